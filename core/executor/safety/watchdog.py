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
LOOK = 0.1  # s between two checks
OTHERS = 10  # checks of the executor per check of the other threads
STUCK = 10  # checks without a tick, 1 s in total
PATIENT = 70  # the same while the executor waits for a drive to switch on, which may take 5 s
AGAIN = 5  # checks after which the machine is halted again; a controller in hold is then reset
HALTS = 10
OVERDUE = 3.0  # s of ticks without a check of the watchdog
ENDS = 1.0  # s that closing waits for the watchdog's thread
HALTED_IN = 2.0  # s that closing waits for the drivers to halt
WATCHDOG = "watchdog"  # name of the watchdog's thread, which ``Tell`` receives if the watchdog stops
_LONGEST_TICK = 0.2  # s; a longer tick means that the computer was late, and the watchdog as well
_END = 8.0  # s, the longest wait for a drive and for the end of the executor's thread

Tell = Callable[[str], None]
Halt = Callable[[], None]


# --- the executor's thread ------------------------------------------------------------------------------


class ExecutorThread:
    """The thread in which the executor ticks. An error that the executor cannot catch stops the machine."""

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
        """True if the thread still ticks."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Start the ticks."""
        self._thread.start()

    def close(self, limit: float = _END) -> None:
        """Stop the machine as an E-stop would, and end the thread.

        A thread that does not end within ``limit`` seconds is left running, and the drivers are halted
        instead.
        """
        self._closing.set()
        self.executor.wake()
        if self._thread.is_alive():
            self._thread.join(limit)
        if self._thread.is_alive():
            _log.error("the executor's thread does not end; the drivers are halted")
            Halting(self.executor.halt).halt(HALTED_IN)
        elif not self._shut:
            self.executor.shut()  # The thread has ended, so no other thread calls the drivers.

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
    """Return whether a thread with this name is alive."""
    return any(thread.name == name for thread in threading.enumerate())


class Halting:
    """Halts the machine through the drivers on a separate thread, because a driver may block."""

    def __init__(self, halt: Halt | None) -> None:
        self._halt = halt
        self._thread: threading.Thread | None = None

    def halt(self, wait: float = 0.0) -> None:
        """Start to halt unless the last call is still blocked, and wait at most ``wait`` seconds."""
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
    """Supervises threads by their names, even if they start later.

    ``tell`` receives the name of each thread that has ended, once. A thread is supervised from the first
    check that finds it, or from ``watch``.
    """

    def __init__(self, names: Iterable[str], tell: Tell) -> None:
        self._tell = tell
        self._awaited = list(names)  # =
        self._running: list[str] = []
        self._closing = threading.Event()

    def watch(self, name: str) -> None:
        """Supervise a thread from now on, even if it ends before the next check."""
        self._running.append(name)

    def look(self) -> None:
        """Check the threads once. After ``end``, threads that have ended are not reported."""
        for name in [name for name in self._awaited if running(name)]:
            self._awaited.remove(name)
            self._running.append(name)
        for name in [name for name in self._running if not running(name)]:
            self._running.remove(name)
            self._awaited.append(name)  # the thread may be started again
            if not self._closing.is_set():
                self._tell(name)

    def start(self) -> None:
        """Check once per second on a separate thread."""
        threading.Thread(target=self._look_again, name="thread-watch", daemon=True).start()

    def end(self) -> None:
        """Stop reporting, because threads now end normally."""
        self._closing.set()

    def _look_again(self) -> None:
        while not self._closing.wait(LOOK * OTHERS):
            with ReportedAttempt(_report):
                self.look()


def _report(error: BaseException) -> None:
    _log.error("the watch over the threads has failed", exc_info=error)


class Watchdog:
    """Supervises the executor's thread, and other threads by their names.

    ``halt`` stops the machine through the drivers, or is None if they have no such function. ``tell``
    receives the name of another thread that has ended, once. The end of the executor is an alarm. A thread is
    supervised from the first check that finds it, or from ``watch``.
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
        self._still = 0  # checks without a tick
        self._halted = 0

    @property
    def alive(self) -> bool:
        """True if the watchdog is running."""
        return self._thread.is_alive()

    @property
    def closing(self) -> bool:
        """True if the watchdog was requested to end."""
        return self._closing.is_set()

    def start(self) -> None:
        """Start the watchdog, and let the executor's thread supervise it."""
        self._executor.supervise = WatchdogWatch(self, self._tell).look
        self._thread.start()

    def watch(self, name: str) -> None:
        """Supervise a thread from now on, even if it ends before the next check."""
        self._others.watch(name)

    def end(self) -> None:
        """Stop the checks without waiting, because threads now end normally."""
        self._closing.set()
        self._others.end()

    def close(self, limit: float = ENDS) -> None:
        """End the thread, or leave it running if it does not end within ``limit`` seconds."""
        self.end()
        if self._thread.is_alive():
            self._thread.join(limit)

    def look(self) -> None:
        """Check the executor and the other threads once. Raises nothing."""
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
    """The executor's supervision of the watchdog. ``tell`` receives its name once if it stops checking."""

    def __init__(self, watchdog: Watchdog, tell: Tell) -> None:
        self._watchdog, self._tell = watchdog, tell
        self._looks = -1
        self._last: float | None = None
        self._overdue = 0.0  # s of ticks without a check

    def look(self, now: float) -> None:
        """Check the watchdog once after a tick.

        A gap between two ticks counts as a short one, because both threads were late.
        """
        looks, last = self._watchdog.looks, self._last
        self._last = now
        if looks != self._looks or last is None or self._watchdog.closing:
            self._looks, self._overdue = looks, 0.0
            return
        before = self._overdue
        self._overdue += min(max(now - last, 0.0), _LONGEST_TICK)
        if before < OVERDUE <= self._overdue:
            self._tell(WATCHDOG)
