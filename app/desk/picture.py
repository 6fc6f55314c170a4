"""The path of a program as polylines, made once from its elementary blocks on a worker thread.

Coordinates are the part's: machine position less the offset of the active tool, so that work shifts (G10)
and presets (G92) stand where they are cut. mm, X a radius.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from core.geometry.extent import arc_sweep
from core.interpreter.blocks import Kind

if TYPE_CHECKING:
    from core.interpreter.blocks import Block

CHORD_ERROR = 0.004  # mm: half a pixel at 125 pixels to the millimetre
SAME = 1e-7  # mm
WATCHED = 2000  # blocks between two looks at whether the work is still wanted

Timed = tuple["Block", float, float]


class Stroke(IntEnum):
    """What the stretch that ends in a point is; ``TURN`` strokes cut both sides of X0."""

    JUMP = 0  # another tool's tip: nothing is drawn
    RAPID = 1
    TURN = 2
    MILL = 3  # fed with the spindle standing


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """Points ``z x`` (p,) with the stroke that ends in each; block n ends with point ``first[n] - 1``.

    ``first`` (blocks + 1,), ``ends`` (blocks + 1,) seconds of program time with 0 in front, ``chord``
    (blocks,) mm from start to end of a block. ``bounds`` (least z, greatest z, least x, greatest x) of what
    is cut, or of everything when nothing is. ``line`` (blocks,) is the source line that each block is of.
    """

    z: npt.NDArray[np.float64]
    x: npt.NDArray[np.float64]
    stroke: npt.NDArray[np.uint8]
    first: npt.NDArray[np.int64]
    ends: npt.NDArray[np.float64]
    chord: npt.NDArray[np.float64]
    bounds: tuple[float, float, float, float]
    line: npt.NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    @property
    def blocks(self) -> int:
        """How many elementary blocks it was made of."""
        return len(self.chord)

    def points_done(self, blocks: int) -> int:
        """How many points are behind when so many blocks are."""
        return int(self.first[max(0, min(blocks, self.blocks))])

    def block_of_line(self, line: int) -> int:
        """The block that ends the first pass through a source line, or through the nearest one before that
        makes any; 0 when there is none. Numbers count from 1."""
        before = self.line[self.line <= line]
        if not len(before):
            return 0
        there = np.flatnonzero(self.line == before.max())
        apart = np.flatnonzero(np.diff(there) > 1)
        return int(there[apart[0]] if len(apart) else there[-1]) + 1

    def time_left(self, block: int, to_go: float) -> float:
        """Program seconds left when block number ``block`` has ``to_go`` mm before it, at full override."""
        total = float(self.ends[-1])
        if not 1 <= block <= self.blocks:
            return total
        start, end = float(self.ends[block - 1]), float(self.ends[block])
        chord = float(self.chord[block - 1])
        share = min(1.0, to_go / chord) if chord > SAME else 1.0
        return total - end + (end - start) * share


class Sketch:
    """Collects blocks into a picture."""

    def __init__(self) -> None:
        self._z, self._x, self._stroke = array("d"), array("d"), array("B")
        self._first, self._ends, self._chord = array("q", [0]), array("d", [0.0]), array("d")
        self._line = array("q")

    def add(self, block: Block, end: float) -> None:
        """Append one block that ends ``end`` seconds into the program."""
        if block.moves and block.kind is not Kind.ROTATE:
            self._move(block)
        self._first.append(len(self._z))
        self._ends.append(end)
        self._line.append(block.line)
        self._chord.append(math.hypot(block.x - block.x0, block.z - block.z0) if block.moves else 0.0)

    def picture(self) -> Picture:
        """The picture of what was added."""
        z, x = np.array(self._z), np.array(self._x)
        stroke = np.array(self._stroke, dtype=np.uint8)
        return Picture(
            z=z,
            x=x,
            stroke=stroke,
            first=np.array(self._first, dtype=np.int64),
            ends=np.array(self._ends),
            chord=np.array(self._chord),
            bounds=_bounds(z, x, stroke),
            line=np.array(self._line, dtype=np.int64),
        )

    def _move(self, block: Block) -> None:
        dx = block.offset_x - block.modal.tool_x
        dz = block.offset_z - block.modal.tool_z
        self._start(block.z0 + dz, block.x0 + dx)
        stroke = _stroke(block)
        if block.kind is Kind.ARC:
            self._arc(block, dx, dz, stroke)
        self._point(block.z + dz, block.x + dx, stroke)

    def _start(self, z: float, x: float) -> None:
        if self._z and abs(self._z[-1] - z) < SAME and abs(self._x[-1] - x) < SAME:
            return
        self._point(z, x, Stroke.JUMP)

    def _point(self, z: float, x: float, stroke: Stroke) -> None:
        self._z.append(z)
        self._x.append(x)
        self._stroke.append(stroke)

    def _arc(self, block: Block, dx: float, dz: float, stroke: Stroke) -> None:
        start, sweep = arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)
        radius = math.hypot(block.x0 - block.cx, block.z0 - block.cz)
        pieces = arc_pieces(radius, sweep)
        for k in range(1, pieces):
            at = start + sweep * k / pieces
            self._point(block.cz + dz + radius * math.cos(at), block.cx + dx + radius * math.sin(at), stroke)


def arc_pieces(radius: float, sweep: float) -> int:
    """Into how many chords an arc falls so that none leaves it by more than CHORD_ERROR."""
    if radius <= CHORD_ERROR:
        return 4
    step = 2 * math.acos(1 - CHORD_ERROR / radius)
    return max(1, math.ceil(abs(sweep) / step))


def sketched(blocks: Iterable[Timed], watch: Callable[[int], None]) -> Picture:
    """The picture of all blocks; ``watch`` is told the count now and then and may raise to give up."""
    sketch = Sketch()
    for count, (block, _start, end) in enumerate(blocks, 1):
        sketch.add(block, end)
        if count % WATCHED == 0:
            watch(count)
    return sketch.picture()


def _stroke(block: Block) -> Stroke:
    if block.kind is Kind.RAPID:
        return Stroke.RAPID
    return Stroke.TURN if block.modal.spindle else Stroke.MILL


def _bounds(
    z: npt.NDArray[np.float64], x: npt.NDArray[np.float64], stroke: npt.NDArray[np.uint8]
) -> tuple[float, float, float, float]:
    if not len(z):
        return 0.0, 0.0, 0.0, 0.0
    cut = np.flatnonzero(stroke >= Stroke.TURN)
    if len(cut):
        # A stroke's start is the point before it.
        index = np.concatenate((cut, np.maximum(cut - 1, 0)))
        z, x = z[index], x[index]
    return float(z.min()), float(z.max()), float(x.min()), float(x.max())
