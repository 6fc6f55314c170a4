"""Setup sheet of the loaded program on F10: rows, notes, and saving as a file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Entry, Key, Row, Sheet
from app.desk.persistence import Persistence
from app.desk.translation import tr
from app.programs.removable_media import Stick, sticks
from app.report.pdf_file import Paper
from app.special.backup_and_restore import Place
from app.special.special_functions import SpecialFunction
from core.access.access_table import Act
from core.executor.job import Job
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store_errors import StoreError
from core.store.store_file import notes_key

if TYPE_CHECKING:
    from app.special.setup_sheet_work import MadeSheet

NO_PROGRAM = "CHOOSE A PROGRAM FIRST: EACH PROGRAM HAS ITS OWN SETUP SHEET"
MOST_NOTES, LONGEST = 30, 200
_PAPER = "paper"  # name of the setting
_WIDTHS = (0.15, 0.63, 0.22)


class SetupSheetFunction(SpecialFunction):
    """Special function for the setup sheet and its notes. F6 lists the places for saving."""

    name = "SETUP SHEET"
    use = "tools, stock, stops, notes; printable"

    def __init__(
        self,
        desk: Desk,
        machine: Machine,
        persistence: Persistence,
        worker: Latest,
        folder: Path,
        plugged: Callable[[], Sequence[Stick]] = sticks,
    ) -> None:
        super().__init__(desk)
        self.machine, self.persistence, self.worker = machine, persistence, worker
        self.folder, self.plugged = folder, plugged
        self.made: MadeSheet | None = None
        self.trouble = ""
        self.entry: Entry | None = None  # a note is being typed
        self.places: tuple[Place, ...] = ()  # places to choose from
        self.busy = ""
        self._asked: Job | None = None  # job whose sheet is being prepared
        self._changing: int | None = None  # index of the note being changed; None for a new note
        self._notes_of: tuple[str, list[str]] = ("", [])
        self._paper: Paper | None = None  # None: not loaded yet

    # --- display -------------------------------------------------------------------------------------

    @property
    def program(self) -> str:
        """Name of the loaded program, or an empty string."""
        return self.desk.session.now.name

    @property
    def notes(self) -> list[str]:
        """Notes about the program."""
        program = self.program
        if self._notes_of[0] != program:
            self._notes_of = program, _texts(self._kept(notes_key(program))) if program else []
        return self._notes_of[1]

    def _kept(self, key: str) -> object:
        try:
            return self.persistence.read_setting(key)
        except StoreError:
            return None  # TurnDesk itself reports that nothing is stored.

    @property
    def paper(self) -> Paper:
        """Paper size of the PDF: the stored choice, or else the default for the program's unit."""
        if self._paper is None:
            kept = self._kept(_PAPER)
            usual = Paper.A4 if self.desk.snapshot().modal.metric else Paper.LETTER
            self._paper = Paper(kept) if isinstance(kept, str) and kept in set(Paper) else usual
        return self._paper

    @property
    def count(self) -> int:
        """Number of rows that can be selected."""
        return len(self.places) if self.places else len(list(self._rows()))

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of the sheet or of the places for saving."""
        self._make_when_changed()
        if self.places:
            return self._sheet_of_places()
        name = self.program
        rows = tuple(self._rows())
        self.marked = max(0, min(self.marked, len(rows) - 1))
        return Sheet(
            Message("SETUP SHEET  ·  {name}", name=name) if name else "SETUP SHEET",
            ("", "", ""),
            _WIDTHS,
            rows,
            self.marked,
            question="NOTE" if self.entry is not None else "",
            text=self.entry.text if self.entry is not None else "",
            notes=self._foot(),
            raw=frozenset({1}),
            tall=True,
        )

    def _foot(self) -> tuple[str, ...]:
        if not self.program:
            return (NO_PROGRAM,)
        if self.trouble:
            return (self.trouble,)
        if self.busy:
            return (self.busy,)
        return ("Preparing the setup sheet …",) if self.made is None else ()

    def _rows(self) -> Iterator[Row]:
        if not self.program:
            return
        if self.made is not None:
            from app.special.setup_sheet_work import rows_of

            yield from rows_of(self.made, self._remarks())
        for number, text in enumerate(self.notes, 1):
            yield Row((f"{tr('NOTE')} {number}", text, ""))

    def _remarks(self) -> dict[int, str]:
        if self.machine.kind == "mill":  # Mill tools have names, which are shown with the tools.
            return {}
        return {number: row.remark for number, row in self.desk.book.tools.items() if row.remark}

    def _sheet_of_places(self) -> Sheet:
        rows = tuple(Row((place.label, str(place.path))) for place in self.places)
        return Sheet(
            "SETUP SHEET  ·  SAVE TO WHICH LOCATION?",
            ("WHERE", "FOLDER"),
            (0.35, 0.65),
            rows,
            self.marked,
            notes=(
                self.busy
                or ("Press Enter to save the setup sheet to the selected location as PDF and HTML."),
            ),
            raw=frozenset({0, 1}),
        )

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for notes, paper size and saving."""
        if self.places:
            return {"F4": Key("LOOK", self.look)}
        return {
            "F2": Key("NOTE", self.note),
            "F3": Key("DEL NOTE", self.forget),
            "F5": Key("A4" if self.paper is Paper.A4 else "LETTER", self.next_paper),
            "F6": Key("WRITE", self.look),
        }

    def typed(self, key: str) -> bool:
        """Handle a key of the note entry, or move the selection."""
        if self.entry is None:
            return super().typed(key)
        if key == "Enter":
            self._keep_note(self.entry.text.strip())
            return True
        if len(self.entry.text) >= LONGEST and len(key) == 1:
            self.desk.say(
                tr(Message("NOTES CAN HAVE UP TO {maximum} CHARACTERS. ADD ANOTHER NOTE", maximum=LONGEST))
            )
            return True
        return self.entry.type(key)

    def takes(self, key: str) -> bool:
        """Return whether a character is text of a note."""
        return self.entry is not None and self.entry.takes(key)

    def escape(self) -> bool:
        """Cancel the note entry or the list of places."""
        open_ = self.entry is not None or bool(self.places)
        self.entry, self.places = None, ()
        return open_

    def left(self) -> None:
        """Cancel the note entry when the function closes."""
        self.entry, self.places = None, ()

    def act(self) -> bool:
        """Change the selected note, or save to the selected place."""
        if self.places:
            self._write(self.places[min(self.marked, len(self.places) - 1)])
        elif (at := self._note_marked) is not None:
            self._changing, self.entry = at, Entry(words=True, text=self.notes[at])
        elif self.program:
            self.desk.say("F2: ADD A NOTE   ENTER: CHANGE THE SELECTED NOTE")
        return True

    @property
    def _note_marked(self) -> int | None:
        """Index of the selected note, or None."""
        at = self.marked - (self.count - len(self.notes))
        return at if 0 <= at < len(self.notes) else None

    def note(self) -> None:
        """Start the entry of a new note."""
        self.desk.clear()
        if not self.program:
            self.desk.say(NO_PROGRAM)
        elif len(self.notes) >= MOST_NOTES:
            self.desk.say(
                tr(Message("LIMIT OF {maximum} NOTES REACHED. CHANGE AN EXISTING NOTE", maximum=MOST_NOTES))
            )
        else:
            self._changing, self.entry = None, Entry(words=True)

    def forget(self) -> None:
        """Delete the selected note after confirmation."""
        at = self._note_marked
        if at is None:
            self.desk.say("SELECT A NOTE FIRST")
        else:
            self.desk.ask("PRESS Y TO DELETE THIS NOTE, N TO KEEP IT", partial(self._without, at))

    def _without(self, at: int) -> None:
        self._keep([text for number, text in enumerate(self.notes) if number != at])

    def _keep_note(self, text: str) -> None:
        at, self.entry = self._changing, None
        notes = list(self.notes)
        if at is None:
            notes += [text] if text else []
            self.marked = self.count if text else self.marked
        elif text:
            notes[at] = text
        else:
            notes.pop(at)
        self._keep(notes)

    def _keep(self, notes: list[str]) -> None:
        program = self.program

        def save() -> None:
            told = _changed(
                self.notes, notes
            )  # compared before saving, because later readers see the new notes
            self.persistence.save_setting(notes_key(program), notes or None)
            self.persistence.note_change(
                Message("notes for {program}: {details}", program=program, details=told)
            )
            self._notes_of = program, notes

        self.desk.clear()
        if not self.desk.refused(Act.SCREEN):
            self.desk.keep(save)

    def next_paper(self) -> None:
        """Switch the paper size between A4 and Letter."""
        if self.desk.refused(Act.SCREEN):
            return
        before, other = self.paper, Paper.LETTER if self.paper is Paper.A4 else Paper.A4
        self._paper = other

        def save() -> None:
            self.persistence.save_setting(_PAPER, other.value)
            self.persistence.note_change(
                Message("paper size: {before} → {other}", before=before.value, other=other.value)
            )

        self.desk.keep(save)

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.entry is not None:
            return "TYPE THE NOTE   ENTER: SAVE   ESC: EXIT WITHOUT SAVING"
        if self.places:
            return "ENTER: SAVE SHEET HERE   F4: RESCAN FOR USB STICKS"
        return "F2: ADD A NOTE   F6: SAVE SHEET AS PDF AND HTML   ESC: BACK"

    # --- preparation on the worker -------------------------------------------------------------------

    def opened(self) -> None:
        """Reload notes and paper size when the function opens."""
        self._notes_of, self._paper = ("", []), None

    def _make_when_changed(self) -> None:
        """Prepare the sheet when the job has changed."""
        loaded = self.desk.session.now
        job, picture = loaded.job, loaded.picture
        if job is None or picture is None or job is self._asked:
            return
        self._asked, self.made, self.trouble = job, None, ""
        from app.special.setup_sheet_work import made_of

        setting = picture.part.setting if picture.part is not None else None
        self.worker.ask(partial(made_of, job, self.machine, setting), self._take, self._failed)

    def _take(self, made: MadeSheet) -> None:
        self.made = made

    def _failed(self, why: str) -> None:
        self.trouble = why

    # --- saving --------------------------------------------------------------------------------------

    def look(self) -> None:
        """List the places for saving. The result arrives in a later frame."""
        self.desk.clear()
        if self.made is None or not self.program:
            self.desk.say(
                NO_PROGRAM if not self.program else ("THE SETUP SHEET IS STILL BEING PREPARED: WAIT A MOMENT")
            )
            return
        self.worker.queue(lambda: _places(self.folder, self.plugged()), self._found, self._not_written)

    def _found(self, places: tuple[Place, ...]) -> None:
        self.places, self.marked = places, 0

    def _write(self, place: Place) -> None:
        if self.busy:
            self.desk.say("STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE")
            return
        if self.made is None:
            self.desk.say("THE SETUP SHEET IS STILL BEING PREPARED: WAIT A MOMENT")
            return
        self.busy = "Writing …"
        self.desk.clear()
        from app.special.setup_sheet_work import page_of, write

        page = page_of(self.made, self.program, self.machine, self._remarks(), tuple(self.notes))
        self.worker.queue(
            partial(write, page, self.program, place.path, self.paper), self._done, self._not_written
        )

    def _done(self, name: str) -> None:
        self.busy, self.places = "", ()
        self.desk.done(tr(Message("{name} SAVED. IF YOU USED A USB STICK, YOU CAN REMOVE IT NOW", name=name)))

    def _not_written(self, why: str) -> None:
        self.busy = ""
        self.desk.refuse(why)


def _texts(kept: object) -> list[str]:
    """Return the stored notes, ignoring values of other types."""
    return [each for each in kept if isinstance(each, str)] if isinstance(kept, list) else []


def _changed(before: Sequence[str], now: Sequence[str]) -> str:
    """Return the removed and added notes as text for the log."""
    gone = [Message("'{item}' removed", item=each) for each in before if each not in now]
    return ", ".join((*gone, *(f"'{each}'" for each in now if each not in before))) or (
        "order of the notes changed"
    )


def _places(folder: Path, plugged: Sequence[Stick]) -> tuple[Place, ...]:
    """Return the media and the control's folder."""
    return (*(Place(stick.label, stick.path) for stick in plugged), Place(tr("THIS CONTROL"), folder))
