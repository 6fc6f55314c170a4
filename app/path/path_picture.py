"""Path of a program as polylines, including face and side with C locked; built once on a worker thread.

Coordinates are relative to the part: machine position minus the offset of the active tool. Work shifts (G10)
and presets (G92) therefore appear where they are cut. All values are in mm, with X as a radius.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.path.polyline import (
    SAME,
    Floats,
    Polyline,
    PolylineBuilder,
    Stroke,
    arc_pieces,
    bounds_of,
    mill_way,
    turn_pieces,
)
from app.working_plane.plane_scene import Scene, SceneBuilder
from core.geometry.lines_and_arcs import arc_sweep
from core.geometry.virtual_mill import Face, Side
from core.interpreter.shared.elementary_blocks import Block, Kind, Series, TimedSeries

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove, Spot
    from core.proving.part_history import PartMoves


STILL = 1e-9  # mm, degrees
LEAST = 1.0  # mm: radius for unrolling a side whose radius is unknown


def face_point(x: float, c: float, h: float = 0.0) -> tuple[float, float]:
    """Return the position on the face (right, down) of a tip at lathe X (a radius).

    C is turned by ``c`` degrees, and ``h`` is the height of the center line.
    """
    at = math.atan2(h, -x) - math.radians(c)
    rho = math.hypot(x, h)
    return rho * math.cos(at), -rho * math.sin(at)


class FaceBuilder:
    """Collects the moves that are visible on the face."""

    def __init__(self, blocks: int) -> None:
        self.pencil = PolylineBuilder(blocks)
        self.wanted = False

    def mill(self, move: PlaneMove, frame: Face, way: list[Spot], stroke: int) -> None:
        """Add a move of plane switching, in a frame that was turned by ``frame.c0`` on entry."""
        self.wanted = True
        turn = -math.radians(frame.heading)
        cos, sin = math.cos(turn), math.sin(turn)
        x, y, _ = move.start
        self.pencil.start(x * cos + y * sin, x * sin - y * cos)
        for x, y, _ in way:
            self.pencil.to(x * cos + y * sin, x * sin - y * cos, stroke)
        if move.centre is not None:
            x, y = move.centre
            self.pencil.centres.extend((x * cos + y * sin, x * sin - y * cos))

    def move(self, block: Block, x0: float, x1: float, stroke: int) -> None:
        """Add any other move with C locked, from lathe X ``x0`` to lathe X ``x1``."""
        self.wanted |= abs(block.c - block.c0) > STILL and abs(x1 - x0) > STILL
        self.pencil.start(*face_point(x0, block.c0))
        pieces = turn_pieces(block.c - block.c0)
        for k in range(1, pieces + 1):
            s = k / pieces
            c = block.c0 + (block.c - block.c0) * s
            self.pencil.to(*face_point(x0 + (x1 - x0) * s, c), stroke)

    def polyline(self) -> Polyline:
        """Return the polyline of the collected moves."""
        z, x, stroke, first = self.pencil.arrays()
        low_z, high_z, low_x, high_x = bounds_of(z, x, stroke)
        reach = max(abs(low_z), abs(high_z), abs(low_x), abs(high_x))
        centres = np.array(self.pencil.centres).reshape(-1, 2)
        return Polyline(z, x, stroke, first, (-reach, reach, -reach, reach), centres=centres)


class SideBuilder:
    """Collects the moves that are visible on the side.

    ``x`` is minus C in degrees until the radius is known.
    """

    def __init__(self, blocks: int) -> None:
        self.pencil = PolylineBuilder(blocks)
        self.wanted = False
        self._diameter = 0.0  # diameter of the first plane, which the program uses
        self._reach = 0.0

    def mill(self, move: PlaneMove, frame: Side, way: list[Spot], stroke: int, dz: float) -> None:
        """Add a move of plane switching. ``dz`` converts program Z to the Z of the part."""
        self.wanted = True
        self._diameter = self._diameter or frame.diameter
        degrees = 360.0 / (math.pi * frame.diameter)
        x, y, _ = move.start
        self.pencil.start(frame.z0 - x + dz, y * degrees - frame.c0)
        for x, y, _ in way:
            self.pencil.to(frame.z0 - x + dz, y * degrees - frame.c0, stroke)
        if move.centre is not None:
            x, y = move.centre
            self.pencil.centres.extend((frame.z0 - x + dz, y * degrees - frame.c0))

    def move(self, block: Block, x: float, dz: float, stroke: int) -> None:
        """Add any other move with C locked, to lathe X ``x``."""
        self.wanted |= abs(block.c - block.c0) > STILL and abs(block.z - block.z0) > STILL
        if stroke != Stroke.RAPID:
            self._reach = max(self._reach, abs(x))
        self.pencil.start(block.z0 + dz, -block.c0)
        self.pencil.to(block.z + dz, -block.c, stroke)

    def polyline(self) -> Polyline:
        """Return the collected moves, unrolled at a diameter.

        The diameter is that of the first plane, or else the largest cut diameter.
        """
        z, x, stroke, first = self.pencil.arrays()
        scale = math.pi * (self._diameter or 2 * max(self._reach, LEAST)) / 360.0
        centres = np.array(self.pencil.centres).reshape(-1, 2) * (1.0, scale)
        down: Floats = x * scale
        bounds = bounds_of(z, down, stroke)
        return Polyline(z, down, stroke, first, bounds, centres=centres, round=scale)


class FaceAndSideBuilder:
    """Builds the face and side views of all moves with C locked."""

    def __init__(self, blocks: int) -> None:
        self._face, self._side = FaceBuilder(blocks), SideBuilder(blocks)

    def add(self, block: Block, stroke: int, way: list[Spot]) -> None:
        """Add one move with C locked.

        ``way`` contains the mill's points after the start of a move in a plane.
        """
        modal, plane = block.modal, block.plane
        dz = block.offset_z - modal.base_z
        if plane is None:
            dx = block.offset_x - modal.base_x
            self._face.move(block, block.x0 + dx, block.x + dx, stroke)
            self._side.move(block, block.x + dx, dz, stroke)
        elif isinstance(plane.frame, Side):
            self._side.mill(plane, plane.frame, way, stroke, dz + modal.secondary_z)
        else:
            self._face.mill(plane, plane.frame, way, stroke)

    def end_block(self) -> None:
        """Mark the end of a block, whether or not the block is visible."""
        self._face.pencil.end_block()
        self._side.pencil.end_block()

    def polylines(self) -> tuple[Polyline | None, Polyline | None]:
        """Return face and side, each None if nothing is visible there.

        A program that uses C only for indexing is shown on the face.
        """
        face, side = self._face, self._side
        divides = not side.wanted and len(face.pencil.z) > 0
        return (
            face.polyline() if face.wanted or divides else None,
            side.polyline() if side.wanted else None,
        )


def way_of(block: Block) -> list[Spot]:
    """Return the mill's points after the start of a move in a plane."""
    return [] if block.plane is None else mill_way(block.plane, block.c - block.c0)


WATCHED = 2000  # number of blocks between two checks for cancellation

Timed = tuple[Block, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Picture(Polyline):
    """Path seen from above, with X+ down. ``face`` and ``side`` show the cuts with C locked.

    ``ends`` (blocks + 1,) is the program time in seconds at the end of each block, starting with 0. ``chord``
    (blocks,) is the distance from start to end of a block in mm. ``line`` (blocks,) is the source line of
    each block. ``metric`` is set if the program ends in G71.
    """

    ends: npt.NDArray[np.float64]
    chord: npt.NDArray[np.float64]
    line: npt.NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    face: Polyline | None = None
    side: Polyline | None = None
    metric: bool = False
    scene: Scene | None = None  # scene of a mill
    part: PartMoves | None = None  # moves from which the part can be calculated
    no_part: str = ""  # reason why the part is not calculated

    def block_of_line(self, line: int) -> int:
        """Return the block that ends the first pass through a source line.

        If the line has no blocks, the nearest earlier line with blocks is used. Returns 0 if no such line
        exists. Numbers count from 1.
        """
        before = self.line[self.line <= line]
        if not len(before):
            return 0
        there = np.flatnonzero(self.line == before.max())
        apart = np.flatnonzero(np.diff(there) > 1)
        return int(there[apart[0]] if len(apart) else there[-1]) + 1

    def blocks_before(self, line: int) -> int:
        """Return the number of blocks that are finished when a source line is first reached."""
        there = np.flatnonzero(self.line == line)
        return int(there[0]) if len(there) else self.block_of_line(line)

    def blocks_of_line(self, line: int) -> list[tuple[int, int]]:
        """Return all blocks of a source line as inclusive ranges (first, last), counted from 1."""
        there = np.flatnonzero(self.line == line) + 1
        parts = np.split(there, np.flatnonzero(np.diff(there) > 1) + 1) if len(there) else []
        return [(int(part[0]), int(part[-1])) for part in parts]

    def line_of_block(self, block: int) -> int:
        """Return the source line of a block, both counted from 1, or 0 for no block."""
        return int(self.line[block - 1]) if 1 <= block <= len(self.line) else 0

    def time_left(self, block: int, to_go: float) -> float:
        """Return the remaining program time in seconds, at 100 % override.

        ``to_go`` is the distance in mm that remains in block number ``block``.
        """
        total = float(self.ends[-1])
        if not 1 <= block <= self.blocks:
            return total
        start, end = float(self.ends[block - 1]), float(self.ends[block])
        chord = float(self.chord[block - 1])
        share = min(1.0, to_go / chord) if chord > SAME else 1.0
        return total - end + (end - start) * share


class PictureBuilder:
    """Collects blocks into a picture. ``metric`` is the unit of a picture without blocks."""

    def __init__(self, metric: bool = False) -> None:
        self._pencil = PolylineBuilder()
        self._turned: FaceAndSideBuilder | None = None
        self._metric = metric
        self._scene = SceneBuilder()
        self._ends, self._chord, self._line = array("d", [0.0]), array("d"), array("q")

    def add(self, block: Block, end: float) -> None:
        """Append one block that ends ``end`` seconds after the start of the program."""
        if block.swivel is not None:
            self._scene.add(block, block.swivel)  # The picture of a lathe has no meaning for such a block.
        elif block.moves:
            if block.modal.c_locked:
                self._locked(block)
            elif block.kind is not Kind.ROTATE:
                self._move(block, _stroke(block))
        self._pencil.end_block()
        if self._turned is not None:
            self._turned.end_block()
        self._ends.append(end)
        self._line.append(block.line)
        self._metric = block.modal.metric
        self._chord.append(_chord(block) if block.moves else 0.0)

    def add_series(self, series: Series, ends: Floats) -> None:
        """Append straight moves that end ``ends`` (m,) seconds after the start of the program."""
        like = series.pattern
        if self._turned is not None or like.modal.c_locked:
            for block, end in zip(series, ends.tolist(), strict=True):
                self.add(block, end)
            return
        dx, dz = like.offset_x - like.modal.base_x, like.offset_z - like.modal.base_z
        self._pencil.start(float(series.z0[0]) + dz, float(series.x0[0]) + dx)
        self._pencil.row(series.z + dz, series.x + dx, _stroke(like))
        self._ends.frombytes(ends.tobytes())
        self._line.frombytes(series.line.tobytes())
        self._chord.frombytes(np.hypot(series.x - series.x0, series.z - series.z0).tobytes())
        self._metric = like.modal.metric

    def add_timed(self, each: Timed | TimedSeries) -> int:
        """Append a timed block or series of moves, and return the number of blocks."""
        if isinstance(each, TimedSeries):
            self.add_series(each.series, each.t1)
            return len(each.series)
        self.add(each[0], each[2])
        return 1

    def picture(self) -> Picture:
        """Return the picture of the appended blocks."""
        z, x, stroke, first = self._pencil.arrays()
        face, side = self._turned.polylines() if self._turned is not None else (None, None)
        return Picture(
            z=z,
            x=x,
            stroke=stroke,
            first=first,
            ends=np.array(self._ends),
            chord=np.array(self._chord),
            bounds=bounds_of(z, x, stroke),
            centres=np.array(self._pencil.centres).reshape(-1, 2),
            line=np.array(self._line, dtype=np.int64),
            face=face,
            side=side,
            metric=self._metric,
            scene=self._scene.scene(),
        )

    def _locked(self, block: Block) -> None:
        if self._turned is None:
            self._turned = FaceAndSideBuilder(len(self._line))
        stroke, way = _stroke(block), way_of(block)
        self._turned.add(block, stroke, way)
        if block.plane is not None:
            self._mill(block, block.plane, way, stroke)
        elif block.kind is not Kind.ROTATE:
            self._move(block, stroke)

    def _move(self, block: Block, stroke: Stroke) -> None:
        dx = block.offset_x - block.modal.base_x
        dz = block.offset_z - block.modal.base_z
        self._pencil.start(block.z0 + dz, block.x0 + dx)
        if block.kind is Kind.ARC:
            self._arc(block, dx, dz, stroke)
        self._pencil.to(block.z + dz, block.x + dx, stroke)

    def _arc(self, block: Block, dx: float, dz: float, stroke: Stroke) -> None:
        start, sweep = arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)
        radius = math.hypot(block.x0 - block.cx, block.z0 - block.cz)
        pieces = arc_pieces(radius, sweep)
        cz, cx = block.cz + dz, block.cx + dx
        self._pencil.centres.extend((cz, cx))
        for k in range(1, pieces):
            at = start + sweep * k / pieces
            self._pencil.to(cz + radius * math.cos(at), cx + radius * math.sin(at), stroke)

    def _mill(self, block: Block, plane: PlaneMove, way: list[Spot], stroke: Stroke) -> None:
        """Add the motion of the X and Z axes during a move of the mill in a plane."""
        modal = block.modal
        dx = block.offset_x - modal.base_x + modal.secondary_x
        dz = block.offset_z - modal.base_z + modal.secondary_z
        side = 1.0 if plane.frame.far else -1.0
        for number, (x, y, z) in enumerate((plane.start, *way)):
            if isinstance(plane.frame, Face):
                h = plane.frame.h
                at = (z + dz, dx + side * math.sqrt(max(x * x + y * y - h * h, 0.0)))
            else:
                at = (plane.frame.z0 - x + dz, dx + side * z)
            if number:
                self._pencil.to(*at, stroke)
            else:
                self._pencil.start(*at)


def picture_of(blocks: Iterable[Timed | TimedSeries], watch: Callable[[int], None]) -> Picture:
    """Return the picture of all blocks.

    ``watch`` is called with the block count at intervals and may raise an exception to cancel.
    """
    sketch, count, told = PictureBuilder(), 0, 0
    for each in blocks:
        count += sketch.add_timed(each)
        if count - told >= WATCHED:
            told = count
            watch(count)
    return sketch.picture()


def _chord(block: Block) -> float:
    """Return the distance from start to end in the first two axes, in mm, as used for the distance to go."""
    if block.travel is not None:
        return math.dist(block.travel.start[:2], block.travel.end[:2])
    return math.hypot(block.x - block.x0, block.z - block.z0)


def _stroke(block: Block) -> Stroke:
    if block.kind is Kind.RAPID:
        return Stroke.RAPID
    return Stroke.TURN if block.modal.spindle else Stroke.MILL
