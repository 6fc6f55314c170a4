"""Straight moves one after the other under one state: columns, a block only where one is asked for.

Nearly all of a long program is such moves, and a block of its own costs more than all that is done with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, overload

import numpy as np
import numpy.typing as npt

from core.interpreter.blocks import Block

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class Series(Sequence[Block]):
    """m straight moves of X and Z, one from the end of the other.

    ``n line x0 z0 x z`` (m,) are those of the blocks; everything else is the same in all and stands in
    ``pattern``, a block such as each of them. ``texts`` are the lines of the program.
    """

    __slots__ = ("line", "n", "pattern", "texts", "x", "x0", "z", "z0")

    def __init__(
        self, pattern: Block, texts: Sequence[str], n: Ints, line: Ints,
        *, x0: Floats, z0: Floats, x: Floats, z: Floats,
    ) -> None:  # fmt: skip
        self.pattern, self.texts = pattern, texts
        self.n, self.line = n, line
        self.x0, self.z0, self.x, self.z = x0, z0, x, z

    def __len__(self) -> int:
        return len(self.n)

    @overload
    def __getitem__(self, at: int) -> Block: ...
    @overload
    def __getitem__(self, at: slice) -> Series: ...
    def __getitem__(self, at: int | slice) -> Block | Series:
        if isinstance(at, slice):
            return self._part(at)
        at = range(len(self))[at]
        return next(iter(self._part(slice(at, at + 1))))

    def __iter__(self) -> Iterator[Block]:
        like, texts = self.pattern, self.texts
        kind, c, modal, feed, per_rev, rpm = like.kind, like.c, like.modal, like.feed, like.per_rev, like.rpm
        offset_x, offset_z = like.offset_x, like.offset_z
        columns = (self.n, self.line, self.x0, self.z0, self.x, self.z)
        for n, line, x0, z0, x, z in zip(*(column.tolist() for column in columns), strict=True):
            yield Block(
                n, line, kind, texts[line - 1], x0, z0, c, x, z, c, offset_x, offset_z,
                modal, feed, per_rev, rpm,
            )  # fmt: skip

    def _part(self, at: slice) -> Series:
        return Series(
            self.pattern, self.texts, self.n[at], self.line[at],
            x0=self.x0[at], z0=self.z0[at], x=self.x[at], z=self.z[at],
        )  # fmt: skip


class TimedSeries(NamedTuple):
    """Moves with the starts and ends (m,) of each on the program's clock, s."""

    series: Series
    t0: Floats
    t1: Floats
