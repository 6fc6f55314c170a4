"""Planner and axes of the grblHAL simulator.

At any time, the speed along the path is low enough for a stop at the end of the last block.
"""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from drivers.simulators.grblhal_settings import SettingRegisters

Position = tuple[float, float]  # X as a radius, Z; mm
Shape = tuple[float, Callable[[float], Position]]  # Length, and a function from distance to point.
_ANGLE_TOLERANCE = 5e-7  # radians
_MIN_SPEED = 1e-3  # mm/s; prevents a stop just before the end.
_HEADING_STEP_MM = 1e-3  # Distance in mm over which a direction is calculated.
_RATE, _ACCELERATION = 110, 120  # settings of the first axis
_STRAIGHT = 0.999999  # Cosine beyond which a corner counts as straight or as a reversal.


@dataclass(slots=True)
class PlannedBlock:
    """Block in the planner, with its path as a function of the distance traveled in mm.

    If ``is_feed_per_revolution`` is true, ``max_speed`` is in mm per revolution. A block with ``is_thread``
    waits for the spindle index.
    """

    line_number: int
    length_mm: float
    max_speed: float
    path: Callable[[float], Position]
    is_rapid: bool = False
    is_feed_per_revolution: bool = False
    is_thread: bool = False
    is_jog: bool = False
    speed_and_accel_limits: tuple[float, float] | None = None  # Limits of the axes: mm/s, mm/s².

    def get_direction_at(self, distance_mm: float) -> Position:
        """Return the unit direction of the path at ``distance_mm`` from the start of the block."""
        if isinstance(self.path, _Line):
            return self.path.direction
        first = min(max(distance_mm - _HEADING_STEP_MM, 0.0), max(self.length_mm - _HEADING_STEP_MM, 0.0))
        (x0, z0), (x1, z1) = self.path(first), self.path(min(first + _HEADING_STEP_MM, self.length_mm))
        chord_mm = math.hypot(x1 - x0, z1 - z0) or 1.0
        return (x1 - x0) / chord_mm, (z1 - z0) / chord_mm


class _Line:
    """Straight path from ``start`` to ``end``, which has a constant direction."""

    def __init__(self, start: Position, end: Position) -> None:
        self._start, self._dx, self._dz = start, end[0] - start[0], end[1] - start[1]
        self.length_mm = math.dist(start, end)
        self.direction = self._dx / (self.length_mm or 1.0), self._dz / (self.length_mm or 1.0)

    def __call__(self, s: float) -> Position:
        part = s / self.length_mm if self.length_mm else 1.0
        return self._start[0] + part * self._dx, self._start[1] + part * self._dz


def make_line_path(start: Position, end: Position) -> Shape:
    """Return the length in mm and the path of a straight line."""
    line = _Line(start, end)
    return line.length_mm, line


def make_arc_path(
    start: Position, end: Position, center: Position, *, counterclockwise: bool
) -> Shape | None:
    """Return the length in mm and path of an arc in the ZX plane, or None if ``end`` is off the arc.

    The angle counts from Z to X. If the sweep is zero or has the wrong sign, one revolution is added or
    subtracted, so an arc whose angle rounds to zero becomes a full circle.
    """
    radius = math.dist(start, center)
    off = abs(math.dist(end, center) - radius)
    if off > 0.005 and (off > 0.5 or off > 0.001 * radius):
        return None
    (x0, z0), (x1, z1) = (
        (start[0] - center[0], start[1] - center[1]),
        (end[0] - center[0], end[1] - center[1]),
    )
    sweep = math.atan2(z0 * x1 - x0 * z1, z0 * z1 + x0 * x1)
    if counterclockwise and sweep <= _ANGLE_TOLERANCE:
        sweep += math.tau
    elif not counterclockwise and sweep >= -_ANGLE_TOLERANCE:
        sweep -= math.tau
    first = math.atan2(x0, z0)

    def calculate_position(s: float) -> Position:
        angle = first + math.copysign(s / radius, sweep)
        return center[0] + radius * math.sin(angle), center[1] + radius * math.cos(angle)

    return radius * abs(sweep), calculate_position


class GrblMotion:
    """Planner and axes, which the firmware advances in small steps."""

    def __init__(self, registers: SettingRegisters, max_block_count: int) -> None:
        self.block_queue: deque[PlannedBlock] = deque()
        self.max_block_count = max_block_count
        self.position: Position = (0.0, 0.0)
        self.speed = 0.0
        self.feed_override = self.rapid_override = 1.0  # overrides
        self.is_in_hold = False  # A stop is requested.
        self.total_travel_mm = 0.0  # mm since power-up
        self._registers = registers
        self._s = 0.0

    @property
    def has_block_started(self) -> bool:
        """Return whether the first block has started; a block remains started during a feed hold."""
        return self._s > 0.0 or self.speed > 0.0

    @property
    def free_block_count(self) -> int:
        """Return the number of additional blocks that the planner can accept."""
        return self.max_block_count - len(self.block_queue)

    @property
    def is_moving(self) -> bool:
        """Return whether the axes are moving."""
        return self.speed > 0.0

    def discard_blocks(self) -> None:
        """Discard all blocks and stop immediately."""
        self.block_queue.clear()
        self.speed = self._s = 0.0

    def advance(self, seconds: float, spindle_rev_per_s: float) -> None:
        """Advance the axes by ``seconds`` seconds at a spindle speed of ``spindle_rev_per_s``."""
        if not self.block_queue:
            self.speed = 0.0
            return
        block = self.block_queue[0]
        most, accel = self._limits(block, self._s)
        goal = 0.0 if self.is_in_hold else self._target_speed(block, most, spindle_rev_per_s)
        change = accel * seconds
        self.speed = min(self.speed + change, goal) if self.speed < goal else max(self.speed - change, goal)
        self.speed = min(self.speed, self._allowed_speed(accel, spindle_rev_per_s))
        if self.is_in_hold and self.speed < 1.5 * change:
            self.speed = 0.0
        self._go(self.speed * seconds)

    def _limits(self, block: PlannedBlock, at: float) -> tuple[float, float]:
        """Return the axis limits of speed and acceleration for a block, ``at`` mm from its start.

        The limits of a straight line are constant.
        """
        if block.speed_and_accel_limits is None or not isinstance(block.path, _Line):
            heading = block.get_direction_at(at)
            block.speed_and_accel_limits = (
                self._limit_in_direction(_RATE, heading) / 60.0,
                self._limit_in_direction(_ACCELERATION, heading),
            )
        return block.speed_and_accel_limits

    def _target_speed(self, block: PlannedBlock, max_speed: float, turns_per_s: float) -> float:
        """Return the speed of a block in mm/s, limited to ``max_speed``.

        Overrides do not affect jogs and threading blocks.
        """
        speed = min(
            block.max_speed * turns_per_s if block.is_feed_per_revolution else block.max_speed, max_speed
        )
        if block.is_rapid:
            return speed * self.rapid_override
        return speed if block.is_jog or block.is_thread else min(speed * self.feed_override, max_speed)

    def _limit_in_direction(self, first: int, heading: Position) -> float:
        """Return the axis limit along a direction, calculated from the settings of X and Z.

        The calculation is the same as in ``planner.c`` of grblHAL. ``first`` is the number of the setting
        for X.
        """
        x, z = abs(heading[0]), abs(heading[1])
        along_x = self._registers[first] / x if x else math.inf
        along_z = self._registers[first + 2] / z if z else math.inf
        return min(along_x, along_z) if x or z else self._registers[first]

    def _allowed_speed(self, accel: float, turns_per_s: float) -> float:
        """Return the highest speed in mm/s that permits slowing down for all following corners.

        The axes can also stop at the end of the path. ``accel`` is the acceleration in the current block in
        mm/s².
        """
        before = self.block_queue[0]
        left = max(before.length_mm - self._s, 0.0)
        most, brakes = math.inf, 2.0 * accel * left
        for block in itertools.islice(self.block_queue, 1, None):
            most_there, accel = self._limits(block, 0.0)
            corner = min(
                self._corner_speed(before, block), self._target_speed(block, most_there, turns_per_s)
            )
            most = min(most, math.sqrt(corner**2 + brakes))
            if brakes > self.speed**2:
                return most + _MIN_SPEED
            before, brakes = block, brakes + 2.0 * accel * block.length_mm
        return min(most, math.sqrt(brakes)) + _MIN_SPEED

    def _corner_speed(self, previous: PlannedBlock, block: PlannedBlock) -> float:
        """Return the speed limit at the corner between two blocks in mm/s.

        The limit results from the junction deviation ``$11``. The limit is 0 if the path reverses.
        """
        (x0, z0), (x1, z1) = previous.get_direction_at(previous.length_mm), block.get_direction_at(0.0)
        cosine = x0 * x1 + z0 * z1
        if abs(cosine) > _STRAIGHT:
            return math.inf if cosine > 0.0 else 0.0
        half = math.sqrt(0.5 * (1.0 + cosine))  # Sine of half the angle between the two directions.
        turn = math.hypot(x1 - x0, z1 - z0)
        accel = self._limit_in_direction(_ACCELERATION, ((x1 - x0) / turn, (z1 - z0) / turn))
        return math.sqrt(accel * self._registers[11] * half / (1.0 - half))

    def _go(self, distance_mm: float) -> None:
        self._s, self.total_travel_mm = self._s + distance_mm, self.total_travel_mm + distance_mm
        while self.block_queue and self._s >= self.block_queue[0].length_mm - 1e-9:
            done = self.block_queue.popleft()
            self._s = max(self._s - done.length_mm, 0.0)
            self.position = done.path(done.length_mm)
        if self.block_queue:
            self.position = self.block_queue[0].path(self._s)
        else:
            self.speed = self._s = 0.0
