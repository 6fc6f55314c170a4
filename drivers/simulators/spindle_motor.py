"""Simulated spindle motor with a frequency inverter: latency, ramps, an encoder and faults."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from core.ports import BoolArray, FloatArray
from drivers.simulators.plant_config import SimSpindle

_BEARINGS, _SPEEDS_UP, _IN_CUT = 10.0, 70.0, 30.0  # Percent.
_THERE = 1e-9  # turns
_GRABS = 5.0  # Frequency in Hz at which a slipping belt grips.


@dataclass(slots=True)
class SpindleFaults:
    """Faults of the spindle that tests can set."""

    bog: float = 1.0  # fraction of the commanded speed that the motor reaches
    ignores_stop: bool = False
    wander: float = 0.0  # Amplitude of the speed oscillation as a fraction.
    wander_period: float = 2.0  # s
    belt: float = 0.0  # fraction of the speed that a slipping belt loses in the cut
    fault: str = ""
    never_oriented: bool = False  # The drive does not report that the angle is reached.


class OrientOrder(NamedTuple):
    """Command to orient the spindle: ``angle`` in degrees from the index and the direction.

    ``sense`` is 1 as M03, -1 as M04, and 0 for the shortest path.
    """

    angle: float
    sense: int

    def way(self, turns: float) -> float:
        """Return the signed revolutions from ``turns`` to the angle."""
        left = (self.angle / 360.0 - turns) % 1.0
        if left > 1.0 - _THERE:
            left = 0.0
        if self.sense > 0 or (not self.sense and left <= 0.5):
            return left
        return left - 1.0 if left else 0.0


class TurnedSpindle(Protocol):
    """Spindle as its controller sees it: rpm and revolutions, both signed."""

    @property
    def speed(self) -> float: ...

    @property
    def turns(self) -> float: ...

    def advance(self, now: float) -> None: ...

    def order(self, now: float, rpm: float) -> None: ...


class SpindleMotor:
    """Simulated spindle motor, whose speed ramps and angle are calculated in closed form."""

    def __init__(self, config: SimSpindle) -> None:
        self.config = config
        self.faults = SpindleFaults()
        self._even = 0.0  # rpm, without wander
        self.slips = 0.0  # Fraction of the speed that the belt loses now.
        self.cuts = False  # A tool is cutting.
        self.turns = 0.0
        self.t = 0.0
        self._target = 0.0
        self._coasting = False
        self._orders: deque[tuple[float, float, bool]] = deque()
        self._orient: OrientOrder | None = None  # The spindle is at this angle or turning to it.
        self._begins = 0.0  # Start time of the orientation.

    @property
    def speed(self) -> float:
        """The actual speed in rpm, signed."""
        faults = self.faults
        even = self._even * (1.0 - self.slips) + self._turning_there
        if not faults.wander:
            return even
        swing = math.sin(2.0 * math.pi * self.t / faults.wander_period)
        return even * (1.0 + faults.wander * swing)

    @property
    def load(self) -> float:
        """The load in percent: bearing friction, acceleration and cutting.

        The load is a rough estimate; the depth of cut has no effect.
        """
        if not self._even:
            return 0.0
        faster = abs(self._target) * self.faults.bog > abs(self._even) + 1e-9 and not self._coasting
        turning = _BEARINGS * abs(self._even) / self.config.rpm_max
        return min(100.0, turning + (_SPEEDS_UP if faster else 0.0) + (_IN_CUT if self.cuts else 0.0))

    @property
    def still(self) -> bool:
        """Whether the spindle is at rest and no command is pending."""
        return not self._even and not self._target and not self._orders and not self._turning_there

    @property
    def even(self) -> bool:
        """Whether the speed stays constant until a command or a fault."""
        faults = self.faults
        target = 0.0 if faults.fault else self._target * faults.bog
        return self._even == target and not (self._orders or self._orient or faults.wander or self.slips)

    @property
    def counted(self) -> float:
        """The revolutions counted by the encoder, in steps of a quarter pulse."""
        edges = 4 * self.config.ppr
        return round(self.turns * edges) / edges

    def order(self, now: float, rpm: float, coast: bool = False) -> None:
        """Queue a speed command, which takes effect after the latency of the inverter.

        A stop cancels pending speeds. ``coast`` stops without a ramp.
        """
        if self.faults.ignores_stop and abs(rpm) < abs(self._target):
            return
        limit = self.config.rpm_max
        self.release()
        if rpm == 0.0:
            self._orders = deque(waiting for waiting in self._orders if waiting[1] == 0.0)
        self._orders.append((now + self.config.latency, min(max(rpm, -limit), limit), coast))

    def cut(self, now: float) -> None:
        """Switch off the power by hardware, so that the spindle coasts."""
        self._orders.clear()
        self.release()
        self._orders.append((now, 0.0, True))

    # --- orientation --------------------------------------------------------------------------------------

    def orient(self, now: float, angle: float, sense: int) -> None:
        """Turn from standstill to an angle in degrees and hold it, after the latency of the inverter."""
        self._orient, self._begins = OrientOrder(angle, sense), now + self.config.latency

    def release(self) -> None:
        """Cancel the orientation; the spindle stays at its present angle."""
        self._orient = None

    @property
    def oriented(self) -> bool:
        """Whether the spindle has reached the commanded angle and the drive reports it."""
        order = self._orient
        there = order is not None and self.t >= self._begins and not order.way(self.turns)
        return there and not self.faults.never_oriented and not self.faults.fault

    @property
    def _turning_there(self) -> float:
        """The speed in rpm, signed, during the move to the angle."""
        order = self._orient
        if order is None or self.t < self._begins or self._even or self.faults.fault:
            return 0.0
        way = order.way(self.turns)
        return math.copysign(self.config.orient_rpm, way) if way else 0.0

    def _turn_there(self, now: float) -> None:
        """Turn toward the angle at constant speed; acceleration is neglected."""
        order, begins = self._orient, max(self.t, self._begins)
        if order is None or self._even or self.faults.fault or now <= begins:
            return
        way = order.way(self.turns)
        done = self.config.orient_rpm / 60.0 * (now - begins)
        if done >= abs(way):
            self.turns = round(self.turns + way - order.angle / 360.0) + order.angle / 360.0
        else:
            self.turns += math.copysign(done, way)

    def advance(self, now: float) -> None:
        """Advance the spindle to time ``now`` and apply the commands that become due."""
        while self._orders and self._orders[0][0] <= now:
            at, rpm, coast = self._orders.popleft()
            self._ramp(max(at - self.t, 0.0))
            self.t = max(self.t, at)
            self._target, self._coasting = rpm, coast
        self._ramp(now - self.t)
        if self._orient is not None:
            self._turn_there(now)
        self.t = now

    def turn(self, times: FloatArray, cuts: BoolArray) -> FloatArray:
        """Turn to the last of ``times`` and return speed, counted revolutions and load at each time.

        The times are in seconds and the result has the shape (n, 3). ``cuts`` states at which times a tool
        cuts.
        """
        if not self.even:
            return np.array(
                [self._turn_to(*each) for each in zip(times.tolist(), cuts.tolist(), strict=True)]
            )
        edges, self.cuts = 4 * self.config.ppr, False
        rows = np.empty((len(times), 3))
        rows[:, 0] = self._even
        rows[:, 1] = np.rint((self.turns + self._even / 60.0 * (times - self.t)) * edges) / edges
        rows[:, 2] = self.load + _IN_CUT * cuts if self._even else 0.0
        self.advance(float(times[-1]))
        return rows

    def _turn_to(self, t: float, cuts: bool) -> tuple[float, float, float]:
        self.cuts = cuts
        self.advance(t)
        return self.speed, self.counted, self.load

    def cut_load(self, now: float, *, cutting: bool) -> None:
        """Set whether a tool cuts. While it cuts, a slipping belt loses and regains speed."""
        now = max(now, self.t)
        self.advance(now)
        swing = 0.5 - 0.5 * math.cos(2.0 * math.pi * _GRABS * now)
        self.slips = self.faults.belt * swing if cutting else 0.0

    def _ramp(self, dt: float) -> None:
        """Ramp toward the target for ``dt`` seconds, then continue at the target speed."""
        faults, t, held = self.faults, self.t, 1.0 - self.slips
        target = 0.0 if faults.fault else self._target * faults.bog
        while dt > 0.0:
            if self._even == target:
                self.turns += held * self._even / 60.0 * (dt + self._swung(t, dt))
                return
            braking = self._even * target <= 0.0 < abs(self._even) or abs(target) < abs(self._even)
            rate = self.config.decel if braking else self.config.accel
            if braking and (self._coasting or faults.fault):
                rate = self.config.coast
            goal = 0.0 if self._even * target < 0.0 else target
            used = min(dt, abs(goal - self._even) / rate)
            before = self._even
            reached = used < dt
            self._even = goal if reached else before + (rate if goal > before else -rate) * used
            self.turns += held * 0.5 * (before + self._even) / 60.0 * (used + self._swung(t, used))
            dt, t = dt - used, t + used
            if reached and goal == target:
                self.turns += held * self._even / 60.0 * (dt + self._swung(t, dt))
                return

    def _swung(self, t: float, dt: float) -> float:
        """Return the change of ``dt`` seconds from ``t`` on, as equivalent seconds at constant speed.

        The change is caused by the fault ``wander``.
        """
        faults = self.faults
        if not faults.wander:
            return 0.0
        rate = 2.0 * math.pi / faults.wander_period
        return faults.wander * (math.cos(rate * t) - math.cos(rate * (t + dt))) / rate
