"""The simulator's planner and slides: blocks on a path, always able to stop at its end."""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from drivers.simulators.grblhal_settings import Registers

Place = tuple[float, float]  # X as a radius, Z; mm
Shape = tuple[float, Callable[[float], Place]]  # length, and distance to place
_NOTHING = 5e-7  # radians
_CREEP = 1e-3  # mm/s: nothing stops a hair before its place
_NEAR = 1e-3  # mm, over which a direction is taken
_RATE, _ACCELERATION = 110, 120  # settings of the first axis
_STRAIGHT = 0.999999  # cosine of a corner that is none, or that turns back


@dataclass(slots=True)
class PlannedBlock:
    """``way``: distance (mm) to place. ``per_rev``: ``speed`` is mm a turn; ``thread`` awaits the index."""

    number: int
    length: float
    speed: float
    way: Callable[[float], Place]
    rapid: bool = False
    per_rev: bool = False
    thread: bool = False
    jog: bool = False
    limits: tuple[float, float] | None = None  # the most that the slides do on it: mm/s, mm/s²

    def heading(self, at: float) -> Place:
        """Direction of the way (unit length) close to a distance."""
        if isinstance(self.way, _Line):
            return self.way.heading
        first = min(max(at - _NEAR, 0.0), max(self.length - _NEAR, 0.0))
        (x0, z0), (x1, z1) = self.way(first), self.way(min(first + _NEAR, self.length))
        way = math.hypot(x1 - x0, z1 - z0) or 1.0
        return (x1 - x0) / way, (z1 - z0) / way


class _Line:
    """Way from ``start`` to ``end``, whose ``heading`` is the same everywhere."""

    def __init__(self, start: Place, end: Place) -> None:
        self._start, self._dx, self._dz = start, end[0] - start[0], end[1] - start[1]
        self.length = math.dist(start, end)
        self.heading = self._dx / (self.length or 1.0), self._dz / (self.length or 1.0)

    def __call__(self, s: float) -> Place:
        part = s / self.length if self.length else 1.0
        return self._start[0] + part * self._dx, self._start[1] + part * self._dz


def straight(start: Place, end: Place) -> Shape:
    """Length and way of a line."""
    line = _Line(start, end)
    return line.length, line


def circle(start: Place, end: Place, centre: Place, *, counter: bool) -> Shape | None:
    """Length and way of an arc in the plane of Z and X; None when the end is not on it.

    The angle from the start to the end counts from Z to X; one that is nothing, or goes the other way, is
    made a turn more or less: so the arc that rounds to nothing becomes a whole circle.
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
    """Advanced in small steps by the firmware; ``turns_per_s`` is the spindle's."""

    def __init__(self, registers: Registers, capacity: int) -> None:
        self.queue: deque[PlannedBlock] = deque()
        self.capacity = capacity
        self.place: Place = (0.0, 0.0)
        self.v = 0.0
        self.feed = self.rapid = 1.0  # overrides
        self.held = False  # asked to stop
        self.travelled = 0.0  # mm since power-up
        self._registers = registers
        self._s = 0.0

    @property
    def begun(self) -> bool:
        """Whether the first block is under way, or held in the middle of it."""
        return self._s > 0.0 or self.v > 0.0

    @property
    def free(self) -> int:
        """Blocks that still fit."""
        return self.capacity - len(self.queue)

    @property
    def moving(self) -> bool:
        """Whether it has speed."""
        return self.v > 0.0

    def drop(self) -> None:
        """Forget every block; stands at once where it is."""
        self.queue.clear()
        self.v = self._s = 0.0

    def step(self, dt: float, turns_per_s: float) -> None:
        """Let ``dt`` pass."""
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
        """Return the most that the slides do ``at`` mm from the block's beginning; a line has one limit."""
        if block.limits is None or not isinstance(block.way, _Line):
            heading = block.heading(at)
            block.limits = self._along(_RATE, heading) / 60.0, self._along(_ACCELERATION, heading)
        return block.limits

    def _speed(self, block: PlannedBlock, most: float, turns_per_s: float) -> float:
        """mm/s, no slide faster than it may. A jog knows no override, a thread none either."""
        speed = min(block.speed * turns_per_s if block.per_rev else block.speed, most)
        if block.rapid:
            return speed * self.rapid
        return speed if block.jog or block.thread else min(speed * self.feed, most)

    def _along(self, first: int, heading: Place) -> float:
        """The most on a way of this direction by the settings of X and Z, from ``first`` on (planner.c)."""
        x, z = abs(heading[0]), abs(heading[1])
        along_x = self._registers[first] / x if x else math.inf
        along_z = self._registers[first + 2] / z if z else math.inf
        return min(along_x, along_z) if x or z else self._registers[first]

    def _allowed(self, accel: float, turns_per_s: float) -> float:
        """Speed from which every corner ahead, and the end, can still be taken as slowly as it has to be.

        ``accel``: mm/s², in the present block.
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
        """The fastest through the joint of two blocks, by the deviation of ``$11``; turning back stops."""
        (x0, z0), (x1, z1) = before.heading(before.length), block.heading(0.0)
        cosine = x0 * x1 + z0 * z1
        if abs(cosine) > _STRAIGHT:
            return math.inf if cosine > 0.0 else 0.0
        half = math.sqrt(0.5 * (1.0 + cosine))  # sine of half the angle between the two ways
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
