"""Base class of offset tables that the operator edits cell by cell, in mm and degrees."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import ClassVar

from app.desk.arithmetic import CHARACTERS, EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import edited, refused
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.offset_changes import LETTERS, refusal
from app.offsets.offset_table import OffsetTable
from app.offsets.offset_values import UNKNOWN, cell_text, out_of_range, signed_zero_offset
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.store_rows import FIELDS, Field, Row, Sort, Value

_KEYS = CHARACTERS | {"Back", "Delete", "Enter", "Tab", "Up", "Down", "Left", "Right"}
_STEPS = {"Tab": (0, 1), "Right": (0, 1), "Left": (0, -1), "Up": (-1, 0), "Down": (1, 0)}
_LEAFS = {"Page up": -10, "Page down": 10}


class CellTable(OffsetTable):
    """A table with a selected cell and the text that is entered for it.

    A text cell accepts letters after Enter has opened it.
    """

    numbers: ClassVar[range]  # Numbers of the rows.

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.row = self.column = 0
        self.writing = False  # A text is being edited.

    # --- display -------------------------------------------------------------------------------------

    @property
    def is_writing(self) -> bool:
        """Whether a text cell is being edited."""
        return self.writing

    @property
    def columns(self) -> tuple[str, ...]:
        """The field names of the columns."""
        return tuple(FIELDS[self.kind])

    @property
    @abstractmethod
    def title(self) -> str:
        """The title of the table, with its units."""

    @property
    def words(self) -> tuple[str, ...]:
        """The column heads."""
        return tuple(self.field_of(name).word for name in self.columns)

    @abstractmethod
    def in_force(self, snapshot: Snapshot) -> int:
        """Return the number of the row that the machine uses now, or 0."""

    def field_of(self, name: str) -> Field:
        """Return the field definition of a column."""
        return FIELDS[self.kind][name]

    def value_at(self, number: int, name: str) -> Value:
        """Return the saved value of a cell.

        A row that was never set gives 0 or an empty text. Unreadable offsets give ``UNKNOWN``.
        """
        row = self.book.of(self.kind).get(number)
        if self.book.unread:
            return UNKNOWN
        empty: Value = "" if self.field_of(name).sort is Sort.TEXT else 0.0
        return empty if row is None else getattr(row, name)

    def tone_at(self, _number: int, _name: str) -> Tone:
        """Return the tone of a cell, which shows its urgency."""
        return Tone.OFF

    @property
    def number(self) -> int:
        """The number of the selected row."""
        return self.numbers[self.row]

    @property
    def chosen(self) -> int | None:
        """The number of the selected row, to which undo applies."""
        return self.number

    @property
    def name(self) -> str:
        """The field name of the selected column."""
        return self.columns[self.column]

    @property
    def field(self) -> Field:
        """The field definition of the selected column."""
        return self.field_of(self.name)

    @property
    def which(self) -> str:
        """The displayed name of the selected row."""
        return f"{LETTERS[self.kind]}{self.number}"

    @property
    def stored(self) -> Row | None:
        """The saved values of the selected row. None if the row was never set."""
        return self.book.of(self.kind).get(self.number)

    @property
    def question(self) -> str:
        """The prompt for the selected cell, with its unit."""
        units = {Sort.METRIC: ", MM", Sort.ANGLE: tr(", DEGREES"), Sort.MINUTES: tr(", MINUTES")}
        return f"{self.which}  {self.field.word}{units.get(self.field.sort, '')}?"

    @property
    def value_before(self) -> Value:
        """The saved value of the selected cell."""
        return self.value_at(self.number, self.name)

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last change."""
        if not self.text.strip():
            return self.history.last_in_words
        try:
            new = self._value(self.text)
        except EntryError:
            return ""  # An incomplete expression is not an error yet.
        before, after = (cell_text(self.field, value) for value in (self.value_before, new))
        return f"{self.which} {self.field.word}   {before}  →  {after}"

    def hint(self, _snapshot: Snapshot) -> str:
        """Return how to enter a value and select another cell."""
        if self.writing:
            return tr("TYPE THE TEXT. ENTER: SAVE   ESC: CANCEL")
        return tr("ENTER A NUMBER OR EXPRESSION   ARROWS, TAB: OTHER CELL")

    def barred(self, snapshot: Snapshot, *, correction: bool = False) -> str:
        """Return why this table cannot be changed now. Empty if it can.

        A change moves a zero point or a tip, so it is possible only between cycles.
        """
        if snapshot.state in UNDER_WAY - {State.JOG, State.HOME} and not self.book.locked:
            return tr("PROGRAM RUNNING. CHANGE THIS TABLE ONLY BETWEEN CYCLES")
        return self.book.locked or refusal(snapshot, correction=correction)

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Return whether a character can be entered.

        These are the characters of numbers, C if it clears the table, or any character in an open text.
        """
        return (
            (self.writing and len(key) == 1)
            or key in CHARACTERS
            or (bool(self.own_key) and key == self.own_key)
        )

    def typed(self, key: str) -> bool:
        """Handle a key. While a text is open, every character belongs to the text."""
        return self.enter_key(key) if self.writing else super().typed(key)

    def enter_key(self, key: str) -> bool:
        """Handle a key of the table: arrow keys select a cell, and Enter saves the entered value."""
        if self.writing and (len(key) == 1 or key in {"Back", "Delete"}):
            self.text = edited(self.text, key, int(self.field.high))
            return True
        if key in _LEAFS:
            self.choose(max(0, min(self.row + _LEAFS[key], len(self.numbers) - 1)), self.column)
            return True
        if key not in _KEYS:
            return False
        self.desk.clear()
        if key in _STEPS:
            self.move(*_STEPS[key])
        elif key == "Enter":
            self.enter()
        elif self.field.sort is not Sort.TEXT:
            self.type_text(key)
        return True

    def move(self, rows: int, columns: int) -> None:
        """Select another cell by rows and columns. A value that was not entered is discarded."""
        wide = len(self.columns)
        at = (self.row * wide + self.column + rows * wide + columns) % (len(self.numbers) * wide)
        self.choose(at // wide, at % wide)

    def choose(self, row: int, column: int) -> None:
        """Select a touched cell. A second touch opens a text or toggles a flag."""
        again = (row, column) == (self.row, self.column)
        self.row, self.column, self.text, self.writing = row, column, "", False
        if again and self.field.sort is Sort.TEXT:
            self._open()
        elif again and self.field.sort is Sort.FLAG:
            self._turn()

    def take_back(self) -> bool:
        """Discard the entered text. Return False if nothing was entered."""
        typed = bool(self.text) or self.writing
        self.drop()
        return typed

    def drop(self) -> None:
        """Discard the entered text."""
        self.text, self.writing = "", False

    def enter(self) -> None:
        """Handle Enter: save the entered value, open a text, toggle a flag, or select the next cell."""
        if self.writing:
            self.save(self.text.strip, "")
        elif self.field.sort is Sort.TEXT:
            self._open()
        elif self.text.strip():
            self.save(lambda: self._value(self.text), self.text.strip())
        elif self.field.sort is Sort.FLAG:
            self._turn()
        else:
            self.move(0, 1)

    def _turn(self) -> None:
        """Toggle a flag and save it."""
        on = not self.value_before
        self.save(lambda: on, "1" if on else "0")

    def _open(self) -> None:
        if why := self.barred(self.desk.snapshot()):
            self.desk.say(why)
            return
        self.writing, self.text = True, str(self.value_before)

    # --- saving --------------------------------------------------------------------------------------

    def _value(self, text: str) -> Value:
        if self.writing:
            return text.strip()
        value = self.checked(value_of(text))
        return int(value) if self.field.sort in {Sort.WHOLE, Sort.FLAG} else value

    def checked(self, value: float) -> float:
        """Return the rounded value if it is in the range of the field. Raises EntryError otherwise."""
        field = self.field
        if field.takes(value):
            return round(value, 10)
        unit = {Sort.ANGLE: tr("degrees"), Sort.MINUTES: tr("min"), Sort.WHOLE: "", Sort.FLAG: ""}.get(
            field.sort, tr("mm")
        )
        named = f"{self.which} {field.word}"
        raise EntryError(out_of_range(named, signed_zero_offset(value), unit, field.low, field.high))

    def save(
        self,
        value: Callable[[], Value],
        typed: str,
        also: Callable[[Value], Mapping[str, Value]] = lambda _new: {},
    ) -> bool:
        """Save the selected cell, and return whether this succeeded. A rejected text remains for correction.

        ``typed`` is recorded in the history. ``also`` returns other fields of the row that depend on the new
        value.
        """
        if why := self.barred(self.desk.snapshot()):
            self.desk.say(why)
            return False
        try:
            new = value()
        except EntryError as error:
            self.text = refused(self.text)
            self.desk.say(tr(Message("REJECTED: {why}", why=error)))
            return False
        if self.stored is not None and self.value_before == new:
            self.desk.say(tr(Message("{which} NOT CHANGED", which=self.which)))
        elif why := self.keep({self.name: new, **also(new)}, self._reason(typed)):
            self.text = refused(self.text)
            self.desk.say(why)
            return False
        self.drop()
        return True

    def keep(self, values: Mapping[str, Value], why: str) -> str:
        """Save fields of the selected row. Return why this was rejected, or an empty text."""
        return self.questions.change(self.kind, self.number, values, why)

    def _reason(self, typed: str) -> str:
        return f"{self.field.word} {typed}".strip()
