"""What a path function comes to: one element of the path, in the coordinates of the program.

C, CR, CT, CP and CTP become arcs, with Z helices; LP and CP count from the pole (CC). mm and degrees. A pole
in Y and Z, or in Z and X, makes them upright: seen with Y to the right and Z up; Z to the right and X up.
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

ON_CIRCLE = 0.016  # mm by which the end of an arc may miss the circle through its start: the control's own
_PARALLEL = 1e-9
_MOST_TURNS = 1000


@dataclass(frozen=True, slots=True)
class PathElement:
    """From ``start`` to ``end``, straight or on ``arc``; ``feed`` as programmed, None rapid.

    The arc lies in the first two axes of ``order``, mostly in X and Y.
    ``rotary`` are the goals of rotary axes, counted on. ``line`` and ``text`` are those of its block.
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
        """Whether it is an arc in Y and Z, or in Z and X."""
        return self.arc is not None and self.order != XY

    @property
    def flat(self) -> Element | None:
        """What it is in X and Y; None where nothing moves there, and of an upright arc."""
        if self.upright:
            return None
        if self.arc is not None:
            return self.arc
        start, end = self.start[:2], self.end[:2]
        return Line(start, end) if math.dist(start, end) > SAME_POINT else None

    @property
    def end_direction(self) -> Point | None:
        """Unit vector in X and Y at its end; None where nothing moves there."""
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
    """The element of a path function that begins at ``start``; several where it goes round more than once.

    ``before`` is the direction in which the path has come there. Raises ProgramError.
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
    """C, CR and CP without DR turn as the arc before did."""
    if node.form not in {"C", "CR", "CP"}:
        return node
    state.turn = node.turn or state.turn
    return replace(node, turn=state.turn)


def pole_plane(node: Pole, before: Order) -> Order:
    """The plane that the axes of CC lie in; one that names a single axis stays in the plane before."""
    named = {word.axis for word in node.axes}
    if len(named) < 2:
        return before if named and named <= {"XYZ"[column] for column in before[:2]} else XY
    return {"YZ": YZ, "XZ": ZX}.get("".join(sorted(named)), XY)


def goal(state: State, node: Move, start: Vector) -> Vector:
    """The end point of a path function: its axes, or radius and angle about the pole."""
    x, y, z = (_along(state, node.word(axis), at) for axis, at in zip("XYZ", start, strict=True))
    if node.word("PR") is None and node.word("PA") is None:
        return _paraxial(state, node, start, (x, y, z))
    (cx, cy), (radius, angle) = pole(state, node), _polar(state, node, start)
    turned, order = math.radians(angle), state.pole_plane
    third = seen(order, (x, y, z))[2]
    return unseen(order, (cx + radius * math.cos(turned), cy + radius * math.sin(turned), third))


def _paraxial(state: State, node: Move, start: Vector, end: Vector) -> Vector:
    """R+ makes the way along its one axis longer by the tool's radius, R- shorter (manual)."""
    if node.compensation not in {"+", "-"}:
        return end
    more = math.copysign(state.tool_radius / state.figure.factor, 1.0 if node.compensation == "+" else -1.0)
    x, y, z = (
        there if abs(there - here) < SAME_POINT else there + math.copysign(1.0, there - here) * more
        for here, there in zip(start, end, strict=True)
    )
    return x, y, z


def pole(state: State, node: Move) -> Point:
    """The pole of CC. Raises ProgramError where none was programmed."""
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
    """Radius (mm) and angle (degrees, from X towards Y) of the end; what is not programmed stays."""
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
    """C: about the pole; the end has to lie on the circle."""
    centre = pole(state, node)
    _demand_radius(state, node, math.dist(start, centre))
    _demand_on_circle(state, node, math.dist(start, centre), math.dist(end, centre))
    return arc_between(start, end, centre, clockwise=node.turn == "-") if node.turn else _no_turn(state, node)


def _by_radius(state: State, node: Move, start: Point, end: Point, _: Point | None) -> Arc:
    """CR: a positive radius is the shorter arc, a negative one the longer."""
    word = node.word("R")
    assert word is not None  # the block was refused without it
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
    """CT and CTP: goes on in the direction of the element before; straight on it is a line."""
    if before is None:
        text = "No move precedes {form}, so its starting direction is not defined."
        raise state.refuse(node.column, PREVIOUS, text, "Program a move before this block.", form=node.form)
    dx, dy = end[0] - start[0], end[1] - start[1]
    aside = -before[1] * dx + before[0] * dy  # of the end to the left of the way
    if abs(aside) < _PARALLEL * max(1.0, math.hypot(dx, dy)):
        if before[0] * dx + before[1] * dy <= 0.0:
            text = "{form} would have to reverse its direction to reach its end point."
            raise state.refuse(node.column, ARC_END, text, "Correct the end point.", form=node.form)
        return None
    radius = (dx * dx + dy * dy) / (2.0 * aside)  # positive where the centre is on the left
    centre = start[0] - before[1] * radius, start[1] + before[0] * radius
    return Arc(start, end, centre, clockwise=radius < 0.0)


_ARCS = {"C": _about_pole, "CR": _by_radius, "CT": _tangential, "CTP": _tangential}


def _round_the_pole(state: State, node: Move, made: PathElement) -> Iterator[PathElement]:
    """CP: an angle about the pole, of any number of turns, with the third axis a helix."""
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
    """Signed degrees of CP, counter-clockwise positive. Raises ProgramError where IPA and DR disagree."""
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
