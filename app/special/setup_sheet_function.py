"""Special function on page F10 that shows, annotates and saves the program's setup sheet."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, InputField, TableContent, TableRow
from app.desk.persistence import Persistence
from app.desk.translation import tr
from app.programs.removable_media import UsbStick, list_usb_sticks
from app.report.pdf_file import PaperSize
from app.special.backup_and_restore import BackupLocation
from app.special.special_functions import SpecialFunction
from core.access.access_table import ProtectedChange
from core.executor.job import Job
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store_errors import StoreError
from core.store.store_file import make_notes_setting_key

if TYPE_CHECKING:
    from app.special.setup_sheet_work import PreparedSheet

NO_PROGRAM_LOADED = "CHOOSE A PROGRAM FIRST: EACH PROGRAM HAS ITS OWN SETUP SHEET"
MOST_NOTES, LONGEST = 30, 200
_PAPER_SETTING = "paper"  # name of the setting
_COLUMN_SHARES = (0.15, 0.63, 0.22)


class SetupSheetFunction(SpecialFunction):
    """Special function for the setup sheet and its notes.

    F6 lists the folders in which the sheet can be saved.
    """

    name = "SETUP SHEET"
    use = "tools, stock, stops, notes; printable"

    def __init__(
        self,
        desk: Desk,
        machine_name: Machine,
        persistence: Persistence,
        worker: LatestRequestWorker,
        csv_folder: Path,
        list_media: Callable[[], Sequence[UsbStick]] = list_usb_sticks,
    ) -> None:
        super().__init__(desk)
        self.machine, self.persistence, self.worker = machine_name, persistence, worker
        self.folder, self.list_media = csv_folder, list_media
        self.prepared_sheet: PreparedSheet | None = None
        self.error_text = ""
        self.note_field: InputField | None = None  # a note is being typed
        self.save_locations: tuple[BackupLocation, ...] = ()  # places to choose from
        self.task_text = ""
        self._asked: Job | None = None  # job whose sheet is being prepared
        self._changing: int | None = None  # index of the note being changed; None for a new note
        self._notes_of: tuple[str, list[str]] = ("", [])
        self._paper: PaperSize | None = None  # None: not loaded yet

    # --- display -------------------------------------------------------------------------------------

    @property
    def program_name(self) -> str:
        """Return the name of the loaded program, or an empty string if no program is loaded."""
        return self.desk.program_loader.loaded_program.name

    @property
    def notes(self) -> list[str]:
        """Return the operator's notes about the program."""
        program = self.program_name
        if self._notes_of[0] != program:
            self._notes_of = (
                program,
                _parse_texts(self._kept(make_notes_setting_key(program))) if program else [],
            )
        return self._notes_of[1]

    def _kept(self, key: str) -> object:
        try:
            return self.persistence.read_setting(key)
        except StoreError:
            return None  # TurnDesk itself reports that nothing is stored.

    @property
    def paper_size(self) -> PaperSize:
        """Return the paper size of the PDF.

        This is the stored choice, or the default for the program's unit if no choice is stored.
        """
        if self._paper is None:
            kept = self._kept(_PAPER_SETTING)
            usual = PaperSize.A4 if self.desk.read_snapshot().modal.metric else PaperSize.LETTER
            self._paper = PaperSize(kept) if isinstance(kept, str) and kept in set(PaperSize) else usual
        return self._paper

    @property
    def row_count(self) -> int:
        """Return the number of rows that the operator can select."""
        return len(self.save_locations) if self.save_locations else len(list(self._rows()))

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of the setup sheet, or of the save locations if these are listed."""
        self._make_if_changed()
        if self.save_locations:
            return self._sheet_of_places()
        name = self.program_name
        rows = tuple(self._rows())
        self.marked = max(0, min(self.marked, len(rows) - 1))
        return TableContent(
            Message("SETUP SHEET  ·  {name}", name=name) if name else "SETUP SHEET",
            ("", "", ""),
            _COLUMN_SHARES,
            rows,
            self.marked,
            entry_prompt="NOTE" if self.note_field is not None else "",
            text=self.note_field.text if self.note_field is not None else "",
            notes=self._foot(),
            untranslated_columns=frozenset({1}),
            has_tall_rows=True,
        )

    def _foot(self) -> tuple[str, ...]:
        if not self.program_name:
            return (NO_PROGRAM_LOADED,)
        if self.error_text:
            return (self.error_text,)
        if self.task_text:
            return (self.task_text,)
        return ("Preparing the setup sheet …",) if self.prepared_sheet is None else ()

    def _rows(self) -> Iterator[TableRow]:
        if not self.program_name:
            return
        if self.prepared_sheet is not None:
            from app.special.setup_sheet_work import make_sheet_rows

            yield from make_sheet_rows(self.prepared_sheet, self._remarks())
        for number, text in enumerate(self.notes, 1):
            yield TableRow((f"{tr('NOTE')} {number}", text, ""))

    def _remarks(self) -> dict[int, str]:
        if self.machine.kind == "mill":  # Mill tools have names, which are shown with the tools.
            return {}
        return {
            number: row.remark for number, row in self.desk.offset_book.tool_offsets.items() if row.remark
        }

    def _sheet_of_places(self) -> TableContent:
        rows = tuple(TableRow((place.label, str(place.path))) for place in self.save_locations)
        return TableContent(
            "SETUP SHEET  ·  SAVE TO WHICH LOCATION?",
            ("WHERE", "FOLDER"),
            (0.35, 0.65),
            rows,
            self.marked,
            notes=(
                self.task_text
                or ("Press Enter to save the setup sheet to the selected location as PDF and HTML."),
            ),
            untranslated_columns=frozenset({0, 1}),
        )

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys for notes, paper size and saving."""
        if self.save_locations:
            return {"F4": FunctionKey("LOOK", self.reload_save_locations)}
        return {
            "F2": FunctionKey("NOTE", self.add_note),
            "F3": FunctionKey("DEL NOTE", self.confirm_note_deletion),
            "F5": FunctionKey(
                "A4" if self.paper_size is PaperSize.A4 else "LETTER", self.select_next_paper_size
            ),
            "F6": FunctionKey("WRITE", self.reload_save_locations),
        }

    def handle_key(self, key: str) -> bool:
        """Handle a key of the note entry, or move the selection."""
        if self.note_field is None:
            return super().handle_key(key)
        if key == "Enter":
            self._keep_note(self.note_field.text.strip())
            return True
        if len(self.note_field.text) >= LONGEST and len(key) == 1:
            self.desk.say(
                tr(Message("NOTES CAN HAVE UP TO {maximum} CHARACTERS. ADD ANOTHER NOTE", maximum=LONGEST))
            )
            return True
        return self.note_field.handle_key(key)

    def accepts_key(self, key: str) -> bool:
        """Return whether a note is being edited and the character can be entered in it."""
        return self.note_field is not None and self.note_field.accepts_key(key)

    def handle_escape(self) -> bool:
        """Cancel the note entry, or close the list of save locations."""
        open_ = self.note_field is not None or bool(self.save_locations)
        self.note_field, self.save_locations = None, ()
        return open_

    def on_close(self) -> None:
        """Cancel the note entry and close the list of save locations."""
        self.note_field, self.save_locations = None, ()

    def activate_selected_row(self) -> bool:
        """Edit the selected note, or save the sheet in the selected location."""
        if self.save_locations:
            self._write(self.save_locations[min(self.marked, len(self.save_locations) - 1)])
        elif (at := self._selected_note_index) is not None:
            self._changing, self.note_field = at, InputField(words=True, text=self.notes[at])
        elif self.program_name:
            self.desk.say("F2: ADD A NOTE   ENTER: CHANGE THE SELECTED NOTE")
        return True

    @property
    def _selected_note_index(self) -> int | None:
        """Return the index of the selected note, or None if no note is selected."""
        at = self.marked - (self.row_count - len(self.notes))
        return at if 0 <= at < len(self.notes) else None

    def add_note(self) -> None:
        """Start the entry of a new note."""
        self.desk.clear_prompt_line()
        if not self.program_name:
            self.desk.say(NO_PROGRAM_LOADED)
        elif len(self.notes) >= MOST_NOTES:
            self.desk.say(
                tr(Message("LIMIT OF {maximum} NOTES REACHED. CHANGE AN EXISTING NOTE", maximum=MOST_NOTES))
            )
        else:
            self._changing, self.note_field = None, InputField(words=True)

    def confirm_note_deletion(self) -> None:
        """Delete the selected note after the operator confirms."""
        at = self._selected_note_index
        if at is None:
            self.desk.say("SELECT A NOTE FIRST")
        else:
            self.desk.ask_operator("PRESS Y TO DELETE THIS NOTE, N TO KEEP IT", partial(self._without, at))

    def _without(self, at: int) -> None:
        self._keep([text for number, text in enumerate(self.notes) if number != at])

    def _keep_note(self, text: str) -> None:
        at, self.note_field = self._changing, None
        notes = list(self.notes)
        if at is None:
            notes += [text] if text else []
            self.marked = self.row_count if text else self.marked
        elif text:
            notes[at] = text
        else:
            notes.pop(at)
        self._keep(notes)

    def _keep(self, notes: list[str]) -> None:
        program = self.program_name

        def save_notes() -> None:
            change_text = _describe_change(
                self.notes, notes
            )  # compared before saving, because later readers see the new notes
            self.persistence.save_setting(make_notes_setting_key(program), notes or None)
            self.persistence.log_change(
                Message("notes for {program}: {details}", program=program, details=change_text)
            )
            self._notes_of = program, notes

        self.desk.clear_prompt_line()
        if not self.desk.is_refused(ProtectedChange.SCREEN):
            self.desk.try_save(save_notes)

    def select_next_paper_size(self) -> None:
        """Switch the paper size between A4 and Letter."""
        if self.desk.is_refused(ProtectedChange.SCREEN):
            return
        before, other = self.paper_size, PaperSize.LETTER if self.paper_size is PaperSize.A4 else PaperSize.A4
        self._paper = other

        def save_paper_size() -> None:
            self.persistence.save_setting(_PAPER_SETTING, other.value)
            self.persistence.log_change(
                Message("paper size: {before} → {other}", before=before.value, other=other.value)
            )

        self.desk.try_save(save_paper_size)

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        if self.note_field is not None:
            return "TYPE THE NOTE   ENTER: SAVE   ESC: EXIT WITHOUT SAVING"
        if self.save_locations:
            return "ENTER: SAVE SHEET HERE   F4: RESCAN FOR USB STICKS"
        return "F2: ADD A NOTE   F6: SAVE SHEET AS PDF AND HTML   ESC: BACK"

    # --- preparation on the worker -------------------------------------------------------------------

    def on_open(self) -> None:
        """Discard the loaded notes and paper size, so that they are read again."""
        self._notes_of, self._paper = ("", []), None

    def _make_if_changed(self) -> None:
        """Prepare a new setup sheet if the loaded job has changed."""
        loaded = self.desk.program_loader.loaded_program
        job, picture = loaded.job, loaded.picture
        if job is None or picture is None or job is self._asked:
            return
        self._asked, self.prepared_sheet, self.error_text = job, None, ""
        from app.special.setup_sheet_work import prepare_sheet

        setting = picture.part.part_settings if picture.part is not None else None
        self.worker.request_work(partial(prepare_sheet, job, self.machine, setting), self._take, self._failed)

    def _take(self, made: PreparedSheet) -> None:
        self.prepared_sheet = made

    def _failed(self, why: str) -> None:
        self.error_text = why

    # --- saving --------------------------------------------------------------------------------------

    def reload_save_locations(self) -> None:
        """List the folders in which the sheet can be saved.

        The result is shown in a later frame.
        """
        self.desk.clear_prompt_line()
        if self.prepared_sheet is None or not self.program_name:
            self.desk.say(
                NO_PROGRAM_LOADED
                if not self.program_name
                else ("THE SETUP SHEET IS STILL BEING PREPARED: WAIT A MOMENT")
            )
            return
        self.worker.enqueue_work(
            lambda: _list_places(self.folder, self.list_media()), self._found, self._not_written
        )

    def _found(self, places: tuple[BackupLocation, ...]) -> None:
        self.save_locations, self.marked = places, 0

    def _write(self, place: BackupLocation) -> None:
        if self.task_text:
            self.desk.say("STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE")
            return
        if self.prepared_sheet is None:
            self.desk.say("THE SETUP SHEET IS STILL BEING PREPARED: WAIT A MOMENT")
            return
        self.task_text = "Writing …"
        self.desk.clear_prompt_line()
        from app.special.setup_sheet_work import make_sheet_page, write_sheet_files

        page = make_sheet_page(
            self.prepared_sheet, self.program_name, self.machine, self._remarks(), tuple(self.notes)
        )
        self.worker.enqueue_work(
            partial(write_sheet_files, page, self.program_name, place.path, self.paper_size),
            self._done,
            self._not_written,
        )

    def _done(self, name: str) -> None:
        self.task_text, self.save_locations = "", ()
        self.desk.show_success(
            tr(Message("{name} SAVED. IF YOU USED A USB STICK, YOU CAN REMOVE IT NOW", name=name))
        )

    def _not_written(self, why: str) -> None:
        self.task_text = ""
        self.desk.show_refusal(why)


def _parse_texts(stored: object) -> list[str]:
    """Return the notes from a stored value. Entries that are not texts are ignored."""
    return [each for each in stored if isinstance(each, str)] if isinstance(stored, list) else []


def _describe_change(before: Sequence[str], now: Sequence[str]) -> str:
    """Return the removed and added notes as text for the log."""
    gone = [Message("'{item}' removed", item=each) for each in before if each not in now]
    return ", ".join((*gone, *(f"'{each}'" for each in now if each not in before))) or (
        "order of the notes changed"
    )


def _list_places(folder: Path, media: Sequence[UsbStick]) -> tuple[BackupLocation, ...]:
    """Return the removable media and the control's own folder as locations for saving the sheet."""
    return (
        *(BackupLocation(stick.label, stick.path) for stick in media),
        BackupLocation(tr("THIS CONTROL"), folder),
    )
