"""Lesson files: the shipped lessons are complete and correct, and damaged files are rejected."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.screen.page_table import ALL_PAGES
from core.extras.lessons.lesson import Lesson, LessonStep, OffsetDifference, OffsetField, StepCondition
from core.extras.lessons.lesson_file import LessonFileError, list_lesson_files, read_lesson
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.message import get_error_code
from core.proving.checks.part_checks import PART_CHECKS
from core.proving.prove_program import prove
from resources.translations.collect import read_translations

LESSONS = [read_lesson(path) for path in list_lesson_files()]
STEPS = [step for lesson in LESSONS for step in lesson.steps]
VALID = """
number = 1
title = "A"
goal = "B."
minutes = 2
program = "a.nc"
[[steps]]
instruction = "Press P."
switch_on = "no_count"
[[steps]]
instruction = "Type."
page = "TOOL OFFSETS"
offset = { table = "tool", number = 2, field = "x", difference_mm = -0.5 }
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "lesson.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_lesson_file_specifies_lesson_and_conditions(tmp_path: Path) -> None:
    offset = OffsetDifference(OffsetField("tool", 2, "x"), -0.5)
    steps = (
        LessonStep("Press P.", StepCondition(switch_on="no_count")),
        LessonStep("Type.", StepCondition(page="TOOL OFFSETS", offset=offset)),
    )
    assert read_lesson(write(tmp_path, VALID)) == Lesson(1, "A", "B.", 2, "a.nc", steps)


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("number = 1", "", "number"),
        ("number = 1", "number = 0", "number"),
        ("minutes = 2", "minutes = true", "minutes"),
        ('title = "A"', 'title = ""', "title"),
        ('title = "A"', 'title = "A"\nauthor = "B"', "author"),
        ('instruction = "Press P."', "", "instruction"),
        ('switch_on = "no_count"', "", "step 1"),
        ('switch_on = "no_count"', 'switch_on = "spindle"', "spindle"),
        ('switch_on = "no_count"', 'state = "BUSY"', "BUSY"),
        ('switch_on = "no_count"', "min_line = 0", "min_line"),
        ('switch_on = "no_count"', "is_interrupted = 1", "is_interrupted"),
        ('switch_on = "no_count"', "python = 1", "python"),
        ('table = "tool"', 'table = "zero"', "zero"),
        ('field = "x"', 'field = "remark"', "remark"),
        ("number = 2", "number = -2", "number"),
        ("difference_mm = -0.5", 'difference_mm = "a"', "difference_mm"),
        ("offset = {", "offset = {{", "line"),
    ],
)
def test_damaged_lesson_file_is_rejected(tmp_path: Path, old: str, new: str, named: str) -> None:
    assert old in VALID
    with pytest.raises(LessonFileError) as caught:
        read_lesson(write(tmp_path, VALID.replace(old, new, 1)))
    assert get_error_code(caught.value) == "lesson-file"
    assert "lesson.toml" in str(caught.value)
    assert named in str(caught.value)


def test_lesson_without_steps_is_rejected(tmp_path: Path) -> None:
    head = VALID.partition("[[steps]]")[0]
    for text in (head, f"{head}steps = []\n", f"{head}steps = [1]\n"):
        with pytest.raises(LessonFileError):
            read_lesson(write(tmp_path, text))


def test_missing_binary_and_oversized_files_are_rejected(tmp_path: Path) -> None:
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    (tmp_path / "large.toml").write_text("#" * 70_000)
    for name in ("missing.toml", "binary.toml", "large.toml"):
        with pytest.raises(LessonFileError):
            read_lesson(tmp_path / name)


# --- shipped lessons -------------------------------------------------------------------------------------


def test_shipped_lessons_are_numbered_in_order() -> None:
    assert [lesson.number for lesson in LESSONS] == list(range(1, 9))
    assert sorted({step.condition.page for step in STEPS} - {page.name for page in ALL_PAGES} - {""}) == []
    assert {step.condition.finding for step in STEPS} - {""} <= {*PART_CHECKS}


@pytest.mark.parametrize(
    "lesson", [each for each in LESSONS if each.program_text], ids=lambda each: each.title
)
def test_programs_of_lessons_have_no_errors(lesson: Lesson) -> None:
    # The tools of the demo, and T5 at the position of T1: X radius -.5 in, Z -3 in.
    tools = {1: ToolOffset(-12.7, -76.2), 5: ToolOffset(-12.7, -76.2), 7: ToolOffset(0.0, -50.8)}
    machine = load_machine(None)
    setup = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={})
    report = prove(ProgramSource(lesson.program, lesson.program_text), setup, machine)
    assert [each for each in report.diagnostics if each.code != "comment-character"] == []


def test_lines_named_in_instructions_contain_the_named_code() -> None:
    thread = next(lesson for lesson in LESSONS if "G33" in lesson.program_text)
    assert thread.program_text.splitlines()[16].startswith("G33")  # line 17
    c_axis = next(lesson for lesson in LESSONS if "M19" in lesson.program_text)
    assert c_axis.program_text.splitlines()[10] == "CA120S60"  # line 11


def test_every_text_of_lessons_is_translated() -> None:
    texts = {text for lesson in LESSONS for text in (lesson.title, lesson.goal)}
    texts |= {step.instruction for step in STEPS}
    assert sorted(texts - {*read_translations("es")}) == []
