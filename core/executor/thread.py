"""The thread in which the executor lives: ticks by the machine's clock until it is closed."""

from __future__ import annotations

import threading

from core.executor.executor import Executor
from core.executor.guard import Guard
from core.ports import Clock

TICK = 0.01  # s
_END = 8.0  # s: the longest wait for a drive; one that is stuck longer is left to the watchdog


class ExecutorThread:
    """Owns the thread. A failure that the executor could not catch itself stops the machine and is shown."""

    def __init__(self, executor: Executor, clock: Clock, tick: float = TICK) -> None:
        self.executor = executor
        self._clock = clock
        self._tick = tick
        self._closing = threading.Event()
        self._shut = False
        self._thread = threading.Thread(target=self._run, name="executor", daemon=True)

    @property
    def alive(self) -> bool:
        """Whether it still ticks."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Begin to tick."""
        self._thread.start()

    def close(self) -> None:
        """Stop the machine as E-stop would leave it, and end the thread."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(_END)
        if not self._thread.is_alive() and not self._shut:
            self.executor.shut()  # it has died: nobody else calls the drivers any more

    def _run(self) -> None:
        while not self._closing.is_set():
            with Guard(self.executor.failed):
                self.executor.tick()
                self._clock.sleep_until(self._clock.now() + self._tick)
        self.executor.shut()
        self._shut = True
