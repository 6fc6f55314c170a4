"""Loading, proving and drawing of a program on a worker thread.

The screen reads the result from ``ProgramLoader.loaded_program``.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import LatestRequestWorker, ProgressCallback, WorkRequest
from core.executor.commands import Command, LoadJob, StartClearance, SupplyJobProof
from core.executor.job import Job, Proof
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture
    from core.proving.proof_report import PartReport


ApproachLegs = tuple[tuple[float, float, bool], ...]
"""Path as legs of machine X in mm, machine Z in mm, and whether the leg is a rapid."""


class FirstMoveResult(NamedTuple):
    """Result of checking the first move of a program for collisions.

    - ``clearances`` contains one verdict for a start at the current position and one for Cycle Repeat.
    - ``approach_legs`` is the path to draw.
    - ``part_zero_position`` is the machine position, X and Z in mm, at which the tool tip is at part zero.
    """

    clearances: tuple[StartClearance, ...]
    approach_legs: ApproachLegs = ()
    part_zero_position: tuple[float, float] = (0.0, 0.0)

    @property
    def start_clearance(self) -> StartClearance:
        """Return the verdict on a start from the current position of the axes."""
        return self.clearances[0]


class LoadingPhase(StrEnum):
    """Phase of loading a program."""

    EMPTY = "EMPTY"
    READING = "READING"
    PROVING = "PROVING"
    DRAWING = "DRAWING"
    PROVING_PART = "PROVING PART:"  # The program does not start before this proof is finished.
    READY = "READY"
    REFUSED = "REJECTED"  # The proof found errors. The program is shown but cannot run.
    UNREADABLE = "UNREADABLE"


@dataclass(frozen=True, slots=True)
class ProvedJob:
    """Proof of a job with its diagnostics.

    ``waits_for_part_proof`` is True if the job must not start before its part is proved, because an error
    in the part would prevent the start. ``first_move_result`` is the result of the first-move check of an
    MDI line or a restart.
    """

    proof: Proof
    diagnostics: tuple[Diagnostic, ...] = ()
    waits_for_part_proof: bool = False
    first_move_result: FirstMoveResult | None = None

    @property
    def first_move_clearance(self) -> StartClearance | None:
        """Return the verdict of the first-move check, or None if the move was not checked."""
        return self.first_move_result.start_clearance if self.first_move_result is not None else None


@dataclass(frozen=True, slots=True)
class PartProof:
    """Result of proving the part.

    ``diagnostics`` are the findings with their severity for this machine. ``warning_texts`` are short
    warnings that are shown before a start because they depend on assumptions. If the part could not be
    calculated, ``report`` is None and ``error_text`` gives the reason.
    """

    diagnostics: tuple[Diagnostic, ...] = ()
    warning_texts: tuple[str, ...] = ()
    report: PartReport | None = None
    error_text: str = ""

    def add_to_proof(self, proof: Proof, name: str) -> Proof:
        """Return the proof of the program with the errors and warnings of the part added."""
        errors = tuple(d.format_one_line(name) for d in self.diagnostics if d.severity is Severity.ERROR)
        return replace(proof, errors=(*proof.errors, *errors), warnings=self.warning_texts)

    def merge_diagnostics(self, diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        """Return the diagnostics of the part and the given diagnostics, without duplicates.

        The diagnostics are sorted by line and column.
        """
        known = {(each.line, each.code) for each in diagnostics}
        own = (each for each in self.diagnostics if (each.line, each.code) not in known)
        return tuple(sorted((*diagnostics, *own), key=lambda each: (each.line, each.column)))


def _no_part(_picture: ProgramPicture, _watch: ProgressCallback) -> PartProof | None:
    return None


@dataclass(frozen=True, slots=True)
class LoadingSteps:
    """Functions of other packages that load a program. They are called only on the worker thread.

    They report progress to a ``ProgressCallback``. The callback may raise WorkAbandonedError, which the
    functions must not catch.
    """

    read_source: Callable[[Path], ProgramSource]  # Raises OSError or ValueError with an error message.
    make_job: Callable[[ProgramSource, bool], Job]  # Arguments: text, and state of Block Delete.
    prove_job: Callable[[Job, ProgressCallback], ProvedJob]
    draw_path: Callable[[Job, ProgressCallback], ProgramPicture]
    # Returns the same job with the present offsets.
    renew_job: Callable[[Job], Job] = field(default=lambda job: job)
    # Returns None if the program has no part.
    prove_part: Callable[[ProgramPicture, ProgressCallback], PartProof | None] = field(default=_no_part)


@dataclass(frozen=True, slots=True)
class LoadedProgram:
    """The loaded program and the progress of loading. Each change creates a new object."""

    phase: LoadingPhase = LoadingPhase.EMPTY
    path: Path | None = None
    is_block_delete_on: bool = False
    source: ProgramSource | None = None
    job: Job | None = None
    proof: Proof | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    picture: ProgramPicture | None = None
    part_proof: PartProof | None = None
    progress_count: int = 0  # Number of blocks that are proved or drawn.
    error_text: str = ""  # Reason why the program could not be read.

    @property
    def name(self) -> str:
        """Return the file name of the program, or an empty string if no program is loaded."""
        return self.path.name if self.path else ""

    @property
    def blocking_errors(self) -> tuple[Diagnostic, ...]:
        """Return the diagnostics that prevent the program from running."""
        return tuple(d for d in self.diagnostics if d.severity is Severity.ERROR)

    @property
    def is_busy(self) -> bool:
        """Return whether the worker is still loading the program."""
        return self.phase in {
            LoadingPhase.READING,
            LoadingPhase.PROVING,
            LoadingPhase.DRAWING,
            LoadingPhase.PROVING_PART,
        }


@dataclass(slots=True)
class ProgramLoader:
    """Loader of programs, which loads one program at a time.

    ``post_command`` sends commands to the executor, and is also called on the worker thread.
    """

    loading_steps: LoadingSteps
    post_command: Callable[[Command], None]
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("loading"))
    load_count: int = 0  # Number of times loading began or was stopped.
    _now: LoadedProgram = field(default_factory=LoadedProgram)

    @property
    def loaded_program(self) -> LoadedProgram:
        """Return the loaded program.

        If loading fails, its phase is UNREADABLE and its ``error_text`` gives the reason.
        """
        self.worker.deliver_results()
        return self._now

    def start_loading(self, path: Path, block_delete: bool = False) -> None:
        """Start loading a program, and cancel any loading in progress."""
        with self.worker.lock:
            self.load_count += 1
            self._now = LoadedProgram(LoadingPhase.READING, path, block_delete)
            self.worker.request_work(partial(self._load, path, block_delete), lambda _: None, self._failed)

    def replace_loaded_program(self, loaded: LoadedProgram) -> None:
        """Replace the loaded program with an updated object for the same program.

        The updated object contains a new proof or new progress.
        """
        self._now = loaded

    def wait_until_loaded(self, timeout_s: float) -> LoadedProgram:
        """Wait until loading is complete, and return the program.

        Only scripts and tests use this method.
        """
        self.worker.wait_for_results(timeout_s)
        return self.loaded_program

    def close(self) -> None:
        """Cancel loading and end the worker."""
        self.load_count += 1
        self.worker.close()

    def _load(self, path: Path, block_delete: bool, request: WorkRequest) -> None:
        steps = self.loading_steps
        source = steps.read_source(path)
        job = steps.make_job(source, block_delete)
        _ = source.lines  # Split the text here, so that the screen does not have to.
        self._publish(request, lambda now: replace(now, phase=LoadingPhase.PROVING, source=source, job=job))
        self.post_command(LoadJob(job))
        proved = steps.prove_job(job, partial(self._reached, request))
        proof, found = proved.proof, proved.diagnostics
        self._publish(
            request,
            lambda now: replace(
                now, phase=LoadingPhase.DRAWING, proof=proof, diagnostics=found, progress_count=0
            ),
        )
        if not proved.waits_for_part_proof:
            self.post_command(SupplyJobProof(proof))
        picture = steps.draw_path(job, partial(self._reached, request))
        phase = LoadingPhase.PROVING_PART if proved.waits_for_part_proof else find_final_phase(proof)
        self._publish(request, lambda now: replace(now, phase=phase, picture=picture, progress_count=0))
        self._prove_part(job, proved, picture, request)
        _freeze_garbage()

    def _prove_part(self, job: Job, proved: ProvedJob, picture: ProgramPicture, request: WorkRequest) -> None:
        """Prove the part. The program may run before this proof ends unless it must wait for the proof."""
        watch = partial(self._reached, request) if proved.waits_for_part_proof else request
        part = self.loading_steps.prove_part(picture, watch)
        found, whole = proved.diagnostics, proved.proof
        if part is not None:
            found, whole = part.merge_diagnostics(found), part.add_to_proof(whole, job.source.name)
        phase = find_final_phase(whole)
        self._publish(
            request,
            lambda now: replace(
                now, phase=phase, proof=whole, diagnostics=found, part_proof=part, progress_count=0
            ),
        )
        if proved.waits_for_part_proof or whole != proved.proof:
            self.post_command(SupplyJobProof(whole))

    def _reached(self, request: WorkRequest, count: float) -> None:
        self._publish(request, lambda now: replace(now, progress_count=int(count)))

    def _publish(self, request: WorkRequest, change: Callable[[LoadedProgram], LoadedProgram]) -> None:
        request.publish_result(lambda: self.replace_loaded_program(change(self._now)))

    def _failed(self, why: str) -> None:
        self._now = replace(self._now, phase=LoadingPhase.UNREADABLE, error_text=why)


def find_final_phase(proof: Proof) -> LoadingPhase:
    """Return the loading phase of a program whose proof is complete."""
    return LoadingPhase.REFUSED if proof.errors else LoadingPhase.READY


def _freeze_garbage() -> None:
    """Exclude the loaded program from garbage collection.

    A scan of the 200,000 blocks of a large program would stop every thread for 40 ms, including the
    executor. Reference counting still frees the objects.
    """
    gc.collect(1)
    gc.freeze()
