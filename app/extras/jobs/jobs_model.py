"""Model of the page JOBS without Qt: queue, setup of the selected job, and keys."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from textwrap import wrap

from app.desk.arithmetic import EntryError
from app.desk.desk import Desk
from app.desk.pages.page_entry import program_barred
from app.desk.pages.sheet import STEPS, Entry, Key, Row, Sheet, refused
from app.desk.status.formats import NOTHING, duration
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.extras.jobs.jobs_watch import JobsWatch, ProvedJob, Station, findings, missing, stations, tool_name
from app.special.counters import whole_number
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.language.diagnostics import Severity
from core.message import Message
from core.store.production import job_queue
from core.store.production.job_queue import NOTE_LONGEST, JobRow
from core.store.store_errors import StoreError
from core.store.store_file import notes_key

NONE_YET = "NO JOBS. F3: ADD LOADED PROGRAM   F1, F6, THEN F10: ADD JOB"
NO_PROGRAM = "F1, THEN F2: LOAD PROGRAM   F1, F6, THEN F10: ADD JOB"
_WIDE = 46  # characters of a cell


@dataclass(slots=True)
class JobsModel:
    """Model of the page JOBS.

    ``asking`` is the entry of a count or note for the selected or a new job.
    """

    desk: Desk
    watch: JobsWatch
    marked: int = 0
    asking: str = ""  # "count", "note" or empty
    program: str = ""  # program of the job that is being added
    entry: Entry = field(default_factory=Entry)
    _notes: tuple[str, tuple[str, ...]] = ("", ())
    _sheets: tuple[object, Sheet, Sheet] | None = None

    # --- display -------------------------------------------------------------------------------------

    @property
    def jobs(self) -> tuple[JobRow, ...]:
        """Jobs of the queue."""
        return self.watch.jobs

    @property
    def job(self) -> JobRow | None:
        """Selected job, or None."""
        return self.jobs[self.marked] if self.marked < len(self.jobs) else None

    @property
    def locked(self) -> str:
        """Reason why jobs are not stored, or an empty string."""
        book = self.watch.parts.book
        return "" if book.store is not None else book.away or tr("JOBS CANNOT BE SAVED: NO DATA STORE")

    def look(self) -> None:
        """Limit the selection and request the proof of the selected job; called once per frame."""
        self.marked = max(0, min(self.marked, len(self.jobs) - 1))
        job = self.job
        self.watch.also = (
            job.program if job is not None and not job.done and not self.watch.on_desk(job) else ""
        )

    def proof_of(self, job: JobRow) -> ProvedJob | str | None:
        """Return the job's proof, the reason why proving failed, or None while it is pending."""
        return self.watch.proofs.of(job.program, self.desk.book.changes)

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table of the queue with the question below."""
        rows = tuple(self._row(number, job, snapshot) for number, job in enumerate(self.jobs, 1))
        question = ""
        if self.asking == "count":
            name = self.program or (self.job.program if self.job is not None else "")
            question = tr(Message("HOW MANY PARTS OF {program}?", program=name))
        elif self.asking == "note":
            question = tr("NOTE")
        return Sheet(
            "JOBS",
            ("", "PROGRAM", "MADE", "TIME", "STATE"),
            (0.05, 0.36, 0.15, 0.12, 0.32),
            rows,
            self.marked if rows else -1,
            question=question,
            text=self.entry.text,
            notes=(self.locked,) if self.locked else () if rows else (NONE_YET,),
            raw=frozenset({0, 1, 2, 3}),
            figures=frozenset({2, 3}),
            tall=True,
        )

    def _row(self, number: int, job: JobRow, snapshot: Snapshot) -> Row:
        made, state, tone = self.proof_of(job), self._state(job), Tone.READY
        if job.done:
            tone = Tone.RUN
        elif isinstance(made, str) or (
            isinstance(made, ProvedJob) and missing(made, self.watch.lives, job.left)
        ):
            tone = Tone.PAUSE
        cycle = made.sheet.cycle if isinstance(made, ProvedJob) else 0.0
        if job.under_way and self.desk.runs.counter.program == job.program:
            cycle = snapshot.last_cycle or cycle
        left = duration(job.left * cycle) if cycle and job.left else NOTHING
        cells = (str(number), f"{job.program}\n{job.note}", f"{job.made}/{job.wanted}", left, state)
        return Row(cells, job.under_way or job.done, tone, bar=min(1.0, job.made / job.wanted))

    def _state(self, job: JobRow) -> str:
        if job.done:
            return tr("JOB DONE, PROGRAM STILL LOADED") if self.watch.on_desk(job) else tr("DONE")
        return tr("IN PROGRESS") if self.watch.on_desk(job) else self.watch.state_words(job)

    def setup(self) -> Sheet:
        """Return the setup table of the selected job: tools, findings of the proof, and notes."""
        job = self.job
        title = tr("SETUP SHEET") + (f"  ·  {job.program}" if job is not None else "")
        rows = tuple(self._setup_rows(job)) if job is not None else ()
        return Sheet(title, ("", "", ""), (0.13, 0.45, 0.42), rows, raw=frozenset({0, 1, 2}), tall=True)

    def _setup_rows(self, job: JobRow) -> Iterator[Row]:
        made = self.proof_of(job)
        if isinstance(made, str):
            yield Row((tr("PROOF"), _folded(made), ""), True, Tone.ALARM)
        elif made is None:
            words = tr("PROVING …")
            if self.watch.on_desk(job) or job.done:
                words = (
                    tr("PROGRAM LOADED. SEE ERRORS AND WARNINGS ON PART PAGE (B)")
                    if not job.done
                    else tr("DONE")
                )
            yield Row((tr("PROOF"), words, ""), False)
        else:
            yield from self._proved_rows(job, made)
        for number, text in enumerate(self.notes_of(job.program), 1):
            yield Row((f"{tr('NOTE')} {number}", text, ""))

    def _proved_rows(self, job: JobRow, made: ProvedJob) -> Iterator[Row]:
        sheet = made.sheet
        for station in stations(made, self.watch.lives, job.left):
            yield self._station(station, made)
        for each in findings(sheet):
            name = tr(Message("LINE {line}", line=each.line)) if each.line else tr("PROOF")
            tone = Tone.ALARM if each.severity is Severity.ERROR else Tone.PAUSE
            yield Row((name, _folded(tr(each.message)), _folded(tr(each.hint))), True, tone)
        yield Row((tr("STOCK"), sheet.stock_words, ""))
        for name, words in sheet.held_words:
            yield Row((name, words, ""))

    @staticmethod
    def _station(station: Station, made: ProvedJob) -> Row:
        tool = station.tool
        lacks = _folded("; ".join(station.lacks)) or tr("ready")
        words = f"{made.sheet.shape_words(tool)}\n{made.sheet.offset_words(tool)}"
        return Row((tool_name(tool.number), words, lacks), bool(station.lacks),
                   Tone.PAUSE if station.lacks else Tone.RUN)  # fmt: skip

    def notes_of(self, program: str) -> Sequence[str]:
        """Return the notes of the program's setup sheet (F10)."""
        if self._notes[0] != program:
            try:
                kept = self.desk.runs.counter.persistence.read_setting(notes_key(program))
            except StoreError:
                kept = None
            texts = kept if isinstance(kept, list) else []
            self._notes = program, tuple(each for each in texts if isinstance(each, str))
        return self._notes[1]

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.asking:
            return "TYPE THE ENTRY   ENTER: ACCEPT   ESC: CANCEL"
        if self.job is None:
            return NONE_YET if self.desk.session.now.name else NO_PROGRAM
        if self.load_barred:
            return "CANNOT LOAD: MACHINE MOVING OR PROGRAM RUNNING. ESC: BACK"
        return "F2: LOAD JOB ONLY   CYCLE START: RUN   ESC: AUTOMATIC"

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys; none during an entry, which Enter and Esc end."""
        if self.asking:
            return {}
        none = self.job is None
        notes_barred = none or self.desk.snapshot().state in UNDER_WAY
        return {
            "F3": Key("ADD", self.add, barred=not self.desk.session.now.name),
            "F4": Key("QUANTITY", partial(self._ask, "count"), barred=none),
            "F5": Key("UP", partial(self.move, -1), barred=none),
            "F6": Key("DOWN", partial(self.move, 1), barred=none),
            "F8": Key("NOTE", partial(self._ask, "note"), barred=notes_barred),
            "F9": Key("REMOVE", self.remove, barred=none),
            "F10": Key("CLEAR", self.clear),
        }

    @property
    def load_barred(self) -> str:
        """Reason why the selected job cannot be loaded, or an empty string."""
        return NONE_YET if self.job is None else program_barred(self.desk.snapshot())

    def may_load(self) -> bool:
        """Return whether the selected job can be loaded, and show the reason if not."""
        if why := self.load_barred:
            self.desk.say(why)
        return not why

    def load(self) -> None:
        """Load the selected job. Only the palm buttons start its cycle."""
        job = self.job
        if job is not None:
            self.watch.load(job)

    def add(self) -> None:
        """Add a job for the loaded program. The number of parts is asked."""
        name = self.desk.session.now.name
        if not name:
            self.desk.say(NO_PROGRAM)
            return
        self.add_program(name)

    def add_program(self, name: str) -> None:
        """Add a job for a program. The number of parts is asked."""
        self.desk.clear()
        self.asking, self.program, self.entry = "count", name, Entry()

    def _ask(self, what: str) -> None:
        job = self.job
        if job is None:
            self.desk.say(NONE_YET)
        elif what == "note" and self.desk.snapshot().state in UNDER_WAY:
            self.desk.say("NO NOTES DURING A CYCLE: LETTER KEYS WOULD STOP THE MACHINE")
        else:
            self.desk.clear()
            text = job.note if what == "note" else ""
            self.asking, self.program, self.entry = what, "", Entry(words=what == "note", text=text)

    def move(self, by: int) -> None:
        """Move the selected job up or down the queue."""
        job, to = self.job, self.marked + 1 + by
        if job is None:
            self.desk.say(NONE_YET)
        elif 1 <= to <= len(self.jobs):
            self.desk.clear()
            self._write(
                lambda c: job_queue.move(c, job.id, to),
                partial(self._mark, to - 1),
                Message("job {program}: moved to position {to}", program=job.program, to=to),
            )

    def _mark(self, row: int) -> None:
        self.marked = row

    def remove(self) -> None:
        """Remove the selected job after confirmation. The part count of its program remains."""
        job = self.job
        if job is None:
            self.desk.say(NONE_YET)
            return
        words = tr("{program}: {made} OF {wanted} MADE. Y: REMOVE FROM QUEUE   N: KEEP")
        words = tr(Message(words, program=job.program, made=job.made, wanted=job.wanted))
        self.desk.ask(
            words,
            partial(
                self._write,
                lambda c: job_queue.remove(c, job.id),
                change=Message("job {program} removed", program=job.program),
            ),
        )

    def clear(self) -> None:
        """Remove finished jobs after confirmation."""
        done = sum(job.done for job in self.jobs)
        if not done:
            self.desk.done("NO FINISHED JOBS TO CLEAR")
            return
        words = tr("Y: REMOVE {count} FINISHED JOBS FROM THE QUEUE   N: KEEP THEM")
        self.desk.ask(tr(Message(words, count=done)), partial(self._write, _clear_done))

    def _write(
        self,
        operation: Callable[[sqlite3.Connection], object],
        done: Callable[[], None] = lambda: None,
        change: str = "finished jobs removed from the job queue",
    ) -> None:
        self.desk.clear()
        self.watch.parts.book.write(Act.JOBS, operation, done, self.watch.parts.refuse, change)

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select a job, and other keys edit the entry."""
        if not self.asking:
            if key in STEPS and self.jobs:
                self.choose(self.marked + STEPS[key])
                return True
            return False
        if key == "Enter":
            self._answer()
        elif self.asking == "note" and len(self.entry.text) >= NOTE_LONGEST and len(key) == 1:
            self.desk.say(tr(Message("NOTE TOO LONG: {maximum} CHARACTERS AT MOST", maximum=NOTE_LONGEST)))
        elif self.entry.type(key):
            self.desk.clear()
        else:
            return False
        return True

    def _answer(self) -> None:
        text, job = self.entry.text.strip(), self.job
        if self.asking == "note":
            if job is not None:
                self._write(
                    lambda c: job_queue.change(c, job.id, job.wanted, text),
                    change=Message("job {program}: {text}", program=job.program, text=text),
                )
            self.asking = ""
            return
        try:
            wanted = whole_number(text)
        except EntryError as error:
            self.entry.text = refused(self.entry.text)
            self.desk.refuse(str(error))
            return
        program, last = self.program, len(self.jobs)
        if program:
            self._write(
                lambda c: job_queue.add(c, program, wanted),
                partial(self._mark, last),
                Message("job {program} added: {expected} parts", program=program, expected=wanted),
            )
        elif job is not None:
            self._write(
                lambda c: job_queue.change(c, job.id, wanted, job.note),
                change=Message(
                    "job {program}: quantity changed: {expected} → {expected2} parts",
                    program=job.program,
                    expected=job.wanted,
                    expected2=wanted,
                ),
            )
        self.asking = ""

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the entry."""
        return bool(self.asking) and self.entry.takes(key)

    def choose(self, row: int) -> None:
        """Select a row."""
        if not self.asking and self.jobs:
            self.desk.clear()
            self.marked = max(0, min(len(self.jobs) - 1, row))

    def opened(self) -> None:
        """Discard cached notes and proofs when the page opens.

        Programs and shapes can have changed.
        """
        self._notes = "", ()
        self.watch.proofs.anew()

    def escape(self) -> bool:
        """Go back one step. Return False if the page can close."""
        if self.desk.notice:
            self.desk.clear()
        elif self.asking:
            self.asking = ""
        else:
            return False
        return True

    def leave(self) -> None:
        """Cancel the entry when the page closes. Then only the next job is proved."""
        self.asking, self.watch.also = "", ""

    def close(self) -> None:
        """Do nothing, because the watch is closed separately."""


def _folded(text: str) -> str:
    """Return a text folded into the two lines of a cell."""
    first, *more = wrap(text, _WIDE) or [""]
    return f"{first}\n{' '.join(more)}" if more else first


def _clear_done(connection: sqlite3.Connection) -> None:
    job_queue.clear(connection, everything=False)
