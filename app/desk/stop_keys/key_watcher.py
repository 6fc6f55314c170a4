"""The key watcher: ``python -m app.desk.stop_keys.key_watcher LINE SCREEN``.

LINE and SCREEN are file descriptors of two sockets. The watcher is a separate process, because a painting
call of Qt holds Python's lock, and no thread of the screen's process runs in that time. The watcher sends
every press of a stop key to the control over LINE and to the screen over SCREEN. It acts only while a window
of TurnDesk has the keyboard, and ends with the screen.
"""

from __future__ import annotations

import select
import socket
import sys
from contextlib import suppress

from app.desk.stop_keys.raw_keys import RawKey, RawKeys
from app.desk.stop_keys.stop_records import LONGEST, NOWHERE, Focus, Stop, StopKind, press_number

PLACES = {127: StopKind.HOLD, 78: StopKind.ESTOP}
"""X's codes of Pause and Scroll Lock on the keyboard of a PC, whatever a layout makes of them."""


class KeyWatcher:
    """Decides which key presses stop the machine, and sends them."""

    def __init__(self, keys: RawKeys, line: socket.socket, screen: socket.socket) -> None:
        self._keys, self._line, self._screen = keys, line, screen
        self._focus = NOWHERE

    def run(self) -> None:
        """Watch the keys until the screen ends."""
        poll = select.poll()
        for each in (self._keys, self._screen):
            poll.register(each.fileno(), select.POLLIN)
        while True:
            ready = dict(poll.poll())
            if self._screen.fileno() in ready and not self.read_focus():
                return
            for key in self._keys.pressed():
                self.see(key)

    def read_focus(self) -> bool:
        """Read the windows that the screen has sent. Return False if the screen has ended."""
        try:
            while record := self._screen.recv(LONGEST, socket.MSG_DONTWAIT):
                self._focus = Focus.unpacked(record)
        except BlockingIOError:
            return True
        except OSError:  # The screen ended before it read all records.
            return False
        return False

    def see(self, key: RawKey) -> None:
        """Send a stop for a pressed key. The X server sends no raw events for key repeats."""
        kind = self._kind(key.code)
        if kind is not None and self._keys.focus() in self._focus.windows:
            self._send(Stop(kind, press_number(key.code, key.stamp)))

    def _kind(self, code: int) -> StopKind | None:
        if code in PLACES:
            return PLACES[code]
        if self._focus.esc_holds and code == self._keys.escape_code():
            return StopKind.ESC
        return None

    def _send(self, stop: Stop) -> None:
        for end in (self._line, self._screen):
            with suppress(OSError):  # The control may have ended, or the screen may hang.
                end.send(stop.packed(), socket.MSG_DONTWAIT)


def main(arguments: list[str]) -> int:
    """Watch the keys. Return 1 if the X server sends no raw events."""
    line, screen = (socket.socket(fileno=int(each)) for each in arguments)
    try:
        keys = RawKeys()
    except OSError:
        return 1
    KeyWatcher(keys, line, screen).run()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
