"""A program in time: stretches of motion with the blocks that end in them, and of rest."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

from core.interpreter.elementary_blocks import Block, Series, TimedSeries
from core.motion.timeline import Chunk
from core.proving.passing import Part

TimedBlock = tuple[Block, float, float]
"""A block with its start and end on the program's clock, s."""


class Moved(NamedTuple):
    """A stretch of motion from ``t0`` on, and the blocks that end in it with when they start and end."""

    t0: float
    chunk: Chunk
    parts: tuple[Part, ...]

    @property
    def blocks(self) -> list[Block]:
        """Each block, those of series made for whoever asks."""
        return list(chain.from_iterable(self.parts))

    @property
    def last(self) -> Block | None:
        """The last block that ends in it."""
        return self.parts[-1][-1] if self.parts else None

    @property
    def t1(self) -> float:
        """When the stretch ends; the next one may go on without a stop."""
        return self.t0 + self.chunk.profile.duration

    def times(self) -> Iterator[TimedBlock]:
        """Each block with its start and end on the program's clock."""
        for each in self.times_of_parts():
            if isinstance(each, TimedSeries):
                yield from zip(each.series, each.t0.tolist(), each.t1.tolist(), strict=True)
            else:
                yield each

    def times_of_parts(self) -> Iterator[TimedBlock | TimedSeries]:
        """The same, series in one."""
        shift, first = self.t0 - self.chunk.t, 0
        for part in self.parts:
            there = slice(first, first + len(part))
            t0, t1 = self.chunk.t0[there] + shift, self.chunk.t1[there] + shift
            if isinstance(part, Series):
                yield TimedSeries(part, t0, t1)
            else:
                yield from zip(part, t0.tolist(), t1.tolist(), strict=True)
            first = there.stop


class Rested(NamedTuple):
    """At rest from ``t0`` to ``t1``: a block that does not move, or (None) a wait before the next motion."""

    t0: float
    t1: float
    block: Block | None
