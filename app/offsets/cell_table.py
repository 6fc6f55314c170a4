"""A table of offsets that is entered cell by cell: a cell is chosen, typed over and saved. mm and degrees."""

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
    """The cell that is chosen, and what is typed over it. A text takes letters once Return has opened it."""

    numbers: ClassVar[range]  # of the rows

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.row = self.column = 0
        self.writing = False  # a text is open

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def is_writing(self) -> bool:
        """Whether a text is open."""
        return self.writing

    @property
    def columns(self) -> tuple[str, ...]:
        """What the columns are called inside."""
        return tuple(FIELDS[self.kind])

    @property
    @abstractmethod
    def title(self) -> str:
        """What the table is, and its units."""

    @property
    def words(self) -> tuple[str, ...]:
        """What stands over the columns."""
        return tuple(self.field_of(name).word for name in self.columns)

    @abstractmethod
    def in_force(self, snapshot: Snapshot) -> int:
        """The number of the row that the machine goes by now; 0: none."""

    def field_of(self, name: str) -> Field:
        """What a column takes."""
        return FIELDS[self.kind][name]

    def value_at(self, number: int, name: str) -> Value:
        """A cell as it is saved; that of a row that was never set, or cannot be read."""
        row = self.book.of(self.kind).get(number)
        if self.book.unread:
            return UNKNOWN
        empty: Value = "" if self.field_of(name).sort is Sort.TEXT else 0.0
        return empty if row is None else getattr(row, name)

    def tone_at(self, _number: int, _name: str) -> Tone:
        """How urgent a cell is."""
        return Tone.OFF

    @property
    def number(self) -> int:
        """The number of the chosen row."""
        return self.numbers[self.row]

    @property
    def chosen(self) -> int | None:
        """Undo refers to the chosen row."""
        return self.number

    @property
    def name(self) -> str:
        """The field of the chosen column."""
        return self.columns[self.column]

    @property
    def field(self) -> Field:
        """What the chosen column takes."""
        return self.field_of(self.name)

    @property
    def which(self) -> str:
        """What the chosen row is called."""
        return f"{LETTERS[self.kind]}{self.number}"

    @property
    def stored(self) -> Row | None:
        """The chosen row as it is saved; None where it was never set."""
        return self.book.of(self.kind).get(self.number)

    @property
    def question(self) -> str:
        """What is asked for the chosen cell."""
        units = {Sort.METRIC: ", MM", Sort.ANGLE: tr(", DEGREES"), Sort.MINUTES: tr(", MINUTES")}
        return f"{self.which}  {self.field.word}{units.get(self.field.sort, '')}?"

    @property
    def value_before(self) -> Value:
        """The chosen cell as it is saved."""
        return self.value_at(self.number, self.name)

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""
        if not self.text.strip():
            return self.history.last_in_words
        try:
            new = self._value(self.text)
        except EntryError:
            return ""  # half a sum is no mistake yet
        before, after = (cell_text(self.field, value) for value in (self.value_before, new))
        return f"{self.which} {self.field.word}   {before}  →  {after}"

    def hint(self, _snapshot: Snapshot) -> str:
        """How a value is entered and another cell chosen."""
        if self.writing:
            return tr("TYPE THE TEXT. ENTER: SAVE   ESC: CANCEL")
        return tr("ENTER A NUMBER OR EXPRESSION   ARROWS, TAB: OTHER CELL")

    def barred(self, snapshot: Snapshot, *, correction: bool = False) -> str:
        """Nothing here is a correction: what says where zero or a tip is changes between cycles only."""
        if snapshot.state in UNDER_WAY - {State.JOG, State.HOME} and not self.book.locked:
            return tr("PROGRAM RUNNING. CHANGE THIS TABLE ONLY BETWEEN CYCLES")
        return self.book.locked or refusal(snapshot, correction=correction)

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Figures and signs are typed, C clears the table where it does; an open text takes everything."""
        return (
            (self.writing and len(key) == 1)
            or key in CHARACTERS
            or (bool(self.own_key) and key == self.own_key)
        )

    def typed(self, key: str) -> bool:
        """Of an open text every character is its own."""
        return self.enter_key(key) if self.writing else super().typed(key)

    def enter_key(self, key: str) -> bool:
        """Arrows go from cell to cell, Return saves what is typed."""
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
        """Another cell; what was typed and not entered is forgotten."""
        wide = len(self.columns)
        at = (self.row * wide + self.column + rows * wide + columns) % (len(self.numbers) * wide)
        self.choose(at // wide, at % wide)

    def choose(self, row: int, column: int) -> None:
        """The cell that a finger touched; a text opens when it is touched again."""
        again = (row, column) == (self.row, self.column)
        self.row, self.column, self.text, self.writing = row, column, "", False
        if again and self.field.sort is Sort.TEXT:
            self._open()
        elif again and self.field.sort is Sort.FLAG:
            self._turn()

    def take_back(self) -> bool:
        """Forget what is typed; False when nothing was."""
        typed = bool(self.text) or self.writing
        self.drop()
        return typed

    def drop(self) -> None:
        """Forget what is typed."""
        self.text, self.writing = "", False

    def enter(self) -> None:
        """Return saves what is typed, opens a text, or goes on to the next cell."""
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
        """A yes or no is the other one."""
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
        """The value, where it is one that is kept. Raises EntryError."""
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
        """Save the chosen cell, unless something is wrong with it; that is said, and the text stays.

        ``also`` are other fields of the row that follow its new value.
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
        """Have fields of the chosen row kept; answers why not, or nothing."""
        return self.questions.change(self.kind, self.number, values, why)

    def _reason(self, typed: str) -> str:
        return f"{self.field.word} {typed}".strip()
