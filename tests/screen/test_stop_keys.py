"""Feed Hold and E-stop: one key each, and a drawn button, in every state that moves, on every page and in
every entry that its keys open, and after input that was dropped.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.desk.status.prompt_line import MOVING_STATES
from app.screen import page_table
from app.screen.page_table import list_pages
from core.executor.snapshot import MachineState
from tests.screen.day import Day, Key
from tests.screen.test_every_key import STROKES, day, typists
from tests.screen.typist import CTRL, NONE, Stroke, Typist

__all__ = ["day", "typists"]
PAUSE, SCROLL_LOCK = Stroke("Pause", Key.Key_Pause), Stroke("ScrollLock", Key.Key_ScrollLock)
LETTER = Stroke("x", Key.Key_X, "x")
NO_OPENING = {"Pause", "ScrollLock", "e", "h", " "}
SEARCH = Stroke("f", Key.Key_F, "", CTRL)
OPENING = (
    SEARCH,
    *(each for each in STROKES if each.modifiers is NONE and each.name not in NO_OPENING),
)
ENTRIES = {
    page_table.EDITOR,
    page_table.PROGRAMS,
    page_table.TOOLS,
    page_table.SECCMP,
    page_table.ZERO,
    page_table.SHAPE,
}
"""Pages that have an entry in every state in which they open."""
WHERE = [("omniturn", state) for state in sorted(MOVING_STATES)]


def stops(typist: Typist) -> bool:
    """Whether both keys act, also after input was dropped, which another key does not survive."""
    acted = [bool(typist.press(PAUSE)), bool(typist.press(SCROLL_LOCK))]
    typist.day.window.input_times.record_dropped_answer(0)
    acted += [not typist.press(LETTER), bool(typist.press(PAUSE)), bool(typist.press(SCROLL_LOCK))]
    typist.day.window.input_times._dropped = float("-inf")
    return all(acted)


def entries(typist: Typist, name: str, known: set[object]) -> Iterator[Stroke]:
    """The keys that open an entry on this page, each kind of entry once."""
    for stroke in OPENING if name != page_table.EDITOR else OPENING[-24:]:
        typist.opens(name)
        typist.press(stroke)
        if typist.day.frame.has_text_field() and typist.face not in known:
            known.add(typist.face)
            yield stroke


@pytest.mark.parametrize("day", WHERE, indirect=True, ids=lambda each: each[1])
def test_both_stop_keys_act_in_every_entry(day: Day, typists: list[Typist]) -> None:
    typist = Typist(day)
    typists.append(typist)
    deaf, written = [], set()
    for entry in list_pages(day.desk.machine.program_language):
        if not typist.opens(entry.name):
            continue
        known: set[object] = {typist.face}
        deaf += [] if stops(typist) else [entry.name]
        if day.frame.has_text_field():
            written.add(entry.name)
        for stroke in entries(typist, entry.name, known):
            written.add(day.frame.current_page.NAME)
            deaf += [] if stops(typist) else [f"{entry.name} {stroke.name}"]
    typist.opens(page_table.AUTOMATIC)
    assert deaf == []
    assert (
        ENTRIES
        - ({page_table.EDITOR} if day.shot.state in {MachineState.JOG, MachineState.HOMING} else set())
        <= written
    )


@pytest.mark.parametrize("day", WHERE, indirect=True, ids=lambda each: each[1])
def test_both_on_screen_stop_buttons_act_on_every_page(day: Day, typists: list[Typist]) -> None:
    typist = Typist(day)
    typists.append(typist)
    dock = day.frame.station_dock
    assert dock is not None
    for entry in list_pages(day.desk.machine.program_language):
        if not typist.opens(entry.name):
            continue
        dock.grab()
        typist.done.clear()
        day.desk.station_controls.is_estop_pressed = False
        for control in [each for each in dock.controls if each.stops_machine]:
            at = control.box.center().toPoint()
            QTest.mouseClick(dock, Qt.MouseButton.LeftButton, pos=at)
        assert {"press_hold", "press_estop"} <= typist.done, entry.name
    typist.opens(page_table.AUTOMATIC)
