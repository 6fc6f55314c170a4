"""Watch of the job queue: the active job, the next job and its required setup.

The next job is proved on a worker while another job runs, without affecting the executor.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import Latest, Watch
from app.desk.desk import Desk
from app.desk.pages.sheet import Row
from app.desk.programs.program_loading import Loaded
from app.desk.status.formats import NOTHING, local_time
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.production.parts_watch import PartsWatch
from app.special.special_functions import PageFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.production.tool_life import LifeState, ToolLife
from core.store.production import job_queue
from core.store.production.job_queue import JobRow
from core.store.store_rows import ToolRow
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from app.special.setup_sheet import SetupSheet, SheetTool


_SAME = 1e-4  # mm: smaller differences of nose radii are ignored
_TOLD = 3  # maximum number of displayed findings


@dataclass(frozen=True, slots=True)
class ProvedJob:
    """Program of the queue, proved with the offsets of that moment.

    ``before`` contains the tools at its last start, and ``ran`` is the time of that start (UTC), or empty if
    it never ran.
    """

    sheet: SetupSheet
    ran: str = ""
    before: Mapping[int, ToolRow] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Station:
    """Tool that a job needs. ``lacks`` lists the required actions as text."""

    tool: SheetTool
    lacks: tuple[str, ...] = ()


def stations(job: ProvedJob, lives: Mapping[int, ToolLife], parts: int) -> tuple[Station, ...]:
    """Return the tools of a job that has ``parts`` parts to make, in the order of the gang plate."""
    return tuple(
        Station(tool, tuple(_lacks(tool, job, lives.get(tool.number), parts))) for tool in job.sheet.tools
    )


def missing(job: ProvedJob, lives: Mapping[int, ToolLife], parts: int) -> int:
    """Return the number of open items before the job can start: tool actions and errors of the proof."""
    return sum(len(each.lacks) for each in stations(job, lives, parts)) + job.sheet.errors


def findings(sheet: SetupSheet) -> tuple[Diagnostic, ...]:
    """Return the first errors of the proof, followed by its first warnings."""
    worth = [each for each in sheet.found if each.severity is not Severity.NOTE]
    return tuple(sorted(worth, key=lambda each: (each.severity is not Severity.ERROR, each.line))[:_TOLD])


def _lacks(tool: SheetTool, job: ProvedJob, life: ToolLife | None, parts: int) -> Iterator[str]:
    if tool.offset is None:
        yield tr("no offset set: touch off the tool")
        return
    yield from _of_life(tool, life, parts)
    yield from _of_tip(tool, job)


def _of_life(tool: SheetTool, life: ToolLife | None, parts: int) -> Iterator[str]:
    if life is None or life.state is LifeState.NO_LIMIT:
        return
    if life.state is LifeState.SPENT:
        yield tr(Message("tool life used up, {words}: change the insert", words=tr(life.words)))
        return
    left = _parts_left(life, tool.time.cutting)
    if left is not None and left < parts:
        yield tr(Message("remaining tool life covers {left} of {parts} parts", left=left, parts=parts))


def _parts_left(life: ToolLife, seconds: float) -> int | None:
    """Return the number of parts that the tool life covers, at the cutting time per part of this job."""
    left = [life.limit_parts - life.parts] if life.limit_parts else []
    if life.limit_seconds and seconds > 0.0:
        left.append(int((life.limit_seconds - life.seconds) / seconds + 1e-9))
    return max(0, min(left)) if left else None


def _of_tip(tool: SheetTool, job: ProvedJob) -> Iterator[str]:
    """Yield a note if the tool tip differs from that at the last start of the program."""
    then, now = job.before.get(tool.number), tool.offset
    if then is None or now is None:
        return
    if then.quadrant == now.quadrant and abs(then.nose_radius - now.nose_radius) < _SAME:
        return
    words = tr(
        "since the last run ({when}), the tool tip has changed from R {was}, {was_tip}, to R {radius}, {tip}"
    )
    length = job.sheet.length
    yield tr(
        Message(
            words,
            radius=length(now.nose_radius),
            tip=_tip(now.quadrant),
            when=local_time(job.ran, seconds=False),
            was=length(then.nose_radius),
            was_tip=_tip(then.quadrant),
        )
    )


def _tip(quadrant: int) -> str:
    return tr(Message("tip quadrant {quadrant}", quadrant=quadrant))


def tool_name(number: int) -> str:
    """Return the name of a tool or edge, such as ``T3`` or ``T1D2``."""
    return edge_name(number)


PAGE = "JOBS"  # name of the page in app.screen.page_table


class JobsFunction(PageFunction):
    """Special function with the number of waiting jobs and the next job."""

    name = "JOBS"
    use = "next job, number of parts, setup requirements"
    page = PAGE
    way = (
        "Press Enter to open the JOBS page. Shift+F6 opens it from any page, and J opens it "
        "from the main menu."
    )

    def facts(self) -> tuple[Row, ...]:
        """Return the rows with the active, next and waiting jobs."""
        watch = self.desk.pages.find(JobsWatch)
        if watch is None:
            return ()
        job, coming = watch.under_way, watch.next
        made = f"{job.program}  {job.made}/{job.wanted}" if job is not None else NOTHING
        then = f"{coming.program}  {coming.left}" if coming is not None else NOTHING
        waiting = sum(not each.done and not each.under_way for each in watch.jobs)
        return (Row((tr("IN PROGRESS"), made)), Row((tr("NEXT"), then)), Row((tr("WAITING"), str(waiting))))

    def prompt(self) -> str:
        """Return the prompt that names the keys."""
        return "ENTER: OPEN JOBS   ESC: BACK TO THE LIST"


Prove = Callable[[str, Watch], ProvedJob]
"""A program by its name, with the offsets of now; on the worker. Raises ValueError with a sentence."""
KEPT = 20


@dataclass(slots=True)
class JobProofs:
    """Proofs of jobs by program and offsets. ``want`` and ``of`` never wait."""

    prove: Prove
    worker: Latest = field(default_factory=lambda: Latest("editing-jobs"))
    _made: dict[tuple[str, int], ProvedJob | str] = field(default_factory=dict)
    _asked: tuple[str, int] | None = None

    def want(self, programs: Sequence[str], offsets: int) -> None:
        """Request proofs, the first program first, and cancel an obsolete proof; called once per frame.

        ``offsets`` identifies the state of the offset tables.
        """
        self.worker.poll()
        keys = [(program, offsets) for program in programs[:KEPT]]
        wanted = next((key for key in keys if key not in self._made), None)
        if wanted is None or wanted == self._asked:
            return
        self._asked = wanted
        done = partial(self._keep, wanted)
        self.worker.ask(partial(self.prove, wanted[0]), done, done)

    def of(self, program: str, offsets: int) -> ProvedJob | str | None:
        """Return the proof of a program, the reason why proving failed, or None while it is pending."""
        return self._made.get((program, offsets))

    def anew(self) -> None:
        """Discard all proofs, because files and shapes can have changed."""
        self._made.clear()
        self._asked = None

    def _keep(self, key: tuple[str, int], made: ProvedJob | str) -> None:
        self._made[key] = made
        self._asked = None
        while len(self._made) > KEPT:
            del self._made[next(iter(self._made))]

    def close(self) -> None:
        """Cancel the present proof and stop the worker."""
        self.worker.close()


FEATURE = "jobs"  # name of the queue in the parts book
KEY = "Shift+F6"  # name of the key in app.screen.window.keys


@dataclass(slots=True)
class JobsWatch:
    """Watch of the job queue.

    ``see`` is called once per frame. Only the operator loads and starts jobs.
    """

    desk: Desk
    parts: PartsWatch
    proofs: JobProofs
    also: str = ""  # program of the job that is selected on the page, which is proved too
    _counted: tuple[str, int] = ("", 0)
    _told: int = 0  # job whose end was reported
    _known: bool = False
    _loading: tuple[JobRow, Path, int] | None = None  # job that is being loaded, with its path and load count

    @property
    def jobs(self) -> tuple[JobRow, ...]:
        """Stored jobs of the queue."""
        jobs: tuple[JobRow, ...] = self.parts.book.now.more.get(FEATURE, ())
        return jobs

    @property
    def under_way(self) -> JobRow | None:
        """Active job, whose parts are counted, or None."""
        return next((row for row in self.jobs if row.under_way), None)

    def on_desk(self, job: JobRow) -> bool:
        """Return whether a job is active and its program is loaded, which may differ after a restart."""
        return job.under_way and self.desk.session.now.name == job.program

    @property
    def next(self) -> JobRow | None:
        """First unfinished job that is not active, or None."""
        return next((row for row in self.jobs if not row.done and not row.under_way), None)

    @property
    def lives(self) -> Mapping[int, ToolLife]:
        """Tool life of all tools."""
        return self.parts.lives.lives()

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Update the active job, its target and the proofs. Called once per frame."""
        counter = self.desk.runs.counter
        if (counter.program, counter.count) != self._counted:
            self._counted = counter.program, counter.count
            self.parts.book.refresh()
        self._begin(loaded)
        job = self.under_way
        counter.of_job = job.target if job is not None and job.program == counter.program else 0
        self._tell(job)
        self._prove(snapshot)

    def _prove(self, snapshot: Snapshot) -> None:
        """Request the proofs of the selected and the next job, and of all jobs while no program runs."""
        waiting = [row.program for row in self.jobs if not row.done and not row.under_way]
        wanted = waiting if snapshot.state not in UNDER_WAY else waiting[:1]
        self.proofs.want([each for each in (self.also, *wanted) if each], self.desk.book.changes)

    # --- loading a job -----------------------------------------------------------------------------------

    def load(self, job: JobRow) -> None:
        """Load the program of a job that the operator has selected. Its parts count after loading."""
        if not self.desk.programs.can_choose():
            return
        path = self.desk.programs.folders.find(job.program)
        if path is None:
            self.desk.say(
                tr(Message("{name} IS NOT IN THE PROGRAM LIST. F1, THEN F6: CHECK LIST", name=job.program))
            )
            return
        loads = self.desk.session.loads
        self.desk.programs.load(path)
        self._loading = job, path, loads

    def _begin(self, loaded: Loaded) -> None:
        """Start the job after loading.

        A question about an interrupted job can still cancel the loading.
        """
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

    # --- messages ------------------------------------------------------------------------------------

    def _tell(self, job: JobRow | None) -> None:
        """Report once when the count of a job is reached.

        The notice shows jobs finished before the start.
        """
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
        """Return the state of a waiting job as text: not proved, open items or ready."""
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
        """Return the notice of the Automatic page about a finished job and the next job, or None."""
        job = self.under_way
        if job is None or not job.done or snapshot.state in UNDER_WAY or snapshot.interrupted is not None:
            return None
        return NoticeRow(self._done_words(job), self._next_words(), ((KEY, "SHIFT+F6"),), "run")

    def due(self) -> str:
        """Return an empty string, because the notice replaces the text on the prompt line."""
        return ""

    def close(self) -> None:
        """Stop the worker."""
        self.proofs.close()


def _nothing() -> None:
    """Do nothing, because the queue shows the stored change."""
