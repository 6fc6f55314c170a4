"""Records of program runs: the part counter, the run history and the steps of the first job."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from app.desk.pages.first_job import FirstJobCard
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadedProgram, PartProof
from app.desk.status.prompt_line import ACTIVE_STATES
from app.programs.run_history import PartCounter, RunHistory
from core.executor.commands import Command
from core.executor.snapshot import Snapshot
from core.store.store_errors import StoreError


class ProgramRuns:
    """Part counter, run history and guidance card for the first job.

    ``persistence`` stores all three.
    """

    def __init__(self, persistence: Persistence) -> None:
        self.part_counter = PartCounter(persistence)
        self.run_history = RunHistory(persistence)
        self._persistence = persistence
        self._first_job = FirstJobCard()
        with suppress(StoreError):  # A store that cannot be read is reported elsewhere.
            self._first_job = FirstJobCard.from_store(persistence)
        self._part_seen: PartProof | None = None

    @property
    def first_job_card(self) -> FirstJobCard:
        """Return the card that guides the operator through the first job."""
        return self._first_job

    def restart_first_job(self) -> None:
        """Restart the guidance for the first job at its first step."""
        self._first_job = FirstJobCard()

    def record_frame(
        self,
        snapshot: Snapshot,
        loaded: LoadedProgram,
        post_command: Callable[[Command], None],
        show_message: Callable[[str], None],
    ) -> None:
        """Record one frame of a program run.

        Do not call this method for MDI lines, which are not program runs.
        """
        text = loaded.job.text_digest if loaded.job is not None else self.part_counter.program_digest
        self.part_counter.process_snapshot(snapshot, post_command, show_message, text)
        self.run_history.process_snapshot(snapshot, loaded)

    def update_first_job(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Advance the card of the first job and store its step, without waiting for the disk.

        Raises StoreError if the step cannot be queued for saving. A later write error is not raised.
        """
        self._first_job.advance(snapshot, loaded, self.part_counter.part_count)
        self._first_job.save_step(self._persistence)

    def pop_part_warning(self, snapshot: Snapshot, loaded: LoadedProgram) -> str:
        """Return the next new warning about a part that was proved while its program was running.

        Each warning is returned only once. The result is an empty string if there is no new warning.
        """
        part, seen = loaded.part_proof, self._part_seen
        self._part_seen = part
        if part is None or part is seen or not part.warning_texts or snapshot.state not in ACTIVE_STATES:
            return ""
        return part.warning_texts[0]
