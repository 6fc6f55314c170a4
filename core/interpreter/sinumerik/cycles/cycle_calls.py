"""Calls of standard cycles: the selection of the cycle, and the contour of CYCLE95."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import CycleCall
from core.interpreter.sinumerik.cycles.drilling_cycles import (
    run_boring,
    run_boring_with_liftoff,
    run_drilling,
    run_peck_drilling,
    stop,
)
from core.interpreter.sinumerik.cycles.grooving_cycles import run_grooving, run_part_off
from core.interpreter.sinumerik.cycles.stock_removal import (
    WRONG_CONTOUR_DEFINITION,
    find_contour_lines,
    read_contour,
    run_stock_removal,
)
from core.interpreter.sinumerik.cycles.tapping_cycles import run_compensating_tapping, run_rigid_tapping
from core.interpreter.sinumerik.cycles.thread_cycle import run_chain_threading, run_threading
from core.interpreter.sinumerik.cycles.undercut_cycles import (
    run_shoulder_undercut,
    run_thread_undercut,
    run_undercut,
)
from core.interpreter.sinumerik.flow.subprogram_flow import SinumerikProgramFlow
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.sinumerik.cycle_names import IGNORED_CYCLES, SWIVEL_CYCLE
from core.language.sinumerik.sinumerik_words import LexedBlock
from core.message import Message

_CYCLE_FUNCTIONS: Mapping[str, Callable[[CycleCall], Iterator[Block]]] = {
    "CYCLE81": run_drilling,
    "CYCLE82": run_drilling,
    "CYCLE83": run_peck_drilling,
    "CYCLE84": run_rigid_tapping,
    "CYCLE840": run_compensating_tapping,
    "CYCLE85": run_boring,
    "CYCLE86": run_boring_with_liftoff,
    "CYCLE87": stop,
    "CYCLE88": stop,
    "CYCLE89": run_boring,
    "CYCLE92": run_part_off,
    "CYCLE93": run_grooving,
    "CYCLE94": run_shoulder_undercut,
    "CYCLE940": run_undercut,
    "CYCLE96": run_thread_undercut,
    "CYCLE97": run_threading,
    "CYCLE98": run_chain_threading,
    "CYCLE99": run_threading,
}


def generate_cycle_blocks(
    state: SinumerikState, line: LexedBlock, flow: SinumerikProgramFlow
) -> Iterator[Block]:
    """Return an iterator over the blocks of a standard cycle.

    Raises ProgramError before the first block if the call is invalid.
    """
    cycle = CycleCall(state, line)
    if line.called_name == "CYCLE95":
        return run_stock_removal(cycle, _contour(cycle, flow))
    return _CYCLE_FUNCTIONS[line.called_name](cycle)


def _contour(cycle: CycleCall, flow: SinumerikProgramFlow) -> list[Element]:
    named = cycle.read_string("NPP")
    hint = 'Write "NAME" for a subprogram, or "START:END" for two labels.'
    cycle.check_parameter(
        named, "NPP", "{name} does not contain the name of a contour", hint, WRONG_CONTOUR_DEFINITION
    )
    known = flow.find_routine(named)
    lines = find_contour_lines(named, flow.active_routine, known)
    if lines is None:
        if ":" in named:
            text = "{name} refers to labels that do not exist: {named}"
            raise cycle.make_parameter_error(
                "NPP", text, "Correct the entries named in the message.", 14080, named=named
            )
        text = "{name} refers to subprogram {named}, which does not exist"
        hint = (
            "Put {named}.spf in the main program's folder, or add %_N_{named2}_SPF to the main program's "
            "file."
        )
        raise cycle.make_parameter_error("NPP", text, hint, "subprogram-missing", named=named, named2=named)
    file_name, log = "" if known is None else known.displayed_name, DiagnosticLog()
    try:
        return read_contour(cycle.state, lines, log)
    except ProgramError as problem:
        if not file_name:
            raise
        raise ProgramError(_relocate_finding(cycle.line, file_name, problem.diagnostic)) from None
    finally:
        for each in log.findings:
            cycle.state.log_finding(_relocate_finding(cycle.line, file_name, each) if file_name else each)


def _relocate_finding(line: LexedBlock, file_name: str, finding: Diagnostic) -> Diagnostic:
    """Return a finding in the contour's file as a finding at the line of the cycle call."""
    message = Message(
        "{source} line {line}: {value}", source=file_name, line=finding.line, value=finding.message
    )
    return replace(finding, line=line.line_number, column=line.call_column, message=message)


def log_ineffective_cycle(state: SinumerikState, line: LexedBlock) -> None:
    """Log a note, only once, that a cycle has no effect on this machine.

    Raises ProgramError if the parameters of the cycle are not supported.
    """
    if line.called_name == SWIVEL_CYCLE and any(each.is_specified for each in line.arguments or ()):
        text = "CYCLE800: this lathe has no swivel head."
        raise line.make_error(line.call_column, "not-in-subset", text, "Remove this text from the program.")
    if line.called_name not in state.logged_functions:
        state.logged_functions.add(line.called_name)
        why = Message(
            "{name} has no effect because {why}.",
            name=line.called_name,
            why=IGNORED_CYCLES[line.called_name],
        )
        found = line.make_error(line.call_column, "no-effect", why, "").diagnostic
        state.log_finding(replace(found, severity=Severity.NOTE))
