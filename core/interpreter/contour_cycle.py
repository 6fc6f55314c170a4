"""G75 and G78: the area between the start point and a contour, in passes parallel to Z and one along it."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

from core.geometry.clip import Area
from core.geometry.contour import Element
from core.geometry.trim import TrimError
from core.interpreter.contour_reading import read_contour
from core.interpreter.cycle_blocks import LIFT, Move, check_count, left_over, name, positive, refused
from core.interpreter.rough_moves import Rougher, StartNearError
from core.interpreter.state import State
from core.interpreter.statement import Statement
from core.interpreter.view import View, view_from

_WHOLE = 1e-6  # of a pass: what a decimal fraction lacks in binary
_MOST_ELEMENTS = 2_000
_MOST_LOOKS = 200_000  # elements times passes: a few seconds


def contour_moves(state: State, made: Statement, lines: Sequence[Statement]) -> list[Move]:
    """The motions of G75 or G78 along the contour that ``lines`` describe, from the start and back to it.

    Raises ProgramError where words are missing, or no tool can run so.
    """
    if "P" in made.words and made.value("P") is None:
        text = "P does not say which subroutine describes the contour."
        raise refused(made, "P", "word-missing", text, "Write its number after P.")
    cut = positive(state, made, "I", "the greatest depth of cut") if made.one_shot == 75 else None
    left = left_over(state, made)
    contour = read_contour(state, made, lines)
    if len(contour) > _MOST_ELEMENTS:
        text = f"The contour has {len(contour):,} lines and arcs; {_MOST_ELEMENTS:,} are the most."
        raise refused(made, "G", "cycle-contour-long", text, "Run it with fewer, longer moves.")
    view = _view(state, made, contour)
    try:
        area = Area(view.seen(contour), left)
    except TrimError:
        text = f"{name(made)} finds no unbroken way along the contour at the distance U."
        raise refused(made, "U", "cycle-no-way", text, "Lower U, or open the narrow place.") from None
    rougher = Rougher(area, state.modal.rapid_rate, LIFT)
    if cut is not None:
        _passes(state, made, rougher, area, cut, len(contour))
    try:
        rougher.finish(backwards=view.backwards)
    except StartNearError:
        text = "On the way from the start point to the contour and back the tool comes nearer to it than U."
        hint = "Move the start point away from the contour."
        raise refused(made, "G", "cycle-start-near", text, hint) from None
    if area.turns_back:
        text = "The contour runs back along Z: behind that edge the pass along it cuts all that is there."
        state.log.warn(made.line, _column(made), "cycle-undercut", text, "Look whether the tool fits.")
    return [view.placed(move) for move in rougher.moves]


def _passes(state: State, made: Statement, rougher: Rougher, area: Area, cut: float, elements: int) -> None:
    if area.deepest <= 0:
        text = "The contour leaves nothing to cut between it and the start point."
        raise refused(made, "G", "cycle-nothing", text, "Start farther from the contour in X.")
    count = ceil(area.deepest / cut - _WHOLE)
    check_count(made, "I", count, "passes")
    if count * elements > _MOST_LOOKS:
        text = f"{count:,} passes beside a contour of {elements:,} lines and arcs are too many to work out."
        raise refused(made, "I", "cycle-passes", text, "Raise I, or describe the contour in fewer moves.")
    for k in range(1, count + 1):
        rougher.cut(area.deepest * k / count)
    if rougher.plunged:
        text = "The contour rises and falls again: the tool plunges into the material behind the rise."
        state.log.warn(made.line, _column(made), "cycle-plunge", text, "Look whether the tool can do so.")


def _view(state: State, made: Statement, contour: list[Element]) -> View:
    """The contour as the start point sees it. Raises ProgramError (cycle-quadrant, cycle-nothing)."""
    start, first, last = (state.x, state.z), contour[0].start, contour[-1].end
    for axis, letter in ((0, "X"), (1, "Z")):
        to_first, to_last = first[axis] - start[axis], last[axis] - start[axis]
        if to_first * to_last < 0:
            text = f"The start point lies between the ends of the contour in {letter}, not outside of both."
            raise refused(made, "G", "cycle-quadrant", text, "Move the start point beyond both ends.")
        if to_first == to_last == 0:
            text = f"Both ends of the contour have the {letter} of the start point: there is no area to cut."
            raise refused(made, "G", "cycle-nothing", text, "Move the start point away from the contour.")
    return view_from(start, first, last)


def _column(made: Statement) -> int:
    return made.code.column if made.code else 0
