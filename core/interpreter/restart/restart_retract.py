"""Retract of a tool from the part and, reversed, its approach, along moves that do not cross material.

Known free space is where this tool has been since the collet was last opened, outside the largest cut radius,
and in front of the face. Other moves are safe only if the program itself makes the same retract. The rules
are in docs/decisions/0021-restart.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from math import hypot, inf, isnan
from typing import NamedTuple

import numpy as np

from core.interpreter.restart.cut_record import (
    FACE,
    FEED,
    PER_REV,
    REVERSE,
    SAME,
    SIDE,
    STILL,
    THREAD,
    CutRecord,
    Floats,
)

NEAR = 0.1  # mm; a tool within this distance of a path is on the path
_END = 0.005  # mm; a row is complete within this distance of its end
_ASIDE = 0.01  # mm; a cut within this distance of a radius or Z counts as parallel to it
_BETWEEN = 1.1  # mm; minimum tool width, so that closer passes leave no material between them
_BACK_A_LITTLE = 0.25  # mm
_FROM_A_SHOULDER = 0.1  # mm; minimum distance from a face that is not cut yet
_ON_CENTRE = 0.05  # mm of radius; a tool within it drills or taps
# maximum rows to examine ahead and back, and maximum moves that an operator can follow
_AHEAD, _BACK, _LEGS = 400, 400, 60
_FAR = 100_000  # maximum rows in which the next retract is searched
_TRIED = 24  # maximum rows back from which the retract of the program is tried


class ToolPlace(Enum):
    """Situation of a tool: clear of the part, or in the part, and how it can leave."""

    CLEAR = "clear"
    WORK = "work"
    THREAD = "thread"
    TAP = "tap"
    MILL = "mill"  # C is locked
    TURNED = "turned"  # a mill in a part that has turned since
    UNKNOWN = "unknown"


class RetractLeg(NamedTuple):
    """A straight move of the tip to a point, in mm."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class Retract:
    """Retract of a tool. ``legs`` lead from its position out of the material; empty if clear or not known.

    ``away`` is the direction in which the tool leaves in any case, as the signs of (x, z) of the first move;
    (0, 0) if unknown.
    """

    tool_place: ToolPlace
    legs: tuple[RetractLeg, ...] = ()
    away: tuple[int, int] = (0, 0)

    @property
    def known(self) -> bool:
        """Whether the tool is clear, or its path out of the part is known."""
        return self.tool_place is ToolPlace.CLEAR or bool(self.legs)


class Place(NamedTuple):
    """Position in a program: at or within ``block``, with the tip of ``tool`` at (x, z)."""

    block: int
    tool: int
    x: float
    z: float


class _Segment(NamedTuple):
    x0: float
    z0: float
    x: float
    z: float
    how: int
    row: int

    @property
    def length(self) -> float:
        return hypot(self.x - self.x0, self.z - self.z0)


def retract(cut: CutRecord, place: Place, done: int) -> Retract:
    """Return the retract from this position; the blocks up to ``done`` have been cut."""
    row = cut.row_behind(place.block)
    if row >= 0 and int(cut.tool[row]) == place.tool:
        row, on = _on_row(cut, row, place)
        if on:
            return _Search(cut, place, row, done).retract_there()
    return Retract(ToolPlace.CLEAR if _clear(cut, place) else ToolPlace.UNKNOWN)


def _clear(cut: CutRecord, place: Place) -> bool:
    return cut.outside(place.x, place.z, place.tool)


def _on_row(cut: CutRecord, row: int, place: Place) -> tuple[int, bool]:
    """Return the row of the block that is nearest to the tool, and whether the tool is on it."""
    rows = range(cut.first_row(row), row + 1)
    best = min(rows, key=lambda each: (round(off_row(cut, each, place.x, place.z), 4), -each))
    return best, off_row(cut, best, place.x, place.z) <= NEAR


def off_row(cut: CutRecord, row: int, x: float, z: float) -> float:
    """Return the distance of a point from a row, in mm."""
    x0, z0, x1, z1 = cut.ends(row)
    if isnan(x0) or isnan(z0):
        return hypot(x - x1, z - z1)
    return off_line(x0, z0, x1, z1, x, z)


def nearest(cut: CutRecord, row: int, x: float, z: float) -> tuple[float, float] | None:
    """Return the point of a row that is nearest to (x, z), in mm; None if the start of the row is unknown."""
    x0, z0, x1, z1 = cut.ends(row)
    length = hypot(x1 - x0, z1 - z0)
    return None if isnan(length) or not length else _foot(x0, z0, x1, z1, x, z)


def off_line(x0: float, z0: float, x1: float, z1: float, x: float, z: float) -> float:
    """Return the distance of a point from the straight piece (x0, z0) to (x1, z1), in mm."""
    foot_x, foot_z = _foot(x0, z0, x1, z1, x, z)
    return hypot(foot_x - x, foot_z - z)


def _foot(x0: float, z0: float, x1: float, z1: float, x: float, z: float) -> tuple[float, float]:
    """Return the point of a straight piece that is nearest to (x, z)."""
    dx, dz = x1 - x0, z1 - z0
    size = dx * dx + dz * dz
    share = max(0.0, min(1.0, ((x - x0) * dx + (z - z0) * dz) / size)) if size > 0.0 else 0.0
    return x0 + share * dx, z0 + share * dz


class _Search:
    """Search for a retract from one position on one row."""

    def __init__(self, cut: CutRecord, place: Place, row: int, done: int) -> None:
        self.cut, self.place, self.row, self.done = cut, place, row, done
        self.x, self.z = place.x, place.z
        self.how = int(cut.how[row])
        left = hypot(float(cut.x[row]) - self.x, float(cut.z[row]) - self.z)
        # the tool is within the row and not at its end
        self.within = left > _END and place.block <= int(cut.n[row])

    def retract_there(self) -> Retract:  # noqa: PLR0911 - one answer for each way of standing in the work
        how = self.how
        if how & (FACE | SIDE):
            return self._off_the_mill(how & (FACE | SIDE))
        if self._tap():
            return Retract(ToolPlace.TAP)
        clear = _clear(self.cut, self.place) or (self._brings_it(self.row) and not self.within)
        clear = clear or (not how & FEED and self.z >= self.cut.begins)
        if clear and not (self.within and how & FEED):
            return Retract(ToolPlace.CLEAR)
        on = self._going_on()
        if on is not None:
            return on
        if how & STILL:
            return self._off_the_mill(self._axis_of_the_mill())
        ahead = self._as_the_program_does()
        if ahead is not None:
            return ahead
        if how & THREAD and self.within:
            return Retract(ToolPlace.THREAD, away=self._thread_away())
        return self._as_it_came()

    # --- retract as in the program ------------------------------------------------------------------------

    def _ahead(self) -> Iterator[_Segment]:
        """Yield the next segments with this tool and this bar, beginning with the rest of the row."""
        cut, row = self.cut, self.row
        if self.within:
            yield _Segment(self.x, self.z, float(cut.x[row]), float(cut.z[row]), self.how, row)
        tool, bar = int(cut.tool[row]), int(cut.bar[row])
        for each in range(row + 1, min(row + 1 + _AHEAD, len(cut))):
            if int(cut.tool[each]) != tool or int(cut.bar[each]) != bar:
                return
            yield self._segment(each)

    def _segment(self, row: int) -> _Segment:
        return _Segment(*self.cut.ends(row), int(self.cut.how[row]), row)

    def _going_on(self) -> Retract | None:
        """Return the next rapids of the program as a retract if they lead out of the part; otherwise None."""
        legs: list[RetractLeg] = []
        for segment in self._ahead():
            if segment.how & FEED or len(legs) >= _LEGS:
                return None
            legs.append(RetractLeg(segment.x, segment.z))
            if self._out(legs[-1]) or self._brings_it(segment.row):
                return self._made(legs)
        return None

    def _as_the_program_does(self) -> Retract | None:
        """Return a move along X to the program's next rapid toward Z+, and that rapid; or None.

        The result is None if earlier cuts may still have to make room for this rapid.
        """
        level, first = self.z + _ASIDE, self.row + 1
        grew = shrank = False
        if self.within and self.how & FEED:
            sideways = self._rest_of_the_cut(level)
            if sideways is None:
                return None
            grew, shrank = sideways > _ASIDE, sideways < -_ASIDE
        elif self.within:
            first = self.row
        rows = self._with_this_tool(first)
        cut = self.cut
        past = (cut.z[rows] > level) & (cut.z0[rows] <= level)
        passes = np.flatnonzero(((cut.how[rows] & FEED) == 0) & past)
        if not len(passes):
            return None
        crossing = first + int(passes[0])
        cuts = slice(first, crossing)
        if self._in_the_way(cuts, level):
            return None
        out = self._sideways(cuts)
        grew, shrank = grew or bool((out > _ASIDE).any()), shrank or bool((out < -_ASIDE).any())
        steps = (self._segment(row) for row in range(crossing + 1, min(crossing + _AHEAD, rows.stop)))
        return self._out_with(self._segment(crossing), steps, grew=grew, shrank=shrank)

    def _rest_of_the_cut(self, level: float) -> float | None:
        """Return the outward travel of the rest of this row in mm, 0 in a thread.

        The result is None if the rest of the row is itself an obstacle.
        """
        x, z = float(self.cut.x[self.row]), float(self.cut.z[self.row])
        sideways = 0.0 if self.how & THREAD else abs(x) - abs(self.x)
        here = z > self.z - _FROM_A_SHOULDER and abs(sideways) > _ASIDE
        return None if here or z > level else sideways

    def _with_this_tool(self, first: int) -> slice:
        """Return the rows from here on with this tool and this bar, up to a limit."""
        cut = self.cut
        far = slice(first, first + _FAR)
        other = (cut.tool[far] != cut.tool[self.row]) | (cut.bar[far] != cut.bar[self.row])
        ends = np.flatnonzero(other)
        return slice(first, first + (int(ends[0]) if len(ends) else len(other)))

    def _in_the_way(self, rows: slice, level: float) -> bool:
        """Return whether a cut among these rows reaches this Z or moves along X at it."""
        cut = self.cut
        feeds = (cut.how[rows] & FEED) != 0
        upper = np.maximum(cut.z[rows], cut.z0[rows])
        here = (upper > self.z - _FROM_A_SHOULDER) & (np.abs(self._sideways(rows)) > _ASIDE)
        held = (cut.how[rows] & (STILL | FACE | SIDE)) != 0
        return bool((feeds & ((upper > level) | here | held)).any())

    def _sideways(self, rows: slice) -> Floats:
        """Return the outward travel of each cut among these rows in mm; 0 for threads and rapids."""
        cut = self.cut
        out = np.abs(cut.x[rows]) - np.abs(cut.x0[rows])
        return np.where((cut.how[rows] & (FEED | THREAD)) == FEED, out, 0.0)

    def _out_with(
        self, segment: _Segment, steps: Iterator[_Segment], *, grew: bool, shrank: bool
    ) -> Retract | None:
        share = (max(self.z, segment.z0) - segment.z0) / (segment.z - segment.z0)
        to_x = segment.x0 + share * (segment.x - segment.x0)
        out = abs(to_x) - abs(self.x)
        if (to_x < -SAME) != (self.x < -SAME) and max(abs(to_x), abs(self.x)) > _ON_CENTRE:
            return None
        if out < -_ASIDE and shrank:
            return None
        if out > _ASIDE and grew and abs(to_x) < self.cut.over - SAME and not self._swept(abs(to_x)):
            return None
        legs = [RetractLeg(to_x, self.z), RetractLeg(segment.x, segment.z)]
        while not self._out(legs[-1]):
            after = next(steps, None)
            if after is None or after.how & FEED or len(legs) >= _LEGS:
                return None
            legs.append(RetractLeg(after.x, after.z))
        return self._made(legs)

    def _out(self, leg: RetractLeg) -> bool:
        """Return whether a rapid that ends here has left the part."""
        return leg.z >= self.cut.begins - SAME or self.cut.outside(leg.x, leg.z, self.place.tool)

    def _swept(self, end: float) -> bool:
        """Return whether completed passes of this tool have cleared the material up to this radius.

        Adjacent passes must be closer than the tool width, or a pass must have retracted through the gap.
        """
        cut, z, side = self.cut, self.z, -1.0 if self.x < 0.0 else 1.0
        low, high = np.minimum(cut.z0, cut.z), np.maximum(cut.z0, cut.z)
        past = (cut.tool == self.place.tool) & (cut.bar == cut.bar[self.row]) & (cut.n <= self.done)
        past &= (np.arange(len(cut)) < self.row) & (low <= z + SAME) & (high >= z - SAME)
        rows = np.flatnonzero(past & (high - low > _ASIDE) & ((cut.how & (STILL | THREAD)) == 0))
        share = (z - cut.z0[rows]) / (cut.z[rows] - cut.z0[rows])
        radii = side * (cut.x0[rows] + share * (cut.x[rows] - cut.x0[rows]))
        reached = abs(self.x)
        for radius, row in sorted(zip(radii.tolist(), rows.tolist(), strict=True)):
            if radius <= reached + SAME:
                continue
            if radius - reached > _BETWEEN and self._drawn_off_from(row, side) > reached + _ASIDE:
                return False
            reached = radius
            if reached >= end - _ASIDE:
                return True
        return False

    def _drawn_off_from(self, row: int, side: float) -> float:
        """Return the radius from which the cut before this rapid moved out to its level.

        The result is inf if no such cut exists.
        """
        cut = self.cut
        before = row - 1
        if before < 0 or cut.how[row] & FEED or not cut.how[before] & FEED or cut.z[row] < cut.z0[row]:
            return inf
        return side * float(cut.x0[before]) if abs(cut.z[before] - cut.z0[before]) <= _ASIDE else inf

    # --- retract along the entry path ---------------------------------------------------------------------

    def _as_it_came(self) -> Retract:
        """Return the retract along the entry path, until the program's retract is safe or the tool is clear.

        It does not pass through a thread, an opened collet or another tool.
        """
        points = [RetractLeg(self.x, self.z)]
        for segment in self._back():
            if not self.within and len(points) == 1:
                points[0] = RetractLeg(segment.x, segment.z)
            ahead = self._from(segment, points[-1]) if len(points) <= _TRIED else None
            if ahead is not None:
                return self._made([*_shortest([*points, ahead[0]])[1:], *ahead[1]])
            points.append(RetractLeg(segment.x0, segment.z0))
            if self.cut.outside(segment.x0, segment.z0, self.place.tool) or self._brings_it(segment.row - 1):
                legs = _shortest(points)[1:]
                return self._made(legs) if len(legs) <= _LEGS else self._lost()
        return self._lost()

    def _back(self) -> Iterator[_Segment]:
        """Yield the earlier segments with this tool and this bar, the last one first."""
        cut, row = self.cut, self.row
        tool, bar = int(cut.tool[row]), int(cut.bar[row])
        before: _Segment | None = None
        for each in range(row, max(-1, row - _BACK), -1):
            segment = self._segment(each)
            other = int(cut.tool[each]) != tool or int(cut.bar[each]) != bar or int(cut.n[each]) > self.done
            unknown = isnan(segment.x0) or isnan(segment.z0)
            if other or unknown or segment.how & (THREAD | STILL | FACE | SIDE):
                return
            if before is not None and hypot(segment.x - before.x0, segment.z - before.z0) > NEAR:
                return
            yield segment
            before = segment

    def _from(self, segment: _Segment, at: RetractLeg) -> tuple[RetractLeg, tuple[RetractLeg, ...]] | None:
        """Return a short move back along a cut toward Z-, and the program's retract from there.

        The result is None if this is not safe.
        """
        length = hypot(segment.x0 - at.x, segment.z0 - at.z)
        if not segment.how & FEED or at.z >= segment.z0 - _ASIDE or length <= _ASIDE:
            return None
        share = min(_BACK_A_LITTLE, length / 2) / length
        leg = RetractLeg(at.x + share * (segment.x0 - at.x), at.z + share * (segment.z0 - at.z))
        place = Place(int(self.cut.n[segment.row]), self.place.tool, leg.x, leg.z)
        found = _Search(self.cut, place, segment.row, self.done)._as_the_program_does()
        return None if found is None or not found.legs else (leg, found.legs)

    def _brings_it(self, row: int) -> bool:
        """Return whether the row is the rapid that brings the tool to the part after its T, from outside."""
        cut = self.cut
        if row < 0 or cut.how[row] & FEED or isnan(cut.x[row]) or isnan(cut.z[row]):
            return False
        before = row - 1
        first = before < 0 or bool(cut.tool[before] != cut.tool[row])
        unknown = not first and (isnan(cut.x[before]) or isnan(cut.z[before]))
        first = first or (unknown and not cut.how[before] & FEED)
        return first and cut.beyond(float(cut.x[row]), float(cut.z[row]))

    def _lost(self) -> Retract:
        """Return a retract with only the direction, from the next rapid or from the entry path."""
        cut, row = self.cut, self.row
        rapids = (segment for segment in self._ahead() if not segment.how & FEED)
        ways = [(segment.x - segment.x0, segment.z - segment.z0) for segment in rapids]
        ways.append((float(cut.x0[row]) - self.x, float(cut.z0[row]) - self.z))
        away = next(((_sign(dx), _sign(dz)) for dx, dz in ways if _sign(dx) or _sign(dz)), (0, 0))
        return Retract(ToolPlace.UNKNOWN, away=away if away[1] >= 0 else (0, 0))

    # --- threads, taps, mills -----------------------------------------------------------------------------

    def _tap(self) -> bool:
        """Return whether the tool is in a hole from which the program feeds with the spindle reversed."""
        if abs(self.x) > _ON_CENTRE or not self.how & PER_REV or _clear(self.cut, self.place):
            return False
        turns = self.how & REVERSE
        cut, row = self.cut, self.row
        near = [self._segment(each) for each in range(max(0, row - 3), row + 1)] + list(self._ahead())[:4]
        return any(
            segment.how & FEED and segment.how & PER_REV and abs(segment.x) <= _ON_CENTRE
            and segment.how & REVERSE != turns and int(cut.tool[segment.row]) == self.place.tool
            for segment in near
        )  # fmt: skip

    def _thread_away(self) -> tuple[int, int]:
        """Return the direction away from the thread, from the next rapid along X."""
        for segment in self._ahead():
            if abs(segment.x - self.x) > _ASIDE and not segment.how & FEED:
                return _sign(segment.x - self.x), 0
        return 0, 0

    def _off_the_mill(self, axis: int) -> Retract:
        """Return the retract of a mill along its axis: along Z on the face, along X on the side."""
        low, high = self.cut.reach[self.place.tool]
        offset = self.cut.offsets[self.place.tool][0]
        far = low - offset if self.x < 0.0 else high - offset
        to = RetractLeg(self.x, self._before_the_face()) if axis == FACE else RetractLeg(far, self.z)
        away = (0, 1) if axis == FACE else (-1 if self.x < 0.0 else 1, 0)
        out = to.z - self.z if axis == FACE else abs(far) - abs(self.x)
        return Retract(ToolPlace.MILL, (to,), away) if out > SAME else Retract(ToolPlace.CLEAR)

    def _before_the_face(self) -> float:
        face, own = self.cut.front(self.place.tool), self.cut.tool == self.place.tool
        return face if face < inf else float(np.nanmax(self.cut.z[own]))

    def _axis_of_the_mill(self) -> int:
        """Return FACE or SIDE, from the plane switching, from the next rapid or from the entry."""
        cut, row = self.cut, self.row
        near = slice(max(0, row - _BACK), row + _AHEAD)
        own = cut.how[near][cut.tool[near] == self.place.tool]
        for axis in (FACE, SIDE):
            if (own & axis).any():
                return axis
        off = (each for each in self._ahead() if not each.how & FEED and each.length > _ASIDE)
        segment = next(off, self._segment(row))
        return SIDE if abs(segment.x - segment.x0) > abs(segment.z - segment.z0) else FACE

    def _made(self, legs: list[RetractLeg]) -> Retract:
        kept: list[RetractLeg] = []
        at = RetractLeg(self.x, self.z)
        for leg in legs:
            if hypot(leg.x - at.x, leg.z - at.z) > SAME:
                kept.append(leg)
                at = leg
        if not kept:
            return Retract(ToolPlace.CLEAR)
        tool_place = ToolPlace.THREAD if self.how & THREAD and self.within else ToolPlace.WORK
        away = _sign(kept[0].x - self.x), _sign(kept[0].z - self.z)
        return Retract(tool_place, tuple(kept), away)


def _sign(value: float) -> int:
    return (value > _ASIDE) - (value < -_ASIDE)


def _shortest(points: list[RetractLeg]) -> list[RetractLeg]:
    """Return a path without detours, in which sections that return to the path are removed."""
    kept, at = [points[0]], 0
    while at < len(points) - 1:
        start, end = points[at], points[at + 1]
        reached = at + 1
        for k in range(len(points) - 1, at + 1, -1):
            ends_here = off_line(*start, *end, *points[k]) <= SAME
            passes = off_line(*points[k - 1], *points[k], *start) <= SAME
            if ends_here or passes:
                reached = k
                break
        kept.append(points[reached])
        at = reached
    return kept
