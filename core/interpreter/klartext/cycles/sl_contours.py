"""Contours of SL cycles, as listed in cycle 14 or CONTOUR DEF, and the area that they enclose.

A contour is a subprogram that is executed without axis motion. A contour is a pocket if it runs clockwise
with RR or counterclockwise with RL; otherwise, it is an island. Overlapping pockets are combined. If the
first pocket starts inside the other pocket, only their intersection is cleared (see areas of inclusion and
intersection in the manual). Islands are not cleared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass

from core.geometry.lines_and_arcs import Element, Point, find_intersections
from core.geometry.pocket_area import (
    ElementLoop,
    PocketAreaError,
    WindingCalculator,
    close_loop,
    find_boundary,
    is_counterclockwise,
)
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.path_elements import PathElement
from core.interpreter.klartext.motion.path_functions import PathRunner
from core.language.klartext.klartext_faults import (
    CYCLE_MISSING,
    INPUT_VALUE_INCORRECT,
    make_unsupported_error,
)
from core.language.klartext.klartext_nodes import PathFunction
from core.message import Message

MAX_CLOSING_GAP_MM = (
    0.016  # mm; permitted gap between start and end of a contour, as for an arc and its circle
)


@dataclass(frozen=True, slots=True)
class SlContour:
    """The elements of one contour in the program's X and Y.

    ``label`` is the name of the contour in messages. ``compensation_side`` is L or R, or an empty string
    without compensation. ``is_pocket`` comes from CONTOUR DEF; if it is None, the side determines whether
    the contour is a pocket.
    """

    label: str
    elements: tuple[Element, ...]
    compensation_side: str = ""
    is_pocket: bool | None = None


class ContourCollector(PathRunner):
    """Path runner that collects the elements and corners of a contour and generates no blocks."""

    def __init__(self, state: State) -> None:
        super().__init__(state)
        self._begun = -1  # index of the element that leads to the start of the contour
        self.side = ""

    @property
    def elements(self) -> tuple[Element, ...]:
        """Return the elements that follow the move to the start of the contour."""
        contour_items = self._waiting[self._begun + 1 :]
        return tuple(
            each.planar_element
            for each in contour_items
            if isinstance(each, PathElement) and each.planar_element is not None
        )

    def add_path_function(self, node: PathFunction) -> None:
        """Add the element of a path function.

        Raises ProgramError if a contour cannot contain this function, or if the element or its corner is
        invalid.
        """
        if node.function_name.startswith(("APPR", "DEP")):
            raise make_unsupported_error(
                self._state.line_number,
                node.column,
                Message("{form} inside an SL cycle contour", form=node.function_name),
            )
        if not node.axis_words and not node.words and node.function_name == "L":
            return
        self.side = self.side or node.compensation.strip("0+-")
        made = list(self._elements(node))
        if any(each.is_vertical_arc for each in made):
            raise make_unsupported_error(
                self._state.line_number, node.column, "A vertical arc inside an SL cycle contour"
            )
        if self._corner is not None:
            made[0] = self._insert_corner(made[0])
        if self._begun < 0 and (node.words or any(word.axis in "XY" for word in node.axis_words)):
            self._begun = len(self._waiting)
        self._waiting += made
        self._end = made[-1].end
        self._direction = made[-1].end_direction or self._direction

    def _set_block_feed(self, node: PathFunction) -> float | None:
        del node  # The feeds of a contour have no effect.
        return None

    def finish_contour(self) -> None:
        """Complete the contour at the end of the subprogram.

        Raises ProgramError if a corner is incomplete.
        """
        self._check_no_corner()


def copy_state(state: State) -> State:
    """Return a copy of the state, so that assignments in a contour do not affect the program."""
    shared = (state.setup, state.log, state.kinematics)
    copied = deepcopy(state, {id(each): each for each in shared})
    copied.is_tcpm_active = False
    return copied


# --- the area


def find_area_boundary(state: State, contours: Sequence[SlContour], column: int) -> list[ElementLoop]:
    """Return the boundary of the area to clear.

    Raises ProgramError if a contour is empty or open or has no machining side, if the contours cannot be
    combined, or if they do not enclose an area.
    """
    pockets: list[ElementLoop] = []
    islands: list[ElementLoop] = []
    for figure in contours:
        loop = _make_loop(state, figure, column)
        (pockets if _is_pocket(state, figure, loop, column) else islands).append(loop)
    text = "Cycle 14 lists only islands and no pocket, so there is nothing to clear."
    state.check_condition(
        pockets, column, INPUT_VALUE_INCORRECT, text, "Program the outer contour clockwise with RR."
    )
    return _compute_boundary(state, [*pockets, *islands], _inside(pockets, islands), column)


def _compute_boundary(
    state: State, loops: Sequence[ElementLoop], inside: Callable[[Point], bool], column: int
) -> list[ElementLoop]:
    """Return the boundary of an area.

    Raises ProgramError if the boundary cannot be determined or the area is empty.
    """
    try:
        found = find_boundary(loops, inside)
    except PocketAreaError as problem:
        text = "The contours cannot be combined: {problem}."
        hint = "Correct the entries named in the message."
        raise state.make_error(column, INPUT_VALUE_INCORRECT, text, hint, problem=problem) from None
    text = "The contours do not enclose an area because the islands cover the pockets."
    state.check_condition(found, column, INPUT_VALUE_INCORRECT, text, "Correct the contours.")
    return found


def _make_loop(state: State, contour: SlContour, column: int) -> ElementLoop:
    """Return the contour as a closed loop.

    Raises ProgramError if the contour has no elements, or if its end is more than 0.016 mm from its start.
    """
    text = "Contour {figure} does not contain any elements."
    hint = "Add path functions to the contour."
    state.check_condition(contour.elements, column, CYCLE_MISSING, text, hint, figure=contour.label)
    gap = math.dist(contour.elements[-1].end, contour.elements[0].start)
    text = "Contour {figure} ends {gap} mm from its start."
    hint = "End the contour at its start point."
    state.check_condition(
        gap <= MAX_CLOSING_GAP_MM,
        column,
        INPUT_VALUE_INCORRECT,
        text,
        hint,
        figure=contour.label,
        gap=f"{gap:.10g}",
    )
    return close_loop(contour.elements)


def _is_pocket(state: State, figure: SlContour, loop: ElementLoop, column: int) -> bool:
    if figure.is_pocket is not None:
        return figure.is_pocket
    text = "No machining side is programmed for contour {figure}."
    hint = "Write RL or RR in the first block of the contour."
    state.check_condition(figure.compensation_side, column, CYCLE_MISSING, text, hint, figure=figure.label)
    return is_counterclockwise(loop) == (figure.compensation_side == "L")


def _inside(pockets: Sequence[ElementLoop], islands: Sequence[ElementLoop]) -> Callable[[Point], bool]:
    """Return a function that determines whether a point must be cleared."""
    first, *others = [WindingCalculator(loop) for loop in pockets]
    stay = [WindingCalculator(loop) for loop in islands]
    start = pockets[0][0].start
    both = [
        within.compute_winding_number(start) != 0 and _meet(pockets[0], loop)
        for within, loop in zip(others, pockets[1:], strict=True)
    ]

    def is_inside_area(point: Point) -> bool:
        found = first.compute_winding_number(point) != 0
        for within, only_both in zip(others, both, strict=True):
            other = within.compute_winding_number(point) != 0
            found = found and other if only_both else found or other
        return found and not any(within.compute_winding_number(point) for within in stay)

    return is_inside_area


def _meet(one: ElementLoop, other: ElementLoop) -> bool:
    return any(find_intersections(a, b) for a in one for b in other)
