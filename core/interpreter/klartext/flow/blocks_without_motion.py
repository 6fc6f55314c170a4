"""Blocks without motion: labels, jumps, calls, Q parameters and system values.

FN 18 SYSREAD reads system values, and FN 17 SYSWRITE writes them. Groups and numbers follow the public
manuals of the control. Unknown numbers are errors. A column that the tool table lacks is read as an empty
cell, with a warning.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.flow.word_values import OF_THE_CONTROL, keep, value
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.feed_rates import per_minute
from core.interpreter.shared.control_flow import ENDLESS, LoopWatch
from core.interpreter.shared.job_setup import MillTool
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.klartext_faults import OWN_ERROR, TOOL_UNKNOWN, unsupported
from core.language.klartext.klartext_nodes import SystemRead, SystemWrite
from core.language.klartext.structure_blocks import MOST_REPEATS
from core.message import Message


def go_on(state: State, flow: Flow, line: int, node: nodes.Label | nodes.Call | nodes.Jump) -> None:
    """Execute a label, call or jump. Raises ProgramError for an invalid repeat count or condition."""
    if isinstance(node, nodes.Label):
        flow.label(node)
    elif isinstance(node, nodes.Call):
        repeat = node.repeat or nodes.Value(0.0)
        times = word_values.number(state, repeat, "REP", MOST_REPEATS, 0.0)
        flow.call(line, node, math.floor(times))
    elif word_values.value(state, node.condition):
        flow.jump(node)


def refuse_endless(state: State, flow: Flow, watch: LoopWatch, line: int, node: nodes.Jump) -> None:
    """Raise ProgramError if a jump back makes the loop endless.

    It is endless if the state is the same as at an earlier jump. The state includes the parameters and, for
    Q108 to Q114, tool, spindle and coolant.
    """
    if flow.at >= line:
        return
    tool = state.tool_radius, state.tool_length, state.tool_axis, state.modal.spindle, state.modal.coolant
    if watch.comes_round(flow, line, tool, state.q, state.q_beside, state.q_global, state.selected_program):
        text = "This jump repeats forever because the loop does not change anything that affects a jump."
        hint = "In the loop, change a Q parameter that the jump condition uses."
        raise state.refuse(node.column, ENDLESS, text, hint)


Reckoned = (
    nodes.Assign
    | nodes.SystemRead
    | nodes.SystemWrite
    | nodes.ErrorMessage
    | nodes.Unheeded
    | nodes.GlobalDef
)


def reckon(state: State, node: Reckoned) -> None:
    """Execute a Q parameter or FN block. Raises ProgramError, always for FN 14."""
    match node:
        case nodes.Assign():
            word_values.keep(state, node.kind, node.q, word_values.value(state, node.formula))
        case nodes.SystemRead():
            read_system(state, node)
        case nodes.SystemWrite():
            write_system(state, node)
        case nodes.ErrorMessage():
            text = Message("The program reports its own error {number} and stops.", number=node.number)
            hint = "Check the conditions under which the program reaches this block."
            raise state.refuse(node.column, OWN_ERROR, text, hint)
        case nodes.Unheeded():
            state.unheeded(node.what, node.column)
        case nodes.GlobalDef():
            for each in node.values:
                state.q_global[each.q] = word_values.value(state, each.formula)


_TOOL_TABLE = 50
_AXES = {1: "X", 2: "Y", 3: "Z", 4: "A", 5: "B", 6: "C"}
_LENGTHS = frozenset(range(1, 7))  # columns with lengths: L R R2 DL DR DR2
_COLUMNS: dict[int, tuple[str, Callable[[MillTool], float]]] = {
    1: ("L", lambda row: row.length),
    2: ("R", lambda row: row.radius),
    3: ("R2", lambda row: row.corner),
    4: ("DL", lambda row: row.dl),
    5: ("DR", lambda row: row.dr),
    6: ("DR2", lambda row: row.dr2),
    10: ("TIME2", lambda row: row.life),
    15: ("CUT", lambda row: row.teeth),
    32: ("T-ANGLE", lambda row: row.point),
}
# Columns that this tool table lacks. The control reads an empty column as 0.
_EMPTY = {
    7: "TL", 8: "RT", 9: "TIME1", 12: "PLC", 13: "LCUTS", 14: "ANGLE", 16: "LTOL", 17: "RTOL", 18: "DIRECT",
    19: "R-OFFS", 20: "L-OFFS", 21: "LBREAK", 22: "RBREAK", 23: "PLC-VAL", 28: "NMAX", 34: "LIFTOFF",
    35: "R2TOL", 36: "TYPE",
}  # fmt: skip
_LOCKED = 7  # TL
_OFFSET_IN_PLANE = 19  # R-OFFS
_AS_THE_RADIUS = 99_999.9999  # value of the default R, which means the tool radius


def read_system(state: State, node: SystemRead) -> None:
    """Execute FN 18. Raises ProgramError for system values that this control lacks."""
    group, number = int(value(state, node.group)), int(value(state, node.number))
    index = int(value(state, node.index)) if node.index is not None else 0
    if group == _TOOL_TABLE:
        found = _cell(state, node.column, number, index)
    else:
        found = _figure(state, node.column, group, number, index)
    keep(state, node.kind, node.q, found)


def write_system(state: State, node: SystemWrite) -> None:
    """Execute FN 17, which does not change the control. Raises ProgramError for an unknown value.

    Values of the tool table without effect on motion are noted, and FN 18 then returns them. A value that
    would change a path is an error, unless the table already has it.
    """
    group, number = int(value(state, node.group)), int(value(state, node.number))
    index = int(value(state, node.index)) if node.index is not None else 0
    content = value(state, node.content)
    if group != _TOOL_TABLE or number not in _COLUMNS.keys() | _EMPTY.keys() | {11}:
        raise _not_here(state, node.column, 17, group, number, index)
    tool = index or state.modal.tool
    name = _COLUMNS[number][0] if number in _COLUMNS else _EMPTY.get(number, "")
    if number in _COLUMNS or number == _LOCKED:
        before = _cell(state, node.column, number, index) if number in _COLUMNS else 0.0
        if not math.isclose(before, content, abs_tol=1e-9):
            raise unsupported(
                state.line,
                node.column,
                Message(
                    "Writing {name} of tool {tool} to the tool table with FN 17 (enter the value "
                    "in the tool table instead)",
                    name=name,
                    tool=tool,
                ),
            )
    state.tool_cells[tool, number] = content
    state.unheeded(
        Message("FN 17 SYSWRITE ID50 NR{number} {name}", number=number, name=name).rstrip(), node.column
    )


def _cell(state: State, column: int, number: int, index: int) -> float:
    """Return a value of the tool table, lengths in the program's unit; index 0 is the active tool."""
    tool = index or state.modal.tool
    if (tool, number) in state.tool_cells:
        return state.tool_cells[tool, number]
    row = _row(state, tool)
    if row is None:
        text = "Tool {tool} is not in the tool table."
        raise state.refuse(column, TOOL_UNKNOWN, text, "Add the tool to the tool table.", tool=tool)
    if number in _COLUMNS:
        return _COLUMNS[number][1](row) / (state.scale if number in _LENGTHS else 1.0)
    if number not in _EMPTY:
        raise _not_here(state, column, 18, _TOOL_TABLE, number, index)
    found = _AS_THE_RADIUS if number == _OFFSET_IN_PLANE else 0.0
    text = "The tool table has no column {empty}, so FN 18 returns {value} as it does for an empty cell."
    state.tell_once(
        column, Severity.WARNING, "tool-table-column", text, empty=_EMPTY[number], value=f"{found:.9g}"
    )
    return found


def _row(state: State, tool: int) -> MillTool | None:
    """Return the known data of a tool; TOOL DEF has priority over the table."""
    row = state.setup.mill_tools.get(tool)
    if tool in state.tool_defs:
        length, radius = state.tool_defs[tool]
        return MillTool(length, radius) if row is None else _defined(row, length, radius)
    if row is not None:
        return row
    if tool == state.modal.tool:  # a tool with only an offset, or with a name in TOOL DEF
        longer, thicker = state.oversize
        return MillTool(state.tool_length - longer, state.tool_radius - thicker)
    offset = state.setup.tools.get(tool)
    return None if offset is None else MillTool(offset.z, offset.nose_radius)


def _defined(row: MillTool, length: float, radius: float) -> MillTool:
    return MillTool(length, radius, corner=row.corner, teeth=row.teeth, point=row.point, life=row.life)


def _figure(state: State, column: int, group: int, number: int, index: int) -> float:
    if (group, number) in _PLAIN:
        return _PLAIN[group, number](state, column)
    axis = _AXES.get(index, "")
    if axis in state.at:
        found = _of_axis(state, group, number, axis)
        if found is not None:
            return found / (state.scale if axis in "XYZ" else 1.0)
    if group == 200 and number in {1, 2, 3} and index in {1, 2, 3}:
        return _compensation(state, number, index) / state.scale
    if (group, number) == (210, 4) and index in {1, 2, 3}:
        return state.figure.factor
    raise _not_here(state, column, 18, group, number, index)


def _not_here(state: State, column: int, function: int, group: int, number: int, index: int) -> ProgramError:
    return unsupported(
        state.line,
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
    return 0.0 if state.feed is None else per_minute(state, state.feed, state.feed_per, column)


_PLAIN: Mapping[tuple[int, int], Callable[[State, int], float]] = {
    (20, 1): lambda state, _: float(state.modal.tool),
    (20, 3): lambda _state, _: 2.0,
    (20, 4): lambda state, _: state.modal.rpm,
    (20, 5): lambda state, _: OF_THE_CONTROL[110](state),
    (20, 8): lambda state, _: OF_THE_CONTROL[111](state),
    (20, 9): _feed,
    (25, 1): lambda _state, _: 1.0,
    (35, 1): lambda _state, _: 0.0,  # words without I are absolute
    (60, 1): lambda state, _: float(state.modal.tool),
    (60, 2): lambda _state, _: 2.0,
    (60, 3): lambda state, _: state.modal.rpm,
    (60, 4): lambda state, _: state.oversize[0] / state.scale,
    (60, 5): lambda state, _: state.oversize[1] / state.scale,
    (210, 1): lambda state, _: state.kinematics.basic_rotation,
    (210, 2): lambda state, _: state.figure.rotation,
    (210, 3): lambda state, _: float(sum(2 ** "XYZ".index(axis) for axis in state.figure.mirrored)),
    (210, 6): lambda state, _: -1.0 if state.plane is not None else 0.0,
    (230, 5): lambda _state, _: 0.0,  # the travel limits are always monitored
    (280, 1): lambda state, _: -1.0 if state.m128 else 0.0,
}


def _of_axis(state: State, group: int, number: int, axis: str) -> float | None:
    """Return a system value of one axis, in mm or degrees; None if it does not exist."""
    linear = axis in "XYZ"
    if number == 1 and group in {240, 270}:
        state.place_is_read()
    if (group, number) == (240, 1):
        return state.at[axis]
    if (group, number) == (270, 1):
        return state.programmed["XYZ".index(axis)] if linear else state.displayed["ABC".index(axis)]
    if (group, number) == (220, 2) and linear and state.plane is None:
        return state.origin["XYZ".index(axis)]
    if group == 230 and number in {2, 3}:
        bounds = {each.name: (each.low, each.high) for each in state.kinematics.slides}
        bounds |= {each.name: (each.low, each.high) for each in state.kinematics.rotaries}
        bound = bounds[axis][number - 2]
        return bound if math.isfinite(bound) else None
    return None


def _compensation(state: State, number: int, index: int) -> float:
    """Return the active radius, length or R2 in mm.

    With ``index`` 1, it is the table value; 2 adds the deltas of the table, and 3 also those of TOOL CALL.
    """
    row = _row(state, state.modal.tool) or MillTool()
    plain, off, called = {
        1: (row.radius, row.dr, state.oversize[1]),
        2: (row.length, row.dl, state.oversize[0]),
        3: (row.corner, row.dr2, 0.0),
    }[number]
    return plain + (off if index > 1 else 0.0) + (called if index > 2 else 0.0)
