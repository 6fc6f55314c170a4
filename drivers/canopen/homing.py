"""The drive's own homing, waited for by our own rules: stale bits of the last move must not end it."""

from __future__ import annotations

from enum import Enum

from core.ports import Fault
from drivers.canopen import objects as od
from drivers.canopen.drives import DrivenAxis
from drivers.canopen.states import BIT_12, BIT_13, HALT, HM, NEW, REACHED

_FIRST = 0.1  # s in which "target reached" may still be that of the last move
_MODE = 0.5  # s for a change of mode
_SPARE = 10.0  # s beyond the way at homing speed
_STILL = 0.1  # s without a count before a drive that was halted counts as standing


class _Step(Enum):
    MODE = "waits for the homing mode"
    RUN = "looks for the switch"
    HALT = "brakes, given up"
    BACK = "waits for the old mode"
    DONE = "back in its old mode"


class Homing:
    """One axis. ``step`` once a tick; ``done`` in the end, found or given up, or ``trouble``."""

    def __init__(self, axis: DrivenAxis, back: int, now: float) -> None:
        self.axis = axis
        self.config = axis.config
        self._drive = axis.drive
        self._back = back
        self._step = _Step.MODE
        self._since = now
        self.trouble: Fault | str = ""
        self._write()
        self._drive.mode = HM

    @property
    def done(self) -> bool:
        """The axis stands, and is back in its mode."""
        return self._step is _Step.DONE

    def step(self, now: float) -> None:
        """Look at the status word, and go on."""
        drive, waited = self._drive, now - self._since
        if self._step is _Step.MODE and drive.shown_mode == HM:
            drive.extra |= NEW
            self._enter(_Step.RUN, now)
        elif self._step is _Step.RUN:
            self._look(now, waited)
        elif self._step is _Step.HALT:
            self._brake(now, waited)
        elif self._step is _Step.BACK and drive.shown_mode == self._back:
            self._enter(_Step.DONE, now)
        elif self._step in {_Step.MODE, _Step.BACK} and waited > _MODE:
            self._fail(f"the drive stays in mode {drive.shown_mode}")

    def give_up(self) -> None:
        """Halt: the drive brakes. Its mode changes back once it stands; some refuse that in motion."""
        self._drive.extra = self._drive.extra & ~NEW | HALT
        self._step = _Step.HALT

    def _brake(self, now: float, waited: float) -> None:
        if self.axis.moving or not self._braking:  # the first look after giving up begins the wait
            self._since, self._braking = now, True
        elif waited > _STILL:
            self._leave(now)

    def _leave(self, now: float) -> None:
        self._drive.extra &= ~(NEW | HALT)
        self._drive.mode = self._back
        self._enter(_Step.BACK, now)

    def _look(self, now: float, waited: float) -> None:
        status = self._drive.status
        if status & BIT_13:
            self._fail("the drive reports a homing error; check switch, method and direction")
        elif waited > _FIRST and status & BIT_12 and status & REACHED:
            self._leave(now)
        elif waited > self._longest():
            self._fail("no switch was found within the travel")

    def _longest(self) -> float:
        low, high = self.config.travel or (0.0, 360.0)
        return 2.0 * (high - low) / self.config.home_speed + _SPARE

    def _enter(self, step: _Step, now: float) -> None:
        self._step, self._since = step, now

    def _fail(self, why: str) -> None:
        self._drive.extra &= ~NEW
        self.trouble = Fault(f"{self.config.name}: homing has failed: {why}", "homing")

    def _write(self) -> None:
        """Method, speeds, acceleration and offset. Raises DriverError."""
        config, count = self.config, self.config.count
        slow = config.home_latch or config.home_speed / 10.0
        for index, sub, value in (
            (od.HOME_METHOD, 0, config.home_method),
            (od.HOME_SPEEDS, 1, round(config.home_speed / count)),
            (od.HOME_SPEEDS, 2, round(slow / count)),
            (od.HOME_ACCEL, 0, round(config.amax / count)),
            (od.HOME_OFFSET, 0, round(config.home_offset / count)),
        ):
            self._drive.setup.write(index, sub, value)

    _braking = False
