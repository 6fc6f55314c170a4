"""Calls of standard cycles: selection of the cycle, and the contour of CYCLE95."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import Cycle
from core.interpreter.sinumerik.cycles.drilling_cycles import bore, drill, lift_off, peck, stop
from core.interpreter.sinumerik.cycles.grooving_cycles import groove, part_off
from core.interpreter.sinumerik.cycles.stock_removal import (
    WRONG_CONTOUR,
    contour_lines,
    read_contour,
    stock_removal,
)
from core.interpreter.sinumerik.cycles.tapping_cycles import compensating, rigid
from core.interpreter.sinumerik.cycles.thread_cycle import thread_chain, thread_cycle
from core.interpreter.sinumerik.cycles.undercut_cycles import shoulder_undercut, thread_undercut, undercut
from core.interpreter.sinumerik.flow.subprogram_flow import Flow
from core.interpreter.sinumerik.sinumerik_state import State
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.sinumerik.sinumerik_words import Line
from core.message import Message

_RUN: Mapping[str, Callable[[Cycle], Iterator[Block]]] = {
    "CYCLE81": drill,
    "CYCLE82": drill,
    "CYCLE83": peck,
    "CYCLE84": rigid,
    "CYCLE840": compensating,
    "CYCLE85": bore,
    "CYCLE86": lift_off,
    "CYCLE87": stop,
    "CYCLE88": stop,
    "CYCLE89": bore,
    "CYCLE92": part_off,
    "CYCLE93": groove,
    "CYCLE94": shoulder_undercut,
    "CYCLE940": undercut,
    "CYCLE96": thread_undercut,
    "CYCLE97": thread_cycle,
    "CYCLE98": thread_chain,
    "CYCLE99": thread_cycle,
}


def cycle_blocks(state: State, line: Line, flow: Flow) -> Iterator[Block]:
    """Return an iterator of the blocks of a standard cycle. Raises ProgramError before the first block."""
    cycle = Cycle(state, line)
    if line.call == "CYCLE95":
        return stock_removal(cycle, _contour(cycle, flow))
    return _RUN[line.call](cycle)


def _contour(cycle: Cycle, flow: Flow) -> list[Element]:
    named = cycle.text("NPP")
    hint = 'Write "NAME" for a subprogram, or "START:END" for two labels.'
    cycle.check(named, "NPP", "{name} does not contain the name of a contour", hint, WRONG_CONTOUR)
    known = flow.routine(named)
    lines = contour_lines(named, flow.running, known)
    if lines is None:
        if ":" in named:
            text = "{name} refers to labels that do not exist: {named}"
            raise cycle.wrong("NPP", text, "Correct the entries named in the message.", 14080, named=named)
        text = "{name} refers to subprogram {named}, which does not exist"
        hint = (
            "Put {named}.spf in the main program's folder, or add %_N_{named2}_SPF to the main program's "
            "file."
        )
        raise cycle.wrong("NPP", text, hint, "subprogram-missing", named=named, named2=named)
    try:
        return read_contour(cycle.state, lines)
    except ProgramError as problem:
        if known is None or not known.shown:
            raise
        raise ProgramError(_told_at(cycle.line, known.shown, problem.diagnostic)) from None


def _told_at(line: Line, shown: str, found: Diagnostic) -> Diagnostic:
    """Return an error in the contour's file as a finding at the line of the cycle."""
    message = Message("{source} line {line}: {value}", source=shown, line=found.line, value=found.message)
    return replace(found, line=line.number, column=line.call_column, message=message)
