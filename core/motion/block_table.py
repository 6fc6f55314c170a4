"""Elementary blocks as a table of numbers for the motion planner, with one row per block.

Blocks arrive individually or as series, and are combined into batches that are planned together.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from itertools import chain, repeat
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Protocol, TypeGuard

import numpy as np

from core.message import Message
from core.motion.axis_limits import BoolArray, FloatArray, IntArray, MotionError

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove
    from core.geometry.working_plane import AxisMove, CurvedMove


class ModalStateLike(Protocol):
    """The modal values that the planner uses.

    The values are the rpm limits of constant surface speed, the shift of C in degrees, and whether the
    spindle is engaged as the C axis.
    """

    @property
    def min_css_rpm(self) -> float:
        """Return the minimum spindle speed in rpm under constant surface speed."""
        ...

    @property
    def max_css_rpm(self) -> float | None:
        """Return the maximum spindle speed in rpm under constant surface speed.

        None means that there is no limit.
        """
        ...

    @property
    def offset_c(self) -> float:
        """Return the shift of C in degrees."""
        ...

    @property
    def c_locked(self) -> bool:
        """Return whether the spindle is engaged as the C axis."""
        ...


class MotionBlock(Protocol):
    """An elementary block as the interpreter creates it.

    Positions are in mm, with X as a radius, or in degrees. Feeds are in mm/s or mm/rev.
    """

    n: int
    x0: float
    z0: float
    c0: float
    x: float
    z: float
    c: float
    offset_x: float
    offset_z: float
    feed: float
    per_rev: bool
    rpm: float
    css: float | None
    cx: float
    cz: float
    clockwise: bool
    plane: PlaneMove | None
    travel: AxisMove | None

    @property
    def kind(self) -> str:
        """Return the kind of the block, such as ``feed``, ``rapid`` or ``arc``."""
        ...

    @property
    def rapid(self) -> bool:
        """Return whether the block is a rapid."""
        ...

    @property
    def modal(self) -> ModalStateLike:
        """Return the modal values that apply to the block."""
        ...


KIND_CODES = {"rapid": 0, "feed": 1, "arc": 2, "rotate": 3, "plane-line": 4, "plane-arc": 5, "thread": 6}
KIND_CODES["plane"] = 7  # swivel of rotary axes in Klartext
_COLUMNS = ("n", "x0", "z0", "c0", "x", "z", "c", "offset_x", "offset_z", "feed", "rpm", "cx", "cz")
_read_columns = attrgetter(*_COLUMNS, "per_rev", "clockwise", "modal.offset_c", "modal.c_locked")


@dataclass(frozen=True, slots=True)
class BlockTable:
    """A table of m blocks, with one array per column.

    Positions are stored in memory axis by axis, because columns are faster than rows.

    - ``start`` and ``end`` (m, axes) and ``centre`` (m, 2) are in machine coordinates.
    - ``axis`` (m,) is the machine X of the spindle centerline, from which radii are measured.
    - ``locked`` (m,) is True while the spindle is engaged as the C axis. A feed per revolution then
      refers to the revolutions of C.
    - ``surface`` (m,) is the surface speed in mm/s, or NaN without a surface speed.
    - ``min_rpm`` and ``max_rpm`` (m,) are the limits of the spindle speed for this surface speed.
    - ``curved_moves`` has m entries: a move on which the axes are not proportional, such as a move of the
      virtual mill, or None for any other move.
    - ``length`` (m,) is the path length of blocks that specify all axes. For a lathe, it is NaN, because
      the length follows from X, Z and C.
    """

    n: FloatArray
    start: FloatArray
    end: FloatArray
    centre: FloatArray
    axis: FloatArray
    feed: FloatArray
    rpm: FloatArray
    per_rev: BoolArray
    clockwise: BoolArray
    rapid: BoolArray
    arc: BoolArray
    thread: BoolArray
    locked: BoolArray
    surface: FloatArray
    min_rpm: FloatArray
    max_rpm: FloatArray
    curved_moves: tuple[CurvedMove | None, ...]
    length: FloatArray


def build_block_table(blocks: Sequence[MotionBlock], rpm_max: float) -> BlockTable:
    """Return the table of blocks that move an axis.

    ``rpm_max`` is the maximum spindle speed in rpm. Raises MotionError with the block number in these cases:
    - The kind of a block cannot be planned.
    - A value is not a finite number, or a surface speed is negative or not finite.
    - Only some of the blocks specify all axes.
    """
    width = len(_COLUMNS) + 4
    table = np.fromiter(chain.from_iterable(map(_read_columns, blocks)), np.float64).reshape(-1, width)
    _demand_finite(table)
    kinds = _kinds(blocks)
    shift = table[:, 7:9]
    start, end = table[:, 1:4].copy(order="F"), table[:, 4:7].copy(order="F")
    start[:, :2] += shift
    end[:, :2] += shift
    start[:, 2] += table[:, 15]
    end[:, 2] += table[:, 15]
    length = np.full(len(blocks), np.nan)
    if blocks[0].travel is not None:
        start, end, length = _travel_columns(blocks)
    surface, lo, hi = _surface(blocks, rpm_max)
    return BlockTable(
        n=table[:, 0],
        start=start,
        end=end,
        centre=table[:, 11:13] + shift,
        axis=table[:, 7],
        feed=table[:, 9],
        rpm=np.minimum(np.abs(table[:, 10]), rpm_max),
        per_rev=((table[:, 13] != 0.0) & (kinds != KIND_CODES["rapid"])) | (kinds == KIND_CODES["thread"]),
        clockwise=table[:, 14] != 0.0,
        rapid=_find_rapids(blocks, kinds),
        arc=kinds == KIND_CODES["arc"],
        thread=kinds == KIND_CODES["thread"],
        locked=table[:, 16] != 0.0,
        surface=surface,
        min_rpm=lo,
        max_rpm=hi,
        curved_moves=tuple(_way(block) for block in blocks),
        length=length,
    )


def _find_rapids(blocks: Sequence[MotionBlock], kinds: FloatArray) -> BoolArray:
    """Return a mask (m,) of the blocks to which the rapid override applies."""
    rapid: BoolArray = kinds == KIND_CODES["rapid"]
    for i in np.flatnonzero((kinds == KIND_CODES["plane"]) | (kinds == KIND_CODES["plane-line"])).tolist():
        rapid[i] = blocks[i].rapid
    return rapid


def _way(block: MotionBlock) -> CurvedMove | None:
    return block.plane if block.travel is None else block.travel.curved_move


def _travel_columns(blocks: Sequence[MotionBlock]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the start and end (m, axes) and the length (m,) of blocks that specify all axes."""
    travels = [block.travel for block in blocks if block.travel is not None]
    if len(travels) != len(blocks):
        raise MotionError(
            Message("Block {number} specifies all axes, but a later block does not.", number=blocks[0].n),
            "axes-differ",
        )
    start, end = (np.array([getattr(t, name) for t in travels], order="F") for name in ("start", "end"))
    return start, end, np.array([t.length for t in travels])


def _kinds(blocks: Sequence[MotionBlock]) -> FloatArray:
    try:
        return np.array([KIND_CODES[b.kind] for b in blocks], dtype=np.float64)
    except KeyError:
        block = next(b for b in blocks if b.kind not in KIND_CODES)
        raise MotionError(
            Message(
                "Block {number}: a {kind} block cannot be planned as a motion.",
                number=block.n,
                kind=block.kind,
            ),
            "no-time-law",
        ) from None


def _demand_finite(table: FloatArray) -> None:
    bad = ~np.isfinite(table).all(axis=1)
    if bad.any():
        row = table[bad.argmax()]
        names = (*_COLUMNS, "per_rev", "clockwise", "offset_c", "c_locked")
        name = names[int(np.argmax(~np.isfinite(row)))]
        raise MotionError(
            Message(
                "Block {row}: {name} is not a number; correct the block.", row=f"{row[0]:.0f}", name=name
            ),
            "not-a-number",
        )


def _surface(blocks: Sequence[MotionBlock], rpm_max: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    surface = np.full(len(blocks), np.nan)
    lo, hi = np.zeros(len(blocks)), np.full(len(blocks), rpm_max)
    for i, block in enumerate(blocks):
        if block.css is not None:
            if not 0.0 <= block.css < math.inf:
                raise MotionError(
                    Message(
                        "Block {number}: surface speed css = {css} mm/s is not valid. Program a "
                        "surface speed with S.",
                        number=block.n,
                        css=block.css,
                    ),
                    "surface-speed",
                )
            surface[i], lo[i] = block.css, block.modal.min_css_rpm
            hi[i] = rpm_max if block.modal.max_css_rpm is None else min(block.modal.max_css_rpm, rpm_max)
    return surface, np.minimum(lo, hi), hi


# --- batches --------------------------------------------------------------------------------------------


_FIELDS = tuple(f.name for f in fields(BlockTable))


class MoveSeries(Protocol):
    """A series of m straight moves of X and Z as columns (m,).

    All other values are those of ``pattern``. ``feed`` (m,) is None if all moves have the feed of
    ``pattern``.
    """

    @property
    def pattern(self) -> MotionBlock:
        """Return the block whose values apply to all moves, unless a column contains them."""
        ...

    @property
    def n(self) -> IntArray:
        """Return the block numbers of the moves."""
        ...

    @property
    def x0(self) -> FloatArray:
        """Return the start positions of the moves in X, in mm as radii."""
        ...

    @property
    def z0(self) -> FloatArray:
        """Return the start positions of the moves in Z, in mm."""
        ...

    @property
    def x(self) -> FloatArray:
        """Return the end positions of the moves in X, in mm as radii."""
        ...

    @property
    def z(self) -> FloatArray:
        """Return the end positions of the moves in Z, in mm."""
        ...

    @property
    def feed(self) -> FloatArray | None:
        """Return the feeds of the moves in mm/s or mm/rev, or None if the feed of ``pattern`` applies."""
        ...

    def __len__(self) -> int: ...
    def __getitem__(self, at: slice, /) -> MoveSeries: ...


BlockGroup = list[Any] | MoveSeries
"""Single blocks as a list, or a move series."""


def split_into_batches(
    blocks: Iterable[MotionBlock | MoveSeries], first_size: int, window_size: int
) -> Iterator[tuple[list[BlockGroup], int]]:
    """Yield batches of ``window_size`` blocks, each with its number of blocks.

    The first batch has ``first_size`` blocks, and the last batch contains the remaining blocks. A full
    batch is yielded before the next block is read. A series is divided where a batch ends.
    """
    batch: list[BlockGroup] = []
    singles: list[Any] = []
    room = size = first_size
    for each in blocks:
        if _is_row(each):
            rest = each
            while len(rest) >= room:
                yield [*batch, rest[:room]], size
                rest, batch, room, size = rest[room:], [], window_size, window_size
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
            batch, room, size = [], window_size, window_size
    if batch:
        yield batch, size - room


def _is_row(each: MotionBlock | MoveSeries) -> TypeGuard[MoveSeries]:
    return isinstance(each, Sequence)  # single blocks are not sequences


def build_batch_table(batch: Sequence[BlockGroup], rpm_max: float) -> BlockTable:
    """Return the table of all blocks of a batch; see ``build_block_table``."""
    unlike = [block for part in batch for block in (part if isinstance(part, list) else [part.pattern])]
    table = build_block_table(unlike, rpm_max)
    if all(isinstance(part, list) for part in batch):
        return table  # =
    counts = [n for part in batch for n in ([1] * len(part) if isinstance(part, list) else [len(part)])]
    table = BlockTable(*[_repeat_entries(getattr(table, name), counts) for name in _FIELDS])
    first = 0
    for part in batch:
        if not isinstance(part, list):
            _write_series(table, slice(first, first + len(part)), part)
        first += len(part)
    return table


def _repeat_entries(column: Any, counts: Sequence[int]) -> Any:
    """Return a column of a block table with each entry repeated as often as ``counts`` specifies.

    The column is an array (k,) or (k, axes), or a tuple of curved moves.
    """
    if isinstance(column, tuple):
        return tuple(chain.from_iterable(map(repeat, column, counts)))
    # The array is stored axis by axis, and remains so when its columns are repeated.
    return np.repeat(column.T, counts, axis=-1).T


def _write_series(table: BlockTable, rows: slice, row: MoveSeries) -> None:
    """Write the numbers, positions and feeds of a series to the slice ``rows`` of the table."""
    like = row.pattern
    table.n[rows] = row.n
    if row.feed is not None:
        table.feed[rows] = row.feed
    for ends, x, z in ((table.start, row.x0, row.z0), (table.end, row.x, row.z)):
        ends[rows, 0], ends[rows, 1] = x + like.offset_x, z + like.offset_z
