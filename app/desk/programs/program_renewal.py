"""Renewal of the loaded program's proof after a change of offsets or units.

Between two programs, the program is loaded again. During a run, the program is proved with the new offsets,
and the executor applies them at the end of the part.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

from app.desk.background_work import AbandonedError, Latest, Request
from app.desk.programs.program_loading import Loaded, Phase, ProgramLoader, settled
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offsets_in_force import secondary_offsets, tool_offsets
from core.executor.commands import Command, GiveProof, Renew, UseOffsets
from core.executor.job import Job, Proof, outdated
from core.executor.snapshot import Snapshot, State
from core.message import Message

# --- while the program runs ---------------------------------------------------------------------------


@dataclass(slots=True)
class RunningRenewal:
    """One renewal of the proof during a run. A newer renewal or a newly loaded program replaces it.

    The renewal uses the text of the running program and not the file on the disk. The screen shows the old
    program until the executor uses the new one.
    """

    session: ProgramLoader
    worker: Latest = field(init=False)  # Shares the thread of the loader and runs after its current work.
    _loads: int = 0  # Load count of the loader when the renewal began.
    _next: Loaded | None = None
    _shown: Loaded | None = None
    _given: Proof | None = None  # Proof that was sent to the executor last.
    _told: bool = True
    _trouble: str = ""

    def __post_init__(self) -> None:
        self.worker = Latest("renewing", beside=self.session.worker)

    def begin(self) -> bool:
        """Announce the renewal to the executor and begin proving. Return False if no program is loaded.

        After the announcement, the executor does not start a part with the old offsets.
        """
        now = self.session.now
        if now.job is None:
            return False
        self.worker.give_up()
        self._loads, self._next, self._told, self._trouble = self.session.loads, None, False, ""
        self.session.post(Renew())
        self.worker.ask(partial(self._renew, now, now.job), self._ready, self._failed)
        return True

    def taken(self, snapshot: Snapshot) -> bool:
        """Return whether the executor uses the renewed program. The screen then shows it, too."""
        ready = self._next
        if ready is None or ready.job is None or self.session.loads != self._loads:
            return False
        if ready.job.digest != snapshot.job:
            return False
        if ready is not self._shown:
            self._shown = ready
            self.session.adopt(ready)
            # The proof includes the findings of the part.
            if ready.proof is not None and ready.proof != self._given:
                self._given = ready.proof
                self.session.post(GiveProof(ready.proof))
        return True

    def trouble(self) -> str:
        """Return once why the next part will not start. Empty if there is no new reason.

        If the renewed proof could not be made, the executor is informed.
        """
        self.worker.poll()
        if self._trouble:
            why, self._trouble = self._trouble, ""
            self.session.post(Renew(trouble=why))
            return why
        ready = self._next
        if self._told or ready is None or ready.proof is None:
            return ""
        self._told = True
        return ready.proof.errors[0] if ready.proof.errors else ""

    def _renew(self, now: Loaded, old: Job, request: Request) -> Loaded:
        steps, watch = self.session.workshop, partial(self._go_on, request)
        job = steps.renew_job(old)
        proved = steps.prove(job, watch)
        fresh = replace(
            now,
            job=job,
            proof=proved.proof,
            diagnostics=proved.diagnostics,
            phase=Phase.DRAWING,
            part=None,
            reached=0,
        )
        if not proved.waits:
            request.publish(partial(self._publish, fresh))
            self._give(job, proved.proof)
        picture = steps.draw(job, watch)
        part = steps.part(picture, watch)
        found, whole = proved.diagnostics, proved.proof
        if part is not None:
            found, whole = part.among(found), part.completes(whole, job.source.name)
        fresh = replace(
            fresh, picture=picture, part=part, proof=whole, diagnostics=found, phase=settled(whole)
        )
        if proved.waits:
            request.publish(partial(self._publish, fresh))
            self._give(job, whole)
        return fresh

    def _give(self, job: Job, proof: Proof) -> None:
        self._given = proof
        self.session.post(Renew(job, proof))

    def _go_on(self, request: Request, reached: float) -> None:
        request(reached)
        self._still_loaded()

    def _publish(self, fresh: Loaded) -> None:
        self._still_loaded()
        self._next = fresh

    def _still_loaded(self) -> None:
        if self.session.loads != self._loads:
            raise AbandonedError

    def _ready(self, fresh: Loaded) -> None:
        self._next = fresh

    def _failed(self, why: str) -> None:
        self._trouble = why


@dataclass(slots=True)
class ProgramRenewal:
    """Renews the proof after a change of tool offsets, secondary offsets or the modal unit.

    Between two programs, the program is read, proved and drawn again. During a run, the program is proved
    with the new offsets, and the executor applies them at the end of the part.
    """

    session: ProgramLoader
    # A worker may finish at any moment, so the next key must not remove its message.
    warn: Callable[[str], None]
    wanted: bool = False
    renewing: RunningRenewal = field(init=False)
    _changes: int = 0  # Change count of the offset book at the last update.

    def __post_init__(self) -> None:
        self.renewing = RunningRenewal(self.session)

    def look(self, snapshot: Snapshot, book: OffsetBook, post: Callable[[Command], None]) -> None:
        """Detect changes of the offsets and begin a renewal when possible; called once a frame."""
        trouble, before = book.poll(), self._changes
        self._changes = book.changes
        if trouble:
            self.warn(Message("REJECTED: {why}", why=trouble))
        changed, under_way = self._changes != before, snapshot.state in UNDER_WAY
        if changed and under_way:
            self.renewing.begin()
        elif self.renewing.taken(snapshot) and not changed:
            self.wanted = False
        if changed or self._outdated(snapshot):
            self.wanted = True
        self._tell_trouble(snapshot)
        if self.wanted and not under_way and not book.busy:
            self.wanted = False
            # The new offsets take effect immediately, also for the tool in use.
            post(UseOffsets(tool_offsets(book.tools), secondary_offsets(book.secondary)))
            now = self.session.now
            if now.path is not None:
                self.session.load(now.path, now.block_delete)

    def _tell_trouble(self, snapshot: Snapshot) -> None:
        """Warn that the next part will not start, while the operator can still undo the change."""
        why = self.renewing.trouble()
        if why and snapshot.state in UNDER_WAY:
            self.warn(tr(Message("AFTER THIS OFFSET CHANGE, THE NEXT PART WILL NOT START: {why}", why=why)))

    def _outdated(self, snapshot: Snapshot) -> bool:
        """Return whether the machine's modal unit differs from the unit of the proof.

        This matters only if the program does not specify the unit.
        """
        now = self.session.now
        at_rest = snapshot.state is State.IDLE and not now.busy and now.phase is not Phase.UNREADABLE
        return at_rest and now.job is not None and bool(outdated(now.job, snapshot.modal))
