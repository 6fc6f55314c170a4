"""The queue of jobs in every frame: what is under way, what comes next, and what that needs on the plate.

The next job is proved while another one runs, on a worker of the desk and never in the executor's way.
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


_SAME = 1e-4  # mm: nose radii that differ by less are one
_TOLD = 3  # findings of the proof that are named


@dataclass(frozen=True, slots=True)
class ProvedJob:
    """A program of the queue as it was proved with the offsets of that moment.

    ``before``: its tools as they were set when it was started last, ``ran`` (UTC); empty: it never was.
    """

    sheet: SetupSheet
    ran: str = ""
    before: Mapping[int, ToolRow] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Station:
    """One tool that a job needs; ``lacks``: in words what is to be done about it, empty: nothing."""

    tool: SheetTool
    lacks: tuple[str, ...] = ()


def stations(job: ProvedJob, lives: Mapping[int, ToolLife], parts: int) -> tuple[Station, ...]:
    """The tools of a job that is to make so many parts still, in the order of the plate."""
    return tuple(
        Station(tool, tuple(_lacks(tool, job, lives.get(tool.number), parts))) for tool in job.sheet.tools
    )


def missing(job: ProvedJob, lives: Mapping[int, ToolLife], parts: int) -> int:
    """How many things are to be seen to before it can be started: tools, and errors of its proof."""
    return sum(len(each.lacks) for each in stations(job, lives, parts)) + job.sheet.errors


def findings(sheet: SetupSheet) -> tuple[Diagnostic, ...]:
    """The first errors of the proof, and behind them its first warnings."""
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
    """By what a part of this job takes of it, which may be less or more than the parts before have taken."""
    left = [life.limit_parts - life.parts] if life.limit_parts else []
    if life.limit_seconds and seconds > 0.0:
        left.append(int((life.limit_seconds - life.seconds) / seconds + 1e-9))
    return max(0, min(left)) if left else None


def _of_tip(tool: SheetTool, job: ProvedJob) -> Iterator[str]:
    """Another tip than that with which the program was started last: other inserts are on the plate now."""
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
    """``T3``, ``T1D2``."""
    return edge_name(number)


PAGE = "JOBS"  # its name in app.screen.page_table


class JobsFunction(PageFunction):
    """How many jobs wait, and which is next."""

    name = "JOBS"
    use = "next job, number of parts, setup requirements"
    page = PAGE
    way = (
        "Press Enter to open the JOBS page. Shift+F6 opens it from any page, and J opens it "
        "from the main menu."
    )

    def facts(self) -> tuple[Row, ...]:
        """Under way, next, waiting."""
        watch = self.desk.pages.find(JobsWatch)
        if watch is None:
            return ()
        job, coming = watch.under_way, watch.next
        made = f"{job.program}  {job.made}/{job.wanted}" if job is not None else NOTHING
        then = f"{coming.program}  {coming.left}" if coming is not None else NOTHING
        waiting = sum(not each.done and not each.under_way for each in watch.jobs)
        return (Row((tr("IN PROGRESS"), made)), Row((tr("NEXT"), then)), Row((tr("WAITING"), str(waiting))))

    def prompt(self) -> str:
        """How the page is opened."""
        return "ENTER: OPEN JOBS   ESC: BACK TO THE LIST"


Prove = Callable[[str, Watch], ProvedJob]
"""A program by its name, with the offsets of now; on the worker. Raises ValueError with a sentence."""
KEPT = 20


@dataclass(slots=True)
class JobProofs:
    """``want`` and ``of`` never wait. A proof is of a program and the offsets that it was made with."""

    prove: Prove
    worker: Latest = field(default_factory=lambda: Latest("editing-jobs"))
    _made: dict[tuple[str, int], ProvedJob | str] = field(default_factory=dict)
    _asked: tuple[str, int] | None = None

    def want(self, programs: Sequence[str], offsets: int) -> None:
        """Once a frame: these are to be proved, the first one first; ``offsets`` tells one state of tables
        from another. What is being proved and is wanted no longer is given up.
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
        """What is known of it: its proof, why there is none, None: it is not proved yet."""
        return self._made.get((program, offsets))

    def anew(self) -> None:
        """Files and shapes may have changed: everything is proved again."""
        self._made.clear()
        self._asked = None

    def _keep(self, key: tuple[str, int], made: ProvedJob | str) -> None:
        self._made[key] = made
        self._asked = None
        while len(self._made) > KEPT:
            del self._made[next(iter(self._made))]

    def close(self) -> None:
        """Give up what is being proved and end the worker."""
        self.worker.close()


FEATURE = "jobs"  # name of the queue in the book
KEY = "Shift+F6"  # its name in app.screen.window.keys


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
        jobs: tuple[JobRow, ...] = self.parts.book.now.more.get(FEATURE, ())
        return jobs

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
        """The marked one and the next; those behind them while nothing is under way."""
        waiting = [row.program for row in self.jobs if not row.done and not row.under_way]
        wanted = waiting if snapshot.state not in UNDER_WAY else waiting[:1]
        self.proofs.want([each for each in (self.also, *wanted) if each], self.desk.book.changes)

    # --- putting one on the desk -------------------------------------------------------------------------

    def load(self, job: JobRow) -> None:
        """The operator has chosen it: its program is loaded; once the desk has taken it, its parts count."""
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
