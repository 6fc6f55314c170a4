"""A thread for tasks that may hang: the process ends without it."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable


class DaemonWorker:
    """Carries tasks out, one after the other, on one daemon thread; the thread starts with the first task.

    A ThreadPoolExecutor would join its threads when the interpreter ends, however long they hang. A task may
    raise nothing.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._tasks: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()
        self._closed = False

    def submit(self, task: Callable[[], None]) -> None:
        """Queue a task; a closed worker drops it."""
        with self._lock:
            if self._closed:
                return
            self._tasks.put(task)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=self._name, daemon=True)
                self._thread.start()

    def close(self, limit: float) -> None:
        """Finish the queued tasks; wait ``limit`` seconds for them at most."""
        with self._lock:
            self._closed = True
            self._tasks.put(None)
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(limit)

    def _work(self) -> None:
        while (task := self._tasks.get()) is not None:
            task()
