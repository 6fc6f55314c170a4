"""Checks of a path function before its move: axes, compensation of LN, spindle and table angles."""

from __future__ import annotations

from core.interpreter.klartext.klartext_state import LINEAR_AXES, State
from core.language.klartext.klartext_faults import WRONG_AXIS, make_unsupported_error
from core.language.klartext.klartext_nodes import PathFunction

TABLE_TOLERANCE_DEG = 0.001  # degrees; position error of the table above which a cut causes a warning


def check_axes(state: State, node: PathFunction) -> None:
    """Raise ProgramError for an axis that the machine does not have."""
    for word in node.axis_words:
        if word.axis not in state.position_by_axis:
            text = "This machine has no {axis} axis."
            raise state.make_error(word.column, WRONG_AXIS, text, "Remove the word.", axis=word.axis)


def check_surface_normal(state: State, node: PathFunction, *, is_compensated: bool) -> None:
    """Raise ProgramError for an LN block with a tool vector, tool delta or radius compensation.

    The deltas are DL, DR and DR2 of TOOL CALL and of the tool table.
    """
    if any(word.axis[0] == "T" for word in node.words):
        raise make_unsupported_error(
            state.line_number, node.column, "LN with a tool direction vector (TX TY TZ)"
        )
    row = state.setup.mill_tools.get(state.modal.tool)
    off = (
        *state.tool_deltas_mm,
        *((row.delta_length, row.delta_radius, row.delta_corner_radius) if row is not None else ()),
    )
    if any(off) or node.compensation in {"L", "R"} or is_compensated:
        raise make_unsupported_error(
            state.line_number, node.column, "LN with 3D compensation (DL, DR, DR2, RL, RR)"
        )


def warn_about_cut_start(state: State, node: PathFunction) -> None:
    """Warn once if a cut starts with the spindle stopped or the table not at the plane's angles."""
    if all(word.axis not in LINEAR_AXES for word in node.axis_words) and not node.words:
        return
    if not state.modal.spindle and "spindle" not in state.reported_findings:
        state.reported_findings.add("spindle")
        text, hint = "The spindle is stopped during this feed move.", ("Start the spindle with M3 or M4.")
        state.log.add_warning(state.line_number, 0, "spindle-stopped", text, hint)
    plane = state.active_plane
    if plane is None or ("table", plane.line_number) in state.reported_findings:
        return
    off = [
        axis.name
        for axis in state.kinematics.rotary_axes
        if abs(axis.find_travel(plane.target_angles[axis.name], state.position_by_axis[axis.name]))
        > TABLE_TOLERANCE_DEG
    ]
    if off:
        state.reported_findings.add(("table", plane.line_number))
        text = "The position of {off} does not match the plane programmed on line {line}."
        hint = (
            "Position the rotary axes before the cut with L A+Q120 C+Q122 R0 FMAX, or write TURN in the "
            "PLANE block."
        )
        state.log.add_warning(
            state.line_number, 0, "table-elsewhere", text, hint, off=" and ".join(off), line=plane.line_number
        )
