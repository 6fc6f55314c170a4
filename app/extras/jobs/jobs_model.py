"""Model of the JOBS page, independent of Qt: job queue, setup of the selected job, and keys."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from textwrap import wrap

from app.desk.arithmetic import InvalidEntryError
from app.desk.desk import Desk
from app.desk.pages.page_entry import find_program_refusal
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, InputField, TableContent, TableRow, refused
from app.desk.status.formats import NO_VALUE, format_duration
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.extras.jobs.jobs_watch import (
    JobTool,
    JobWatch,
    ProvedJob,
    count_open_items,
    list_job_tools,
    make_tool_label,
    select_important_findings,
)
from app.special.counter_functions import parse_part_count
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.language.diagnostics import Severity
from core.message import Message
from core.store.production import job_queue
from core.store.production.job_queue import MAX_NOTE_LENGTH, JobRow
from core.store.store_errors import StoreError
from core.store.store_file import make_notes_setting_key

NO_JOBS_MESSAGE = "NO JOBS. F3: ADD LOADED PROGRAM   F1, F6, THEN F10: ADD JOB"
NO_PROGRAM_MESSAGE = "F1, THEN F2: LOAD PROGRAM   F1, F6, THEN F10: ADD JOB"
_WIDE = 46  # characters of a cell


@dataclass(slots=True)
class JobsModel:
    """Model of the JOBS page.

    ``entry_kind`` is ``count`` or ``note`` while the operator enters such a value, and otherwise empty. The
    entry is for the selected job or for a new job.
    """

    desk: Desk
    job_watch: JobWatch
    selected_row: int = 0
    entry_kind: str = ""  # "count", "note" or empty
    entry_program: str = ""  # program of the job that is being added
    entry_field: InputField = field(default_factory=InputField)
    _notes: tuple[str, tuple[str, ...]] = ("", ())
    _sheets: tuple[object, TableContent, TableContent] | None = None

    # --- display -------------------------------------------------------------------------------------

    @property
    def jobs(self) -> tuple[JobRow, ...]:
        """Return the jobs of the queue."""
        return self.job_watch.jobs

    @property
    def selected_job(self) -> JobRow | None:
        """Return the selected job, or None if the queue is empty."""
        return self.jobs[self.selected_row] if self.selected_row < len(self.jobs) else None

    @property
    def storage_refusal_reason(self) -> str:
        """Return the reason why jobs cannot be stored, or an empty string if they can be stored."""
        book = self.job_watch.parts_watch.production_records
        return (
            ""
            if book.store is not None
            else book.no_store_reason or tr("JOBS CANNOT BE SAVED: NO DATA STORE")
        )

    def update(self) -> None:
        """Limit the selection to the rows of the queue, and request the proof of the selected job.

        This method is called once per frame.
        """
        self.selected_row = max(0, min(self.selected_row, len(self.jobs) - 1))
        job = self.selected_job
        self.job_watch.selected_program = (
            job.program
            if job is not None and not job.is_done and not self.job_watch.is_active_and_loaded(job)
            else ""
        )

    def find_proof(self, job: JobRow) -> ProvedJob | str | None:
        """Return the proof of a job, the reason why proving failed, or None while the proof is pending."""
        return self.job_watch.proofs.find_proof(job.program, self.desk.offset_book.changes)

    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table of the job queue, with the question that is pending, if any."""
        rows = tuple(self._row(number, job, snapshot) for number, job in enumerate(self.jobs, 1))
        question = ""
        if self.entry_kind == "count":
            name = self.entry_program or (self.selected_job.program if self.selected_job is not None else "")
            question = tr(Message("HOW MANY PARTS OF {program}?", program=name))
        elif self.entry_kind == "note":
            question = tr("NOTE")
        return TableContent(
            "JOBS",
            ("", "PROGRAM", "MADE", "TIME", "STATE"),
            (0.05, 0.36, 0.15, 0.12, 0.32),
            rows,
            self.selected_row if rows else -1,
            entry_prompt=question,
            text=self.entry_field.text,
            notes=(self.storage_refusal_reason,)
            if self.storage_refusal_reason
            else ()
            if rows
            else (NO_JOBS_MESSAGE,),
            untranslated_columns=frozenset({0, 1, 2, 3}),
            numeric_columns=frozenset({2, 3}),
            has_tall_rows=True,
        )

    def _row(self, number: int, job: JobRow, snapshot: Snapshot) -> TableRow:
        made, state, tone = self.find_proof(job), self._state(job), StatusTone.READY
        if job.is_done:
            tone = StatusTone.RUN
        elif isinstance(made, str) or (
            isinstance(made, ProvedJob)
            and count_open_items(made, self.job_watch.tool_lives, job.remaining_part_count)
        ):
            tone = StatusTone.PAUSE
        cycle = made.setup_sheet.cycle_time_s if isinstance(made, ProvedJob) else 0.0
        if job.is_active and self.desk.program_runs.part_counter.program_name == job.program:
            cycle = snapshot.last_cycle or cycle
        left = (
            format_duration(job.remaining_part_count * cycle)
            if cycle and job.remaining_part_count
            else NO_VALUE
        )
        cells = (
            str(number),
            f"{job.program}\n{job.note}",
            f"{job.parts_made}/{job.parts_to_make}",
            left,
            state,
        )
        return TableRow(
            cells,
            job.is_active or job.is_done,
            tone,
            bar_fraction=min(1.0, job.parts_made / job.parts_to_make),
        )

    def _state(self, job: JobRow) -> str:
        if job.is_done:
            return (
                tr("JOB DONE, PROGRAM STILL LOADED")
                if self.job_watch.is_active_and_loaded(job)
                else tr("DONE")
            )
        return (
            tr("IN PROGRESS")
            if self.job_watch.is_active_and_loaded(job)
            else self.job_watch.describe_state(job)
        )

    def make_setup_table(self) -> TableContent:
        """Return the setup table of the selected job, with tools, proof findings and notes."""
        job = self.selected_job
        title = tr("SETUP SHEET") + (f"  ·  {job.program}" if job is not None else "")
        rows = tuple(self._setup_rows(job)) if job is not None else ()
        return TableContent(
            title,
            ("", "", ""),
            (0.13, 0.45, 0.42),
            rows,
            untranslated_columns=frozenset({0, 1, 2}),
            has_tall_rows=True,
        )

    def _setup_rows(self, job: JobRow) -> Iterator[TableRow]:
        made = self.find_proof(job)
        if isinstance(made, str):
            yield TableRow((tr("PROOF"), _folded(made), ""), True, StatusTone.ALARM)
        elif made is None:
            words = tr("PROVING …")
            if self.job_watch.is_active_and_loaded(job) or job.is_done:
                words = (
                    tr("PROGRAM LOADED. SEE ERRORS AND WARNINGS ON PART PAGE (B)")
                    if not job.is_done
                    else tr("DONE")
                )
            yield TableRow((tr("PROOF"), words, ""), False)
        else:
            yield from self._proved_rows(job, made)
        for number, text in enumerate(self.read_setup_notes(job.program), 1):
            yield TableRow((f"{tr('NOTE')} {number}", text, ""))

    def _proved_rows(self, job: JobRow, made: ProvedJob) -> Iterator[TableRow]:
        sheet = made.setup_sheet
        for station in list_job_tools(made, self.job_watch.tool_lives, job.remaining_part_count):
            yield self._station(station, made)
        for each in select_important_findings(sheet):
            name = tr(Message("LINE {line}", line=each.line)) if each.line else tr("PROOF")
            tone = StatusTone.ALARM if each.severity is Severity.ERROR else StatusTone.PAUSE
            yield TableRow((name, _folded(tr(each.message)), _folded(tr(each.hint))), True, tone)
        yield TableRow((tr("STOCK"), sheet.stock_text, ""))
        for name, words in sheet.clamping_texts:
            yield TableRow((name, words, ""))

    @staticmethod
    def _station(station: JobTool, made: ProvedJob) -> TableRow:
        tool = station.tool
        lacks = _folded("; ".join(station.required_actions)) or tr("ready")
        words = f"{made.setup_sheet.describe_tool_shape(tool)}\n{made.setup_sheet.format_offset(tool)}"
        return TableRow((make_tool_label(tool.tool_number), words, lacks), bool(station.required_actions),
                   StatusTone.PAUSE if station.required_actions else StatusTone.RUN)  # fmt: skip

    def read_setup_notes(self, program: str) -> Sequence[str]:
        """Return the notes that are stored for the setup sheet of a program."""
        if self._notes[0] != program:
            try:
                kept = self.desk.program_runs.part_counter.persistence.read_setting(
                    make_notes_setting_key(program)
                )
            except StoreError:
                kept = None
            texts = kept if isinstance(kept, list) else []
            self._notes = program, tuple(each for each in texts if isinstance(each, str))
        return self._notes[1]

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        if self.entry_kind:
            return "TYPE THE ENTRY   ENTER: ACCEPT   ESC: CANCEL"
        if self.selected_job is None:
            return NO_JOBS_MESSAGE if self.desk.program_loader.loaded_program.name else NO_PROGRAM_MESSAGE
        if self.load_refusal_reason:
            return "CANNOT LOAD: MACHINE MOVING OR PROGRAM RUNNING. ESC: BACK"
        return "F2: LOAD JOB ONLY   CYCLE START: RUN   ESC: AUTOMATIC"

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys.

        During an entry there are no function keys, because Enter or Esc ends the entry.
        """
        if self.entry_kind:
            return {}
        none = self.selected_job is None
        notes_barred = none or self.desk.read_snapshot().state in ACTIVE_STATES
        return {
            "F3": FunctionKey("ADD", self.add_job, barred=not self.desk.program_loader.loaded_program.name),
            "F4": FunctionKey("QUANTITY", partial(self._ask, "count"), barred=none),
            "F5": FunctionKey("UP", partial(self.move_job, -1), barred=none),
            "F6": FunctionKey("DOWN", partial(self.move_job, 1), barred=none),
            "F8": FunctionKey("NOTE", partial(self._ask, "note"), barred=notes_barred),
            "F9": FunctionKey("REMOVE", self.remove_job, barred=none),
            "F10": FunctionKey("CLEAR", self.clear_finished_jobs),
        }

    @property
    def load_refusal_reason(self) -> str:
        """Return the reason why the selected job cannot be loaded, or an empty string if it can be loaded."""
        return (
            NO_JOBS_MESSAGE if self.selected_job is None else find_program_refusal(self.desk.read_snapshot())
        )

    def can_load_job(self) -> bool:
        """Return whether the selected job can be loaded. If it cannot, show the reason."""
        if why := self.load_refusal_reason:
            self.desk.say(why)
        return not why

    def load_job(self) -> None:
        """Load the selected job.

        Loading does not start a cycle; only the palm buttons can do that.
        """
        job = self.selected_job
        if job is not None:
            self.job_watch.load_job(job)

    def add_job(self) -> None:
        """Start the entry of a job for the loaded program by asking for the number of parts."""
        name = self.desk.program_loader.loaded_program.name
        if not name:
            self.desk.say(NO_PROGRAM_MESSAGE)
            return
        self.start_job_entry(name)

    def start_job_entry(self, name: str) -> None:
        """Start the entry of a job for the given program by asking for the number of parts."""
        self.desk.clear_prompt_line()
        self.entry_kind, self.entry_program, self.entry_field = "count", name, InputField()

    def _ask(self, what: str) -> None:
        job = self.selected_job
        if job is None:
            self.desk.say(NO_JOBS_MESSAGE)
        elif what == "note" and self.desk.read_snapshot().state in ACTIVE_STATES:
            self.desk.say("NO NOTES DURING A CYCLE: LETTER KEYS WOULD STOP THE MACHINE")
        else:
            self.desk.clear_prompt_line()
            text = job.note if what == "note" else ""
            self.entry_kind, self.entry_program, self.entry_field = (
                what,
                "",
                InputField(words=what == "note", text=text),
            )

    def move_job(self, steps: int) -> None:
        """Move the selected job up or down in the queue by a number of steps."""
        job, to = self.selected_job, self.selected_row + 1 + steps
        if job is None:
            self.desk.say(NO_JOBS_MESSAGE)
        elif 1 <= to <= len(self.jobs):
            self.desk.clear_prompt_line()
            self._write(
                lambda c: job_queue.move_job(c, job.id, to),
                partial(self._mark, to - 1),
                Message("job {program}: moved to position {to}", program=job.program, to=to),
            )

    def _mark(self, row: int) -> None:
        self.selected_row = row

    def remove_job(self) -> None:
        """Remove the selected job after the operator confirms.

        The part count of the program is not changed.
        """
        job = self.selected_job
        if job is None:
            self.desk.say(NO_JOBS_MESSAGE)
            return
        words = tr("{program}: {made} OF {wanted} MADE. Y: REMOVE FROM QUEUE   N: KEEP")
        words = tr(Message(words, program=job.program, made=job.parts_made, wanted=job.parts_to_make))
        self.desk.ask_operator(
            words,
            partial(
                self._write,
                lambda c: job_queue.remove_job(c, job.id),
                change=Message("job {program} removed", program=job.program),
            ),
        )

    def clear_finished_jobs(self) -> None:
        """Remove all jobs whose required number of parts has been made, after the operator confirms."""
        done = sum(job.is_done for job in self.jobs)
        if not done:
            self.desk.show_success("NO FINISHED JOBS TO CLEAR")
            return
        words = tr("Y: REMOVE {count} FINISHED JOBS FROM THE QUEUE   N: KEEP THEM")
        self.desk.ask_operator(tr(Message(words, count=done)), partial(self._write, _clear_done))

    def _write(
        self,
        operation: Callable[[sqlite3.Connection], object],
        done: Callable[[], None] = lambda: None,
        change: str = "finished jobs removed from the job queue",
    ) -> None:
        self.desk.clear_prompt_line()
        self.job_watch.parts_watch.production_records.write_change(
            ProtectedChange.JOBS, operation, done, self.job_watch.parts_watch.report_refusal, change
        )

    def handle_key(self, key: str) -> bool:
        """Handle a key and return whether it was used.

        During an entry, keys edit the entry. Otherwise the arrow keys select a job.
        """
        if not self.entry_kind:
            if key in ROW_STEPS and self.jobs:
                self.select_row(self.selected_row + ROW_STEPS[key])
                return True
            return False
        if key == "Enter":
            self._answer()
        elif self.entry_kind == "note" and len(self.entry_field.text) >= MAX_NOTE_LENGTH and len(key) == 1:
            self.desk.say(tr(Message("NOTE TOO LONG: {maximum} CHARACTERS AT MOST", maximum=MAX_NOTE_LENGTH)))
        elif self.entry_field.handle_key(key):
            self.desk.clear_prompt_line()
        else:
            return False
        return True

    def _answer(self) -> None:
        text, job = self.entry_field.text.strip(), self.selected_job
        if self.entry_kind == "note":
            if job is not None:
                self._write(
                    lambda c: job_queue.edit_job(c, job.id, job.parts_to_make, text),
                    change=Message("job {program}: {text}", program=job.program, text=text),
                )
            self.entry_kind = ""
            return
        try:
            wanted = parse_part_count(text)
        except InvalidEntryError as error:
            self.entry_field.text = refused(self.entry_field.text)
            self.desk.show_refusal(str(error))
            return
        program, last = self.entry_program, len(self.jobs)
        if program:
            self._write(
                lambda c: job_queue.add_job(c, program, wanted),
                partial(self._mark, last),
                Message("job {program} added: {expected} parts", program=program, expected=wanted),
            )
        elif job is not None:
            self._write(
                lambda c: job_queue.edit_job(c, job.id, wanted, job.note),
                change=Message(
                    "job {program}: quantity changed: {expected} → {expected2} parts",
                    program=job.program,
                    expected=job.parts_to_make,
                    expected2=wanted,
                ),
            )
        self.entry_kind = ""

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the open entry."""
        return bool(self.entry_kind) and self.entry_field.accepts_key(key)

    def select_row(self, row: int) -> None:
        """Select a job by its row number, unless an entry is open."""
        if not self.entry_kind and self.jobs:
            self.desk.clear_prompt_line()
            self.selected_row = max(0, min(len(self.jobs) - 1, row))

    def on_open(self) -> None:
        """Discard cached notes and proofs when the page opens.

        Programs and tool shapes can have changed while the page was closed.
        """
        self._notes = "", ()
        self.job_watch.proofs.clear_proofs()

    def handle_escape(self) -> bool:
        """Clear the message or cancel the entry, and return False if the page can close."""
        if self.desk.prompt_notice:
            self.desk.clear_prompt_line()
        elif self.entry_kind:
            self.entry_kind = ""
        else:
            return False
        return True

    def on_close(self) -> None:
        """Cancel the entry when the page closes. The selected job's proof then no longer has priority."""
        self.entry_kind, self.job_watch.selected_program = "", ""

    def close(self) -> None:
        """Do nothing because the job watch is closed separately."""


def _folded(text: str) -> str:
    """Return a text wrapped to at most two lines for a table cell."""
    first, *more = wrap(text, _WIDE) or [""]
    return f"{first}\n{' '.join(more)}" if more else first


def _clear_done(connection: sqlite3.Connection) -> None:
    job_queue.clear(connection, remove_all=False)
