"""Loading a program: read, proved and drawn on a worker thread; the screen only looks at ``now``."""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.latest import AbandonedError, Watch, sentence
from core.executor.commands import Command, GiveProof, LoadJob
from core.executor.job import Job, Proof
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Source

if TYPE_CHECKING:
    from app.path.path_picture import Picture


def _same(job: Job) -> Job:
    """Where no offsets are kept nothing ever changes."""
    return job


class Phase(StrEnum):
    """How far loading has come."""

    EMPTY = "EMPTY"
    READING = "READING"
    PROVING = "PROVING"
    DRAWING = "DRAWING"
    READY = "READY"
    REFUSED = "REFUSED"  # the proof found errors: it is shown, but it will not run
    UNREADABLE = "UNREADABLE"


@dataclass(frozen=True, slots=True)
class Proved:
    """A proof and everything that proving had to say."""

    proof: Proof
    diagnostics: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, slots=True)
class LoadingSteps:
    """What loading needs from the rest of the house. Called on the worker thread only.

    ``watch`` is told how far the work has come and may raise to abandon it; it must be let through.
    """

    read: Callable[[Path], Source]  # raises OSError or ValueError with a sentence
    make_job: Callable[[Source, bool], Job]  # text, block delete
    prove: Callable[[Job, Watch], Proved]
    draw: Callable[[Job, Watch], Picture]
    renew_job: Callable[[Job], Job] = _same  # the same program with the offsets of now


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
        return self.phase in {Phase.READING, Phase.PROVING, Phase.DRAWING}


@dataclass(slots=True)
class ProgramLoader:
    """One program at a time. ``post`` hands commands to the executor; it may be called from the worker."""

    workshop: LoadingSteps
    post: Callable[[Command], None]
    _now: Loaded = field(default_factory=Loaded)
    _ticket: int = 0
    _future: Future[None] | None = None
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="loading")
    )

    @property
    def now(self) -> Loaded:
        """The program on the desk. A worker that has died shows as trouble, not as endless waiting."""
        future = self._future
        if future is not None and future.done():
            error = future.exception()
            self._future = None
            if error is not None and not isinstance(error, AbandonedError):
                self._now = replace(self._now, phase=Phase.UNREADABLE, trouble=sentence(error))
        return self._now

    def load(self, path: Path, block_delete: bool = False) -> None:
        """Start loading; what was being loaded before is given up."""
        with self._lock:
            self._ticket += 1
            ticket = self._ticket
            self._now = Loaded(Phase.READING, path, block_delete)
        self._future = self._pool.submit(self._work, ticket, path, block_delete)

    @property
    def loads(self) -> int:
        """How often loading has begun."""
        return self._ticket

    def submit(self, work: Callable[[], None]) -> Future[None]:
        """Have something done by the worker that loads, after what it has in hand."""
        return self._pool.submit(work)

    def adopt(self, loaded: Loaded) -> None:
        """The same program under other circumstances is the one on the desk now."""
        self._now = loaded

    def settled(self, timeout: float) -> Loaded:
        """Wait until loading is over and look; for scripts and tests, never for the screen."""
        if self._future is not None:
            wait([self._future], timeout)
        return self.now

    def close(self) -> None:
        """Give up whatever is being loaded and end the worker."""
        with self._lock:
            self._ticket += 1
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _work(self, ticket: int, path: Path, block_delete: bool) -> None:
        source = self.workshop.read(path)
        job = self.workshop.make_job(source, block_delete)
        _ = source.lines  # split here once, so that the screen never does
        self._publish(ticket, lambda now: replace(now, phase=Phase.PROVING, source=source, job=job))
        self.post(LoadJob(job))
        watch = self._watch(ticket)
        proof, found = self._proved(job, watch)
        self._publish(
            ticket,
            lambda now: replace(now, phase=Phase.DRAWING, proof=proof, diagnostics=found, reached=0),
        )
        self.post(GiveProof(proof))
        picture = self.workshop.draw(job, watch)
        phase = Phase.REFUSED if proof.errors else Phase.READY
        self._publish(ticket, lambda now: replace(now, phase=phase, picture=picture))
        _keep_out_of_collections()

    def _proved(self, job: Job, watch: Watch) -> tuple[Proof, tuple[Diagnostic, ...]]:
        proved = self.workshop.prove(job, watch)
        return proved.proof, proved.diagnostics

    def _watch(self, ticket: int) -> Watch:
        return lambda count: self._publish(ticket, lambda now: replace(now, reached=int(count)))

    def _publish(self, ticket: int, change: Callable[[Loaded], Loaded]) -> None:
        with self._lock:
            if ticket != self._ticket:
                raise AbandonedError
            self._now = change(self._now)


def _keep_out_of_collections() -> None:
    """What a program is made of stays until it goes by itself. To look through it for cycles would stop every
    thread, the executor too, for 40 ms with 200 000 blocks, again and again."""
    gc.collect(1)
    gc.freeze()
