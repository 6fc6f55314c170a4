"""Model of the program list without Qt: search, sort, preview, load, file commands and transfer."""

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
    """Model of the program list. ``own`` is the operator's folder."""

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
    _after: str = ""  # name to select after the list was read again

    def __post_init__(self) -> None:
        self.transfer.finished = self.look_again
        self.changer = CopyRenameDelete(
            self.desk, self.own, self.persistence, self.worker, lambda: self.program, self._changed
        )

    @property
    def question(self) -> str:
        """Question about a name, or an empty string."""
        return self.changer.question

    @property
    def entry(self) -> Entry:
        """Entry field of the name."""
        return self.changer.entry

    # --- displayed values ----------------------------------------------------------------------------

    def opened(self) -> None:
        """Read the folders and the records when the page opens."""
        self._after = self.desk.session.now.name
        self.look_again()

    def look_again(self) -> None:
        """Read the folders again. The result arrives in a later frame."""
        work = partial(list_programs, self.desk.programs.folders, self.own, self.persistence)
        self.worker.queue(work, self._found, self.desk.refuse)

    def look(self) -> None:
        """Process the results of the worker; called once per frame."""
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
        """Selected program, or None in an empty list."""
        return self.listed[self.marked] if self.marked < len(self.listed) else None

    def sheet(self) -> Sheet:
        """Return the table of programs, or of the folder chooser while it is open."""
        return self.transfer.sheet() if self.transfer.open else sheet_of(self)

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the present function keys."""
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
        """Return whether a character is part of a name, as all are while the folder chooser is closed."""
        return not self.transfer.open and self.find.takes(key)

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select, Enter loads or submits, and letters filter the list."""
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
        """Select a row."""
        if not self.question and self.listed:
            self.desk.clear()
            self.marked = max(0, min(len(self.listed) - 1, row))

    def escape(self) -> bool:
        """Go back one step. Return False if the page can close."""
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
        """Clear questions and filters when the page closes."""
        self.changer.question = self.find.text = ""
        self.transfer.shut()
        self.preview.of(None)
        self._narrow(self.program.name if self.program else "")

    def sort(self) -> None:
        """Sort the list by the next criterion (F2)."""
        self.order = following(ORDERS, self.order)
        self._narrow(self.program.name if self.program else "")

    def may_load(self) -> bool:
        """Return whether the selected program can be loaded, and show the reason if not."""
        if self.program is None or self.program.drawing:
            self.desk.say(NONE if self.program is None else tr(Message(DRAWING, name=self.program.name)))
            return False
        programs = self.desk.programs
        return programs.can_choose() and programs.folders.find(str(self.program.path)) is not None

    def load(self) -> bool:
        """Load the selected program or ask for confirmation.

        Return False if loading is not possible.
        """
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
        """Return the prompt for the present keys."""
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
        """Stop the workers of the list and of the preview."""
        self.worker.close()
        self.preview.close()


# --- rows of the list and details of the selected program ------------------------------------------------

Detail = tuple[str, str]


def sheet_of(model: ProgramList) -> Sheet:
    """Return the table with name, date, last run, parts and best cycle."""
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
    """Return the details of a program.

    The last two texts can be long, and the others are short.
    """
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
