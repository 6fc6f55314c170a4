"""Sums over a program while it passes by: lengths, reach, tools; constant memory at any size."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from core.geometry.extent import arc_sweep
from core.geometry.mill import PlaneMove
from core.interpreter.elementary_blocks import Block, Kind, Series
from core.proving.passing import Part
from core.proving.report import Range, Reach


class Span:
    """Least and greatest of what was seen; (0, 0) when nothing was."""

    def __init__(self) -> None:
        self.low, self.high = math.inf, -math.inf

    def see(self, *values: float) -> None:
        """Widen to these values."""
        self.low = min(self.low, *values)
        self.high = max(self.high, *values)

    @property
    def range(self) -> Range:
        """What was seen."""
        return (self.low, self.high) if self.low <= self.high else (0.0, 0.0)


class Tally:
    """Lengths in mm, reach in the program's frame, from the blocks of a program in order."""

    def __init__(self) -> None:
        self.x, self.z, self.c, self.rpm, self.feed = Span(), Span(), Span(), Span(), Span()
        self.axes: list[Span] = []  # machine positions of a mill's axes
        self.cutting_length = 0.0
        self.rapid_length = 0.0

    @property
    def reach(self) -> Reach:
        """What the program reaches."""
        return Reach(self.x.range, self.z.range, self.c.range, self.rpm.range, self.feed.range)

    def add(self, parts: Sequence[Part]) -> None:
        """Count the moving blocks of a stretch."""
        if not parts:
            return
        table = np.concatenate([_rows(part) for part in parts])
        length = np.hypot(table[:, 2] - table[:, 0], table[:, 3] - table[:, 1])
        first = 0
        for part in parts:
            if not isinstance(part, Series):
                self._curved(part, length[first : first + len(part)])
            first += len(part)
        rapid, turned, locked = (table[:, column] > 0.0 for column in (8, 9, 10))
        self.rapid_length += float(length[rapid].sum())
        self.cutting_length += float(length[~rapid].sum())
        for span, column in ((self.x, 2), (self.z, 3), (self.c, 4)):
            span.see(float(table[:, column].min()), float(table[:, column].max()))
        in_degrees = turned | (length == 0.0)  # a rapid of C alone, and what stands
        if not in_degrees.all():
            self._feeds(table[~in_degrees])
        self._turning(table[~(turned | locked)])

    def _curved(self, blocks: Sequence[Block], length: npt.NDArray[np.float64]) -> None:
        """Put in the lengths of ways that are no straight lines of X and Z."""
        for index, block in enumerate(blocks):
            if block.travel is not None:
                length[index] = 0.0 if block.swivels else block.travel.length
                self._see_axes(block)
            elif block.kind is Kind.ARC:
                length[index] = self._arc(block)
            elif block.plane is not None:
                length[index] = self._plane(block, block.plane)

    def _see_axes(self, block: Block) -> None:
        if not self.axes:
            self.axes = [Span() for _ in block.machine_end]
        for span, reach in zip(self.axes, block.machine_reach(), strict=True):
            span.see(*reach)

    def _reach(self, block: Block) -> None:
        low_x, high_x, low_z, high_z = block.reach()
        self.x.see(low_x, high_x)
        self.z.see(low_z, high_z)

    def _arc(self, block: Block) -> float:
        self._reach(block)
        _, sweep = arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)
        return abs(sweep) * math.hypot(block.x0 - block.cx, block.z0 - block.cz)

    def _plane(self, block: Block, way: PlaneMove) -> float:
        self._reach(block)
        low, high = way.reach()
        self.c.see(float(low[2]), float(high[2]))
        return way.length

    def _feeds(self, table: npt.NDArray[np.float64]) -> None:
        rpm = np.abs(table[:, 5])
        path_speed = np.where(table[:, 7] > 0, table[:, 6] * rpm / 60, table[:, 6])
        self.feed.see(float(path_speed.min()), float(path_speed.max()))

    def _turning(self, table: npt.NDArray[np.float64]) -> None:
        """Speeds of the spindle as such; C has its own."""
        rpm = np.abs(table[:, 5])
        turning = rpm[rpm > 0]
        if turning.size:
            self.rpm.see(float(turning.min()), float(turning.max()))


def _rows(part: Part) -> npt.NDArray[np.float64]:
    """What is summed up of each block, a row (11,) each."""
    if not isinstance(part, Series):
        return np.array([_row(block) for block in part])
    rows = np.repeat(np.array([_row(part.pattern)]), len(part), axis=0)
    rows[:, :4] = np.column_stack((part.x0, part.z0, part.x, part.z))
    return rows


def _row(b: Block) -> tuple[float, ...]:
    turned = b.kind is Kind.ROTATE or b.swivels
    return b.x0, b.z0, b.x, b.z, b.c, b.rpm, b.feed, b.per_rev, b.rapid, turned, b.modal.c_locked
