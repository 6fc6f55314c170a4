"""Model of the program list without Qt.

The model searches, sorts, previews, loads and transfers programs, and executes file commands.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.page_entry import MANUAL_STATES
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, InputField, TableContent, TableRow, following
from app.desk.persistence import Persistence
from app.desk.status import formats
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.programs.import_export import ProgramTransfer
from app.programs.program_commands import COPY, NO_SELECTION, RENAME, ProgramCommands
from app.programs.program_rows import (
    LIST_VIEWS,
    RECENT,
    ListedFile,
    ProgramPreview,
    find_missing_reason,
    format_file_time,
    format_stored_time,
    list_programs,
    list_recent_programs,
    sort_programs,
)
from core.message import Message, join_messages

DRAWING_HINT = "{name} IS A DRAWING. F3: MAKE A PROGRAM FROM IT"
MISSING_FILE = "{name} CANNOT BE LOADED: {reason}"
MISSING_RECENT = "{name} CANNOT BE LOADED: {reason}. F6: REMOVE FROM THIS LIST"


@dataclass(slots=True)
class ProgramListModel:
    """Model of the program list.

    ``operator_folder`` is the folder in which the operator's own programs are stored.
    """

    desk: Desk
    operator_folder: Path
    persistence: Persistence
    worker: LatestRequestWorker
    preview: ProgramPreview
    program_transfer: ProgramTransfer
    sort_order: str = "NAME"
    selected_row: int = 0
    search_field: InputField = field(default_factory=lambda: InputField(words=True))
    all_programs: tuple[ListedFile, ...] = ()
    recent_programs: tuple[ListedFile, ...] = ()
    listed_programs: tuple[ListedFile, ...] = ()
    program_commands: ProgramCommands = field(init=False)
    # A network folder of a recently loaded program must not delay the list of the program folders.
    recent_worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("recent-programs"))
    _after: str = ""  # name to select after the list was read again

    def __post_init__(self) -> None:
        self.program_transfer.on_finished = self.reload_list
        self.program_commands = ProgramCommands(
            self.desk,
            self.operator_folder,
            self.persistence,
            self.worker,
            lambda: self.selected_program,
            self._changed,
        )

    @property
    def name_question(self) -> str:
        """Return the question that asks for a program name, or an empty string."""
        return self.program_commands.question

    @property
    def name_field(self) -> InputField:
        """Return the input field for the program name."""
        return self.program_commands.name_field

    # --- displayed values ----------------------------------------------------------------------------

    def on_open(self) -> None:
        """Read the program folders and the run records when the page opens."""
        self._after = self.desk.program_loader.loaded_program.name
        self.reload_list()

    def reload_list(self) -> None:
        """Read the folders again.

        The result is shown in a later frame.
        """
        folders, own, persistence = (
            self.desk.program_choice.program_folders,
            self.operator_folder,
            self.persistence,
        )
        conversion = self.desk.page_registry.program_conversion
        recognize = conversion.recognize_control if conversion is not None else None
        paths = self.desk.recent_programs.paths
        self.worker.enqueue_work(
            partial(list_programs, folders, own, persistence, recognize),
            self._receive_programs,
            self.desk.show_refusal,
        )
        self.recent_worker.request_work(
            lambda _request: list_recent_programs(paths, folders, own, persistence, recognize),
            self._receive_recent_programs,
            self.desk.show_refusal,
        )

    def poll(self) -> None:
        """Process the results of the workers.

        This is called once a frame.
        """
        self.worker.deliver_results()
        self.recent_worker.deliver_results()

    def _receive_programs(self, programs: tuple[ListedFile, ...]) -> None:
        name, self._after = self._after, ""
        self.all_programs = programs
        self._narrow(name)

    def _receive_recent_programs(self, programs: tuple[ListedFile, ...]) -> None:
        self.recent_programs = programs
        if self.is_recent_view:
            self._narrow()

    def _narrow(self, name: str = "") -> None:
        """List the programs that match the search, and select a program by its name.

        Without ``name``, the selected file remains selected. Files of several folders can have one name.
        """
        selected = self.selected_program
        part = self.search_field.text.strip().lower()
        programs = self.recent_programs if self.is_recent_view else self.all_programs
        found = tuple(program for program in programs if part in program.name.lower())
        self.listed_programs = found if self.is_recent_view else sort_programs(self.sort_order, found)
        marks = [each.name if name else str(each.path) for each in self.listed_programs]
        mark = name or (str(selected.path) if selected is not None else "")
        self.selected_row = marks.index(mark) if mark in marks else 0

    @property
    def is_recent_view(self) -> bool:
        """Return whether the list shows the recently loaded programs."""
        return self.sort_order == RECENT

    @property
    def selected_program(self) -> ListedFile | None:
        """Return the selected program, or None in an empty list."""
        return (
            self.listed_programs[self.selected_row] if self.selected_row < len(self.listed_programs) else None
        )

    def make_table(self) -> TableContent:
        """Return the table of programs, or of the folder chooser while it is open."""
        return (
            self.program_transfer.make_table() if self.program_transfer.is_open else make_program_table(self)
        )

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that are available now."""
        if self.program_transfer.is_open:
            return self.program_transfer.make_function_keys()
        is_empty = self.selected_program is None
        delete = FunctionKey(
            "DELETE", self.program_commands.confirm_delete, barred=self.program_commands.is_protected
        )
        remove = FunctionKey("REMOVE", self.remove_recent_program, barred=is_empty)
        return {
            "F2": FunctionKey("SORT", self.select_next_sort_order),
            "F4": FunctionKey("COPY", lambda: self.program_commands.ask_for_name(COPY), barred=is_empty),
            "F5": FunctionKey(
                "RENAME",
                lambda: self.program_commands.ask_for_name(RENAME),
                barred=self.program_commands.is_protected,
            ),
            "F6": remove if self.is_recent_view else delete,
            "F8": FunctionKey("IMPORT", lambda: self._transfer(out=False)),
            "F9": FunctionKey("EXPORT", lambda: self._transfer(out=True), barred=is_empty),
        }

    def accepts_key(self, key: str) -> bool:
        """Return whether a character is allowed in a program name and can be entered now.

        Return False for all characters while the folder chooser is open.
        """
        return not self.program_transfer.is_open and self.search_field.accepts_key(key)

    def handle_key(self, key: str) -> bool:
        """Handle a key of the program list.

        Arrow keys select a row, Enter loads the program or accepts the name, and letters filter the list.
        """
        if self.program_transfer.is_open:
            return self.program_transfer.handle_key(key)
        if key in ROW_STEPS and not self.name_question:
            self.select_row(self.selected_row + ROW_STEPS[key])
        elif key == "Enter":
            self.program_commands.apply_entered_name() if self.name_question else self.load_selected_program()
        elif (self.name_field if self.name_question else self.search_field).handle_key(key):
            self.desk.clear_prompt_line()
            if not self.name_question:
                self._narrow()
        else:
            return False
        return True

    def select_row(self, row: int) -> None:
        """Select a row of the list."""
        if not self.name_question and self.listed_programs:
            self.desk.clear_prompt_line()
            self.selected_row = max(0, min(len(self.listed_programs) - 1, row))

    def handle_escape(self) -> bool:
        """Go back one step.

        Return False if there is no step to go back, so that the page can close.
        """
        if self.desk.prompt_notice:
            self.desk.clear_prompt_line()
        elif self.program_transfer.is_open:
            self.program_transfer.handle_escape()
        elif self.name_question:
            self.program_commands.question = ""
        elif self.search_field.text:
            self.search_field.text = ""
            self._narrow()
        else:
            return False
        return True

    def on_close(self) -> None:
        """Clear questions and filters when the page closes."""
        self.program_commands.question = self.search_field.text = ""
        self.program_transfer.close_chooser()
        self.preview.find_picture(None)
        self._narrow()

    def select_next_sort_order(self) -> None:
        """Handle F2: sort the list by the next criterion, or show the recently loaded programs."""
        self.sort_order = following(LIST_VIEWS, self.sort_order)
        self._narrow()

    def remove_recent_program(self) -> None:
        """Remove the selected program from the recently loaded programs. Its file is not changed."""
        program = self.selected_program
        if program is None:
            self.desk.say(NO_SELECTION)
            return
        self.desk.recent_programs.remove(program.path)
        self.recent_programs = tuple(each for each in self.recent_programs if each.path != program.path)
        row = self.selected_row
        self._narrow()
        self.selected_row = max(0, min(row, len(self.listed_programs) - 1))
        self.desk.show_success(tr(Message("{name} REMOVED FROM THIS LIST", name=program.name)))

    def can_load(self) -> bool:
        """Return whether the selected program can be loaded, and show the reason if not."""
        if self.selected_program is None or self.selected_program.is_drawing:
            self.desk.say(
                NO_SELECTION
                if self.selected_program is None
                else tr(Message(DRAWING_HINT, name=self.selected_program.name))
            )
            return False
        if not self.desk.program_choice.can_choose_program():
            return False
        program = self.selected_program
        # Only a worker looks at files outside the program folders: a network folder may not respond.
        reason = program.missing_reason if program.is_outside else find_missing_reason(program.path)
        if reason:
            words = MISSING_RECENT if self.is_recent_view else MISSING_FILE
            self.desk.say(tr(Message(words, name=self.selected_program.name, reason=tr(reason))))
        return not reason

    def load_selected_program(self) -> bool:
        """Load the selected program, after the operator confirms if necessary.

        Return False if loading is not possible.
        """
        program = self.selected_program
        if program is None or not self.can_load():
            return False
        if program.is_outside:
            self.desk.program_choice.load_path(program.path)
            return True
        return self.desk.program_choice.load_by_name(str(program.path))

    def _changed(self, name: str) -> None:
        self._after = name
        self.reload_list()

    def _transfer(self, *, out: bool) -> None:
        if out and self.selected_program is None:
            self.desk.say(NO_SELECTION)
        else:
            self.desk.clear_prompt_line()
            self.program_transfer.open_chooser(
                tuple(p.path for p in self.listed_programs if not p.missing_reason),
                self.selected_program.path if self.selected_program else None,
                out,
            )

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        if self.program_transfer.is_open:
            return self.program_transfer.prompt_text()
        if self.name_question:
            return "TYPE A NAME   BACKSPACE: EDIT   ENTER: ACCEPT   ESC: CANCEL"
        if self.search_field.text and not self.listed_programs:
            return tr("NO PROGRAM NAME CONTAINS THIS TEXT. F3: NEW PROGRAM")
        if self.desk.read_snapshot().state in MANUAL_STATES:
            return "TYPE PART OF A NAME   PAUSE: FEED HOLD   ESC: AUTOMATIC"
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            return "TYPE PART OF NAME   F3: EDIT   PAUSE: FEED HOLD   ESC: BACK"
        return "TYPE PART OF A NAME OR USE ARROWS   ENTER: LOAD   ESC: BACK"

    def close(self) -> None:
        """Stop the workers of the lists and of the preview."""
        self.worker.close()
        self.recent_worker.close()
        self.preview.close()


# --- rows of the list and details of the selected program ------------------------------------------------

ProgramDetail = tuple[str, str]
LONG_DETAILS = frozenset({"LAST RUN", "LAST PROOF", "FOLDER"})
"""Labels of the details whose texts can be long."""


def make_program_table(model: ProgramListModel) -> TableContent:
    """Return the table of programs with name, date, last run, parts and best cycle.

    If the list contains a program of another control, a column shows the control.
    """
    with_controls = any(program.control_name for program in model.listed_programs)
    rows = tuple(_row(program, with_control=with_controls) for program in model.listed_programs)
    count = (
        Message(
            "{listed_count} OF {all_count} PROGRAMS",
            listed_count=len(model.listed_programs),
            all_count=len(model.recent_programs if model.is_recent_view else model.all_programs),
        )
        if model.search_field.text
        else Message("{rows_count} PROGRAMS", rows_count=len(rows))
    )
    question, text = model.name_question, model.name_field.text
    if not question:
        question, text = "NAME TO FIND OR CREATE", model.search_field.text
    title = (
        Message("PROGRAMS  ·  {count}  ·  RECENTLY LOADED", count=count)
        if model.is_recent_view
        else Message("PROGRAMS  ·  {count}  ·  SORTED BY {order}", count=count, order=model.sort_order)
    )
    return TableContent(
        title,
        ("NAME", *(["CONTROL"] if with_controls else []), "CHANGED", "LAST RUN", "PARTS", "BEST"),
        (0.26, 0.14, 0.22, 0.22, 0.08, 0.08) if with_controls else (0.32, 0.25, 0.25, 0.09, 0.09),
        rows,
        model.selected_row if rows else -1,
        entry_prompt=question,
        text=text,
        untranslated_columns=frozenset({0, 1, 2, 3} if with_controls else {0, 1, 2}),
        numeric_columns=frozenset({4, 5} if with_controls else {3, 4}),
    )


def _row(program: ListedFile, *, with_control: bool) -> TableRow:
    run = program.run_row
    best = formats.format_duration(run.best) if run.best is not None else formats.NO_VALUE
    cells = (
        program.name,
        *([program.control_name] if with_control else []),
        formats.NO_VALUE if program.missing_reason else format_file_time(program.modified_time_s),
        format_stored_time(run.started),
        str(run.parts),
        best,
    )
    good = run.proof == "PROVED"
    lit = None if not run.proof else good
    if program.missing_reason:
        lit, good = False, False
    return TableRow(cells, lit, StatusTone.RUN if good else StatusTone.ALARM)


def make_program_details(program: ListedFile) -> tuple[ProgramDetail, ...]:
    """Return the details of a program as texts for display.

    The texts of ``LONG_DETAILS`` can be long. The others are short.
    """
    run = program.run_row
    return (
        ("SIZE", formats.format_file_size(program.size_bytes)),
        ("TYPE", _describe_type(program)),
        ("PARTS", str(run.parts)),
        ("BEST CYCLE", _time(run.best)),
        ("LAST CYCLE", _time(run.latest)),
        ("PLANNED TIME", _time(run.planned)),
        (
            "LAST RUN",
            join_messages("  ·  ", (format_stored_time(run.started), run.outcome))
            if run.outcome
            else format_stored_time(run.started),
        ),
        (
            "LAST PROOF",
            join_messages("  ·  ", (run.proof, format_stored_time(run.proved)))
            if run.proof
            else "NEVER PROVED",
        ),
        *([("FOLDER", str(program.path.parent))] if program.is_outside or program.missing_reason else []),
    )


def _describe_type(program: ListedFile) -> str:
    if program.control_name:
        return Message("{control} PROGRAM", control=program.control_name)
    if program.missing_reason:
        return "NOT FOUND"
    if program.is_outside:
        return "OTHER FOLDER"
    return "DRAWING" if program.is_drawing else "SAMPLE" if program.is_sample else "USER PROGRAM"


def _time(seconds: float | None) -> str:
    return formats.format_duration(seconds) if seconds is not None else formats.NO_VALUE
