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
    from app.cli.figures.units import Json
    from app.report.run_record import RunRecord
    from core.language.source import Source
    from core.proving.proof_report import PartReport, Report


_ROOT = Path(__file__).parents[3]
_ROOMS = ("app/cli", "app/compose", "app/report", "core")  # folders with the code that affects a proof


@dataclass(frozen=True, slots=True)
class Proof:
    """Result of a proof: the JSON object, or the reason ``fault`` why the proof failed.

    ``section`` is the program's part of a report, if required. ``seconds`` is the duration of the proof, or 0
    for a proof from the cache.
    """

    report: Json
    section: str = ""
    fault: str = ""
    seconds: float = 0.0

    def count(self, severity: str) -> int:
        """Return the number of findings with this severity."""
        return sum(1 for _ in self.findings(severity))

    def findings(self, severity: str) -> Iterator[Json]:
        """Return an iterator over the findings with this severity."""
        found = self.report.get("diagnostics", [])
        assert isinstance(found, list)
        return (each for each in found if each["severity"] == severity)


class OtherVersionError(Exception):
    """The worker has another version of TurnDesk, so its proofs would differ."""


def proof_of(packed: bytes, version: str, source: Source) -> Proof:
    """Prove one program in a worker. Raises OtherVersionError unless the versions match.

    An empty ``version`` disables the check.
    """
    if version and version != code_version():
        raise OtherVersionError
    start = time.perf_counter()
    proof = proved(_unpacked(packed), source)
    return replace(proof, seconds=time.perf_counter() - start)


def proved(job: ProofJob, source: Source) -> Proof:
    """Prove one program in this process."""
    from app.cli.figures.proof_json import report_json

    found = findings(job, source)
    json = report_json(source.name, found.report, found.part, optional_stop=job.optional_stop)
    return Proof(json if found.compare is None else {**json, "compare": found.compare}, found.section)


class Findings(NamedTuple):
    """Results of one proof: report, part, section of a report (empty if not required) and comparison."""

    report: Report
    part: PartReport | None
    section: str = ""
    compare: Json | None = None


def findings(job: ProofJob, source: Source, progress: Callable[[float], None] | None = None) -> Findings:
    """Prove one program; make the comparison and the report section if the job requires them."""
    from core.proving.part_proof import prove_with_part, refusing_missing_offsets

    record = _record(job)
    see = record.see if record is not None else None
    around = (job.setup, job.machine, job.setting)
    report, part = prove_with_part(source, *around, progress, ideal=job.ideal, seen=see)
    report = refusing_missing_offsets(report, job.setup)
    compare: Json | None = None
    if job.other is not None:
        from app.cli.figures.compare_figures import compared

        compare = compared(job, source, report, part)
    if record is None:
        return Findings(report, part, "", compare)
    from app.report.report_page import ProgramReport, compared_part

    section = ProgramReport(source, report, part, record, job.machine, job.setup).html()
    if compare is not None:
        from app.cli.figures.compare_figures import compare_lines

        section += compared_part(compare_lines(compare, metric=report.metric, dialect=report.dialect))
    return Findings(report, part, section, compare)


def _record(job: ProofJob) -> RunRecord | None:
    """Return the recorder for a report, or None if no report is required."""
    if not job.reported:
        return None
    from app.report.run_record import RunRecord

    return RunRecord(job.setting)


@lru_cache(maxsize=4)
def _unpacked(packed: bytes) -> ProofJob:
    import pickle

    job: ProofJob = pickle.loads(packed)
    return job


@lru_cache(maxsize=1)
def code_version() -> str:
    """Return a hash of TurnDesk's code, because the version number does not change during development."""
    from hashlib import sha256

    total = sha256()
    for room in _ROOMS:
        for path in sorted((_ROOT / room).rglob("*.py")):
            total.update(path.relative_to(_ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return total.hexdigest()
