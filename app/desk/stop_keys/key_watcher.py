"""Key watcher process for the stop keys and the drawn stop controls.

Its arguments are LINE and SCREEN, the file descriptors of two sockets. The watcher sends every press of a
stop key to the control over LINE and to the screen over SCREEN, while a window of TurnDesk has the keyboard
focus. It does the same for every mouse press and touch on a drawn stop control that no other window covers.
The watcher ends when the screen ends.

The watcher is a separate process, because a painting call of Qt holds Python's global interpreter lock,
which blocks all threads of the screen's process.
"""

from __future__ import annotations

import select
import socket
from contextlib import suppress

from app.desk.stop_keys.handled_presses import is_press_handled
from app.desk.stop_keys.key_codes import STOP_CHARACTERS, STOP_KEY_CODES
from app.desk.stop_keys.raw_keys import RawKey, RawKeyReader
from app.desk.stop_keys.raw_pointer import PointerPress, RawPointerReader
from app.desk.stop_keys.stop_records import (
    MAX_RECORD_BYTES,
    NO_FOCUS,
    FocusRecord,
    StopKeyPress,
    StopKind,
    make_press_number,
)


class KeyWatcher:
    """Watcher of keyboard, mouse and touch, which detects presses that stop the machine and sends them.

    Without ``raw_pointer``, it watches only the keyboard.
    """

    def __init__(
        self,
        raw_keys: RawKeyReader,
        stop_channel: socket.socket,
        screen_channel: socket.socket,
        raw_pointer: RawPointerReader | None = None,
    ) -> None:
        self._keys, self._line, self._screen = raw_keys, stop_channel, screen_channel
        self._pointer = raw_pointer
        self._focus = NO_FOCUS
        self._last_press = 0  # Number of the last press, also of a touch, for which no stop was sent.

    def watch_presses(self) -> None:
        """Watch the keys, the mouse and the touches until the screen process ends."""
        poll = select.poll()
        for each in (self._keys, self._screen, self._pointer):
            if each is not None:
                poll.register(each.fileno(), select.POLLIN)
        while True:
            ready = dict(poll.poll())
            if self._screen.fileno() in ready and not self.read_focus_records():
                return
            self._handle_pointer_presses()
            for key in self._keys.read_key_presses():
                self.handle_key_press(key)

    def _handle_pointer_presses(self) -> None:
        if self._pointer is not None:
            for press in self._pointer.read_presses():
                self.handle_pointer_press(press)

    def read_focus_records(self) -> bool:
        """Read the focus record that the screen has sent. Return False if the screen has ended."""
        try:
            while record := self._screen.recv(MAX_RECORD_BYTES, socket.MSG_DONTWAIT):
                self._focus = FocusRecord.from_bytes(record)
        except BlockingIOError:
            return True
        except OSError:  # The screen ended before it read all records.
            return False
        return False

    def handle_key_press(self, key: RawKey) -> None:
        """Send a stop if the pressed key is a stop key and a window of TurnDesk has the keyboard focus.

        The X server does not send raw events for key repeats.
        """
        press = make_press_number(key.key_code, key.time_ms)
        kind = self._find_kind(key.key_code, press)
        if kind is not None and self._keys.find_focus_window() in self._focus.window_ids:
            self._send(StopKeyPress(kind, press))
        else:
            self._last_press = press

    def handle_pointer_press(self, press: PointerPress) -> None:
        """Send a stop if a mouse press or touch is on a drawn stop control that no window covers."""
        number, kind = make_press_number(press.press_code, press.time_ms), self._find_area_kind(press)
        if kind is not None:
            self._send(StopKeyPress(kind, number))
        else:
            self._last_press = number

    def _find_area_kind(self, press: PointerPress) -> StopKind | None:
        number = make_press_number(press.press_code, press.time_ms)
        if self._pointer is None or is_press_handled(number, self._focus.received_press):
            return None  # The screen has received the press, and knows where the pointer was.
        found = self._pointer.find_window_at(press.x_px, press.y_px, self._focus.window_ids)
        for area in self._focus.stop_areas:
            if found is not None and area.window_id == found[0] and area.contains(*found[1:]):
                return area.stop_kind
        return None

    def _find_kind(self, code: int, press: int) -> StopKind | None:
        if code in STOP_KEY_CODES:
            return STOP_KEY_CODES[code]
        if is_press_handled(press, self._focus.received_press):
            return None  # The screen has received the press, perhaps before the key became a stop key.
        if self._focus.is_esc_stop_key and code == self._keys.find_escape_code():
            return StopKind.ESC
        if not self._is_letter_certain():
            return None
        return STOP_CHARACTERS.get(self._keys.find_character(code))

    def _is_letter_certain(self) -> bool:
        """Return whether a letter cannot be text, because no earlier press can open a text field.

        The screen must have handled every earlier press before it reported that no text field has the
        keyboard focus. Mouse presses and touches are known only with ``raw_pointer``.
        """
        self._handle_pointer_presses()
        return (
            self._pointer is not None
            and self._focus.are_letters_stop_keys
            and is_press_handled(self._last_press, self._focus.handled_press)
        )

    def _send(self, stop: StopKeyPress) -> None:
        for end in (self._line, self._screen):
            with suppress(OSError):  # The control may have ended, or the screen may hang.
                end.send(stop.to_bytes(), socket.MSG_DONTWAIT)


def main(arguments: list[str]) -> int:
    """Watch the presses, and return 1 if the X server does not send raw events."""
    line, screen = (socket.socket(fileno=int(each)) for each in arguments)
    try:
        keys = RawKeyReader()
    except OSError:
        return 1
    pointer = None
    with suppress(OSError):  # An X server from before 2012.
        pointer = RawPointerReader()
    KeyWatcher(keys, line, screen, pointer).watch_presses()
    return 0
