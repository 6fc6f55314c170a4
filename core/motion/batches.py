"""Blocks as they come in, one by one or in rows, put together to batches that are planned at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields
from typing import Any, Protocol, TypeGuard

import numpy as np

from core.motion.limits import FloatArray, IntArray
from core.motion.words import MotionBlock, Words, read_words

_FIELDS = tuple(f.name for f in fields(Words))


class Row(Protocol):
    """m straight moves of X and Z as columns (m,); in all else each of them is as ``pattern`` is."""

    @property
    def pattern(self) -> MotionBlock: ...
    @property
    def n(self) -> IntArray: ...
    @property
    def x0(self) -> FloatArray: ...
    @property
    def z0(self) -> FloatArray: ...
    @property
    def x(self) -> FloatArray: ...
    @property
    def z(self) -> FloatArray: ...
    def __len__(self) -> int: ...
    def __getitem__(self, at: slice, /) -> Row: ...


Part = list[Any] | Row
"""Blocks one by one, or a row."""


def batches(blocks: Iterable[MotionBlock | Row], first: int, window: int) -> Iterator[tuple[list[Part], int]]:
    """Batches of ``window`` blocks and how many each has: the first of ``first``, the last of what is left.

    Takes no block before the batch that was full is asked on from; rows are cut where a batch ends.
    """
    batch: list[Part] = []
    singles: list[Any] = []
    room = size = first
    for each in blocks:
        if _is_row(each):
            rest = each
            while len(rest) >= room:
                yield [*batch, rest[:room]], size
                rest, batch, room, size = rest[room:], [], window, window
            if len(rest):
                batch.append(rest)
                room -= len(rest)
            continue
        if not batch or batch[-1] is not singles:
            singles = []
            batch.append(singles)
        singles.append(each)
        room -= 1
        if not room:
            yield batch, size
            batch, room, size = [], window, window
    if batch:
        yield batch, size - room


def _is_row(each: MotionBlock | Row) -> TypeGuard[Row]:
    return isinstance(each, Sequence)  # blocks have no length


def words_of(batch: Sequence[Part], rpm_max: float) -> Words:
    """The words of all blocks of a batch; see ``read_words``."""
    parts = [read_words(p, rpm_max) if isinstance(p, list) else _row_words(p, rpm_max) for p in batch]
    if len(parts) == 1:
        return parts[0]
    return Words(*[_joined([getattr(part, name) for part in parts]) for name in _FIELDS])


def _joined(columns: list[Any]) -> Any:
    """Columns one below the other: arrays, or the ways, which are a tuple."""
    return sum(columns, ()) if isinstance(columns[0], tuple) else np.concatenate(columns)


def _row_words(row: Row, rpm_max: float) -> Words:
    like, m = row.pattern, len(row)
    one = read_words([like], rpm_max)
    many: dict[str, Any] = {name: getattr(one, name) for name in _FIELDS}
    many = {k: c * m if isinstance(c, tuple) else np.repeat(c, m, axis=0) for k, c in many.items()}
    many["n"] = row.n.astype(np.float64)
    for name, x, z in (("start", row.x0, row.z0), ("end", row.x, row.z)):
        many[name][:, 0], many[name][:, 1] = x + like.offset_x, z + like.offset_z
    return Words(**many)
