"""The executor's thread and the watchdog; each supervises the other.

The watchdog makes the machine safe when the executor is dead or stuck. The executor reports a watchdog that
is dead or stuck. The watchdog counts its own looks, not time: when the whole process stops for a while, both
stop, and neither is reported. The watchdog calls the drivers only through ``MachinePorts.halt``, which any
thread may call, and only on a separate thread, because a driver may block.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable

from core.executor.executor import TICK, Executor
from core.executor.raised_alarm import Attempt, ReportedAttempt
from core.ports import Clock

_log = logging.getLogger(__name__)
LOOK = 0.1  # s between two looks
OTHERS = 10  # looks at the executor to one at the other threads
STUCK = 10  # looks without a tick: a second
PATIENT = 70  # the same while the executor waits for a drive to come on, which may take five seconds
AGAIN = 5  # looks after which the machine is halted once more: a controller that holds is then reset
HALTS = 10
OVERDUE = 3.0  # s of ticks without a look of the watchdog
ENDS = 1.0  # s that closing waits for the watchdog's thread
HALTED_IN = 2.0  # s that closing waits for the drivers' own way to stop
WATCHDOG = "watchdog"  # the name of its thread, and what ``Tell`` gets when it does not look any more
_LONGEST_TICK = 0.2  # s; a longer one is a computer that was late, and the watchdog was late as well
_END = 8.0  # s: the longest wait for a drive; closing waits no longer for the executor's thread

Tell = Callable[[str], None]
Halt = Callable[[], None]


# --- the executor's thread ------------------------------------------------------------------------------


class ExecutorThread:
    """The thread in which the executor ticks. A failure that it could not catch itself stops the machine."""

    def __init__(self, executor: Executor, clock: Clock, tick: float = TICK) -> None:
        self.executor = executor
        self.supervise: Callable[[float], None] = lambda _now: None  # called after each tick
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

    def close(self, limit: float = _END) -> None:
        """Stop the machine as E-stop would leave it, and end the thread.

        A thread that does not end within ``limit`` seconds is left running: the drivers then stop the machine
        in their own way.
        """
        self._closing.set()
        self.executor.wake()
        if self._thread.is_alive():
            self._thread.join(limit)
        if self._thread.is_alive():
            _log.error("the executor's thread does not end; the drivers are halted")
            Halting(self.executor.halt).halt(HALTED_IN)
        elif not self._shut:
            self.executor.shut()  # it has died: no other thread calls the drivers any more

    def _run(self) -> None:
        while not self._closing.is_set():
            with ReportedAttempt(self.executor.failed):
                self.executor.tick()
                self.supervise(self._clock.now())
                if not self.executor.rest():
                    self._clock.sleep_until(self._clock.now() + self._tick)
        self.executor.shut()
        self._shut = True


# --- the watchdog ---------------------------------------------------------------------------------------


def running(name: str) -> bool:
    """Whether a thread of this name is alive."""
    return any(thread.name == name for thread in threading.enumerate())


class Halting:
    """The drivers' own way to stop the machine, on a separate thread: it may block, its caller does not."""

    def __init__(self, halt: Halt | None) -> None:
        self._halt = halt
        self._thread: threading.Thread | None = None

    def halt(self, wait: float = 0.0) -> None:
        """Begin to halt unless the last call is still blocked; wait ``wait`` seconds at most for its end."""
        if self._halt is None:
            return
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(target=self._run, name="halting", daemon=True)
            self._thread.start()
        self._thread.join(wait)

    def _run(self) -> None:
        assert self._halt is not None
        with Attempt() as halting:
            self._halt()
        if halting.error is not None:
            _log.error("the drivers cannot be halted", exc_info=halting.error)


class ThreadWatch:
    """Supervises threads by their names, whenever these start.

    ``tell`` gets the name of a thread that has ended, once. A name is supervised from the first look that
    finds its thread, or from ``watch``.
    """

    def __init__(self, names: Iterable[str], tell: Tell) -> None:
        self._tell = tell
        self._awaited = list(names)  # threads that have not been seen yet
        self._running: list[str] = []
        self._closing = threading.Event()

    def watch(self, name: str) -> None:
        """Supervise the thread of this name from now on, also one that ends before the next look."""
        self._running.append(name)

    def look(self) -> None:
        """Look once; after ``end`` threads that have ended are not told of."""
        for name in [name for name in self._awaited if running(name)]:
            self._awaited.remove(name)
            self._running.append(name)
        for name in [name for name in self._running if not running(name)]:
            self._running.remove(name)
            self._awaited.append(name)  # it may be started again
            if not self._closing.is_set():
                self._tell(name)

    def start(self) -> None:
        """Look once a second, on a thread of its own."""
        threading.Thread(target=self._look_again, name="thread-watch", daemon=True).start()

    def end(self) -> None:
        """Tell no more: threads that end from now on end in good order."""
        self._closing.set()

    def _look_again(self) -> None:
        while not self._closing.wait(LOOK * OTHERS):
            with ReportedAttempt(_report):
                self.look()


def _report(error: BaseException) -> None:
    _log.error("the watch over the threads has failed", exc_info=error)


class Watchdog:
    """Supervises the executor's thread, and other threads by their names, whenever these start.

    ``halt`` is the drivers' own way to stop the machine, None where they have none. ``tell`` gets the name of
    another thread that has ended, once; the executor's own end is an alarm. A name is supervised from the
    first look that finds its thread, or from ``watch``.
    """

    def __init__(
        self, executor: ExecutorThread, halt: Halt | None, others: Iterable[str], tell: Tell
    ) -> None:
        self._executor, self._tell = executor, tell
        self._halting = Halting(halt)
        self._others = ThreadWatch(others, tell)
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name=WATCHDOG, daemon=True)
        self.looks = 0
        self._ticks = -1
        self._still = 0  # looks without a tick
        self._halted = 0

    @property
    def alive(self) -> bool:
        """Whether it still looks."""
        return self._thread.is_alive()

    @property
    def closing(self) -> bool:
        """Whether it was asked to end."""
        return self._closing.is_set()

    def start(self) -> None:
        """Begin to look, and be supervised by the executor's thread."""
        self._executor.supervise = WatchdogWatch(self, self._tell).look
        self._thread.start()

    def watch(self, name: str) -> None:
        """Supervise the thread of this name from now on, also one that ends before the next look."""
        self._others.watch(name)

    def end(self) -> None:
        """Look no more, without waiting: threads that end from now on end in good order."""
        self._closing.set()
        self._others.end()

    def close(self, limit: float = ENDS) -> None:
        """End the thread; one that hangs is left running after ``limit`` seconds."""
        self.end()
        if self._thread.is_alive():
            self._thread.join(limit)

    def look(self) -> None:
        """Look once at the executor and the other threads. Raises nothing."""
        with Attempt() as trial:
            self._mind_executor()
            if self.looks % OTHERS == 0:
                self._others.look()
        self.looks += 1
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
        if self.closing or (not dead and self._still < (PATIENT if executor.patient else STUCK)):
            self._halted = 0
            return
        first, again = self._halted == 0, self._halted % AGAIN == 0 and self._halted < AGAIN * HALTS
        self._halted += 1
        if again:
            self._halting.halt()
        if first:
            executor.declare_silent(
                "the software thread of the control has ended"
                if dead
                else ("the software thread of the control is stuck")
            )


class WatchdogWatch:
    """What the executor's thread sees of the watchdog; ``tell`` gets its name once when it looks no more."""

    def __init__(self, watchdog: Watchdog, tell: Tell) -> None:
        self._watchdog, self._tell = watchdog, tell
        self._looks = -1
        self._last: float | None = None
        self._overdue = 0.0  # s of ticks without a look

    def look(self, now: float) -> None:
        """Look once after a tick. A gap between two ticks counts as a short one: both threads were late."""
        looks, last = self._watchdog.looks, self._last
        self._last = now
        if looks != self._looks or last is None or self._watchdog.closing:
            self._looks, self._overdue = looks, 0.0
            return
        before = self._overdue
        self._overdue += min(max(now - last, 0.0), _LONGEST_TICK)
        if before < OVERDUE <= self._overdue:
            self._tell(WATCHDOG)
