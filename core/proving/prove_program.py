"""Proof of a program, with block delete both on and off.

Cycle Start uses the present position of the switch. A fault that occurs only in the other position is a
warning, because the program is proved again when the switch is turned.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.job_setup import Setup
from core.language.diagnostics import Severity
from core.language.source import Dialect, Source
from core.machine.machine_model import Machine
from core.message import Message
from core.proving.checks.machine_checks import CuttingChecks
from core.proving.program_branches import Branches
from core.proving.program_timeline import MotionSpan, RestSpan, Timeline
from core.proving.proof_pass import MAX_FINDINGS, ProofPass
from core.proving.proof_report import Report, Ways, in_order

# The character / is first on a line. SINUMERIK and Klartext permit a block number before it.
_DELETED = {
    Dialect.OMNITURN: re.compile(r"^[^\S\n]*/", re.MULTILINE),
    Dialect.SINUMERIK: re.compile(r"^[^\S\n]*(?:[N:][^\S\n]*[0-9]+[^\S\n]*)?/", re.MULTILINE | re.IGNORECASE),
    Dialect.KLARTEXT: re.compile(r"^[^\S\n]*(?:[0-9]+[^\S\n]*)?/", re.MULTILINE),
}
__all__ = ["MAX_FINDINGS", "prove"]
Progress = Callable[[float], None]


def deletes_blocks(source: Source) -> bool:
    """Return whether any line of the program or of its subprograms starts with ``/``."""
    return ("/" in source.text and _DELETED[source.dialect].search(source.text) is not None) or any(
        map(deletes_blocks, source.subprograms)
    )


def with_the_other(report: Report, other: Report, *, deleted: bool) -> Report:
    """Return the report with warnings for faults that occur only in the other position of block delete."""
    known = {(found.line, found.code, found.severity) for found in report.diagnostics}
    switch = "on" if deleted else "off"
    found = [
        replace(
            each,
            severity=Severity.WARNING,
            message=Message("With block delete {switch}: {item}", switch=switch, item=each.message),
        )
        for each in other.diagnostics
        if each.severity is not Severity.NOTE and (each.line, each.code, each.severity) not in known
    ]
    (low, high), (other_low, other_high) = report.ways.cycle, other.ways.cycle
    return replace(
        report,
        diagnostics=in_order([*report.diagnostics, *found]),
        ways=Ways(
            report.ways.proved + other.ways.proved,
            report.ways.unproved + other.ways.unproved,
            (min(low, other_low), max(high, other_high)),
        ),
    )


def prove(
    program: Source | ReadProgram,
    setup: Setup,
    machine: Machine,
    progress: Progress | None = None,
    *,
    ideal: bool = False,
    seen: Callable[[MotionSpan | RestSpan], None] | None = None,
) -> Report:
    """Check a whole program: syntax, travel and times. ``progress`` receives the number of blocks done.

    A program that other code also uses should be passed in its parsed form.

    The values apply to the inputs and the block delete of ``setup``. Other inputs and the other position of
    block delete are also proved, with their faults in ``diagnostics``. With ``ideal``, times depend on feeds
    and speed limits only, without accelerations and waits. ``seen`` receives each span of the timeline, so
    that a caller who draws the program needs no second pass.
    """
    reading = program if isinstance(program, ReadProgram) else ReadProgram(program, strict=setup.strict)
    report = _proved(reading, setup, machine, progress, seen, ideal=ideal)
    if not deletes_blocks(reading.source) or (setup.begin is not None and setup.begin.single):
        return report
    flipped = replace(setup, block_delete=not setup.block_delete)
    other = _proved(reading, flipped, machine, progress, None, ideal=ideal)
    return with_the_other(report, other, deleted=flipped.block_delete)


def _proved(
    reading: ReadProgram,
    setup: Setup,
    machine: Machine,
    progress: Progress | None,
    seen: Callable[[MotionSpan | RestSpan], None] | None,
    *,
    ideal: bool,
) -> Report:
    """Return the report for one position of block delete and both states of all inputs."""
    branches = Branches(reading, setup, machine, ideal=ideal)
    timeline = Timeline(branches.root or reading.begin(setup), setup, machine, ideal=ideal)
    single = setup.begin is not None and setup.begin.single
    checks = CuttingChecks(machine, reading.source.dialect, single, placed=setup.begin is not None)
    proof_pass = ProofPass(machine, checks)
    for span in branches.spans(proof_pass, timeline):
        proof_pass.add(span)
        if seen is not None:
            seen(span)
        if progress is not None and proof_pass.last is not None:
            progress(proof_pass.last.n)
    report = proof_pass.report(timeline, reading.source)
    return branches.report_of_all(report, progress)
