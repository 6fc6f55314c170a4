"""Base class for offset tables that the operator edits cell by cell, in mm and degrees."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import ClassVar

from app.desk.arithmetic import EXPRESSION_CHARACTERS, InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import apply_edit_key, refused
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.offsets.offset_changes import NUMBER_PREFIXES, find_change_refusal
from app.offsets.offset_table import OffsetTable
from app.offsets.offset_values import UNKNOWN_VALUE, describe_range_error, format_cell, format_zero_offset
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message
from core.store.store_rows import FIELDS_BY_KIND, FieldType, FieldValue, OffsetRow, RowField

_ENTRY_KEYS = EXPRESSION_CHARACTERS | {"Back", "Delete", "Enter", "Tab", "Up", "Down", "Left", "Right"}
_CELL_STEPS = {"Tab": (0, 1), "Right": (0, 1), "Left": (0, -1), "Up": (-1, 0), "Down": (1, 0)}


class CellTable(OffsetTable):
    """Table with a selected cell and the text that is being entered in this cell.

    A text cell accepts letters after the operator opens it with Enter.
    """

    numbers: ClassVar[range]  # Numbers of the rows.

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.row_index = self.column_index = 0
        self.is_text_open = False  # A text is being edited.

    # --- display -------------------------------------------------------------------------------------

    @property
    def is_editing_text(self) -> bool:
        """Return whether a text cell is being edited."""
        return self.is_text_open

    @property
    def columns(self) -> tuple[str, ...]:
        """Return the field names of the columns."""
        return tuple(FIELDS_BY_KIND[self.kind])

    @property
    @abstractmethod
    def title(self) -> str:
        """Return the title of the table, with its units."""

    @property
    def words(self) -> tuple[str, ...]:
        """Return the column headings."""
        return tuple(self.field_of(name).label for name in self.columns)

    @abstractmethod
    def find_active_row(self, snapshot: Snapshot) -> int:
        """Return the number of the row that the machine currently uses, or 0 if it uses no row."""

    def field_of(self, name: str) -> RowField:
        """Return the field definition of a column."""
        return FIELDS_BY_KIND[self.kind][name]

    def value_at(self, number: int, name: str) -> FieldValue:
        """Return the saved value of a cell.

        If the row was never set, the value is 0 or an empty string. If the offsets could not be read, the
        value is ``UNKNOWN_VALUE``.
        """
        row = self.offset_book.get_rows(self.kind).get(number)
        if self.offset_book.has_read_failed:
            return UNKNOWN_VALUE
        empty: FieldValue = "" if self.field_of(name).field_type is FieldType.TEXT else 0.0
        return empty if row is None else getattr(row, name)

    def tone_at(self, _number: int, _name: str) -> StatusTone:
        """Return the color tone of a cell, which shows whether the operator should check its value."""
        return StatusTone.OFF

    @property
    def number(self) -> int:
        """Return the number of the selected row."""
        return self.numbers[self.row_index]

    @property
    def selected_row_number(self) -> int | None:
        """Return the number of the selected row, to which undo applies."""
        return self.number

    @property
    def name(self) -> str:
        """Return the field name of the selected column."""
        return self.columns[self.column_index]

    @property
    def selected_field_name(self) -> str:
        """Return the name of the selected field."""
        return self.name

    @property
    def selected_field(self) -> RowField:
        """Return the field definition of the selected column."""
        return self.field_of(self.name)

    @property
    def row_name(self) -> str:
        """Return the displayed name of the selected row."""
        return f"{NUMBER_PREFIXES[self.kind]}{self.number}"

    @property
    def stored_row(self) -> OffsetRow | None:
        """Return the saved values of the selected row, or None if the row was never set."""
        return self.offset_book.get_rows(self.kind).get(self.number)

    @property
    def question_text(self) -> str:
        """Return the prompt for the selected cell, with its unit."""
        units = {
            FieldType.METRIC_LENGTH: ", MM",
            FieldType.ANGLE: tr(", DEGREES"),
            FieldType.MINUTES: tr(", MINUTES"),
        }
        return f"{self.row_name}  {self.selected_field.label}{units.get(self.selected_field.field_type, '')}?"

    @property
    def stored_value(self) -> FieldValue:
        """Return the saved value of the selected cell."""
        return self.value_at(self.number, self.name)

    @property
    def change_description(self) -> str:
        """Return a description of the change being entered, or of the last change if nothing is entered."""
        if not self.text.strip():
            return self.offset_history.last_change_text
        try:
            new = self._value(self.text)
        except InvalidEntryError:
            return ""  # An incomplete expression is not an error yet.
        before, after = (format_cell(self.selected_field, value) for value in (self.stored_value, new))
        return f"{self.row_name} {self.selected_field.label}   {before}  →  {after}"

    def make_hint(self, _snapshot: Snapshot) -> str:
        """Return the prompt that explains how to enter a value and how to select another cell."""
        if self.is_text_open:
            return tr("TYPE THE TEXT. ENTER: SAVE   ESC: CANCEL")
        return tr("ENTER A NUMBER OR EXPRESSION   ARROWS, TAB: OTHER CELL")

    def find_change_refusal(self, snapshot: Snapshot, *, is_correction: bool = False) -> str:
        """Return the reason why this table cannot be changed now, or an empty string if it can be changed.

        A change moves a zero point or a tool tip, so changes are allowed only between cycles.
        """
        if (
            snapshot.state in ACTIVE_STATES - {MachineState.JOG, MachineState.HOMING}
            and not self.offset_book.lock_reason
        ):
            return tr("PROGRAM RUNNING. CHANGE THIS TABLE ONLY BETWEEN CYCLES")
        return self.offset_book.lock_reason or find_change_refusal(snapshot, is_correction=is_correction)

    # --- keys ----------------------------------------------------------------------------------------

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the selected cell.

        The characters of numbers and expressions are accepted, and also the letter that clears the table.
        While a text cell is open, any character is accepted.
        """
        return (
            (self.is_text_open and len(key) == 1)
            or key in EXPRESSION_CHARACTERS
            or (bool(self.page_key) and key == self.page_key)
        )

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return whether it was used.

        While a text cell is open, every character is added to its text.
        """
        return self.handle_entry_key(key) if self.is_text_open else super().handle_key(key)

    def handle_entry_key(self, key: str) -> bool:
        """Handle a key that selects a cell or edits its value, and return whether it was used.

        The arrow keys select a cell, and Enter saves the entered value.
        """
        if self.is_text_open and (len(key) == 1 or key in {"Back", "Delete"}):
            self.text = apply_edit_key(self.text, key, int(self.selected_field.maximum))
            return True
        if key not in _ENTRY_KEYS:
            return False
        self.desk.clear_prompt_line()
        if key in _CELL_STEPS:
            self.move_selection(*_CELL_STEPS[key])
        elif key == "Enter":
            self.handle_enter()
        elif self.selected_field.field_type is not FieldType.TEXT:
            self.edit_entry(key)
        return True

    def move_selection(self, row_steps: int, column_steps: int) -> None:
        """Move the selection by a number of rows and columns.

        An entry that was not saved is discarded.
        """
        wide = len(self.columns)
        at = (self.row_index * wide + self.column_index + row_steps * wide + column_steps) % (
            len(self.numbers) * wide
        )
        self.choose(at // wide, at % wide)

    def select_row(self, row: int) -> None:
        """Select the cell of the same column in a row, without a change of this cell."""
        if row != self.row_index:
            self.choose(row, self.column_index)

    def choose(self, row: int, column: int) -> None:
        """Select the touched cell.

        A second touch opens a text cell or toggles a flag.
        """
        again = (row, column) == (self.row_index, self.column_index)
        self.row_index, self.column_index, self.text, self.is_text_open = row, column, "", False
        if again and self.selected_field.field_type is FieldType.TEXT:
            self._open()
        elif again and self.selected_field.field_type is FieldType.BOOLEAN:
            self._toggle_flag()

    def cancel_entry(self) -> bool:
        """Discard the entered text, and return whether anything was entered."""
        typed = bool(self.text) or self.is_text_open
        self.discard_entry()
        return typed

    def discard_entry(self) -> None:
        """Discard the entered text."""
        self.text, self.is_text_open = "", False

    def handle_enter(self) -> None:
        """Handle Enter according to the selected cell.

        Enter saves an entered value, opens a text cell or toggles a flag. Otherwise it selects the next
        cell.
        """
        if self.is_text_open:
            self.save_cell(self.text.strip, "")
        elif self.selected_field.field_type is FieldType.TEXT:
            self._open()
        elif self.text.strip():
            self.save_cell(lambda: self._value(self.text), self.text.strip())
        elif self.selected_field.field_type is FieldType.BOOLEAN:
            self._toggle_flag()
        else:
            self.move_selection(0, 1)

    def _toggle_flag(self) -> None:
        """Toggle the flag in the selected cell, and save it."""
        on = not self.stored_value
        self.save_cell(lambda: on, "1" if on else "0")

    def _open(self) -> None:
        if why := self.find_change_refusal(self.desk.read_snapshot()):
            self.desk.say(why)
            return
        self.is_text_open, self.text = True, str(self.stored_value)

    # --- saving --------------------------------------------------------------------------------------

    def _value(self, text: str) -> FieldValue:
        if self.is_text_open:
            return text.strip()
        value = self.check_range(evaluate_expression(text))
        return (
            int(value) if self.selected_field.field_type in {FieldType.INTEGER, FieldType.BOOLEAN} else value
        )

    def check_range(self, value: float) -> float:
        """Return the rounded value if it is in the range of the selected field.

        Raises InvalidEntryError if the value is out of range.
        """
        field = self.selected_field
        if field.is_valid_value(value):
            return round(value, 10)
        unit = {
            FieldType.ANGLE: tr("degrees"),
            FieldType.MINUTES: tr("min"),
            FieldType.INTEGER: "",
            FieldType.BOOLEAN: "",
        }.get(field.field_type, tr("mm"))
        named = f"{self.row_name} {field.label}"
        raise InvalidEntryError(
            describe_range_error(named, format_zero_offset(value), unit, field.minimum, field.maximum)
        )

    def save_cell(
        self,
        parse_value: Callable[[], FieldValue],
        entered_text: str,
        find_dependent_values: Callable[[FieldValue], Mapping[str, FieldValue]] = lambda _new: {},
    ) -> bool:
        """Save a value in the selected cell, and return whether this succeeded.

        A rejected text remains in the cell for correction. ``entered_text`` is recorded in the history.
        ``find_dependent_values`` returns the other fields of the row that depend on the new value.
        """
        if why := self.find_change_refusal(self.desk.read_snapshot()):
            self.desk.say(why)
            return False
        try:
            new = parse_value()
        except InvalidEntryError as error:
            self.text = refused(self.text)
            self.desk.say(tr(Message("REJECTED: {why}", why=error)))
            return False
        if self.stored_row is not None and self.stored_value == new:
            self.desk.say(tr(Message("{which} NOT CHANGED", which=self.row_name)))
        elif why := self.save_fields(
            {self.name: new, **find_dependent_values(new)}, self._reason(entered_text)
        ):
            self.text = refused(self.text)
            self.desk.say(why)
            return False
        self.discard_entry()
        return True

    def save_fields(self, values: Mapping[str, FieldValue], reason: str) -> str:
        """Save several fields of the selected row.

        Returns the reason if the change is rejected, or an empty string on success.
        """
        return self.confirmed_changes.change_fields(self.kind, self.number, values, reason)

    def _reason(self, typed: str) -> str:
        return f"{self.selected_field.label} {typed}".strip()
