"""Blocks that move nothing: labels, jumps and calls, Q parameters, figures of the control."""

from __future__ import annotations

import math
from copy import deepcopy

from core.interpreter.endless_loops import ENDLESS, LoopWatch
from core.interpreter.klartext import q_functions, system_data, word_values
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import State
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.structure_blocks import MOST_REPEATS


def go_on(state: State, flow: Flow, line: int, node: nodes.Label | nodes.Call | nodes.Jump) -> None:
    """Labels, calls and jumps: where the program goes on."""
    if isinstance(node, nodes.Label):
        flow.label(node)
    elif isinstance(node, nodes.Call):
        repeat = node.repeat or nodes.Value(0.0)
        times = word_values.number(state, repeat, "REP", MOST_REPEATS, 0.0)
        flow.call(line, node, math.floor(times))
    elif q_functions.jumps(state, node):
        flow.jump(node)


class EndlessJumps:
    """Jumps back of one pass that come round unchanged. Not where FN 18 reads what no parameter shows."""

    def __init__(self, flow: Flow) -> None:
        self._loops = None if flow.reads_the_control else LoopWatch()

    def look(self, state: State, flow: Flow, line: int, node: nodes.Jump) -> None:
        """A jump was executed. Raises ProgramError where it has met all that jumps go by before."""
        if self._loops is None or not flow.jumped_back(line):
            return
        stands = line, flow.standing(), _of_the_tool(state)
        held = state.q, state.q_beside, state.q_global, state.selected_program
        if self._loops.comes_round((stands, held), lambda: (stands, deepcopy(held))):
            text = "This jump repeats forever because the loop does not change anything that affects a jump."
            raise state.refuse(
                node.column,
                ENDLESS,
                text,
                "In the loop, change a Q parameter that the jump condition uses.",
            )


def _of_the_tool(state: State) -> tuple[object, ...]:
    """What Q108 to Q114 show."""
    return state.tool_radius, state.tool_length, state.tool_axis, state.modal.spindle, state.modal.coolant


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
            q_functions.assign(state, node)
        case nodes.SystemRead():
            system_data.read_system(state, node)
        case nodes.SystemWrite():
            system_data.write_system(state, node)
        case nodes.ErrorMessage():
            raise q_functions.own_error(state, node)
        case nodes.Unheeded():
            state.unheeded(node.what, node.column)
        case nodes.GlobalDef():
            q_functions.predefine(state, node)
