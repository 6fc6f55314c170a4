"""Keys and touches behind a stall: done in their order, and what starts something is dropped and named."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.late_presses import BlockedLateAction, get_starting_action_name
from app.jog.jog_view import JogPage
from app.screen import page_table
from app.screen.window.input_times import FRAMES_AFTER_STALL, PAUSE_TIME_S
from core.executor.commands import (
    ConfirmStart,
    CycleStart,
    EnableDrives,
    FeedHold,
    Jog,
    JogByStep,
    SetSwitch,
    StopSpindle,
)
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands, Key
from tests.screen.test_keyboard import SHIFT, Time, send, window_of
from tests.screen.yes import read
from tests.texts import shows

STALLED = 2.0  # s


class Stall:
    """The screen stood still for two seconds; ``ms`` after its begin keys are pressed."""

    def __init__(self, hands: Hands) -> None:
        self.hands, self.time = hands, Time()
        hands.window.input_times.clock = hands.desk.station_controls.clock = (
            hands.desk.window_state.late_presses.read_time_s
        ) = self.time
        send(hands, Key.Key_F5, at=round(1000 * self.time.now))  # the stamps are of our own clock
        send(hands, Key.Key_F5, up=True, at=round(1000 * self.time.now))
        hands.window._faces.append((0.0, hands.frame.screen_context))
        self.frames()
        self.begun = self.time.now
        hands.machine.posted.clear()

    def ends(self) -> None:
        self.time.now = self.begun + STALLED

    def press(self, key: Key, ms: int, text: str = "", *, up: bool = True) -> None:
        """A key goes down so long after the begin of the stall, and comes up at once."""
        at = round(1000 * self.begun) + ms
        send(self.hands, key, text=text, at=at)
        if up:
            send(self.hands, key, text=text, up=True, at=at + 1)

    def type(self, text: str, ms: int) -> None:
        """Letters behind each other."""
        for number, letter in enumerate(text):
            self.press(Key(ord(letter.upper())), ms + 10 * number, letter)

    def touch_f2(self, ms: int) -> None:
        """Click F2 where it was drawn."""
        keys = self.hands.frame.key_bar
        self.click(keys, keys.list_targets()[1].box.center(), ms)

    def click(self, part: QWidget, place: QPointF, ms: int) -> None:
        """Click on a part of the window, so long after the begin of the stall."""
        window = self.hands.window
        at = QPointF(part.mapTo(window, place.toPoint()))
        left, none = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
        for kind, buttons in (
            (QEvent.Type.MouseButtonPress, left),
            (QEvent.Type.MouseButtonRelease, Qt.MouseButton.NoButton),
        ):
            event = QMouseEvent(kind, at, window.mapToGlobal(at), left, buttons, none)
            event.setTimestamp(round(1000 * self.begun) + ms)
            QCoreApplication.sendEvent(window_of(self.hands), event)

    def frames(self, count: int = FRAMES_AFTER_STALL, seconds: float = 0.016) -> None:
        for _ in range(count):
            self.time.now += seconds
            self.hands.window.input_times.frame()
            self.hands.window.set_event_late(is_late=False)

    def told(self, *names: BlockedLateAction) -> bool:
        """Whether these were reported as not done."""
        answer = self.hands.desk.prompt_line.message
        return shows(
            answer, "screen.screen-stood-still", what=", ".join(map(get_starting_action_name, names))
        )


@pytest.fixture
def stall(hands: Hands, stalls: None) -> Stall:
    hands.sees(lambda: QApplication.focusWindow() is window_of(hands))
    return Stall(hands)


def starts_of(stall: Stall) -> list[object]:
    kinds = (CycleStart, EnableDrives, Jog, JogByStep, ConfirmStart)
    return [each for each in stall.hands.machine.posted if isinstance(each, kinds)]


# --- what is done -------------------------------------------------------------------------------------------


def test_late_keys_open_field_and_type_text_in_order(stall: Stall) -> None:
    hands = stall.hands
    stall.ends()
    stall.press(Key.Key_F2, 100)
    stall.type("spoc", 200)
    assert hands.page.file_prompt.isVisible()
    assert hands.machine.posted == []  # no letter was a command
    stall.press(Key.Key_Escape, 400)
    assert not hands.page.file_prompt.isVisible()
    assert not hands.desk.prompt_line.message


def test_late_page_keys_act_in_order(stall: Stall) -> None:
    hands = stall.hands
    stall.ends()
    stall.press(Key.Key_F1, 100)
    assert hands.frame.current_page.NAME == page_table.MENU
    stall.press(Key.Key_F8, 200)
    stall.press(Key.Key_F1, 300)
    assert hands.frame.current_page.NAME == page_table.MENU
    assert not hands.desk.prompt_line.message


def test_switch_pressed_twice_in_stall_switches_twice(stall: Stall) -> None:
    stall.ends()
    for ms in (100, 200, 300):
        stall.press(Key.Key_S, ms, "s")
    posted = [each for each in stall.hands.machine.posted if isinstance(each, SetSwitch)]
    assert [each.on for each in posted] == [True, False, True]


def test_shift_pressed_in_stall_applies_to_its_key(stall: Stall) -> None:
    class Server:
        reports_repeats = True

        def read_pressed_keys(self) -> frozenset[int]:
            return frozenset()  # all were let go by now

        def has_button_down(self) -> bool:
            return False

    keyboard = stall.hands.window.keyboard_filter
    keyboard._server = Server()  # type: ignore[assignment]
    stall.ends()
    at = round(1000 * stall.begun) + 100
    send(stall.hands, Key.Key_Shift, modifiers=SHIFT, at=at)
    send(stall.hands, Key.Key_F10, modifiers=SHIFT, at=at + 50)
    assert stall.hands.frame.current_page.NAME == page_table.SCOPE


def test_auto_repeats_from_stall_are_ignored(stall: Stall) -> None:
    hands = stall.hands
    hands.frame.open_page(page_table.PROGRAMS)
    hands.window.refresh()
    stall.ends()
    for ms in range(100, 600, 40):
        send(hands, Key.Key_A, text="a", at=round(1000 * stall.begun) + ms, repeat=ms > 100)
    assert hands.frame.current_page.model.search_field.text == "a"  # type: ignore[attr-defined]


def test_late_touch_on_unchanged_target_acts(stall: Stall) -> None:
    stall.ends()
    stall.touch_f2(500)
    assert stall.hands.page.file_prompt.isVisible()
    assert not stall.hands.desk.prompt_line.message


# --- what is not done ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("later", [0, 1200])
def test_late_palm_buttons_start_nothing(stall: Stall, later: int) -> None:
    hands = stall.hands
    hands.load("pin")
    stall = Stall(hands)
    stall.ends()
    stall.press(Key.Key_F11, 300, up=False)
    stall.press(Key.Key_F12, 300 + later, up=False)
    assert starts_of(stall) == []
    assert not hands.desk.station_controls.palms.press_times
    assert not hands.machine.palms
    assert stall.told(BlockedLateAction.CYCLE)


def test_palm_buttons_pressed_in_and_after_stall_are_not_a_pair(stall: Stall) -> None:
    hands = stall.hands
    hands.load("pin")
    stall = Stall(hands)
    stall.ends()
    stall.press(Key.Key_F11, 1900, up=False)
    stall.frames(20)
    stall.press(Key.Key_F12, 2310, up=False)
    assert hands.machine.now.state is MachineState.IDLE


def test_late_drives_key_is_dropped_and_following_key_acts(stall: Stall) -> None:
    hands = stall.hands
    hands.machine.now = type(hands.machine.now)(state=MachineState.DISABLED)
    hands.window.refresh()
    stall.ends()
    stall.press(Key.Key_D, 100, "d")
    stall.press(Key.Key_S, 200, "s")
    assert starts_of(stall) == []
    assert hands.machine.now.state is MachineState.DISABLED
    assert hands.machine.now.single_block
    assert stall.told(BlockedLateAction.DRIVES)


def test_one_message_names_all_dropped_keys(stall: Stall) -> None:
    hands = stall.hands
    hands.machine.now = type(hands.machine.now)(state=MachineState.DISABLED)
    hands.window.refresh()
    stall.ends()
    stall.press(Key.Key_D, 100, "d")
    stall.press(Key.Key_F11, 200)
    stall.press(Key.Key_F12, 250)
    assert stall.told(BlockedLateAction.DRIVES, BlockedLateAction.CYCLE)
    for passed in (2.0, 1.9):
        stall.time.now += passed
        hands.desk.say("THE ANSWER TO ANOTHER KEY")
        hands.window.refresh()
        assert stall.told(BlockedLateAction.DRIVES, BlockedLateAction.CYCLE)
    hands.desk.ask_operator("A QUESTION IS NEVER HIDDEN", lambda: None)
    hands.window.refresh()
    assert hands.frame.prompt_line.question_text == "A QUESTION IS NEVER HIDDEN"
    stall.time.now += 0.2
    hands.window.refresh()
    assert hands.frame.prompt_line.message_text == "THE ANSWER TO ANOTHER KEY"  # it waited for the warning
    assert hands.frame.prompt_line.question_text == "A QUESTION IS NEVER HIDDEN"


@pytest.fixture
def asked(stall: Stall) -> Callable[[], list[str]]:
    """A question was asked and read before the stall; the answers to it."""
    said: list[str] = []
    stall.hands.desk.ask_operator("PRESS Y", lambda: said.append("yes"))
    read(stall.hands.desk)
    stall.hands.window.refresh()
    return lambda: said


def test_late_yes_key_does_not_answer_question(stall: Stall, asked: Callable[[], list[str]]) -> None:
    stall.ends()
    stall.press(Key.Key_Y, 500, "y")
    assert asked() == []
    assert stall.hands.desk.confirmation_key == "Y"  # it stands
    assert stall.told(BlockedLateAction.YES)


def test_late_touch_on_yes_does_not_answer_question(stall: Stall, asked: Callable[[], list[str]]) -> None:
    stall.ends()
    stall.hands.window.set_event_late(is_late=True)
    stall.hands.window.press_key("Yes")
    assert asked() == []


def test_late_no_cancels_question(stall: Stall, asked: Callable[[], list[str]]) -> None:
    stall.ends()
    stall.press(Key.Key_N, 500, "n")
    assert asked() == []
    assert not stall.hands.desk.confirmation_key


@pytest.mark.parametrize("later", [100, 1300])
def test_key_pressed_after_dropped_answer_is_dropped_too(
    stall: Stall, asked: Callable[[], list[str]], later: int
) -> None:
    hands = stall.hands
    stall.ends()
    stall.press(Key.Key_Y, 300, "y")
    stall.press(Key.Key_F2, 300 + later)
    stall.press(Key.Key_S, 320 + later, "s")
    assert asked() == []
    assert not hands.page.file_prompt.isVisible()
    assert not hands.machine.now.single_block
    assert stall.told(BlockedLateAction.YES, BlockedLateAction.FOLLOWING_KEY)


def test_keys_act_again_after_pause_following_dropped_answer(
    stall: Stall, asked: Callable[[], list[str]]
) -> None:
    hands = stall.hands
    stall.ends()
    stall.press(Key.Key_Y, 1900, "y")
    stall.frames(4, 0.05)
    stall.press(Key.Key_S, 2190, "s")  # typed on without a look
    assert not hands.machine.now.single_block
    stall.frames(30, 0.05)
    stall.press(Key.Key_S, round(2190 + 1000 * PAUSE_TIME_S + 100), "s")
    assert hands.machine.now.single_block
    assert asked() == []


@pytest.mark.usefixtures("asked")
def test_estop_key_acts_after_dropped_answer(stall: Stall) -> None:
    stall.ends()
    stall.press(Key.Key_Y, 300, "y")
    stall.press(Key.Key_Pause, 400)
    assert stall.hands.machine.posted == [FeedHold()]
    stall.press(Key.Key_ScrollLock, 500)
    assert stall.hands.desk.station_controls.is_estop_pressed


@pytest.mark.usefixtures("asked")
def test_spindle_stop_key_of_jog_page_acts_after_dropped_answer(stall: Stall) -> None:
    stall.hands.frame.open_page(page_table.JOG)
    stall.hands.machine.posted.clear()
    stall.ends()
    stall.press(Key.Key_Y, 300, "y")
    stall.press(Key.Key_1, 350, "1")  # FORWARD is dropped.
    stall.press(Key.Key_0, 400, "0")
    assert [each for each in stall.hands.machine.posted if isinstance(each, StopSpindle)] == [StopSpindle()]
    page = stall.hands.frame.current_page
    assert isinstance(page, JogPage)
    assert not page.model.manual_functions.selected_function


def test_zero_as_digit_of_entry_is_dropped_after_dropped_answer(stall: Stall) -> None:
    stall.hands.frame.open_page(page_table.JOG)
    page = stall.hands.frame.current_page
    assert isinstance(page, JogPage)
    page.model.manual_functions.ask_spindle_speed()
    stall.hands.desk.ask_operator("PRESS Y", lambda: None)
    read(stall.hands.desk)
    stall.hands.machine.posted.clear()
    stall.ends()
    stall.press(Key.Key_Y, 300, "y")
    stall.press(Key.Key_0, 400, "0")
    assert page.model.manual_functions.text == ""
    assert StopSpindle() not in stall.hands.machine.posted


@pytest.mark.parametrize("key", [Key.Key_Pause, Key.Key_H, Key.Key_Space])
def test_late_feed_hold_always_acts(stall: Stall, key: Key) -> None:
    stall.ends()
    stall.press(key, 100)
    assert stall.hands.machine.posted == [FeedHold()]
    assert not stall.hands.desk.prompt_line.message


def test_late_touch_on_changed_screen_is_dropped(stall: Stall) -> None:
    hands = stall.hands
    stall.ends()
    stall.press(Key.Key_F1, 100)  # done: another page
    stall.touch_f2(500)
    assert hands.frame.current_page.NAME == page_table.MENU
    assert stall.told(BlockedLateAction.TOUCH)


@pytest.mark.parametrize("label", ["SPINDLE STOP", "FORWARD"])
def test_late_touch_on_changed_jog_page_acts_only_on_spindle_stop(stall: Stall, label: str) -> None:
    hands = stall.hands
    hands.frame.open_page(page_table.JOG)
    page = hands.frame.current_page
    assert isinstance(page, JogPage)
    page.model.toggle_manual_functions()
    hands.window.refresh()
    page.manual_panel.grab()
    hands.machine.posted.clear()
    stall.ends()
    boxes = {page.manual_panel.describe_target(each): each.box for each in page.manual_panel.list_targets()}
    (box,) = [box for name, box in boxes.items() if label in name]
    stall.click(page.manual_panel, box.center(), 500)
    assert [type(each) for each in hands.machine.posted if isinstance(each, StopSpindle)] == (
        [StopSpindle] if label == "SPINDLE STOP" else []
    )
    assert not page.model.manual_functions.selected_function
    assert stall.told(BlockedLateAction.TOUCH) is (label != "SPINDLE STOP")


def test_late_touch_on_help_over_spindle_stop_is_dropped(stall: Stall) -> None:
    hands = stall.hands
    hands.frame.open_page(page_table.JOG)
    page = hands.frame.current_page
    assert isinstance(page, JogPage)
    page.model.toggle_manual_functions()
    hands.window.refresh()
    page.manual_panel.grab()
    (stop,) = [each for each in page.manual_panel.controls if each.stops_machine]
    hands.frame.show_help()
    hands.machine.posted.clear()
    stall.ends()
    stall.click(page.manual_panel, stop.box.center(), 500)
    assert StopSpindle() not in hands.machine.posted
    assert stall.told(BlockedLateAction.TOUCH)


def test_late_start_by_mouse_is_dropped(stall: Stall) -> None:
    hands = stall.hands
    hands.machine.now = type(hands.machine.now)(state=MachineState.DISABLED)
    hands.window.refresh()
    stall.ends()
    hands.window.set_event_late(is_late=True)
    hands.window.press_key("D")  # as its lamp does it
    assert starts_of(stall) == []
    assert stall.told(BlockedLateAction.DRIVES)
