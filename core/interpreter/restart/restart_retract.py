"""Retract of a tool from the part along moves that do not cross material.

The approach of the tool is the same path in reverse. Space is known to be free outside the largest cut
radius, in front of the face, and where this tool has been since the collet was last opened. Any other move
is considered safe only if the program itself makes it. The rules are in docs/decisions/0021-restart.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot, inf, isnan
from typing import NamedTuple

import numpy as np

from core.interpreter.restart.cut_record import (
    FACE,
    FEED,
    PER_REV,
    REVERSE,
    SAME_POINT_MM,
    SIDE,
    STILL,
    THREAD,
    CutRecord,
    FloatArray,
)
from core.interpreter.restart.path_distances import (
    PATH_TOLERANCE_MM,
    compute_distance_from_row,
    remove_detours,
)
from core.interpreter.restart.tool_retract import Retract, RetractLeg, ToolPosition, ToolSituation

_END = 0.005  # mm; a row is complete within this distance of its end
_PARALLEL_TOLERANCE_MM = 0.01  # mm; a cut within this distance of a radius or Z counts as parallel to it
_MIN_TOOL_WIDTH_MM = 1.1  # mm; minimum tool width, so that closer passes leave no material between them
_BACKOFF_MM = 0.25  # mm
_SHOULDER_CLEARANCE_MM = 0.1  # mm; minimum distance from a face that is not cut yet
_CENTERLINE_TOLERANCE_MM = 0.05  # mm of radius; a tool within it drills or taps
# maximum rows to examine ahead and back, and maximum moves that an operator can follow
_AHEAD, _BACK, _LEGS = 400, 400, 60
_MAX_SEARCH_ROWS = 100_000  # maximum rows in which the next retract is searched
_MAX_ROWS_BACK = 24  # maximum rows back from which the retract of the program is tried


class _Segment(NamedTuple):
    start_x: float
    start_z: float
    end_x: float
    end_z: float
    move_kind: int
    record_row: int

    @property
    def length(self) -> float:
        return hypot(self.end_x - self.start_x, self.end_z - self.start_z)


def plan_retract(cut_record: CutRecord, position: ToolPosition, last_complete_block: int) -> Retract:
    """Return the retract from this position, if the blocks to ``last_complete_block`` were cut."""
    row = cut_record.find_last_row(position.block_number)
    if row >= 0 and int(cut_record.tool_numbers[row]) == position.tool_number:
        row, on = _nearest_row(cut_record, row, position)
        if on:
            return _Search(cut_record, position, row, last_complete_block).find_retract()
    return Retract(ToolSituation.CLEAR if _clear(cut_record, position) else ToolSituation.UNKNOWN)


def _clear(cut: CutRecord, place: ToolPosition) -> bool:
    return cut.is_outside_material(place.x, place.z, place.tool_number)


def _nearest_row(cut_record: CutRecord, row: int, position: ToolPosition) -> tuple[int, bool]:
    """Return the row of the block that is nearest to the tool, and whether the tool is on that row."""
    rows = range(cut_record.find_first_row(row), row + 1)
    best = min(
        rows,
        key=lambda each: (
            round(compute_distance_from_row(cut_record, each, position.x, position.z), 4),
            -each,
        ),
    )
    return best, compute_distance_from_row(cut_record, best, position.x, position.z) <= PATH_TOLERANCE_MM


class _Search:
    """Search for a safe retract from one tool position on one row of the cut record."""

    def __init__(
        self, cut_record: CutRecord, position: ToolPosition, row: int, last_complete_block: int
    ) -> None:
        self.cut_record, self.position, self.row, self.last_complete_block = (
            cut_record,
            position,
            row,
            last_complete_block,
        )
        self.x, self.z = position.x, position.z
        self.move_kind = int(cut_record.move_kinds[row])
        left = hypot(float(cut_record.end_x[row]) - self.x, float(cut_record.end_z[row]) - self.z)
        # the tool is within the row and not at its end
        self.is_inside_row = left > _END and position.block_number <= int(cut_record.block_numbers[row])

    def find_retract(self) -> Retract:  # noqa: PLR0911 - one result for each position of the tool in the part
        how = self.move_kind
        if how & (FACE | SIDE):
            return self._mill_retract(how & (FACE | SIDE))
        if self._is_tapping():
            return Retract(ToolSituation.IN_TAPPED_HOLE)
        clear = _clear(self.cut_record, self.position) or (
            self._is_approach_rapid(self.row) and not self.is_inside_row
        )
        clear = clear or (not how & FEED and self.z >= self.cut_record.max_cut_start_z)
        if clear and not (self.is_inside_row and how & FEED):
            return Retract(ToolSituation.CLEAR)
        on = self._next_rapids()
        if on is not None:
            return on
        if how & STILL:
            return self._mill_retract(self._mill_axis())
        ahead = self._crosswise_retract()
        if ahead is not None:
            return ahead
        if how & THREAD and self.is_inside_row:
            return Retract(ToolSituation.IN_THREAD, direction=self._thread_exit_direction())
        return self._entry_retract()

    # --- retract as in the program ------------------------------------------------------------------------

    def _following_segments(self) -> Iterator[_Segment]:
        """Yield the rest of this row and the following moves of this tool on this bar section."""
        cut, row = self.cut_record, self.row
        if self.is_inside_row:
            yield _Segment(self.x, self.z, float(cut.end_x[row]), float(cut.end_z[row]), self.move_kind, row)
        tool, bar = int(cut.tool_numbers[row]), int(cut.bar_sections[row])
        for each in range(row + 1, min(row + 1 + _AHEAD, len(cut))):
            if int(cut.tool_numbers[each]) != tool or int(cut.bar_sections[each]) != bar:
                return
            yield self._segment(each)

    def _segment(self, row: int) -> _Segment:
        return _Segment(*self.cut_record.get_end_points(row), int(self.cut_record.move_kinds[row]), row)

    def _next_rapids(self) -> Retract | None:
        """Return the next rapids of the program as a retract.

        Returns None if these rapids do not lead out of the part.
        """
        legs: list[RetractLeg] = []
        for segment in self._following_segments():
            if segment.move_kind & FEED or len(legs) >= _LEGS:
                return None
            legs.append(RetractLeg(segment.end_x, segment.end_z))
            if self._has_left_part(legs[-1]) or self._is_approach_rapid(segment.record_row):
                return self._made(legs)
        return None

    def _crosswise_retract(self) -> Retract | None:
        """Return a retract along X, and then along Z+ as in the program's next rapid.

        Returns None if earlier cuts may not yet have cleared the path of this rapid.
        """
        level, first = self.z + _PARALLEL_TOLERANCE_MM, self.row + 1
        grew = shrank = False
        if self.is_inside_row and self.move_kind & FEED:
            sideways = self._remaining_travel(level)
            if sideways is None:
                return None
            grew, shrank = sideways > _PARALLEL_TOLERANCE_MM, sideways < -_PARALLEL_TOLERANCE_MM
        elif self.is_inside_row:
            first = self.row
        rows = self._same_tool_rows(first)
        cut = self.cut_record
        past = (cut.end_z[rows] > level) & (cut.start_z[rows] <= level)
        passes = np.flatnonzero(((cut.move_kinds[rows] & FEED) == 0) & past)
        if not len(passes):
            return None
        crossing = first + int(passes[0])
        cuts = slice(first, crossing)
        if self._is_obstructed(cuts, level):
            return None
        out = self._outward_travels(cuts)
        grew, shrank = (
            grew or bool((out > _PARALLEL_TOLERANCE_MM).any()),
            shrank or bool((out < -_PARALLEL_TOLERANCE_MM).any()),
        )
        steps = (self._segment(row) for row in range(crossing + 1, min(crossing + _AHEAD, rows.stop)))
        return self._out_with(self._segment(crossing), steps, grew=grew, shrank=shrank)

    def _remaining_travel(self, level: float) -> float | None:
        """Return how far the rest of this row moves outward along X, in mm, or 0 in a screw thread.

        Returns None if the rest of the row is itself an obstacle.
        """
        x, z = float(self.cut_record.end_x[self.row]), float(self.cut_record.end_z[self.row])
        sideways = 0.0 if self.move_kind & THREAD else abs(x) - abs(self.x)
        here = z > self.z - _SHOULDER_CLEARANCE_MM and abs(sideways) > _PARALLEL_TOLERANCE_MM
        return None if here or z > level else sideways

    def _same_tool_rows(self, first: int) -> slice:
        """Return the rows from ``first`` on with this tool and bar section, up to a maximum count."""
        cut = self.cut_record
        far = slice(first, first + _MAX_SEARCH_ROWS)
        other = (cut.tool_numbers[far] != cut.tool_numbers[self.row]) | (
            cut.bar_sections[far] != cut.bar_sections[self.row]
        )
        ends = np.flatnonzero(other)
        return slice(first, first + (int(ends[0]) if len(ends) else len(other)))

    def _is_obstructed(self, rows: slice, level: float) -> bool:
        """Return whether a cut in these rows reaches the Z ``level`` or moves along X at this Z."""
        cut = self.cut_record
        feeds = (cut.move_kinds[rows] & FEED) != 0
        upper = np.maximum(cut.end_z[rows], cut.start_z[rows])
        here = (upper > self.z - _SHOULDER_CLEARANCE_MM) & (
            np.abs(self._outward_travels(rows)) > _PARALLEL_TOLERANCE_MM
        )
        held = (cut.move_kinds[rows] & (STILL | FACE | SIDE)) != 0
        return bool((feeds & ((upper > level) | here | held)).any())

    def _outward_travels(self, rows: slice) -> FloatArray:
        """Return how far each of these rows moves outward along X, in mm.

        The travel is negative for a move toward the centerline, and 0 for threads and rapids.
        """
        cut = self.cut_record
        out = np.abs(cut.end_x[rows]) - np.abs(cut.start_x[rows])
        return np.where((cut.move_kinds[rows] & (FEED | THREAD)) == FEED, out, 0.0)

    def _out_with(
        self, segment: _Segment, steps: Iterator[_Segment], *, grew: bool, shrank: bool
    ) -> Retract | None:
        share = (max(self.z, segment.start_z) - segment.start_z) / (segment.end_z - segment.start_z)
        to_x = segment.start_x + share * (segment.end_x - segment.start_x)
        out = abs(to_x) - abs(self.x)
        if (to_x < -SAME_POINT_MM) != (self.x < -SAME_POINT_MM) and max(
            abs(to_x), abs(self.x)
        ) > _CENTERLINE_TOLERANCE_MM:
            return None
        if out < -_PARALLEL_TOLERANCE_MM and shrank:
            return None
        if (
            out > _PARALLEL_TOLERANCE_MM
            and grew
            and abs(to_x) < self.cut_record.retract_radius - SAME_POINT_MM
            and not self._is_cleared(abs(to_x))
        ):
            return None
        legs = [RetractLeg(to_x, self.z), RetractLeg(segment.end_x, segment.end_z)]
        while not self._has_left_part(legs[-1]):
            after = next(steps, None)
            if after is None or after.move_kind & FEED or len(legs) >= _LEGS:
                return None
            legs.append(RetractLeg(after.end_x, after.end_z))
        return self._made(legs)

    def _has_left_part(self, leg: RetractLeg) -> bool:
        """Return whether the tool is clear of the part at the end point of this rapid."""
        return (
            leg.z >= self.cut_record.max_cut_start_z - SAME_POINT_MM
            or self.cut_record.is_outside_material(leg.x, leg.z, self.position.tool_number)
        )

    def _is_cleared(self, end: float) -> bool:
        """Return whether this tool has cleared the material from its position out to a radius.

        ``end`` is the radius in mm. The material between two adjacent completed passes counts as cleared if
        the passes are closer than the minimum tool width. It also counts as cleared if the tool has cut
        outward through it before the rapid of a pass.
        """
        cut, z, side = self.cut_record, self.z, -1.0 if self.x < 0.0 else 1.0
        low, high = np.minimum(cut.start_z, cut.end_z), np.maximum(cut.start_z, cut.end_z)
        past = (
            (cut.tool_numbers == self.position.tool_number)
            & (cut.bar_sections == cut.bar_sections[self.row])
            & (cut.block_numbers <= self.last_complete_block)
        )
        past &= (np.arange(len(cut)) < self.row) & (low <= z + SAME_POINT_MM) & (high >= z - SAME_POINT_MM)
        rows = np.flatnonzero(
            past & (high - low > _PARALLEL_TOLERANCE_MM) & ((cut.move_kinds & (STILL | THREAD)) == 0)
        )
        share = (z - cut.start_z[rows]) / (cut.end_z[rows] - cut.start_z[rows])
        radii = side * (cut.start_x[rows] + share * (cut.end_x[rows] - cut.start_x[rows]))
        reached = abs(self.x)
        for radius, row in sorted(zip(radii.tolist(), rows.tolist(), strict=True)):
            if radius <= reached + SAME_POINT_MM:
                continue
            if (
                radius - reached > _MIN_TOOL_WIDTH_MM
                and self._drawoff_radius(row, side) > reached + _PARALLEL_TOLERANCE_MM
            ):
                return False
            reached = radius
            if reached >= end - _PARALLEL_TOLERANCE_MM:
                return True
        return False

    def _drawoff_radius(self, row: int, side: float) -> float:
        """Return the start radius of the outward cut along X directly before the rapid in ``row``.

        The radius is inf if no such cut precedes the rapid.
        """
        cut = self.cut_record
        before = row - 1
        if (
            before < 0
            or cut.move_kinds[row] & FEED
            or not cut.move_kinds[before] & FEED
            or cut.end_z[row] < cut.start_z[row]
        ):
            return inf
        return (
            side * float(cut.start_x[before])
            if abs(cut.end_z[before] - cut.start_z[before]) <= _PARALLEL_TOLERANCE_MM
            else inf
        )

    # --- retract along the entry path ---------------------------------------------------------------------

    def _entry_retract(self) -> Retract:
        """Return the retract along the path on which the tool entered the part.

        The retract ends where the program's retract is safe or the tool is clear. It does not pass through
        a screw thread, the opening of the collet or a tool change.
        """
        points = [RetractLeg(self.x, self.z)]
        for segment in self._earlier_segments():
            if not self.is_inside_row and len(points) == 1:
                points[0] = RetractLeg(segment.end_x, segment.end_z)
            ahead = self._step_back(segment, points[-1]) if len(points) <= _MAX_ROWS_BACK else None
            if ahead is not None:
                return self._made([*remove_detours([*points, ahead[0]])[1:], *ahead[1]])
            points.append(RetractLeg(segment.start_x, segment.start_z))
            if self.cut_record.is_outside_material(
                segment.start_x, segment.start_z, self.position.tool_number
            ) or self._is_approach_rapid(segment.record_row - 1):
                legs = remove_detours(points)[1:]
                return self._made(legs) if len(legs) <= _LEGS else self._direction_only()
        return self._direction_only()

    def _earlier_segments(self) -> Iterator[_Segment]:
        """Yield the earlier path segments of this tool on this bar section, in reverse order."""
        cut, row = self.cut_record, self.row
        tool, bar = int(cut.tool_numbers[row]), int(cut.bar_sections[row])
        before: _Segment | None = None
        for each in range(row, max(-1, row - _BACK), -1):
            segment = self._segment(each)
            other = (
                int(cut.tool_numbers[each]) != tool
                or int(cut.bar_sections[each]) != bar
                or int(cut.block_numbers[each]) > self.last_complete_block
            )
            unknown = isnan(segment.start_x) or isnan(segment.start_z)
            if other or unknown or segment.move_kind & (THREAD | STILL | FACE | SIDE):
                return
            if (
                before is not None
                and hypot(segment.end_x - before.start_x, segment.end_z - before.start_z) > PATH_TOLERANCE_MM
            ):
                return
            yield segment
            before = segment

    def _step_back(
        self, segment: _Segment, at: RetractLeg
    ) -> tuple[RetractLeg, tuple[RetractLeg, ...]] | None:
        """Return a short move back along a cut toward Z-, and the retract that follows.

        The program's retract starts at the end of this move. Returns None if these moves are not safe.
        """
        length = hypot(segment.start_x - at.x, segment.start_z - at.z)
        if (
            not segment.move_kind & FEED
            or at.z >= segment.start_z - _PARALLEL_TOLERANCE_MM
            or length <= _PARALLEL_TOLERANCE_MM
        ):
            return None
        share = min(_BACKOFF_MM, length / 2) / length
        leg = RetractLeg(at.x + share * (segment.start_x - at.x), at.z + share * (segment.start_z - at.z))
        place = ToolPosition(
            int(self.cut_record.block_numbers[segment.record_row]), self.position.tool_number, leg.x, leg.z
        )
        found = _Search(
            self.cut_record, place, segment.record_row, self.last_complete_block
        )._crosswise_retract()
        return None if found is None or not found.legs else (leg, found.legs)

    def _is_approach_rapid(self, row: int) -> bool:
        """Return whether the row is the rapid, after a tool change, that moves the tool to the part."""
        cut = self.cut_record
        if row < 0 or cut.move_kinds[row] & FEED or isnan(cut.end_x[row]) or isnan(cut.end_z[row]):
            return False
        before = row - 1
        first = before < 0 or bool(cut.tool_numbers[before] != cut.tool_numbers[row])
        unknown = not first and (isnan(cut.end_x[before]) or isnan(cut.end_z[before]))
        first = first or (unknown and not cut.move_kinds[before] & FEED)
        return first and cut.is_clear_after_rapid(float(cut.end_x[row]), float(cut.end_z[row]))

    def _direction_only(self) -> Retract:
        """Return the direction of the next rapid or of the entry, because no safe moves are known."""
        cut, row = self.cut_record, self.row
        rapids = (segment for segment in self._following_segments() if not segment.move_kind & FEED)
        ways = [(segment.end_x - segment.start_x, segment.end_z - segment.start_z) for segment in rapids]
        ways.append((float(cut.start_x[row]) - self.x, float(cut.start_z[row]) - self.z))
        away = next(((_sign(dx), _sign(dz)) for dx, dz in ways if _sign(dx) or _sign(dz)), (0, 0))
        return Retract(ToolSituation.UNKNOWN, direction=away if away[1] >= 0 else (0, 0))

    # --- threads, taps, mills -----------------------------------------------------------------------------

    def _is_tapping(self) -> bool:
        """Return whether the tool is tapping a hole.

        The tool is in a hole that the program leaves at a feed with the spindle reversed.
        """
        if (
            abs(self.x) > _CENTERLINE_TOLERANCE_MM
            or not self.move_kind & PER_REV
            or _clear(self.cut_record, self.position)
        ):
            return False
        turns = self.move_kind & REVERSE
        cut, row = self.cut_record, self.row
        near = [self._segment(each) for each in range(max(0, row - 3), row + 1)] + list(
            self._following_segments()
        )[:4]
        return any(
            segment.move_kind & FEED
            and segment.move_kind & PER_REV
            and abs(segment.end_x) <= _CENTERLINE_TOLERANCE_MM
            and segment.move_kind & REVERSE != turns
            and int(cut.tool_numbers[segment.record_row]) == self.position.tool_number
            for segment in near
        )

    def _thread_exit_direction(self) -> tuple[int, int]:
        """Return the direction away from the thread: the direction of the next rapid along X."""
        for segment in self._following_segments():
            if abs(segment.end_x - self.x) > _PARALLEL_TOLERANCE_MM and not segment.move_kind & FEED:
                return _sign(segment.end_x - self.x), 0
        return 0, 0

    def _mill_retract(self, axis: int) -> Retract:
        """Return the retract of a milling tool along its axis: Z for face milling, X for side milling."""
        low, high = self.cut_record.machine_x_range_by_tool[self.position.tool_number]
        offset = self.cut_record.tool_offsets[self.position.tool_number][0]
        far = low - offset if self.x < 0.0 else high - offset
        to = RetractLeg(self.x, self._before_the_face()) if axis == FACE else RetractLeg(far, self.z)
        away = (0, 1) if axis == FACE else (-1 if self.x < 0.0 else 1, 0)
        out = to.z - self.z if axis == FACE else abs(far) - abs(self.x)
        return (
            Retract(ToolSituation.MILLING, (to,), away)
            if out > SAME_POINT_MM
            else Retract(ToolSituation.CLEAR)
        )

    def _before_the_face(self) -> float:
        face, own = (
            self.cut_record.compute_front_z(self.position.tool_number),
            self.cut_record.tool_numbers == self.position.tool_number,
        )
        return face if face < inf else float(np.nanmax(self.cut_record.end_z[own]))

    def _mill_axis(self) -> int:
        """Return FACE or SIDE, the surface being milled, from the cuts, the next rapid or the entry."""
        cut, row = self.cut_record, self.row
        near = slice(max(0, row - _BACK), row + _AHEAD)
        own = cut.move_kinds[near][cut.tool_numbers[near] == self.position.tool_number]
        for axis in (FACE, SIDE):
            if (own & axis).any():
                return axis
        off = (
            each
            for each in self._following_segments()
            if not each.move_kind & FEED and each.length > _PARALLEL_TOLERANCE_MM
        )
        segment = next(off, self._segment(row))
        return SIDE if abs(segment.end_x - segment.start_x) > abs(segment.end_z - segment.start_z) else FACE

    def _made(self, legs: list[RetractLeg]) -> Retract:
        kept: list[RetractLeg] = []
        at = RetractLeg(self.x, self.z)
        for leg in legs:
            if hypot(leg.x - at.x, leg.z - at.z) > SAME_POINT_MM:
                kept.append(leg)
                at = leg
        if not kept:
            return Retract(ToolSituation.CLEAR)
        tool_place = (
            ToolSituation.IN_THREAD
            if self.move_kind & THREAD and self.is_inside_row
            else ToolSituation.IN_PART
        )
        away = _sign(kept[0].x - self.x), _sign(kept[0].z - self.z)
        return Retract(tool_place, tuple(kept), away)


def _sign(value: float) -> int:
    return (value > _PARALLEL_TOLERANCE_MM) - (value < -_PARALLEL_TOLERANCE_MM)
