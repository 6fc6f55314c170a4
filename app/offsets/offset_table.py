"""Base class of the offset tables that the operator edits, and the editor of tool fields.

A page shows the table, the entry line below it, the history, and the effect of a change on the tool path.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from app.desk.arithmetic import EXPRESSION_CHARACTERS, MAX_LENGTH, InvalidEntryError
from app.desk.desk import Desk
from app.desk.pages.table_content import apply_edit_key, refused
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_changes import ConfirmedOffsetChanges, OffsetHistory, find_change_refusal
from app.offsets.offset_values import (
    TOOL_FIELDS,
    UnitMode,
    format_value,
    make_field_heading,
    parse_field_increment,
    parse_field_value,
    translate_field_name,
)
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import FieldType, FieldValue, OffsetKind, SecondaryOffsetRow, ToolOffsetRow
from core.tool_edges import format_edge_name, format_edge_suffix

ProposedOffsets = tuple[Mapping[int, ToolOffsetRow], Mapping[int, SecondaryOffsetRow]]


class OffsetTable(ABC):
    """Base class of the models of offset pages.

    Each subclass implements its own method of entering values.
    """

    kind: ClassVar[OffsetKind]
    clear_table_question: ClassVar[str] = (
        ""  # Question before C clears the whole table; empty if C has no function.
    )
    page_key: str = ""  # A letter with a function on this page, for the number pad.
    clear_table_reason: ClassVar[str] = ""  # Reason for the history.
    text: str = ""  # The entered text.
    is_text_open = False  # A text, such as a remark, is being edited.

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.offset_history = OffsetHistory(desk, self.kind)

    @property
    def offset_book(self) -> OffsetBook:
        """Return the offset book, which contains the saved offsets."""
        return self.desk.offset_book

    @property
    def unit_mode(self) -> UnitMode:
        """Return the unit of length of the control, and whether X values are diameters."""
        return self.offset_history.unit_mode

    @property
    def confirmed_changes(self) -> ConfirmedOffsetChanges:
        """Return the object that changes offsets and asks the operator to confirm suspicious changes."""
        return ConfirmedOffsetChanges(self.offset_history)

    @property
    def selected_row_number(self) -> int | None:
        """Return the number of the selected row, to which undo applies, or None if no row is selected."""
        return None

    @property
    def selected_field_name(self) -> str:
        """Return the name of the selected field, or an empty string if no field is selected."""
        return ""

    # --- members that each table defines -------------------------------------------------------------

    @property
    def heading(self) -> str:
        """Return the name of the offset being entered, or an empty string if the question names it."""
        return ""

    @property
    @abstractmethod
    def question_text(self) -> str:
        """Return the question that the operator must answer now."""

    @property
    def is_editing_text(self) -> bool:
        """Return whether the operator is editing a text, in which letters are accepted."""
        return False

    @property
    def entered_text(self) -> str:
        """Return the entered text, as the entry line shows it."""
        return self.text

    @property
    @abstractmethod
    def change_description(self) -> str:
        """Return a description of the change being entered, or of the last change if nothing is entered."""

    @property
    @abstractmethod
    def footer_text(self) -> str:
        """Return the hint about further keys, which is shown below the table."""

    @abstractmethod
    def make_hint(self, snapshot: Snapshot) -> str:
        """Return the prompt that explains how to enter a value or when the value takes effect."""

    @abstractmethod
    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the table."""

    @abstractmethod
    def handle_entry_key(self, key: str) -> bool:
        """Handle a key of the entry.

        Returns False if the key has no function in the entry.
        """

    @abstractmethod
    def cancel_entry(self) -> bool:
        """Discard the entry, and show a message that it was discarded.

        Returns False if nothing was entered.
        """

    @abstractmethod
    def discard_entry(self) -> None:
        """Discard the entry without a message."""

    def make_proposed_offsets(self) -> ProposedOffsets:
        """Return the tool and secondary offsets that would result from the current entry."""
        return self.offset_book.tool_offsets, self.offset_book.secondary_offsets

    # --- conditions: each returns the reason for a refusal, or an empty text --------------------------

    @property
    def is_correction(self) -> bool:
        """Return whether the entry is a correction, which is allowed while parts are being cut."""
        return True

    def find_change_refusal(self, snapshot: Snapshot, *, is_correction: bool) -> str:
        """Return the reason why the table cannot be changed now, or an empty string if it can be changed."""
        return self.offset_book.lock_reason or find_change_refusal(snapshot, is_correction=is_correction)

    def find_undo_refusal(self) -> str:
        """Return the reason why the last change cannot be undone now, or else an empty string."""
        return self.find_change_refusal(
            self.desk.read_snapshot(), is_correction=self.kind is OffsetKind.SECONDARY
        )

    # --- the page ------------------------------------------------------------------------------------

    def prompt_text(self, snapshot: Snapshot) -> str:
        """Return the prompt of the page, or the reason why the table cannot be changed."""
        if why := self.find_change_refusal(snapshot, is_correction=self.is_correction):
            return why
        if self.offset_history.listed_changes is not None:
            return tr("PAGE UP, PAGE DOWN: SCROLL   F5 OR ESC: CLOSE HISTORY")
        return self.make_hint(snapshot)

    def update(self, snapshot: Snapshot) -> None:
        """Read the unit of the control, and report newly saved changes.

        This method is called once per frame.
        """
        self.offset_history.update(snapshot)

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the window must handle the key."""
        if key in {"c", "C"} and self.clear_table_question:
            self.clear_table()
            return True
        return self.handle_entry_key(key)

    def edit_entry(self, key: str, max_length: int = MAX_LENGTH) -> None:
        """Apply one key press to the entered text."""
        self.text = apply_edit_key(self.text, key, max_length)

    def handle_undo(self) -> None:
        """Discard the entry.

        If there is no entry, ask whether to undo the last change of the selected row.
        """
        why = self.find_undo_refusal()
        if why or not self.cancel_entry():
            self.offset_history.show_refusal(
                why or self.confirmed_changes.ask_to_undo_change(self.kind, self.selected_row_number)
            )

    def clear_table(self) -> None:
        """Clear the whole table after the operator confirms (C)."""
        if why := self.find_change_refusal(self.desk.read_snapshot(), is_correction=False):
            self.desk.say(why)
        else:
            self.desk.ask_operator(tr(self.clear_table_question), self._clear_all)

    def _clear_all(self) -> None:
        why = self.find_change_refusal(self.desk.read_snapshot(), is_correction=False)
        self.offset_history.show_refusal(
            why or self.offset_book.clear_table(self.kind, self.clear_table_reason)
        )

    def handle_escape(self) -> bool:
        """Close the history, or cancel a question or the entry, when Esc is pressed.

        Returns False if there was nothing to close or cancel.
        """
        if self.offset_history.listed_changes is not None:
            self.offset_history.listed_changes = None
        elif self.desk.confirmation_key:
            self.desk.clear_prompt_line()
        else:
            return self.cancel_entry()
        return True

    def on_open(self) -> None:
        """Mark all earlier changes as known when the page opens, so that they are not reported."""
        self.offset_history.on_open()

    def on_close(self) -> None:
        """Discard the entry and close the history before the page closes."""
        self.discard_entry()
        self.desk.clear_prompt_line()
        self.offset_history.listed_changes = None


@dataclass(slots=True)
class IncompleteTool:
    """X or Z value that was entered for a new tool while the other value is still missing.

    Both values are saved together, because a tool with only one of them could run into the part.
    """

    tool_number: int = 0
    known_values: dict[str, FieldValue] = field(default_factory=dict)
    tip_x_mm: float | None = None  # X of the tip relative to part zero at the touch-off in mm.

    def add_value(self, tool_number: int, field_name: str, value: FieldValue) -> dict[str, FieldValue]:
        """Add X or Z, and return the values entered so far."""
        if tool_number != self.tool_number:
            self.discard_values()
        self.known_values = {**self.known_values, field_name: value}
        self.tool_number = tool_number
        return self.known_values

    def discard_values(self) -> None:
        """Discard the values that were entered."""
        self.tool_number, self.known_values, self.tip_x_mm = 0, {}, None

    def describe_missing_axis(self) -> str:
        """Return the note that an axis must still be touched off, or an empty string without a new tool."""
        if not self.tool_number:
            return ""
        text = tr("T{number} IS NOT SET YET. TOUCH OFF {axis} TOO")
        number = format_edge_suffix(self.tool_number)
        return tr(Message(text, number=number, axis=self.missing_axis.upper()))

    @property
    def missing_axis(self) -> str:
        """Return the axis whose value has not been entered yet, x or z."""
        return "x" if "z" in self.known_values else "z"


@dataclass(slots=True)
class ToolFieldEditor:
    """Editor that saves single fields of tools, used by the tool table (F8) and the Jog page.

    Each method that makes a change returns an empty string, or the reason if the change is rejected.
    """

    offset_history: OffsetHistory
    incomplete_tool: IncompleteTool = field(default_factory=IncompleteTool)

    def describe_unset_tool(self, tool_number: int) -> str:
        """Return the message that a tool has no offset yet."""
        text = tr("T{number} IS NOT SET. TYPE X AND Z, OR TOUCH OFF ON THE JOG PAGE")
        return tr(Message(text, number=format_edge_suffix(tool_number)))

    def save_field(
        self, tool_number: int, field_name: str, entered_text: str, *, is_increment: bool = False
    ) -> str:
        """Set a field of a tool to the entered value, or increase it by this value.

        ``is_increment`` means that the value is added. Raises InvalidEntryError if the value is invalid.
        """
        mode, row = (
            self.offset_history.unit_mode,
            self.offset_history.offset_book.tool_offsets.get(tool_number),
        )
        if row is None:
            return self._save_first_value(
                tool_number, field_name, parse_field_value(field_name, entered_text, mode)
            )
        value = (
            parse_field_increment(field_name, row, entered_text, mode)
            if is_increment
            else parse_field_value(field_name, entered_text, mode)
        )
        if value == getattr(row, field_name):
            self.offset_history.desk.say(
                tr(Message("T{number} NOT CHANGED", number=format_edge_suffix(tool_number)))
            )
            return ""
        typed = (
            f"{'MM ' if mode.is_metric else ''}{translate_field_name(field_name)} "
            f"{'+ ' if is_increment else ''}{entered_text.strip()}"
        )
        return ConfirmedOffsetChanges(self.offset_history).change_fields(
            OffsetKind.TOOL, tool_number, {field_name: value}, typed
        )

    def _save_first_value(self, number: int, name: str, value: FieldValue) -> str:
        """Save the first X and Z of a new tool after both have been entered."""
        if name not in {"x", "z"}:
            return self.describe_unset_tool(number)
        values = self.incomplete_tool.add_value(number, name, value)
        if len(values) < 2:
            text = tr("NOW ENTER {axis}. T{number} IS SET WHEN BOTH X AND Z ARE ENTERED")
            self.offset_history.desk.say(
                tr(
                    Message(
                        text,
                        axis=translate_field_name(self.incomplete_tool.missing_axis),
                        number=format_edge_suffix(number),
                    )
                )
            )
            return ""
        why = ConfirmedOffsetChanges(self.offset_history).change_fields(
            OffsetKind.TOOL, number, values, tr("manual entry")
        )
        if not why:
            self.incomplete_tool.discard_values()
        return why

    def ask_to_toggle_master(self, tool_number: int) -> str:
        """Ask whether to make a tool the master tool, or to have no master tool if it already is one."""
        if tool_number not in self.offset_history.offset_book.tool_offsets:
            return self.describe_unset_tool(tool_number)
        return ConfirmedOffsetChanges(self.offset_history).ask_to_toggle_master(tool_number)


class ToolFieldTable(OffsetTable):
    """Tool table with a selected field and the text that is entered for this field.

    A text field accepts letters after the operator opens it with Enter.
    """

    open_text_hint: ClassVar[str]  # Message for a letter before the text is open.

    @property
    def tool_number(self) -> int:
        """Return the number of the tool that is selected on the tool pages."""
        return self.offset_book.at

    @property
    def selected_row_number(self) -> int | None:
        """Return the number of the selected tool, to which undo applies."""
        return self.tool_number

    @property
    def tool_row(self) -> ToolOffsetRow | None:
        """Return the offset of the selected tool, or None if the tool was never set."""
        return self.offset_book.tool_offsets.get(self.tool_number)

    @property
    @abstractmethod
    def name(self) -> str:
        """Return the name of the selected field."""

    @property
    def selected_field_name(self) -> str:
        """Return the name of the selected field."""
        return self.name

    @property
    @abstractmethod
    def stored_value_text(self) -> str:
        """Return the saved value of the selected field as text."""

    def find_cell_refusal(self) -> str:
        """Return the reason why the selected field cannot be changed now, or else an empty string."""
        return self.find_change_refusal(self.desk.read_snapshot(), is_correction=self.is_correction)

    @property
    def accepts_any_text(self) -> bool:
        """Return whether the selected field accepts any text after it is opened with Enter."""
        field = TOOL_FIELDS[self.name]
        return field.field_type is FieldType.TEXT and not field.choices

    @property
    def question_text(self) -> str:
        """Return the prompt for a value, with the name of the tool and of the selected field."""
        return f"{format_edge_name(self.tool_number)}  {make_field_heading(self.name, self.unit_mode)}?"

    @property
    def change_description(self) -> str:
        """Return the old and the entered value of the field, or the last change if nothing is entered."""
        if not (self.text or self.is_text_open):
            return self.offset_history.last_change_text
        try:
            new = format_value(
                self.name, parse_field_value(self.name, self.text, self.unit_mode), self.unit_mode
            )
        except InvalidEntryError:
            new = "…"  # An incomplete expression is not an error yet.
        return f"{self.stored_value_text}  →  {new}"

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the selected field.

        The characters of numbers and expressions are accepted. While a text field is open, any character is
        accepted.
        """
        return self.is_text_open or key in EXPRESSION_CHARACTERS

    def handle_entry_key(self, key: str) -> bool:
        """Handle Enter and the keys that edit the text, and return whether the key was used.

        Subclasses handle the keys that select a field.
        """
        if key == "Enter":
            self.handle_enter()
        elif key in {"Back", "Delete"}:
            self.edit_entry(key)
        elif len(key) == 1 and self.accepts_key(key):
            self._add(key)
        else:
            return False
        return True

    @abstractmethod
    def handle_enter(self) -> None:
        """Handle Enter for the selected field."""

    def _add(self, key: str) -> None:
        if self.accepts_any_text and not self.is_text_open:
            self.desk.say(tr(self.open_text_hint))
            return
        if not self.text:
            self.desk.clear_prompt_line()
        self.edit_entry(key, int(TOOL_FIELDS[self.name].maximum) if self.is_text_open else MAX_LENGTH)

    def is_entry_unfinished(self) -> bool:
        """Return whether an entry must be accepted or canceled first, and show a message in this case."""
        if self.text or self.is_text_open:
            self.desk.say(tr("ENTER: SET   ESC: CANCEL"))
        return bool(self.text or self.is_text_open)

    def save_field(self, save_value: Callable[[], str]) -> bool:
        """Save the selected field by calling ``save_value``, and return whether this succeeded.

        If the value is rejected, show the reason and leave the text in the field for correction.
        """
        barred = self.find_cell_refusal()
        try:
            why = barred or save_value()
        except InvalidEntryError as error:
            why = tr(Message("REJECTED: {why}", why=error))
        if why:
            self.text = self.text if barred else refused(self.text)
            self.desk.say(why)
            return False
        self.text, self.is_text_open = "", False
        return True

    @property
    def has_entry(self) -> bool:
        """Return whether there is an entry that Esc can discard."""
        return bool(self.text or self.is_text_open)

    def cancel_entry(self) -> bool:
        """Discard the entry or close an open text field.

        Returns False if there is neither an entry nor an open text field.
        """
        if not self.has_entry:
            return False
        self.discard_entry()
        self.desk.say(tr(Message("T{number} NOT CHANGED", number=format_edge_suffix(self.tool_number))))
        return True

    def discard_entry(self) -> None:
        """Discard the entry without a message."""
        self.text, self.is_text_open = "", False
