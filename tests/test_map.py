"""A stranger finds his way: what he would ask, in the manual's words, leads to the file in one step.

One step is: the words in a file's name, or in the first line of its docstring, or in a row of
``docs/architecture.md``, and no more than four files that answer.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from tests.whole_product import WHOLE_PRODUCT

HOUSE = Path(__file__).parents[1]
MAP = HOUSE / "docs" / "architecture.md"
ROOMS = ("app", "core", "drivers")
FEW = 4  # files that one looks into
SENTENCES = (
    # what somebody wants to know; the words that he searches for; the file
    ("Wear counts from the next part", "wear", "core/executor/program_run.py"),
    ("Block delete is proved with the switch on and off", "block delete", "core/proving/prove_program.py"),
    ("The retract of a tapered thread", "threading", "core/interpreter/omniturn/cycles/threading_cycles.py"),
    (
        "A pass follows the spindle's measured angle",
        "thread pass",
        "core/executor/program_motion/thread_pass.py",
    ),
    ("The slides follow the spindle by themselves", "gear", "drivers/spindle_gear.py"),
    ("Feed hold stops on the path", "feed hold", "core/executor/machine_control.py"),
    ("Single block stops behind each block", "single block", "core/executor/program_motion/cycle.py"),
    ("Cycle repeat begins the next part", "cycle repeat", "core/executor/program_run.py"),
    ("Why Cycle Start is refused", "cycle start", "core/executor/start_conditions.py"),
    ("The optional stop M01", "optional stop", "core/executor/program_motion/standstill.py"),
    ("An E-stop takes everything off", "safe stop", "core/executor/safety/safe_stop.py"),
    ("How far an axis may lag behind", "following error", "core/executor/safety/supervision.py"),
    ("In which order the axes are homed", "homing", "core/executor/hand_motion/touch_off.py"),
    ("A jog lasts as long as its lease", "jog lease", "core/executor/hand_motion/jogging.py"),
    ("Clicks of the handwheel", "handwheel", "core/executor/hand_motion/handwheel.py"),
    ("A program that did not come to its end", "interrupted job", "core/executor/snapshot.py"),
    ("Read-ahead stops at a standstill", "read ahead", "core/executor/job.py"),
    ("The queue always ends at rest", "setpoint queue", "drivers/setpoint_queue.py"),
    ("A dead thread stops the machine", "watchdog", "core/executor/safety/watchdog.py"),
    ("Whether a part is counted", "part count", "core/executor/control_status.py"),
    ("Speed by the radius", "constant surface speed", "core/interpreter/omniturn/setup/spindle_and_dwell.py"),
    (
        "The nose's path beside the contour",
        "nose compensation",
        "core/interpreter/omniturn/motion/nose_compensation.py",
    ),
    ("A box is taken off in passes", "roughing", "core/interpreter/omniturn/cycles/roughing_cycles.py"),
    ("A hole in pecks", "drilling", "core/interpreter/omniturn/cycles/drilling_cycles.py"),
    ("A chamfer where two lines meet", "chamfer", "core/interpreter/omniturn/motion/corners.py"),
    ("Coarse feeds of G35", "coarse feeds", "core/interpreter/omniturn/motion/feeds.py"),
    ("Milling with XC and ZC", "plane switching", "core/interpreter/omniturn/motion/plane_switching.py"),
    ("The spindle as a rotary axis", "c axis", "core/interpreter/omniturn/motion/c_axis.py"),
    ("A loop of blocks", "loops", "core/interpreter/omniturn/flow/loops_and_subroutines.py"),
    (
        "The bar feeder's input branches",
        "conditional calls",
        "core/interpreter/omniturn/flow/conditional_calls.py",
    ),
    ("What F means on a line", "code table", "core/interpreter/omniturn/codes/code_table.py"),
    ("Work shift by G10", "work shift", "core/interpreter/omniturn/setup/tools_and_offsets.py"),
    ("The table of secondary offsets", "secondary offsets", "app/offsets/secondary_offsets.py"),
    ("Tools are touched off", "touch off", "app/jog/tool_setting.py"),
    ("Back into the part after a stop", "restart", "core/interpreter/restart/restart_approach.py"),
    ("What a G54 is set to", "zero offsets", "app/offsets/zero_offsets.py"),
    ("No move beyond the travel is proved", "soft limits", "core/proving/checks/machine_checks.py"),
    ("How long a part takes", "cycle time", "core/proving/program_timeline.py"),
    ("PLANE POINTS on a table", "plane", "core/interpreter/klartext/motion/plane_functions.py"),
    ("C with the third axis", "third axis", "core/interpreter/sinumerik/motion/third_axis.py"),
)
MOST_MISSED = 4


@cache
def _first_lines() -> dict[str, str]:
    lines = {}
    for room in ROOMS:
        for path in sorted((HOUSE / room).rglob("*.py")):
            if path.name != "__init__.py":
                doc = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
                lines[str(path.relative_to(HOUSE))] = doc.partition("\n")[0].lower()
    return lines


def _has(text: str, words: str) -> bool:
    return all(re.search(rf"\b{word}", text) for word in words.split())


def by_name(words: str) -> list[str]:
    """Files with these words in their names."""
    return [path for path in _first_lines() if _has(Path(path).stem.replace("_", " "), words)]


def by_first_line(words: str) -> list[str]:
    """Files whose first docstring line has these words."""
    return [path for path, line in _first_lines().items() if _has(line.replace("-", " "), words)]


def by_map(words: str) -> list[str]:
    """Files to which a row of the map with these words leads."""
    rows = [row for row in MAP.read_text(encoding="utf-8").splitlines() if row.startswith("| ")]
    found = [re.findall(r"`([\w/]+\.py)`", row) for row in rows if _has(row.lower(), words)]
    return [path for paths in found for path in paths]


def found(words: str, path: str) -> bool:
    """Whether one of the three searches is answered by this file, among few."""
    return any(
        path in hits and len(hits) <= FEW for hits in (by_name(words), by_first_line(words), by_map(words))
    )


def test_map_leads_to_the_file_in_one_step_for_forty_questions() -> None:
    assert len(SENTENCES) == 40
    missed = [(asked, words) for asked, words, path in SENTENCES if not found(words, path)]
    assert len(missed) <= MOST_MISSED, missed


@pytest.mark.parametrize("path", sorted({path for _, _, path in SENTENCES}))
def test_file_named_in_map_questions_exists(path: str) -> None:
    assert (HOUSE / path).is_file()


def _absent(path: str) -> bool:
    """Whether a path does not exist, and does not belong to an optional feature that was deleted."""
    extra = re.match(r"(?:app|core|tests)/extras/(\w+)", path)
    deleted = extra is not None and not (HOUSE / "app" / "extras" / extra[1]).exists()
    return not deleted and not (HOUSE / path).exists()


def test_map_names_only_existing_files() -> None:
    text = MAP.read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:app|core|drivers|tests|resources)/[\w/]*(?:\.py)?)`", text))
    assert len(named) > 60
    assert sorted(filter(_absent, named)) == []


def test_the_documents_name_only_files_that_are_there() -> None:
    named = [
        (document.name, path)
        for document in [HOUSE / "README.md", *sorted((HOUSE / "docs").rglob("*.md"))]
        for path in re.findall(
            r"\b((?:app|core|drivers|tests|resources)/[\w/]+\.(?:py|toml|sh|nc))\b",
            document.read_text(encoding="utf-8"),
        )
    ]
    assert len(named) > 150
    assert [each for each in named if _absent(each[1])] == []


@WHOLE_PRODUCT
def test_decision_records_name_only_existing_files() -> None:
    """In a record a file often stands alone, without its folder."""
    there = {path.name for room in (*ROOMS, "resources", "tests") for path in (HOUSE / room).rglob("*.py")}
    records = sorted((HOUSE / "docs" / "decisions").glob("*.md"))
    named = [
        (record.name, name)
        for record in records
        for name in re.findall(r"`(?:[\w/]+/)?(\w+\.py)`", record.read_text(encoding="utf-8"))
    ]
    assert len(named) > 80
    gone = {"page.py"}  # nine former files, which record 0001 names
    assert [(record, name) for record, name in named if name not in there | gone] == []


def test_every_record_is_in_the_index_of_decisions() -> None:
    """One of the last ten may wait for its row."""
    folder = HOUSE / "docs" / "decisions"
    text = (folder / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[(\d{4})\]\((\d{4}-[\w-]+\.md)\) \|", text, re.MULTILINE)
    listed = [name for _, name in rows]
    assert [number for number, name in rows if name[:4] != number] == []
    known = {path.name for path in folder.glob("0*.md")}
    assert sorted(set(listed) - known) == []
    waiting = {name for name in known if int(name[:4]) > int(max(known)[:4]) - 10}
    assert sorted(known - set(listed) - waiting) == []


def test_every_source_folder_is_on_the_map() -> None:
    text = MAP.read_text(encoding="utf-8")
    rooms = {path.parent.relative_to(HOUSE) for room in ROOMS for path in (HOUSE / room).rglob("*.py")}
    assert [str(room) for room in sorted(rooms) if room.name not in text] == []


def test_unknown_word_leads_to_no_file() -> None:
    assert not found("flux capacitor", "core/executor/program_motion/cycle.py")
    assert not found("spindle", "core/executor/hand_motion/touch_off.py")
