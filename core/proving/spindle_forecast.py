"""Forecast of spindle ramps and collet times, and of the times to start and end a motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from core.machine.machine_model import Machine, SpindleModel

# Seconds before a drive follows a new command; inverters need 50 to 100 ms.
DRIVE_LATENCY_S = 0.08

# Seconds from the end of a motion until the axes are in position and the executor continues. The following
# error of a 40 Hz servo decays in 20 to 30 ms, and the decision is made at the next tick.
SETTLING_TIME_S = 0.035


# Seconds that the executor leaves between the plan of a thread pass and its start.
THREAD_START_LEAD_S = 0.01


def calculate_max_orientation_time_s(spindle: SpindleModel, direction: int) -> float:
    """Return the longest time in seconds to orient the spindle from standstill to an angle.

    The rotation is at most half a revolution, or a full revolution if the direction is specified.
    """
    return DRIVE_LATENCY_S + (60.0 if direction else 30.0) / spindle.orient_rpm


class SpindleForecast:
    """The forecast of the spindle speed over time, and of the times at which the spindle is at speed.

    The speed is in signed rpm and includes the ramps of the drive. Times must not decrease between calls of
    ``command_speed``.
    """

    def __init__(self, machine: Machine) -> None:
        self._model = machine.spindle
        self._from = 0.0
        self._to = 0.0
        self._since = 0.0
        self._turns, self._counted = 0.0, 0.0

    @property
    def target_rpm(self) -> float:
        """Return the commanded speed in rpm, with its sign."""
        return self._to

    def command_speed(self, time_s: float, rpm: float) -> None:
        """Command a new speed at ``time_s``.

        The ramp starts from the speed at that time.
        """
        if rpm == self._to:
            return
        self._turns, self._counted = self.calculate_revolutions_at(time_s), time_s
        self._from, self._to, self._since = self.calculate_speed_at(time_s), rpm, time_s + DRIVE_LATENCY_S

    def calculate_ramp_speed(self, present_rpm: float, rpm: float, interval_s: float) -> float:
        """Return the speed after ``interval_s`` seconds on the ramp from ``present_rpm`` toward ``rpm``."""
        rate = (
            self._model.acceleration_rpm_s if abs(rpm) > abs(present_rpm) else self._model.deceleration_rpm_s
        )
        return present_rpm + max(-rate * interval_s, min(rate * interval_s, rpm - present_rpm))

    def set_speed(self, time_s: float, rpm: float) -> None:
        """Set the speed to ``rpm`` at ``time_s``, after a move with constant surface speed."""
        self._turns, self._counted = self.calculate_revolutions_at(time_s), time_s
        self._from = self._to = rpm
        self._since = time_s

    def calculate_revolutions_at(self, time_s: float) -> float:
        """Return the signed number of revolutions from the start of the program to ``time_s``.

        ``time_s`` must not be before the last command.
        """
        at, ends = self._since, [self._counted, time_s]
        rpm = self._from
        for goal, rate in self._ramp_legs():
            ends += [at, at + abs(goal - rpm) / rate]
            at, rpm = ends[-1], goal
        joints = sorted(joint for joint in ends if self._counted <= joint <= time_s)
        turned = self._turns
        for a, b in pairwise(joints):  # the speed is linear between two joints
            turned += (self.calculate_speed_at(a) + self.calculate_speed_at(b)) / 120.0 * (b - a)
        return turned

    @property
    def max_rpm(self) -> float:
        """Return the maximum speed of the machine, in rpm."""
        return self._model.max_rpm

    def calculate_speed_at(self, time_s: float) -> float:
        """Return the signed rpm at ``time_s``."""
        left = max(0.0, time_s - self._since)
        rpm = self._from
        for goal, rate in self._ramp_legs():
            need = abs(goal - rpm) / rate
            if left < need:
                return rpm + (goal - rpm) * left / need
            left -= need
            rpm = goal
        return self._to

    def calculate_speeds_at(self, times_s: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return the signed rpm at each of ``times_s`` (k,).

        Only the speeds within the ramp are calculated individually.
        """
        ends = self._since + (abs(self._from) + abs(self._to)) / min(
            self._model.acceleration_rpm_s, self._model.deceleration_rpm_s
        )
        found = np.full(len(times_s), self._to)
        for at in np.flatnonzero(times_s <= ends).tolist():
            found[at] = self.calculate_speed_at(float(times_s[at]))
        return found

    def _ramp_legs(self) -> list[tuple[float, float]]:
        """Return the legs of the ramp as (target rpm, rpm/s).

        A reversal first decelerates to rest.
        """
        slow, fast = self._model.deceleration_rpm_s, self._model.acceleration_rpm_s
        if self._from * self._to < 0:
            return [(0.0, slow), (self._to, fast)]
        return [(self._to, fast if abs(self._to) > abs(self._from) else slow)]

    def calculate_slowdown_time_s(self, threshold_rpm: float) -> float:
        """Return the time in seconds at which a stopping spindle falls below ``threshold_rpm``.

        The time is in the past if the spindle is already slower.
        """
        over = abs(self._from) - threshold_rpm
        return self._since + over / self._model.deceleration_rpm_s if over > 0.0 else 0.0

    def calculate_at_speed_time_s(self) -> float:
        """Return the time in seconds from which the spindle is treated as at speed.

        At this time, the spindle has been within the at-speed band long enough.
        """
        rpm, t = self._from, self._since
        band = self._model.at_speed_tolerance * abs(self._to)
        for goal, rate in self._ramp_legs():
            inside = band if goal == self._to else 0.0
            t += max(0.0, abs(goal - rpm) - inside) / rate
            rpm = goal
        return t + self._model.at_speed_time_s
