"""Proving: the same program, given to a checker, with block delete on and off.

Cycle Start goes by the switch as it stands. What is wrong with it the other way alone is a warning: to turn
the switch is to prove the program again.
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

# / is first on a line; SINUMERIK and Klartext let the number of the block stand before it.
_DELETED = {
    Dialect.OMNITURN: re.compile(r"^[^\S\n]*/", re.MULTILINE),
    Dialect.SINUMERIK: re.compile(r"^[^\S\n]*(?:[N:][^\S\n]*[0-9]+[^\S\n]*)?/", re.MULTILINE | re.IGNORECASE),
    Dialect.KLARTEXT: re.compile(r"^[^\S\n]*(?:[0-9]+[^\S\n]*)?/", re.MULTILINE),
}
__all__ = ["MAX_FINDINGS", "prove"]
Progress = Callable[[float], None]


def deletes_blocks(source: Source) -> bool:
    """Whether ``/`` stands before a line of the program or of its subprograms."""
    return ("/" in source.text and _DELETED[source.dialect].search(source.text) is not None) or any(
        map(deletes_blocks, source.subprograms)
    )


def with_the_other(report: Report, other: Report, *, deleted: bool) -> Report:
    """The report of the switch as it stands, with warnings of what was found with it the other way."""
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
    """Check a whole program: words, travel, times. ``progress`` hears how many blocks have passed.

    A program that others go through too is given as its one reading.

    The figures are those of the inputs and of block delete as ``setup`` has them; what the program does with
    other inputs, and with block delete the other way, is proved too, and found in ``diagnostics``.

    ``ideal``: times by feeds and limits of speed alone, without accelerations and waits.

    ``seen`` is given each span of the program laid out in time, as ``setup`` has it: whoever draws it needs
    no pass of his own.
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
    """The report with block delete as it stands, and all inputs both ways."""
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
