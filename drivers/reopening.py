"""Opens again what was lost, in a thread of its own: nobody waits for a port or process that is not there."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from core.ports import DriverError

T = TypeVar("T")


class Opening(Generic[T]):
    """One attempt. ``at_once``: in this thread, where it cannot wait."""

    def __init__(self, open_: Callable[[], T], *, at_once: bool = False) -> None:
        self._open = open_
        self._found: queue.SimpleQueue[T | DriverError] = queue.SimpleQueue()
        if at_once:
            self._run()
        else:
            threading.Thread(target=self._run, name="reopening", daemon=True).start()

    def take(self) -> T | None:
        """What was opened, None until then. Raises DriverError when it cannot be."""
        try:
            found = self._found.get_nowait()
        except queue.Empty:
            return None
        if isinstance(found, DriverError):
            raise found
        return found

    def _run(self) -> None:
        try:
            self._found.put(self._open())
        except DriverError as error:
            self._found.put(error)
