"""Lessons on the screen: start from the F10 list, completion by keys alone, and refusal on a real machine."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.compose.machine.machine_files import load_machine
from app.desk.persistence import Persistence
from app.desk.translation import tr
from app.extras.lessons import lessons_function
from app.extras.lessons.extra import EXTRA
from app.extras.lessons.lesson_card import COMPLETED_SETTING, LessonCard
from app.extras.lessons.lessons_function import LessonsFunction
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, measure_text, set_language
from app.screen.window.window_bars import NOTICE_KEY
from app.screen.window_layout import MIN_WINDOW_PX, make_automatic_layout
from app.special.special_functions import SpecialFunctionsModel
from core.executor.snapshot import MachineState
from core.extras.lessons.lesson_file import list_lesson_files, read_lesson
from tests.screen.day import Day, Key, begun
from tests.texts import shows

PEG = "(PEG)\nG90G94F300G72\nT1\nM03S2000\nG00X.7Z.1\nX.5\nG01G94F60Z-.3\nX.7\nG00Z1\nM05\nM30\n"
LESSON = """
number = 1
title = "PEG"
goal = "Make a peg."
minutes = 1
program = "peg.nc"
[[steps]]
instruction = "Open the Automatic page."
page = "AUTOMATIC"
proved_program = "peg.nc"
[[steps]]
instruction = "Turn the drives on."
state = "READY"
[[steps]]
instruction = "Correct D1."
offset = { table = "secondary", number = 1, field = "x", difference_mm = -0.0254 }
[[steps]]
instruction = "Make the part."
page = "AUTOMATIC"
counted_parts = 1
"""
CREATING = LESSON.replace("peg.nc", "own.nc").replace(
    'minutes = 1\nprogram = "own.nc"', 'minutes = 1\nprogram = "own.nc"\nprogram_text = "G90\\nM30\\n"'
)


@pytest.fixture
def lesson_path(tmp_path: Path) -> Path:
    path = tmp_path / "lesson.toml"
    path.write_text(LESSON)
    return path


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, lesson_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    monkeypatch.setattr(lessons_function, "list_lesson_files", lambda: [lesson_path])
    with begun(qtbot, "peg.nc", PEG) as day:
        day.store.offsets.tool_offsets.change_row(1, "test", {"x": -12.7, "z": -50.8}).result(60)
        day.desk.offset_book.read_store()
        day.run(0.02)
        yield day


def open_function(day: Day) -> LessonsFunction:
    day.key(Key.Key_F10)
    model = day.desk.page_registry.find_model(SpecialFunctionsModel)
    assert model is not None
    index = next(n for n, each in enumerate(model.functions) if each.name == "LESSONS")
    model.open_function(index)
    function = model.shown_function
    assert isinstance(function, LessonsFunction)
    return function


def card_text(day: Day) -> str:
    day.run(0.05)
    return "\n".join(row.text for row in day.frame.notice_rows.notice_rows)


def status_of(day: Day, function: LessonsFunction, row: int = 0) -> str:
    return function.make_table(day.shot).rows[row].cells[2]


def test_lesson_is_completed_with_keys_alone(day: Day) -> None:
    function = open_function(day)
    day.key(Key.Key_Return)
    day.sees(lambda: day.desk.program_loader.loaded_program.name == "peg.nc")
    assert shows(card_text(day), "lessons.step", number=1, step=1, count=4)
    day.key(Key.Key_F1, Key.Key_F2)
    day.sees(lambda: shows(card_text(day), "lessons.step", step=2, count=4))
    day.key(Key.Key_D)
    day.until(lambda: shows(card_text(day), "lessons.step", step=3, count=4))
    day.key(Key.Key_F9)
    day.enter("1", "-.002", "", "")
    day.saved()
    assert shows(card_text(day), "lessons.step", step=4, count=4)  # the card is also on other pages
    day.key(Key.Key_Escape, Key.Key_Escape)
    day.sees(lambda: shows(day.prompt, "screen.to-start"))
    day.palms()
    day.reaches(MachineState.IDLE)
    assert shows(card_text(day), "lessons.all-done", number=1)
    assert status_of(day, function) == "4 OF 4 STEPS"
    day.saved()
    assert day.store.settings.read_setting(COMPLETED_SETTING) == [1]


@pytest.mark.parametrize("language", ["en", "es"])
def test_every_instruction_fits_on_the_card_of_the_smallest_window(qapp: object, language: str) -> None:
    theme = ScreenTheme(DARK_PALETTE)
    theme.set_window_size(*MIN_WINDOW_PX)
    strip_px = make_automatic_layout(*MIN_WINDOW_PX, has_dock=True).strip.w
    width_px = strip_px - (NOTICE_KEY + 2.4) * theme.unit_px  # next to the touch target and the margins
    set_language(language)
    texts = [tr(step.instruction) for path in list_lesson_files() for step in read_lesson(path).steps]
    set_language("en")
    widths = {text: measure_text(text, theme.fit_font(text, 1.7, width_px)) for text in texts}
    assert [text for text, width in widths.items() if width > width_px] == []
    assert measure_text("Long. " * 99, theme.fit_font("Long. " * 99, 1.7, width_px)) > width_px


def test_touch_target_closes_the_card_and_then_the_card_of_the_first_job(day: Day) -> None:
    day.desk.apply_setting("first_job", True)
    function = open_function(day)
    day.key(Key.Key_Return, Key.Key_F1, Key.Key_F2)
    assert "FIRST JOB" not in card_text(day)
    day.window.press_key("×")
    assert "LESSON" not in card_text(day)
    assert "FIRST JOB" in card_text(day)
    day.window.press_key("×")
    assert card_text(day) == ""
    function.end_lesson()
    assert shows(day.prompt, "lessons.none-started")


def test_lesson_creates_its_program_but_never_replaces_a_file(day: Day, lesson_path: Path) -> None:
    lesson_path.write_text(CREATING)
    own = day.desk.program_choice.program_folders.folders[0] / "own.nc"
    open_function(day)
    day.key(Key.Key_Return)
    day.sees(lambda: day.desk.program_loader.loaded_program.name == "own.nc")
    assert own.read_text() == "G90\nM30\n"
    own.write_text("G90\nM05\nM30\n")
    day.key(Key.Key_Return)
    day.sees(lambda: "M05" in getattr(day.desk.program_loader.loaded_program.source, "text", ""))
    assert own.read_text() == "G90\nM05\nM30\n"


def test_damaged_lesson_is_listed_with_its_fault_and_cannot_be_started(day: Day, lesson_path: Path) -> None:
    lesson_path.write_text(LESSON.replace("minutes = 1", "minutes = 0"))
    function = open_function(day)
    assert "minutes" in function.make_table(day.shot).rows[0].cells[1]
    assert status_of(day, function) == "DAMAGED"
    day.key(Key.Key_Return)
    assert "minutes" in day.prompt
    assert card_text(day) == ""


def test_lesson_cannot_be_started_while_a_program_runs(day: Day) -> None:
    day.key(Key.Key_D)
    assert day.desk.program_choice.load_by_name("peg")
    day.sees(lambda: shows(day.prompt, "screen.to-start"))
    day.palms()
    assert day.shot.state is MachineState.RUN
    open_function(day).start_selected_lesson()
    assert card_text(day) == ""
    day.reaches(MachineState.IDLE)
    assert day.shot.parts == 1  # the run was not disturbed


def test_lesson_cannot_be_started_on_a_real_machine(day: Day) -> None:
    real = load_machine(Path("resources/machines/gt75-canopen.toml"))
    model = day.desk.page_registry.find_model(SpecialFunctionsModel)
    assert model is not None
    ((function, _preceding),) = EXTRA.list_special_functions(day.desk, real, Persistence(), model.worker)
    assert isinstance(function, LessonsFunction)
    assert shows(function.make_table(day.shot).notes[0], "lessons.simulated-only")
    function.start_selected_lesson()
    assert shows(day.prompt, "lessons.simulated-only")
    card = day.desk.page_registry.find_model(LessonCard)
    assert card is not None
    assert card.progress is None


def test_invalid_stored_setting_counts_as_no_completed_lesson(day: Day) -> None:
    for stored in ("1", ["1", None, True], {"1": 1}):
        day.desk.settings_store.persistence.save_setting(COMPLETED_SETTING, stored)
        day.saved()
        assert LessonCard(day.desk).completed_lessons == frozenset()
