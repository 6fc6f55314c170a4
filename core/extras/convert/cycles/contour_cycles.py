"""Contour cycles: roughing in passes (G71, G72), contour repetition (G73) and finishing (G70)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import copysign
from typing import NamedTuple

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.contour_pieces import ContourPiece, Point, find_deeper_sections, has_reversal
from core.extras.convert.cycles.cycle_limits import limit_pass_count, require_positive
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_state import SourceState

_SAME = 1e-6  # mm
_MAX_REPETITIONS = 1000


@dataclass(slots=True)
class RoughingValues:
    """Values from the first line of a two-line roughing cycle.

    ``depth_mm`` is the depth of a pass. The retract, and the relief in X and Z (only of G73), are also in
    mm. ``repetition_count`` is the number of repetitions of G73.
    """

    depth_mm: float = 0.0
    retract_mm: float = 0.5
    relief_x: float = 0.0
    relief_z: float = 0.0
    repetition_count: int = 1


def store_roughing_words(
    state: SourceState, statement: SourceStatement, code: SourceWord, rough: RoughingValues
) -> bool:
    """Store the words of a line if it is the first line of a roughing cycle; return whether it is.

    Raises ProgramError if the contour would be repeated too often.
    """
    if statement.find_word("P") is not None:
        return False
    u, w, r = (statement.find_word(letter) for letter in "UWR")
    if code.value == 73:
        rough.relief_x = state.convert_length(u) if u is not None else 0.0
        rough.relief_z = state.convert_length(w) if w is not None else 0.0
        rough.repetition_count = (
            max(round(r.value * (1 if not r.has_decimal_point or r.value >= 1 else 1000)), 1) if r else 1
        )
        if r is not None and rough.repetition_count > _MAX_REPETITIONS:
            raise make_error(r.line_number, r.column, "too-many-passes", word=r.text)
        return True
    depth = u if code.value == 71 else w
    if depth is not None:
        rough.depth_mm = abs(state.convert_length(depth))
    if r is not None:
        rough.retract_mm = abs(state.convert_length(r))
    return True


def read_allowances(state: SourceState, statement: SourceStatement) -> Point:
    """Return the finishing allowance in X (a radius) and Z, in mm."""
    u, w = statement.find_word("U"), statement.find_word("W")
    return (
        state.convert_x(u) if u is not None else 0.0,
        state.convert_length(w) if w is not None else 0.0,
    )


def read_pass_depth(
    state: SourceState, statement: SourceStatement, code: SourceWord, rough: RoughingValues
) -> float:
    """Return the depth of a roughing pass in mm.

    Raises ProgramError if the depth is missing or zero.
    """
    d = statement.find_word("D")
    if d is not None:
        depth = (
            state.convert_increment(d) if state.source_control.uses_code_system_a else state.convert_length(d)
        )
        return require_positive(d, abs(depth))
    if not rough.depth_mm:
        raise make_error(code.line_number, code.column, "cycle-word", word="U" if code.value == 71 else "W")
    return rough.depth_mm


def append_roughing_passes(
    state: SourceState,
    code: SourceWord,
    contour: Sequence[PathStep],
    depth: float,
    retract: float,
    allowance: Point,
) -> None:
    """Append the roughing passes of G71 or G72, the pass along the contour, and the return move.

    Raises ProgramError if the contour is empty or has an undercut, or if it needs too many passes.
    """
    start = state.get_position(code)
    across_x = code.value == 71
    shifted = shift_steps(contour, allowance)
    if len(shifted) < 2:
        raise make_error(code.line_number, code.column, "cycle-empty")
    first = (start[0] + allowance[0], start[1] + allowance[1])
    begin = _swap(first, across_x=across_x)
    pieces = _pieces(first, shifted, across_x=across_x)[1:]
    toward = copysign(1.0, pieces[0].start[0] - begin[0])
    along = copysign(1.0, pieces[-1].end[1] - begin[1])
    if has_reversal(pieces, along):
        raise make_error(code.line_number, code.column, "cycle-undercut", axis="Z" if across_x else "X")
    depths = [each for piece in pieces for each in (piece.start[0], *piece.find_extremes(0), piece.end[0])]
    bottom = max(depths, key=lambda each: toward * each)
    limit_pass_count(code, abs(bottom - begin[0]), depth)
    state.append_rapid(code.line_number, *first)
    level = begin[0]
    while abs(bottom - level) > depth + _SAME:
        level += toward * depth
        place = DepthLevel(begin, level, toward, along, depth, retract)
        _one_level(state, code, pieces, place, across_x=across_x)
    for step in shifted:
        _follow(state, code, step)
    end = _swap(state.get_position(code), across_x=across_x)
    state.append_rapid(code.line_number, *_swap((begin[0], end[1]), across_x=across_x))
    state.append_rapid(code.line_number, *start)


class DepthLevel(NamedTuple):
    """One depth level of the roughing passes.

    It contains the start point of the cycle, sizes in mm, and the signs of two directions: depth, and
    travel along the pass.
    """

    start_point: Point
    depth: float
    depth_sign: float
    travel_sign: float
    pass_depth: float
    retract_mm: float


def _one_level(
    state: SourceState, code: SourceWord, pieces: Sequence[ContourPiece], at: DepthLevel, *, across_x: bool
) -> None:
    """Append the passes at one depth level.

    There is one pass for each section where the contour is deeper than this level.
    """
    begin, level, toward = at.start_point, at.depth, at.depth_sign
    for low, high in find_deeper_sections(pieces, level, toward):
        enter = begin[1] if low is None else low
        if abs(high - enter) <= _SAME:
            continue
        if low is None:
            state.append_rapid(code.line_number, *_swap((level, enter), across_x=across_x))
        else:
            # The tool enters a pocket where the pass before has cut.
            above = level - toward * min(at.pass_depth + at.retract_mm, abs(level - begin[0]))
            state.append_rapid(code.line_number, *_swap((begin[0], enter), across_x=across_x))
            state.append_rapid(code.line_number, *_swap((above, enter), across_x=across_x))
            state.append_cut(code, *_swap((level, enter), across_x=across_x))
        state.append_cut(code, *_swap((level, high), across_x=across_x))
        out = min(at.retract_mm, abs(level - begin[0]), abs(high - enter))
        state.append_rapid(
            code.line_number, *_swap((level - toward * out, high - at.travel_sign * out), across_x=across_x)
        )
        if low is not None:
            state.append_rapid(
                code.line_number, *_swap((begin[0], high - at.travel_sign * out), across_x=across_x)
            )
            out = abs(level - begin[0])
        state.append_rapid(code.line_number, *_swap((level - toward * out, begin[1]), across_x=across_x))


def append_contour_repetitions(
    state: SourceState, code: SourceWord, contour: Sequence[PathStep], rough: RoughingValues, allowance: Point
) -> None:
    """Append the G73 repetitions of the contour, from the relief distance to the finishing allowance."""
    start = state.get_position(code)
    for k in range(rough.repetition_count):
        share = 1.0 - k / (rough.repetition_count - 1) if rough.repetition_count > 1 else 0.0
        by = (allowance[0] + rough.relief_x * share, allowance[1] + rough.relief_z * share)
        state.append_rapid(code.line_number, start[0] + by[0], start[1] + by[1])
        for step in shift_steps(contour, by):
            _follow(state, code, step)
        state.append_rapid(code.line_number, start[0] + by[0], start[1] + by[1])
    state.append_rapid(code.line_number, *start)


def shift_steps(steps: Sequence[PathStep], distance: Point) -> list[PathStep]:
    """Return the path steps shifted by ``distance``, which is (X, Z) in mm."""
    return [
        replace(
            step,
            x=(step.x or 0.0) + distance[0],
            z=(step.z or 0.0) + distance[1],
            cx=step.cx + distance[0],
            cz=step.cz + distance[1],
        )
        for step in steps
    ]


def _follow(state: SourceState, code: SourceWord, step: PathStep) -> None:
    """Append a move along the contour, at the feed of the cycle or as a rapid."""
    if step.kind is StepKind.RAPID:
        state.append_rapid(step.line, step.x, step.z)
    elif step.kind is StepKind.ARC:
        if state.feed is None:
            raise make_error(code.line_number, code.column, "feed-missing")
        state.append_move(
            StepKind.ARC, step.line, step.x, step.z, cx=step.cx, cz=step.cz, clockwise=step.clockwise,
            feed=state.feed, per_rev=state.is_feed_per_rev,
        )  # fmt: skip
    else:
        state.append_cut(replace_line(code, step.line), step.x, step.z)


def replace_line(code: SourceWord, line: int) -> SourceWord:
    """Return the G word of a cycle with another line number, to which its moves then refer."""
    return code._replace(line_number=line)


def _swap(point: Point, *, across_x: bool) -> Point:
    """Exchange the coordinates of a point as needed: (x, z) to (depth, travel), or the reverse."""
    return point if across_x else (point[1], point[0])


def _pieces(first: Point, steps: Sequence[PathStep], *, across_x: bool) -> list[ContourPiece]:
    points = [first, *((step.x or 0.0, step.z or 0.0) for step in steps)]
    return [
        ContourPiece(
            _swap(a, across_x=across_x),
            _swap(b, across_x=across_x),
            _swap((step.cx, step.cz), across_x=across_x) if step.kind is StepKind.ARC else None,
            step.clockwise == across_x,
        )
        for (a, b), step in zip(pairwise(points), steps, strict=True)
    ]
