"""The other side of a line by hand: what it has heard, and what it says."""

from __future__ import annotations

import os
import select
import threading
import tty
from concurrent.futures import Future

from tests.drivers.inverter.lines import WAIT
from tests.drivers.ptys import open_pty


class FarEnd:
    """The other side by hand: what it has heard, and what it says."""

    def __init__(self) -> None:
        self.handle, self._slave = open_pty()
        tty.setraw(self._slave)
        self.port = os.ttyname(self._slave)
        self.heard = bytearray()

    def hear(self, limit: float = 0.05) -> bytes:
        """What comes within the limit."""
        ready, _, _ = select.select((self.handle,), (), (), limit)
        data = os.read(self.handle, 4096) if ready else b""
        self.heard += data
        return data

    def say(self, data: bytes) -> None:
        os.write(self.handle, data)

    def close(self) -> None:
        """Pull the cable; once is enough."""
        for handle in (self.handle, self._slave):
            if handle >= 0:
                os.close(handle)
        self.handle = self._slave = -1


def feed(far: FarEnd, data: bytes) -> None:
    """As fast as the pty takes it."""
    at = 0
    os.set_blocking(far.handle, False)
    while at < len(data):
        _, free, _ = select.select((), (far.handle,), (), WAIT)
        assert free
        at += os.write(far.handle, data[at : at + 512])


def answer(far: FarEnd, future: Future[int], data: bytes) -> None:
    """Say it again until the command, which opens its port in its own time, has come to its end."""
    tick = threading.Event()
    for _ in range(int(WAIT / 0.1)):
        if future.done():
            return
        far.say(data)
        tick.wait(0.1)
