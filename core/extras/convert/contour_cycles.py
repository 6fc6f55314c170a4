"""Roughing along a contour in passes (G71, G72), by repeating the contour (G73), and finishing (G70)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, copysign, hypot, pi, sqrt

from core.extras.convert.path_steps import Kind, Step
from core.extras.convert.reasons import refuse
from core.extras.convert.source_lines import Statement, Word
from core.extras.convert.source_state import SourceState

_SAME = 1e-6  # mm
Point = tuple[float, float]


@dataclass(slots=True)
class Roughing:
    """Values of the first line of a cycle, in mm: depth, retract, relief in X and Z; and the count."""

    depth: float = 0.0
    retract: float = 0.5
    relief_x: float = 0.0
    relief_z: float = 0.0
    count: int = 1


@dataclass(frozen=True, slots=True)
class Piece:
    """A line or arc of a contour. Points are the depth of the passes, and the coordinate along them."""

    start: Point
    end: Point
    center: Point | None = None
    clockwise: bool = False

    def extremes(self) -> list[float]:
        """Return the depths at which an arc is parallel to the passes, between its ends."""
        if self.center is None:
            return []
        radius = hypot(self.start[0] - self.center[0], self.start[1] - self.center[1])
        points = [(self.center[0] + sign * radius, self.center[1]) for sign in (1.0, -1.0)]
        return [point[0] for point in points if self._contains(point)]

    def crossing(self, level: float) -> float | None:
        """Return the coordinate along the passes of the first point at this depth, or None."""
        if self.center is None:
            low, high = sorted((self.start[0], self.end[0]))
            if not low - _SAME <= level <= high + _SAME or high - low < _SAME:
                return None
            share = (level - self.start[0]) / (self.end[0] - self.start[0])
            return self.start[1] + (self.end[1] - self.start[1]) * share
        radius = hypot(self.start[0] - self.center[0], self.start[1] - self.center[1])
        off = level - self.center[0]
        if abs(off) > radius + _SAME:
            return None
        half = sqrt(max(radius * radius - off * off, 0.0))
        found = [self.center[1] + sign * half for sign in (1.0, -1.0)]
        inside = [each for each in found if self._contains((level, each))]
        return min(inside, key=lambda each: abs(each - self.start[1])) if inside else None

    def _contains(self, point: Point) -> bool:
        assert self.center is not None
        angles = [
            atan2(each[0] - self.center[0], each[1] - self.center[1])
            for each in (self.start, point, self.end)
        ]
        sense = 1.0 if self.clockwise else -1.0
        whole = (sense * (angles[2] - angles[0])) % (2 * pi)
        part = (sense * (angles[1] - angles[0])) % (2 * pi)
        return part <= whole + 1e-7 or part >= 2 * pi - 1e-7


def roughing_words(state: SourceState, statement: Statement, code: Word, rough: Roughing) -> bool:
    """Store the words of the first line of a cycle; return whether the line is such a line."""
    if statement.word("P") is not None:
        return False
    u, w, r = (statement.word(letter) for letter in "UWR")
    if code.value == 73:
        rough.relief_x = state.length(u) if u is not None else 0.0
        rough.relief_z = state.length(w) if w is not None else 0.0
        rough.count = max(round(r.value * (1 if not r.has_point or r.value >= 1 else 1000)), 1) if r else 1
        return True
    depth = u if code.value == 71 else w
    if depth is not None:
        rough.depth = abs(state.length(depth))
    if r is not None:
        rough.retract = abs(state.length(r))
    return True


def allowances(state: SourceState, statement: Statement) -> Point:
    """Return the finishing allowance in X (a radius) and Z, in mm."""
    u, w = statement.word("U"), statement.word("W")
    return (
        state.across(u) if u is not None else 0.0,
        state.length(w) if w is not None else 0.0,
    )


def depth_of_pass(state: SourceState, statement: Statement, code: Word, rough: Roughing) -> float:
    """Return the depth of a pass in mm. Raises ProgramError if it is missing."""
    d = statement.word("D")
    if d is not None:
        return abs(state.increment(d)) if state.control.has_system_a else abs(state.length(d))
    if not rough.depth:
        raise refuse(code.line, code.column, "cycle-word", word="U" if code.value == 71 else "W")
    return rough.depth


def passes(
    state: SourceState, code: Word, contour: Sequence[Step], depth: float, retract: float, allowance: Point
) -> None:
    """Append the passes of G71 or G72, the pass along the contour, and the return. Raises ProgramError."""
    start = state.here(code)
    across_x = code.value == 71
    shifted = shift_steps(contour, allowance)
    first = (start[0] + allowance[0], start[1] + allowance[1])
    pieces = _pieces(first, shifted, across_x=across_x)
    begin = _swap(first, across_x=across_x)
    toward = copysign(1.0, _swap(contour_point(shifted), across_x=across_x)[0] - begin[0])
    lowest = max(range(len(pieces)), key=lambda k: (toward * pieces[k].end[0], -k))
    bottom, cut_pieces = pieces[lowest].end[0], pieces[lowest + 1 :]
    if not cut_pieces:
        raise refuse(code.line, code.column, "cycle-empty")
    _check_rising(code, cut_pieces, toward, across_x=across_x)
    _check_facing(code, pieces[1 : lowest + 1], allowance[1], across_x=across_x)
    state.rapid(code.line, *first)
    level = begin[0]
    while abs(bottom - level) > depth + _SAME:
        level += toward * depth
        _one_pass(state, code, cut_pieces, (begin, level, toward), retract, across_x=across_x)
    for step in shifted:
        _follow(state, code, step)
    state.rapid(
        code.line,
        *_swap((begin[0], _swap((state.x or 0.0, state.z or 0.0), across_x=across_x)[1]), across_x=across_x),
    )
    state.rapid(code.line, *start)


def _one_pass(
    state: SourceState,
    code: Word,
    pieces: Sequence[Piece],
    place: tuple[Point, float, float],
    retract: float,
    *,
    across_x: bool,
) -> None:
    begin, level, toward = place
    found = (each.crossing(level) for each in pieces)
    end = next((each for each in found if each is not None), pieces[-1].end[1])
    along = copysign(1.0, end - begin[1])
    if abs(end - begin[1]) < _SAME:
        return
    state.rapid(code.line, *_swap((level, begin[1]), across_x=across_x))
    state.cut(code, *_swap((level, end), across_x=across_x))
    out = min(retract, abs(level - begin[0]), abs(end - begin[1]))
    state.rapid(code.line, *_swap((level - toward * out, end - along * out), across_x=across_x))
    state.rapid(code.line, *_swap((level - toward * out, begin[1]), across_x=across_x))


def repeats(
    state: SourceState, code: Word, contour: Sequence[Step], rough: Roughing, allowance: Point
) -> None:
    """Append the repetitions of the contour of G73, from the relief to the allowance."""
    start = state.here(code)
    for k in range(rough.count):
        share = 1.0 - k / (rough.count - 1) if rough.count > 1 else 0.0
        by = (allowance[0] + rough.relief_x * share, allowance[1] + rough.relief_z * share)
        state.rapid(code.line, start[0] + by[0], start[1] + by[1])
        for step in shift_steps(contour, by):
            _follow(state, code, step)
        state.rapid(code.line, start[0] + by[0], start[1] + by[1])
    state.rapid(code.line, *start)


def shift_steps(steps: Sequence[Step], by: Point) -> list[Step]:
    """Return the moves shifted by X and Z in mm."""
    return [
        replace(
            step,
            x=(step.x or 0.0) + by[0],
            z=(step.z or 0.0) + by[1],
            cx=step.cx + by[0],
            cz=step.cz + by[1],
        )
        for step in steps
    ]


def _follow(state: SourceState, code: Word, step: Step) -> None:
    """Append a move of the contour at the feed of the cycle."""
    if step.kind is Kind.RAPID:
        state.rapid(step.line, step.x, step.z)
    elif step.kind is Kind.ARC:
        if state.feed is None:
            raise refuse(code.line, code.column, "feed-missing")
        state.go(
            Kind.ARC, step.line, step.x, step.z, cx=step.cx, cz=step.cz, clockwise=step.clockwise,
            feed=state.feed, per_rev=state.per_rev,
        )  # fmt: skip
    else:
        state.cut(replace_line(code, step.line), step.x, step.z)


def replace_line(code: Word, line: int) -> Word:
    """Return the word of a cycle at another line, to which its moves belong."""
    return code._replace(line=line)


def _check_facing(code: Word, pieces: Sequence[Piece], allowance: float, *, across_x: bool) -> None:
    """Raise ProgramError if the contour before its deepest point is not in front of part zero.

    The passes of G71 begin in front of the part, so that they would cut the contour there. A contour may only
    face the part before it turns.
    """
    least = min((each.end[1] for each in pieces), default=0.0)
    if pieces and (not across_x or least < min(allowance, 0.0) - _SAME):
        raise refuse(code.line, code.column, "cycle-pocket", axis="X" if across_x else "Z")


def contour_point(steps: Sequence[Step]) -> Point:
    """Return the first point of a contour, which is on the side of the part that the passes approach."""
    return steps[0].x or 0.0, steps[0].z or 0.0


def _swap(point: Point, *, across_x: bool) -> Point:
    """Return (depth, along) for (x, z) and conversely."""
    return point if across_x else (point[1], point[0])


def _pieces(first: Point, steps: Sequence[Step], *, across_x: bool) -> list[Piece]:
    points = [first, *((step.x or 0.0, step.z or 0.0) for step in steps)]
    return [
        Piece(
            _swap(a, across_x=across_x),
            _swap(b, across_x=across_x),
            _swap((step.cx, step.cz), across_x=across_x) if step.kind is Kind.ARC else None,
            step.clockwise == across_x,
        )
        for (a, b), step in zip(pairwise(points), steps, strict=True)
    ]


def _check_rising(code: Word, pieces: Sequence[Piece], toward: float, *, across_x: bool) -> None:
    """Raise ProgramError if the contour returns to the bottom, so that a pass would end too early."""
    highest = None
    for piece in pieces:
        depths = [piece.start[0], *piece.extremes(), piece.end[0]]
        for each in (-toward * depth for depth in depths):
            if highest is not None and each < highest - 0.001:
                raise refuse(code.line, code.column, "cycle-pocket", axis="X" if across_x else "Z")
            highest = each if highest is None else max(highest, each)
