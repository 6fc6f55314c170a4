"""The queue of jobs in every frame: what is under way, when its count is reached, what comes next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from app.desk.desk import Desk
from app.desk.interrupted_notice import NoticeRow
from app.desk.program_loading import Loaded
from app.desk.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.jobs.job_setup import ProvedJob, missing
from app.jobs.next_job import JobProofs
from app.quality.parts_watch import PartsWatch
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.message import Message
from core.quality.tool_life import ToolLife
from core.store.production import job_queue
from core.store.production.job_queue import JobRow

KEY = "Jobs"  # its name in app.screen.keys


@dataclass(slots=True)
class JobsWatch:
    """``see`` is called once a frame. Nothing is put on the desk or started here: that is the operator's."""

    desk: Desk
    parts: PartsWatch
    proofs: JobProofs
    also: str = ""  # a job that is looked at on the page is proved too
    _counted: tuple[str, int] = ("", 0)
    _told: int = 0  # the job whose end was told
    _known: bool = False
    _loading: tuple[JobRow, Path, int] | None = None  # put on the desk, and not taken by it yet

    @property
    def jobs(self) -> tuple[JobRow, ...]:
        """The queue as it is kept."""
        return self.parts.book.now.jobs

    @property
    def under_way(self) -> JobRow | None:
        """The job for which parts are counted now."""
        return next((row for row in self.jobs if row.under_way), None)

    def on_desk(self, job: JobRow) -> bool:
        """Whether it is under way and its program is the one on the desk; after a restart it may not be."""
        return job.under_way and self.desk.session.now.name == job.program

    @property
    def next(self) -> JobRow | None:
        """The first of those that are still to be made, but for the one under way."""
        return next((row for row in self.jobs if not row.done and not row.under_way), None)

    @property
    def lives(self) -> Mapping[int, ToolLife]:
        """Of the tools, as of now."""
        return self.parts.lives.lives()

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """One frame."""
        counter = self.desk.counter
        if (counter.program, counter.count) != self._counted:
            self._counted = counter.program, counter.count
            self.parts.book.refresh()
        self._begin(loaded)
        job = self.under_way
        counter.of_job = job.target if job is not None and job.program == counter.program else 0
        self._tell(job)
        self._prove(snapshot)

    def _prove(self, snapshot: Snapshot) -> None:
        """The marked one and the next; those behind them while nothing is under way."""
        waiting = [row.program for row in self.jobs if not row.done and not row.under_way]
        wanted = waiting if snapshot.state not in UNDER_WAY else waiting[:1]
        self.proofs.want([each for each in (self.also, *wanted) if each], self.desk.book.changes)

    # --- putting one on the desk -------------------------------------------------------------------------

    def load(self, job: JobRow) -> None:
        """The operator has chosen it: its program is loaded; once the desk has taken it, its parts count."""
        if not self.desk.may_choose():
            return
        path = self.desk.program_folders.find(job.program)
        if path is None:
            self.desk.say(
                tr(Message("{name} IS NOT IN THE PROGRAM LIST. F1, THEN F6: CHECK LIST", name=job.program))
            )
            return
        loads = self.desk.session.loads
        self.desk.put_on_desk(path)
        self._loading = job, path, loads

    def _begin(self, loaded: Loaded) -> None:
        """What is asked about an interrupted job may still be answered with no."""
        if self._loading is None:
            return
        job, path, loads = self._loading
        if self.desk.session.loads != loads:
            self._loading = None
            if loaded.path == path:
                self.parts.book.write(
                    Act.JOBS,
                    lambda connection: job_queue.begin(connection, job.id),
                    _nothing,
                    self.parts.refuse,
                    Message("job {program} started", program=job.program),
                )
        elif not self.desk.asked:
            self._loading = None

    # --- what is told --------------------------------------------------------------------------------

    def _tell(self, job: JobRow | None) -> None:
        """Once when its count is reached; one that was done before this desk began is told by the notice."""
        if not self.parts.book.loads:
            return
        done = job.id if job is not None and job.done else 0
        if done and done != self._told and self._known and job is not None:
            self.desk.done(
                Message("{job} {next_words}", job=self._done_words(job), next_words=self._next_words())
            )
        self._told, self._known = done, True

    @staticmethod
    def _done_words(job: JobRow) -> str:
        return tr(
            Message(
                "JOB DONE: {count} OF {expected} PARTS OF {program}.",
                count=job.made,
                expected=job.wanted,
                program=job.program,
            )
        )

    def _next_words(self) -> str:
        job = self.next
        if job is None:
            return tr("NO MORE JOBS WAITING.")
        words = tr(Message("NEXT: {program}, {left} PARTS", program=job.program, left=job.left))
        return Message("{words}, {job}", words=words, job=self.state_words(job))

    def state_words(self, job: JobRow) -> str:
        """How a job that waits stands: not proved yet, what is missing, ready."""
        made = self.proofs.of(job.program, self.desk.book.changes)
        if made is None:
            return tr("NOT PROVED YET")
        if not isinstance(made, ProvedJob):
            return made
        if made.sheet.errors:
            return tr("THE PROGRAM HAS ERRORS")
        lacking = missing(made, self.lives, job.left)
        return (
            tr(Message("{count} SETUP ITEMS NOT READY", count=lacking)) if lacking else tr("ALL TOOLS READY")
        )

    def notice(self, snapshot: Snapshot) -> NoticeRow | None:
        """On the Automatic page, between cycles: the job is done, and which comes next."""
        job = self.under_way
        if job is None or not job.done or snapshot.state in UNDER_WAY or snapshot.interrupted is not None:
            return None
        return NoticeRow(self._done_words(job), self._next_words(), ((KEY, "SHIFT+F6"),), "run")

    def due(self) -> str:
        """The notice tells it; the prompt line has nothing besides."""
        return ""

    def close(self) -> None:
        """End the worker."""
        self.proofs.close()


def _nothing() -> None:
    """What was kept is seen in the queue."""
