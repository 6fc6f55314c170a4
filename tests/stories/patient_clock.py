"""Machine time of a story: it stops while the computer is too busy for the control or the screen.

A story tests what TurnDesk does, not how fast this computer is. The control's thread and Qt's thread each
report a beat whenever they run. Machine time is never later than the older beat plus ``GRACE``, so neither
thread is ever late. A story about a stall calls ``run_in_real_time`` before the stall.
"""

from __future__ import annotations

import threading
import time

from app.compose.control import control_attachment
from app.screen.window import input_times
from drivers.wakeups import RealClock

GRACE = 0.12  # s; the control at rest ticks every 0.095 s
_CONTROL, _SCREEN = "control", "screen"


class PatientClock:
    """Seconds of machine time. Thread-safe; never goes back."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._origin = self._since = time.monotonic()  # machine time, and the real time at which it was that
        self._beats: dict[str, float] = {}
        self._is_real = False
        self.rate = 1.0  # seconds of machine time per second

    def now(self) -> float:
        """Return machine time; a call from the control's thread is its beat."""
        if threading.current_thread().name == "executor":
            return self._beat(_CONTROL)
        with self._lock:
            return self._time()

    def beat_of_screen(self) -> None:
        """Report that Qt's thread handles events."""
        self._beat(_SCREEN)

    def run_in_real_time(self) -> None:
        """Follow the monotonic clock from now on, so that delays count."""
        with self._lock:
            self._settle(self._time())
            self._is_real, self.rate = True, 1.0

    def run_at(self, rate: float) -> None:
        """Let machine time pass ``rate`` times as fast as real time."""
        with self._lock:
            self._settle(self._time())
            self.rate = rate

    def _beat(self, whose: str) -> float:
        with self._lock:
            now = self._time()
            if not self._is_real:
                self._settle(now)
            self._beats[whose] = now
            return now

    def _settle(self, now: float) -> None:
        self._origin, self._since = now, time.monotonic()

    def _time(self) -> float:
        now = self._origin + self.rate * (time.monotonic() - self._since)
        if self._is_real:
            return now
        control, screen = self._beats.get(_CONTROL, now), self._beats.get(_SCREEN, now)
        return min(now, control + GRACE, screen + GRACE * self.rate)


CLOCK = PatientClock()
_STALL = input_times.STALL_TIME_S


def install() -> None:
    """Replace the time of every ``RealClock`` of this process, and let no key count as late."""

    def begin(clock: RealClock, zero: float | None = None) -> None:
        clock.origin_s = CLOCK.now() if zero is None else zero

    def now(clock: RealClock) -> float:
        return CLOCK.now() - clock.origin_s

    def sleep_until(clock: RealClock, t: float) -> None:
        time.sleep(max(t - clock.now(), 0.0) / CLOCK.rate)

    setattr(RealClock, "__init__", begin)  # noqa: B010
    setattr(RealClock, "sleep_until", sleep_until)  # noqa: B010
    setattr(RealClock, "now", now)  # noqa: B010
    # One process has one machine time: the control runs on a thread here, as it does on Windows.
    setattr(control_attachment, "USES_OWN_PROCESS", False)  # noqa: B010
    input_times.STALL_TIME_S = float("inf")


def run_in_real_time() -> None:
    """Let delays of machine time and of keys count from now on."""
    input_times.STALL_TIME_S = _STALL
    CLOCK.run_in_real_time()
