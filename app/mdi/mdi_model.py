"""Model of the MDI page, independent of Qt: entry, completion, proof and preparation of one line."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.pages.code_help import CodeHelp
from app.desk.pages.page_entry import find_mdi_refusal
from app.desk.pages.table_content import ROW_STEPS
from app.desk.persistence import Persistence
from app.desk.programs.prepared_line import PreparedMdiLine, ProveLine
from app.desk.status import prompt_line
from app.desk.translation import tr
from core.executor.commands import Command, StopSpindle
from core.executor.snapshot import CYCLE_STATES, MachineState, Snapshot
from core.language.diagnostics import Diagnostic
from core.message import Message
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from core.language.code_book import CodeBook, CodeBookEntry

HISTORY_SETTING = "mdi"
MAX_LINE_LENGTH = 120  # Maximum characters of a line.
MAX_HISTORY_LINES = 100  # Number of lines.


@dataclass(slots=True)
class MdiInput:
    """Input line with a cursor and a history.

    Up and Down recall earlier lines, as in a shell.
    """

    persistence: Persistence = field(default_factory=Persistence)
    text: str = ""
    cursor_index: int = 0  # The cursor is before this character.
    history_lines: list[str] = field(default_factory=list)  # Oldest line first.
    error_columns_by_line: dict[str, int] = field(
        default_factory=dict
    )  # Rejected lines with the column of the error, counted from 1; 0: the whole line.
    # Position of the recalled line in the history, counted from the newest; 0: the line is being typed.
    recall_index: int = 0
    _draft: str = ""

    def __post_init__(self) -> None:
        self.reload_history()

    def reload_history(self) -> None:
        """Read the stored history of input lines. Invalid entries are ignored."""
        try:
            kept = self.persistence.read_setting(HISTORY_SETTING)
        except StoreError:
            kept = None
        lines = kept if isinstance(kept, list) else []
        self.history_lines = [line for line in lines if isinstance(line, str)][-MAX_HISTORY_LINES:]

    def handle_key(self, key: str) -> bool:
        """Handle a character or an editing key, and return False if the key has no function here."""
        match key:
            case "Back":
                self._cut(self.cursor_index - 1)
            case "Delete":
                self._cut(self.cursor_index)
            case "Left" | "Right":
                self.cursor_index = max(
                    0, min(len(self.text), self.cursor_index + (1 if key == "Right" else -1))
                )
            case "Up" | "Down":
                self.recall_line(self.recall_index + (1 if key == "Up" else -1))
            case _ if len(key) == 1 and key.isprintable():
                if len(self.text) < MAX_LINE_LENGTH:
                    self.set_text(
                        self.text[: self.cursor_index] + key + self.text[self.cursor_index :],
                        self.cursor_index + 1,
                    )
            case _:
                return False
        return True

    def set_text(self, text: str, cursor_index: int | None = None) -> None:
        """Set the text, and move the cursor to ``cursor_index`` or to the end of the text."""
        self.text = text
        self.cursor_index = len(text) if cursor_index is None else cursor_index

    def recall_line(self, index: int) -> None:
        """Recall a line of the history.

        ``index`` counts from 1 for the newest line. The index 0 restores the typed text.
        """
        if not 0 <= index <= len(self.history_lines):
            return
        if not self.recall_index:
            self._draft = self.text
        self.recall_index = index
        self.set_text(self.history_lines[-index] if index else self._draft)

    def store_started_line(self) -> None:
        """Add the line that has started running to the history, and clear the input line."""
        self.error_columns_by_line.pop(self.text, None)
        self._remember()
        self.set_text("")
        self.recall_index, self._draft = 0, ""

    def add_rejected_line(self, column: int) -> None:
        """Add a rejected line to the history, with the column of its error.

        The text also remains in the input line.
        """
        self._remember()
        self.error_columns_by_line[self.text] = column
        self.error_columns_by_line = {
            line: at for line, at in self.error_columns_by_line.items() if line in self.history_lines
        }
        self.recall_index = 0

    def _remember(self) -> None:
        if self.text.strip() and (not self.history_lines or self.history_lines[-1] != self.text):
            self.history_lines = [*self.history_lines, self.text][-MAX_HISTORY_LINES:]
            with suppress(StoreError):  # TurnDesk shows the storage error elsewhere.
                self.persistence.save_setting(HISTORY_SETTING, self.history_lines)

    def _cut(self, index: int) -> None:
        if 0 <= index < len(self.text):
            self.set_text(self.text[:index] + self.text[index + 1 :], index)


CONTINUATION_SIGN = "~"  # A block of Klartext continues in the next line.


@dataclass(slots=True)
class LineCompletion:
    """Code help and code completion for the MDI input line.

    ``is_open`` is True while the list of choices is open and the arrow keys select a choice.
    """

    mdi_input: MdiInput
    read_code_book: Callable[[], CodeBook]
    code_help: CodeHelp = field(default_factory=CodeHelp)
    is_choice_list_open: bool = False

    def toggle_choices(self) -> None:
        """Open or close the list of codes that match the text before the cursor."""
        self.is_choice_list_open = not self.is_choice_list_open
        if self.is_choice_list_open:
            self.code_help.update_for_cursor(
                self.read_code_book(), self.mdi_input.text, self.mdi_input.cursor_index + 1
            )
            self.code_help.open_choices()

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the input line must handle the key.

        Tab opens the list of choices. While it is open, the arrow keys select a choice. Any key without a
        function closes the list.
        """
        if not self.is_choice_list_open:
            if key == "Tab":
                self.toggle_choices()
            return self.is_choice_list_open
        match key:
            case "Up" | "Down" | "Page up" | "Page down" | "Home" | "End":
                self.code_help.mark(self.code_help.marked + ROW_STEPS[key])
            case "Left" | "Right":
                self.code_help.move_chapters(1 if key == "Right" else -1)
            case "Enter" | "Tab":
                self.insert_code()
            case _:
                self.is_choice_list_open = False
        return self.is_choice_list_open or key in ("Enter", "Tab")

    def insert_code(self) -> None:
        """Replace the partly typed code at the cursor with the selected code."""
        self.is_choice_list_open, chosen = False, self.code_help.selected_entry
        if chosen is None:
            return
        text, at = self.mdi_input.text, self.mdi_input.cursor_index
        begin = self.code_help.start_column - 1 if self.code_help.start_column else at
        written = _fit_entry(chosen, MAX_LINE_LENGTH - len(text) + at - begin)
        if written:
            self.mdi_input.set_text(text[:begin] + written + text[at:], begin + len(written))


def _fit_entry(entry: CodeBookEntry, max_length: int) -> str:
    """Return the text that completion inserts for a code, with its continuation lines joined.

    If this text is longer than ``max_length``, only the code is returned. If the code is also too long, the
    result is an empty string.
    """
    lines = entry.written.splitlines()
    joined = len(lines) == 1 or all(line.rstrip().endswith(CONTINUATION_SIGN) for line in lines[:-1])
    whole = " ".join(" ".join(line.rstrip().removesuffix(CONTINUATION_SIGN).split()) for line in lines)
    fitting = (each for each in ((whole,) if joined else ()) + (entry.head,) if len(each) <= max_length)
    return next(fitting, "")


@dataclass(slots=True)
class MdiModel:
    """Model of the MDI page.

    ``show_message`` shows a message, and ``read_code_book`` returns the known codes.
    """

    prove_line: ProveLine
    post_command: Callable[[Command], None]
    read_snapshot: Callable[[], Snapshot]
    show_message: Callable[[str], None]
    clear_message: Callable[[], None]
    read_code_book: Callable[[], CodeBook]
    mdi_input: MdiInput = field(default_factory=MdiInput)
    is_open: bool = False
    prepared_line: PreparedMdiLine = field(init=False)
    line_completion: LineCompletion = field(init=False)

    def __post_init__(self) -> None:
        self.line_completion = LineCompletion(self.mdi_input, self.read_code_book)
        self.prepared_line = PreparedMdiLine(self.prove_line, self.post_command, on_refused=self._refused)

    # --- page ----------------------------------------------------------------------------------------

    def can_open(self) -> bool:
        """Return whether the MDI page can open now. If it cannot, show the reason."""
        if why := find_mdi_refusal(self.read_snapshot()):
            self.show_message(why)
        return not why

    def on_open(self) -> None:
        """Prepare the model when the page opens.

        Cycle Start then runs the entered lines instead of a program.
        """
        self.is_open = True
        self.mdi_input.reload_history()
        self.line_completion.is_choice_list_open = False
        self.prepared_line.cancel_line()

    def try_leave(self) -> bool:
        """Return whether the page can close.

        The page cannot close while a line is running. When it closes, the spindle remains on, and Cycle
        Start runs programs again.
        """
        if not self.is_open:
            return True
        if self.read_snapshot().state in CYCLE_STATES:
            self.show_message(tr("A LINE IS RUNNING. LET IT END, OR STOP IT AND PRESS R"))
            return False
        self.is_open = False
        self.prepared_line.stop_line_mode()
        return True

    def close(self) -> None:
        """Stop the worker that proves lines."""
        self.prepared_line.close()

    # --- keys ----------------------------------------------------------------------------------------

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered now."""
        return len(key) == 1 and self.accepts_input

    @property
    def accepts_input(self) -> bool:
        """Return whether the input line accepts keys.

        It accepts keys even while the drives are off, but not while a line is running.
        """
        return self.read_snapshot().state in {
            MachineState.IDLE,
            MachineState.DISABLED,
            MachineState.ESTOP,
            MachineState.FAULT,
        }

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the window must handle the key."""
        if not self.accepts_input:
            return False
        before = self.mdi_input.text
        taken = self.line_completion.handle_key(key)
        if key == "Enter" and not taken:
            self.prove_entered_line()
            return True
        taken = taken or self.mdi_input.handle_key(key)
        if self.mdi_input.text != before:
            self.clear_message()
            self.prepared_line.cancel_line()
        return taken

    def prove_entered_line(self) -> None:
        """Prove the entered line from the current machine state. If this is not possible, show the reason."""
        snapshot = self.read_snapshot()
        self.clear_message()
        if snapshot.state is not MachineState.IDLE:
            self.show_message(tr("DRIVES MUST BE ON TO PROVE A LINE. F5: DRIVES ON   F6: RESET"))
            return
        if not self.mdi_input.text.strip():
            self.show_message(tr("TYPE A LINE FIRST. UP ARROW: EARLIER LINES"))
            return
        self.prepared_line.prove_line(self.mdi_input.text, snapshot, self._failed)

    def toggle_choices(self) -> None:
        """Open or close the list of codes that match the text at the cursor."""
        if self.accepts_input:
            self.clear_message()
            self.line_completion.toggle_choices()

    def insert_code(self) -> None:
        """Insert the selected code into the input line."""
        self.line_completion.insert_code()
        self.clear_message()
        self.prepared_line.cancel_line()

    def recall_line(self, index: int) -> None:
        """Recall a line of the history.

        ``index`` counts from 1 for the newest line.
        """
        self.mdi_input.recall_line(index)
        self.clear_message()
        self.prepared_line.cancel_line()

    def handle_escape(self) -> bool:
        """Close the list of codes, cancel a prepared line, or clear the text.

        Returns False if there was nothing to close, cancel or clear.
        """
        under_way = self.read_snapshot().state in prompt_line.ACTIVE_STATES
        if self.line_completion.is_choice_list_open:
            self.line_completion.is_choice_list_open = False
            return not under_way  # Closing the list does not delay feed hold.
        begun = self.prepared_line.ready_job or self.mdi_input.text or self.prepared_line.is_proving
        if under_way or not begun:
            return False
        if self.prepared_line.ready_job is None and not self.prepared_line.is_proving:
            self.mdi_input.set_text("")
        self.prepared_line.cancel_line()
        return True

    def stop_spindle(self) -> None:
        """Stop the spindle, which may have been started by an earlier line."""
        self.clear_message()
        self.post_command(StopSpindle())

    # --- every frame ---------------------------------------------------------------------------------

    def update(self, snapshot: Snapshot) -> None:
        """Process the result of proving the line. After the line has started, add it to the history.

        This method is called once per frame.
        """
        if self.is_open:
            self.prepared_line.renew_line_mode(snapshot)
        if self.prepared_line.update(snapshot):
            self.mdi_input.store_started_line()

    def prompt_text(self, snapshot: Snapshot, start_instruction: str) -> str:
        """Return the prompt of the page.

        ``start_instruction`` explains how to start a cycle.
        """
        if snapshot.state is MachineState.DISABLED:
            return tr("DRIVES ARE OFF. F5: DRIVES ON. YOU CAN STILL TYPE A LINE")
        if snapshot.state is not MachineState.IDLE:
            return ""
        if self.line_completion.is_choice_list_open:
            return tr("ARROWS: SELECT CODE OR CHAPTER   ENTER: INSERT   ESC: BACK")
        return self._make_line_prompt(start_instruction)

    def _make_line_prompt(self, start: str) -> str:
        """Return the prompt for the state of the entered line."""
        if self.prepared_line.is_proving:
            return tr("CHECKING THE LINE FOR ERRORS")
        if self.prepared_line.blocking_errors:
            return tr("CORRECT THE LINE. ESC: CLEAR IT")
        if self.prepared_line.ready_job is not None:
            return tr(Message("TO RUN THE LINE: {start}. ESC: CANCEL", start=start))
        return tr("TYPE A LINE   ENTER: PROVE   F1: EXIT, SPINDLE UNCHANGED")

    def barred(self) -> str:
        """Return the reason why the start buttons cannot start a line now, or an empty string if they can."""
        if self.read_snapshot().state is MachineState.IDLE and self.prepared_line.ready_job is None:
            return tr("NO LINE IS READY. TYPE A LINE AND PRESS ENTER")
        return ""

    def _failed(self, why: str) -> None:
        self.show_message(tr(Message("THE LINE CANNOT BE CHECKED: {why}", why=why)))

    def _refused(self, error: Diagnostic) -> None:
        self.mdi_input.add_rejected_line(error.column)
