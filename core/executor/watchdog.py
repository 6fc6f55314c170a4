"""The executor's thread, and the watchdog that sees when it is dead or stuck and makes the machine safe.

The watchdog is a thread of its own. It counts its own looks, not time: when the whole process stands
still, it does so too, and nobody is blamed. It touches no driver that belongs to the executor but by
``MachinePorts.halt``, which any thread may call.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable

from core.executor.attempt import Attempt, ReportedAttempt
from core.executor.executor import TICK, Executor
from core.ports import Clock

# --- the executor's thread ------------------------------------------------------------------------------


_END = 8.0  # s: the longest wait for a drive; one that is stuck longer is left to the watchdog


class ExecutorThread:
    """The thread in which the executor ticks. A failure that it could not catch itself stops the machine."""

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
        self.executor.wake()
        if self._thread.is_alive():
            self._thread.join(_END)
        if not self._thread.is_alive() and not self._shut:
            self.executor.shut()  # it has died: nobody else calls the drivers any more

    def _run(self) -> None:
        while not self._closing.is_set():
            with ReportedAttempt(self.executor.failed):
                self.executor.tick()
                if not self.executor.rest():
                    self._clock.sleep_until(self._clock.now() + self._tick)
        self.executor.shut()
        self._shut = True


_log = logging.getLogger(__name__)
LOOK = 0.1  # s between two looks
OTHERS = 10  # looks at the executor to one at the other threads
STUCK = 10  # looks without a tick: a second
PATIENT = 70  # the same while the executor waits for a drive to come on, which may take five seconds
AGAIN = 5  # looks after which the machine is halted once more: a controller that holds is then reset
HALTS = 10

Tell = Callable[[str], None]


def running(name: str) -> bool:
    """Whether a thread of this name is alive."""
    return any(thread.name == name for thread in threading.enumerate())


class Watchdog:
    """Watches the executor's thread, and others by their names, from the poll at which each is running.

    ``halt`` is the drivers' own way to stop everything, None where there is none. ``tell`` is told of another
    thread's end, once; the executor's own end is an alarm.
    """

    def __init__(
        self, executor: ExecutorThread, halt: Callable[[], None] | None, others: Iterable[str], tell: Tell
    ) -> None:
        self._executor, self._halt, self._tell = executor, halt, tell
        self._others = frozenset(others)
        self._running = frozenset[str]()  # those of the others that ran at the last poll
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="watchdog", daemon=True)
        self._looks = 0
        self._ticks = -1
        self._still = 0  # looks without a tick
        self._halted = 0

    @property
    def alive(self) -> bool:
        """Whether it still looks."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Start polling. The other threads may start before or after."""
        self._running = self._alive()
        self._thread.start()

    def close(self) -> None:
        """End before anything else is closed: what ends behind it ends in good order."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join()

    def look(self) -> None:
        """Look once at the executor and the other threads. Raises nothing."""
        with Attempt() as trial:
            self._mind_executor()
            if self._looks % OTHERS == 0:
                self._mind_others()
            self._looks += 1
        if trial.error is not None:
            _log.error("the watchdog has failed", exc_info=trial.error)

    def _watch(self) -> None:
        while not self._closing.wait(LOOK):
            self.look()

    def _mind_executor(self) -> None:
        thread = self._executor
        executor = thread.executor
        moved = executor.ticks != self._ticks
        self._ticks = executor.ticks
        self._still = 0 if moved else self._still + 1
        dead = not thread.alive
        if not dead and self._still < (PATIENT if executor.patient else STUCK):
            self._halted = 0
            return
        if self._halted % AGAIN == 0 and self._halted < AGAIN * HALTS and self._halt is not None:
            with Attempt() as halting:
                self._halt()
            if halting.error is not None:
                _log.error("the drivers cannot be halted", exc_info=halting.error)
        if self._halted == 0:
            executor.declare_silent("its thread has ended" if dead else "its thread is stuck")
        self._halted += 1

    def _mind_others(self) -> None:
        before, self._running = self._running, self._alive()
        for name in sorted(before - self._running):
            self._tell(name)

    def _alive(self) -> frozenset[str]:
        """Names of the other threads that are running."""
        return frozenset(name for name in self._others if running(name))
