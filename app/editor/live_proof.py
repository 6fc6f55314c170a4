"""Proof during typing: runs on a worker for the latest text only, without delaying keys."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

from app.desk.background_work import Latest, Request
from app.desk.programs.program_loading import LoadingSteps
from core.interpreter.dialects import code_book
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Source
from core.message import Message

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from core.language.code_book import CodeBook

QUIET = 0.008  # seconds without a key press before proving starts
LONGEST = 0.03  # maximum seconds by which typing delays proving
PATIENCE = 0.2  # seconds of work after which a newer text interrupts the worker
_WEIGHT = {Severity.ERROR: 2, Severity.WARNING: 1, Severity.NOTE: 0}


@dataclass(frozen=True, slots=True)
class Findings:
    """Result of proving the text with this number. ``picture`` can belong to an older text."""

    number: int = 0
    diagnostics: tuple[Diagnostic, ...] = ()
    by_line: dict[int, Diagnostic] = field(default_factory=dict)  # most severe finding of each line
    picture: Picture | None = None
    cycle_time: float = 0.0
    blocks: int = 0
    trouble: str = ""  # reason why the text could not be proved
    book: CodeBook | None = None  # code book of the text's language

    @property
    def errors(self) -> int:
        """Number of findings that prevent a run."""
        return sum(d.severity is Severity.ERROR for d in self.diagnostics)

    @property
    def warnings(self) -> int:
        """Number of warnings."""
        return sum(d.severity is Severity.WARNING for d in self.diagnostics)


def by_line(diagnostics: tuple[Diagnostic, ...]) -> dict[int, Diagnostic]:
    """Return the most severe finding of each line, the first of equals.

    Line 0 is the whole file.
    """
    found: dict[int, Diagnostic] = {}
    for one in diagnostics:
        there = found.get(one.line)
        if there is None or _WEIGHT[one.severity] > _WEIGHT[there.severity]:
            found[one.line] = one
    return found


@dataclass(slots=True)
class LiveProof:
    """Proof of the latest text.

    ``submit`` and ``now`` never wait, and older texts are skipped.
    """

    workshop: LoadingSteps
    worker: Latest = field(
        default_factory=lambda: Latest("editing-proof", quiet=QUIET, longest=LONGEST, patience=PATIENCE)
    )
    _now: Findings = field(default_factory=Findings)
    _number: int = 0

    @property
    def now(self) -> Findings:
        """Latest findings. A failure of the worker appears as ``trouble``."""
        self.worker.poll()
        return self._now

    @property
    def behind(self) -> bool:
        """Whether a newer text than that of ``now`` is waiting or being proved."""
        return self.worker.busy

    def submit(self, name: str, text: str, block_delete: bool = False) -> int:
        """Submit the present text, and return its number."""
        self._number += 1
        work = partial(self._prove, self._number, Source(name, text), block_delete)
        self.worker.ask(work, self._show, self._failed)
        return self._number

    def forget(self) -> None:
        """Clear the findings when another document opens."""
        self._number += 1
        self._now = Findings(self._number)

    def close(self) -> None:
        """Cancel the present proof and stop the worker."""
        self.worker.close()

    def _prove(self, number: int, source: Source, block_delete: bool, request: Request) -> Findings:
        """Prove a text on the worker.

        Findings are published before the picture is drawn. Those of the part follow last.
        """
        job = self.workshop.make_job(source, block_delete)
        proved = self.workshop.prove(job, request)
        found, proof = proved.diagnostics, proved.proof
        before = self._now.picture
        book = code_book(source.dialect).prepared()
        findings = Findings(number, found, by_line(found), before, proof.cycle_time, proof.blocks, book=book)
        request.publish(partial(self._show, findings))
        picture = self.workshop.draw(job, request)
        findings = replace(findings, picture=picture)
        request.publish(partial(self._show, findings))
        part = self.workshop.part(picture, request)
        if part is None:
            return findings
        found = part.among(found)
        return replace(findings, diagnostics=found, by_line=by_line(found))

    def _show(self, findings: Findings) -> None:
        if findings.number >= self._now.number:
            self._now = findings

    def _failed(self, why: str) -> None:
        self._now = Findings(self._number, trouble=Message("PROVING FAILED: {why}", why=why))
