"""What can be said about a program and its circumstances before the first block."""

from __future__ import annotations

from core.interpreter.count import refuse_too_large
from core.interpreter.log import Log, refusal
from core.interpreter.mcodes import check_m_codes
from core.interpreter.program import Program
from core.interpreter.state import State
from core.interpreter.statement import UNREADABLE, Statement


def check_opening(state: State, program: Program) -> tuple[int, bool]:
    """Number of the first line to execute (0: none), and whether the program is too large to be begun."""
    log = state.log
    check_m_codes(state, program.m_codes)
    begin = state.setup.begin
    alone = begin is not None and begin.single
    first = 0 if alone else _first_line(program, log, block_delete=state.setup.block_delete)
    if begin is not None and alone and begin.checkpoint.modal.absolute is None:
        _refuse_move(program, log)
    large = refuse_too_large(program, state.setup.inputs)
    if large is not None:
        log.add(large)
    if state.setup.metric and not program.names_units and first:
        text = "The program names neither G70 nor G71; it runs in millimetres, in which the control counts."
        log.warn(first, 0, "units-unnamed", text, "Write G70 or G71 on the first line.")
    return first, large is not None


def _refuse_move(program: Program, log: Log) -> None:
    """MDI after power-up or M30: neither G90 nor G91 is in force, so X and Z have no meaning yet."""
    step = program.steps[0]
    named = isinstance(step, Statement) and {90, 91}.intersection(step.modal)
    moves = isinstance(step, tuple) or (step is not None and {"X", "Z"}.intersection(step.words))
    if moves and not named:
        text = "Neither G90 (absolute) nor G91 (incremental) is in force."
        log.add(refusal(1, 1, "first-line", text, "Say one of them first."))


def _first_line(program: Program, log: Log, *, block_delete: bool) -> int:
    """Number of the first line to execute, 0 where there is none; it must say G90 or G91."""
    for number, step in enumerate(program.steps, start=1):
        if step is None:
            continue
        if isinstance(step, Statement):
            if not step.executable or (block_delete and step.block_delete):
                continue
            if step.flow == UNREADABLE or {90, 91}.intersection(step.modal):
                return number
        text = "The first line must say G90 (absolute) or G91 (incremental)."
        log.add(refusal(number, 1, "first-line", text, "Begin with G90G94F300."))
        return number
    return 0
