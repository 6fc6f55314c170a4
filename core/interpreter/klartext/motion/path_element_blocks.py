"""Conversion of path elements to blocks: straight moves and arcs in machine coordinates.

The points are converted through the active plane.
"""

from __future__ import annotations

from collections.abc import Mapping

from core.geometry.lines_and_arcs import Arc
from core.geometry.working_plane import HelixMove, convert_to_plane_order
from core.interpreter.klartext.klartext_state import LINEAR_AXES, POINT_TOLERANCE, State
from core.interpreter.klartext.motion.feed_rates import compute_rotary_feed
from core.interpreter.klartext.motion.path_elements import PathElement
from core.interpreter.klartext.motion.plane_functions import move_with_rotary_axes
from core.interpreter.shared.elementary_blocks import Block, BlockKind


def make_element_block(state: State, each: PathElement) -> Block:
    """Return the block of one element, converted to plane and machine coordinates."""
    if each.arc is not None:
        return _make_arc_block(state, each, each.arc)
    if state.is_tcpm_active and each.rotary_targets_deg:
        return move_with_rotary_axes(state, each)
    goals: Mapping[str, float] = dict(
        zip(LINEAR_AXES, state.convert_to_machine_position(each.end), strict=True)
    )
    if not any(abs(goals[name] - state.position_by_axis[name]) > POINT_TOLERANCE for name in LINEAR_AXES):
        goals = {}
    rate = None if each.feed is None else state.convert_feed_to_mm_s(each.feed)
    if rate is not None and each.feed is not None and not goals:
        rate = compute_rotary_feed(state, each.feed, each.rotary_targets_deg)
    return state.make_move_block(
        BlockKind.RAPID if rate is None else BlockKind.FEED, {**goals, **each.rotary_targets_deg}, rate
    )


def _make_arc_block(state: State, each: PathElement, arc: Arc) -> Block:
    names = state.axis_names
    columns = names.index("X"), names.index("Y"), names.index("Z")
    if each.is_vertical_arc:
        arc, frame = state.transformation.transform_upright_arc(arc, each.axis_order)
        w0, w1 = (
            convert_to_plane_order(each.axis_order, at)[2] * state.transformation.scale_factor
            for at in (each.start, each.end)
        )
        helix_move = HelixMove(state.plane_transform, arc, w0, w1, state.axis_positions, columns, frame)
    else:
        z0, z1 = (
            state.transformation.convert_to_plane((0.0, 0.0, at))[2] for at in (each.start[2], each.end[2])
        )
        helix_move = HelixMove(
            state.plane_transform,
            state.transformation.transform_arc(arc),
            z0,
            z1,
            state.axis_positions,
            columns,
        )
    goals = dict(zip(LINEAR_AXES, state.convert_to_machine_position(each.end), strict=True))
    rate = None if each.feed is None else state.convert_feed_to_mm_s(each.feed)
    return state.make_move_block(BlockKind.PLANE_ARC, goals, rate, helix_move)
