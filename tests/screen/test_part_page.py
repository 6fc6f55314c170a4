"""The page PART by keys and by fingers, on the real screen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.part.part_sheet_view import PartPage
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
    day.sees(lambda: day.desk.session.now.part is not None)
    day.key(Key.Key_B)
    day.sees(lambda: day.page == page_table.PART)
    found = day.window.findChild(PartPage)
    assert found is not None
    return found


def test_a_finding_stands_the_part_at_its_place(day: Day) -> None:
    shown = page(day)
    day.sees(lambda: shown.path.shows_part)
    player = shown.path.player
    assert player is not None
    day.sees(lambda: player.played is not None and player.played.instant.line == 11)
    assert shown.model.marked == 1  # what weighs most, not the offset that nobody has set
    day.key(Key.Key_J)
    day.sees(lambda: player.played is not None and player.played.instant.line == 10)
    day.key(Key.Key_Return)
    day.sees(lambda: player.played is not None and player.played.instant.line == 11)


def test_a_bar_is_said_by_fingers(day: Day) -> None:
    shown = page(day)
    day.key(Key.Key_F2)
    day.sees(lambda: shown.table.sheet.title.startswith("STOCK"))
    day.key(Key.Key_F4)
    day.sees(lambda: len(shown.table.sheet.rows) == 5)
    shown.model.touch(1)
    day.sees(lambda: not shown.pad.isHidden())
    shown.pad.repaint()
    for key in ("1", "Enter"):
        box = next(box for box, press, *_ in shown.pad._places if key in getattr(press, "args", ()))
        QTest.mouseClick(shown.pad, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    day.sees(lambda: shown.model.kept.stock == "bar:1")
    day.sees(lambda: not day.desk.session.now.busy)
    assert day.desk.session.now.diagnostics[-1].assumed == ()


def test_letters_are_a_reason_while_one_is_asked(day: Day) -> None:
    shown = page(day)
    day.key(Key.Key_F4)
    day.sees(lambda: not shown.letters.isHidden())
    day.type("had sickle")  # h, d and s would mean something elsewhere
    assert shown.model.text == "had sickle"
    day.key(Key.Key_Escape)
    day.sees(shown.letters.isHidden)
    day.key(Key.Key_Escape)
    day.sees(lambda: day.page == page_table.AUTOMATIC)
