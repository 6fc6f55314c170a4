"""Times that the machine needs: spindle ramps, collet, and the start and end of a motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from core.machine.machine_model import Machine, SpindleModel

# Seconds before a drive follows a new command; inverters need 50 to 100 ms.
DRIVE_LATENCY = 0.08

# Seconds from the end of a motion until the axes are in position and the executor continues. The following
# error of a 40 Hz servo decays in 20 to 30 ms, and the decision is made at the next tick.
SETTLING = 0.035


# Seconds that the executor leaves between the plan of a thread pass and its start.
THREAD_EARLY = 0.01


def orienting(spindle: SpindleModel, sense: int) -> float:
    """Return the longest time in seconds from standstill to an angle.

    The rotation is half a revolution, or a full one in a given direction.
    """
    return DRIVE_LATENCY + (60.0 if sense else 30.0) / spindle.orient_rpm


class SpindleForecast:
    """The forecast spindle speed: signed rpm over time as the drive ramps it, and at-speed times.

    Times must not decrease between calls of ``command``.
    """

    def __init__(self, machine: Machine) -> None:
        self._model = machine.spindle
        self._from = 0.0
        self._to = 0.0
        self._since = 0.0
        self._turns, self._counted = 0.0, 0.0

    @property
    def target(self) -> float:
        """The commanded speed in signed rpm."""
        return self._to

    def command(self, t: float, rpm: float) -> None:
        """Command a new speed at time ``t``. The ramp starts from the speed at that time."""
        if rpm == self._to:
            return
        self._turns, self._counted = self.turns(t), t
        self._from, self._to, self._since = self.speed(t), rpm, t + DRIVE_LATENCY

    def towards(self, now: float, rpm: float, dt: float) -> float:
        """Return the speed after ``dt`` seconds on the ramp from ``now`` toward ``rpm``."""
        rate = self._model.accel if abs(rpm) > abs(now) else self._model.decel
        return now + max(-rate * dt, min(rate * dt, rpm - now))

    def settle(self, t: float, rpm: float) -> None:
        """Set the speed to ``rpm`` at time ``t``, after a move with constant surface speed."""
        self._turns, self._counted = self.turns(t), t
        self._from = self._to = rpm
        self._since = t

    def turns(self, t: float) -> float:
        """Return the signed revolutions from the start of the program to ``t``.

        ``t`` must not be before the last command.
        """
        at, ends = self._since, [self._counted, t]
        rpm = self._from
        for goal, rate in self._legs():
            ends += [at, at + abs(goal - rpm) / rate]
            at, rpm = ends[-1], goal
        joints = sorted(joint for joint in ends if self._counted <= joint <= t)
        turned = self._turns
        for a, b in pairwise(joints):  # the speed is linear between two joints
            turned += (self.speed(a) + self.speed(b)) / 120.0 * (b - a)
        return turned

    @property
    def rpm_max(self) -> float:
        """The maximum speed of the machine, in rpm."""
        return self._model.rpm_max

    def speed(self, t: float) -> float:
        """Return the signed rpm at time ``t``."""
        left = max(0.0, t - self._since)
        rpm = self._from
        for goal, rate in self._legs():
            need = abs(goal - rpm) / rate
            if left < need:
                return rpm + (goal - rpm) * left / need
            left -= need
            rpm = goal
        return self._to

    def speeds(self, t: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return ``speed`` at the times ``t`` (k,). Only times within the ramp are computed singly."""
        ends = self._since + (abs(self._from) + abs(self._to)) / min(self._model.accel, self._model.decel)
        found = np.full(len(t), self._to)
        for at in np.flatnonzero(t <= ends).tolist():
            found[at] = self.speed(float(t[at]))
        return found

    def _legs(self) -> list[tuple[float, float]]:
        """Return the ramp as (target rpm, rpm/s). A reversal decelerates to rest first."""
        slow, fast = self._model.decel, self._model.accel
        if self._from * self._to < 0:
            return [(0.0, slow), (self._to, fast)]
        return [(self._to, fast if abs(self._to) > abs(self._from) else slow)]

    def still_at(self, below: float) -> float:
        """Return the time at which a stopping spindle is slower than ``below`` rpm.

        The time is in the past if the spindle is already slower.
        """
        over = abs(self._from) - below
        return self._since + over / self._model.decel if over > 0.0 else 0.0

    def ready_at(self) -> float:
        """Return the time at which the spindle has been within the at-speed band long enough."""
        rpm, t = self._from, self._since
        band = self._model.at_speed * abs(self._to)
        for goal, rate in self._legs():
            inside = band if goal == self._to else 0.0
            t += max(0.0, abs(goal - rpm) - inside) / rate
            rpm = goal
        return t + self._model.at_speed_time
