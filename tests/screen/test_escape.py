"""Esc, one step after the other, ends on the Automatic page; what moves is held first, nothing is lost."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.compose.optional_features import extras
from app.editor import editor_messages as messages
from app.editor.editor_view import EditorPage
from app.mdi.mdi_model import MdiModel
from app.screen import page_table
from core.executor.snapshot import MachineState
from tests.attached import attached
from tests.screen.chapters import drives_on
from tests.screen.day import Day, Key, begun
from tests.screen.yes import twist_out, yes
from tests.texts import text

CTRL = Qt.KeyboardModifier.ControlModifier
TEXT = "G90G94F10\nX1Z1\nM30\n"


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot, "slow.nc", TEXT) as day:
        yield day


def opened(day: Day, key: Key, name: str) -> None:
    """A page of the main menu."""
    day.key(Key.Key_F1, key)
    day.sees(lambda: day.page == name)


KEYS = {
    Key.Key_F4: page_table.MDI,
    Key.Key_F5: page_table.JOG,
    Key.Key_F6: page_table.PROGRAMS,
    Key.Key_F8: page_table.TOOLS,
    Key.Key_F9: page_table.SECCMP,
    Key.Key_F10: page_table.SPECIAL,
    Key.Key_G: page_table.ZERO,
    Key.Key_B: page_table.PART,
    Key.Key_Q: page_table.SCOPE,
    **{
        getattr(Key, f"Key_{page.key}"): page.name
        for extra in extras().values()
        for page in extra.page_descriptions
        if page.key
    },
}


@pytest.mark.parametrize("switched_on", [True, False])
def test_esc_returns_from_every_page_to_automatic(day: Day, switched_on: bool) -> None:
    if switched_on:
        drives_on(day)
    for key, name in KEYS.items():
        opened(day, key, name)
        day.key(Key.Key_Escape)
        day.sees(lambda: day.page == page_table.AUTOMATIC)


@pytest.mark.parametrize("switched_on", [True, False])
def test_esc_on_mdi_page_first_clears_text(day: Day, switched_on: bool) -> None:
    if switched_on:
        drives_on(day)
    opened(day, Key.Key_F4, page_table.MDI)
    if switched_on:
        day.type("X1")
        day.key(Key.Key_Escape)
        assert day.page == page_table.MDI
        assert attached(day.desk, MdiModel).mdi_input.text == ""
    day.key(Key.Key_Escape)
    assert day.page == page_table.AUTOMATIC


def test_esc_holds_running_mdi_line_and_stays_on_page(day: Day) -> None:
    drives_on(day)
    opened(day, Key.Key_F4, page_table.MDI)
    day.type("G90G94F5X1")
    day.key(Key.Key_Return)
    attached(day.desk, MdiModel).prepared_line.worker.wait_for_results(60.0)
    day.run(0.05)
    day.palms()
    day.reaches(MachineState.RUN)
    day.key(Key.Key_Escape)
    day.reaches(MachineState.HOLD)
    assert day.page == page_table.MDI
    day.key(Key.Key_Escape)
    assert day.page == page_table.MDI  # a line that is held is not walked away from
    day.key(Key.Key_Escape, Key.Key_R)
    yes(day.window)
    day.reaches(MachineState.IDLE)


def test_esc_holds_before_it_closes_list_or_message(day: Day) -> None:
    """The codes are open over a line that runs, and a message has come that nobody asked for."""
    drives_on(day)
    opened(day, Key.Key_F4, page_table.MDI)
    model = attached(day.desk, MdiModel)
    assert model is not None
    day.type("G90G94F5X1")
    day.key(Key.Key_Return)
    model.prepared_line.worker.wait_for_results(60.0)
    day.run(0.05)
    day.key(Key.Key_F3)
    assert model.line_completion.is_choice_list_open
    day.palms()
    day.reaches(MachineState.RUN)
    day.desk.say("PEG.NC WAS CHANGED ON LATHE 2: F1, X SHOWS WHAT")
    day.key(Key.Key_Escape)
    day.reaches(MachineState.HOLD)
    assert day.page == page_table.MDI


def test_esc_on_jog_page_first_cancels_entry_and_stops_jog(day: Day) -> None:
    drives_on(day)
    opened(day, Key.Key_F5, page_table.JOG)
    day.type("t")
    day.key(Key.Key_Escape)
    assert day.page == page_table.JOG
    QTest.keyPress(day.window, Key.Key_Right)
    day.reaches(MachineState.JOG)
    day.key(Key.Key_Escape)
    assert day.page == page_table.JOG
    day.reaches(MachineState.IDLE)
    QTest.keyRelease(day.window, Key.Key_Right)
    assert day.desk.prompt_notice == text("screen.jog-ended-by-key")
    day.key(Key.Key_Escape)
    assert (day.page, day.desk.prompt_notice) == (page_table.JOG, "")
    day.key(Key.Key_Escape)
    day.sees(lambda: day.page == page_table.AUTOMATIC)


def test_esc_clears_message_before_it_leaves_page(day: Day) -> None:
    drives_on(day)
    opened(day, Key.Key_F5, page_table.JOG)
    day.desk.say("AN ANSWER")
    day.key(Key.Key_Escape)
    assert (day.page, day.desk.prompt_notice) == (page_table.JOG, "")


def edited(day: Day) -> EditorPage:
    """F3 on the program of the folder."""
    day.key(Key.Key_F2)
    day.type("slow")
    day.key(Key.Key_Return)
    day.sees(lambda: day.prompt.startswith(text("screen.to-start")))
    day.key(Key.Key_F3)
    day.sees(lambda: day.page == page_table.EDITOR)
    page = day.frame.current_page
    assert isinstance(page, EditorPage)
    day.sees(lambda: bool(page.text_field.toPlainText()))
    return page


def test_esc_leaves_editor_if_nothing_has_to_be_saved(day: Day, tmp_path: Path) -> None:
    drives_on(day)
    edited(day)
    day.key(Key.Key_F4)
    day.key(Key.Key_Escape)  # the search first
    assert day.page == page_table.EDITOR
    day.key(Key.Key_Escape)
    day.sees(lambda: day.page == page_table.AUTOMATIC)
    assert day.prompt.startswith(text("screen.to-start"))
    assert (tmp_path / "programs" / "slow.nc").read_text(encoding="utf-8") == TEXT


def test_esc_stays_in_editor_if_text_is_not_saved(day: Day, tmp_path: Path) -> None:
    drives_on(day)
    page = edited(day)
    day.key(Key.Key_End, modifier=CTRL)
    day.type("(END)")
    day.key(Key.Key_Escape)
    assert day.prompt == messages.UNSAVED_CHANGES
    for _ in range(3):
        day.key(Key.Key_Escape)
        assert day.page == page_table.EDITOR
    assert page.text_field.toPlainText().endswith("(END)")
    assert (tmp_path / "programs" / "slow.nc").read_text(encoding="utf-8") == TEXT


def test_esc_holds_running_cycle_on_jog_and_automatic_pages(day: Day) -> None:
    drives_on(day)
    day.key(Key.Key_F2)
    day.type("slow")
    day.key(Key.Key_Return)
    day.sees(lambda: day.prompt.startswith(text("screen.to-start")))
    day.palms()
    day.reaches(MachineState.RUN)
    day.key(Key.Key_Escape)
    day.reaches(MachineState.HOLD)
    assert day.page == page_table.AUTOMATIC
    day.palms()
    day.reaches(MachineState.RUN)
    opened(day, Key.Key_F5, page_table.JOG)
    day.key(Key.Key_Escape)
    day.reaches(MachineState.HOLD)
    assert day.page == page_table.JOG
    day.key(Key.Key_Escape)
    day.sees(lambda: day.page == page_table.AUTOMATIC)
    day.key(Key.Key_R)
    yes(day.window)
    day.reaches(MachineState.IDLE)


def test_esc_leaves_page_during_estop(day: Day) -> None:
    drives_on(day)
    opened(day, Key.Key_F5, page_table.JOG)
    day.key(Key.Key_E)
    day.reaches(MachineState.ESTOP)
    day.key(Key.Key_Escape)
    day.sees(lambda: day.page == page_table.AUTOMATIC)
    twist_out(day.window)


def test_f10_on_mdi_page_opens_scope(day: Day) -> None:
    opened(day, Key.Key_F4, page_table.MDI)
    day.key(Key.Key_F10)
    day.sees(lambda: day.page == page_table.SCOPE)
