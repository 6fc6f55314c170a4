"""The drive's own homing, waited for by our own rules: stale bits of the last move must not end it."""

from __future__ import annotations

from enum import Enum

from drivers.canopen import objects as od
from drivers.canopen.config import AxisConfig
from drivers.canopen.drive import Drive402
from drivers.canopen.states import BIT_12, BIT_13, HM, NEW, REACHED

_FIRST = 0.1  # s in which "target reached" may still be that of the last move
_MODE = 0.5  # s for a change of mode
_SPARE = 10.0  # s beyond the way at homing speed


class _Step(Enum):
    MODE = "waits for the homing mode"
    RUN = "looks for the switch"
    BACK = "waits for the old mode"
    DONE = "knows where it is"


class Homing:
    """One axis. ``step`` once a tick; ``done`` in the end, or ``trouble``."""

    def __init__(self, config: AxisConfig, drive: Drive402, back: int, now: float) -> None:
        self.config = config
        self._drive = drive
        self._back = back
        self._step = _Step.MODE
        self._since = now
        self.trouble = ""
        _write(config, drive)
        drive.mode = HM

    @property
    def done(self) -> bool:
        """The axis is homed and back in its mode."""
        return self._step is _Step.DONE

    def step(self, now: float) -> None:
        """Look at the status word, and go on."""
        drive, waited = self._drive, now - self._since
        if self._step is _Step.MODE and drive.shown_mode == HM:
            drive.extra |= NEW
            self._enter(_Step.RUN, now)
        elif self._step is _Step.RUN:
            self._look(now, waited)
        elif self._step is _Step.BACK and drive.shown_mode == self._back:
            self._enter(_Step.DONE, now)
        elif self._step in {_Step.MODE, _Step.BACK} and waited > _MODE:
            self._fail(f"the drive stays in mode {drive.shown_mode}")

    def give_up(self) -> None:
        """Bit 4 falls: the drive brakes."""
        self._drive.extra &= ~NEW
        self._drive.mode = self._back

    def _look(self, now: float, waited: float) -> None:
        status = self._drive.status
        if status & BIT_13:
            self._fail("the drive reports a homing error; check switch, method and direction")
        elif waited > _FIRST and status & BIT_12 and status & REACHED:
            self.give_up()
            self._enter(_Step.BACK, now)
        elif waited > self._longest():
            self._fail("no switch was found within the travel")

    def _longest(self) -> float:
        low, high = self.config.travel or (0.0, 360.0)
        return 2.0 * (high - low) / self.config.home_speed + _SPARE

    def _enter(self, step: _Step, now: float) -> None:
        self._step, self._since = step, now

    def _fail(self, why: str) -> None:
        self.give_up()
        self.trouble = f"{self.config.name}: homing has failed: {why}"


def _write(config: AxisConfig, drive: Drive402) -> None:
    """Method, speeds, acceleration and offset. Raises DriverError."""
    count = config.count
    slow = config.home_latch or config.home_speed / 10.0
    for index, sub, value in (
        (od.HOME_METHOD, 0, config.home_method),
        (od.HOME_SPEEDS, 1, round(config.home_speed / count)),
        (od.HOME_SPEEDS, 2, round(slow / count)),
        (od.HOME_ACCEL, 0, round(config.amax / count)),
        (od.HOME_OFFSET, 0, round(config.home_offset / count)),
    ):
        drive.setup.write(index, sub, value)
