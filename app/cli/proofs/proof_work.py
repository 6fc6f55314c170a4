"""Proof of one program as a unit of work that can be sent to another process or computer."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.cli.proofs.proof_job import ProofJob

if TYPE_CHECKING:
    from app.cli.outputs.units import Json
    from app.report.run_record import ReportRecorder
    from core.language.source import ProgramSource
    from core.proving.proof_report import PartReport, ProofReport


_ROOT = Path(__file__).parents[3]
_CODE_FOLDERS = ("app/cli", "app/compose", "app/report", "core")  # folders with the code that affects a proof


@dataclass(frozen=True, slots=True)
class Proof:
    """Result of a proof: the JSON object ``report``, or ``failure_reason`` if proving failed.

    ``report_section`` is the program's section of a report, if one is required. ``duration_s`` is the
    duration of the proof in seconds, or 0 for a proof from the cache.
    """

    report_json: Json
    report_section: str = ""
    failure_reason: str = ""
    duration_s: float = 0.0

    def count_findings(self, severity: str) -> int:
        """Return the number of findings with this severity."""
        return sum(1 for _ in self.iterate_findings(severity))

    def iterate_findings(self, severity: str) -> Iterator[Json]:
        """Return an iterator over the findings with this severity."""
        found = self.report_json.get("diagnostics", [])
        assert isinstance(found, list)
        return (each for each in found if each["severity"] == severity)


class VersionMismatchError(Exception):
    """Error raised because a worker with another TurnDesk version could prove programs differently."""


def prove_pickled_program(pickled_job: bytes, version: str, source: ProgramSource) -> Proof:
    """Prove one program in a worker. Raises VersionMismatchError if the versions differ.

    An empty ``version`` disables the check.
    """
    if version and version != get_code_hash():
        raise VersionMismatchError
    start = time.perf_counter()
    proof = prove_program(_unpacked(pickled_job), source)
    return replace(proof, duration_s=time.perf_counter() - start)


def prove_program(job: ProofJob, source: ProgramSource) -> Proof:
    """Prove one program in this process."""
    from app.cli.outputs.proof_output import make_report_json

    found = prove_with_comparison(job, source)
    json = make_report_json(
        source.name, found.report, found.part_report, optional_stop=job.is_optional_stop_on
    )
    return Proof(
        json if found.comparison_json is None else {**json, "compare": found.comparison_json},
        found.report_section,
    )


class ProofResult(NamedTuple):
    """Results of one proof with the comparison and the report section, which may be empty."""

    report: ProofReport
    part_report: PartReport | None
    report_section: str = ""
    comparison_json: Json | None = None


def prove_with_comparison(
    job: ProofJob, source: ProgramSource, report_progress: Callable[[float], None] | None = None
) -> ProofResult:
    """Prove one program, and add the comparison and the report section if the job requires them."""
    from core.proving.part_proof import prove_program_and_part, require_tool_offsets

    record = _run_record(job)
    see = record.add_time_span if record is not None else None
    around = (job.setup, job.machine, job.part_settings)
    report, part = prove_program_and_part(
        source, *around, report_progress, is_ideal=job.uses_ideal_times, on_span=see
    )
    report = require_tool_offsets(report, job.setup)
    compare: Json | None = None
    if job.comparison_offsets is not None:
        from app.cli.outputs.comparison_output import make_comparison_json

        compare = make_comparison_json(job, source, report, part)
    if record is None:
        return ProofResult(report, part, "", compare)
    from app.report.report_page import ProgramReport, make_offset_comparison

    section = ProgramReport(source, report, part, record, job.machine, job.setup).make_html()
    if compare is not None:
        from app.cli.outputs.comparison_output import format_comparison

        section += make_offset_comparison(
            format_comparison(compare, is_metric=report.is_metric, dialect=report.dialect)
        )
    return ProofResult(report, part, section, compare)


def _run_record(job: ProofJob) -> ReportRecorder | None:
    """Return the recorder of run data for a report, or None if the job requires no report."""
    if not job.needs_report_section:
        return None
    from app.report.run_record import ReportRecorder

    return ReportRecorder(job.part_settings)


@lru_cache(maxsize=4)
def _unpacked(packed: bytes) -> ProofJob:
    import pickle

    job: ProofJob = pickle.loads(packed)
    return job


@lru_cache(maxsize=1)
def get_code_hash() -> str:
    """Return a hash of TurnDesk's code, because the version number can stay the same between changes."""
    from hashlib import sha256

    total = sha256()
    for room in _CODE_FOLDERS:
        for path in sorted((_ROOT / room).rglob("*.py")):
            total.update(path.relative_to(_ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return total.hexdigest()
