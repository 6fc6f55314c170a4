"""Radius compensation with RL and RR, and approaches and departures with APPR and DEP.

The tool center is one radius to the left or right of the contour. Without APPR, the tool moves straight to
the point perpendicular to the start of the contour. At the end of the contour, the tool remains at the
perpendicular point until a block with R0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from core.geometry.contour_offset import GougeError, OffsetPiece, offset_known_contour
from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    Element,
    Point,
    find_tangent_point,
    get_left_normal,
)
from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.path_elements import PathElement, compute_end_point
from core.language.klartext.klartext_faults import (
    INPUT_VALUE_INCORRECT,
    RADIUS_TOO_LARGE,
    make_klartext_error,
)
from core.language.klartext.klartext_nodes import PathFunction
from core.message import Message

_MAX_CCA = 360.0


class CompensatedContour:
    """A contour together with the tool path, which is offset to one side by the tool radius.

    The tool radius is in mm.
    """

    def __init__(self, elements: list[PathElement], side: str, tool_radius_mm: float) -> None:
        self._flats = [each for each in elements if each.planar_element is not None]
        self._pieces: dict[int, list[OffsetPiece]] = {id(each): [] for each in elements}
        self.first_element: Element | None = self._flats[0].planar_element if self._flats else None
        for piece in self._beside(tool_radius_mm if side == "L" else -tool_radius_mm):
            self._pieces[id(self._flats[piece.source_index])].append(piece)

    @property
    def end_point(self) -> Point | None:
        """Return the end point of the contour, or None if the contour has no motion in the plane."""
        return self._flats[-1].end[:2] if self._flats else None

    @property
    def end_direction(self) -> Point | None:
        """Return the direction at the end of the contour, or None if it has no motion in the plane."""
        return self._flats[-1].end_direction if self._flats else None

    def _beside(self, left: float) -> list[OffsetPiece]:
        try:
            return offset_known_contour(
                [each.planar_element for each in self._flats if each.planar_element is not None], left
            )
        except GougeError as problem:
            at = self._flats[min(problem.element_index, len(self._flats) - 1)]
            text = Message(
                "A tool radius of {radius} mm does not fit the contour: {why}.",
                radius=f"{abs(left):.10g}",
                why=problem.reason,
            )
            hint = "Use a smaller tool, or change the contour."
            raise make_klartext_error(at.line_number, at.column, RADIUS_TOO_LARGE, text, hint) from None

    def generate_path(self, element: PathElement, start: Vector) -> Iterator[PathElement]:
        """Yield the tool path along one element from ``start``, with the outside corner at its end."""
        mine = self._pieces[id(element)]
        z0, z1 = element.start[2], element.end[2]
        if not mine:
            if abs(z1 - z0) > SAME_POINT_TOLERANCE_MM:
                yield replace(element, start=start, end=(*start[:2], z1), arc=None)
            return
        whole = sum(piece.element.length for piece in mine if not piece.is_corner)
        done = 0.0
        for piece in mine:
            below = z0 + (z1 - z0) * (done / whole if whole else 1.0)
            done += 0.0 if piece.is_corner else piece.element.length
            above = z0 + (z1 - z0) * (done / whole if whole else 1.0)
            yield _along(element, piece.element, below, above)


def _along(element: PathElement, flat: Element, z0: float, z1: float) -> PathElement:
    arc = flat if isinstance(flat, Arc) else None
    return replace(element, start=(*flat.start, z0), end=(*flat.end, z1), arc=arc)


@dataclass(frozen=True, slots=True)
class ContourEntry:
    """An approach from the tool position ``start_position`` to the first point of a contour.

    ``compensation_side`` is L, R or an empty string (none). Lengths are in mm in program coordinates.
    """

    node: PathFunction
    start_position: Vector
    contour_start: Vector
    feed: float | None
    compensation_side: str
    radius_mm: float


def plan_approach_path(state: State, entry: ContourEntry, direction: Point) -> Iterator[PathElement]:
    """Yield the approach to a contour that starts in ``direction`` (a unit vector)."""
    offset_start = _offset_point(entry.contour_start, direction, entry.compensation_side, entry.radius_mm)
    made = PathElement(
        entry.start_position,
        entry.start_position,
        entry.feed,
        state.line_number,
        state.text,
        entry.node.column,
    )
    form = entry.node.function_name.removeprefix("APPR ").replace("PL", "L").replace("PC", "C")
    if not entry.node.function_name.startswith("APPR"):
        yield _straight(made, entry.start_position, offset_start)
    elif form in {"LT", "LN"}:
        length = _length(state, entry.node, "LEN")
        back = (
            (-direction[0], -direction[1])
            if form == "LT"
            else _outward_normal(direction, entry.compensation_side)
        )
        before = (offset_start[0] + back[0] * length, offset_start[1] + back[1] * length, offset_start[2])
        yield _straight(made, entry.start_position, before)
        yield _straight(made, before, offset_start)
    else:
        arc = _arc_in(state, entry, direction, offset_start, tangent=form == "LCT")
        yield _straight(made, entry.start_position, (*arc.start, offset_start[2]))
        yield _round(made, arc, offset_start[2], offset_start[2])


def plan_departure_path(
    state: State,
    node: PathFunction,
    contour_end: Vector,
    direction: Point,
    side: str,
    radius: float,
    feed: float | None,
) -> Iterator[PathElement]:
    """Yield the elements of a departure with DEP.

    The contour ends at ``contour_end`` in ``direction``, which is a unit vector.
    """
    start = _offset_point(contour_end, direction, side, radius)
    made = PathElement(start, start, feed, state.line_number, state.text, node.column)
    form = node.function_name.removeprefix("DEP ").replace("PL", "L")
    end = compute_end_point(state, node, contour_end)
    if form in {"LT", "LN"}:
        length = _length(state, node, "LEN")
        on = direction if form == "LT" else _outward_normal(direction, side)
        yield _straight(made, start, (start[0] + on[0] * length, start[1] + on[1] * length, end[2]))
        return
    # A departure is a reversed approach.
    back = ContourEntry(node, end, contour_end, feed, {"L": "R", "R": "L"}.get(side, ""), radius)
    turned = -direction[0], -direction[1]
    arc = _arc_in(state, back, turned, start, tangent=form == "LCT").make_reversed()
    yield _round(made, arc, start[2], start[2])
    if form == "LCT":
        yield _straight(made, (*arc.end, start[2]), end)


def _arc_in(
    state: State, entry: ContourEntry, direction: Point, offset_point: Vector, *, tangent: bool
) -> Arc:
    """Return the approach arc, which ends tangentially at the offset contour.

    Its angle is CCA. If ``tangent`` is True, the start is instead the point where a line from the tool
    position is tangent to the arc.
    """
    size, turn = _radius(state, entry)
    left = get_left_normal(direction)
    centre = offset_point[0] + left[0] * size * turn, offset_point[1] + left[1] * size * turn
    if tangent:
        start = _tangent_point(state, entry, centre, size, clockwise=turn < 0)
    else:
        word = entry.node.find_word("CCA")
        assert word is not None  # guaranteed by the reader
        swept = math.radians(word_values.number(state, word.value, "CCA", _MAX_CCA, 0.0))
        angle = math.atan2(offset_point[1] - centre[1], offset_point[0] - centre[0]) - turn * swept
        start = centre[0] + size * math.cos(angle), centre[1] + size * math.sin(angle)
    return Arc(start, offset_point[:2], centre, clockwise=turn < 0)


def _radius(state: State, entry: ContourEntry) -> tuple[float, float]:
    """Return the radius of the tool-center arc in mm, and the side on which the arc center is.

    The side is 1 for left or -1 for right. With a positive R, the arc is on the side of the tool, and with
    a negative R, on the side of the workpiece. Without compensation, a positive R means left, and a
    negative R means right. Raises ProgramError if R is 0, or if a positive R is not larger than the tool
    radius.
    """
    word = entry.node.find_word("R")
    assert word is not None
    value = word_values.evaluate_coordinate(state, word)
    turn = -1.0 if (entry.compensation_side == "R") != (value < 0.0) else 1.0
    size = value - entry.radius_mm if value > 0.0 else entry.radius_mm - value
    if value == 0.0 or size < SAME_POINT_TOLERANCE_MM:
        raise state.make_error(
            word.column,
            RADIUS_TOO_LARGE,
            "R {value} mm of {form} must be larger than the tool radius of {radius} mm.",
            "Increase R.",
            value=f"{value:.10g}",
            form=entry.node.function_name,
            radius=f"{entry.radius_mm:.10g}",
        )
    return size, turn


def _tangent_point(
    state: State, entry: ContourEntry, center: Point, size: float, *, clockwise: bool
) -> Point:
    """Return the point where a line from the start of the approach is tangent to the approach arc."""
    if math.dist(entry.start_position[:2], center) < size:
        text = "No path is possible for {form} because the tool is inside the arc of this move."
        hint = "Start farther from the contour, or reduce R."
        raise state.make_error(
            entry.node.column, INPUT_VALUE_INCORRECT, text, hint, form=entry.node.function_name
        )
    return find_tangent_point(entry.start_position[:2], center, size, is_clockwise=clockwise)


def _offset_point(point: Vector, direction: Point, side: str, radius: float) -> Vector:
    """Return the tool center that is perpendicular to a contour point, at the distance ``radius``."""
    if not side:
        return point
    left = get_left_normal(direction)
    off = radius if side == "L" else -radius
    return point[0] + left[0] * off, point[1] + left[1] * off, point[2]


def _outward_normal(direction: Point, side: str) -> Point:
    """Return the unit vector perpendicular to the contour on the tool side.

    Without compensation, it points to the left.
    """
    left = get_left_normal(direction)
    return (-left[0], -left[1]) if side == "R" else left


def _length(state: State, node: PathFunction, name: str) -> float:
    word = node.find_word(name)
    assert word is not None  # guaranteed by the reader
    return word_values.number(state, word.value, name, word_values.MAX_COORDINATE, 0.0) * state.mm_per_unit


def _straight(made: PathElement, start: Vector, end: Vector) -> PathElement:
    return replace(made, start=start, end=end, arc=None)


def _round(made: PathElement, arc: Arc, z0: float, z1: float) -> PathElement:
    return replace(made, start=(*arc.start, z0), end=(*arc.end, z1), arc=arc)
