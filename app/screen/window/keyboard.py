"""The keyboard: every key passes here before anything else sees it, with the time when it went down.

Two keys act everywhere, with any modifier, lock and layout: Pause holds the feed, Scroll Lock is the E-stop.
H, Space and E do the same where no caret is visible. Esc holds while something moves, unless the page uses
Esc for something else. Of all other keys this knows which are really down: a repeat is no press, and a key
held while the keyboard was elsewhere is dead until it is let go. A press that waited behind a stall of the
screen is carried out in its order, and starts nothing (``app.desk.late_presses``). After an answer that was
dropped for that, the rest of the burst is dropped too: it relied on the answer.
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

STALL = 0.3  # s without a frame: whatever waited behind it starts nothing
FRAMES = 2  # that must have been shown since, before anything starts
PAUSE = 1.0  # s without a press that end a burst of which an answer was dropped
_WRAPPED = 1e5  # s: further off than this the 32 bits of the stamps have run over
_DRIFT = 1e-3  # of the time passed: how much two clocks may go apart


class EventTimes:
    """``clock`` is monotonic, seconds."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self.touched = self.clock()  # when somebody last did something, a key or a finger
        self.woken: Callable[[], None] = lambda: None  # called then
        self.stalled = 0.0  # s that the last stall took
        self._alive: float | None = None
        self._behind = float("-inf")  # the end of the last stall
        self._dropped = float(
            "-inf"
        )  # when an answer that was dropped, or a press that relied on it, was made
        self._frames = FRAMES  # shown since
        self._offsets: dict[str, tuple[float, float]] = {}  # of whose clock: offset, and when it was seen

    @property
    def known(self) -> bool:
        """Whether what is to be seen has been shown since the last stall."""
        return self._frames >= FRAMES

    def frame(self) -> None:
        """A frame is shown."""
        self._lives(self.clock())
        self._frames += 1

    def alive(self) -> None:
        """The screen does something; called before an event is judged."""
        self.touched = self.clock()
        self._lives(self.touched)
        self.woken()

    def _lives(self, now: float) -> None:
        if self._alive is not None and now - self._alive > STALL:
            self.stalled, self._behind, self._frames = now - self._alive, now, 0
        self._alive = now

    def at(self, stamp: int, whose: str = "") -> float:
        """When it happened, seconds of our clock; an event without a stamp happens now.

        ``whose`` clock counts the stamps: events of one clock alone are compared.
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
        """Whether it waited behind a stall, of the screen or on its way here."""
        if not stamp:
            return False
        at = self.at(stamp, whose)
        return at <= self._behind or not self.known or self.clock() - at > STALL

    def drop(self, stamp: int, whose: str = "") -> None:
        """Note that an answer was dropped: what follows relies on it."""
        self._dropped = max(self._dropped, self.at(stamp, whose))

    def relies_on_dropped(self, stamp: int, whose: str = "") -> bool:
        """Return whether a press follows one that was dropped: in the same stall, or without a pause."""
        at = self.at(stamp, whose)
        same_stall = self._behind - self.stalled < self._dropped and at <= self._behind
        return same_stall or at - self._dropped < PAUSE

    def delay(self, stamp: int, whose: str = "") -> float:
        """Return how long a press waited, or the stall that it waited behind took, in seconds."""
        at = self.at(stamp, whose)
        return self.stalled if at <= self._behind else self.clock() - at


Key = Qt.Key
TOGETHER = 2  # ms: a press so soon after its own release is a repeat
# X's codes of the keys of a PC, whatever a layout makes of them: Pause and Scroll Lock, and the letters.
_STOPS = {127: "hold", 78: "estop"}
_PC = frozenset({"xcb", "wayland"})  # there a key's code is X's
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
_SHIFTS = frozenset({50, 62})  # codes of both
_KEYS = frozenset({QEvent.Type.KeyPress, QEvent.Type.KeyRelease})


class Stops(Protocol):
    """A stop of the machine; ``press`` is the number of the press."""

    def __call__(self, *, press: int) -> None: ...


class Behind(Protocol):
    """What the keyboard does at once, and what it asks of the window behind it."""

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
    """The letter of a key as its layout has it; of one that writes no Latin letter, that of its place."""
    key = event.key()
    if Key.Key_A <= key <= Key.Key_Z:
        return chr(key)
    foreign = key > 0x7F and not Key.Key_Escape <= key <= Key.Key_unknown
    code = event.nativeScanCode() if QApplication.platformName() in _PC else 0
    return _LETTERS.get(code, "") if foreign or key == 0 else ""


def key_of(event: QKeyEvent) -> int:
    """The key, of a layout without Latin letters by its place."""
    letter = letter_of(event)
    return ord(letter) if letter else event.key()


class Keyboard(QObject):
    """A filter on the windows of the application; see the module."""

    def __init__(self, behind: Behind, times: EventTimes) -> None:
        super().__init__()
        self._behind, self.times = behind, times
        self._server: XServer | None = None
        self._watched: WatchedKeys | None = None
        self._down: dict[int, int] = {}  # codes of what is down, and the key that it was
        self._dead: set[int] = set()  # of these: pressed for something else, or nobody knows when
        self._stops: set[int] = set()  # of these: what stops the machine as long as it is held
        self._shifts: set[int] = set()  # codes of those that are down, in the order of the events
        self._up: dict[int, int] = {}  # the stamp of the last release
        self._known_up: dict[int, float] = {}  # when the server said so of a key whose release is on its way
        self._sending = False
        self._stamp = 0  # of the event that is handled now
        self._whose = ""  # clock counts it
        self._late = False  # it waited behind a stall

    def watch(self, window: QWindow) -> None:
        """From now on see what this window gets."""
        window.removeEventFilter(self)
        window.installEventFilter(self)
        if self._server is None:
            self._server = x_server()

    def watch_stops(self, open_line: OpenLine) -> WatchedKeys | None:
        """Start the key watcher, where an X server and a control of its own process are there."""
        line = open_line() if QGuiApplication.platformName() == "xcb" else None
        self._watched = WatchedKeys(line) if line is not None else None
        return self._watched

    @property
    def delay(self) -> float:
        """How long what is handled now waited, or the stall behind which it waited took; seconds."""
        return self.times.delay(self._stamp, self._whose)

    @property
    def now(self) -> float:
        """When what is handled now has happened; monotonic seconds."""
        return self.times.at(self._stamp, self._whose)

    # --- what is down --------------------------------------------------------------------------------

    def alone(self, event: QKeyEvent) -> bool:
        """Whether no other key is down than the one of this event, and modifiers."""
        return not {key for code, key in self._down.items() if code != code_of(event)} - _MODIFIERS

    def stop_held(self) -> bool:
        """Whether a key that stops the machine is still down: nothing starts meanwhile."""
        self._stops &= self._down.keys()
        return bool(self._stops)

    def away(self) -> None:
        """The keyboard is elsewhere, or the page is another: what is down is dead until it was let go."""
        self._dead |= self._down.keys()

    def back(self) -> None:
        """The keyboard is here again: what is down now was pressed elsewhere."""
        if self._server is None:
            return
        held = self._server.keys()
        self._down = {code: self._down.get(code, Key.Key_Shift) for code in held}
        self._dead = set(held)

    def look(self) -> None:
        """Once a frame: what the server knows to be up has come up, even where its release was lost."""
        self._stamp = 0
        windows = QGuiApplication.topLevelWindows()
        if self._watched is not None:
            shown = frozenset(window.winId() for window in windows if window.isVisible())
            self._watched.show(Focus(shown, self._behind.esc_holds()))
            if any(stop.kind is StopKind.ESTOP for stop in self._watched.news()):
                self._behind.estop_sent()
        for window in windows if len(windows) > 1 else ():
            window.installEventFilter(self)  # a menu or a dialog has the keyboard for itself
        if self._server is None or not self._down:
            return
        for code in self._down.keys() - self._server.keys():
            key, dead = self._down.pop(code, None), code in self._dead
            self._dead.discard(code)
            self._known_up[code] = self.times.clock()
            if key is not None and not dead:  # handling one looks again
                self._send(QKeyEvent(QEvent.Type.KeyRelease, key, Qt.KeyboardModifier.NoModifier))

    def button_held(self) -> bool:
        """Whether a button of the mouse is really down still."""
        if self._server is None:
            return QApplication.mouseButtons() is not Qt.MouseButton.NoButton
        return self._server.buttons()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Whether an event goes no further."""
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
        """Note when an event happened, and whether it is late."""
        self.times.alive()
        self._stamp, self._whose = event.timestamp(), _clock_of(event)
        self._late = self.times.late(self._stamp, self._whose)
        self._behind.judge(late=self._late)

    def _pressed_on_screen(self, event: QInputEvent) -> bool:
        """Return whether a press of the mouse or a finger goes no further."""
        if self._behind.stops_at(event):
            return False
        if self._relies_on_dropped():
            starting = Starting.FOLLOWING
        elif self._late and self._behind.looks_different(self.now):
            starting = Starting.TOUCH
        else:
            return False
        event.setAccepted(True)  # or Qt makes a mouse button of the finger
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
        if code in self._dead or (repeat and self._late):  # nobody has seen what it repeated
            return True
        if self._relies_on_dropped():
            self._dead.add(code)
            return repeat or self._forget(Starting.FOLLOWING)
        if repeat and not event.isAutoRepeat():
            return self._send_repeat(event)
        return self._latched(event) and self._send(_like(event, repeat=repeat, shift=False))

    def _overtaken(self, code: int) -> bool:
        """Whether a press was made before the server said that its key is up: a repeat, late on its way."""
        said = self._known_up.get(code)
        if said is None or not self._stamp:
            return False
        if self.times.at(self._stamp, self._whose) <= said:
            return True
        del self._known_up[code]
        return False

    def _latched(self, event: QKeyEvent) -> bool:
        """Whether Shift is locked or sticks: for a key that writes nothing only a held Shift is one."""
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
        """Note a press; whether it only repeats one. Under X Qt's flag tells nothing."""
        if code in self._down:
            if not event.isAutoRepeat() and self._server is None:
                self._dead.discard(code)  # its release was somebody else's to see
                return False
            return True
        self._down[code] = event.key()
        if event.isAutoRepeat() or self._paired(code):
            self._dead.add(code)  # nobody has seen it go down
            return True
        return False

    def _paired(self, code: int) -> bool:
        """Whether a press belongs to the release before it: of a server that makes repeats so."""
        tells = self._server is not None and self._server.tells_repeats
        return not tells and bool(self._stamp) and abs(self._stamp - self._up.get(code, -1000)) <= TOGETHER

    def _stop_of(self, event: QKeyEvent) -> Stops | None:
        """What a key does that stops the machine, whatever else is so; None for any other key."""
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
        """Return whether a character stops the machine; where a caret is visible every character is text."""
        return key_of_stop and not self._behind.has_field()

    def _relies_on_dropped(self) -> bool:
        return self.times.relies_on_dropped(self._stamp, self._whose)

    def answer_dropped(self) -> None:
        """The press that is handled now was an answer, and was dropped."""
        self.times.drop(self._stamp, self._whose)

    def _forget(self, starting: Starting) -> bool:
        if starting is Starting.FOLLOWING:
            self.answer_dropped()
        self._behind.drop(starting)
        return True

    def _writes(self, event: QKeyEvent) -> bool:
        """Whether a key only writes, where it goes."""
        text = event.text()
        if len(text) == 1 and text.isprintable():
            return self._behind.is_text(text)
        return event.key() in _WRITE and _field() is not None

    def _send_repeat(self, event: QKeyEvent) -> bool:
        """On as what it is. A stock field repeats what writes, and nothing that acts."""
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
    """The same key, as what it is."""
    modifiers = event.modifiers()
    if not shift:
        modifiers &= ~Qt.KeyboardModifier.ShiftModifier
    codes = (event.nativeScanCode(), event.nativeVirtualKey(), event.nativeModifiers())
    return QKeyEvent(event.type(), event.key(), modifiers, *codes, event.text(), repeat, event.count())


def code_of(event: QKeyEvent) -> int:
    """Which key it is, whatever modifiers make of it."""
    return event.nativeScanCode() or event.key()


def _clock_of(event: QInputEvent) -> str:
    """Whose clock counts the stamp of an event: fingers may be read by another than keys and mouse."""
    return "touch" if event.deviceType() is QInputDevice.DeviceType.TouchScreen else ""


def _field() -> QWidget | None:
    """The stock field that has the keyboard."""
    at = QApplication.focusWidget()
    return at if isinstance(at, QLineEdit | QPlainTextEdit) and shiboken6.isValid(at) else None


def _breaks(field: QWidget, event: QKeyEvent) -> bool:
    """Return breaks a line where there are lines."""
    return isinstance(field, QPlainTextEdit) and event.key() in {Key.Key_Return, Key.Key_Enter, Key.Key_Tab}
