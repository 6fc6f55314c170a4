"""Monitoring of the job queue: the active job, the next job and the setup that it requires.

A worker proves the next job while another job runs. The proof does not affect the running program.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.desk import Desk
from app.desk.pages.table_content import TableRow
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.formats import NO_VALUE, format_local_time
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.production.parts_watch import ProductionMonitor
from app.special.special_functions import SeparatePageFunction
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.production.tool_life import ToolLife, ToolLifeState
from core.store.production import job_queue
from core.store.production.job_queue import JobRow
from core.store.store_rows import ToolOffsetRow
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from app.special.setup_sheet import SetupSheet, SetupSheetTool


_SAME = 1e-4  # mm: smaller differences of nose radii are ignored
_TOLD = 3  # maximum number of displayed findings


@dataclass(frozen=True, slots=True)
class ProvedJob:
    """Result of the proof of a queued program, with the offsets at the time of the proof.

    ``tools_at_last_start`` are the tools at the program's last start. ``last_start_utc`` is the UTC time of
    that start, or an empty string if the program has never run.
    """

    setup_sheet: SetupSheet
    last_start_utc: str = ""
    tools_at_last_start: Mapping[int, ToolOffsetRow] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class JobTool:
    """Tool that a job needs.

    ``required_actions`` are the actions that the operator must perform for this tool, as display text.
    """

    tool: SetupSheetTool
    required_actions: tuple[str, ...] = ()


def list_job_tools(
    job: ProvedJob, tool_lives: Mapping[int, ToolLife], parts_to_make: int
) -> tuple[JobTool, ...]:
    """Return the tools of a job in the order of their positions on the gang plate.

    ``parts_to_make`` is the number of parts that the tool life must cover.
    """
    return tuple(
        JobTool(tool, tuple(_lacks(tool, job, tool_lives.get(tool.tool_number), parts_to_make)))
        for tool in job.setup_sheet.setup_tools
    )


def count_open_items(job: ProvedJob, tool_lives: Mapping[int, ToolLife], parts_to_make: int) -> int:
    """Return the number of items that the operator must resolve before the job can start.

    The items are the required tool actions and the errors of the proof.
    """
    return (
        sum(len(each.required_actions) for each in list_job_tools(job, tool_lives, parts_to_make))
        + job.setup_sheet.error_count
    )


def select_important_findings(sheet: SetupSheet) -> tuple[Diagnostic, ...]:
    """Return the first errors and warnings of the proof, errors first."""
    worth = [each for each in sheet.diagnostics if each.severity is not Severity.NOTE]
    return tuple(sorted(worth, key=lambda each: (each.severity is not Severity.ERROR, each.line))[:_TOLD])


def _lacks(tool: SetupSheetTool, job: ProvedJob, life: ToolLife | None, parts: int) -> Iterator[str]:
    if tool.tool_offset is None:
        yield tr("no offset set: touch off the tool")
        return
    yield from _of_life(tool, life, parts)
    yield from _list_tip_actions(tool, job)


def _of_life(tool: SetupSheetTool, life: ToolLife | None, parts: int) -> Iterator[str]:
    if life is None or life.state is ToolLifeState.NO_LIMIT:
        return
    if life.state is ToolLifeState.USED_UP:
        yield tr(Message("tool life used up, {words}: change the insert", words=tr(life.words)))
        return
    left = _parts_left(life, tool.tool_times.cutting_s)
    if left is not None and left < parts:
        yield tr(Message("remaining tool life covers {left} of {parts} parts", left=left, parts=parts))


def _parts_left(life: ToolLife, seconds: float) -> int | None:
    """Return the number of parts that can be made in the remaining tool life.

    ``seconds`` is the cutting time per part of this job. The result is None if the tool life has no limit.
    """
    left = [life.limit_parts - life.parts] if life.limit_parts else []
    if life.limit_seconds and seconds > 0.0:
        left.append(int((life.limit_seconds - life.seconds) / seconds + 1e-9))
    return max(0, min(left)) if left else None


def _list_tip_actions(tool: SetupSheetTool, job: ProvedJob) -> Iterator[str]:
    """Yield a required action if the tip of a tool has changed since the last start of the program."""
    then, now = job.tools_at_last_start.get(tool.tool_number), tool.tool_offset
    if then is None or now is None:
        return
    if then.quadrant == now.quadrant and abs(then.nose_radius - now.nose_radius) < _SAME:
        return
    words = tr(
        "since the last run ({when}), the tool tip has changed from R {was}, {was_tip}, to R {radius}, {tip}"
    )
    length = job.setup_sheet.format_length
    yield tr(
        Message(
            words,
            radius=length(now.nose_radius),
            tip=_tip(now.quadrant),
            when=format_local_time(job.last_start_utc, with_seconds=False),
            was=length(then.nose_radius),
            was_tip=_tip(then.quadrant),
        )
    )


def _tip(quadrant: int) -> str:
    return tr(Message("tip quadrant {quadrant}", quadrant=quadrant))


def make_tool_label(number: int) -> str:
    """Return the label of a tool or cutting edge, such as ``T3`` or ``T1D2``."""
    return format_edge_name(number)


JOBS_PAGE = "JOBS"  # name of the page in app.screen.page_table


class JobsFunction(SeparatePageFunction):
    """Special function that shows the number of waiting jobs and the next job."""

    name = "JOBS"
    use = "next job, number of parts, setup requirements"
    page = JOBS_PAGE
    key_hint = (
        "Press Enter to open the JOBS page. Shift+F6 opens it from any page, and J opens it "
        "from the main menu."
    )

    def make_information_rows(self) -> tuple[TableRow, ...]:
        """Return the rows for the active job, the next job and the number of waiting jobs."""
        watch = self.desk.page_registry.find_model(JobWatch)
        if watch is None:
            return ()
        job, coming = watch.active_job, watch.next_job
        made = f"{job.program}  {job.parts_made}/{job.parts_to_make}" if job is not None else NO_VALUE
        then = f"{coming.program}  {coming.remaining_part_count}" if coming is not None else NO_VALUE
        waiting = sum(not each.is_done and not each.is_active for each in watch.jobs)
        return (
            TableRow((tr("IN PROGRESS"), made)),
            TableRow((tr("NEXT"), then)),
            TableRow((tr("WAITING"), str(waiting))),
        )

    def prompt_text(self) -> str:
        """Return the prompt that explains the keys."""
        return "ENTER: OPEN JOBS   ESC: BACK TO THE LIST"


ProveFunction = Callable[[str, ProgressCallback], ProvedJob]
"""Function that proves a program, given by name, with the current offsets.

It is called on the worker thread and raises ValueError with a complete sentence.
"""
MAX_PROOFS = 20


@dataclass(slots=True)
class JobProofs:
    """Cache of job proofs. The key is the program and the state of the offset tables.

    ``request_proofs`` and ``find_proof`` never block.
    """

    prove_program: ProveFunction
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-jobs"))
    _made: dict[tuple[str, int], ProvedJob | str] = field(default_factory=dict)
    _asked: tuple[str, int] | None = None

    def request_proofs(self, program_names: Sequence[str], offset_revision: int) -> None:
        """Request proofs in the order of ``program_names``, and cancel a running proof that is not needed.

        ``offset_revision`` identifies the state of the offset tables. This method is called once per frame.
        """
        self.worker.deliver_results()
        keys = [(program, offset_revision) for program in program_names[:MAX_PROOFS]]
        wanted = next((key for key in keys if key not in self._made), None)
        if wanted is None or wanted == self._asked:
            return
        self._asked = wanted
        done = partial(self._keep, wanted)
        self.worker.request_work(partial(self.prove_program, wanted[0]), done, done)

    def find_proof(self, program: str, offset_revision: int) -> ProvedJob | str | None:
        """Return the proof of a program, the reason why proving failed, or None if still pending."""
        return self._made.get((program, offset_revision))

    def clear_proofs(self) -> None:
        """Discard all proofs, because files and tool shapes may have changed."""
        self._made.clear()
        self._asked = None

    def _keep(self, key: tuple[str, int], made: ProvedJob | str) -> None:
        self._made[key] = made
        self._asked = None
        while len(self._made) > MAX_PROOFS:
            del self._made[next(iter(self._made))]

    def close(self) -> None:
        """Cancel the current proof and stop the worker."""
        self.worker.close()


BOOK_KEY = "jobs"  # name of the queue in the parts book
JOBS_KEY = "Shift+F6"  # name of the key in app.screen.window.key_table


@dataclass(slots=True)
class JobWatch:
    """Monitor of the job queue, which tracks the active job and requests proofs of waiting jobs.

    ``observe_frame`` must be called once per frame. Only the operator loads and starts jobs.
    """

    desk: Desk
    parts_watch: ProductionMonitor
    proofs: JobProofs
    selected_program: str = ""  # program of the job that is selected on the page, which is proved too
    _counted: tuple[str, int] = ("", 0)
    _told: int = 0  # job whose end was reported
    _known: bool = False
    _loading: tuple[JobRow, Path, int] | None = None  # job that is being loaded, with its path and load count

    @property
    def jobs(self) -> tuple[JobRow, ...]:
        """Return the stored jobs of the queue."""
        jobs: tuple[JobRow, ...] = self.parts_watch.production_records.current_data.feature_data.get(
            BOOK_KEY, ()
        )
        return jobs

    @property
    def active_job(self) -> JobRow | None:
        """Return the job for which completed parts are counted, or None if no job is active."""
        return next((row for row in self.jobs if row.is_active), None)

    def is_active_and_loaded(self, job: JobRow) -> bool:
        """Return whether a job is active and its program is loaded.

        After a restart, the program of the active job may not be loaded.
        """
        return job.is_active and self.desk.program_loader.loaded_program.name == job.program

    @property
    def next_job(self) -> JobRow | None:
        """Return the first waiting job in the queue, or None if no job is waiting.

        The active job and jobs whose parts have all been made are not waiting.
        """
        return next((row for row in self.jobs if not row.is_done and not row.is_active), None)

    @property
    def tool_lives(self) -> Mapping[int, ToolLife]:
        """Return the tool life of all tools by tool number."""
        return self.parts_watch.tool_life_monitor.find_tool_lives()

    def observe_frame(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Update the active job, its part target and the proofs.

        This method is called once per frame.
        """
        counter = self.desk.program_runs.part_counter
        if (counter.program_name, counter.part_count) != self._counted:
            self._counted = counter.program_name, counter.part_count
            self.parts_watch.production_records.request_reload()
        self._begin(loaded)
        job = self.active_job
        counter.job_target_count = (
            job.target_part_count if job is not None and job.program == counter.program_name else 0
        )
        self._report_finished(job)
        self._prove(snapshot)

    def _prove(self, snapshot: Snapshot) -> None:
        """Request the proofs of the selected job and the next job.

        While no program runs, request the proofs of all waiting jobs.
        """
        waiting = [row.program for row in self.jobs if not row.is_done and not row.is_active]
        wanted = waiting if snapshot.state not in ACTIVE_STATES else waiting[:1]
        self.proofs.request_proofs(
            [each for each in (self.selected_program, *wanted) if each], self.desk.offset_book.changes
        )

    # --- loading a job -----------------------------------------------------------------------------------

    def load_job(self, job: JobRow) -> None:
        """Load the program of a job that the operator has selected.

        Parts count for the job only after its program is loaded.
        """
        if not self.desk.program_choice.can_choose_program():
            return
        path = self.desk.program_choice.program_folders.find_path(job.program)
        if path is None:
            self.desk.say(
                tr(Message("{name} IS NOT IN THE PROGRAM LIST. F1, THEN F6: CHECK LIST", name=job.program))
            )
            return
        loads = self.desk.program_loader.load_count
        self.desk.program_choice.load_path(path)
        self._loading = job, path, loads

    def _begin(self, loaded: LoadedProgram) -> None:
        """Make the job active after its program is loaded.

        The operator can still cancel loading while the question about an interrupted job is open.
        """
        if self._loading is None:
            return
        job, path, loads = self._loading
        if self.desk.program_loader.load_count != loads:
            self._loading = None
            if loaded.path == path:
                self.parts_watch.production_records.write_change(
                    ProtectedChange.JOBS,
                    lambda connection: job_queue.activate_job(connection, job.id),
                    _nothing,
                    self.parts_watch.report_refusal,
                    Message("job {program} started", program=job.program),
                )
        elif not self.desk.confirmation_key:
            self._loading = None

    # --- messages ------------------------------------------------------------------------------------

    def _report_finished(self, job: JobRow | None) -> None:
        """Report once that the required number of parts of a job has been made.

        Jobs that were complete before TurnDesk started are shown only in the notice.
        """
        if not self.parts_watch.production_records.load_count:
            return
        done = job.id if job is not None and job.is_done else 0
        if done and done != self._told and self._known and job is not None:
            self.desk.show_success(
                Message("{job} {next_words}", job=self._done_words(job), next_words=self._next_words())
            )
        self._told, self._known = done, True

    @staticmethod
    def _done_words(job: JobRow) -> str:
        return tr(
            Message(
                "JOB DONE: {count} OF {expected} PARTS OF {program}.",
                count=job.parts_made,
                expected=job.parts_to_make,
                program=job.program,
            )
        )

    def _next_words(self) -> str:
        job = self.next_job
        if job is None:
            return tr("NO MORE JOBS WAITING.")
        words = tr(
            Message("NEXT: {program}, {left} PARTS", program=job.program, left=job.remaining_part_count)
        )
        return Message("{words}, {job}", words=words, job=self.describe_state(job))

    def describe_state(self, job: JobRow) -> str:
        """Return the state of a waiting job as text: not proved, open items, or ready."""
        made = self.proofs.find_proof(job.program, self.desk.offset_book.changes)
        if made is None:
            return tr("NOT PROVED YET")
        if not isinstance(made, ProvedJob):
            return made
        if made.setup_sheet.error_count:
            return tr("THE PROGRAM HAS ERRORS")
        lacking = count_open_items(made, self.tool_lives, job.remaining_part_count)
        return (
            tr(Message("{count} SETUP ITEMS NOT READY", count=lacking)) if lacking else tr("ALL TOOLS READY")
        )

    def make_notice(self, snapshot: Snapshot) -> NoticeRow | None:
        """Return the notice for the Automatic page that the active job is complete and which job is next.

        The result is None if the active job is not complete, or while a program runs or is interrupted.
        """
        job = self.active_job
        if (
            job is None
            or not job.is_done
            or snapshot.state in ACTIVE_STATES
            or snapshot.interrupted is not None
        ):
            return None
        return NoticeRow(self._done_words(job), self._next_words(), ((JOBS_KEY, "SHIFT+F6"),), "run")

    def find_reminder(self) -> str:
        """Return an empty string, because the job notice is used instead of a reminder."""
        return ""

    def close(self) -> None:
        """Stop the worker."""
        self.proofs.close()


def _nothing() -> None:
    """Do nothing after a change is stored, because the queue shows the change anyway."""
