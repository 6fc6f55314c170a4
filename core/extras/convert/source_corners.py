"""Chamfers and corner radii on straight moves, programmed with ``,C``, ``,R``, C, R, I or K."""

from __future__ import annotations

from dataclasses import replace
from math import acos, hypot, tan
from typing import NamedTuple

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_lines import SourceWord
from core.extras.convert.source_state import SourceState

_SLACK = 1e-6  # mm


class Corner(NamedTuple):
    """A chamfer or corner radius after the last move.

    It contains the programmed word, its size in mm, and the start point of the last move.
    """

    word: SourceWord
    size_mm: float
    move_start: tuple[float, float]


def add_corner(state: SourceState, corner: Corner, x: float, z: float) -> None:
    """Shorten the last move, and append the chamfer or arc that leads toward the next end point.

    Raises ProgramError if the corner is not possible: the last move is not a straight feed move, one move
    has no length, both moves are on one line, or the corner does not fit.
    """
    last = state.steps[-1]
    assert last.x is not None
    assert last.z is not None
    x1, z1 = last.x - corner.move_start[0], last.z - corner.move_start[1]
    x2, z2 = x - last.x, z - last.z
    first, second = hypot(x1, z1), hypot(x2, z2)
    turns = z1 * x2 - x1 * z2
    rounds = corner.word.letter.endswith("R")
    if last.kind is not StepKind.FEED or not first or not second or abs(turns) < _SLACK * first * second:
        raise make_error(corner.word.line_number, corner.word.column, "corner", word=corner.word.text)
    back = corner.size_mm
    if rounds:
        back = corner.size_mm * tan(acos(max(-1.0, min(1.0, (x1 * x2 + z1 * z2) / (first * second)))) / 2)
    if back > first + _SLACK or back > second + _SLACK:
        raise make_error(corner.word.line_number, corner.word.column, "corner", word=corner.word.text)
    a = last.x - x1 / first * back, last.z - z1 / first * back
    b = last.x + x2 / second * back, last.z + z2 / second * back
    if hypot(a[0] - corner.move_start[0], a[1] - corner.move_start[1]) < _SLACK:
        state.steps.pop()
    else:
        state.steps[-1] = replace(last, x=a[0], z=a[1])
    state.steps.append(_piece(last, a, b, (x1 / first, z1 / first), turns, corner.size_mm if rounds else 0.0))
    state.x, state.z = b


def _piece(
    last: PathStep,
    a: tuple[float, float],
    b: tuple[float, float],
    travel: tuple[float, float],
    turns: float,
    radius: float,
) -> PathStep:
    if not radius:
        return replace(last, x=b[0], z=b[1], comment="")
    # With Z to the right and X upward, a positive turn is to the left.
    left = 1.0 if turns > 0 else -1.0
    center = a[0] + travel[1] * radius * left, a[1] - travel[0] * radius * left
    # OmniTurn sees X+ downward, so that a left turn is clockwise.
    return replace(
        last, kind=StepKind.ARC, x=b[0], z=b[1], cx=center[0], cz=center[1], clockwise=left > 0, comment=""
    )
