"""Contours of SL cycles, as listed by cycle 14 or CONTOUR DEF, and the area that they enclose.

A contour is a subprogram that is executed without moving an axis. A contour that runs clockwise with RR or
counterclockwise with RL is a pocket; otherwise, it is an island. Pockets that overlap are combined. If the
first pocket starts inside the other one, only their intersection counts (manual: areas of inclusion and
intersection). Islands remain.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass

from core.geometry.lines_and_arcs import Element, Point, intersections
from core.geometry.pocket_area import AreaError, Loop, Winding, boundary, follows, goes_round
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.path_elements import PathElement
from core.interpreter.klartext.motion.path_functions import PathRunner
from core.language.klartext.klartext_faults import CYCLE_MISSING, INPUT_VALUE, unsupported
from core.language.klartext.klartext_nodes import Move
from core.message import Message

OPEN = 0.016  # mm; permitted gap between start and end of a contour, as for an arc and its circle


@dataclass(frozen=True, slots=True)
class ContourFigure:
    """The elements of one contour in the program's X and Y; ``side`` is L, R or empty without compensation.

    ``label`` is its name in messages. ``pocket`` comes from CONTOUR DEF; with None, the side determines it.
    """

    label: str
    elements: tuple[Element, ...]
    side: str = ""
    pocket: bool | None = None


class FigureRunner(PathRunner):
    """Runner that collects the elements of a contour, with corners, without generating blocks."""

    def __init__(self, state: State) -> None:
        super().__init__(state)
        self._begun = -1  # index of the element that leads to the start of the contour
        self.side = ""

    @property
    def elements(self) -> tuple[Element, ...]:
        """The elements after the block that leads to the start of the contour."""
        behind = self._waiting[self._begun + 1 :]
        return tuple(each.flat for each in behind if isinstance(each, PathElement) and each.flat is not None)

    def draw(self, node: Move) -> None:
        """Add the element of a path function. Raises ProgramError if it is not allowed in a contour."""
        if node.form.startswith(("APPR", "DEP")):
            raise unsupported(
                self._state.line, node.column, Message("{form} inside an SL cycle contour", form=node.form)
            )
        if not node.axes and not node.words and node.form == "L":
            return
        self.side = self.side or node.compensation.strip("0+-")
        made = list(self._elements(node))
        if any(each.upright for each in made):
            raise unsupported(self._state.line, node.column, "A vertical arc inside an SL cycle contour")
        if self._corner is not None:
            made[0] = self._rounded(made[0])
        if self._begun < 0 and (node.words or any(word.axis in "XY" for word in node.axes)):
            self._begun = len(self._waiting)
        self._waiting += made
        self._end = made[-1].end
        self._direction = made[-1].end_direction or self._direction

    def _take_feed(self, node: Move) -> float | None:
        del node  # The feeds of a contour have no effect.
        return None

    def close(self) -> None:
        """Process the end of the subprogram. Raises ProgramError if a corner is unfinished."""
        self._demand_no_corner()


def copy_of(state: State) -> State:
    """Return a copy of the state for a contour, so that its assignments do not affect the program."""
    shared = (state.setup, state.log, state.kinematics)
    copied = deepcopy(state, {id(each): each for each in shared})
    copied.m128 = False
    return copied


# --- the area


def area_of(state: State, figures: Sequence[ContourFigure], column: int) -> list[Loop]:
    """Return the boundary of the area to clear. Raises ProgramError if the contours enclose no area."""
    pockets: list[Loop] = []
    islands: list[Loop] = []
    for figure in figures:
        loop = _closed(state, figure, column)
        (pockets if _is_pocket(state, figure, loop, column) else islands).append(loop)
    text = "Cycle 14 lists only islands and no pocket, so there is nothing to clear."
    state.check(pockets, column, INPUT_VALUE, text, "Program the outer contour clockwise with RR.")
    return _bounded(state, [*pockets, *islands], _inside(pockets, islands), column)


def _bounded(state: State, loops: Sequence[Loop], inside: Callable[[Point], bool], column: int) -> list[Loop]:
    """Return the boundary of an area. Raises ProgramError if it cannot be determined or is empty."""
    try:
        found = boundary(loops, inside)
    except AreaError as problem:
        text = "The contours cannot be combined: {problem}."
        hint = "Correct the entries named in the message."
        raise state.refuse(column, INPUT_VALUE, text, hint, problem=problem) from None
    text = "The contours do not enclose an area because the islands cover the pockets."
    state.check(found, column, INPUT_VALUE, text, "Correct the contours.")
    return found


def _closed(state: State, figure: ContourFigure, column: int) -> Loop:
    """Return the contour as a loop. Raises ProgramError if it is open."""
    text = "Contour {figure} does not contain any elements."
    hint = "Add path functions to the contour."
    state.check(figure.elements, column, CYCLE_MISSING, text, hint, figure=figure.label)
    gap = math.dist(figure.elements[-1].end, figure.elements[0].start)
    text = "Contour {figure} ends {gap} mm from its start."
    hint = "End the contour at its start point."
    state.check(gap <= OPEN, column, INPUT_VALUE, text, hint, figure=figure.label, gap=f"{gap:.10g}")
    return follows(figure.elements)


def _is_pocket(state: State, figure: ContourFigure, loop: Loop, column: int) -> bool:
    if figure.pocket is not None:
        return figure.pocket
    text = "No machining side is programmed for contour {figure}."
    hint = "Write RL or RR in the first block of the contour."
    state.check(figure.side, column, CYCLE_MISSING, text, hint, figure=figure.label)
    return goes_round(loop) == (figure.side == "L")


def _inside(pockets: Sequence[Loop], islands: Sequence[Loop]) -> Callable[[Point], bool]:
    """Return a function that determines whether a point must be cleared."""
    first, *others = [Winding(loop) for loop in pockets]
    stay = [Winding(loop) for loop in islands]
    start = pockets[0][0].start
    both = [
        within.round(start) != 0 and _meet(pockets[0], loop)
        for within, loop in zip(others, pockets[1:], strict=True)
    ]

    def inside(point: Point) -> bool:
        found = first.round(point) != 0
        for within, only_both in zip(others, both, strict=True):
            other = within.round(point) != 0
            found = found and other if only_both else found or other
        return found and not any(within.round(point) for within in stay)

    return inside


def _meet(one: Loop, other: Loop) -> bool:
    return any(intersections(a, b) for a in one for b in other)
