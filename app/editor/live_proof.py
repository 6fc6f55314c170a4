"""Proving while one types: on a worker, the latest text only, and never in the way of the next key."""

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

QUIET = 0.008  # seconds without a key after which proving begins
LONGEST = 0.03  # seconds that typing may put it off
PATIENCE = 0.2  # seconds of work after which a newer text takes the worker
_WEIGHT = {Severity.ERROR: 2, Severity.WARNING: 1, Severity.NOTE: 0}


@dataclass(frozen=True, slots=True)
class Findings:
    """What proving says of the text with this number; ``picture`` may still be that of an older one."""

    number: int = 0
    diagnostics: tuple[Diagnostic, ...] = ()
    by_line: dict[int, Diagnostic] = field(default_factory=dict)  # the weightiest of each line
    picture: Picture | None = None
    cycle_time: float = 0.0
    blocks: int = 0
    trouble: str = ""  # why it could not be proved at all
    book: CodeBook | None = None  # of the text's language

    @property
    def errors(self) -> int:
        """How many keep the program from running."""
        return sum(d.severity is Severity.ERROR for d in self.diagnostics)

    @property
    def warnings(self) -> int:
        """How many are only to be looked at."""
        return sum(d.severity is Severity.WARNING for d in self.diagnostics)


def by_line(diagnostics: tuple[Diagnostic, ...]) -> dict[int, Diagnostic]:
    """The weightiest finding of each line, of equals the first; line 0 speaks of the whole file."""
    found: dict[int, Diagnostic] = {}
    for one in diagnostics:
        there = found.get(one.line)
        if there is None or _WEIGHT[one.severity] > _WEIGHT[there.severity]:
            found[one.line] = one
    return found


@dataclass(slots=True)
class LiveProof:
    """``submit`` and ``now`` never wait. A text that a newer one has overtaken is not proved."""

    workshop: LoadingSteps
    worker: Latest = field(
        default_factory=lambda: Latest("editing-proof", quiet=QUIET, longest=LONGEST, patience=PATIENCE)
    )
    _now: Findings = field(default_factory=Findings)
    _number: int = 0

    @property
    def now(self) -> Findings:
        """The latest that is known. A worker that has failed shows as trouble."""
        self.worker.poll()
        return self._now

    @property
    def behind(self) -> bool:
        """Whether a newer text than that of ``now`` is waiting or being proved."""
        return self.worker.busy

    def submit(self, name: str, text: str, block_delete: bool = False) -> int:
        """This is the text now; answers its number."""
        self._number += 1
        work = partial(self._prove, self._number, Source(name, text), block_delete)
        self.worker.ask(work, self._show, self._failed)
        return self._number

    def forget(self) -> None:
        """Drop the findings: another document is opened, and these are of the one before."""
        self._number += 1
        self._now = Findings(self._number)

    def close(self) -> None:
        """Give up what is being proved and end the worker."""
        self.worker.close()

    def _prove(self, number: int, source: Source, block_delete: bool, request: Request) -> Findings:
        """On the worker. The findings are shown before the picture is drawn, those of the part last."""
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
