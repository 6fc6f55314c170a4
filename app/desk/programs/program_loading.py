"""Loading a program: read, proved and drawn on a worker thread; the screen only looks at ``now``."""

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
    """The answer to one question: the verdict here and that of Cycle Repeat, and the legs that are drawn.

    ``zero`` is machine X and Z, mm, with the tip for which they are drawn on part zero.
    """

    verdicts: tuple[Clearance, ...]
    legs: Legs = ()
    zero: tuple[float, float] = (0.0, 0.0)

    @property
    def clearance(self) -> Clearance:
        """The verdict on a start from where the axes are."""
        return self.verdicts[0]


class Phase(StrEnum):
    """How far loading has come."""

    EMPTY = "EMPTY"
    READING = "READING"
    PROVING = "PROVING"
    DRAWING = "DRAWING"
    PART = "PROVING PART:"  # before it is known, the program will not start
    READY = "READY"
    REFUSED = "REJECTED"  # the proof found errors: it is shown, but it will not run
    UNREADABLE = "UNREADABLE"


@dataclass(frozen=True, slots=True)
class Proved:
    """A proof and everything that proving had to say.

    ``waits``: so much is said of its part that an error of it may refuse the start, so it waits for that.
    ``first_move``: what was found of the first move, of a line and of a restart.
    """

    proof: Proof
    diagnostics: tuple[Diagnostic, ...] = ()
    waits: bool = False
    first_move: FirstMoveSeen | None = None

    @property
    def clearance(self) -> Clearance | None:
        """The verdict on the first move; None: it was not checked."""
        return self.first_move.clearance if self.first_move is not None else None


@dataclass(frozen=True, slots=True)
class PartProved:
    """What proving the part had to say, each finding with the weight that it has here.

    ``warned``: in a few words each, what is announced before a start because it rests on something assumed.
    ``report`` is None where the part could not be made; ``trouble`` then says why.
    """

    diagnostics: tuple[Diagnostic, ...] = ()
    warned: tuple[str, ...] = ()
    report: PartReport | None = None
    trouble: str = ""

    def completes(self, proof: Proof, name: str) -> Proof:
        """The proof of the program with that of its part."""
        errors = tuple(d.in_one_line(name) for d in self.diagnostics if d.severity is Severity.ERROR)
        return replace(proof, errors=(*proof.errors, *errors), warned=self.warned)

    def among(self, diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        """All findings, in the order of lines and columns; one that reading has told already is told once."""
        known = {(each.line, each.code) for each in diagnostics}
        own = (each for each in self.diagnostics if (each.line, each.code) not in known)
        return tuple(sorted((*diagnostics, *own), key=lambda each: (each.line, each.column)))


def _no_part(_picture: Picture, _watch: Watch) -> PartProved | None:
    return None


@dataclass(frozen=True, slots=True)
class LoadingSteps:
    """What loading needs from the rest of the house. Called on the worker thread only.

    ``watch`` is told how far the work has come and may raise to abandon it; it must be let through.
    """

    read: Callable[[Path], Source]  # raises OSError or ValueError with a sentence
    make_job: Callable[[Source, bool], Job]  # text, block delete
    prove: Callable[[Job, Watch], Proved]
    draw: Callable[[Job, Watch], Picture]
    renew_job: Callable[[Job], Job] = field(default=lambda job: job)  # the same with the offsets of now
    part: Callable[[Picture, Watch], PartProved | None] = field(default=_no_part)  # None: it has none


@dataclass(frozen=True, slots=True)
class Loaded:
    """The program on the desk, as far as it has come; replaced whole, never changed."""

    phase: Phase = Phase.EMPTY
    path: Path | None = None
    block_delete: bool = False
    source: Source | None = None
    job: Job | None = None
    proof: Proof | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    picture: Picture | None = None
    part: PartProved | None = None
    reached: int = 0  # blocks that proving or drawing has come to
    trouble: str = ""  # why it could not be read

    @property
    def name(self) -> str:
        """What the screen calls it."""
        return self.path.name if self.path else ""

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """What keeps it from running."""
        return tuple(d for d in self.diagnostics if d.severity is Severity.ERROR)

    @property
    def busy(self) -> bool:
        """Whether the worker is still at it."""
        return self.phase in {Phase.READING, Phase.PROVING, Phase.DRAWING, Phase.PART}


@dataclass(slots=True)
class ProgramLoader:
    """One program at a time. ``post`` hands commands to the executor; it may be called from the worker."""

    workshop: LoadingSteps
    post: Callable[[Command], None]
    worker: Latest = field(default_factory=lambda: Latest("loading"))
    loads: int = 0  # how often loading has begun, or was ended
    _now: Loaded = field(default_factory=Loaded)

    @property
    def now(self) -> Loaded:
        """The program on the desk. Work that has failed shows as trouble, not as endless waiting."""
        self.worker.poll()
        return self._now

    def load(self, path: Path, block_delete: bool = False) -> None:
        """Start loading; what was being loaded before is given up."""
        with self.worker.lock:
            self.loads += 1
            self._now = Loaded(Phase.READING, path, block_delete)
            self.worker.ask(partial(self._load, path, block_delete), lambda _: None, self._failed)

    def adopt(self, loaded: Loaded) -> None:
        """The same program under other circumstances is the one on the desk now."""
        self._now = loaded

    def settled(self, timeout: float) -> Loaded:
        """Wait until loading is over and look; for scripts and tests, never for the screen."""
        self.worker.settle(timeout)
        return self.now

    def close(self) -> None:
        """Give up whatever is being loaded and end the worker."""
        self.loads += 1
        self.worker.close()

    def _load(self, path: Path, block_delete: bool, request: Request) -> None:
        steps = self.workshop
        source = steps.read(path)
        job = steps.make_job(source, block_delete)
        _ = source.lines  # split here once, so that the screen never does
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
        """What it makes of the stock; a program that did not have to wait for it may be running by now."""
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
    """How far a program has come when its proof is known whole."""
    return Phase.REFUSED if proof.errors else Phase.READY


def _keep_out_of_collections() -> None:
    """What a program is made of stays until it goes by itself. To look through it for cycles would stop every
    thread, the executor too, for 40 ms with 200 000 blocks, again and again."""
    gc.collect(1)
    gc.freeze()
