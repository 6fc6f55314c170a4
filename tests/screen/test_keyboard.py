"""The keyboard layer without a server: stops, repeats, dead keys, stalls, answers."""

from __future__ import annotations

import itertools

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QKeyEvent, QWindow
from PySide6.QtWidgets import QApplication

from app.screen import page_table
from app.screen.window.input_times import FRAMES_AFTER_STALL, STALL_TIME_S, InputTimes
from app.screen.window.main_window import MainWindow
from core.executor.commands import FeedHold
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands, Key
from tests.screen.yes import read
from tests.texts import shows

NONE = Qt.KeyboardModifier.NoModifier
SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
ALT, META = Qt.KeyboardModifier.AltModifier, Qt.KeyboardModifier.MetaModifier
MODIFIERS = [a | b | c for a, b, c in itertools.product((NONE, SHIFT), (NONE, CTRL), (NONE, ALT, META))]


def window_of(hands: Hands) -> QWindow:
    """What the platform sends keys to."""
    handle = hands.window.windowHandle()
    assert handle is not None
    return handle


def send(
    hands: Hands,
    key: Key,
    *,
    up: bool = False,
    text: str = "",
    modifiers: Qt.KeyboardModifier = NONE,
    repeat: bool = False,
    at: int = 0,
) -> None:
    """A key as the platform brings it, with a time stamp."""
    kind = QEvent.Type.KeyRelease if up else QEvent.Type.KeyPress
    event = QKeyEvent(kind, key, modifiers, text, repeat)
    event.setTimestamp(at)
    QCoreApplication.sendEvent(window_of(hands), event)


@pytest.fixture
def watched(hands: Hands) -> Hands:
    """A window that sits in front and has the keyboard."""
    hands.sees(lambda: QApplication.focusWindow() is window_of(hands))
    return hands


@pytest.mark.parametrize("modifiers", MODIFIERS)
@pytest.mark.parametrize("key", [Key.Key_Pause, Key.Key_H, Key.Key_Space])
def test_feed_hold_acts_with_every_modifier(watched: Hands, key: Key, modifiers: Qt.KeyboardModifier) -> None:
    send(watched, key, modifiers=modifiers)
    assert watched.machine.posted[-1] == FeedHold()


@pytest.mark.parametrize("modifiers", MODIFIERS)
@pytest.mark.parametrize("key", [Key.Key_ScrollLock, Key.Key_E])
def test_estop_acts_with_every_modifier(watched: Hands, key: Key, modifiers: Qt.KeyboardModifier) -> None:
    for _ in range(3):  # nor does it free itself
        send(watched, key, modifiers=modifiers)
        assert watched.desk.station_controls.is_estop_pressed


def test_stop_key_acts_despite_lost_release(watched: Hands) -> None:
    for _ in range(3):  # its releases were lost
        send(watched, Key.Key_Pause)
    assert watched.machine.posted.count(FeedHold()) == 3


def test_start_is_blocked_while_stop_key_is_down(watched: Hands) -> None:
    watched.load("pin")
    send(watched, Key.Key_Pause)
    watched.both_palms()
    assert watched.machine.now.state is MachineState.IDLE
    assert shows(watched.desk.prompt_notice, "screen.stopping-key-held")
    send(watched, Key.Key_Pause, up=True)
    watched.both_palms()
    watched.sees_state(MachineState.RUN)


def test_press_immediately_after_release_is_a_repeat(watched: Hands) -> None:
    send(watched, Key.Key_S, text="s", at=10_000)
    for at in range(10_400, 11_000, 40):  # a server that was not asked to tell repeats
        send(watched, Key.Key_S, up=True, at=at)
        send(watched, Key.Key_S, text="s", at=at)
    send(watched, Key.Key_S, up=True, at=11_000)
    assert watched.machine.now.single_block
    send(watched, Key.Key_S, text="s", at=11_400)
    assert not watched.machine.now.single_block


class Server:
    """An X server that tells repeats as presses, and which keys are down."""

    reports_repeats = True
    held: frozenset[int] = frozenset({int(Key.Key_S)})

    def read_pressed_keys(self) -> frozenset[int]:
        return self.held

    def has_button_down(self) -> bool:
        return False


def test_repeat_overtaken_by_release_is_not_a_press(watched: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    server, keyboard = Server(), watched.window.keyboard_filter
    monkeypatch.setattr("app.screen.window.keyboard.open_x_server", lambda: server)
    keyboard.filter_window_events(window_of(watched))
    now = [keyboard.input_times.clock()]
    monkeypatch.setattr(keyboard.input_times, "clock", lambda: now[0])
    send(watched, Key.Key_S, text="s", at=10_000)
    assert watched.machine.now.single_block
    now[0] += 0.1
    server.held = frozenset()
    keyboard.update()  # up, says the server; two repeats and the release are still to come
    for at in (10_040, 10_080):
        send(watched, Key.Key_S, text="s", at=at)
    assert watched.machine.now.single_block
    now[0] += 0.2
    send(watched, Key.Key_S, up=True, at=10_090)
    now[0] += 0.2
    send(watched, Key.Key_S, text="s", at=10_400)  # and this is a press
    assert not watched.machine.now.single_block


def test_repeat_without_press_is_ignored(watched: Hands) -> None:
    send(watched, Key.Key_S, text="s", repeat=True)
    send(watched, Key.Key_S, text="s", repeat=True)
    assert not watched.machine.now.single_block
    send(watched, Key.Key_S, up=True)
    send(watched, Key.Key_S, text="s")
    assert watched.machine.now.single_block


def test_key_down_since_another_page_is_ignored(watched: Hands) -> None:
    send(watched, Key.Key_S, text="s")
    watched.frame.open_page(page_table.MENU)
    watched.window.refresh()
    watched.frame.open_page(page_table.AUTOMATIC)
    watched.window.refresh()
    send(watched, Key.Key_S, text="s", repeat=True)
    assert watched.machine.now.single_block  # from the press, and turned once


def test_answer_key_is_ignored_while_another_key_is_down(watched: Hands) -> None:
    said: list[str] = []
    watched.desk.ask_operator("PRESS Y", lambda: said.append("yes"))
    read(watched.desk)
    send(watched, Key.Key_R, text="r")  # asks something else? it is down, in any case
    watched.desk.ask_operator("PRESS Y", lambda: said.append("yes"))
    read(watched.desk)
    send(watched, Key.Key_Y, text="y")
    send(watched, Key.Key_Y, up=True)
    assert said == []
    send(watched, Key.Key_R, up=True)
    send(watched, Key.Key_Y, text="y")
    assert said == ["yes"]


def test_question_is_answered_by_touch_on_prompt_line(watched: Hands) -> None:
    said: list[str] = []
    watched.desk.ask_operator("PRESS Y TO DO IT", lambda: said.append("yes"))
    watched.window.refresh()
    assert watched.frame.prompt_line.confirm_key == "Y"
    watched.window.press_key("Yes")
    assert said == []  # a double tap is quicker than any reading
    assert not watched.desk.confirmation_key
    watched.desk.ask_operator("PRESS Y TO DO IT", lambda: said.append("yes"))
    read(watched.desk)
    watched.window.press_key("Yes")
    assert said == ["yes"]


class Time:
    """Of the test's own."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.mark.usefixtures("stalls")
def test_event_queued_during_stall_is_late() -> None:
    time = Time()
    times = InputTimes(time)
    for _ in range(3):
        time.now += 0.016
        times.frame()
    assert not times.was_delayed(50_000)  # the stamps count from somewhere else: now
    before, during = 50_100, 52_900
    time.now += 3.0
    times.record_input()
    assert times.was_delayed(before)
    assert times.was_delayed(during)
    for _ in range(FRAMES_AFTER_STALL):
        time.now += 0.016
        times.frame()
    assert times.was_delayed(during)
    assert not times.was_delayed(50_000 + round(1000 * 3.0 + 32))
    assert times.stall_duration_s == pytest.approx(3.0)


@pytest.mark.usefixtures("stalls")
def test_delayed_event_is_late_without_stall() -> None:
    time = Time()
    times = InputTimes(time)
    assert not times.was_delayed(50_000)
    for _ in range(100):
        time.now += 0.01
        times.frame()
    assert not times.was_delayed(51_000 - round(900 * STALL_TIME_S))
    assert times.was_delayed(51_000 - round(1100 * STALL_TIME_S))


@pytest.mark.usefixtures("stalls")
def test_touch_events_with_different_clock_are_not_always_late() -> None:
    time = Time()
    times = InputTimes(time)
    assert not times.was_delayed(50_000)  # keys and mouse
    for _ in range(100):
        time.now += 0.01
        times.frame()
    assert not times.was_delayed(20_000, "touch")  # counts from elsewhere, a second of it behind
    time.now += 0.01
    assert not times.was_delayed(20_010, "touch")
    assert times.was_delayed(20_010 - round(1100 * STALL_TIME_S), "touch")
    assert not times.was_delayed(51_010)


@pytest.mark.usefixtures("stalls")
def test_timestamp_overflow_is_not_a_stall() -> None:
    time = Time()
    times = InputTimes(time)
    assert not times.was_delayed(2**32 - 5)
    time.now += 0.02
    assert not times.was_delayed(15)
    assert times.find_event_time(15) == pytest.approx(time.now, abs=0.01)


def stopped_clock(hands: Hands) -> int:
    """Nothing is late by itself on a busy computer: only the stamps tell. The stamp of now."""
    hands.window.input_times.clock = Time()
    return round(1000 * Time.now)


def test_palm_buttons_too_far_apart_by_event_time_are_invalid(watched: Hands) -> None:
    watched.load("pin")
    now = stopped_clock(watched)
    send(watched, Key.Key_F5, at=now)
    send(watched, Key.Key_F11, at=now - 280)  # both within what is not late
    watched.desk.station_controls.palms.press_times["left"] -= 0.4
    send(watched, Key.Key_F12, at=now)
    assert watched.desk.station_controls.palms.is_pair_invalid
    assert watched.machine.now.state is MachineState.IDLE


def test_keyboard_filter_works_after_window_is_shown_again(watched: Hands) -> None:
    assert isinstance(watched.window, MainWindow)
    watched.window.hide()
    watched.window.show()
    send(watched, Key.Key_Pause)
    assert watched.machine.posted[-1] == FeedHold()
    assert watched.machine.posted.count(FeedHold()) == 1


@pytest.mark.parametrize(
    "name", [page_table.SECCMP, page_table.TOOLS, page_table.SPECIAL, page_table.PROGRAMS]
)
def test_esc_leaves_offset_and_list_pages_without_feed_hold(watched: Hands, name: str) -> None:
    watched.load("pin")
    watched.both_palms()
    watched.sees_state(MachineState.RUN)
    watched.frame.open_page(name)
    watched.window.refresh()
    send(watched, Key.Key_Escape)
    assert watched.frame.current_page.NAME == page_table.AUTOMATIC
    assert FeedHold() not in watched.machine.posted
    watched.frame.open_page(name)
    send(watched, Key.Key_Pause)
    assert watched.machine.posted[-1] == FeedHold()


def test_letters_on_offset_page_are_text_and_stop_nothing(watched: Hands) -> None:
    watched.frame.open_page(page_table.SECCMP)
    watched.window.refresh()
    before = len(watched.machine.posted)
    for letter in "hebevelcap":
        send(watched, Key(ord(letter.upper())), text=letter)
        send(watched, Key(ord(letter.upper())), text=letter, up=True)
    assert watched.machine.posted[before:] == []
    assert not watched.desk.station_controls.is_estop_pressed
