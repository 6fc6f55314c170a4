"""Event filter for all keys and touches, which handles stop keys and delayed presses.

- Pause starts feed hold and Scroll Lock is the E-stop, with any modifier, lock and keyboard
  layout.
- H, Space and E do the same if no caret is visible.
- Esc starts feed hold while the machine moves, unless the page uses Esc.
- The filter tracks which other keys are physically down. A repeat is not a press. A key that
  was pressed while another window had the keyboard focus is ignored until it is released.
- A press that was delayed by a stall of the screen is processed in order but starts nothing
  (``app.desk.late_presses``). If an answer is dropped for this reason, the presses that follow
  without a pause are also dropped, because they relied on the answer. Keys and controls that
  stop something always act.
"""

from __future__ import annotations

from functools import partial
from typing import Protocol

import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, QObject, Qt
from PySide6.QtGui import (
    QEventPoint,
    QGuiApplication,
    QInputDevice,
    QInputEvent,
    QKeyEvent,
    QMouseEvent,
    QTouchEvent,
    QWindow,
)
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget

from app.desk.late_presses import BlockedLateAction
from app.desk.stop_keys.handled_presses import HandledPresses
from app.desk.stop_keys.key_codes import STOP_KEY_CODES
from app.desk.stop_keys.key_watcher_client import KeyWatcherClient, OpenStopChannel, ReportEnd
from app.desk.stop_keys.stop_records import SOURCE_ESC, FocusRecord, StopArea, StopKind, make_press_number
from app.screen.text_area.text_area import TextArea
from app.screen.window.input_times import InputTimes
from app.screen.window.key_table import (
    MODIFIER_KEYS,
    PC_PLATFORMS,
    find_letter,
    find_press_code,
    find_scan_code,
)
from app.screen.window.x_server import XServer, open_x_server

Key = Qt.Key
REPEAT_TIME_MS = 2  # Milliseconds: a press this soon after the release of the same key is a repeat.
_EDITING_KEYS = frozenset(
    {Key.Key_Backspace, Key.Key_Delete, Key.Key_Left, Key.Key_Right, Key.Key_Up, Key.Key_Down}
    | {Key.Key_Home, Key.Key_End, Key.Key_PageUp, Key.Key_PageDown}
)
_PRESS_EVENTS = frozenset(
    {QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick, QEvent.Type.TouchBegin, QEvent.Type.Wheel}
)
_TOUCH_END_EVENTS = frozenset({QEvent.Type.TouchEnd, QEvent.Type.TouchCancel})
_SHIFT_CODES = frozenset({50, 62})  # Key codes of both Shift keys.
_KEY_EVENTS = frozenset({QEvent.Type.KeyPress, QEvent.Type.KeyRelease})


class StopFunction(Protocol):
    """Function that stops the machine in response to a key.

    ``press`` is the number of the key press.
    """

    def __call__(self, *, press: int) -> None:
        """Stop the machine in response to the key press with the number ``press``."""
        ...


class KeyboardTarget(Protocol):
    """Interface through which the keyboard filter uses the main window."""

    def start_feed_hold(self, source: str = "", press: int = 0) -> None:
        """Start feed hold, regardless of the open page, input field or question.

        ``source`` names the key in the log. ``press`` is the number of the key press.
        """
        ...

    def press_estop(self, press: int = 0) -> None:
        """Press the E-stop, regardless of the open page, input field or question.

        ``press`` is the number of the key press.
        """
        ...

    def show_estop_pressed(self) -> None:
        """Show the simulated E-stop as pressed after the key watcher has pressed it."""
        ...

    def is_esc_stop_key(self) -> bool:
        """Return whether Esc starts feed hold now."""
        ...

    def has_text_field(self) -> bool:
        """Return whether an input field has the keyboard focus, so that characters are text."""
        ...

    def accepts_text(self, key: str) -> bool:
        """Return whether a character is passed to an input field."""
        ...

    def record_activity(self) -> None:
        """Record that the operator has pressed a key or touched the screen."""
        ...

    def set_event_late(self, *, is_late: bool) -> None:
        """Set whether the current event was delayed by a stall and must not start anything."""
        ...

    def has_screen_changed_since(self, time_s: float) -> bool:
        """Return whether the screen has changed after a time in seconds."""
        ...

    def report_dropped_press(self, action: BlockedLateAction) -> None:
        """Report a press that is not executed because a stall delayed it."""
        ...

    def is_stop_control_at(self, event: QInputEvent) -> bool:
        """Return whether a press at a position hits a control that stops something."""
        ...

    def is_page_stop_key(self, event: QKeyEvent) -> bool:
        """Return whether a key stops something on the current page, for example the spindle."""
        ...

    def find_stop_areas(self) -> tuple[StopArea, ...]:
        """Return the rectangles of the drawn controls that the key watcher watches."""
        ...


class KeyboardFilter(QObject):
    """Event filter on the windows of the application, with the rules in the docstring of the module."""

    def __init__(self, target: KeyboardTarget, input_times: InputTimes) -> None:
        super().__init__()
        self._behind, self.input_times = target, input_times
        self._server: XServer | None = None
        self._watched: KeyWatcherClient | None = None
        self._down: dict[int, int] = {}  # Scan codes of the keys that are down, with their key values.
        # Keys that are down but ignored: pressed for another purpose or at an unknown time.
        self._dead: set[int] = set()
        self._stops: set[int] = set()  # Stop keys that are down.
        self._shifts: set[int] = set()  # Codes of the Shift keys that are down, according to the events.
        self._up: dict[int, int] = {}  # Time stamp of the last release, by key.
        # Time when the X server reported a key as up before its release event arrived.
        self._known_up: dict[int, float] = {}
        self._sending = False
        self._stamp, self._whose = 0, ""  # Time stamp of the event that is being handled, and its clock.
        self._late = False  # The event waited during a stall.
        self._handled = HandledPresses()

    def filter_window_events(self, window: QWindow) -> None:
        """Install this filter on a window, so that it receives the events of the window."""
        window.removeEventFilter(self)
        window.installEventFilter(self)
        if self._server is None:
            self._server = open_x_server()

    def start_key_watcher(
        self, open_stop_channel: OpenStopChannel, report_end: ReportEnd
    ) -> KeyWatcherClient | None:
        """Start the key watcher, or return None if this is not possible.

        The key watcher needs an X server and a control in a separate process. ``report_end`` reports a key
        watcher that has ended.
        """
        line = open_stop_channel() if QGuiApplication.platformName() == "xcb" else None
        self._watched = KeyWatcherClient(line, open_stop_channel, report_end) if line is not None else None
        return self._watched

    @property
    def delay_s(self) -> float:
        """Return the delay of the current event, or the duration of the stall, in seconds."""
        return self.input_times.find_delay(self._stamp, self._whose)

    @property
    def event_time_s(self) -> float:
        """Return the time of the current event in monotonic seconds."""
        return self.input_times.find_event_time(self._stamp, self._whose)

    # --- pressed keys --------------------------------------------------------------------------------

    def is_only_key(self, event: QKeyEvent) -> bool:
        """Return whether no other key is down. Modifier keys are ignored."""
        return not {key for code, key in self._down.items() if code != find_scan_code(event)} - MODIFIER_KEYS

    def is_stop_key(self, event: QKeyEvent) -> bool:
        """Return whether this key stops the machine now."""
        return self._find_stop(event) is not None

    def is_stop_key_held(self) -> bool:
        """Return whether a stop key is still down, so that nothing may start."""
        self._stops &= self._down.keys()
        return bool(self._stops)

    def ignore_pressed_keys(self) -> None:
        """Ignore the pressed keys until they are released, because the window or page has changed."""
        self._dead |= self._down.keys()

    def read_pressed_keys(self) -> None:
        """Read which keys are down after the window has received the keyboard focus.

        These keys were pressed in another window, and are ignored until they are released.
        """
        if self._server is None:
            return
        held = self._server.read_pressed_keys()
        self._down = {code: self._down.get(code, Key.Key_Shift) for code in held}
        self._dead = set(held)

    def update(self) -> None:
        """Process stops that the key watcher has sent, and key releases that were lost.

        This is called once a frame. A release was lost if the X server reports that the key is physically
        up.
        """
        self._stamp = 0
        windows = QGuiApplication.topLevelWindows()
        if self._watched is not None:
            self._watched.check_process()
            self._send_focus(self._watched)
            if any(stop.stop_kind is StopKind.ESTOP for stop in self._watched.read_sent_stops()):
                self._behind.show_estop_pressed()
        for window in windows if len(windows) > 1 else ():
            window.installEventFilter(self)  # A menu or a dialog has its own window for key events.
        if self._server is None or not self._down:
            return
        for code in self._down.keys() - self._server.read_pressed_keys():
            key, dead = self._down.pop(code, None), code in self._dead
            self._dead.discard(code)
            self._known_up[code] = self.input_times.clock()
            if key is not None and not dead:  # Handling a release may call this method again.
                self._send(QKeyEvent(QEvent.Type.KeyRelease, key, Qt.KeyboardModifier.NoModifier))

    def complete_frame(self) -> None:
        """Record that a frame is complete, while no event is being handled, and inform the key watcher."""
        self._stamp = 0
        self._handled.complete_frame()
        if self._watched is not None:
            self._send_focus(self._watched)

    def _send_focus(self, watcher: KeyWatcherClient) -> None:
        """Send the key watcher which keys and drawn controls stop the machine now."""
        target, windows = self._behind, QGuiApplication.topLevelWindows()
        watcher.send_focus(
            FocusRecord(
                frozenset(window.winId() for window in windows if window.isVisible()),
                is_esc_stop_key=target.is_esc_stop_key(),
                stop_areas=target.find_stop_areas(),
                are_letters_stop_keys=bool(QGuiApplication.focusWindow()) and not target.has_text_field(),
                handled_press=self._handled.handled_press,
                received_press=self._handled.received_press,
            )
        )

    def is_mouse_button_held(self) -> bool:
        """Return whether a mouse button is physically still down."""
        if self._server is None:
            return QApplication.mouseButtons() is not Qt.MouseButton.NoButton
        return self._server.is_mouse_button_down()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Handle an event, and return whether it must not be passed on."""
        kind = event.type()
        if kind in _PRESS_EVENTS or kind in _KEY_EVENTS:
            self._behind.record_activity()
        if kind in _KEY_EVENTS and isinstance(event, QKeyEvent):
            return not self._sending and self._key(event)
        if not isinstance(event, QInputEvent):
            return False
        self._read_event_time(event)
        if isinstance(event, QTouchEvent):
            self._handled.is_pointer_down = kind not in _TOUCH_END_EVENTS
        elif isinstance(event, QMouseEvent):
            self._handled.is_pointer_down = event.buttons() is not Qt.MouseButton.NoButton
        pressed = kind in _PRESS_EVENTS or (
            isinstance(event, QTouchEvent)
            and any(point.state() == QEventPoint.State.Pressed for point in event.points())
        )
        return pressed and self._handle_screen_press(event)

    def _read_event_time(self, event: QInputEvent) -> None:
        """Record the time of an event, and whether a stall delayed it."""
        self.input_times.record_input()
        self._stamp, self._whose = event.timestamp(), _find_clock(event)
        self._late = self.input_times.was_delayed(self._stamp, self._whose)
        self._behind.set_event_late(is_late=self._late)

    def _handle_screen_press(self, event: QInputEvent) -> bool:
        """Handle a mouse press or touch. Return True if the press is discarded."""
        self._handled.record_press(make_press_number(find_press_code(event), self._stamp))
        if self._behind.is_stop_control_at(event):
            return False
        if self._relies_on_dropped():
            starting = BlockedLateAction.FOLLOWING_KEY
        elif self._late and self._behind.has_screen_changed_since(self.event_time_s):
            starting = BlockedLateAction.TOUCH
        else:
            return False
        event.setAccepted(True)  # Otherwise Qt sends the touch again as a mouse event.
        return self._forget(starting)

    def _key(self, event: QKeyEvent) -> bool:
        self._read_event_time(event)
        code = find_scan_code(event)
        if event.key() == Key.Key_Shift:
            (self._shifts.discard if event.type() == QEvent.Type.KeyRelease else self._shifts.add)(code)
        if event.type() == QEvent.Type.KeyRelease:
            return self._released(event, code)
        self._handled.record_press(make_press_number(code, self._stamp))
        stop = self._find_stop(event)
        if stop is not None:
            self._down.setdefault(code, event.key())
            self._dead.add(code)
            self._stops.add(code)
            stop(press=make_press_number(code, self._stamp))
            return True
        return event.key() not in MODIFIER_KEYS and self._pressed(event, code)

    def _pressed(self, event: QKeyEvent, code: int) -> bool:
        if self._is_repeat_overtaken(code) and (self._late or not self._is_writing(event)):
            return True
        repeat = self._is_repeat(event, code)
        if code in self._dead or (repeat and self._late):  # The original press was not seen.
            return True
        if self._relies_on_dropped() and not self._behind.is_page_stop_key(event):
            self._dead.add(code)
            return repeat or self._forget(BlockedLateAction.FOLLOWING_KEY)
        if repeat and not event.isAutoRepeat():
            return self._send_repeat(event)
        return self._is_shift_latched(event) and self._send(_copy_event(event, repeat=repeat, shift=False))

    def _is_repeat_overtaken(self, code: int) -> bool:
        """Return whether a press is older than the X server's report that its key is up.

        Such a press is an auto-repeat that arrived late.
        """
        said = self._known_up.get(code)
        if said is None or not self._stamp:
            return False
        if self.input_times.find_event_time(self._stamp, self._whose) <= said:
            return True
        del self._known_up[code]
        return False

    def _is_shift_latched(self, event: QKeyEvent) -> bool:
        """Return whether Shift is active only because it is locked or sticky, and not pressed.

        Such a Shift is ignored for keys that produce no text.
        """
        shift = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if self._server is None or not shift or event.text():
            return False
        return not (self._shifts if self._late else self._server.read_pressed_keys() & _SHIFT_CODES)

    def _released(self, event: QKeyEvent, code: int) -> bool:
        if event.isAutoRepeat():
            return False
        self._up[code] = self._stamp
        self._known_up.pop(code, None)
        dead = code in self._dead
        self._down.pop(code, None)
        self._dead.discard(code)
        return dead and event.key() not in MODIFIER_KEYS

    def _is_repeat(self, event: QKeyEvent, code: int) -> bool:
        """Record a key press, and return whether it is an auto-repeat.

        Under X, Qt's repeat flag is not reliable.
        """
        if code in self._down:
            if not event.isAutoRepeat() and self._server is None:
                self._dead.discard(code)  # Another window got its release event.
                return False
            return True
        self._down[code] = event.key()
        if event.isAutoRepeat() or self._is_paired(code):
            self._dead.add(code)  # The press itself was not seen.
            return True
        return False

    def _is_paired(self, code: int) -> bool:
        """Return whether a press and the release just before it are an auto-repeat of a key held down.

        Some X servers send repeats as such pairs.
        """
        has_repeat_reports = self._server is not None and self._server.reports_repeats
        return (
            not has_repeat_reports
            and bool(self._stamp)
            and abs(self._stamp - self._up.get(code, -1000)) <= REPEAT_TIME_MS
        )

    def _find_stop(self, event: QKeyEvent) -> StopFunction | None:
        """Return the stop function of a key, or None if the key does not stop the machine."""
        is_pc = QApplication.platformName() in PC_PLATFORMS
        place = STOP_KEY_CODES.get(event.nativeScanCode()) if is_pc else None
        key, letter = event.key(), find_letter(event)
        if (
            key == Key.Key_ScrollLock
            or place is StopKind.ESTOP
            or (letter == "E" and self._is_letter_stop(event))
        ):
            return self._behind.press_estop
        holds = key in {Key.Key_Pause, Key.Key_Cancel} or place is StopKind.HOLD
        holds = holds or ((letter == "H" or key == Key.Key_Space) and self._is_letter_stop(event))
        if key == Key.Key_Escape and (self._behind.is_esc_stop_key() or self._was_sent(event)):
            return partial(self._behind.start_feed_hold, SOURCE_ESC)
        return self._behind.start_feed_hold if holds else None

    def _was_sent(self, event: QKeyEvent) -> bool:
        """Return whether the key watcher has already sent this key press to the control."""
        press = make_press_number(find_scan_code(event), self._stamp)
        return self._watched is not None and self._watched.was_press_sent(press)

    def _is_letter_stop(self, event: QKeyEvent) -> bool:
        """Return whether a character stops the machine.

        While a caret is visible, no character does, because every character is text. A character does that
        the key watcher has already sent to the control.
        """
        return not self._behind.has_text_field() or self._was_sent(event)

    def _relies_on_dropped(self) -> bool:
        return self.input_times.follows_dropped_answer(self._stamp, self._whose)

    def record_dropped_answer(self) -> None:
        """Record that the current press was an answer to a question and was dropped."""
        self.input_times.record_dropped_answer(self._stamp, self._whose)

    def _forget(self, starting: BlockedLateAction) -> bool:
        if starting is BlockedLateAction.FOLLOWING_KEY:
            self.record_dropped_answer()
        self._behind.report_dropped_press(starting)
        return True

    def _is_writing(self, event: QKeyEvent) -> bool:
        """Return whether a key only enters or edits text."""
        text = event.text()
        if len(text) == 1 and text.isprintable():
            return self._behind.accepts_text(text)
        return event.key() in _EDITING_KEYS and _find_focus_field() is not None

    def _send_repeat(self, event: QKeyEvent) -> bool:
        """Pass a key on as a repeat.

        In a standard text field, only editing keys repeat.
        """
        field = _find_focus_field()
        if field is not None and not (
            event.key() in _EDITING_KEYS or self._is_writing(event) or _inserts_break(field, event)
        ):
            return True
        return self._send(_copy_event(event, repeat=True, shift=not self._is_shift_latched(event)))

    def _send(self, event: QKeyEvent) -> bool:
        window = QApplication.focusWindow()
        self._sending = True
        try:
            if isinstance(window, QWindow):
                QCoreApplication.sendEvent(window, event)
        finally:
            self._sending = False
        return True


def _copy_event(event: QKeyEvent, *, repeat: bool, shift: bool) -> QKeyEvent:
    """Return a copy of a key event, with or without its repeat flag and Shift."""
    modifiers = event.modifiers()
    if not shift:
        modifiers &= ~Qt.KeyboardModifier.ShiftModifier
    codes = (event.nativeScanCode(), event.nativeVirtualKey(), event.nativeModifiers())
    return QKeyEvent(event.type(), event.key(), modifiers, *codes, event.text(), repeat, event.count())


def _find_clock(event: QInputEvent) -> str:
    """Return the name of the clock of an event's time stamp.

    Touches may use a different clock.
    """
    return "touch" if event.deviceType() is QInputDevice.DeviceType.TouchScreen else ""


def _find_focus_field() -> QWidget | None:
    """Return the standard text field that has the keyboard focus, or None."""
    at = QApplication.focusWidget()
    return at if isinstance(at, QLineEdit | TextArea) and shiboken6.isValid(at) else None


def _inserts_break(field: QWidget, event: QKeyEvent) -> bool:
    """Return whether the key inserts a line break or tab in a multi-line text field."""
    return isinstance(field, TextArea) and event.key() in {Key.Key_Return, Key.Key_Enter, Key.Key_Tab}
