"""Execution of blocks without motion: labels, jumps, calls, Q parameters and system values.

FN 18 SYSREAD reads system values, and FN 17 SYSWRITE writes system values. Group and value numbers follow
the public manuals of the control. Unknown numbers are errors. If the tool table lacks a column, its cells
are read as empty and a warning is logged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.flow.word_values import CONTROL_Q_PARAMETERS, set_parameter, value
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.feed_rates import convert_to_feed_per_minute
from core.interpreter.shared.control_flow import ENDLESS_LOOP_CODE, EndlessLoopDetector
from core.interpreter.shared.job_setup import MillTool
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext import klartext_words
from core.language.klartext.klartext_faults import PROGRAM_RAISED_ERROR, TOOL_UNKNOWN, make_unsupported_error
from core.language.klartext.klartext_nodes import SystemRead, SystemWrite
from core.language.klartext.structure_blocks import MAX_REPEAT_COUNT
from core.message import Message


def execute_flow_block(
    state: State, flow: Flow, line: int, node: nodes.Label | nodes.LabelCall | nodes.ConditionalJump
) -> None:
    """Execute a label, a call or a jump.

    Raises ProgramError for an invalid repeat count or condition, or if calls are nested too deeply.
    """
    if isinstance(node, nodes.Label):
        flow.execute_label(node)
    elif isinstance(node, nodes.LabelCall):
        repeat = node.repeat_count or klartext_words.Value(0.0)
        times = word_values.number(state, repeat, "REP", MAX_REPEAT_COUNT, 0.0)
        flow.call_label(line, node, math.floor(times))
    elif word_values.value(state, node.condition):
        flow.jump_to_label(node)


def check_endless_loop(
    state: State, flow: Flow, loop_detector: EndlessLoopDetector, line: int, node: nodes.ConditionalJump
) -> None:
    """Raise ProgramError if a backward jump causes an endless loop.

    A loop is endless if the state is the same as at an earlier jump. The state includes the parameters and,
    because of Q108 to Q114, the tool, spindle and coolant.
    """
    if flow.next_index >= line:
        return
    tool = (
        state.tool_radius_mm,
        state.tool_length_mm,
        state.tool_axis,
        state.modal.spindle,
        state.modal.coolant,
    )
    if loop_detector.is_repeated_state(
        flow,
        line,
        tool,
        state.q_values,
        state.ql_and_qr_values,
        state.global_def_values,
        state.selected_program,
    ):
        text = "This jump repeats forever because the loop does not change anything that affects a jump."
        hint = "In the loop, change a Q parameter that the jump condition uses."
        raise state.make_error(node.column, ENDLESS_LOOP_CODE, text, hint)


CalculationNode = (
    nodes.Assignment
    | nodes.SystemRead
    | nodes.SystemWrite
    | nodes.ErrorMessageBlock
    | nodes.IgnoredBlock
    | nodes.GlobalDefinition
)


def execute_calculation(state: State, node: CalculationNode) -> None:
    """Execute a block with Q parameters or FN functions.

    Raises ProgramError for an invalid block, and always for FN 14.
    """
    match node:
        case nodes.Assignment():
            word_values.set_parameter(
                state, node.parameter_kind, node.parameter_number, word_values.value(state, node.formula)
            )
        case nodes.SystemRead():
            execute_system_read(state, node)
        case nodes.SystemWrite():
            execute_system_write(state, node)
        case nodes.ErrorMessageBlock():
            text = Message("The program reports its own error {number} and stops.", number=node.error_number)
            hint = "Check the conditions under which the program reaches this block."
            raise state.make_error(node.column, PROGRAM_RAISED_ERROR, text, hint)
        case nodes.IgnoredBlock():
            state.log_ignored_function(node.function_name, node.column)
        case nodes.GlobalDefinition():
            for each in node.parameters:
                state.global_def_values[each.parameter_number] = word_values.value(state, each.formula)


_TOOL_TABLE = 50
_AXES = {1: "X", 2: "Y", 3: "Z", 4: "A", 5: "B", 6: "C"}
_LENGTHS = frozenset(range(1, 7))  # columns with lengths: L R R2 DL DR DR2
_COLUMNS: dict[int, tuple[str, Callable[[MillTool], float]]] = {
    1: ("L", lambda row: row.length),
    2: ("R", lambda row: row.radius),
    3: ("R2", lambda row: row.corner_radius),
    4: ("DL", lambda row: row.delta_length),
    5: ("DR", lambda row: row.delta_radius),
    6: ("DR2", lambda row: row.delta_corner_radius),
    10: ("TIME2", lambda row: row.tool_life_minutes),
    15: ("CUT", lambda row: row.tooth_count),
    32: ("T-ANGLE", lambda row: row.point_angle_deg),
}
# Columns that this tool table lacks. The control reads an empty column as 0.
_EMPTY = {
    7: "TL", 8: "RT", 9: "TIME1", 12: "PLC", 13: "LCUTS", 14: "ANGLE", 16: "LTOL", 17: "RTOL", 18: "DIRECT",
    19: "R-OFFS", 20: "L-OFFS", 21: "LBREAK", 22: "RBREAK", 23: "PLC-VAL", 28: "NMAX", 34: "LIFTOFF",
    35: "R2TOL", 36: "TYPE",
}  # fmt: skip
_LOCKED = 7  # TL
_PLANE_OFFSET_GROUP = 19  # R-OFFS
_DEFAULT_RADIUS_VALUE = 99_999.9999  # value of the default R, which means the tool radius


def _read_address(state: State, node: SystemRead | SystemWrite) -> tuple[int, int, int]:
    """Return the group, the number and the index of a system value; the index is 0 if it is missing.

    Raises ProgramError if one of them is not a whole number.
    """
    group = word_values.check_whole_number(state, value(state, node.group_number), "ID", node.column)
    number = word_values.check_whole_number(state, value(state, node.data_number), "NR", node.column)
    if node.index is None:
        return group, number, 0
    return group, number, word_values.check_whole_number(state, value(state, node.index), "IDX", node.column)


def execute_system_read(state: State, node: SystemRead) -> None:
    """Execute FN 18, which reads a system value.

    Raises ProgramError for values that this control lacks, and for a tool that is not in the tool table.
    """
    group, number, index = _read_address(state, node)
    if group == _TOOL_TABLE:
        found = _cell(state, node.column, number, index)
    else:
        found = _figure(state, node.column, group, number, index)
    set_parameter(state, node.parameter_kind, node.parameter_number, found)


def execute_system_write(state: State, node: SystemWrite) -> None:
    """Execute FN 17, which writes a system value, but leave the actual tool table unchanged.

    Values of the tool table that do not affect motion are stored, and FN 18 then returns them. A value that
    would change a path is an error, unless the table already contains this value. Raises ProgramError for
    an unknown value.
    """
    group, number, index = _read_address(state, node)
    content = value(state, node.new_value)
    if group != _TOOL_TABLE or number not in _COLUMNS.keys() | _EMPTY.keys() | {11}:
        raise _not_here(state, node.column, 17, group, number, index)
    tool = index or state.modal.tool
    name = _COLUMNS[number][0] if number in _COLUMNS else _EMPTY.get(number, "")
    if number in _COLUMNS or number == _LOCKED:
        before = _cell(state, node.column, number, index) if number in _COLUMNS else 0.0
        if not math.isclose(before, content, abs_tol=1e-9):
            raise make_unsupported_error(
                state.line_number,
                node.column,
                Message(
                    "Writing {name} of tool {tool} to the tool table with FN 17 (enter the value "
                    "in the tool table instead)",
                    name=name,
                    tool=tool,
                ),
            )
    state.system_written_values[tool, number] = content
    state.log_ignored_function(
        Message("FN 17 SYSWRITE ID50 NR{number} {name}", number=number, name=name).rstrip(), node.column
    )


def _cell(state: State, column: int, number: int, index: int) -> float:
    """Return a value of the tool table, with lengths in the program's unit.

    ``index`` is the tool number; 0 selects the active tool.
    """
    tool = index or state.modal.tool
    if (tool, number) in state.system_written_values:
        return state.system_written_values[tool, number]
    row = _row(state, tool)
    if row is None:
        text = "Tool {tool} is not in the tool table."
        raise state.make_error(column, TOOL_UNKNOWN, text, "Add the tool to the tool table.", tool=tool)
    if number in _COLUMNS:
        return _COLUMNS[number][1](row) / (state.mm_per_unit if number in _LENGTHS else 1.0)
    if number not in _EMPTY:
        raise _not_here(state, column, 18, _TOOL_TABLE, number, index)
    found = _DEFAULT_RADIUS_VALUE if number == _PLANE_OFFSET_GROUP else 0.0
    text = "The tool table has no column {empty}, so FN 18 returns {value} as it does for an empty cell."
    state.log_finding_once(
        column, Severity.WARNING, "tool-table-column", text, empty=_EMPTY[number], value=f"{found:.9g}"
    )
    return found


def _row(state: State, tool: int) -> MillTool | None:
    """Return the known data of a tool, or None if no data exist. TOOL DEF overrides the tool table."""
    row = state.setup.mill_tools.get(tool)
    if tool in state.tool_definitions:
        length, radius = state.tool_definitions[tool]
        return MillTool(length, radius) if row is None else _defined(row, length, radius)
    if row is not None:
        return row
    if tool == state.modal.tool:  # a tool with only an offset, or with a name in TOOL DEF
        off = state.tool_deltas_mm
        return MillTool(state.tool_length_mm - off.length, state.tool_radius_mm - off.radius)
    offset = state.setup.tools.get(tool)
    return None if offset is None else MillTool(offset.z, offset.nose_radius)


def _defined(row: MillTool, length: float, radius: float) -> MillTool:
    return MillTool(
        length,
        radius,
        corner_radius=row.corner_radius,
        tooth_count=row.tooth_count,
        point_angle_deg=row.point_angle_deg,
        tool_life_minutes=row.tool_life_minutes,
    )


def _figure(state: State, column: int, group: int, number: int, index: int) -> float:
    if (group, number) in _PLAIN:
        return _PLAIN[group, number](state, column)
    axis = _AXES.get(index, "")
    if axis in state.position_by_axis:
        found = _axis_value(state, group, number, axis)
        if found is not None:
            return found / (state.mm_per_unit if axis in "XYZ" else 1.0)
    if group == 200 and number in {1, 2, 3} and index in {1, 2, 3}:
        return _compensation(state, number, index) / state.mm_per_unit
    if (group, number) == (210, 4) and index in {1, 2, 3}:
        return state.transformation.scale_factor
    raise _not_here(state, column, 18, group, number, index)


def _not_here(state: State, column: int, function: int, group: int, number: int, index: int) -> ProgramError:
    return make_unsupported_error(
        state.line_number,
        column,
        Message(
            "FN {function} with ID{word} NR{number} IDX{index}",
            function=function,
            word=group,
            number=number,
            index=index,
        ),
    )


def _feed(state: State, column: int) -> float:
    return (
        0.0 if state.feed is None else convert_to_feed_per_minute(state, state.feed, state.feed_base, column)
    )


_PLAIN: Mapping[tuple[int, int], Callable[[State, int], float]] = {
    (20, 1): lambda state, _: float(state.modal.tool),
    (20, 3): lambda _state, _: 2.0,
    (20, 4): lambda state, _: state.modal.rpm,
    (20, 5): lambda state, _: CONTROL_Q_PARAMETERS[110](state),
    (20, 8): lambda state, _: CONTROL_Q_PARAMETERS[111](state),
    (20, 9): _feed,
    (25, 1): lambda _state, _: 1.0,
    (35, 1): lambda _state, _: 0.0,  # words without I are absolute
    (60, 1): lambda state, _: float(state.modal.tool),
    (60, 2): lambda _state, _: 2.0,
    (60, 3): lambda state, _: state.modal.rpm,
    (60, 4): lambda state, _: state.tool_deltas_mm.length / state.mm_per_unit,
    (60, 5): lambda state, _: state.tool_deltas_mm.radius / state.mm_per_unit,
    (60, 7): lambda state, _: state.tool_deltas_mm.corner_radius / state.mm_per_unit,
    (210, 1): lambda state, _: state.kinematics.basic_rotation_deg,
    (210, 2): lambda state, _: state.transformation.rotation_deg,
    (210, 3): lambda state, _: float(
        sum(2 ** "XYZ".index(axis) for axis in state.transformation.mirrored_axes)
    ),
    (210, 6): lambda state, _: -1.0 if state.active_plane is not None else 0.0,
    (230, 5): lambda _state, _: 0.0,  # the travel limits are always monitored
    (280, 1): lambda state, _: -1.0 if state.is_tcpm_active else 0.0,
}


def _axis_value(state: State, group: int, number: int, axis: str) -> float | None:
    """Return a system value of one axis in mm or degrees, or None if the value does not exist."""
    linear = axis in "XYZ"
    if number == 1 and group in {240, 270}:
        state.record_position_read()
    if (group, number) == (240, 1):
        return state.position_by_axis[axis]
    if (group, number) == (270, 1):
        return (
            state.programmed_position["XYZ".index(axis)]
            if linear
            else state.displayed_angles["ABC".index(axis)]
        )
    if (group, number) == (220, 2) and linear and state.active_plane is None:
        return state.origin["XYZ".index(axis)]
    if group == 230 and number in {2, 3}:
        bounds = {each.name: (each.travel_min, each.travel_max) for each in state.kinematics.linear_axes}
        bounds |= {each.name: (each.travel_min, each.travel_max) for each in state.kinematics.rotary_axes}
        bound = bounds[axis][number - 2]
        return bound if math.isfinite(bound) else None
    return None


def _compensation(state: State, number: int, index: int) -> float:
    """Return the radius, length or R2 of the active tool, in mm.

    ``index`` selects the table value (1), the table value plus the table deltas (2), or this sum plus the
    deltas of TOOL CALL (3).
    """
    row = _row(state, state.modal.tool) or MillTool()
    plain, off, called = {
        1: (row.radius, row.delta_radius, state.tool_deltas_mm.radius),
        2: (row.length, row.delta_length, state.tool_deltas_mm.length),
        3: (row.corner_radius, row.delta_corner_radius, state.tool_deltas_mm.corner_radius),
    }[number]
    return plain + (off if index > 1 else 0.0) + (called if index > 2 else 0.0)
