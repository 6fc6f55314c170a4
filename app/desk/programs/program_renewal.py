"""Renewal of the loaded program's proof after a change of offsets or units.

Between two program runs, the program is loaded again. During a run, the program is proved with the new
offsets, and the executor applies the offsets at the end of the part.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

from app.desk.background_work import LatestRequestWorker, WorkAbandonedError, WorkRequest
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase, ProgramLoader, find_final_phase
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.offsets.active_offsets import make_secondary_offsets, make_tool_offsets
from app.offsets.offset_book import OffsetBook
from core.executor.commands import ChangeOffsets, Command, SupplyJobProof, UseOffsetTables
from core.executor.job import Job, Proof, find_outdated_setting
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message

# --- while the program runs ---------------------------------------------------------------------------


@dataclass(slots=True)
class RunningRenewal:
    """Renewal of the proof for a running program after one change of offsets.

    A newer renewal or a newly loaded program replaces this renewal. The renewal uses the text of the
    running program, and not the file on the disk. The screen shows the old program until the executor uses
    the new one.
    """

    program_loader: ProgramLoader
    worker: LatestRequestWorker = field(
        init=False
    )  # Shares the thread of the loader and runs after its current work.
    _loads: int = 0  # Load count of the loader when the renewal began.
    _next: LoadedProgram | None = None
    _shown: LoadedProgram | None = None
    _given: Proof | None = None  # Proof that was sent to the executor last.
    _told: bool = True
    _trouble: str = ""

    def __post_init__(self) -> None:
        self.worker = LatestRequestWorker("renewing", thread_owning_worker=self.program_loader.worker)

    def begin_renewal(self) -> bool:
        """Announce the renewal to the executor and begin proving.

        Returns False if no program is loaded. After the announcement, the executor does not start a part
        with the old offsets.
        """
        now = self.program_loader.loaded_program
        if now.job is None:
            return False
        self.worker.cancel_request()
        self._loads, self._next, self._told, self._trouble = self.program_loader.load_count, None, False, ""
        self.program_loader.post_command(ChangeOffsets())
        self.worker.request_work(partial(self._renew, now, now.job), self._ready, self._failed)
        return True

    def is_in_use(self, snapshot: Snapshot) -> bool:
        """Return whether the executor uses the renewed program.

        If it does, show that program on the screen.
        """
        ready = self._next
        if ready is None or ready.job is None or self.program_loader.load_count != self._loads:
            return False
        if ready.job.digest != snapshot.job:
            return False
        if ready is not self._shown:
            self._shown = ready
            self.program_loader.replace_loaded_program(ready)
            # The proof includes the findings of the part.
            if ready.proof is not None and ready.proof != self._given:
                self._given = ready.proof
                self.program_loader.post_command(SupplyJobProof(ready.proof))
        return True

    def poll_error(self) -> str:
        """Return the reason why the next part will not start, or an empty string.

        Each reason is returned only once. If the program could not be proved again, the executor is
        informed.
        """
        self.worker.deliver_results()
        if self._trouble:
            why, self._trouble = self._trouble, ""
            self.program_loader.post_command(ChangeOffsets(failure_reason=why))
            return why
        ready = self._next
        if self._told or ready is None or ready.proof is None:
            return ""
        self._told = True
        return ready.proof.errors[0] if ready.proof.errors else ""

    def _renew(self, now: LoadedProgram, old: Job, request: WorkRequest) -> LoadedProgram:
        steps, watch = self.program_loader.loading_steps, partial(self._go_on, request)
        job = steps.renew_job(old)
        proved = steps.prove_job(job, watch)
        fresh = replace(
            now,
            job=job,
            proof=proved.proof,
            diagnostics=proved.diagnostics,
            phase=LoadingPhase.DRAWING,
            part_proof=None,
            progress_count=0,
        )
        if not proved.waits_for_part_proof:
            request.publish_result(partial(self._publish, fresh))
            self._give(job, proved.proof)
        picture = steps.draw_path(job, watch)
        part = steps.prove_part(picture, watch)
        found, whole = proved.diagnostics, proved.proof
        if part is not None:
            found, whole = part.merge_diagnostics(found), part.add_to_proof(whole, job.source.name)
        fresh = replace(
            fresh,
            picture=picture,
            part_proof=part,
            proof=whole,
            diagnostics=found,
            phase=find_final_phase(whole),
        )
        if proved.waits_for_part_proof:
            request.publish_result(partial(self._publish, fresh))
            self._give(job, whole)
        return fresh

    def _give(self, job: Job, proof: Proof) -> None:
        self._given = proof
        self.program_loader.post_command(ChangeOffsets(job, proof))

    def _go_on(self, request: WorkRequest, reached: float) -> None:
        request(reached)
        self._still_loaded()

    def _publish(self, fresh: LoadedProgram) -> None:
        self._still_loaded()
        self._next = fresh

    def _still_loaded(self) -> None:
        if self.program_loader.load_count != self._loads:
            raise WorkAbandonedError

    def _ready(self, fresh: LoadedProgram) -> None:
        self._next = fresh

    def _failed(self, why: str) -> None:
        self._trouble = why


@dataclass(slots=True)
class ProgramRenewal:
    """Renewal of the proof after a change of tool offsets, secondary offsets or the modal unit.

    Between two program runs, the program is read, proved and drawn again. During a run, the program is
    proved with the new offsets, and the executor applies the offsets at the end of the part.
    """

    program_loader: ProgramLoader
    # A worker may finish at any moment, so the next key must not remove its message.
    show_warning: Callable[[str], None]
    is_requested: bool = False
    running_renewal: RunningRenewal = field(init=False)
    _changes: int = 0  # Change count of the offset book at the last update.

    def __post_init__(self) -> None:
        self.running_renewal = RunningRenewal(self.program_loader)

    def update(
        self, snapshot: Snapshot, offset_book: OffsetBook, post_command: Callable[[Command], None]
    ) -> None:
        """Detect changes of the offsets, and begin a renewal when possible.

        The screen calls this method once per frame.
        """
        save_error, before = offset_book.poll_saving(), self._changes
        self._changes = offset_book.changes
        if save_error:
            self.show_warning(Message("REJECTED: {why}", why=save_error))
        changed, under_way = self._changes != before, snapshot.state in ACTIVE_STATES
        if changed and under_way:
            self.running_renewal.begin_renewal()
        elif self.running_renewal.is_in_use(snapshot) and not changed:
            self.is_requested = False
        if changed or self._is_outdated(snapshot):
            self.is_requested = True
        self._report_error(snapshot)
        if self.is_requested and not under_way and not offset_book.is_saving:
            self.is_requested = False
            # The new offsets take effect immediately, also for the tool in use.
            post_command(
                UseOffsetTables(
                    make_tool_offsets(offset_book.tool_offsets),
                    make_secondary_offsets(offset_book.secondary_offsets),
                )
            )
            now = self.program_loader.loaded_program
            if now.path is not None:
                self.program_loader.start_loading(now.path, now.is_block_delete_on)

    def _report_error(self, snapshot: Snapshot) -> None:
        """Warn that the next part will not start, while the operator can still undo the change."""
        why = self.running_renewal.poll_error()
        if why and snapshot.state in ACTIVE_STATES:
            self.show_warning(
                tr(Message("AFTER THIS OFFSET CHANGE, THE NEXT PART WILL NOT START: {why}", why=why))
            )

    def _is_outdated(self, snapshot: Snapshot) -> bool:
        """Return whether the unit of the proof differs from the machine's current modal unit.

        The difference matters only if the program does not specify its unit.
        """
        now = self.program_loader.loaded_program
        at_rest = (
            snapshot.state is MachineState.IDLE
            and not now.is_busy
            and now.phase is not LoadingPhase.UNREADABLE
        )
        return at_rest and now.job is not None and bool(find_outdated_setting(now.job, snapshot.modal))
