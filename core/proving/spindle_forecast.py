"""How long the machine itself takes: spindle ramps, collet, the start and end of a motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from core.machine.machine_model import Machine, SpindleModel

# Seconds before a drive follows a new command; inverters need 50 to 100 ms.
DRIVE_LATENCY = 0.08

# Seconds from the end of a motion until the slides are in position and the executor goes on: the following
# error of a 40 Hz servo dies away in 20 to 30 ms, and a decision falls on the next tick.
SETTLING = 0.035


# Seconds that the executor leaves between the plan of a thread pass and its start.
THREAD_EARLY = 0.01


def orienting(spindle: SpindleModel, sense: int) -> float:
    """Seconds from standstill to an angle, by the longest way: half a turn, or a whole one in a sense."""
    return DRIVE_LATENCY + (60.0 if sense else 30.0) / spindle.orient_rpm


class SpindleForecast:
    """The spindle as its drive ramps it: signed rpm over time, and when it will have been at speed.

    Times must not go backwards between calls of ``command``.
    """

    def __init__(self, machine: Machine) -> None:
        self._model = machine.spindle
        self._from = 0.0
        self._to = 0.0
        self._since = 0.0
        self._turns, self._counted = 0.0, 0.0

    @property
    def target(self) -> float:
        """The command in force, signed rpm."""
        return self._to

    def command(self, t: float, rpm: float) -> None:
        """A new command at ``t``; the ramp starts from the speed of that moment."""
        if rpm == self._to:
            return
        self._turns, self._counted = self.turns(t), t
        self._from, self._to, self._since = self.speed(t), rpm, t + DRIVE_LATENCY

    def towards(self, now: float, rpm: float, dt: float) -> float:
        """Constant surface speed: how far the drive comes from ``now`` towards ``rpm`` within ``dt``."""
        rate = self._model.accel if abs(rpm) > abs(now) else self._model.decel
        return now + max(-rate * dt, min(rate * dt, rpm - now))

    def settle(self, t: float, rpm: float) -> None:
        """At ``t`` the spindle turns at ``rpm``: what a move under constant surface speed has led to."""
        self._turns, self._counted = self.turns(t), t
        self._from = self._to = rpm
        self._since = t

    def turns(self, t: float) -> float:
        """Signed revolutions from the start of the program to ``t``; not before the last command."""
        at, ends = self._since, [self._counted, t]
        rpm = self._from
        for goal, rate in self._legs():
            ends += [at, at + abs(goal - rpm) / rate]
            at, rpm = ends[-1], goal
        joints = sorted(joint for joint in ends if self._counted <= joint <= t)
        turned = self._turns
        for a, b in pairwise(joints):  # the speed runs straight between two joints
            turned += (self.speed(a) + self.speed(b)) / 120.0 * (b - a)
        return turned

    @property
    def rpm_max(self) -> float:
        """The fastest the machine allows, rpm."""
        return self._model.rpm_max

    def speed(self, t: float) -> float:
        """Signed rpm at ``t``."""
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
        """``speed`` at the times ``t`` (k,): only those within the ramp are asked for one by one."""
        ends = self._since + (abs(self._from) + abs(self._to)) / min(self._model.accel, self._model.decel)
        found = np.full(len(t), self._to)
        for at in np.flatnonzero(t <= ends).tolist():
            found[at] = self.speed(float(t[at]))
        return found

    def _legs(self) -> list[tuple[float, float]]:
        """The ramp as (rpm to reach, rpm/s): a reversal slows to rest first."""
        slow, fast = self._model.decel, self._model.accel
        if self._from * self._to < 0:
            return [(0.0, slow), (self._to, fast)]
        return [(self._to, fast if abs(self._to) > abs(self._from) else slow)]

    def still_at(self, below: float) -> float:
        """When a spindle that was told to stop turns slower than ``below`` rpm; the past where it stands."""
        over = abs(self._from) - below
        return self._since + over / self._model.decel if over > 0.0 else 0.0

    def ready_at(self) -> float:
        """When the speed will have been within the at-speed band for as long as the machine file asks."""
        rpm, t = self._from, self._since
        band = self._model.at_speed * abs(self._to)
        for goal, rate in self._legs():
            inside = band if goal == self._to else 0.0
            t += max(0.0, abs(goal - rpm) - inside) / rate
            rpm = goal
        return t + self._model.at_speed_time
