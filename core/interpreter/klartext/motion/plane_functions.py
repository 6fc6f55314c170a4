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
    InvalidFrameError,
    Matrix,
    Vector,
    add_vectors,
    apply_matrix,
    make_frame_from_euler_angles,
    make_frame_from_points,
    make_frame_from_projections,
    make_frame_from_spatial_angles,
    make_frame_from_vectors,
    make_rotation,
    multiply_matrices,
    scale_vector,
    subtract_vectors,
    transpose_matrix,
)
from core.geometry.swivel_angles import PrimaryAxisSide, choose_solution, find_reachable_solutions
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import (
    LINEAR_AXES,
    ORIGIN_POINT,
    POINT_TOLERANCE,
    ROTARY_AXES,
    TARGET_ANGLE_PARAMETERS,
    ActivePlane,
    State,
)
from core.interpreter.klartext.motion.path_elements import PathElement
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import Diagnostic, Severity
from core.language.klartext.klartext_faults import (
    ANGLE_NOT_PERMITTED,
    INPUT_VALUE_INCORRECT,
    M128_ACTIVE,
    PLANE_INCORRECT,
    TOOL_AXIS_MISSING,
    WRONG_AXIS,
)
from core.language.klartext.klartext_nodes import PlaneBlock
from core.language.klartext.klartext_words import AxisWord, RetractWord
from core.message import Message

# --- frame and angles of a PLANE block, without motion


_ROTATION_AXES = {"SPA": X_AXIS, "SPB": Y_AXIS, "SPC": Z_AXIS}


def make_working_plane(state: State, node: PlaneBlock) -> ActivePlane:
    """Return the plane of a PLANE block.

    Raises ProgramError if the plane is undefined or cannot be reached.
    """
    if node.definition_kind == "AXIAL":
        return _axial(state, node)
    frame = multiply_matrices(
        _base(state, node), _transform_frame(state, node, _FORMS[node.definition_kind](state, node))
    )
    side = PrimaryAxisSide(node.positioning.solution) if node.positioning.solution else None
    table_rot = node.positioning.rotation_mode == "TABLE ROT"
    found = choose_solution(state.kinematics, frame, state.rotary_angles, side, rotates_table=table_rot)
    if found is None:
        asked = Message(" when {side} is programmed", side=side) if side else ""
        text = "The rotary axes cannot reach this plane within their ranges{requested}."
        raise state.make_error(
            node.column, ANGLE_NOT_PERMITTED, text, "Check the points, angles and SYM.", requested=asked
        )
    if side is None and not state.is_table_positioned:
        _note_swivel_direction(state, node, frame)
    return ActivePlane(frame, found.axis_angles, state.line_number)


def _note_swivel_direction(state: State, node: PlaneBlock, frame: Matrix) -> None:
    """Log a note that the swivel direction depends on the start position of the table.

    The start position is unknown when the program is proved.
    """
    if len(find_reachable_solutions(state.kinematics, frame, state.rotary_angles)) > 1:
        text = (
            "There are two possible swivel directions; the start position of the table "
            "determines which direction is used."
        )
        hint = "Write SYM+ or SYM-, or position the table before this block."
        state.log.add_finding(
            Diagnostic(state.line_number, node.column, Severity.NOTE, "two-ways", text, hint)
        )


def _axial(state: State, node: PlaneBlock) -> ActivePlane:
    """Return the plane of PLANE AXIAL.

    The axis angles are absolute or incremental and do not include the basic rotation.
    """
    angles = state.target_angles
    for word in node.words:
        axis = state.kinematics.find_rotary_axis(word.axis)
        if axis is None:
            text = "This machine has no rotary axis {axis}."
            hint = "Remove the word, or select a machine with axis {axis}."
            raise state.make_error(word.column, WRONG_AXIS, text, hint, axis=word.axis)
        value = word_values.number(state, word.value, word.axis, word_values.MAX_AXIS_ANGLE_DEG)
        zero = state.kinematics.zero_angles[axis.name]
        angle = angles[axis.name] + value if word.is_incremental else value + zero
        if not axis.is_in_range(angle):
            ends = Message(
                "{low} and {high}", low=f"{axis.travel_min - zero:g}", high=f"{axis.travel_max - zero:g}"
            )
            text = "{axis} {angle} is not between {ends}."
            hint = "Correct the angle."
            raise state.make_error(
                word.column,
                ANGLE_NOT_PERMITTED,
                text,
                hint,
                axis=axis.name,
                angle=f"{angle - zero:+.7g}",
                ends=ends,
            )
        angles[axis.name] = axis.get_displayed_angle(angle)
    return ActivePlane(state.kinematics.compute_tool_frame(angles), angles, state.line_number)


def _points(state: State, node: PlaneBlock) -> Matrix:
    x1, y1, z1, x2, y2, z2, x3, y3, z3 = (number * state.mm_per_unit for number in _lengths(state, node))
    return _made(state, node, lambda: make_frame_from_points((x1, y1, z1), (x2, y2, z2), (x3, y3, z3)))


def _vector(state: State, node: PlaneBlock) -> Matrix:
    bx, by, bz, nx, ny, nz = _lengths(state, node)
    return _made(state, node, lambda: make_frame_from_vectors((bx, by, bz), (nx, ny, nz)))


def _lengths(state: State, node: PlaneBlock) -> list[float]:
    most = word_values.MAX_POINT_COORDINATE
    return [word_values.number(state, word.value, word.axis, most) for word in node.words]


def _made(state: State, node: PlaneBlock, frame: Callable[[], Matrix]) -> Matrix:
    try:
        return frame()
    except InvalidFrameError as problem:
        text = "Correct the points, vectors or angles."
        raise state.make_error(
            node.column, PLANE_INCORRECT, "{what}.", text, what=str(problem).capitalize()
        ) from problem


def _projected(state: State, node: PlaneBlock) -> Matrix:
    first, second, rotation = (_angle(state, word) for word in node.words)
    return _made(state, node, lambda: make_frame_from_projections(first, second, rotation))


def _euler(state: State, node: PlaneBlock) -> Matrix:
    precession, nutation, rotation = (_angle(state, word) for word in node.words)
    return make_frame_from_euler_angles(precession, nutation, rotation)


def _spatial(state: State, node: PlaneBlock) -> Matrix:
    a, b, c = (_angle(state, word) for word in node.words)
    return make_frame_from_spatial_angles(a, b, c)


def _relative(state: State, node: PlaneBlock) -> Matrix:
    """Return the rotation of PLANE RELATIV about an axis of the active plane.

    If no plane is active, the axis belongs to the workpiece system.
    """
    (word,) = node.words
    return make_rotation(_ROTATION_AXES[word.axis], _angle(state, word))


def _base(state: State, node: PlaneBlock) -> Matrix:
    """Return the reference frame of a PLANE block.

    The reference frame is the active plane for PLANE RELATIV, and the basic rotation otherwise.
    """
    relative = node.definition_kind == "RELATIV" and state.active_plane is not None
    return (
        state.active_plane.frame
        if relative and state.active_plane is not None
        else state.kinematics.workpiece_rotation
    )


def _transform_frame(state: State, node: PlaneBlock, frame: Matrix) -> Matrix:
    """Return the frame transformed by the active TRANS MIRROR, ROTATION and SCALE: T F T⁻¹.

    T also transforms the program in the plane. The result p = T F q is therefore the mirrored or rotated
    image of the original plane. PLANE AXIAL specifies axis angles and is not transformed.
    """
    figure = state.transformation
    if figure.is_identity:
        return frame
    text = "MIRROR, ROTATION or SCALE is active and also applies to PLANE {form}."
    hint = "Check the axis angles, write PLANE before MIRROR, ROTATION and SCALE, or use PLANE AXIAL."
    state.log.add_warning(
        state.line_number, node.column, "plane-figure", text, hint, form=node.definition_kind
    )
    columns = [
        figure.convert_to_plane(apply_matrix(frame, figure.convert_to_program(unit))) for unit in IDENTITY
    ]
    return transpose_matrix((columns[0], columns[1], columns[2]))


_FORMS = {
    "POINTS": _points,
    "SPATIAL": _spatial,
    "RELATIV": _relative,
    "EULER": _euler,
    "VECTOR": _vector,
    "PROJECTED": _projected,
}


def _angle(state: State, word: AxisWord) -> float:
    return word_values.number(state, word.value, word.axis, word_values.MAX_SPATIAL_ANGLE_DEG)


LIMIT_CLEARANCE_MM = 0.001  # mm; distance of MB MAX from the software limit


def plane(state: State, node: PlaneBlock) -> Iterator[Block]:
    """Yield the blocks of PLANE: the retract, if programmed, and a block of kind ``plane``.

    If ProgramError is raised, the state has not changed.
    """
    _demand_possible(state, node)
    made = None if node.definition_kind == "RESET" else make_working_plane(state, node)
    if made is not None and made.frame != state.kinematics.workpiece_rotation:
        _check_tool_axis(state, node)
    targets = state.kinematics.zero_angles if made is None else made.target_angles
    mode = node.positioning.mode or "STAY"
    feed = word_values.evaluate_feed(state, node.positioning.feed, node.column) if mode != "STAY" else None
    up = compute_retract_length(state, node.positioning.retract)
    distance = word_values.evaluate_length_mm(state, node.positioning.rotation_center_distance, "DIST")
    _warn_about_shift(state, made)
    for q, name in zip(TARGET_ANGLE_PARAMETERS, ROTARY_AXES, strict=True):
        axis = state.kinematics.find_rotary_axis(name)
        state.q_values[q] = 0.0 if axis is None else state.kinematics.get_displayed_angle(axis, targets[name])
    if up > POINT_TOLERANCE:
        yield make_retract_block(state, up, feed)
    pivot = _pivot(state, distance) if mode == "MOVE" else None
    goal = state.rotary_angles if mode == "STAY" else _goal(state, targets)
    state.is_table_positioned = state.is_table_positioned or mode != "STAY"
    state.set_plane(made)
    yield _swivel(state, goal, feed, pivot, distance)


def make_retract_block(state: State, distance_mm: float, feed: float | None) -> Block:
    """Return the block of a retract from the workpiece along the tool axis.

    ``feed`` is the programmed feed, or None for a rapid.
    """
    goal = dict(zip(LINEAR_AXES, _raised(state, distance_mm), strict=True))
    rate = None if feed is None else state.convert_feed_to_mm_s(feed)
    return state.make_move_block(BlockKind.RAPID if rate is None else BlockKind.FEED, goal, rate)


def compute_retract_length(state: State, retract_word: RetractWord | None) -> float:
    """Return the length of the retract MB in mm, or 0 if MB is not programmed.

    MB MAX ends just before the first software limit.
    """
    if retract_word is None:
        return 0.0
    if retract_word.distance is not None:
        return word_values.evaluate_length_mm(state, retract_word.distance, "MB")
    ways = []
    for slide, at, share in zip(
        state.kinematics.linear_axes,
        state.linear_position,
        state.kinematics.compute_tool_direction(state.rotary_angles),
        strict=True,
    ):
        if abs(share) > POINT_TOLERANCE:
            ways.append(((slide.travel_max if share > 0.0 else slide.travel_min) - at) / share)
    up = min(ways, default=math.inf)
    text = "MB MAX needs a software limit, but this machine does not have one along the tool axis."
    state.check_condition(
        not math.isinf(up), retract_word.column, INPUT_VALUE_INCORRECT, text, "Write MB with a length."
    )
    return max(up - LIMIT_CLEARANCE_MM, 0.0)


def _demand_possible(state: State, node: PlaneBlock) -> None:
    text = "M128 is active."
    state.check_condition(
        not state.is_tcpm_active,
        node.column,
        M128_ACTIVE,
        text,
        "Switch M128 off with M129 before this block.",
    )


def _check_tool_axis(state: State, node: PlaneBlock) -> None:
    """Raise ProgramError if no TOOL CALL has defined a tool axis, which a tilted plane needs.

    Call this function only for a tilted plane.
    """
    if not state.tool_axis:
        text = "No TOOL CALL has defined a tool axis."
        raise state.make_error(node.column, TOOL_AXIS_MISSING, text, "Write TOOL CALL n Z before this block.")


def _raised(state: State, up: float) -> Vector:
    return subtract_vectors(
        state.linear_position, scale_vector(state.kinematics.compute_tool_direction(state.rotary_angles), -up)
    )


def _pivot(state: State, distance: float) -> Vector:
    """Return the pivot point of a PLANE block with MOVE.

    The point is in the machine-parallel system with its origin at the workpiece zero.
    """
    place = state.kinematics.make_transform(state.rotary_angles, tool_length=state.tool_length_mm)
    return place.convert_to_frame_point(_raised(state, -distance))


def _goal(state: State, targets: Mapping[str, float]) -> dict[str, float]:
    return {
        axis.name: state.position_by_axis[axis.name]
        + axis.find_travel(state.position_by_axis[axis.name], targets[axis.name])
        for axis in state.kinematics.rotary_axes
    }


def _swivel(
    state: State, goal: Mapping[str, float], feed: float | None, pivot: Vector | None, distance: float
) -> Block:
    """Return the block of kind ``plane``, which swivels the rotary axes to ``goal``.

    Without ``pivot``, only the rotary axes move. With ``pivot``, the linear axes follow, so that the tool
    does not move relative to the pivot point.
    """
    rate = None if feed is None else feed / 60.0
    start = state.rotary_angles
    turn = math.hypot(*(goal[name] - at for name, at in start.items()))
    if pivot is None or turn <= POINT_TOLERANCE:
        return state.make_move_block(BlockKind.PLANE, goal, rate)
    pivot_move = PivotMove(state.kinematics, start, goal, pivot, distance, state.tool_length_mm, turn)
    return state.make_move_block(BlockKind.PLANE, pivot_move.compute_end_positions(), rate, pivot_move)


def _warn_about_shift(state: State, plane: ActivePlane | None) -> None:
    """Log a warning if a PLANE block follows a datum shift that was programmed in a tilted plane.

    Programmers usually do not intend this.
    """
    if plane is None or state.active_plane is None or state.shift == ORIGIN_POINT:
        return
    text = "The datum was shifted in the tilted coordinate system that is defined on line {line}."
    hint = (
        "If the shift is meant for the workpiece coordinate system, write PLANE RESET STAY before TRANS "
        "DATUM."
    )
    state.log.add_warning(
        state.line_number, 0, "datum-in-plane", text, hint, line=state.active_plane.line_number
    )


def set_tcpm_active(state: State, *, is_active: bool) -> None:
    """Turn tool center point control on or off."""
    state.is_tcpm_active = is_active
    state.update_derived_values()


def move_with_rotary_axes(state: State, element: PathElement) -> Block:
    """Return a straight move of the tip on the workpiece, during which rotary axes move as well.

    The rotary axes move in proportion to the path. The feed is in mm of the tip path, or in degrees if the
    tip does not move.
    """
    first, last = (
        _parallel(state, state.transformation.convert_to_plane(at)) for at in (element.start, element.end)
    )
    start = state.rotary_angles
    end = start | dict(element.rotary_targets_deg)
    path_length_mm = math.dist(first, last)
    turn = math.hypot(*(end[name] - at for name, at in start.items()))
    moves = path_length_mm > POINT_TOLERANCE
    led = PivotMove(
        state.kinematics,
        start,
        end,
        first,
        0.0,
        state.tool_length_mm,
        path_length_mm if moves else turn,
        last if moves else None,
    )
    goals = led.compute_end_positions()
    rate = (
        None
        if element.feed is None
        else (state.convert_feed_to_mm_s(element.feed) if moves else element.feed / 60.0)
    )
    kind = BlockKind.RAPID if rate is None else BlockKind.FEED
    if turn <= POINT_TOLERANCE:
        return state.make_move_block(kind, {name: goals[name] for name in LINEAR_AXES}, rate)
    return state.make_move_block(kind, goals, rate, led)


def _parallel(state: State, point: Vector) -> Vector:
    """Convert a point of the working plane to the machine-parallel system, in mm.

    The origin of this system is the workpiece zero.
    """
    frame = (
        state.active_plane.frame if state.active_plane is not None else state.kinematics.workpiece_rotation
    )
    return add_vectors(
        apply_matrix(state.kinematics.workpiece_rotation, state.origin), apply_matrix(frame, point)
    )
