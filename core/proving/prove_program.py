"""Proof of a program for both positions of the block delete switch.

Cycle Start uses the current position. A fault that occurs only in the other position is a warning, because
the program is proved again when the switch position changes.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Severity
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.message import Message
from core.proving.checks.machine_checks import CuttingChecks
from core.proving.program_branches import BranchProof
from core.proving.program_timeline import MotionSpan, RestSpan, Timeline
from core.proving.proof_pass import MAX_FINDINGS, ProofPass
from core.proving.proof_report import BranchSummary, ProofReport, sort_findings

# The character / is first on a line. SINUMERIK and Klartext permit a block number before it.
_BLOCK_DELETE_PATTERNS = {
    Dialect.OMNITURN: re.compile(r"^[^\S\n]*/", re.MULTILINE),
    Dialect.SINUMERIK: re.compile(r"^[^\S\n]*(?:[N:][^\S\n]*[0-9]+[^\S\n]*)?/", re.MULTILINE | re.IGNORECASE),
    Dialect.KLARTEXT: re.compile(r"^[^\S\n]*(?:[0-9]+[^\S\n]*)?/", re.MULTILINE),
}
__all__ = ["MAX_FINDINGS", "prove"]
ReportProgress = Callable[[float], None]


def uses_block_delete(source: ProgramSource) -> bool:
    """Return whether any line of the program or of its subprograms starts with ``/``."""
    return (
        "/" in source.text and _BLOCK_DELETE_PATTERNS[source.dialect].search(source.text) is not None
    ) or any(map(uses_block_delete, source.subprograms))


def add_block_delete_warnings(
    report: ProofReport, other_report: ProofReport, *, is_delete_on: bool
) -> ProofReport:
    """Return the report with a warning for each fault that occurs only in ``other_report``.

    ``other_report`` is the report for the other position of block delete.
    """
    known = {(found.line, found.code, found.severity) for found in report.diagnostics}
    switch = "on" if is_delete_on else "off"
    found = [
        replace(
            each,
            severity=Severity.WARNING,
            message=Message("With block delete {switch}: {item}", switch=switch, item=each.message),
        )
        for each in other_report.diagnostics
        if each.severity is not Severity.NOTE and (each.line, each.code, each.severity) not in known
    ]
    (low, high), (other_low, other_high) = (
        report.branch_summary.cycle_time_range,
        other_report.branch_summary.cycle_time_range,
    )
    return replace(
        report,
        diagnostics=sort_findings([*report.diagnostics, *found]),
        branch_summary=BranchSummary(
            report.branch_summary.proved_count + other_report.branch_summary.proved_count,
            report.branch_summary.unproved_count + other_report.branch_summary.unproved_count,
            (min(low, other_low), max(high, other_high)),
        ),
    )


def prove(
    program: ProgramSource | SharedProgram,
    setup: InterpreterSetup,
    machine: Machine,
    report_progress: ReportProgress | None = None,
    *,
    is_ideal: bool = False,
    on_span: Callable[[MotionSpan | RestSpan], None] | None = None,
) -> ProofReport:
    """Return the proof of a whole program: syntax, travel and times.

    ``report_progress`` receives the number of completed blocks. If other code also uses the program, pass
    its parsed form.

    The values apply to the inputs and the block delete of ``setup``. Other inputs and the other position of
    block delete are also proved; their faults are in the diagnostics of the report. If ``is_ideal`` is
    True, times depend only on feeds and speed limits, without accelerations and waits. ``on_span`` receives
    each span of the timeline, so that a caller that draws the path does not need to interpret the program
    again.
    """
    reading = program if isinstance(program, SharedProgram) else SharedProgram(program, strict=setup.strict)
    report = _prove_branches(reading, setup, machine, report_progress, on_span, ideal=is_ideal)
    if not uses_block_delete(reading.source) or (setup.begin is not None and setup.begin.is_mdi_line):
        return report
    flipped = replace(setup, block_delete=not setup.block_delete)
    other = _prove_branches(reading, flipped, machine, report_progress, None, ideal=is_ideal)
    return add_block_delete_warnings(report, other, is_delete_on=flipped.block_delete)


def _prove_branches(
    reading: SharedProgram,
    setup: InterpreterSetup,
    machine: Machine,
    progress: ReportProgress | None,
    on_span: Callable[[MotionSpan | RestSpan], None] | None,
    *,
    ideal: bool,
) -> ProofReport:
    """Return the report for one position of block delete and both states of all inputs."""
    branches = BranchProof(reading, setup, machine, ideal=ideal)
    timeline = Timeline(branches.root_pass or reading.start_pass(setup), setup, machine, ideal=ideal)
    single = setup.begin is not None and setup.begin.is_mdi_line
    checks = CuttingChecks(machine, reading.source.dialect, single, is_position_known=setup.begin is not None)
    proof_pass = ProofPass(machine, checks)
    for span in branches.iter_spans(proof_pass, timeline):
        proof_pass.add_span(span)
        if on_span is not None:
            on_span(span)
        if progress is not None and proof_pass.last_block is not None:
            progress(proof_pass.last_block.n)
    report = proof_pass.make_report(timeline, reading.source)
    return branches.report_all_branches(report, progress)
