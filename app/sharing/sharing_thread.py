"""The thread that shares programs: a look now and then, and at once when somebody asks for one."""

from __future__ import annotations

import threading
from collections.abc import Callable

from app.sharing.sharing import Shared, Sharing

_PATIENCE = 2.0  # s that closing waits for a look: one that hangs in a dead network drive is left behind


class SharingThread:
    """``heard`` is told, on this thread, of what each look has found; ``every``: s between two looks."""

    def __init__(self, sharing: Sharing, every: float, heard: Callable[[Shared], None]) -> None:
        self._sharing, self._every, self._heard = sharing, every, heard
        self._wake, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._repeat, name="sharing", daemon=True)
        self.looking = False

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def look_now(self) -> None:
        """From any thread; it waits for nothing."""
        self._wake.set()

    def close(self) -> None:
        """What is under way is given up: it is taken up again when the desk starts anew."""
        self._closing.set()
        self._wake.set()
        self._sharing.place.close()
        if self._thread.is_alive():
            self._thread.join(_PATIENCE)

    def _repeat(self) -> None:
        while not self._closing.is_set():
            self.looking = True
            shared = self._sharing.look(settled=True)
            self.looking = False
            if not self._closing.is_set():
                self._heard(shared)
            self._wake.wait(self._every)
            self._wake.clear()
