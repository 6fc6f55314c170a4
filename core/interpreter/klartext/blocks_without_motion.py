"""Blocks that move nothing: labels, jumps and calls, Q parameters, texts, figures of the control, tables."""

from __future__ import annotations

import math
from copy import deepcopy
from dataclasses import replace

from core.interpreter.endless_loops import ENDLESS, LoopWatch
from core.interpreter.klartext import q_functions, system_data, text_values, word_values
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.text_values import text_of, texts_agree
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.klartext_faults import LABEL
from core.language.klartext.structure_blocks import MOST_REPEATS
from core.message import Message


def go_on(state: State, flow: Flow, line: int, node: nodes.Label | nodes.Call | nodes.Jump) -> None:
    """Labels, calls and jumps: where the program goes on."""
    if isinstance(node, nodes.Label):
        flow.label(node)
    elif isinstance(node, nodes.Call):
        node = replace(node, name=_label(state, flow, node.name, subprogram=node.repeat is None))
        repeat = node.repeat or nodes.Value(0.0)
        times = word_values.number(state, repeat, "REP", MOST_REPEATS, 0.0)
        flow.call(line, node, math.floor(times))
    elif texts_agree(state, node) if node.texts else q_functions.jumps(state, node):
        flow.jump(replace(node, name=_label(state, flow, node.name, subprogram=False)))


class EndlessJumps:
    """Jumps back of one pass that come round unchanged. Not where FN 18 reads what no parameter shows."""

    def __init__(self, flow: Flow) -> None:
        self._loops = None if flow.reads_the_control else LoopWatch()

    def look(self, state: State, flow: Flow, line: int, node: nodes.Jump) -> None:
        """A jump was executed. Raises ProgramError where it has met all that jumps go by before."""
        if self._loops is None or not flow.jumped_back(line):
            return
        stands = line, flow.standing(), _of_the_tool(state)
        held = (
            state.q,
            state.q_beside,
            state.texts,
            state.q_global,
            state.free_table,
            state.selected_program,
        )
        if self._loops.comes_round((stands, held), lambda: (stands, deepcopy(held))):
            text = "This jump repeats forever because the loop does not change anything that affects a jump."
            raise state.refuse(
                node.column,
                ENDLESS,
                text,
                ("In the loop, change a Q parameter that the jump condition uses."),
            )


def _of_the_tool(state: State) -> tuple[object, ...]:
    """What Q108 to Q114 show."""
    return state.tool_radius, state.tool_length, state.tool_axis, state.modal.spindle, state.modal.coolant


def _label(state: State, flow: Flow, name: int | str | nodes.TextName, *, subprogram: bool) -> int | str:
    """A label as written, which was looked for when the program was read, or by the text of QS.

    Raises ProgramError for one by text that is not there, or is no subprogram though it is to be one.
    """
    if not isinstance(name, nodes.TextName):
        return name
    found = text_of(state, name)
    at = flow.program.labels.get(found)
    if at is None or (subprogram and flow.program.subprogram_end(at) is None):
        text = Message('LBL "{value}" is not in the program or has no LBL 0.', value=found)
        raise state.refuse(
            name.column, LABEL, text, ("Correct the label name in the QS parameter, or add the label.")
        )
    return found


Reckoned = (
    nodes.Assign
    | nodes.SystemRead
    | nodes.SystemWrite
    | nodes.ErrorMessage
    | nodes.Unheeded
    | nodes.GlobalDef
    | nodes.TextAssign
    | nodes.TextRead
    | nodes.TableRead
    | nodes.TableWrite
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
        case _:
            _read_or_write(state, node)


def _read_or_write(
    state: State, node: nodes.TextAssign | nodes.TextRead | nodes.TableRead | nodes.TableWrite
) -> None:
    """Texts and free tables. Raises ProgramError."""
    match node:
        case nodes.TextAssign():
            text_values.assign_text(state, node)
        case nodes.TextRead():
            text_values.read_text(state, node)
        case nodes.TableRead():
            text_values.read_cells(state, node)
        case nodes.TableWrite():
            text_values.write_cells(state, node)
