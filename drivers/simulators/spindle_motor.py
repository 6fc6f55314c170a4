"""Spindle motor behind a frequency inverter: late to obey, ramps, a counting encoder, faults."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from core.ports import BoolArray, FloatArray
from drivers.simulators.plant_config import SimSpindle

_BEARINGS, _SPEEDS_UP, _IN_CUT = 10.0, 70.0, 30.0  # per cent
_THERE = 1e-9  # turns
_GRABS = 5.0  # a second: a belt that slips


@dataclass(slots=True)
class SpindleFaults:
    """What tests may break."""

    bog: float = 1.0  # fraction of the commanded speed that the motor reaches
    ignores_stop: bool = False
    wander: float = 0.0  # fraction by which the speed swings about what it ought to be
    wander_period: float = 2.0  # s
    belt: float = 0.0  # fraction of the speed that a slipping belt loses in the cut
    fault: str = ""
    never_oriented: bool = False  # it turns to its angle, and does not say that it is there


class OrientOrder(NamedTuple):
    """To ``angle``, degrees from the index: by the short way, or in a sense."""

    angle: float
    sense: int

    def way(self, turns: float) -> float:
        """Turns from there on, signed."""
        left = (self.angle / 360.0 - turns) % 1.0
        if left > 1.0 - _THERE:
            left = 0.0
        if self.sense > 0 or (not self.sense and left <= 0.5):
            return left
        return left - 1.0 if left else 0.0


class TurnedSpindle(Protocol):
    """What a controller knows of the spindle that it turns: rpm and turns, both signed."""

    @property
    def speed(self) -> float: ...

    @property
    def turns(self) -> float: ...

    def advance(self, now: float) -> None: ...

    def order(self, now: float, rpm: float) -> None: ...


class SpindleMotor:
    """Speed and angle, advanced in closed form: ramps are straight lines."""

    def __init__(self, config: SimSpindle) -> None:
        self.config = config
        self.faults = SpindleFaults()
        self._even = 0.0  # rpm, without wander
        self.slips = 0.0  # fraction that the belt loses now
        self.cuts = False  # a tool is in the metal
        self.turns = 0.0
        self.t = 0.0
        self._target = 0.0
        self._coasting = False
        self._orders: deque[tuple[float, float, bool]] = deque()
        self._orient: OrientOrder | None = None  # it is held at this angle, or on its way there
        self._begins = 0.0  # from when on

    @property
    def speed(self) -> float:
        """rpm, signed."""
        faults = self.faults
        even = self._even * (1.0 - self.slips) + self._turning_there
        if not faults.wander:
            return even
        swing = math.sin(2.0 * math.pi * self.t / faults.wander_period)
        return even * (1.0 + faults.wander * swing)

    @property
    def load(self) -> float:
        """Per cent of what the motor can: bearings by the speed, speeding up, and a tool in the metal.

        No more than a picture of a real one: how much metal is cut does not count.
        """
        if not self._even:
            return 0.0
        faster = abs(self._target) * self.faults.bog > abs(self._even) + 1e-9 and not self._coasting
        turning = _BEARINGS * abs(self._even) / self.config.rpm_max
        return min(100.0, turning + (_SPEEDS_UP if faster else 0.0) + (_IN_CUT if self.cuts else 0.0))

    @property
    def still(self) -> bool:
        """It stands, and nothing is ordered."""
        return not self._even and not self._target and not self._orders and not self._turning_there

    @property
    def even(self) -> bool:
        """Whether its speed stays the same until something is ordered or breaks."""
        faults = self.faults
        target = 0.0 if faults.fault else self._target * faults.bog
        return self._even == target and not (self._orders or self._orient or faults.wander or self.slips)

    @property
    def counted(self) -> float:
        """Turns as the encoder counts them, in steps of its four edges."""
        edges = 4 * self.config.ppr
        return round(self.turns * edges) / edges

    def order(self, now: float, rpm: float, coast: bool = False) -> None:
        """Accept a command, obeyed after the inverter's latency; a stop cancels speeds that still wait."""
        if self.faults.ignores_stop and abs(rpm) < abs(self._target):
            return
        limit = self.config.rpm_max
        self.release()
        if rpm == 0.0:
            self._orders = deque(waiting for waiting in self._orders if waiting[1] == 0.0)
        self._orders.append((now + self.config.latency, min(max(rpm, -limit), limit), coast))

    def cut(self, now: float) -> None:
        """Power off by hardware: coasts, whatever was ordered."""
        self._orders.clear()
        self.release()
        self._orders.append((now, 0.0, True))

    # --- held at an angle ---------------------------------------------------------------------------------

    def orient(self, now: float, angle: float, sense: int) -> None:
        """From standstill to an angle, in which it is then held; obeyed after the same latency."""
        self._orient, self._begins = OrientOrder(angle, sense), now + self.config.latency

    def release(self) -> None:
        """Whatever is ordered else ends it; it stands where it has come to."""
        self._orient = None

    @property
    def oriented(self) -> bool:
        """Whether it stands where it was sent, and says so."""
        order = self._orient
        there = order is not None and self.t >= self._begins and not order.way(self.turns)
        return there and not self.faults.never_oriented and not self.faults.fault

    @property
    def _turning_there(self) -> float:
        """rpm, signed, while it turns to its angle."""
        order = self._orient
        if order is None or self.t < self._begins or self._even or self.faults.fault:
            return 0.0
        way = order.way(self.turns)
        return math.copysign(self.config.orient_rpm, way) if way else 0.0

    def _turn_there(self, now: float) -> None:
        """On its way at an even speed: what little it accelerates at such a speed is left out."""
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
        """Move on to ``now``, order by order."""
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
        """Turn to the last of ``times`` (s); return speed, counted turns and load at each of them, (n, 3).

        ``cuts``: whether a tool cuts then.
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
        """A tool is in the metal or not: under it a belt that slips lets go and grabs again."""
        now = max(now, self.t)
        self.advance(now)
        swing = 0.5 - 0.5 * math.cos(2.0 * math.pi * _GRABS * now)
        self.slips = self.faults.belt * swing if cutting else 0.0

    def _ramp(self, dt: float) -> None:
        """Towards the target for ``dt`` seconds, then on at its speed."""
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
        """What wander makes of ``dt`` seconds from ``t`` on, as seconds at an even speed."""
        faults = self.faults
        if not faults.wander:
            return 0.0
        rate = 2.0 * math.pi / faults.wander_period
        return faults.wander * (math.cos(rate * t) - math.cos(rate * (t + dt))) / rate
