"""Blocks that move nothing: labels, jumps and calls, Q parameters, figures of the control."""

from __future__ import annotations

import math

from core.interpreter.klartext.flow import system_data, word_values
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import State
from core.interpreter.shared.control_flow import ENDLESS, LoopWatch
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.klartext_faults import OWN_ERROR
from core.language.klartext.structure_blocks import MOST_REPEATS
from core.message import Message


def go_on(state: State, flow: Flow, line: int, node: nodes.Label | nodes.Call | nodes.Jump) -> None:
    """Labels, calls and jumps: where the program goes on. Raises ProgramError."""
    if isinstance(node, nodes.Label):
        flow.label(node)
    elif isinstance(node, nodes.Call):
        repeat = node.repeat or nodes.Value(0.0)
        times = word_values.number(state, repeat, "REP", MOST_REPEATS, 0.0)
        flow.call(line, node, math.floor(times))
    elif word_values.value(state, node.condition):
        flow.jump(node)


def refuse_endless(state: State, flow: Flow, watch: LoopWatch, line: int, node: nodes.Jump) -> None:
    """Raises ProgramError where a jump back comes round with all that jumps go by as it was before.

    That are the parameters and, for Q108 to Q114, the tool, the spindle and the coolant.
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
    """Q parameters and FN functions. Raises ProgramError, and for FN 14 always."""
    match node:
        case nodes.Assign():
            word_values.keep(state, node.kind, node.q, word_values.value(state, node.formula))
        case nodes.SystemRead():
            system_data.read_system(state, node)
        case nodes.SystemWrite():
            system_data.write_system(state, node)
        case nodes.ErrorMessage():
            text = Message("The program reports its own error {number} and stops.", number=node.number)
            hint = "Check the conditions under which the program reaches this block."
            raise state.refuse(node.column, OWN_ERROR, text, hint)
        case nodes.Unheeded():
            state.unheeded(node.what, node.column)
        case nodes.GlobalDef():
            for each in node.values:
                state.q_global[each.q] = word_values.value(state, each.formula)
