"""Key watcher process for the stop keys.

Its arguments are LINE and SCREEN, the file descriptors of two sockets. The watcher sends every press of a
stop key to the control over LINE and to the screen over SCREEN. It does so only while a window of TurnDesk
has the keyboard focus, and it ends when the screen ends.

The watcher is a separate process, because a painting call of Qt holds Python's global interpreter lock,
which blocks all threads of the screen's process.
"""

from __future__ import annotations

import select
import socket
from contextlib import suppress

from app.desk.stop_keys.raw_keys import RawKey, RawKeyReader
from app.desk.stop_keys.stop_records import (
    MAX_RECORD_BYTES,
    NO_FOCUS,
    FocusRecord,
    StopKeyPress,
    StopKind,
    make_press_number,
)

STOP_KEY_CODES = {127: StopKind.HOLD, 78: StopKind.ESTOP}
"""X key codes of Pause and Scroll Lock on a PC keyboard, with the stop that each key triggers.

The codes do not depend on the keyboard layout.
"""


class KeyWatcher:
    """Watcher of the keyboard, which detects presses of stop keys and sends them."""

    def __init__(
        self, raw_keys: RawKeyReader, stop_channel: socket.socket, screen_channel: socket.socket
    ) -> None:
        self._keys, self._line, self._screen = raw_keys, stop_channel, screen_channel
        self._focus = NO_FOCUS

    def watch_keys(self) -> None:
        """Watch the keys until the screen process ends."""
        poll = select.poll()
        for each in (self._keys, self._screen):
            poll.register(each.fileno(), select.POLLIN)
        while True:
            ready = dict(poll.poll())
            if self._screen.fileno() in ready and not self.read_focus_records():
                return
            for key in self._keys.read_key_presses():
                self.handle_key_press(key)

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
        kind = self._kind(key.key_code)
        if kind is not None and self._keys.find_focus_window() in self._focus.window_ids:
            self._send(StopKeyPress(kind, make_press_number(key.key_code, key.time_ms)))

    def _kind(self, code: int) -> StopKind | None:
        if code in STOP_KEY_CODES:
            return STOP_KEY_CODES[code]
        if self._focus.is_esc_stop_key and code == self._keys.find_escape_code():
            return StopKind.ESC
        return None

    def _send(self, stop: StopKeyPress) -> None:
        for end in (self._line, self._screen):
            with suppress(OSError):  # The control may have ended, or the screen may hang.
                end.send(stop.to_bytes(), socket.MSG_DONTWAIT)


def main(arguments: list[str]) -> int:
    """Watch the keys, and return 1 if the X server does not send raw events."""
    line, screen = (socket.socket(fileno=int(each)) for each in arguments)
    try:
        keys = RawKeyReader()
    except OSError:
        return 1
    KeyWatcher(keys, line, screen).watch_keys()
    return 0
