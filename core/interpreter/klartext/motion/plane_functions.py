"""Tilted planes with PLANE, and tool center point control with M128 and FUNCTION TCPM."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

from core.geometry.rotary_axes import PivotMove
from core.geometry.rotation_frames import (
    IDENTITY,
    X_AXIS,
    Y_AXIS,
    Z_AXIS,
    Matrix,
    NoFrameError,
    Vector,
    applied,
    from_euler,
    from_points,
    from_projections,
    from_spatial,
    from_vectors,
    minus,
    plus,
    product,
    scaled,
    transposed,
    turned,
)
from core.geometry.swivel_angles import SolutionSide, choose, fitting
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import (
    ORIGIN,
    Q_TARGETS,
    ROTARY,
    SAME_POINT,
    SLIDES,
    State,
    WorkingPlane,
)
from core.interpreter.klartext.motion.path_elements import PathElement
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.diagnostics import Diagnostic, Severity
from core.language.klartext.klartext_faults import (
    ANGLE,
    INPUT_VALUE,
    M128_ON,
    PLANE_WRONG,
    TOOL_AXIS_MISSING,
    WRONG_AXIS,
)
from core.language.klartext.klartext_nodes import AxisWord, Plane, Retract
from core.message import Message

# --- frame and angles of a PLANE block, without motion


_ABOUT = {"SPA": X_AXIS, "SPB": Y_AXIS, "SPC": Z_AXIS}


def working_plane(state: State, node: Plane) -> WorkingPlane:
    """Return the plane of a block. Raises ProgramError if it is not defined or cannot be reached."""
    if node.form == "AXIAL":
        return _axial(state, node)
    frame = product(_base(state, node), _as_figured(state, node, _FORMS[node.form](state, node)))
    side = SolutionSide(node.positioning.side) if node.positioning.side else None
    table_rot = node.positioning.rotation == "TABLE ROT"
    found = choose(state.kinematics, frame, state.rotary, side, table_rot=table_rot)
    if found is None:
        asked = Message(" when {side} is programmed", side=side) if side else ""
        text = "The rotary axes cannot reach this plane within their ranges{requested}."
        raise state.refuse(node.column, ANGLE, text, "Check the points, angles and SYM.", requested=asked)
    if side is None and not state.table_known:
        _tell_of_two_ways(state, node, frame)
    return WorkingPlane(frame, found.angles, state.line)


def _tell_of_two_ways(state: State, node: Plane, frame: Matrix) -> None:
    """Note that the swivel direction depends on the start position of the table.

    The proof does not know this position.
    """
    if len(fitting(state.kinematics, frame, state.rotary)) > 1:
        text = (
            "There are two possible swivel directions; the start position of the table "
            "determines which direction is used."
        )
        hint = "Write SYM+ or SYM-, or position the table before this block."
        state.log.add(Diagnostic(state.line, node.column, Severity.NOTE, "two-ways", text, hint))


def _axial(state: State, node: Plane) -> WorkingPlane:
    """Return the plane of PLANE AXIAL: absolute or incremental axis angles, without the basic rotation."""
    angles = state.targets
    for word in node.words:
        axis = state.kinematics.rotary(word.axis)
        if axis is None:
            text = "This machine has no rotary axis {axis}."
            hint = "Remove the word, or select a machine with axis {axis}."
            raise state.refuse(word.column, WRONG_AXIS, text, hint, axis=word.axis)
        value = word_values.number(state, word.value, word.axis, word_values.MOST_ANGLE)
        zero = state.kinematics.zero[axis.name]
        angle = angles[axis.name] + value if word.incremental else value + zero
        if not axis.inside(angle):
            ends = Message("{low} and {high}", low=f"{axis.low - zero:g}", high=f"{axis.high - zero:g}")
            text = "{axis} {angle} is not between {ends}."
            hint = "Correct the angle."
            raise state.refuse(
                word.column, ANGLE, text, hint, axis=axis.name, angle=f"{angle - zero:+.7g}", ends=ends
            )
        angles[axis.name] = axis.displayed(angle)
    return WorkingPlane(state.kinematics.frame(angles), angles, state.line)


def _points(state: State, node: Plane) -> Matrix:
    x1, y1, z1, x2, y2, z2, x3, y3, z3 = (number * state.scale for number in _lengths(state, node))
    return _made(state, node, lambda: from_points((x1, y1, z1), (x2, y2, z2), (x3, y3, z3)))


def _vector(state: State, node: Plane) -> Matrix:
    bx, by, bz, nx, ny, nz = _lengths(state, node)
    return _made(state, node, lambda: from_vectors((bx, by, bz), (nx, ny, nz)))


def _lengths(state: State, node: Plane) -> list[float]:
    most = word_values.MOST_POINT
    return [word_values.number(state, word.value, word.axis, most) for word in node.words]


def _made(state: State, node: Plane, frame: Callable[[], Matrix]) -> Matrix:
    try:
        return frame()
    except NoFrameError as problem:
        text = "Correct the points, vectors or angles."
        raise state.refuse(
            node.column, PLANE_WRONG, "{what}.", text, what=str(problem).capitalize()
        ) from problem


def _projected(state: State, node: Plane) -> Matrix:
    first, second, rotation = (_angle(state, word) for word in node.words)
    return _made(state, node, lambda: from_projections(first, second, rotation))


def _euler(state: State, node: Plane) -> Matrix:
    precession, nutation, rotation = (_angle(state, word) for word in node.words)
    return from_euler(precession, nutation, rotation)


def _spatial(state: State, node: Plane) -> Matrix:
    a, b, c = (_angle(state, word) for word in node.words)
    return from_spatial(a, b, c)


def _relative(state: State, node: Plane) -> Matrix:
    """Return the rotation of PLANE RELATIV about an axis of the active plane, or of the workpiece system."""
    (word,) = node.words
    return turned(_ABOUT[word.axis], _angle(state, word))


def _base(state: State, node: Plane) -> Matrix:
    """Return the reference frame of the block: the basic rotation, or for RELATIV the active plane."""
    relative = node.form == "RELATIV" and state.plane is not None
    return state.plane.frame if relative and state.plane is not None else state.kinematics.basic


def _as_figured(state: State, node: Plane, frame: Matrix) -> Matrix:
    """Return the frame in a system changed by TRANS MIRROR, ROTATION and SCALE: T F T⁻¹.

    The program in the plane is also transformed by T, so that p = T F q, the mirrored or rotated image of the
    original plane. PLANE AXIAL specifies axis angles and is not changed.
    """
    figure = state.figure
    if figure.plain:
        return frame
    text = "MIRROR, ROTATION or SCALE is active and also applies to PLANE {form}."
    hint = "Check the axis angles, write PLANE before MIRROR, ROTATION and SCALE, or use PLANE AXIAL."
    state.log.warn(state.line, node.column, "plane-figure", text, hint, form=node.form)
    columns = [figure.plane(applied(frame, figure.program(unit))) for unit in IDENTITY]
    return transposed((columns[0], columns[1], columns[2]))


_FORMS = {
    "POINTS": _points,
    "SPATIAL": _spatial,
    "RELATIV": _relative,
    "EULER": _euler,
    "VECTOR": _vector,
    "PROJECTED": _projected,
}


def _angle(state: State, word: AxisWord) -> float:
    return word_values.number(state, word.value, word.axis, word_values.MOST_SPATIAL)


SHORT_OF_LIMIT = 0.001  # mm; distance of MB MAX from the software limit


def plane(state: State, node: Plane) -> Iterator[Block]:
    """Yield the blocks of PLANE: the retract, if any, and a block of kind ``plane``.

    Raises ProgramError before any change.
    """
    _demand_possible(state, node)
    made = None if node.form == "RESET" else working_plane(state, node)
    if made is not None and made.frame != state.kinematics.basic:
        _demand_tool_axis(state, node)
    targets = state.kinematics.zero if made is None else made.targets
    way = node.positioning.way or "STAY"
    feed = word_values.feed_word(state, node.positioning.feed, node.column) if way != "STAY" else None
    up = retract_way(state, node.positioning.retract)
    distance = word_values.length(state, node.positioning.distance, "DIST")
    _warn_of_shift(state, made)
    for q, name in zip(Q_TARGETS, ROTARY, strict=True):
        axis = state.kinematics.rotary(name)
        state.q[q] = 0.0 if axis is None else state.kinematics.shown(axis, targets[name])
    if up > SAME_POINT:
        yield retract(state, up, feed)
    pivot = _pivot(state, distance) if way == "MOVE" else None
    goal = state.rotary if way == "STAY" else _goal(state, targets)
    state.table_known = state.table_known or way != "STAY"
    state.set_plane(made)
    yield _swivel(state, goal, feed, pivot, distance)


def retract(state: State, up: float, feed: float | None) -> Block:
    """Return a retract from the workpiece along the tool; ``feed`` is as programmed, None for a rapid."""
    goal = dict(zip(SLIDES, _raised(state, up), strict=True))
    rate = None if feed is None else state.path_feed(feed)
    return state.move(Kind.RAPID if rate is None else Kind.FEED, goal, rate)


def retract_way(state: State, asked: Retract | None) -> float:
    """Return the length of MB in mm, or 0 without it; MB MAX ends just before the first software limit."""
    if asked is None:
        return 0.0
    if asked.distance is not None:
        return word_values.length(state, asked.distance, "MB")
    ways = []
    for slide, at, share in zip(
        state.kinematics.slides, state.slides, state.kinematics.tool_axis(state.rotary), strict=True
    ):
        if abs(share) > SAME_POINT:
            ways.append(((slide.high if share > 0.0 else slide.low) - at) / share)
    up = min(ways, default=math.inf)
    text = "MB MAX needs a software limit, but this machine does not have one along the tool axis."
    state.check(not math.isinf(up), asked.column, INPUT_VALUE, text, "Write MB with a length.")
    return max(up - SHORT_OF_LIMIT, 0.0)


def _demand_possible(state: State, node: Plane) -> None:
    text = "M128 is active."
    state.check(not state.m128, node.column, M128_ON, text, "Switch M128 off with M129 before this block.")


def _demand_tool_axis(state: State, node: Plane) -> None:
    """Raise ProgramError if a tilted plane has no tool axis; a plane that is not tilted needs none."""
    if not state.tool_axis:
        text = "No TOOL CALL has defined a tool axis."
        raise state.refuse(node.column, TOOL_AXIS_MISSING, text, "Write TOOL CALL n Z before this block.")


def _raised(state: State, up: float) -> Vector:
    return minus(state.slides, scaled(state.kinematics.tool_axis(state.rotary), -up))


def _pivot(state: State, distance: float) -> Vector:
    """Return the pivot point of MOVE in the machine-parallel system at the workpiece zero."""
    place = state.kinematics.place(state.rotary, tool_length=state.tool_length)
    return place.point(_raised(state, -distance))


def _goal(state: State, targets: Mapping[str, float]) -> dict[str, float]:
    return {
        axis.name: state.at[axis.name] + axis.travel(state.at[axis.name], targets[axis.name])
        for axis in state.kinematics.rotaries
    }


def _swivel(
    state: State, goal: Mapping[str, float], feed: float | None, pivot: Vector | None, distance: float
) -> Block:
    """Return the block of kind ``plane``: only rotary axes, or with linear axes that hold the pivot point."""
    rate = None if feed is None else feed / 60.0
    start = state.rotary
    turn = math.hypot(*(goal[name] - at for name, at in start.items()))
    if pivot is None or turn <= SAME_POINT:
        return state.move(Kind.PLANE, goal, rate)
    way = PivotMove(state.kinematics, start, goal, pivot, distance, state.tool_length, turn)
    return state.move(Kind.PLANE, way.goals(), rate, way)


def _warn_of_shift(state: State, made: WorkingPlane | None) -> None:
    """Warn of a datum shift in a tilted system that another PLANE follows, which is a common mistake."""
    if made is None or state.plane is None or state.shift == ORIGIN:
        return
    text = "The datum was shifted in the tilted coordinate system that is defined on line {line}."
    hint = (
        "If the shift is meant for the workpiece coordinate system, write PLANE RESET STAY before TRANS "
        "DATUM."
    )
    state.log.warn(state.line, 0, "datum-in-plane", text, hint, line=state.plane.line)


def switch(state: State, *, on: bool) -> None:
    """Turn tool center point control on or off."""
    state.m128 = on
    state.derive()


def swivelled(state: State, element: PathElement) -> Block:
    """Return a straight move of the tip on the workpiece with a proportional move of the rotary axes.

    The feed is in mm of the tip path, or in degrees if the tip does not move.
    """
    first, last = (_parallel(state, state.figure.plane(at)) for at in (element.start, element.end))
    start = state.rotary
    end = start | dict(element.rotary)
    way = math.dist(first, last)
    turn = math.hypot(*(end[name] - at for name, at in start.items()))
    moves = way > SAME_POINT
    led = PivotMove(
        state.kinematics,
        start,
        end,
        first,
        0.0,
        state.tool_length,
        way if moves else turn,
        last if moves else None,
    )
    goals = led.goals()
    rate = None if element.feed is None else (state.path_feed(element.feed) if moves else element.feed / 60.0)
    kind = Kind.RAPID if rate is None else Kind.FEED
    if turn <= SAME_POINT:
        return state.move(kind, {name: goals[name] for name in SLIDES}, rate)
    return state.move(kind, goals, rate, led)


def _parallel(state: State, point: Vector) -> Vector:
    """Return a point of the working plane in the machine-parallel system at the workpiece zero, in mm."""
    frame = state.plane.frame if state.plane is not None else state.kinematics.basic
    return plus(applied(state.kinematics.basic, state.origin), applied(frame, point))
