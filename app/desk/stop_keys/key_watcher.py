"""The key watcher: ``python -m app.desk.stop_keys.key_watcher LINE SCREEN``, file descriptors of two sockets.

A process of its own, because a call of Qt that paints keeps Python's lock in the process of the screen, and
no thread there runs meanwhile. It sends every press of a stop key over LINE to the control, and over SCREEN
to the screen. It acts only while a window of TurnDesk has the keyboard, and ends with the screen.
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
    """Decides which raw keys stop the machine."""

    def __init__(self, keys: RawKeys, line: socket.socket, screen: socket.socket) -> None:
        self._keys, self._line, self._screen = keys, line, screen
        self._focus = NOWHERE

    def run(self) -> None:
        """Watch until the screen ends."""
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
        """Take over what the screen says of its windows; return False when the screen has ended."""
        try:
            while record := self._screen.recv(LONGEST, socket.MSG_DONTWAIT):
                self._focus = Focus.unpacked(record)
        except BlockingIOError:
            return True
        except OSError:  # it has not read all that it was sent
            return False
        return False

    def see(self, key: RawKey) -> None:
        """Send a stop for a key that goes down. The server sends no raw events for repeats."""
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
            with suppress(OSError):  # a control that has ended, a screen that hangs for long
                end.send(stop.packed(), socket.MSG_DONTWAIT)


def main(arguments: list[str]) -> int:
    """Watch the keys; return 1 where the X server sends none."""
    line, screen = (socket.socket(fileno=int(each)) for each in arguments)
    try:
        keys = RawKeys()
    except OSError:
        return 1
    KeyWatcher(keys, line, screen).run()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
