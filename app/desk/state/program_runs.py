"""Records of program runs: parts, proofs and runs, and the steps of the first job."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from app.desk.pages.first_job import FirstJob
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import Loaded, PartProved
from app.desk.status.prompt_line import UNDER_WAY
from app.programs.run_history import PartCounter, RunHistory
from core.executor.commands import Command
from core.executor.snapshot import Snapshot
from core.store.store_errors import StoreError


class ProgramRuns:
    """The part counter, the run history and the card of the first job, stored by ``persistence``."""

    def __init__(self, persistence: Persistence) -> None:
        self.counter = PartCounter(persistence)
        self.history = RunHistory(persistence)
        self._persistence = persistence
        self._first_job = FirstJob()
        with suppress(StoreError):  # A store that cannot be read is reported elsewhere.
            self._first_job = FirstJob.stored(persistence)
        self._part_seen: PartProved | None = None

    @property
    def first_job(self) -> FirstJob:
        """The card of the first job."""
        return self._first_job

    def restart_first_job(self) -> None:
        """Start the first job again at its first step."""
        self._first_job = FirstJob()

    def see(
        self,
        snapshot: Snapshot,
        loaded: Loaded,
        post: Callable[[Command], None],
        say: Callable[[str], None],
    ) -> None:
        """Record one frame of a program. Do not call this for MDI lines, which are not program runs."""
        text = loaded.job.text_digest if loaded.job is not None else self.counter.text
        self.counter.see(snapshot, post, say, text)
        self.history.see(snapshot, loaded)

    def follow_first_job(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Advance the card of the first job, and store its step. Raises StoreError."""
        self._first_job.see(snapshot, loaded, self.counter.count)
        self._first_job.save(self._persistence)

    def new_caution(self, snapshot: Snapshot, loaded: Loaded) -> str:
        """Return the first warning about a part that was proved while its program runs.

        Each warning is returned once; otherwise the text is empty.
        """
        part, seen = loaded.part, self._part_seen
        self._part_seen = part
        if part is None or part is seen or not part.warned or snapshot.state not in UNDER_WAY:
            return ""
        return part.warned[0]
