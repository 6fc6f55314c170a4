"""Contour cycles: roughing in passes (G71, G72), contour repetition (G73) and finishing (G70)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import copysign
from typing import NamedTuple

from core.extras.convert.contour_pieces import Piece, Point, deeper_sections, turns_back
from core.extras.convert.path_steps import Kind, Step
from core.extras.convert.reasons import refuse
from core.extras.convert.source_lines import Statement, Word
from core.extras.convert.source_state import SourceState

_SAME = 1e-6  # mm


@dataclass(slots=True)
class Roughing:
    """Values of the first line of a roughing cycle.

    Depth, retract and relief are in mm. ``count`` is the number of repetitions.
    """

    depth: float = 0.0
    retract: float = 0.5
    relief_x: float = 0.0
    relief_z: float = 0.0
    count: int = 1


def roughing_words(state: SourceState, statement: Statement, code: Word, rough: Roughing) -> bool:
    """Store the words of the first line of a roughing cycle; return whether the line is such a line."""
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
    """Return the depth of a pass in mm.

    Raises ProgramError if the depth is missing.
    """
    d = statement.word("D")
    if d is not None:
        return abs(state.increment(d)) if state.control.has_system_a else abs(state.length(d))
    if not rough.depth:
        raise refuse(code.line, code.column, "cycle-word", word="U" if code.value == 71 else "W")
    return rough.depth


def passes(
    state: SourceState, code: Word, contour: Sequence[Step], depth: float, retract: float, allowance: Point
) -> None:
    """Append the passes of G71 or G72, the pass along the contour, and the return move.

    Raises ProgramError.
    """
    start = state.here(code)
    across_x = code.value == 71
    shifted = shift_steps(contour, allowance)
    if len(shifted) < 2:
        raise refuse(code.line, code.column, "cycle-empty")
    first = (start[0] + allowance[0], start[1] + allowance[1])
    begin = _swap(first, across_x=across_x)
    pieces = _pieces(first, shifted, across_x=across_x)[1:]
    toward = copysign(1.0, pieces[0].start[0] - begin[0])
    along = copysign(1.0, pieces[-1].end[1] - begin[1])
    if turns_back(pieces, along):
        raise refuse(code.line, code.column, "cycle-undercut", axis="Z" if across_x else "X")
    depths = [each for piece in pieces for each in (piece.start[0], *piece.extremes(0), piece.end[0])]
    bottom = max(depths, key=lambda each: toward * each)
    state.rapid(code.line, *first)
    level = begin[0]
    while abs(bottom - level) > depth + _SAME:
        level += toward * depth
        place = Level(begin, level, toward, along, depth, retract)
        _one_level(state, code, pieces, place, across_x=across_x)
    for step in shifted:
        _follow(state, code, step)
    end = _swap(state.here(code), across_x=across_x)
    state.rapid(code.line, *_swap((begin[0], end[1]), across_x=across_x))
    state.rapid(code.line, *start)


class Level(NamedTuple):
    """One depth level of the passes: start point of the cycle, signs of depth and travel, and sizes in mm."""

    begin: Point
    level: float
    toward: float
    along: float
    depth: float
    retract: float


def _one_level(state: SourceState, code: Word, pieces: Sequence[Piece], at: Level, *, across_x: bool) -> None:
    """Append the passes at one depth level.

    There is one pass for each section where the contour is deeper than this level.
    """
    begin, level, toward = at.begin, at.level, at.toward
    for low, high in deeper_sections(pieces, level, toward):
        enter = begin[1] if low is None else low
        if abs(high - enter) <= _SAME:
            continue
        if low is None:
            state.rapid(code.line, *_swap((level, enter), across_x=across_x))
        else:
            # The tool enters a pocket where the pass before has cut.
            above = level - toward * min(at.depth + at.retract, abs(level - begin[0]))
            state.rapid(code.line, *_swap((begin[0], enter), across_x=across_x))
            state.rapid(code.line, *_swap((above, enter), across_x=across_x))
            state.cut(code, *_swap((level, enter), across_x=across_x))
        state.cut(code, *_swap((level, high), across_x=across_x))
        out = min(at.retract, abs(level - begin[0]), abs(high - enter))
        state.rapid(code.line, *_swap((level - toward * out, high - at.along * out), across_x=across_x))
        if low is not None:
            state.rapid(code.line, *_swap((begin[0], high - at.along * out), across_x=across_x))
            out = abs(level - begin[0])
        state.rapid(code.line, *_swap((level - toward * out, begin[1]), across_x=across_x))


def repeats(
    state: SourceState, code: Word, contour: Sequence[Step], rough: Roughing, allowance: Point
) -> None:
    """Append the repetitions of the contour of G73, which progress from the relief to the allowance."""
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
    """Return the steps shifted by the X and Z distances ``by`` in mm."""
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
    """Append a move along the contour at the feed of the cycle."""
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
    """Return the word of a cycle with another line number, so that its moves belong to this line."""
    return code._replace(line=line)


def _swap(point: Point, *, across_x: bool) -> Point:
    """Convert (x, z) to (depth, travel), or back."""
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
