"""Conversion of path functions to path elements in program coordinates, in mm and degrees.

C, CR, CT, CP and CTP are arcs, with Z helices; LP and CP are relative to the pole (CC). With a pole in YZ or
ZX, arcs are vertical, in the view with Y to the right and Z up, or Z to the right and X up.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from core.geometry.lines_and_arcs import (
    SAME_POINT,
    Arc,
    Element,
    Line,
    Point,
    arc_between,
    centre_from_radius,
)
from core.geometry.rotation_frames import Vector
from core.geometry.working_plane import XY, YZ, ZX, Order, seen, unseen
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State
from core.language.klartext.klartext_faults import ARC_END, DIRECTION, NO_POLE, PREVIOUS
from core.language.klartext.klartext_nodes import AxisWord, Move, Pole
from core.message import Message

ON_CIRCLE = 0.016  # mm; permitted distance of an arc end from the circle through its start, as on the control
_PARALLEL = 1e-9
_MOST_TURNS = 1000


@dataclass(frozen=True, slots=True)
class PathElement:
    """A line or ``arc`` from ``start`` to ``end``; ``feed`` is as programmed, None for a rapid.

    The arc is in the first two axes of ``order``, usually X and Y. ``rotary`` are the continuous targets of
    rotary axes. ``line`` and ``text`` are those of its block.
    """

    start: Vector
    end: Vector
    feed: float | None
    line: int
    text: str
    column: int = 1
    arc: Arc | None = None
    rotary: Mapping[str, float] = field(default_factory=dict)
    order: Order = XY

    @property
    def upright(self) -> bool:
        """Whether the element is a vertical arc, in YZ or ZX."""
        return self.arc is not None and self.order != XY

    @property
    def flat(self) -> Element | None:
        """The element in X and Y; None without motion in X and Y, and for a vertical arc."""
        if self.upright:
            return None
        if self.arc is not None:
            return self.arc
        start, end = self.start[:2], self.end[:2]
        return Line(start, end) if math.dist(start, end) > SAME_POINT else None

    @property
    def end_direction(self) -> Point | None:
        """Unit vector in X and Y at the end; None without motion in X and Y."""
        flat = self.flat
        return None if flat is None else flat.end_direction


def elements(
    state: State,
    node: Move,
    start: Vector,
    before: Point | None,
    feed: float | None,
    rotary: Mapping[str, float],
) -> Iterator[PathElement]:
    """Yield the element of a path function from ``start``, or several for more than one revolution.

    ``before`` is the direction at the end of the previous path. Raises ProgramError if the element is
    invalid.
    """
    node = _with_direction(state, node)
    order = state.pole_plane if node.form in _ABOUT_POLE else XY
    made = PathElement(start, start, feed, state.line, state.text, node.column, None, rotary, order)
    if node.form == "CP":
        yield from _round_the_pole(state, node, made)
        return
    end = goal(state, node, start)
    first, last = seen(order, start), seen(order, end)
    arc = _ARCS[node.form](state, node, first[:2], last[:2], before) if node.form in _ARCS else None
    yield replace(made, end=end, arc=arc)


_ABOUT_POLE = {"C", "CP"}


def _with_direction(state: State, node: Move) -> Move:
    """Return the path function with the last DR if C, CR or CP has none."""
    if node.form not in {"C", "CR", "CP"}:
        return node
    state.turn = node.turn or state.turn
    return replace(node, turn=state.turn)


def pole_plane(node: Pole, before: Order) -> Order:
    """Return the plane of the axes of CC; with a single axis, the plane may remain unchanged."""
    named = {word.axis for word in node.axes}
    if len(named) < 2:
        return before if named and named <= {"XYZ"[column] for column in before[:2]} else XY
    return {"YZ": YZ, "XZ": ZX}.get("".join(sorted(named)), XY)


def goal(state: State, node: Move, start: Vector) -> Vector:
    """Return the end point of a path function, from its axes or from radius and angle about the pole."""
    x, y, z = (_along(state, node.word(axis), at) for axis, at in zip("XYZ", start, strict=True))
    if node.word("PR") is None and node.word("PA") is None:
        return _paraxial(state, node, start, (x, y, z))
    (cx, cy), (radius, angle) = pole(state, node), _polar(state, node, start)
    turned, order = math.radians(angle), state.pole_plane
    third = seen(order, (x, y, z))[2]
    return unseen(order, (cx + radius * math.cos(turned), cy + radius * math.sin(turned), third))


def _paraxial(state: State, node: Move, start: Vector, end: Vector) -> Vector:
    """Return the end point of a paraxial move with R+ or R-.

    R+ extends the move along its axis by the tool radius, and R- shortens it, as in the manual.
    """
    if node.compensation not in {"+", "-"}:
        return end
    more = math.copysign(state.tool_radius / state.figure.factor, 1.0 if node.compensation == "+" else -1.0)
    x, y, z = (
        there if abs(there - here) < SAME_POINT else there + math.copysign(1.0, there - here) * more
        for here, there in zip(start, end, strict=True)
    )
    return x, y, z


def pole(state: State, node: Move) -> Point:
    """Return the pole of CC. Raises ProgramError if no pole is defined."""
    if state.pole is None:
        text = "No pole is defined with CC."
        raise state.refuse(node.column, NO_POLE, text, "Write CC with X and Y before this block.")
    return state.pole


def _along(state: State, word: AxisWord | None, at: float) -> float:
    if word is None:
        return at
    value = word_values.coordinate(state, word)
    return at + value if word.incremental else value


def _polar(state: State, node: Move, start: Vector) -> tuple[float, float]:
    """Return radius (mm) and angle (degrees from X toward Y) of the end; missing values are unchanged."""
    cx, cy = pole(state, node)
    x, y, _ = seen(state.pole_plane, start)
    radius, angle = math.hypot(x - cx, y - cy), math.degrees(math.atan2(y - cy, x - cx))
    if (word := node.word("PR")) is not None:
        value = word_values.coordinate(state, word)
        radius = radius + value if word.incremental else value
    if (word := node.word("PA")) is not None:
        value = word_values.number(state, word.value, "PA", word_values.MOST_COORDINATE)
        angle = angle + value if word.incremental else value
    return radius, angle


# --- arcs


def _about_pole(state: State, node: Move, start: Point, end: Point, _: Point | None) -> Arc:
    """Return the arc of C about the pole. Raises ProgramError if the end is not on the circle."""
    centre = pole(state, node)
    _demand_radius(state, node, math.dist(start, centre))
    _demand_on_circle(state, node, math.dist(start, centre), math.dist(end, centre))
    return arc_between(start, end, centre, clockwise=node.turn == "-") if node.turn else _no_turn(state, node)


def _by_radius(state: State, node: Move, start: Point, end: Point, _: Point | None) -> Arc:
    """Return the arc of CR: a positive radius is the shorter arc, a negative radius the longer one."""
    word = node.word("R")
    assert word is not None  # guaranteed by the reader
    radius = word_values.coordinate(state, word)
    chord = math.dist(start, end)
    if chord < SAME_POINT or chord / 2.0 > abs(radius) + ON_CIRCLE:
        text = Message(
            "An arc with R {radius} mm cannot connect two points {chord} mm apart.",
            radius=f"{abs(radius):.10g}",
            chord=f"{chord:.10g}",
        )
        hint = (
            "Program a full circle as two arcs or with path function C."
            if chord < SAME_POINT
            else "Correct R or the end point."
        )
        raise state.refuse(word.column, ARC_END, text, hint)
    if not node.turn:
        return _no_turn(state, node)
    clockwise = node.turn == "-"
    centre = centre_from_radius(start, end, abs(radius), clockwise=clockwise == (radius > 0.0))
    return Arc(start, end, centre, clockwise)


def _tangential(state: State, node: Move, start: Point, end: Point, before: Point | None) -> Arc | None:
    """Return the arc of CT or CTP, tangent to the previous element; None for a straight line."""
    if before is None:
        text = "No move precedes {form}, so its starting direction is not defined."
        raise state.refuse(node.column, PREVIOUS, text, "Program a move before this block.", form=node.form)
    dx, dy = end[0] - start[0], end[1] - start[1]
    aside = -before[1] * dx + before[0] * dy  # distance of the end to the left of the path
    if abs(aside) < _PARALLEL * max(1.0, math.hypot(dx, dy)):
        if before[0] * dx + before[1] * dy <= 0.0:
            text = "{form} would have to reverse its direction to reach its end point."
            raise state.refuse(node.column, ARC_END, text, "Correct the end point.", form=node.form)
        return None
    radius = (dx * dx + dy * dy) / (2.0 * aside)  # positive with the center on the left
    centre = start[0] - before[1] * radius, start[1] + before[0] * radius
    return Arc(start, end, centre, clockwise=radius < 0.0)


_ARCS = {"C": _about_pole, "CR": _by_radius, "CT": _tangential, "CTP": _tangential}


def _round_the_pole(state: State, node: Move, made: PathElement) -> Iterator[PathElement]:
    """Yield the elements of CP: an angle about the pole of any number of revolutions, with a helix."""
    order, centre = made.order, pole(state, node)
    start = seen(order, made.start)
    radius = math.dist(start[:2], centre)
    _demand_radius(state, node, radius)
    if not node.turn:
        _no_turn(state, node)
    first = math.degrees(math.atan2(start[1] - centre[1], start[0] - centre[0]))
    sweep = _sweep(state, node, first)
    turns = math.ceil(abs(sweep) / 360.0 - 1e-9)
    if turns > _MOST_TURNS:
        text = "CP makes {revolutions} revolutions, which is too many."
        hint = "Program at most {most_turns} revolutions."
        raise state.refuse(node.column, ARC_END, text, hint, revolutions=turns, most_turns=_MOST_TURNS)
    z1 = _along(state, node.word("XYZ"[order[2]]), start[2])
    here = start
    for turn in range(1, turns + 1):
        done = min(turn * 360.0 / abs(sweep), 1.0)
        angle = math.radians(first + sweep * done)
        point = centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)
        whole = turn * 360.0 <= abs(sweep) + 1e-9
        end = (*(here[:2] if whole else point), start[2] + (z1 - start[2]) * done)
        arc = Arc(here[:2], end[:2], centre, node.turn == "-")
        yield replace(made, start=unseen(order, here), end=unseen(order, end), arc=arc)
        here = end


def _sweep(state: State, node: Move, first: float) -> float:
    """Return the angle of CP in degrees, positive counterclockwise.

    Raises ProgramError if IPA and DR conflict.
    """
    word = node.word("PA")
    if word is None:
        return 360.0 if node.turn == "+" else -360.0
    value = word_values.number(state, word.value, "PA", word_values.MOST_COORDINATE)
    if not word.incremental:
        turned = (value - first) % 360.0
        turned = 0.0 if 360.0 - turned < 1e-9 else turned
        return (turned or 360.0) if node.turn == "+" else turned - 360.0
    if value == 0.0 or (value > 0.0) != (node.turn == "+"):
        text = (
            Message("IPA{value} and DR{turn} have opposite directions.", value=f"{value:+g}", turn=node.turn)
            if value
            else ("IPA+0 does not produce any motion.")
        )
        raise state.refuse(word.column, DIRECTION, text, "Use the same sign for IPA and DR.")
    return value


def _demand_radius(state: State, node: Move, radius: float) -> None:
    if radius < SAME_POINT:
        text = "The tool is on the pole, so no circle is possible."
        raise state.refuse(node.column, ARC_END, text, "Move to a point on the circle before this block.")


def _demand_on_circle(state: State, node: Move, first: float, last: float) -> None:
    if abs(first - last) > ON_CIRCLE:
        text = "The end point is {last} mm from the pole, but the start point is {first} mm from the pole."
        hint = "Correct the end point or CC."
        raise state.refuse(node.column, ARC_END, text, hint, last=f"{last:.10g}", first=f"{first:.10g}")


def _no_turn(state: State, node: Move) -> Arc:
    text = "{form} needs DR+ or DR-."
    raise state.refuse(node.column, DIRECTION, text, "Write DR+ for counterclockwise.", form=node.form)
