"""G74, G75 and G78: a box, or the area before a contour, taken off in passes parallel to Z."""

from __future__ import annotations

from collections.abc import Sequence

from core.geometry.contour_offset import Area, TrimError
from core.geometry.lines_and_arcs import Element
from core.interpreter.omniturn.codes.code_rules import number
from core.interpreter.omniturn.cycles.canned_cycles import LIFT, check_count, length, name
from core.interpreter.omniturn.cycles.cycle_contour import read_contour
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.contour_passes import (
    MOST_ELEMENTS,
    MOST_LOOKS,
    ContourView,
    Move,
    Rougher,
    StartNearError,
    equal_depths,
    pass_count,
    view_from,
)

_SAME = 1e-6  # mm


def contour_moves(state: State, statement: Statement, lines: Sequence[Statement]) -> list[Move]:
    """The motions of G75 or G78 along the contour that ``lines`` describe, from the start and back to it.

    Raises ProgramError where words are missing, or no tool can run so.
    """
    number(state, statement, "P")
    cut = length(state, statement, "I") if statement.one_shot == 75 else None
    left = length(state, statement, "U")
    contour = read_contour(state, statement, lines)
    if len(contour) > MOST_ELEMENTS:
        raise statement.refuse(
            "G",
            "cycle-contour-long",
            "The contour has {contour_count} lines and arcs; the maximum is {most_elements}.",
            "Program the contour with fewer, longer moves.",
            contour_count=f"{len(contour):,}",
            most_elements=f"{MOST_ELEMENTS:,}",
        )
    view = _view(state, statement, contour)
    try:
        area = Area(view.from_start(contour), left)
    except TrimError:
        text = "{text} cannot find a continuous path along the contour at distance U."
        hint = "Reduce U, or widen the narrow part of the contour."
        raise statement.refuse("U", "cycle-no-way", text, hint, text=name(statement)) from None
    rougher = Rougher(area, state.modal.rapid_rate, LIFT)
    if cut is not None:
        _passes(state, statement, rougher, area, cut, len(contour))
    try:
        rougher.finish(backwards=view.backwards)
    except StartNearError:
        text = (
            "On the path from the start point to the contour and back, the tool comes closer to "
            "the contour than the distance U."
        )
        hint = "Move the start point away from the contour."
        if _falls_at_once(view.from_start(contour)[0]):
            hint = (
                "The contour goes deeper immediately after its first point; start the contour at the "
                "lowest X and move up the face first."
            )
        raise statement.refuse("G", "cycle-start-near", text, hint) from None
    if area.turns_back:
        text = (
            "The contour reverses along Z. The roughing passes do not reach this undercut, so the pass along "
            "the contour cuts all of its material."
        )
        hint = "Check whether the tool fits into the undercut."
        state.log.warn(statement.line, statement.code_column, "cycle-undercut", text, hint)
    return [view.placed(move) for move in rougher.moves]


def _falls_at_once(first: Element) -> bool:
    """Whether a contour, in depth and way from the start point, goes deeper as soon as it goes on."""
    (depth, way), (there, further) = first.start, first.end
    return there > depth + _SAME and abs(further - way) > _SAME


def _passes(
    state: State, statement: Statement, rougher: Rougher, area: Area, cut: float, elements: int
) -> None:
    text = "No material remains to be cut between the contour and the start point."
    statement.check(area.deepest > 0, "G", "cycle-nothing", text, "Start farther from the contour in X.")
    count = pass_count(area.deepest, cut)
    check_count(statement, "I", count, "passes")
    if count * elements > MOST_LOOKS:
        text = "{count} passes along a contour of {elements} lines and arcs are too many to calculate."
        hint = "Increase I, or program the contour with fewer moves."
        raise statement.refuse("I", "cycle-passes", text, hint, count=f"{count:,}", elements=f"{elements:,}")
    rougher.rough(count)
    if rougher.plunged:
        text = "The contour rises and falls again, so the tool plunges into the material after the rise."
        hint = "Check whether the tool can plunge into the material."
        state.log.warn(statement.line, statement.code_column, "cycle-plunge", text, hint)


def _view(state: State, statement: Statement, contour: list[Element]) -> ContourView:
    """The contour as the start point sees it. Raises ProgramError (cycle-quadrant, cycle-nothing)."""
    start, first, last = (state.x, state.z), contour[0].start, contour[-1].end
    for axis, letter in ((0, "X"), (1, "Z")):
        to_first, to_last = first[axis] - start[axis], last[axis] - start[axis]
        text = (
            "In {letter}, the start point is between the two ends of the contour, but it must be outside "
            "them."
        )
        hint = (
            "Move the start point so that both ends of the contour are on the same side of it, in X and in Z."
        )
        statement.check(to_first * to_last >= 0, "G", "cycle-quadrant", text, hint, letter=letter)
        text = (
            "Both ends of the contour have the same {letter} as the start point, so the contour does not "
            "enclose an area to cut."
        )
        hint = "Move the start point away from the contour."
        statement.check(not to_first == to_last == 0, "G", "cycle-nothing", text, hint, letter=letter)
    return view_from(start, first, last)


def box_moves(state: State, statement: Statement) -> list[Move]:
    """Equal passes from the start's X to X, none deeper than I, U left on a side; back to the start.

    The tool goes in at the feed: behind a shoulder it does so in material. Raises ProgramError.
    """
    x = _corner(state, statement, "X", state.x, state.dx)
    z = _corner(state, statement, "Z", state.z, state.dz)
    cut, left = length(state, statement, "I"), length(state, statement, "U")
    towards = 1.0 if x > state.x else -1.0
    depth = abs(x - state.x) - left
    if depth <= 0:
        text = "The allowance {text} leaves no material for the box cycle to cut."
        hint = "U must be less than the distance in X from the start point to the programmed X."
        raise statement.refuse("U", "cycle-nothing", text, hint, text=statement.words["U"].text)
    count = pass_count(depth, cut)
    check_count(statement, "I", count, "passes")
    rapid = state.modal.rapid_rate
    moves: list[Move] = []
    for below in equal_depths(depth, count):
        level = state.x + towards * below
        off = level - towards * LIFT
        moves += [Move(level, state.z), Move(level, z), Move(off, z, rapid), Move(off, state.z, rapid)]
    return [*moves, Move(state.x, state.z, rapid)]


def _corner(state: State, statement: Statement, letter: str, start: float, offset: float) -> float:
    """X or Z of the corner opposite to the start."""
    end = length(state, statement, letter) + (offset if state.absolute else start)
    text = "The box has zero size along {letter} because its corner is at the start point."
    hint = "Correct {letter} or the start point."
    statement.check(end != start, letter, "cycle-nothing", text, hint, letter=letter)
    return end
