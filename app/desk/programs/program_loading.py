"""Loading, proving and drawing of a program on a worker thread. The screen reads the result from ``now``."""

from __future__ import annotations

import gc
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import Latest, Request, Watch
from core.executor.commands import Clearance, Command, GiveProof, LoadJob
from core.executor.job import Job, Proof
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Source

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from core.proving.proof_report import PartReport


Legs = tuple[tuple[float, float, bool], ...]
"""A path in machine X and Z, mm, with whether each leg is a rapid."""


class FirstMoveSeen(NamedTuple):
    """The result of checking the first move, with a verdict for the start here and one for Cycle Repeat.

    ``legs`` is the path that is drawn. ``zero`` is the machine X and Z in mm at which the tip is on part
    zero.
    """

    verdicts: tuple[Clearance, ...]
    legs: Legs = ()
    zero: tuple[float, float] = (0.0, 0.0)

    @property
    def clearance(self) -> Clearance:
        """The verdict on a start from the present position of the axes."""
        return self.verdicts[0]


class Phase(StrEnum):
    """The progress of loading a program."""

    EMPTY = "EMPTY"
    READING = "READING"
    PROVING = "PROVING"
    DRAWING = "DRAWING"
    PART = "PROVING PART:"  # The program does not start before this proof is finished.
    READY = "READY"
    REFUSED = "REJECTED"  # The proof found errors. The program is shown but cannot run.
    UNREADABLE = "UNREADABLE"


@dataclass(frozen=True, slots=True)
class Proved:
    """A proof with its diagnostics.

    ``waits``: the start must wait for the proof of the part, because a part error may refuse the start.
    ``first_move`` is the result of the first-move check of an MDI line or a restart.
    """

    proof: Proof
    diagnostics: tuple[Diagnostic, ...] = ()
    waits: bool = False
    first_move: FirstMoveSeen | None = None

    @property
    def clearance(self) -> Clearance | None:
        """The verdict on the first move. None if the move was not checked."""
        return self.first_move.clearance if self.first_move is not None else None


@dataclass(frozen=True, slots=True)
class PartProved:
    """The result of proving the part.

    ``diagnostics`` are the findings with their severity for this machine. ``warned`` contains short warnings
    that are shown before a start because they rest on assumptions. ``report`` is None if the part could not
    be calculated; ``trouble`` then gives the reason.
    """

    diagnostics: tuple[Diagnostic, ...] = ()
    warned: tuple[str, ...] = ()
    report: PartReport | None = None
    trouble: str = ""

    def completes(self, proof: Proof, name: str) -> Proof:
        """Return the proof of the program with the errors and warnings of its part added."""
        errors = tuple(d.in_one_line(name) for d in self.diagnostics if d.severity is Severity.ERROR)
        return replace(proof, errors=(*proof.errors, *errors), warned=self.warned)

    def among(self, diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        """Return these and the given diagnostics without duplicates, sorted by line and column."""
        known = {(each.line, each.code) for each in diagnostics}
        own = (each for each in self.diagnostics if (each.line, each.code) not in known)
        return tuple(sorted((*diagnostics, *own), key=lambda each: (each.line, each.column)))


def _no_part(_picture: Picture, _watch: Watch) -> PartProved | None:
    return None


@dataclass(frozen=True, slots=True)
class LoadingSteps:
    """Functions that loading needs from other rooms. They are called on the worker thread only.

    ``watch`` gets the progress. It may raise AbandonedError, which the functions must not catch.
    """

    read: Callable[[Path], Source]  # Raises OSError or ValueError with an error message.
    make_job: Callable[[Source, bool], Job]  # Arguments: text, and state of Block Delete.
    prove: Callable[[Job, Watch], Proved]
    draw: Callable[[Job, Watch], Picture]
    # Returns the same job with the present offsets.
    renew_job: Callable[[Job], Job] = field(default=lambda job: job)
    # Returns None if the program has no part.
    part: Callable[[Picture, Watch], PartProved | None] = field(default=_no_part)


@dataclass(frozen=True, slots=True)
class Loaded:
    """The loaded program and the progress of loading. Objects are replaced and never changed."""

    phase: Phase = Phase.EMPTY
    path: Path | None = None
    block_delete: bool = False
    source: Source | None = None
    job: Job | None = None
    proof: Proof | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    picture: Picture | None = None
    part: PartProved | None = None
    reached: int = 0  # Number of blocks that are proved or drawn.
    trouble: str = ""  # Reason why the program could not be read.

    @property
    def name(self) -> str:
        """The file name of the program. Empty if no program is loaded."""
        return self.path.name if self.path else ""

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """The diagnostics that prevent the program from running."""
        return tuple(d for d in self.diagnostics if d.severity is Severity.ERROR)

    @property
    def busy(self) -> bool:
        """Whether the worker is still loading the program."""
        return self.phase in {Phase.READING, Phase.PROVING, Phase.DRAWING, Phase.PART}


@dataclass(slots=True)
class ProgramLoader:
    """Loads one program at a time. ``post`` sends commands to the executor, also from the worker thread."""

    workshop: LoadingSteps
    post: Callable[[Command], None]
    worker: Latest = field(default_factory=lambda: Latest("loading"))
    loads: int = 0  # Number of times loading began or was stopped.
    _now: Loaded = field(default_factory=Loaded)

    @property
    def now(self) -> Loaded:
        """The loaded program. If loading fails, the phase is UNREADABLE and ``trouble`` gives the reason."""
        self.worker.poll()
        return self._now

    def load(self, path: Path, block_delete: bool = False) -> None:
        """Start loading a program. Loading in progress is canceled."""
        with self.worker.lock:
            self.loads += 1
            self._now = Loaded(Phase.READING, path, block_delete)
            self.worker.ask(partial(self._load, path, block_delete), lambda _: None, self._failed)

    def adopt(self, loaded: Loaded) -> None:
        """Replace the loaded program by the same program with another proof or progress."""
        self._now = loaded

    def settled(self, timeout: float) -> Loaded:
        """Wait until loading is finished, and return the program. For scripts and tests only."""
        self.worker.settle(timeout)
        return self.now

    def close(self) -> None:
        """Cancel loading and end the worker."""
        self.loads += 1
        self.worker.close()

    def _load(self, path: Path, block_delete: bool, request: Request) -> None:
        steps = self.workshop
        source = steps.read(path)
        job = steps.make_job(source, block_delete)
        _ = source.lines  # Split the text here, so that the screen does not have to.
        self._publish(request, lambda now: replace(now, phase=Phase.PROVING, source=source, job=job))
        self.post(LoadJob(job))
        proved = steps.prove(job, partial(self._reached, request))
        proof, found = proved.proof, proved.diagnostics
        self._publish(
            request,
            lambda now: replace(now, phase=Phase.DRAWING, proof=proof, diagnostics=found, reached=0),
        )
        if not proved.waits:
            self.post(GiveProof(proof))
        picture = steps.draw(job, partial(self._reached, request))
        phase = Phase.PART if proved.waits else settled(proof)
        self._publish(request, lambda now: replace(now, phase=phase, picture=picture, reached=0))
        self._prove_part(job, proved, picture, request)
        _keep_out_of_collections()

    def _prove_part(self, job: Job, proved: Proved, picture: Picture, request: Request) -> None:
        """Prove the part. A program that did not wait for this proof may already be running."""
        watch = partial(self._reached, request) if proved.waits else request
        part = self.workshop.part(picture, watch)
        found, whole = proved.diagnostics, proved.proof
        if part is not None:
            found, whole = part.among(found), part.completes(whole, job.source.name)
        phase = settled(whole)
        self._publish(
            request,
            lambda now: replace(now, phase=phase, proof=whole, diagnostics=found, part=part, reached=0),
        )
        if proved.waits or whole != proved.proof:
            self.post(GiveProof(whole))

    def _reached(self, request: Request, count: float) -> None:
        self._publish(request, lambda now: replace(now, reached=int(count)))

    def _publish(self, request: Request, change: Callable[[Loaded], Loaded]) -> None:
        request.publish(lambda: self.adopt(change(self._now)))

    def _failed(self, why: str) -> None:
        self._now = replace(self._now, phase=Phase.UNREADABLE, trouble=why)


def settled(proof: Proof) -> Phase:
    """Return the phase of a program whose proof is complete."""
    return Phase.REFUSED if proof.errors else Phase.READY


def _keep_out_of_collections() -> None:
    """Exclude the loaded program from garbage collection.

    A scan of 200,000 blocks would stop every thread for 40 ms, including the executor, again and again. The
    objects are freed by reference counting.
    """
    gc.collect(1)
    gc.freeze()
