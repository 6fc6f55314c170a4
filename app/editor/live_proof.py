"""Live proof of the program text while the operator types.

A worker proves only the latest text, so that typing is never delayed.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

from app.desk.background_work import LatestRequestWorker, WorkRequest
from app.desk.programs.program_loading import LoadingSteps
from core.interpreter.dialects import get_code_book
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource
from core.message import Message

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture
    from core.language.code_book import CodeBook

QUIET_TIME_S = 0.008  # seconds without a key press before proving starts
MAX_DELAY_S = 0.03  # maximum seconds by which typing delays proving
GRACE_TIME_S = 0.2  # seconds of work after which a newer text interrupts the worker
_SEVERITY_WEIGHTS = {Severity.ERROR: 2, Severity.WARNING: 1, Severity.NOTE: 0}


@dataclass(frozen=True, slots=True)
class ProofFindings:
    """Findings of the proof of one text. ``number`` identifies the text.

    ``picture`` may still show an older text.
    """

    number: int = 0
    diagnostics: tuple[Diagnostic, ...] = ()
    line_findings: dict[int, Diagnostic] = field(default_factory=dict)  # most severe finding of each line
    picture: ProgramPicture | None = None
    cycle_time_s: float = 0.0
    block_count: int = 0
    error_text: str = ""  # reason why the text could not be proved
    code_book: CodeBook | None = None  # code book of the text's language

    @property
    def error_count(self) -> int:
        """Return the number of errors. A program with errors cannot run."""
        return sum(d.severity is Severity.ERROR for d in self.diagnostics)

    @property
    def warning_count(self) -> int:
        """Return the number of warnings."""
        return sum(d.severity is Severity.WARNING for d in self.diagnostics)


def map_findings_by_line(diagnostics: tuple[Diagnostic, ...]) -> dict[int, Diagnostic]:
    """Return the most severe finding of each line, by line number.

    If several findings of a line have the same severity, the first one is returned. Line 0 represents the
    whole file.
    """
    found: dict[int, Diagnostic] = {}
    for one in diagnostics:
        there = found.get(one.line)
        if there is None or _SEVERITY_WEIGHTS[one.severity] > _SEVERITY_WEIGHTS[there.severity]:
            found[one.line] = one
    return found


@dataclass(slots=True)
class LiveProof:
    """Live proof of the latest text.

    ``submit_text`` and ``current_findings`` never block. Only the latest text is proved.
    """

    loading_steps: LoadingSteps
    worker: LatestRequestWorker = field(
        default_factory=lambda: LatestRequestWorker(
            "editing-proof", quiet_time_s=QUIET_TIME_S, max_delay_s=MAX_DELAY_S, grace_time_s=GRACE_TIME_S
        )
    )
    _now: ProofFindings = field(default_factory=ProofFindings)
    _number: int = 0

    @property
    def current_findings(self) -> ProofFindings:
        """Return the latest available findings.

        If the worker fails, ``error_text`` of the findings contains the reason.
        """
        self.worker.deliver_results()
        return self._now

    @property
    def is_outdated(self) -> bool:
        """Return whether a text newer than the one in ``current_findings`` still has to be proved."""
        return self.worker.is_busy

    def submit_text(self, name: str, text: str, block_delete: bool = False) -> int:
        """Submit the current text for proving, and return its number."""
        self._number += 1
        work = partial(self._prove_text, self._number, ProgramSource(name, text), block_delete)
        self.worker.request_work(work, self._show, self._failed)
        return self._number

    def clear_findings(self) -> None:
        """Clear the findings before another document opens."""
        self._number += 1
        self._now = ProofFindings(self._number)

    def cancel_proof(self) -> None:
        """Cancel the current proof, because its text has changed."""
        self.worker.cancel_request()

    def show_adjusted_findings(self, findings: ProofFindings) -> None:
        """Show adjusted findings until the next proof."""
        self._now = findings

    def close(self) -> None:
        """Cancel the current proof and stop the worker."""
        self.worker.close()

    def _prove_text(
        self, number: int, source: ProgramSource, block_delete: bool, request: WorkRequest
    ) -> ProofFindings:
        """Prove a text on the worker.

        The findings of the program proof are published first. The picture and the findings about the part
        follow later.
        """
        job = self.loading_steps.make_job(source, block_delete)
        proved = self.loading_steps.prove_job(job, request)
        found, proof = proved.diagnostics, proved.proof
        before = self._now.picture
        book = get_code_book(source.dialect).compile_patterns()
        findings = ProofFindings(
            number,
            found,
            map_findings_by_line(found),
            before,
            proof.cycle_time_s,
            proof.block_count,
            code_book=book,
        )
        request.publish_result(partial(self._show, findings))
        picture = self.loading_steps.draw_path(job, request)
        findings = replace(findings, picture=picture)
        request.publish_result(partial(self._show, findings))
        part = self.loading_steps.prove_part(picture, request)
        if part is None:
            return findings
        found = part.merge_diagnostics(found)
        return replace(findings, diagnostics=found, line_findings=map_findings_by_line(found))

    def _show(self, findings: ProofFindings) -> None:
        if findings.number >= self._now.number:
            self._now = findings

    def _failed(self, why: str) -> None:
        self._now = ProofFindings(self._number, error_text=Message("PROVING FAILED: {why}", why=why))


def describe_finding(finding: Diagnostic, line: int) -> str:
    """Return the prompt text that describes a finding in a line."""
    return Message("LINE {line}: {value} {hint}", line=line, value=finding.text, hint=finding.hint).strip()
