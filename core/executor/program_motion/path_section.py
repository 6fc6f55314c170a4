"""A path section: its blocks, their path, and what overrides and stops make of its speeds."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from enum import Enum
from typing import NamedTuple

import numpy as np

from core.interpreter.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.motion.motion_path import Path, PathBuilder


class Progress(Enum):
    """How far the present path section is."""

    DONE = "no move is active, or all moves of the path are finished"
    MOVING = "moving"
    BLOCK_END = "the axes are stopped at the end of a block by Single Block"
    STILL = "the axes are stopped because the override is 0"
    HELD = "the axes are stopped by an external hold"


class Overrides(NamedTuple):
    """Fractions of the programmed speeds. ``spindle``: its speed over the programmed one."""

    feed: float = 1.0
    rapid: float = 1.0
    spindle: float = 1.0


class PathSection:
    """Blocks that are played without a standstill between them."""

    def __init__(self, limits: MotionLimits, rpm_max: float) -> None:
        self._builder = PathBuilder(limits, rpm_max=rpm_max)
        self._blocks: dict[int, Block] = {}
        self.first_block: Block | None = None

    def add(self, blocks: Iterable[Block], reached: float = -np.inf) -> None:
        """Append; ``reached`` as for ``PathBuilder.add``."""
        new = list(blocks)
        self._builder.add(new, reached)
        for block in new:
            self.first_block = self.first_block or block
            self._blocks[block.n] = block

    def block(self, n: int) -> Block | None:
        """The block with this number."""
        return self._blocks.get(n)

    def behind(self, n: int) -> list[Block]:
        """The blocks after this one, in order."""
        return [block for number, block in sorted(self._blocks.items()) if number > n]

    @property
    def length(self) -> float:
        """Length of what is held, mm (degrees where only C turns)."""
        return self._builder.path().length

    @property
    def end_s(self) -> float:
        """Distance of the end."""
        return float(self._builder.path().s[-1])

    @property
    def last_block(self) -> Block | None:
        """The block with the highest number."""
        return self._blocks[max(self._blocks)] if self._blocks else None

    def end_of(self, n: int) -> float:
        """Distance at which this block ends; behind everything when it is not held."""
        path = self._builder.path()
        return path.block_span(n)[1] if n in self._blocks else np.inf

    def drop_before(self, n: int | None) -> None:
        """Forget what lies behind block ``n``."""
        if n is None or n not in self._blocks:
            return
        self._builder.drop_before(n)
        kept = set(self._builder.path().blocks.tolist())
        for old in [number for number in self._blocks if number not in kept and number < n]:
            del self._blocks[old]

    def path(self, overrides: Overrides, last: int | None) -> Path:
        """The path with its speeds scaled; behind block ``last`` they are 0, so that a plan stops there.

        Limits do not depend on the overrides, so a plan made from a moving state meets the limits of the plan
        that it replaces.
        """
        path = self._builder.path()
        if last is None and overrides == (1.0, 1.0, 1.0):
            return path
        factors = [self._factor(n, overrides, last) for n in path.blocks.tolist()]
        rate = path.pieces.rate * np.repeat(factors, np.diff(path.first))
        return dataclasses.replace(path, pieces=dataclasses.replace(path.pieces, rate=rate))

    def stoppable(self, last: int | None, s: float) -> int | None:
        """The first block from ``last`` on that ends at or behind distance ``s`` and may be stopped at.

        None where there is none, as behind a tap that is in its hole.
        """
        path = self._builder.path()
        numbers: list[int] = path.blocks.tolist()
        ends: list[float] = path.s[path.first[1:]].tolist()
        for n, end in zip(numbers, ends, strict=True):
            if (last is None or n >= last) and end >= s - 1e-9 and not self._blocks[n].in_hole:
                return n
        return None

    def _factor(self, n: int, overrides: Overrides, last: int | None) -> float:
        if last is not None and n > last:
            return 0.0
        block = self._blocks[n]
        if block.rapid:
            return overrides.rapid
        if block.coupled:
            return overrides.spindle
        turns = block.per_rev and not block.modal.c_locked
        return overrides.feed * overrides.spindle if turns else overrides.feed
