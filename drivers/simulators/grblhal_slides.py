"""Planner and axes of the grblHAL simulator.

The speed on the path always permits a stop at the end of the last block.
"""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from drivers.simulators.grblhal_settings import Registers

Place = tuple[float, float]  # X as a radius, Z; mm
Shape = tuple[float, Callable[[float], Place]]  # Length, and a function from distance to point.
_NOTHING = 5e-7  # radians
_CREEP = 1e-3  # mm/s; prevents a stop just before the end.
_NEAR = 1e-3  # Distance in mm over which a direction is calculated.
_RATE, _ACCELERATION = 110, 120  # settings of the first axis
_STRAIGHT = 0.999999  # Cosine beyond which a corner counts as straight or as a reversal.


@dataclass(slots=True)
class PlannedBlock:
    """Block in the planner, with its path as a function of the distance in mm from its start.

    With ``per_rev``, ``speed`` is in mm per revolution. ``thread`` waits for the spindle index.
    """

    number: int
    length: float
    speed: float
    way: Callable[[float], Place]
    rapid: bool = False
    per_rev: bool = False
    thread: bool = False
    jog: bool = False
    limits: tuple[float, float] | None = None  # Limits of the axes: mm/s, mm/s².

    def heading(self, at: float) -> Place:
        """Return the unit direction of the path at a distance in mm."""
        if isinstance(self.way, _Line):
            return self.way.heading
        first = min(max(at - _NEAR, 0.0), max(self.length - _NEAR, 0.0))
        (x0, z0), (x1, z1) = self.way(first), self.way(min(first + _NEAR, self.length))
        way = math.hypot(x1 - x0, z1 - z0) or 1.0
        return (x1 - x0) / way, (z1 - z0) / way


class _Line:
    """Straight path from ``start`` to ``end`` with a constant ``heading``."""

    def __init__(self, start: Place, end: Place) -> None:
        self._start, self._dx, self._dz = start, end[0] - start[0], end[1] - start[1]
        self.length = math.dist(start, end)
        self.heading = self._dx / (self.length or 1.0), self._dz / (self.length or 1.0)

    def __call__(self, s: float) -> Place:
        part = s / self.length if self.length else 1.0
        return self._start[0] + part * self._dx, self._start[1] + part * self._dz


def straight(start: Place, end: Place) -> Shape:
    """Return the length in mm and the path of a line."""
    line = _Line(start, end)
    return line.length, line


def circle(start: Place, end: Place, centre: Place, *, counter: bool) -> Shape | None:
    """Return the length in mm and the path of an arc in the ZX plane, or None if the end is not on it.

    The angle counts from Z to X. A sweep that is zero or has the wrong sign is changed by one revolution, so
    an arc that rounds to zero becomes a full circle.
    """
    radius = math.dist(start, centre)
    off = abs(math.dist(end, centre) - radius)
    if off > 0.005 and (off > 0.5 or off > 0.001 * radius):
        return None
    (x0, z0), (x1, z1) = (
        (start[0] - centre[0], start[1] - centre[1]),
        (end[0] - centre[0], end[1] - centre[1]),
    )
    sweep = math.atan2(z0 * x1 - x0 * z1, z0 * z1 + x0 * x1)
    if counter and sweep <= _NOTHING:
        sweep += math.tau
    elif not counter and sweep >= -_NOTHING:
        sweep -= math.tau
    first = math.atan2(x0, z0)

    def way(s: float) -> Place:
        angle = first + math.copysign(s / radius, sweep)
        return centre[0] + radius * math.sin(angle), centre[1] + radius * math.cos(angle)

    return radius * abs(sweep), way


class Slides:
    """Planner and axes, advanced in small steps by the firmware."""

    def __init__(self, registers: Registers, capacity: int) -> None:
        self.queue: deque[PlannedBlock] = deque()
        self.capacity = capacity
        self.place: Place = (0.0, 0.0)
        self.v = 0.0
        self.feed = self.rapid = 1.0  # overrides
        self.held = False  # A stop is requested.
        self.travelled = 0.0  # mm since power-up
        self._registers = registers
        self._s = 0.0

    @property
    def begun(self) -> bool:
        """Whether the first block has started, also while it is in feed hold."""
        return self._s > 0.0 or self.v > 0.0

    @property
    def free(self) -> int:
        """The number of blocks that the planner can still accept."""
        return self.capacity - len(self.queue)

    @property
    def moving(self) -> bool:
        """Whether the axes move."""
        return self.v > 0.0

    def drop(self) -> None:
        """Discard all blocks and stop immediately."""
        self.queue.clear()
        self.v = self._s = 0.0

    def step(self, dt: float, turns_per_s: float) -> None:
        """Advance by ``dt`` seconds at a spindle speed of ``turns_per_s``."""
        if not self.queue:
            self.v = 0.0
            return
        block = self.queue[0]
        most, accel = self._limits(block, self._s)
        goal = 0.0 if self.held else self._speed(block, most, turns_per_s)
        change = accel * dt
        self.v = min(self.v + change, goal) if self.v < goal else max(self.v - change, goal)
        self.v = min(self.v, self._allowed(accel, turns_per_s))
        if self.held and self.v < 1.5 * change:
            self.v = 0.0
        self._go(self.v * dt)

    def _limits(self, block: PlannedBlock, at: float) -> tuple[float, float]:
        """Return the speed and acceleration limits at ``at`` mm from the start of the block.

        The limits of a line are constant.
        """
        if block.limits is None or not isinstance(block.way, _Line):
            heading = block.heading(at)
            block.limits = self._along(_RATE, heading) / 60.0, self._along(_ACCELERATION, heading)
        return block.limits

    def _speed(self, block: PlannedBlock, most: float, turns_per_s: float) -> float:
        """Return the speed of a block in mm/s, limited to ``most``; no override affects jogs and threads."""
        speed = min(block.speed * turns_per_s if block.per_rev else block.speed, most)
        if block.rapid:
            return speed * self.rapid
        return speed if block.jog or block.thread else min(speed * self.feed, most)

    def _along(self, first: int, heading: Place) -> float:
        """Return the limit along a direction from the settings of X and Z, as planner.c does.

        ``first`` is the number of the setting for X.
        """
        x, z = abs(heading[0]), abs(heading[1])
        along_x = self._registers[first] / x if x else math.inf
        along_z = self._registers[first + 2] / z if z else math.inf
        return min(along_x, along_z) if x or z else self._registers[first]

    def _allowed(self, accel: float, turns_per_s: float) -> float:
        """Return the highest speed in mm/s that still permits all corners ahead and the stop at the end.

        ``accel`` is the acceleration in the present block in mm/s².
        """
        before = self.queue[0]
        left = max(before.length - self._s, 0.0)
        most, brakes = math.inf, 2.0 * accel * left
        for block in itertools.islice(self.queue, 1, None):
            most_there, accel = self._limits(block, 0.0)
            corner = min(self._corner(before, block), self._speed(block, most_there, turns_per_s))
            most = min(most, math.sqrt(corner**2 + brakes))
            if brakes > self.v**2:
                return most + _CREEP
            before, brakes = block, brakes + 2.0 * accel * block.length
        return min(most, math.sqrt(brakes)) + _CREEP

    def _corner(self, before: PlannedBlock, block: PlannedBlock) -> float:
        """Return the speed limit at the corner of two blocks by the deviation ``$11``; a reversal stops."""
        (x0, z0), (x1, z1) = before.heading(before.length), block.heading(0.0)
        cosine = x0 * x1 + z0 * z1
        if abs(cosine) > _STRAIGHT:
            return math.inf if cosine > 0.0 else 0.0
        half = math.sqrt(0.5 * (1.0 + cosine))  # Sine of half the angle between the two directions.
        turn = math.hypot(x1 - x0, z1 - z0)
        accel = self._along(_ACCELERATION, ((x1 - x0) / turn, (z1 - z0) / turn))
        return math.sqrt(accel * self._registers[11] * half / (1.0 - half))

    def _go(self, way: float) -> None:
        self._s, self.travelled = self._s + way, self.travelled + way
        while self.queue and self._s >= self.queue[0].length - 1e-9:
            done = self.queue.popleft()
            self._s = max(self._s - done.length, 0.0)
            self.place = done.way(done.length)
        if self.queue:
            self.place = self.queue[0].way(self._s)
        else:
            self.v = self._s = 0.0
