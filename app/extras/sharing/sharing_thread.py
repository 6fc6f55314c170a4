"""The thread that shares programs: a look now and then, and at once when somebody asks for one."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from app.extras.sharing.sharing import Shared, Sharing

_PATIENCE = 2.0  # s that closing waits for a look: one that hangs in a dead network drive is left behind


class SharingThread:
    """``heard`` is told, on this thread, of what each look has found; ``every``: s between two looks."""

    def __init__(
        self,
        sharing: Sharing,
        every: float,
        heard: Callable[[Shared], None],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._sharing, self._every, self._heard = sharing, every, heard
        self._wake, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._repeat, name="sharing", daemon=True)
        self._now, self._since = now, -1.0  # when the look that is under way began; under 0: none is

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def look_now(self) -> None:
        """From any thread; it waits for nothing."""
        self._wake.set()

    def silent_for(self) -> float:
        """How many seconds a look has waited for the place: a dead network drive may never answer."""
        since = self._since
        return self._now() - since if since >= 0.0 else 0.0

    def close(self) -> None:
        """What is under way is left behind: it is taken up again when the desk starts anew."""
        self._closing.set()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(_PATIENCE)

    def _repeat(self) -> None:
        while not self._closing.is_set():
            self._since = self._now()
            shared = self._sharing.look(settled=True)
            self._since = -1.0
            if not self._closing.is_set():
                self._heard(shared)
            self._wake.wait(self._every)
            self._wake.clear()
