"""Presses that the key watcher has sent to the control, and their events that come to the screen later."""

from __future__ import annotations

import socket
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import partial
from typing import cast

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QGuiApplication, QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.stop_keys.key_watcher_client import KeyWatcherClient
from app.desk.stop_keys.key_watcher_notice import report_watcher_end
from app.desk.stop_keys.stop_records import (
    FocusRecord,
    StopKeyPress,
    StopKind,
    make_button_code,
    make_press_number,
)
from app.screen import page_table
from core.executor.commands import FeedHold
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands, Key
from tests.screen.test_keyboard import send, window_of
from tests.texts import text

AT = 10_000


@dataclass
class Watched:
    """A watcher of which the test says what it has sent."""

    sent: list[StopKeyPress] = field(default_factory=list)
    told: list[StopKeyPress] = field(default_factory=list)
    shown: list[FocusRecord] = field(default_factory=list)

    def check_process(self) -> None:
        """It runs."""

    def send(self, kind: StopKind, key: int) -> None:
        self.sent.append(StopKeyPress(kind, make_press_number(key, AT)))
        self.told.append(self.sent[-1])

    def send_focus(self, focus: FocusRecord) -> None:
        self.shown.append(focus)

    def read_sent_stops(self) -> list[StopKeyPress]:
        told, self.told = self.told, []
        return told

    def was_press_sent(self, press: int) -> bool:
        return press in {each.press_number for each in self.sent}


@pytest.fixture
def watched(hands: Hands) -> tuple[Hands, Watched]:
    hands.sees(lambda: QApplication.focusWindow() is window_of(hands))
    made = Watched()
    hands.window.keyboard_filter._watched = cast("KeyWatcherClient", made)
    return hands, made


def moving(hands: Hands, state: MachineState = MachineState.RUN) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)


def test_watcher_is_informed_of_window_and_esc_function(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    hands.window.refresh()
    assert made.shown[-1].window_ids == frozenset({int(window_of(hands).winId())})
    assert not made.shown[-1].is_esc_stop_key
    moving(hands, MachineState.WAIT)
    hands.window.refresh()
    assert made.shown[-1].is_esc_stop_key
    hands.frame.open_page(page_table.SECCMP)
    hands.window.refresh()
    assert not made.shown[-1].is_esc_stop_key


def test_watcher_is_informed_of_drawn_stop_controls(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    dock = hands.frame.station_dock
    assert dock is not None
    dock.grab()
    hands.window.refresh()
    boxes = [each.box for each in dock.controls if each.stops_machine]
    areas = made.shown[-1].stop_areas
    assert [each.stop_kind for each in areas] == [StopKind.ESTOP, StopKind.HOLD]
    for area, box in zip(areas, boxes, strict=True):
        at = hands.window.mapFromGlobal(dock.mapToGlobal(box.center())).toPoint()
        assert area.contains(at.x(), at.y())
        assert (area.width_px, area.height_px) == pytest.approx((box.width(), box.height()), abs=1)
        assert area.window_id == int(window_of(hands).winId())


def test_watcher_is_not_informed_of_hidden_or_covered_stop_controls(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    dock = hands.frame.station_dock
    assert dock is not None
    dock.grab()
    cover = QWidget(hands.window)
    cover.setGeometry(hands.window.rect())
    cover.show()
    hands.window.refresh()
    assert made.shown[-1].stop_areas == ()
    cover.hide()
    hands.window.refresh()
    assert len(made.shown[-1].stop_areas) == 2
    dock.hide()
    hands.window.refresh()
    assert made.shown[-1].stop_areas == ()


def test_feed_hold_contains_number_of_its_key_press(watched: tuple[Hands, Watched]) -> None:
    hands, _ = watched
    send(hands, Key.Key_Pause, at=AT)
    (hold,) = [each for each in hands.machine.posted if isinstance(each, FeedHold)]
    assert hold.press == make_press_number(Key.Key_Pause, AT)


def test_esc_that_caused_feed_hold_does_not_leave_page(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    hands.frame.open_page(page_table.MENU)
    moving(hands, MachineState.HOLD)  # by the watcher
    hands.window.refresh()
    made.send(StopKind.ESC, Key.Key_Escape)
    send(hands, Key.Key_Escape, at=AT)
    assert hands.frame.current_page.NAME == page_table.MENU
    assert hands.machine.posted[-1].press == make_press_number(Key.Key_Escape, AT)  # type: ignore[attr-defined]


def test_esc_that_caused_no_feed_hold_leaves_page(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    hands.frame.open_page(page_table.MENU)
    moving(hands, MachineState.HOLD)
    hands.window.refresh()
    made.send(StopKind.ESC, Key.Key_Escape)
    send(hands, Key.Key_Escape, at=AT + 500)  # another press
    assert hands.frame.current_page.NAME == page_table.AUTOMATIC
    assert FeedHold() not in hands.machine.posted


def test_estop_reported_by_watcher_is_shown_as_pressed(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    made.send(StopKind.ESTOP, Key.Key_ScrollLock)
    hands.window.refresh()
    assert hands.desk.station_controls.is_estop_pressed


def test_feed_hold_reported_by_watcher_is_not_posted_again(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    made.send(StopKind.HOLD, Key.Key_Pause)
    hands.window.refresh()
    assert FeedHold() not in hands.machine.posted
    assert not hands.desk.station_controls.is_estop_pressed


@pytest.fixture
def without_display(monkeypatch: pytest.MonkeyPatch) -> None:
    """A computer on which the window opens, but the key watcher ends at once."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(QGuiApplication, "platformName", lambda: "xcb")


@pytest.mark.usefixtures("without_display")
def test_ended_watcher_is_logged_and_shown_once_after_its_restart(hands: Hands) -> None:
    lines, events = list[socket.socket](), list[str]()
    hands.desk.desk_control.report_event = lambda kind, words: events.append(f"{kind}: {words}")

    def open_line() -> socket.socket:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        lines.append(theirs)
        return ours

    report_end = partial(report_watcher_end, hands.desk)
    client = hands.window.keyboard_filter.start_key_watcher(open_line, report_end)
    assert client is not None
    with closing(client):
        hands.sees(lambda: len(events) == 2)
    assert events == [
        "warning: " + text("stories.key-watcher-restarted", status=1),
        "warning: " + text("stories.key-watcher-ended", status=1),
    ]
    assert hands.desk.prompt_line.message == text("stories.stop-keys-late")
    send(hands, Key.Key_Right)  # a key does not remove it
    assert hands.desk.prompt_line.message == text("stories.stop-keys-late")
    for line in lines:
        line.close()


@pytest.mark.parametrize("key", [Key.Key_E, Key.Key_H, Key.Key_Space])
def test_letter_that_watcher_has_sent_is_not_entered_in_field(
    watched: tuple[Hands, Watched], key: Key
) -> None:
    hands, made = watched
    hands.key(Key.Key_F2)
    assert hands.frame.has_text_field()
    made.send(StopKind.ESTOP if key is Key.Key_E else StopKind.HOLD, key)
    text = " " if key is Key.Key_Space else chr(key).lower()
    send(hands, key, text=text, at=AT + 500)  # another press, which is text
    assert hands.page.file_prompt.name_edit.text() == text
    send(hands, key, text=text, at=AT)
    assert hands.page.file_prompt.name_edit.text() == text
    if key is Key.Key_E:
        assert hands.desk.station_controls.is_estop_pressed
    else:
        assert hands.machine.posted[-1] == FeedHold(press=make_press_number(key, AT))


def test_watcher_is_informed_of_text_field_and_of_handled_press(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    keyboard = hands.window.keyboard_filter
    keyboard.complete_frame()
    assert made.shown[-1].are_letters_stop_keys
    send(hands, Key.Key_F2, at=AT)
    assert not made.shown[-1].are_letters_stop_keys or made.shown[-1].handled_press == 0
    keyboard.complete_frame()
    assert made.shown[-1].handled_press == 0
    keyboard.complete_frame()
    assert made.shown[-1].handled_press == make_press_number(Key.Key_F2, AT)
    assert not made.shown[-1].are_letters_stop_keys


def test_letters_are_not_reported_as_stop_keys_while_another_program_has_the_keyboard(
    watched: tuple[Hands, Watched], monkeypatch: pytest.MonkeyPatch
) -> None:
    # Qt then names no field with the keyboard, although the field gets it back with the window.
    hands, made = watched
    hands.window.keyboard_filter.complete_frame()
    assert made.shown[-1].are_letters_stop_keys
    monkeypatch.setattr(QGuiApplication, "focusWindow", lambda: None)
    hands.window.keyboard_filter.complete_frame()
    assert not made.shown[-1].are_letters_stop_keys


def test_mouse_press_is_handled_two_frames_after_its_release(watched: tuple[Hands, Watched]) -> None:
    # A list row opens when the button is released, so that a letter can be text afterwards.
    hands, made = watched
    keyboard, window = hands.window.keyboard_filter, window_of(hands)
    at, left, none = QPointF(5, 5), Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    number = make_press_number(make_button_code(1), AT)
    for kind, buttons, expected in (
        (QEvent.Type.MouseButtonPress, left, [0, 0, 0]),
        (QEvent.Type.MouseButtonRelease, none, [0, number, number]),
    ):
        event = QMouseEvent(kind, at, at, at, left, buttons, Qt.KeyboardModifier.NoModifier)
        event.setTimestamp(AT)
        keyboard.eventFilter(window, event)
        for handled in expected:
            keyboard.complete_frame()
            assert made.shown[-1].handled_press == handled


def test_watcher_is_informed_of_received_press(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    send(hands, Key.Key_F2, at=AT)
    hands.window.keyboard_filter.complete_frame()
    assert made.shown[-1].received_press == make_press_number(Key.Key_F2, AT)


def test_watcher_is_not_started_without_x_server(hands: Hands) -> None:
    def never() -> None:
        raise AssertionError

    def never_ends(_status: int, _is_restarted: bool) -> None:
        raise AssertionError

    assert hands.window.keyboard_filter.start_key_watcher(never, never_ends) is None
