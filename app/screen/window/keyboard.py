"""Event filter for all keys and touches, which handles stop keys and late presses.

Pause starts feed hold and Scroll Lock is the E-stop, with any modifier, lock and keyboard layout. H, Space
and E do the same if no caret is visible. Esc starts feed hold while the machine moves, unless the page uses
Esc. The filter tracks which other keys are really down. A repeat is not a press. A key that was pressed while
another window had the keyboard is dead until its release. A press that waited during a stall of the screen is
executed in order but starts nothing (``app.desk.late_presses``). If an answer is dropped for this reason, the
presses that follow without a pause are also dropped, because they relied on the answer.
"""

from __future__ import annotations

import time
from collections.abc import Callable
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
    QTouchEvent,
    QWindow,
)
from PySide6.QtWidgets import QApplication, QLineEdit, QPlainTextEdit, QWidget

from app.desk.late_presses import Starting
from app.desk.stop_keys.stop_records import BY_ESC, Focus, StopKind, press_number
from app.desk.stop_keys.watched_keys import OpenLine, WatchedKeys
from app.screen.window.x_server import XServer, x_server

STALL = 0.3  # Seconds without a frame. A press that waited during a longer stall starts nothing.
FRAMES = 2  # Frames that must be shown after a stall before a press may start something.
PAUSE = 1.0  # Seconds without a press that end a sequence of presses with a dropped answer.
_WRAPPED = 1e5  # Seconds: a larger difference means that the 32-bit time stamps have overflowed.
_DRIFT = 1e-3  # Maximum drift between two clocks, as a fraction of the elapsed time.


class EventTimes:
    """Times of input events on the screen's clock, and stalls of the screen.

    ``clock`` is monotonic, in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self.touched = self.clock()  # Time of the last key press or touch.
        self.woken: Callable[[], None] = lambda: None  # Called at each key press or touch.
        self.stalled = 0.0  # Duration of the last stall in seconds.
        self._alive: float | None = None
        self._behind = float("-inf")  # End of the last stall.
        self._dropped = float("-inf")  # Time of the last dropped answer or of a press that relied on it.
        self._frames = FRAMES  # Frames that were shown since the last stall.
        # By clock: offset, and time when the offset was determined.
        self._offsets: dict[str, tuple[float, float]] = {}

    @property
    def known(self) -> bool:
        """Whether the operator has seen the present screen since the last stall."""
        return self._frames >= FRAMES

    def frame(self) -> None:
        """Note that a frame is shown."""
        self._lives(self.clock())
        self._frames += 1

    def alive(self) -> None:
        """Note an input event, before its time is checked."""
        self.touched = self.clock()
        self._lives(self.touched)
        self.woken()

    def _lives(self, now: float) -> None:
        if self._alive is not None and now - self._alive > STALL:
            self.stalled, self._behind, self._frames = now - self._alive, now, 0
        self._alive = now

    def at(self, stamp: int, whose: str = "") -> float:
        """Return the time of an event in seconds of the screen's clock. An event without a stamp happens now.

        ``stamp`` is in ms of the clock ``whose``. Each clock has its own offset.
        """
        now = self.clock()
        if not stamp:
            return now
        apart = now - stamp / 1000
        offset, seen = self._offsets.get(whose, (apart, now))
        if apart - offset > _WRAPPED:
            offset = apart
        offset = min(apart, offset + _DRIFT * (now - seen))
        self._offsets[whose] = offset, now
        return min(now, stamp / 1000 + offset)

    def late(self, stamp: int, whose: str = "") -> bool:
        """Return whether an event waited during a stall of the screen or on its path to the screen."""
        if not stamp:
            return False
        at = self.at(stamp, whose)
        return at <= self._behind or not self.known or self.clock() - at > STALL

    def drop(self, stamp: int, whose: str = "") -> None:
        """Note that an answer was dropped, so that the presses that follow are dropped, too."""
        self._dropped = max(self._dropped, self.at(stamp, whose))

    def relies_on_dropped(self, stamp: int, whose: str = "") -> bool:
        """Return whether a press follows a dropped answer in the same stall or without a pause of 1 s."""
        at = self.at(stamp, whose)
        same_stall = self._behind - self.stalled < self._dropped and at <= self._behind
        return same_stall or at - self._dropped < PAUSE

    def delay(self, stamp: int, whose: str = "") -> float:
        """Return how long a press waited in seconds, or the duration of the stall in which it waited."""
        at = self.at(stamp, whose)
        return self.stalled if at <= self._behind else self.clock() - at


Key = Qt.Key
TOGETHER = 2  # Milliseconds: a press this soon after the release of the same key is a repeat.
# X key codes of Pause, Scroll Lock and the letters on a PC keyboard, which do not depend on the layout.
_STOPS = {127: "hold", 78: "estop"}
_PC = frozenset({"xcb", "wayland"})  # Platforms on which the scan code is an X key code.
_LETTERS = dict(
    zip((*range(24, 34), *range(38, 47), *range(52, 59)), "QWERTYUIOPASDFGHJKLZXCVBNM", strict=True)
)
_MODIFIERS = frozenset(
    {Key.Key_Shift, Key.Key_Control, Key.Key_Alt, Key.Key_AltGr, Key.Key_Meta, Key.Key_Super_L}
    | {Key.Key_Super_R, Key.Key_CapsLock, Key.Key_NumLock, Key.Key_Mode_switch, Key.Key_Hyper_L}
)
_WRITE = frozenset(
    {Key.Key_Backspace, Key.Key_Delete, Key.Key_Left, Key.Key_Right, Key.Key_Up, Key.Key_Down}
    | {Key.Key_Home, Key.Key_End, Key.Key_PageUp, Key.Key_PageDown}
)
_PRESSES = frozenset(
    {QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick, QEvent.Type.TouchBegin, QEvent.Type.Wheel}
)
_SHIFTS = frozenset({50, 62})  # Key codes of both Shift keys.
_KEYS = frozenset({QEvent.Type.KeyPress, QEvent.Type.KeyRelease})


class Stops(Protocol):
    """A function that stops the machine. ``press`` is the number of the key press."""

    def __call__(self, *, press: int) -> None: ...


class Behind(Protocol):
    """Interface of the main window as the keyboard uses it."""

    def hold(self, by: str = "", press: int = 0) -> None: ...

    def estop(self, press: int = 0) -> None: ...

    def estop_sent(self) -> None: ...

    def esc_holds(self) -> bool: ...

    def has_field(self) -> bool: ...

    def is_text(self, key: str) -> bool: ...

    def used(self) -> None: ...

    def judge(self, *, late: bool) -> None: ...

    def looks_different(self, at: float) -> bool: ...

    def drop(self, starting: Starting) -> None: ...

    def stops_at(self, event: QInputEvent) -> bool: ...


def letter_of(event: QKeyEvent) -> str:
    """Return the letter of a key in its layout, or on a PC keyboard if the layout has no Latin letters."""
    key = event.key()
    if Key.Key_A <= key <= Key.Key_Z:
        return chr(key)
    foreign = key > 0x7F and not Key.Key_Escape <= key <= Key.Key_unknown
    code = event.nativeScanCode() if QApplication.platformName() in _PC else 0
    return _LETTERS.get(code, "") if foreign or key == 0 else ""


def key_of(event: QKeyEvent) -> int:
    """Return Qt's code of a key, with the Latin letter of its place in a layout without Latin letters."""
    letter = letter_of(event)
    return ord(letter) if letter else event.key()


class Keyboard(QObject):
    """The event filter on the windows of the application. See the module's docstring."""

    def __init__(self, behind: Behind, times: EventTimes) -> None:
        super().__init__()
        self._behind, self.times = behind, times
        self._server: XServer | None = None
        self._watched: WatchedKeys | None = None
        self._down: dict[int, int] = {}  # Scan codes of the keys that are down, with their key values.
        # Keys that are down but ignored: pressed for another purpose or at an unknown time.
        self._dead: set[int] = set()
        self._stops: set[int] = set()  # Stop keys that are down.
        self._shifts: set[int] = set()  # Codes of the Shift keys that are down, according to the events.
        self._up: dict[int, int] = {}  # Time stamp of the last release, by key.
        # Time when the X server reported a key as up before its release event arrived.
        self._known_up: dict[int, float] = {}
        self._sending = False
        self._stamp = 0  # Time stamp of the event that is being handled.
        self._whose = ""  # Clock of that time stamp.
        self._late = False  # The event waited during a stall.

    def watch(self, window: QWindow) -> None:
        """Filter the events of this window from now on."""
        window.removeEventFilter(self)
        window.installEventFilter(self)
        if self._server is None:
            self._server = x_server()

    def watch_stops(self, open_line: OpenLine) -> WatchedKeys | None:
        """Start the key watcher, or return None if the key watcher is not possible.

        The key watcher needs an X server and a control in a separate process.
        """
        line = open_line() if QGuiApplication.platformName() == "xcb" else None
        self._watched = WatchedKeys(line) if line is not None else None
        return self._watched

    @property
    def delay(self) -> float:
        """The time in seconds that the present event waited, or the duration of the stall."""
        return self.times.delay(self._stamp, self._whose)

    @property
    def now(self) -> float:
        """The time of the present event in monotonic seconds."""
        return self.times.at(self._stamp, self._whose)

    # --- pressed keys --------------------------------------------------------------------------------

    def alone(self, event: QKeyEvent) -> bool:
        """Return whether no key is down except the key of this event and modifiers."""
        return not {key for code, key in self._down.items() if code != code_of(event)} - _MODIFIERS

    def stop_held(self) -> bool:
        """Return whether a stop key is still down, so that nothing may start."""
        self._stops &= self._down.keys()
        return bool(self._stops)

    def away(self) -> None:
        """Ignore the pressed keys until they are released, because the window or page has changed."""
        self._dead |= self._down.keys()

    def back(self) -> None:
        """Read which keys are down after the window has got the keyboard.

        They were pressed elsewhere, and are ignored until they are released.
        """
        if self._server is None:
            return
        held = self._server.keys()
        self._down = {code: self._down.get(code, Key.Key_Shift) for code in held}
        self._dead = set(held)

    def look(self) -> None:
        """Process stops of the key watcher and key releases that were lost; called once a frame.

        The X server reports which keys are really down.
        """
        self._stamp = 0
        windows = QGuiApplication.topLevelWindows()
        if self._watched is not None:
            shown = frozenset(window.winId() for window in windows if window.isVisible())
            self._watched.show(Focus(shown, self._behind.esc_holds()))
            if any(stop.kind is StopKind.ESTOP for stop in self._watched.news()):
                self._behind.estop_sent()
        for window in windows if len(windows) > 1 else ():
            window.installEventFilter(self)  # A menu or a dialog has its own window for key events.
        if self._server is None or not self._down:
            return
        for code in self._down.keys() - self._server.keys():
            key, dead = self._down.pop(code, None), code in self._dead
            self._dead.discard(code)
            self._known_up[code] = self.times.clock()
            if key is not None and not dead:  # Handling a release may call this method again.
                self._send(QKeyEvent(QEvent.Type.KeyRelease, key, Qt.KeyboardModifier.NoModifier))

    def button_held(self) -> bool:
        """Return whether a mouse button is really still down."""
        if self._server is None:
            return QApplication.mouseButtons() is not Qt.MouseButton.NoButton
        return self._server.buttons()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Return whether an event is handled here and must not be passed on."""
        kind = event.type()
        if kind in _PRESSES or kind in _KEYS:
            self._behind.used()
        if kind in _KEYS and isinstance(event, QKeyEvent):
            return not self._sending and self._key(event)
        if not isinstance(event, QInputEvent):
            return False
        self._take_up(event)
        pressed = kind in _PRESSES or (
            isinstance(event, QTouchEvent)
            and any(point.state() == QEventPoint.State.Pressed for point in event.points())
        )
        return pressed and self._pressed_on_screen(event)

    def _take_up(self, event: QInputEvent) -> None:
        """Note the time of an event, and whether it is late."""
        self.times.alive()
        self._stamp, self._whose = event.timestamp(), _clock_of(event)
        self._late = self.times.late(self._stamp, self._whose)
        self._behind.judge(late=self._late)

    def _pressed_on_screen(self, event: QInputEvent) -> bool:
        """Return whether a mouse press or touch must not be passed on."""
        if self._behind.stops_at(event):
            return False
        if self._relies_on_dropped():
            starting = Starting.FOLLOWING
        elif self._late and self._behind.looks_different(self.now):
            starting = Starting.TOUCH
        else:
            return False
        event.setAccepted(True)  # Otherwise Qt sends the touch again as a mouse event.
        return self._forget(starting)

    def _key(self, event: QKeyEvent) -> bool:
        self._take_up(event)
        code = code_of(event)
        if event.key() == Key.Key_Shift:
            (self._shifts.discard if event.type() == QEvent.Type.KeyRelease else self._shifts.add)(code)
        if event.type() == QEvent.Type.KeyRelease:
            return self._released(event, code)
        stop = self._stop_of(event)
        if stop is not None:
            self._down.setdefault(code, event.key())
            self._dead.add(code)
            self._stops.add(code)
            stop(press=press_number(code, self._stamp))
            return True
        return event.key() not in _MODIFIERS and self._pressed(event, code)

    def _pressed(self, event: QKeyEvent, code: int) -> bool:
        if self._overtaken(code) and (self._late or not self._writes(event)):
            return True
        repeat = self._repeats(event, code)
        if code in self._dead or (repeat and self._late):  # The original press was not seen.
            return True
        if self._relies_on_dropped():
            self._dead.add(code)
            return repeat or self._forget(Starting.FOLLOWING)
        if repeat and not event.isAutoRepeat():
            return self._send_repeat(event)
        return self._latched(event) and self._send(_like(event, repeat=repeat, shift=False))

    def _overtaken(self, code: int) -> bool:
        """Return whether a press is older than the X server's report that its key is up.

        Such a press is a delayed repeat.
        """
        said = self._known_up.get(code)
        if said is None or not self._stamp:
            return False
        if self.times.at(self._stamp, self._whose) <= said:
            return True
        del self._known_up[code]
        return False

    def _latched(self, event: QKeyEvent) -> bool:
        """Return whether Shift is locked or sticky and not pressed. Keys without text ignore such a Shift."""
        shift = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if self._server is None or not shift or event.text():
            return False
        return not (self._shifts if self._late else self._server.keys() & _SHIFTS)

    def _released(self, event: QKeyEvent, code: int) -> bool:
        if event.isAutoRepeat():
            return False
        self._up[code] = self._stamp
        self._known_up.pop(code, None)
        dead = code in self._dead
        self._down.pop(code, None)
        self._dead.discard(code)
        return dead and event.key() not in _MODIFIERS

    def _repeats(self, event: QKeyEvent, code: int) -> bool:
        """Record a press, and return whether it is only a repeat.

        Under X, Qt's repeat flag is not reliable.
        """
        if code in self._down:
            if not event.isAutoRepeat() and self._server is None:
                self._dead.discard(code)  # Another window got its release event.
                return False
            return True
        self._down[code] = event.key()
        if event.isAutoRepeat() or self._paired(code):
            self._dead.add(code)  # The press itself was not seen.
            return True
        return False

    def _paired(self, code: int) -> bool:
        """Return whether a press and the release before it are a repeat, as some X servers send them."""
        tells = self._server is not None and self._server.tells_repeats
        return not tells and bool(self._stamp) and abs(self._stamp - self._up.get(code, -1000)) <= TOGETHER

    def _stop_of(self, event: QKeyEvent) -> Stops | None:
        """Return the stop function of a key, or None if the key does not stop the machine."""
        place = _STOPS.get(event.nativeScanCode(), "") if QApplication.platformName() in _PC else ""
        key, letter = event.key(), letter_of(event)
        if key == Key.Key_ScrollLock or place == "estop" or self._stops_by(letter == "E"):
            return self._behind.estop
        holds = key in {Key.Key_Pause, Key.Key_Cancel} or place == "hold"
        holds = holds or self._stops_by(letter == "H" or key == Key.Key_Space)
        if key == Key.Key_Escape and (self._behind.esc_holds() or self._was_sent(event)):
            return partial(self._behind.hold, BY_ESC)
        return self._behind.hold if holds else None

    def _was_sent(self, event: QKeyEvent) -> bool:
        """Return whether the key watcher has sent this press to the control."""
        press = press_number(code_of(event), self._stamp)
        return self._watched is not None and self._watched.was_sent(press)

    def _stops_by(self, key_of_stop: bool) -> bool:
        """Return whether a character stops the machine. If a caret is visible, every character is text."""
        return key_of_stop and not self._behind.has_field()

    def _relies_on_dropped(self) -> bool:
        return self.times.relies_on_dropped(self._stamp, self._whose)

    def answer_dropped(self) -> None:
        """Note that the present press was an answer to a question and was dropped."""
        self.times.drop(self._stamp, self._whose)

    def _forget(self, starting: Starting) -> bool:
        if starting is Starting.FOLLOWING:
            self.answer_dropped()
        self._behind.drop(starting)
        return True

    def _writes(self, event: QKeyEvent) -> bool:
        """Return whether a key only enters or edits text."""
        text = event.text()
        if len(text) == 1 and text.isprintable():
            return self._behind.is_text(text)
        return event.key() in _WRITE and _field() is not None

    def _send_repeat(self, event: QKeyEvent) -> bool:
        """Send a key as a repeat. In a standard field, only editing keys repeat."""
        field = _field()
        if field is not None and not (event.key() in _WRITE or self._writes(event) or _breaks(field, event)):
            return True
        return self._send(_like(event, repeat=True, shift=not self._latched(event)))

    def _send(self, event: QKeyEvent) -> bool:
        window = QApplication.focusWindow()
        self._sending = True
        try:
            if isinstance(window, QWindow):
                QCoreApplication.sendEvent(window, event)
        finally:
            self._sending = False
        return True


def _like(event: QKeyEvent, *, repeat: bool, shift: bool) -> QKeyEvent:
    """Return a copy of a key event, with its repeat flag set and with or without Shift."""
    modifiers = event.modifiers()
    if not shift:
        modifiers &= ~Qt.KeyboardModifier.ShiftModifier
    codes = (event.nativeScanCode(), event.nativeVirtualKey(), event.nativeModifiers())
    return QKeyEvent(event.type(), event.key(), modifiers, *codes, event.text(), repeat, event.count())


def code_of(event: QKeyEvent) -> int:
    """Return the scan code of a key, which does not depend on modifiers."""
    return event.nativeScanCode() or event.key()


def _clock_of(event: QInputEvent) -> str:
    """Return the name of the clock of an event's time stamp. Touches may use a different clock."""
    return "touch" if event.deviceType() is QInputDevice.DeviceType.TouchScreen else ""


def _field() -> QWidget | None:
    """Return the standard text field that has the keyboard, or None."""
    at = QApplication.focusWidget()
    return at if isinstance(at, QLineEdit | QPlainTextEdit) and shiboken6.isValid(at) else None


def _breaks(field: QWidget, event: QKeyEvent) -> bool:
    """Return whether the key inserts a line break or tab in a field with several lines."""
    return isinstance(field, QPlainTextEdit) and event.key() in {Key.Key_Return, Key.Key_Enter, Key.Key_Tab}
