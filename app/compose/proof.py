"""From what proving reports to what the executor demands before it starts."""

from __future__ import annotations

from core.executor.job import Job, Proof
from core.proving.proof_report import Report


def proof_of(job: Job, report: Report) -> Proof:
    """The proof of this job; the report must be of this job's text and circumstances."""
    return Proof(
        digest=job.digest,
        errors=tuple(d.shown(job.source.name) for d in report.errors),
        blocks=report.elementary,
        cycle_time=report.times.cycle,
        tools=report.tools,
        needs=report.needs,
    )
