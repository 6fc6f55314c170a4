"""The page PART by keys and by fingers, on the real screen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.part.part_page_view import PartPage
from app.screen import page_table
from tests.desk.test_part_found import SLIP
from tests.screen.day import Day, Key, begun


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot, "slip.nc", SLIP) as day:
        yield day


def page(day: Day) -> PartPage:
    """The slip is on the desk, and its part in view."""
    day.key(Key.Key_F2)
    day.type("slip.nc")
    day.key(Key.Key_Return)
    day.sees(lambda: day.desk.program_loader.loaded_program.part_proof is not None)
    day.key(Key.Key_B)
    day.sees(lambda: day.page == page_table.PART)
    found = day.window.findChild(PartPage)
    assert found is not None
    return found


def test_selected_finding_moves_part_view_to_its_line(day: Day) -> None:
    shown = page(day)
    day.sees(lambda: shown.path_view.is_part_shown)
    player = shown.path_view.part_player
    assert player is not None
    day.sees(lambda: player.latest_result is not None and player.latest_result.part_instant.line_number == 11)
    assert shown.model.selected_row_index == 1  # what weighs most, not the offset that nobody has set
    day.key(Key.Key_J)
    day.sees(lambda: player.latest_result is not None and player.latest_result.part_instant.line_number == 10)
    day.key(Key.Key_Return)
    day.sees(lambda: player.latest_result is not None and player.latest_result.part_instant.line_number == 11)


def test_bar_stock_is_entered_by_touch(day: Day) -> None:
    shown = page(day)
    day.key(Key.Key_F2)
    day.sees(lambda: shown.table_panel.table.title.startswith("STOCK"))
    day.key(Key.Key_F4)
    day.sees(lambda: len(shown.table_panel.table.rows) == 5)
    shown.model.handle_row_touch(1)
    day.sees(lambda: not shown.number_pad.isHidden())
    shown.number_pad.repaint()
    for key in ("1", "Enter"):
        box = next(box for box, press, *_ in shown.number_pad._places if key in getattr(press, "args", ()))
        QTest.mouseClick(shown.number_pad, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    day.sees(lambda: shown.model.stored_part.stock_text == "bar:1")
    day.sees(lambda: not day.desk.program_loader.loaded_program.is_busy)
    assert day.desk.program_loader.loaded_program.diagnostics[-1].assumptions == ()


def test_letters_are_text_while_a_reason_is_asked(day: Day) -> None:
    shown = page(day)
    day.key(Key.Key_F4)
    day.sees(lambda: not shown.letter_pad.isHidden())
    day.type("had sickle")  # h, d and s would mean something elsewhere
    assert shown.model.entry_text == "had sickle"
    day.key(Key.Key_Escape)
    day.sees(shown.letter_pad.isHidden)
    day.key(Key.Key_Escape)
    day.sees(lambda: day.page == page_table.AUTOMATIC)
