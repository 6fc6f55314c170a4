"""Conversion of path functions to path elements in program coordinates, in mm and degrees.

C, CR, CT, CP and CTP are arcs, or helices if Z also moves. LP and CP are relative to the pole (CC). With a
pole in YZ or ZX, arcs are vertical. They are viewed with Y to the right and Z up, or with Z to the right
and X up.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    Element,
    Line,
    Point,
    find_arc_center,
    make_arc,
)
from core.geometry.rotation_frames import Vector
from core.geometry.working_plane import (
    XY_ORDER,
    YZ_ORDER,
    ZX_ORDER,
    AxisOrder,
    convert_from_plane_order,
    convert_to_plane_order,
)
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State
from core.language.klartext.klartext_faults import (
    ARC_END_INCORRECT,
    DIRECTION_UNDEFINED,
    PATH_FUNCTION_NOT_POSSIBLE,
    POLE_MISSING,
)
from core.language.klartext.klartext_nodes import PathFunction, Pole
from core.language.klartext.klartext_words import AxisWord
from core.message import Message

CIRCLE_TOLERANCE_MM = (
    0.016  # mm; permitted distance of an arc end from the circle through its start, as on the control
)
_PARALLEL = 1e-9
_MAX_TURNS = 1000


@dataclass(frozen=True, slots=True)
class PathElement:
    """A line or arc from ``start`` to ``end``.

    ``feed`` is the programmed feed, or None for a rapid. ``arc`` is in the first two axes of
    ``axis_order``, usually X and Y. ``rotary_targets_deg`` contains the continuous target angles of rotary
    axes. ``line_number`` and ``block_text`` are the line and the text of its block.
    """

    start: Vector
    end: Vector
    feed: float | None
    line_number: int
    block_text: str
    column: int = 1
    arc: Arc | None = None
    rotary_targets_deg: Mapping[str, float] = field(default_factory=dict)
    axis_order: AxisOrder = XY_ORDER

    @property
    def is_vertical_arc(self) -> bool:
        """Return whether the element is a vertical arc in YZ or ZX."""
        return self.arc is not None and self.axis_order != XY_ORDER

    @property
    def planar_element(self) -> Element | None:
        """Return the line or arc of this element in X and Y, or None if it does not exist.

        Vertical arcs and elements without motion in X and Y do not have a planar element.
        """
        if self.is_vertical_arc:
            return None
        if self.arc is not None:
            return self.arc
        start, end = self.start[:2], self.end[:2]
        return Line(start, end) if math.dist(start, end) > SAME_POINT_TOLERANCE_MM else None

    @property
    def end_direction(self) -> Point | None:
        """Return the direction at the end as a unit vector in X and Y, or None without motion in X and Y."""
        flat = self.planar_element
        return None if flat is None else flat.end_direction


def make_elements(
    state: State,
    node: PathFunction,
    start: Vector,
    previous_direction: Point | None,
    feed: float | None,
    rotary: Mapping[str, float],
) -> Iterator[PathElement]:
    """Yield the elements of a path function that begins at ``start``.

    There is one element, or several for an arc of more than one revolution. ``previous_direction`` is the
    direction at the end of the previous element. Raises ProgramError if an element is invalid.
    """
    node = _with_direction(state, node)
    order = state.pole_plane if node.function_name in _POLAR_FORMS else XY_ORDER
    made = PathElement(start, start, feed, state.line_number, state.text, node.column, None, rotary, order)
    if node.function_name == "CP":
        yield from _turns_about_pole(state, node, made)
        return
    end = compute_end_point(state, node, start)
    first, last = convert_to_plane_order(order, start), convert_to_plane_order(order, end)
    arc = (
        _ARCS[node.function_name](state, node, first[:2], last[:2], previous_direction)
        if node.function_name in _ARCS
        else None
    )
    yield replace(made, end=end, arc=arc)


_POLAR_FORMS = {"C", "CP"}


def _with_direction(state: State, node: PathFunction) -> PathFunction:
    """Return the path function with a direction of rotation DR.

    If a C, CR or CP block has no DR, the last programmed DR is used.
    """
    if node.function_name not in {"C", "CR", "CP"}:
        return node
    state.rotation_direction = node.rotation_direction or state.rotation_direction
    return replace(node, rotation_direction=state.rotation_direction)


def find_pole_plane(node: Pole, previous_plane: AxisOrder) -> AxisOrder:
    """Return the plane of the pole, which the axes of CC define.

    If CC names only one axis, and the previous plane contains this axis, the plane remains unchanged.
    """
    named = {word.axis for word in node.axis_words}
    if len(named) < 2:
        return (
            previous_plane
            if named and named <= {"XYZ"[column] for column in previous_plane[:2]}
            else XY_ORDER
        )
    return {"YZ": YZ_ORDER, "XZ": ZX_ORDER}.get("".join(sorted(named)), XY_ORDER)


def compute_end_point(state: State, node: PathFunction, start: Vector) -> Vector:
    """Return the end point of a path function.

    The end point is specified by axis words or by polar coordinates about the pole.
    """
    x, y, z = (_along(state, node.find_word(axis), at) for axis, at in zip("XYZ", start, strict=True))
    if node.find_word("PR") is None and node.find_word("PA") is None:
        return _paraxial(state, node, start, (x, y, z))
    (cx, cy), (radius, angle) = read_pole(state, node), _polar(state, node, start)
    turned, order = math.radians(angle), state.pole_plane
    third = convert_to_plane_order(order, (x, y, z))[2]
    return convert_from_plane_order(
        order, (cx + radius * math.cos(turned), cy + radius * math.sin(turned), third)
    )


def _paraxial(state: State, node: PathFunction, start: Vector, end: Vector) -> Vector:
    """Return the end point of a paraxial move with R+ or R-.

    As in the manual, R+ extends the move along its axis by the tool radius, and R- shortens the move.
    """
    if node.compensation not in {"+", "-"}:
        return end
    more = math.copysign(
        state.tool_radius_mm / state.transformation.scale_factor, 1.0 if node.compensation == "+" else -1.0
    )
    x, y, z = (
        there
        if abs(there - here) < SAME_POINT_TOLERANCE_MM
        else there + math.copysign(1.0, there - here) * more
        for here, there in zip(start, end, strict=True)
    )
    return x, y, z


def read_pole(state: State, node: PathFunction) -> Point:
    """Return the pole of CC. Raises ProgramError if no pole is defined."""
    if state.pole is None:
        text = "No pole is defined with CC."
        raise state.make_error(node.column, POLE_MISSING, text, "Write CC with X and Y before this block.")
    return state.pole


def _along(state: State, word: AxisWord | None, at: float) -> float:
    if word is None:
        return at
    value = word_values.evaluate_coordinate(state, word)
    return at + value if word.is_incremental else value


def _polar(state: State, node: PathFunction, start: Vector) -> tuple[float, float]:
    """Return the polar radius (mm) and angle (degrees from X toward Y) of the end point.

    Values that are not programmed remain unchanged.
    """
    cx, cy = read_pole(state, node)
    x, y, _ = convert_to_plane_order(state.pole_plane, start)
    radius, angle = math.hypot(x - cx, y - cy), math.degrees(math.atan2(y - cy, x - cx))
    if (word := node.find_word("PR")) is not None:
        value = word_values.evaluate_coordinate(state, word)
        radius = radius + value if word.is_incremental else value
    if (word := node.find_word("PA")) is not None:
        value = word_values.number(state, word.value, "PA", word_values.MAX_COORDINATE)
        angle = angle + value if word.is_incremental else value
    return radius, angle


# --- arcs


def _arc_about_pole(state: State, node: PathFunction, start: Point, end: Point, _: Point | None) -> Arc:
    """Return the arc of C about the pole.

    Raises ProgramError if no pole or no direction DR is defined, if the start point is on the pole, or if
    the end point is not on the circle.
    """
    centre = read_pole(state, node)
    _demand_radius(state, node, math.dist(start, centre))
    _demand_on_circle(state, node, math.dist(start, centre), math.dist(end, centre))
    return (
        make_arc(start, end, centre, is_clockwise=node.rotation_direction == "-")
        if node.rotation_direction
        else _no_turn(state, node)
    )


def _arc_by_radius(state: State, node: PathFunction, start: Point, end: Point, _: Point | None) -> Arc:
    """Return the arc of CR.

    A positive radius selects the shorter arc, and a negative radius selects the longer arc.
    """
    word = node.find_word("R")
    assert word is not None  # guaranteed by the reader
    radius = word_values.evaluate_coordinate(state, word)
    chord = math.dist(start, end)
    if chord < SAME_POINT_TOLERANCE_MM or chord / 2.0 > abs(radius) + CIRCLE_TOLERANCE_MM:
        text = Message(
            "An arc with R {radius} mm cannot connect two points {chord} mm apart.",
            radius=f"{abs(radius):.10g}",
            chord=f"{chord:.10g}",
        )
        hint = (
            "Program a full circle as two arcs or with path function C."
            if chord < SAME_POINT_TOLERANCE_MM
            else "Correct R or the end point."
        )
        raise state.make_error(word.column, ARC_END_INCORRECT, text, hint)
    if not node.rotation_direction:
        return _no_turn(state, node)
    clockwise = node.rotation_direction == "-"
    centre = find_arc_center(start, end, abs(radius), is_clockwise=clockwise == (radius > 0.0))
    return Arc(start, end, centre, clockwise)


def _tangential(
    state: State, node: PathFunction, start: Point, end: Point, previous_direction: Point | None
) -> Arc | None:
    """Return the arc of CT or CTP, which is tangent to the previous element.

    Returns None if the path is a straight line. Raises ProgramError if no move precedes the arc, or if the
    path would have to reverse its direction.
    """
    if previous_direction is None:
        text = "No move precedes {form}, so its starting direction is not defined."
        raise state.make_error(
            node.column,
            PATH_FUNCTION_NOT_POSSIBLE,
            text,
            "Program a move before this block.",
            form=node.function_name,
        )
    dx, dy = end[0] - start[0], end[1] - start[1]
    aside = (
        -previous_direction[1] * dx + previous_direction[0] * dy
    )  # distance of the end to the left of the path
    if abs(aside) < _PARALLEL * max(1.0, math.hypot(dx, dy)):
        if previous_direction[0] * dx + previous_direction[1] * dy <= 0.0:
            text = "{form} would have to reverse its direction to reach its end point."
            raise state.make_error(
                node.column, ARC_END_INCORRECT, text, "Correct the end point.", form=node.function_name
            )
        return None
    radius = (dx * dx + dy * dy) / (2.0 * aside)  # positive with the center on the left
    centre = start[0] - previous_direction[1] * radius, start[1] + previous_direction[0] * radius
    return Arc(start, end, centre, clockwise=radius < 0.0)


_ARCS = {"C": _arc_about_pole, "CR": _arc_by_radius, "CT": _tangential, "CTP": _tangential}


def _turns_about_pole(state: State, node: PathFunction, made: PathElement) -> Iterator[PathElement]:
    """Yield the elements of CP, an arc of any angle about the pole, or a helix if Z also moves."""
    order, centre = made.axis_order, read_pole(state, node)
    start = convert_to_plane_order(order, made.start)
    radius = math.dist(start[:2], centre)
    _demand_radius(state, node, radius)
    if not node.rotation_direction:
        _no_turn(state, node)
    first = math.degrees(math.atan2(start[1] - centre[1], start[0] - centre[0]))
    sweep = _sweep(state, node, first)
    turns = math.ceil(abs(sweep) / 360.0 - 1e-9)
    if turns > _MAX_TURNS:
        text = "CP makes {revolutions} revolutions, which is too many."
        hint = "Program at most {most_turns} revolutions."
        raise state.make_error(
            node.column, ARC_END_INCORRECT, text, hint, revolutions=turns, most_turns=_MAX_TURNS
        )
    z1 = _along(state, node.find_word("XYZ"[order[2]]), start[2])
    here = start
    for turn in range(1, turns + 1):
        done = min(turn * 360.0 / abs(sweep), 1.0)
        angle = math.radians(first + sweep * done)
        point = centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)
        whole = turn * 360.0 <= abs(sweep) + 1e-9
        end = (*(here[:2] if whole else point), start[2] + (z1 - start[2]) * done)
        arc = Arc(here[:2], end[:2], centre, node.rotation_direction == "-")
        yield replace(
            made,
            start=convert_from_plane_order(order, here),
            end=convert_from_plane_order(order, end),
            arc=arc,
        )
        here = end


def _sweep(state: State, node: PathFunction, first: float) -> float:
    """Return the angle of CP in degrees, which is positive for counterclockwise rotation.

    Raises ProgramError if IPA is 0, or if IPA and DR conflict.
    """
    word = node.find_word("PA")
    if word is None:
        return 360.0 if node.rotation_direction == "+" else -360.0
    value = word_values.number(state, word.value, "PA", word_values.MAX_COORDINATE)
    if not word.is_incremental:
        turned = (value - first) % 360.0
        turned = 0.0 if 360.0 - turned < 1e-9 else turned
        return (turned or 360.0) if node.rotation_direction == "+" else turned - 360.0
    if value == 0.0 or (value > 0.0) != (node.rotation_direction == "+"):
        text = (
            Message(
                "IPA{value} and DR{turn} have opposite directions.",
                value=f"{value:+g}",
                turn=node.rotation_direction,
            )
            if value
            else ("IPA+0 does not produce any motion.")
        )
        raise state.make_error(word.column, DIRECTION_UNDEFINED, text, "Use the same sign for IPA and DR.")
    return value


def _demand_radius(state: State, node: PathFunction, radius: float) -> None:
    if radius < SAME_POINT_TOLERANCE_MM:
        text = "The tool is on the pole, so no circle is possible."
        raise state.make_error(
            node.column, ARC_END_INCORRECT, text, "Move to a point on the circle before this block."
        )


def _demand_on_circle(state: State, node: PathFunction, first: float, last: float) -> None:
    if abs(first - last) > CIRCLE_TOLERANCE_MM:
        text = "The end point is {last} mm from the pole, but the start point is {first} mm from the pole."
        hint = "Correct the end point or CC."
        raise state.make_error(
            node.column, ARC_END_INCORRECT, text, hint, last=f"{last:.10g}", first=f"{first:.10g}"
        )


def _no_turn(state: State, node: PathFunction) -> Arc:
    text = "{form} needs DR+ or DR-."
    raise state.make_error(
        node.column, DIRECTION_UNDEFINED, text, "Write DR+ for counterclockwise.", form=node.function_name
    )
