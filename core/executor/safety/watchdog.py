"""The executor's thread and the watchdog, which supervise each other.

The watchdog makes the machine safe if the executor has ended or is stuck. In turn, the executor reports a
watchdog that has ended or is stuck. The watchdog counts its own checks instead of time, so that a pause of
the whole process is not reported. The watchdog calls the drivers only through
``MachinePorts.halt_machine``, which any thread may call. It uses a separate thread for this, because a
driver may block.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable

from core.executor.executor import TICK_PAUSE_S, Executor
from core.executor.raised_alarm import ErrorCatcher, ErrorReporter
from core.ports import Clock

_log = logging.getLogger(__name__)
CHECK_INTERVAL_S = 0.1  # s between two checks
EXECUTOR_CHECKS_PER_THREAD_CHECK = 10  # checks of the executor per check of the other threads
STUCK_CHECK_COUNT = 10  # checks without a tick, 1 s in total
BUSY_STUCK_CHECK_COUNT = 70  # the same while the executor waits for a drive to switch on, which may take 5 s
CHECKS_BETWEEN_HALTS = 5  # checks after which the machine is halted again; a controller in hold is then reset
MAX_HALT_COUNT = 10
WATCHDOG_TIMEOUT_S = 3.0  # s of ticks without a check of the watchdog
CLOSE_TIMEOUT_S = 1.0  # s that closing waits for the watchdog's thread
HALT_TIMEOUT_S = 2.0  # s that closing waits for the drivers to halt
WATCHDOG_THREAD_NAME = (
    "watchdog"  # name of the watchdog's thread, which ``ReportFailure`` receives if the watchdog stops
)
_MAX_TICK_S = 0.2  # s; a longer tick means that the computer was late, and the watchdog as well
_CLOSE_TIMEOUT_S = 8.0  # s, the longest wait for a drive and for the end of the executor's thread

ReportFailure = Callable[[str], None]
HaltFunction = Callable[[], None]


# --- the executor's thread ------------------------------------------------------------------------------


class ExecutorThread:
    """The thread that runs the executor's ticks.

    If an error occurs that the executor cannot catch, the machine stops.
    """

    def __init__(self, executor: Executor, clock: Clock, tick: float = TICK_PAUSE_S) -> None:
        self.executor = executor
        self.check_watchdog: Callable[[float], None] = lambda _now: None  # called after each tick
        self._clock = clock
        self._tick = tick
        self._closing = threading.Event()
        self._shut = False
        self._thread = threading.Thread(target=self._run, name="executor", daemon=True)

    @property
    def is_alive(self) -> bool:
        """Return whether the executor's thread is still running."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Start the thread, which then runs the executor's ticks."""
        self._thread.start()

    def close(self, timeout_s: float = _CLOSE_TIMEOUT_S) -> None:
        """Stop the machine as an E-stop would, and end the thread.

        If the thread does not end within ``timeout_s`` seconds, the drivers halt the machine instead, and
        the thread continues.
        """
        self._closing.set()
        self.executor.start_next_tick()
        if self._thread.is_alive():
            self._thread.join(timeout_s)
        if self._thread.is_alive():
            _log.error("the executor's thread does not end; the drivers are halted")
            MachineHalter(self.executor.halt_function).start_halt(HALT_TIMEOUT_S)
        elif not self._shut:
            self.executor.shut_down()  # The thread has ended, so no other thread calls the drivers.

    def _run(self) -> None:
        while not self._closing.is_set():
            with ErrorReporter(self.executor.handle_failure):
                self.executor.run_tick()
                self.check_watchdog(self._clock.now())
                if not self.executor.wait_at_rest():
                    self._clock.sleep_until(self._clock.now() + self._tick)
        self.executor.shut_down()
        self._shut = True


# --- the watchdog ---------------------------------------------------------------------------------------


def is_python_thread_alive(name: str) -> bool:
    """Return whether a thread with this name is alive."""
    return any(thread.name == name for thread in threading.enumerate())


class MachineHalter:
    """Helper that halts the machine through the drivers.

    It uses a separate thread, because a driver may block.
    """

    def __init__(self, halt: HaltFunction | None) -> None:
        self._halt = halt
        self._thread: threading.Thread | None = None

    def start_halt(self, timeout_s: float = 0.0) -> None:
        """Halt the machine on a separate thread, unless the previous call is still blocked.

        The function waits at most ``timeout_s`` seconds.
        """
        if self._halt is None:
            return
        if self._thread is None or not self._thread.is_alive():
            self._thread = threading.Thread(target=self._run, name="halting", daemon=True)
            self._thread.start()
        self._thread.join(timeout_s)

    def _run(self) -> None:
        assert self._halt is not None
        with ErrorCatcher() as halting:
            self._halt()
        if halting.error is not None:
            _log.error("the drivers cannot be halted", exc_info=halting.error)


class ThreadMonitor:
    """Supervision of threads by their names, including threads that start later.

    ``report_failure`` receives the name of each ended thread once. A thread is supervised from the first
    check that finds it, or from the call of ``watch_thread``.
    """

    def __init__(self, names: Iterable[str], report_failure: ReportFailure) -> None:
        self._tell = report_failure
        self._awaited = list(names)  # =
        self._running: list[str] = []
        self._closing = threading.Event()

    def watch_thread(self, name: str) -> None:
        """Supervise a thread from now on, even if it ends before the next check."""
        self._running.append(name)

    def check_threads(self) -> None:
        """Check all supervised threads once.

        After ``stop_reporting``, ended threads are not reported.
        """
        for name in [name for name in self._awaited if is_python_thread_alive(name)]:
            self._awaited.remove(name)
            self._running.append(name)
        for name in [name for name in self._running if not is_python_thread_alive(name)]:
            self._running.remove(name)
            self._awaited.append(name)  # the thread may be started again
            if not self._closing.is_set():
                self._tell(name)

    def start(self) -> None:
        """Start a separate thread that checks the supervised threads once per second."""
        threading.Thread(target=self._look_again, name="thread-watch", daemon=True).start()

    def stop_reporting(self) -> None:
        """Stop reporting ended threads, because TurnDesk is closing and threads now end normally."""
        self._closing.set()

    def _look_again(self) -> None:
        while not self._closing.wait(CHECK_INTERVAL_S * EXECUTOR_CHECKS_PER_THREAD_CHECK):
            with ErrorReporter(_report):
                self.check_threads()


def _report(error: BaseException) -> None:
    _log.error("the watch over the threads has failed", exc_info=error)


class Watchdog:
    """Supervision of the executor's thread, and of other threads by their names.

    ``halt`` stops the machine through the drivers, or is None if they cannot. The end of the executor's
    thread causes an alarm. If another thread ends, ``report_failure`` receives its name once. A thread is
    supervised from the first check that finds it, or from the call of ``watch_thread``.
    """

    def __init__(
        self,
        executor: ExecutorThread,
        halt: HaltFunction | None,
        thread_names: Iterable[str],
        report_failure: ReportFailure,
    ) -> None:
        self._executor, self._tell = executor, report_failure
        self._halting = MachineHalter(halt)
        self._others = ThreadMonitor(thread_names, report_failure)
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name=WATCHDOG_THREAD_NAME, daemon=True)
        self.check_count = 0
        self._ticks = -1
        self._still = 0  # checks without a tick
        self._halted = 0

    @property
    def is_alive(self) -> bool:
        """Return whether the watchdog is running."""
        return self._thread.is_alive()

    @property
    def is_closing(self) -> bool:
        """Return whether the watchdog has been requested to end."""
        return self._closing.is_set()

    def start(self) -> None:
        """Start the watchdog, and register it for supervision by the executor's thread."""
        self._executor.check_watchdog = WatchdogSupervisor(self, self._tell).check_watchdog
        self._thread.start()

    def watch_thread(self, name: str) -> None:
        """Supervise a thread from now on, even if it ends before the next check."""
        self._others.watch_thread(name)

    def stop_checks(self) -> None:
        """Stop the checks without waiting.

        This is called when TurnDesk closes, because threads then end normally.
        """
        self._closing.set()
        self._others.stop_reporting()

    def close(self, timeout_s: float = CLOSE_TIMEOUT_S) -> None:
        """End the watchdog's thread, or leave it running if it does not end within ``timeout_s`` seconds."""
        self.stop_checks()
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def check_threads(self) -> None:
        """Check the executor and the other threads once. This function never raises an exception."""
        with ErrorCatcher() as trial:
            self._mind_executor()
            if self.check_count % EXECUTOR_CHECKS_PER_THREAD_CHECK == 0:
                self._others.check_threads()
        self.check_count += 1
        if trial.error is not None:
            _log.error("the watchdog has failed", exc_info=trial.error)

    def _watch(self) -> None:
        while not self._closing.wait(CHECK_INTERVAL_S):
            self.check_threads()

    def _mind_executor(self) -> None:
        thread = self._executor
        executor = thread.executor
        moved = executor.tick_count != self._ticks
        self._ticks = executor.tick_count
        self._still = 0 if moved else self._still + 1
        dead = not thread.is_alive
        if self.is_closing or (
            not dead
            and self._still < (BUSY_STUCK_CHECK_COUNT if executor.is_waiting_for_drive else STUCK_CHECK_COUNT)
        ):
            self._halted = 0
            return
        first, again = (
            self._halted == 0,
            self._halted % CHECKS_BETWEEN_HALTS == 0 and self._halted < CHECKS_BETWEEN_HALTS * MAX_HALT_COUNT,
        )
        self._halted += 1
        if again:
            self._halting.start_halt()
        if first:
            executor.show_unresponsive_alarm(
                "the software thread of the control has ended"
                if dead
                else ("the software thread of the control is stuck")
            )


class WatchdogSupervisor:
    """Supervision of the watchdog by the executor.

    ``report_failure`` receives the name of the watchdog once if it stops checking.
    """

    def __init__(self, watchdog: Watchdog, report_failure: ReportFailure) -> None:
        self._watchdog, self._tell = watchdog, report_failure
        self._looks = -1
        self._last: float | None = None
        self._overdue = 0.0  # s of ticks without a check

    def check_watchdog(self, now: float) -> None:
        """Check the watchdog once after each tick.

        After a long gap between two ticks, only a short time is counted, because the watchdog was probably
        delayed too.
        """
        looks, last = self._watchdog.check_count, self._last
        self._last = now
        if looks != self._looks or last is None or self._watchdog.is_closing:
            self._looks, self._overdue = looks, 0.0
            return
        before = self._overdue
        self._overdue += min(max(now - last, 0.0), _MAX_TICK_S)
        if before < WATCHDOG_TIMEOUT_S <= self._overdue:
            self._tell(WATCHDOG_THREAD_NAME)
