"""What MDI says of a line besides what proving says, and what the prompt line asks for next."""

from __future__ import annotations

from app.desk.session import Proved
from app.desk.words import tr
from core.executor.job import Job
from core.language.diagnostics import Diagnostic, Severity


def prompt(start: str, *, busy: bool, wrong: bool, ready: bool) -> str:
    """What can be done at rest; ``start`` names what starts a cycle here."""
    if busy:
        return tr("PROVING THE LINE")
    if wrong:
        return tr("THE LINE DOES NOT RUN: MEND IT, OR ESC TO CLEAR IT")
    if ready:
        return tr("TO RUN THE LINE {start}; ESC TAKES IT BACK").format(start=start)
    return tr("TYPE A LINE, ENTER PROVES IT; F1 LEAVES, THE SPINDLE STAYS AS IT IS")


def never_set(job: Job, proved: Proved) -> tuple[Diagnostic, ...]:
    """An error for each tool that the line calls and nobody has set."""
    missing = sorted(set(proved.proof.tools) - job.tools_set)
    text = "Tool {number} was never set."
    return tuple(
        Diagnostic(1, 0, Severity.ERROR, "tool-never-set", text.format(number=number), "Set it with F8.")
        for number in missing
    )
