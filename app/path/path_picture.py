"""Path of a program as polylines, seen from above, and on the face and side if C is locked.

The polylines are built once, on a worker thread. Coordinates are relative to the part: machine position
minus the offset of the active tool. Work shifts (G10) and presets (G92) therefore appear where the cuts are
made. All values are in mm, with X as a radius.
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
    SAME_POINT_MM,
    FloatArray,
    Polyline,
    PolylineBuilder,
    StrokeKind,
    count_arc_chords,
    count_turn_chords,
    find_bounds,
    sample_mill_move,
)
from app.working_plane.plane_scene import MillScene, SceneBuilder
from core.geometry.lines_and_arcs import compute_arc_sweep
from core.geometry.virtual_mill import FacePlane, SidePlane
from core.interpreter.shared.elementary_blocks import Block, BlockKind, StraightMoveSeries, TimedSeries

if TYPE_CHECKING:
    from core.geometry.virtual_mill import MillPoint, PlaneMove
    from core.proving.part_history import ProgramSteps


STILL_TOLERANCE = 1e-9  # mm, degrees
MIN_UNROLL_RADIUS_MM = 1.0  # mm: radius for unrolling a side whose radius is unknown


def map_to_face(x: float, c: float, center_height_mm: float = 0.0) -> tuple[float, float]:
    """Return the position (right, down) on the face of the part for a tool tip at lathe X (a radius).

    ``c`` is the angle of the C axis in degrees. ``center_height_mm`` is the height of the center line.
    """
    at = math.atan2(center_height_mm, -x) - math.radians(c)
    rho = math.hypot(x, center_height_mm)
    return rho * math.cos(at), -rho * math.sin(at)


class FaceViewBuilder:
    """Builder of the face view, which collects the moves that are visible on the face of the part."""

    def __init__(self, block_count: int) -> None:
        self.polyline_builder = PolylineBuilder(block_count)
        self.is_needed = False

    def add_mill_move(self, move: PlaneMove, frame: FacePlane, points: list[MillPoint], stroke: int) -> None:
        """Add a move that was programmed in a milling plane to the face view.

        ``frame.heading_deg`` is the direction of mill X on the part.
        """
        self.is_needed = True
        turn = -math.radians(frame.heading_deg)
        cos, sin = math.cos(turn), math.sin(turn)
        x, y, _ = move.start
        self.polyline_builder.move_to(x * cos + y * sin, x * sin - y * cos)
        for x, y, _ in points:
            self.polyline_builder.add_point(x * cos + y * sin, x * sin - y * cos, stroke)
        if move.center is not None:
            x, y = move.center
            self.polyline_builder.centers.extend((x * cos + y * sin, x * sin - y * cos))

    def add_move(self, block: Block, x0: float, x1: float, stroke: int) -> None:
        """Add a move with C locked that is not in a milling plane, from lathe X ``x0`` to lathe X ``x1``."""
        self.is_needed |= abs(block.c - block.c0) > STILL_TOLERANCE and abs(x1 - x0) > STILL_TOLERANCE
        self.polyline_builder.move_to(*map_to_face(x0, block.c0))
        pieces = count_turn_chords(block.c - block.c0)
        for k in range(1, pieces + 1):
            s = k / pieces
            c = block.c0 + (block.c - block.c0) * s
            self.polyline_builder.add_point(*map_to_face(x0 + (x1 - x0) * s, c), stroke)

    def build_polyline(self) -> Polyline:
        """Return the polyline of the collected moves."""
        z, x, stroke, first = self.polyline_builder.make_arrays()
        low_z, high_z, low_x, high_x = find_bounds(z, x, stroke)
        reach = max(abs(low_z), abs(high_z), abs(low_x), abs(high_x))
        centres = np.array(self.polyline_builder.centers).reshape(-1, 2)
        return Polyline(z, x, stroke, first, (-reach, reach, -reach, reach), arc_centers=centres)


class SideViewBuilder:
    """Builder of the side view, which collects the moves that are visible on the side of the part.

    Until the radius is known, the coordinate ``x`` is minus C in degrees.
    """

    def __init__(self, block_count: int) -> None:
        self.polyline_builder = PolylineBuilder(block_count)
        self.is_needed = False
        self._diameter = 0.0  # diameter of the first plane, which the program uses
        self._reach = 0.0

    def add_mill_move(
        self, move: PlaneMove, frame: SidePlane, points: list[MillPoint], stroke: int, dz: float
    ) -> None:
        """Add a move that was programmed in a milling plane to the side view.

        ``dz`` is added to Z of the program to get Z of the part.
        """
        self.is_needed = True
        self._diameter = self._diameter or frame.diameter_mm
        degrees = 360.0 / (math.pi * frame.diameter_mm)
        x, y, _ = move.start
        self.polyline_builder.move_to(frame.z_start_mm - x + dz, y * degrees - frame.c_start_deg)
        for x, y, _ in points:
            self.polyline_builder.add_point(
                frame.z_start_mm - x + dz, y * degrees - frame.c_start_deg, stroke
            )
        if move.center is not None:
            x, y = move.center
            self.polyline_builder.centers.extend((frame.z_start_mm - x + dz, y * degrees - frame.c_start_deg))

    def add_move(self, block: Block, x: float, dz: float, stroke: int) -> None:
        """Add a move with C locked that is not in a milling plane, to lathe X ``x``."""
        self.is_needed |= (
            abs(block.c - block.c0) > STILL_TOLERANCE and abs(block.z - block.z0) > STILL_TOLERANCE
        )
        if stroke != StrokeKind.RAPID:
            self._reach = max(self._reach, abs(x))
        self.polyline_builder.move_to(block.z0 + dz, -block.c0)
        self.polyline_builder.add_point(block.z + dz, -block.c, stroke)

    def build_polyline(self) -> Polyline:
        """Return the collected moves on the cylinder of the part, unrolled into a plane.

        The diameter is that of the first milling plane, or the largest cut diameter without a plane.
        """
        z, x, stroke, first = self.polyline_builder.make_arrays()
        scale = math.pi * (self._diameter or 2 * max(self._reach, MIN_UNROLL_RADIUS_MM)) / 360.0
        centres = np.array(self.polyline_builder.centers).reshape(-1, 2) * (1.0, scale)
        down: FloatArray = x * scale
        bounds = find_bounds(z, down, stroke)
        return Polyline(z, down, stroke, first, bounds, arc_centers=centres, mm_per_degree=scale)


class FaceAndSideBuilder:
    """Builder of the face and side views of all moves with C locked."""

    def __init__(self, block_count: int) -> None:
        self._face, self._side = FaceViewBuilder(block_count), SideViewBuilder(block_count)

    def add_move(self, block: Block, stroke: int, points: list[MillPoint]) -> None:
        """Add one move with C locked.

        For a move in a plane, ``points`` contains the points of the move without its start.
        """
        modal, plane = block.modal, block.plane
        dz = block.offset_z - modal.drawing_zero_z
        if plane is None:
            dx = block.offset_x - modal.drawing_zero_x
            self._face.add_move(block, block.x0 + dx, block.x + dx, stroke)
            self._side.add_move(block, block.x + dx, dz, stroke)
        elif isinstance(plane.frame, SidePlane):
            self._side.add_mill_move(plane, plane.frame, points, stroke, dz + modal.secondary_offset_z)
        else:
            self._face.add_mill_move(plane, plane.frame, points, stroke)

    def end_block(self) -> None:
        """End a block. This is also necessary if the block is not visible."""
        self._face.polyline_builder.end_block()
        self._side.polyline_builder.end_block()

    def build_polylines(self) -> tuple[Polyline | None, Polyline | None]:
        """Return the polylines of the face and of the side, each None if the view is empty.

        A program that uses C only for indexing is shown on the face.
        """
        face, side = self._face, self._side
        divides = not side.is_needed and len(face.polyline_builder.z) > 0
        return (
            face.build_polyline() if face.is_needed or divides else None,
            side.build_polyline() if side.is_needed else None,
        )


def find_mill_points(block: Block) -> list[MillPoint]:
    """Return the points of a move in a plane without its start, or an empty list for other moves."""
    return [] if block.plane is None else sample_mill_move(block.plane, block.c - block.c0)


BLOCKS_PER_CHECK = 2000  # number of blocks between two checks for cancellation

TimedBlocks = tuple[Block, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class ProgramPicture(Polyline):
    """Path of a program seen from above, with X+ down, and the times of its blocks.

    - ``face`` and ``side``: cuts with C locked.
    - ``ends`` (blocks + 1,): program time in seconds at the end of each block, starting with 0.
    - ``chord`` (blocks,): distance from start to end of each block in mm.
    - ``line`` (blocks,): source line of each block.
    - ``metric``: whether the program ends in G71.
    """

    ends: npt.NDArray[np.float64]
    chord: npt.NDArray[np.float64]
    line: npt.NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    face: Polyline | None = None
    side: Polyline | None = None
    metric: bool = False
    mill_scene: MillScene | None = None  # scene of a mill
    part: ProgramSteps | None = None  # moves from which the part can be calculated
    no_part: str = ""  # reason why the part is not calculated

    def find_block_for_line(self, line_number: int) -> int:
        """Return the number of the last block of the first execution of a source line.

        If the line has no blocks, the nearest earlier line with blocks is used. Return 0 if no such line
        exists. Blocks and lines are counted from 1.
        """
        before = self.line[self.line <= line_number]
        if not len(before):
            return 0
        there = np.flatnonzero(self.line == before.max())
        apart = np.flatnonzero(np.diff(there) > 1)
        return int(there[apart[0]] if len(apart) else there[-1]) + 1

    def count_blocks_before_line(self, line_number: int) -> int:
        """Return the number of blocks that are finished when a source line is first reached."""
        there = np.flatnonzero(self.line == line_number)
        return int(there[0]) if len(there) else self.find_block_for_line(line_number)

    def find_block_ranges(self, line_number: int) -> list[tuple[int, int]]:
        """Return all blocks of a source line as ranges (first, last).

        The ranges are inclusive and counted from 1.
        """
        there = np.flatnonzero(self.line == line_number) + 1
        parts = np.split(there, np.flatnonzero(np.diff(there) > 1) + 1) if len(there) else []
        return [(int(part[0]), int(part[-1])) for part in parts]

    def find_source_line(self, block_number: int) -> int:
        """Return the source line of a block, or 0 if there is no such block.

        Both numbers are counted from 1.
        """
        return int(self.line[block_number - 1]) if 1 <= block_number <= len(self.line) else 0

    def time_left(self, block_number: int, remaining_mm: float) -> float:
        """Return the remaining program time in seconds at 100 % override.

        ``remaining_mm`` is the distance in mm that remains in block number ``block_number``.
        """
        total = float(self.ends[-1])
        if not 1 <= block_number <= self.blocks:
            return total
        start, end = float(self.ends[block_number - 1]), float(self.ends[block_number])
        chord = float(self.chord[block_number - 1])
        share = min(1.0, remaining_mm / chord) if chord > SAME_POINT_MM else 1.0
        return total - end + (end - start) * share


class PictureBuilder:
    """Builder of a program picture from blocks.

    ``is_metric`` sets the unit of a picture that has no blocks.
    """

    def __init__(self, is_metric: bool = False) -> None:
        self._pencil = PolylineBuilder()
        self._turned: FaceAndSideBuilder | None = None
        self._metric = is_metric
        self._scene = SceneBuilder()
        self._ends, self._chord, self._line = array("d", [0.0]), array("d"), array("q")

    def add_block(self, block: Block, end_time_s: float) -> None:
        """Append one block that ends ``end_time_s`` seconds after the start of the program."""
        if block.swivel is not None:
            self._scene.add_block(
                block, block.swivel
            )  # The picture of a lathe has no meaning for such a block.
        elif block.moves:
            if block.modal.c_locked:
                self._locked(block)
            elif block.kind is not BlockKind.ROTATE:
                self._move(block, _stroke(block))
        self._pencil.end_block()
        if self._turned is not None:
            self._turned.end_block()
        self._ends.append(end_time_s)
        self._line.append(block.line)
        self._metric = block.modal.metric
        self._chord.append(_find_chord(block) if block.moves else 0.0)

    def add_move_series(self, series: StraightMoveSeries, end_times_s: FloatArray) -> None:
        """Append straight moves that end ``end_times_s`` (m,) seconds after the start of the program."""
        like = series.pattern
        if self._turned is not None or like.modal.c_locked:
            for block, end in zip(series, end_times_s.tolist(), strict=True):
                self.add_block(block, end)
            return
        dx, dz = like.offset_x - like.modal.drawing_zero_x, like.offset_z - like.modal.drawing_zero_z
        self._pencil.move_to(float(series.z0[0]) + dz, float(series.x0[0]) + dx)
        self._pencil.add_separate_points(series.z + dz, series.x + dx, _stroke(like))
        self._ends.frombytes(end_times_s.tobytes())
        self._line.frombytes(series.line.tobytes())
        self._chord.frombytes(np.hypot(series.x - series.x0, series.z - series.z0).tobytes())
        self._metric = like.modal.metric

    def add_timed_blocks(self, each: TimedBlocks | TimedSeries) -> int:
        """Append a timed block or series of moves, and return the number of appended blocks."""
        if isinstance(each, TimedSeries):
            self.add_move_series(each.series, each.end_times_s)
            return len(each.series)
        self.add_block(each[0], each[2])
        return 1

    def build_picture(self) -> ProgramPicture:
        """Return the picture of the appended blocks."""
        z, x, stroke, first = self._pencil.make_arrays()
        face, side = self._turned.build_polylines() if self._turned is not None else (None, None)
        return ProgramPicture(
            z=z,
            x=x,
            stroke=stroke,
            first=first,
            ends=np.array(self._ends),
            chord=np.array(self._chord),
            bounds=find_bounds(z, x, stroke),
            arc_centers=np.array(self._pencil.centers).reshape(-1, 2),
            line=np.array(self._line, dtype=np.int64),
            face=face,
            side=side,
            metric=self._metric,
            mill_scene=self._scene.build_scene(),
        )

    def _locked(self, block: Block) -> None:
        if self._turned is None:
            self._turned = FaceAndSideBuilder(len(self._line))
        stroke, mill_points = _stroke(block), find_mill_points(block)
        self._turned.add_move(block, stroke, mill_points)
        if block.plane is not None:
            self._add_mill_move(block, block.plane, mill_points, stroke)
        elif block.kind is not BlockKind.ROTATE:
            self._move(block, stroke)

    def _move(self, block: Block, stroke: StrokeKind) -> None:
        dx = block.offset_x - block.modal.drawing_zero_x
        dz = block.offset_z - block.modal.drawing_zero_z
        self._pencil.move_to(block.z0 + dz, block.x0 + dx)
        if block.kind is BlockKind.ARC:
            self._arc(block, dx, dz, stroke)
        self._pencil.add_point(block.z + dz, block.x + dx, stroke)

    def _arc(self, block: Block, dx: float, dz: float, stroke: StrokeKind) -> None:
        start, sweep = compute_arc_sweep(
            block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise
        )
        radius = math.hypot(block.x0 - block.cx, block.z0 - block.cz)
        pieces = count_arc_chords(radius, sweep)
        cz, cx = block.cz + dz, block.cx + dx
        self._pencil.centers.extend((cz, cx))
        for k in range(1, pieces):
            at = start + sweep * k / pieces
            self._pencil.add_point(cz + radius * math.cos(at), cx + radius * math.sin(at), stroke)

    def _add_mill_move(
        self, block: Block, plane: PlaneMove, points: list[MillPoint], stroke: StrokeKind
    ) -> None:
        """Add the X and Z motion of a move in a milling plane."""
        modal = block.modal
        dx = block.offset_x - modal.drawing_zero_x + modal.secondary_offset_x
        dz = block.offset_z - modal.drawing_zero_z + modal.secondary_offset_z
        side = 1.0 if plane.frame.is_far_side else -1.0
        for number, (x, y, z) in enumerate((plane.start, *points)):
            if isinstance(plane.frame, FacePlane):
                h = plane.frame.tool_height_mm
                at = (z + dz, dx + side * math.sqrt(max(x * x + y * y - h * h, 0.0)))
            else:
                at = (plane.frame.z_start_mm - x + dz, dx + side * z)
            if number:
                self._pencil.add_point(*at, stroke)
            else:
                self._pencil.move_to(*at)


def build_picture(
    blocks: Iterable[TimedBlocks | TimedSeries], report_progress: Callable[[int], None]
) -> ProgramPicture:
    """Return the picture of all blocks.

    ``report_progress`` is called with the block count at intervals. It may raise an exception to cancel.
    """
    sketch, count, reported_count = PictureBuilder(), 0, 0
    for each in blocks:
        count += sketch.add_timed_blocks(each)
        if count - reported_count >= BLOCKS_PER_CHECK:
            reported_count = count
            report_progress(count)
    return sketch.build_picture()


def _find_chord(block: Block) -> float:
    """Return the straight distance in mm from start to end in the first two axes.

    The displayed distance to go is measured like this.
    """
    if block.travel is not None:
        return math.dist(block.travel.start[:2], block.travel.end[:2])
    return math.hypot(block.x - block.x0, block.z - block.z0)


def _stroke(block: Block) -> StrokeKind:
    if block.kind is BlockKind.RAPID:
        return StrokeKind.RAPID
    return StrokeKind.TURN if block.modal.spindle else StrokeKind.MILL
