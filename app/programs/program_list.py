"""The list of programs: find, sort, look, load, copy, rename, delete, import, export. No Qt, no waiting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.page_entry import BY_HAND
from app.desk.pages.sheet import STEPS, Entry, Key, Row, Sheet, following
from app.desk.persistence import Persistence
from app.desk.status import formats
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.programs.copy_rename_delete import COPY, NONE, RENAME, CopyRenameDelete
from app.programs.import_export import ImportExport
from app.programs.program_rows import (
    ORDERS,
    Preview,
    Program,
    list_programs,
    minute_of,
    minute_of_file,
    sorted_by,
)
from core.message import Message, join_messages

DRAWING = "{name} IS A DRAWING. F3: MAKE A PROGRAM FROM IT"


@dataclass(slots=True)
class ProgramList:
    """``own`` is the operator's folder."""

    desk: Desk
    own: Path
    persistence: Persistence
    worker: Latest
    preview: Preview
    transfer: ImportExport
    order: str = "NAME"
    marked: int = 0
    find: Entry = field(default_factory=lambda: Entry(words=True))
    all: tuple[Program, ...] = ()
    listed: tuple[Program, ...] = ()
    changer: CopyRenameDelete = field(init=False)
    _after: str = ""  # the name to mark when the list has been read again

    def __post_init__(self) -> None:
        self.transfer.finished = self.look_again
        self.changer = CopyRenameDelete(
            self.desk, self.own, self.persistence, self.worker, lambda: self.program, self._changed
        )

    @property
    def question(self) -> str:
        """What is asked about a name; empty: nothing."""
        return self.changer.question

    @property
    def entry(self) -> Entry:
        """The name that is being typed."""
        return self.changer.entry

    # --- what is shown -------------------------------------------------------------------------------

    def opened(self) -> None:
        """The page comes up: read the folders and the records."""
        self._after = self.desk.session.now.name
        self.look_again()

    def look_again(self) -> None:
        """Read the folders again; the answer comes with a later frame."""
        work = partial(list_programs, self.desk.programs.folders, self.own, self.persistence)
        self.worker.queue(work, self._found, self.desk.refuse)

    def look(self) -> None:
        """Once a frame: take what the worker has found."""
        self.worker.poll()

    def _found(self, found: tuple[Program, ...]) -> None:
        name = self._after or (self.program.name if self.program else "")
        self._after, self.all = "", found
        self._narrow(name)

    def _narrow(self, mark: str = "") -> None:
        part = self.find.text.strip().lower()
        found = [program for program in self.all if part in program.name.lower()]
        self.listed = sorted_by(self.order, found)
        names = [program.name for program in self.listed]
        self.marked = names.index(mark) if mark in names else 0

    @property
    def program(self) -> Program | None:
        """The marked program; None where the list is empty."""
        return self.listed[self.marked] if self.marked < len(self.listed) else None

    def sheet(self) -> Sheet:
        """The list, or the chooser of folders over it."""
        return self.transfer.sheet() if self.transfer.open else sheet_of(self)

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Function keys of this moment."""
        if self.transfer.open:
            return self.transfer.keys()
        return {
            "F2": Key("SORT", self.sort),
            "F4": Key("COPY", lambda: self.changer.ask(COPY)),
            "F5": Key("RENAME", lambda: self.changer.ask(RENAME), barred=self.changer.fixed),
            "F6": Key("DELETE", self.changer.delete, barred=self.changer.fixed),
            "F8": Key("IMPORT", lambda: self._transfer(out=False)),
            "F9": Key("EXPORT", lambda: self._transfer(out=True)),
        }

    def takes(self, key: str) -> bool:
        """Return whether a character is part of a name: all are, except while folders are chosen."""
        return not self.transfer.open and self.find.takes(key)

    def typed(self, key: str) -> bool:
        """Arrows mark, Return loads or answers, letters find."""
        if self.transfer.open:
            return self.transfer.typed(key)
        if key in STEPS and not self.question:
            self.choose(self.marked + STEPS[key])
        elif key == "Enter":
            self.changer.answer() if self.question else self.load()
        elif (self.entry if self.question else self.find).type(key):
            self.desk.clear()
            if not self.question:
                self._narrow(self.program.name if self.program else "")
        else:
            return False
        return True

    def choose(self, row: int) -> None:
        """Mark a row."""
        if not self.question and self.listed:
            self.desk.clear()
            self.marked = max(0, min(len(self.listed) - 1, row))

    def escape(self) -> bool:
        """Go one step back; False: the page may be left."""
        if self.desk.notice:
            self.desk.clear()
        elif self.transfer.open:
            self.transfer.escape()
        elif self.question:
            self.changer.question = ""
        elif self.find.text:
            self.find.text = ""
            self._narrow(self.program.name if self.program else "")
        else:
            return False
        return True

    def leave(self) -> None:
        """The page goes: nothing stays half asked."""
        self.changer.question = self.find.text = ""
        self.transfer.shut()
        self.preview.of(None)
        self._narrow(self.program.name if self.program else "")

    def sort(self) -> None:
        """F2: sort the list by the next of the orders."""
        self.order = following(ORDERS, self.order)
        self._narrow(self.program.name if self.program else "")

    def may_load(self) -> bool:
        """Whether the marked program can become that of the desk; why not is said."""
        if self.program is None or self.program.drawing:
            self.desk.say(NONE if self.program is None else tr(Message(DRAWING, name=self.program.name)))
            return False
        programs = self.desk.programs
        return programs.can_choose() and programs.folders.find(str(self.program.path)) is not None

    def load(self) -> bool:
        """The marked program becomes that of the desk, or that is asked; True when it can."""
        program = self.program
        return self.may_load() and program is not None and self.desk.programs.choose(str(program.path))

    def _changed(self, name: str) -> None:
        self._after = name
        self.look_again()

    def _transfer(self, *, out: bool) -> None:
        if out and self.program is None:
            self.desk.say(NONE)
        else:
            self.desk.clear()
            self.transfer.begin(
                tuple(p.path for p in self.listed),
                self.program.path if self.program else None,
                out,
            )

    def prompt(self) -> str:
        """What the keys do now, for the prompt line."""
        if self.transfer.open:
            return self.transfer.prompt()
        if self.question:
            return "TYPE A NAME   BACKSPACE: EDIT   ENTER: ACCEPT   ESC: CANCEL"
        if self.find.text and not self.listed:
            return tr("NO PROGRAM NAME CONTAINS THIS TEXT. F3: NEW PROGRAM")
        if self.desk.snapshot().state in BY_HAND:
            return "TYPE PART OF A NAME   PAUSE: FEED HOLD   ESC: AUTOMATIC"
        if self.desk.snapshot().state in UNDER_WAY:
            return "TYPE PART OF NAME   F3: EDIT   PAUSE: FEED HOLD   ESC: BACK"
        return "TYPE PART OF A NAME OR USE ARROWS   ENTER: LOAD   ESC: BACK"

    def close(self) -> None:
        """End the workers of the list and of the preview."""
        self.worker.close()
        self.preview.close()


# --- how the list and the marked program are written -----------------------------------------------------

Detail = tuple[str, str]


def sheet_of(model: ProgramList) -> Sheet:
    """The list: name, date, last run, parts, best cycle."""
    rows = tuple(_row(program) for program in model.listed)
    count = (
        Message(
            "{listed_count} OF {all_count} PROGRAMS", listed_count=len(model.listed), all_count=len(model.all)
        )
        if model.find.text
        else Message("{rows_count} PROGRAMS", rows_count=len(rows))
    )
    question, text = model.question, model.entry.text
    if not question:
        question, text = "NAME TO FIND OR CREATE", model.find.text
    return Sheet(
        Message("PROGRAMS  ·  {count}  ·  SORTED BY {order}", count=count, order=model.order),
        ("NAME", "CHANGED", "LAST RUN", "PARTS", "BEST"),
        (0.32, 0.25, 0.25, 0.09, 0.09),
        rows,
        model.marked if rows else -1,
        question=question,
        text=text,
        raw=frozenset({0, 1, 2}),
        figures=frozenset({3, 4}),
    )


def _row(program: Program) -> Row:
    run = program.run
    best = formats.duration(run.best) if run.best is not None else formats.NOTHING
    cells = (program.name, minute_of_file(program.changed), minute_of(run.started), str(run.parts), best)
    good = run.proof == "PROVED"
    lit = None if not run.proof else good
    return Row(cells, lit, Tone.RUN if good else Tone.ALARM)


def details_of(program: Program) -> tuple[Detail, ...]:
    """All that is known of the marked program; the last two may be long, the others are short."""
    run = program.run
    return (
        ("SIZE", formats.file_size(program.size)),
        ("TYPE", "DRAWING" if program.drawing else "SAMPLE" if program.sample else "USER PROGRAM"),
        ("PARTS", str(run.parts)),
        ("BEST CYCLE", _time(run.best)),
        ("LAST CYCLE", _time(run.latest)),
        ("PLANNED TIME", _time(run.planned)),
        (
            "LAST RUN",
            join_messages("  ·  ", (minute_of(run.started), run.outcome))
            if run.outcome
            else minute_of(run.started),
        ),
        (
            "LAST PROOF",
            join_messages("  ·  ", (run.proof, minute_of(run.proved))) if run.proof else "NEVER PROVED",
        ),
    )


def _time(seconds: float | None) -> str:
    return formats.duration(seconds) if seconds is not None else formats.NOTHING
