"""The size of the path view on the Automatic page, and what remains visible around it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from app.automatic.automatic_view import AutomaticPage
from core.executor.snapshot import MachineState
from tests.screen.chapters import drives_on
from tests.screen.day import Day, Key, begun

SHIFT = Qt.KeyboardModifier.ShiftModifier
TEXT = "G90G94F10\nX1Z1\nM30\n"


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot, "slow.nc", TEXT) as day:
        yield day


def automatic(day: Day) -> AutomaticPage:
    page = day.frame.automatic_page
    assert isinstance(page, AutomaticPage)
    return page


def share(day: Day) -> float:
    """The share of the window that the path view covers."""
    day.run(0.1)
    view = automatic(day).path_view
    return view.width() * view.height() / (day.window.width() * day.window.height())


def test_key_switches_between_full_and_normal_size(day: Day) -> None:
    normal = share(day)
    day.type("w")
    full = share(day)
    page = automatic(day)
    assert full > 1.8 * normal
    assert page.path_view.geometry() == page.rect()
    assert not page.program_listing.isVisible()
    for part in (day.frame.title_line, day.frame.readout_line, day.frame.strip, day.frame.prompt_line):
        assert part.isVisible()
        assert not part.geometry().intersects(page.geometry())
    day.type("w")
    assert share(day) == normal
    assert page.program_listing.isVisible()


def test_shift_key_shows_half_size_next_to_program(day: Day) -> None:
    normal = share(day)
    day.key(Key.Key_W, modifier=SHIFT)
    half = share(day)
    page = automatic(day)
    assert normal < half
    assert page.program_listing.isVisible()
    assert not page.path_view.geometry().intersects(page.program_listing.geometry())
    day.type("w")
    assert share(day) > half
    day.key(Key.Key_W, modifier=SHIFT)
    assert share(day) == half


def test_button_selects_next_size(day: Day) -> None:
    view = automatic(day).path_view
    assert view.enlarge is not None
    normal = share(day)
    sizes = []
    for _ in range(3):
        view.enlarge()
        sizes.append(share(day))
    assert normal == sizes[2]
    assert normal < sizes[0] < sizes[1]


def started(day: Day) -> None:
    """The program moves an axis."""
    drives_on(day)
    day.key(Key.Key_F2)
    day.type("slow")
    day.key(Key.Key_Return)
    day.sees(lambda: "TO START" in day.prompt)
    day.palms()
    day.reaches(MachineState.RUN)


def test_escape_restores_normal_size_at_rest(day: Day) -> None:
    normal = share(day)
    day.type("w")
    assert share(day) > normal
    day.key(Key.Key_Escape)
    assert share(day) == normal


def test_escape_holds_running_program_and_keeps_size(day: Day) -> None:
    started(day)
    normal = share(day)
    day.type("w")
    assert share(day) > normal
    day.key(Key.Key_Escape)
    day.reaches(MachineState.HOLD)
    assert share(day) > normal


@pytest.mark.parametrize("key", ["h", " "])
def test_stop_keys_act_in_full_size(day: Day, key: str) -> None:
    started(day)
    day.type("w")
    day.type(key)
    day.reaches(MachineState.HOLD)
    assert automatic(day).has_enlarged_view


def test_other_page_has_its_usual_layout(day: Day) -> None:
    day.key(Key.Key_F1, Key.Key_F4)
    day.run(0.1)
    usual = day.frame.current_page.geometry()
    day.key(Key.Key_F1, Key.Key_F2)
    day.type("w")
    share(day)
    day.key(Key.Key_F1, Key.Key_F4)
    day.run(0.1)
    assert day.frame.current_page.geometry() == usual
    day.key(Key.Key_F1, Key.Key_F2)
    assert automatic(day).path_view.geometry() == automatic(day).rect()
