"""Tool offsets, F8: a table of 32 tools in which a cell is chosen, typed into, and saved."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.arithmetic import CHARACTERS, LONGEST, EntryError
from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.offset_history import CORRECTIONS, OffsetHistory, counts_from
from app.offsets.offset_table import OffsetTable, Proposed
from app.offsets.offset_values import (
    heading,
    not_set,
    shown_value,
    value_added,
    value_typed,
    word,
)
from core.executor.snapshot import Snapshot
from core.store.store_rows import OFFSETS, REMARK_LONGEST, Kind, ToolRow, Value

COLUMNS = ("x", "z", "nose_radius", "quadrant", "wear_x", "wear_z", "master", "remark")
PAGE = 5  # rows that are shown, each of a finger's height, and that Page up and Page down go
_MOVES = {"Up": (-1, 0), "Down": (1, 0), "Left": (0, -1), "Right": (0, 1), "Tab": (0, 1)}


@dataclass(slots=True)
class NewTool:
    """X or Z alone of a tool that was never set: half an offset would run into the part, so it waits."""

    number: int = 0
    values: dict[str, Value] = field(default_factory=dict)

    def add(self, number: int, name: str, value: Value) -> dict[str, Value]:
        """One of the two; answers what there is of this tool now."""
        self.values = {**(self.values if number == self.number else {}), name: value}
        self.number = number
        return self.values

    def drop(self) -> None:
        """It is not to be set after all."""
        self.number, self.values = 0, {}

    @property
    def missing(self) -> str:
        """The axis that is still to come."""
        return "x" if "z" in self.values else "z"


@dataclass(slots=True)
class ToolFields:
    """Saves single fields of tools, for F8 and the Jog page. Each answer is why not, or nothing."""

    history: OffsetHistory
    new: NewTool = field(default_factory=NewTool)

    def never_set(self, number: int) -> str:
        """Why a tool that nobody has set has no fields."""
        text = tr("T{number} WAS NEVER SET: TYPE X AND Z FIRST, OR TOUCH IT OFF ON THE JOG PAGE")
        return text.format(number=number)

    def save(self, number: int, name: str, text: str, *, adding: bool = False) -> str:
        """Set a field to what is typed, or add that to it. Raises EntryError for a text that is no value."""
        mode, row = self.history.mode, self.history.book.tools.get(number)
        if row is None:
            return self._first(number, name, value_typed(name, text, mode))
        value = value_added(name, row, text, mode) if adding else value_typed(name, text, mode)
        if value == getattr(row, name):
            self.history.desk.say(tr("T{number} IS AS IT WAS").format(number=number))
            return ""
        typed = f"{'MM ' if mode.metric else ''}{word(name)} {'+ ' if adding else ''}{text.strip()}"
        return self.history.book.change(Kind.TOOL, number, {name: value}, typed)

    def _first(self, number: int, name: str, value: Value) -> str:
        """X and Z of a tool that was never set are saved together."""
        if name not in {"x", "z"}:
            return self.never_set(number)
        values = self.new.add(number, name, value)
        if len(values) < 2:
            text = tr("NOW {axis}: T{number} IS SET WHEN BOTH ARE THERE")
            self.history.desk.say(text.format(axis=word(self.new.missing), number=number))
            return ""
        why = self.history.book.change(Kind.TOOL, number, values, tr("entered by hand"))
        if not why:
            self.new.drop()
        return why

    def master(self, number: int) -> str:
        """A tool becomes the one that the others are relative to; being it already, none is."""
        row = self.history.book.tools.get(number)
        if row is None:
            return self.never_set(number)
        if row.master:
            return self.history.book.choose_master(0, tr("no master"))
        return self.history.book.choose_master(number, tr("chosen as master"))


class ToolOffsets(OffsetTable):
    """Where the cursor stands and what is typed there. A remark takes letters once Return has opened it."""

    kind = Kind.TOOL

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.fields = ToolFields(self.history)
        self.column = 0
        self.writing = False  # a remark is open
        self.relative = False  # X and Z are shown from the master

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def number(self) -> int:
        """The tool under the cursor; its page of shape stands at the same."""
        return self.book.at

    @property
    def name(self) -> str:
        """The field under the cursor."""
        return COLUMNS[self.column]

    @property
    def tool(self) -> ToolRow | None:
        """The tool under the cursor; None when it was never set."""
        return self.book.tools.get(self.number)

    def cell(self, number: int, name: str) -> str:
        """A cell of the table; X and Z of another tool from the master when that is asked for."""
        book, mode, new = self.book, self.mode, self.fields.new
        row = book.tools.get(number)
        if row is None:
            known = number == new.number and name in new.values
            return shown_value(name, new.values[name], mode) if known else ""
        master = book.tools.get(book.master)
        if self.relative and master is not None and name in {"x", "z"} and number != book.master:
            at = "xz".index(name)
            return shown_value(name, row.offset[at] - master.offset[at], mode)
        return shown_value(name, getattr(row, name), mode)

    @property
    def question(self) -> str:
        """The tool and the field under the cursor."""
        return f"T{self.number}  {heading(self.name, self.mode)}?"

    @property
    def old_to_new(self) -> str:
        """The cell before and after what is typed, or else the last change."""
        if not (self.text or self.writing):
            return self.history.last_in_words
        was = self.cell(self.number, self.name) or (not_set() if self.tool is None else "")
        try:
            new = shown_value(self.name, value_typed(self.name, self.text, self.mode), self.mode)
        except EntryError:
            new = "…"  # half a sum is no mistake yet
        return f"{was}  →  {new}"

    @property
    def foot(self) -> str:
        """What F2, F3 and Esc do here."""
        return tr(
            "F2 adds what is typed; F3 shows X and Z from the master; F8: shape of the tool; Esc leaves"
        )

    def hint(self, snapshot: Snapshot) -> str:
        """Of an open remark, or of the table."""
        if self.writing:
            return tr("TYPE THE REMARK; RETURN KEEPS IT, ESC LEAVES IT AS IT WAS; F-KEYS STILL WORK")
        return counts_from(snapshot) or tr(
            "ARROWS CHOOSE A CELL; TYPE A VALUE OR A SUM; RETURN SETS IT, F2 ADDS IT TO WHAT IS THERE"
        )

    def proposed(self) -> Proposed:
        """The tables as they would be with what is typed."""
        tools, secondary = super().proposed()
        if self.tool is None or not self.text:
            return tools, secondary
        try:
            value = value_typed(self.name, self.text, self.mode)
        except EntryError:
            return tools, secondary
        return {**tools, self.number: self.tool._replace(**{self.name: value})}, secondary  # type: ignore[arg-type]

    @property
    def corrects(self) -> bool:
        """Wear and remark may change while parts run."""
        return self.name in CORRECTIONS

    def cell_barred(self) -> str:
        """Why the cell under the cursor may not be changed now; empty when it may."""
        if self.relative and self.name in {"x", "z"}:
            return tr("X AND Z ARE SHOWN FROM THE MASTER: PRESS F3, THEN TYPE THEM FROM HOME")
        return self.barred(self.desk.snapshot(), correction=self.corrects)

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: an entry in another unit is given up, or one of X where X has changed.

        Wear is a diameter whatever the control's X is, which every part changes as it begins.
        """
        before = self.mode
        super().look(snapshot)
        position = not self.corrects or bool(self.fields.new.number)
        changed = self.mode != before if position else self.mode.metric != before.metric
        if changed and (self.text or self.fields.new.number):
            self.drop()
            self.desk.say(
                tr("THE CONTROL HAS CHANGED ITS UNIT OR ITS X: NOTHING WAS CHANGED, ENTER IT AGAIN")
            )

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Figures and signs; every character while a remark is written."""
        return self.writing or key in CHARACTERS

    def enter_key(self, key: str) -> bool:
        """Arrows go from cell to cell, Return sets what is typed."""
        if key == "Enter":
            self._enter()
        elif key in {"Page up", "Page down"}:
            self._go(self.number + (PAGE if key == "Page down" else -PAGE), self.column)
        elif key in _MOVES:
            down, right = _MOVES[key]
            self._go(self.number + down, self.column + right)
        elif key in {"Back", "Delete"}:
            self.type_text(key)
        elif len(key) == 1 and self.takes(key):
            self._add(key)
        else:
            return False
        return True

    def choose(self, number: int, column: int) -> None:
        """A cell by a finger; touched again its remark opens, or its mark is set."""
        again = (number, column) == (self.number, self.column)
        self._go(number, column)
        if again and self.name in {"remark", "master"} and not self.writing:
            self._enter()

    def add(self) -> None:
        """F2: what is typed is added to what is there."""
        if self.tool is None or not self.text.strip():
            self.desk.say(tr("TYPE WHAT IS TO BE ADDED FIRST, THEN PRESS F2"))
            return
        self._store(adding=True)

    def turn_relative(self) -> None:
        """F3: X and Z from home, or from the master."""
        if not self.relative and not self.book.master:
            self.desk.say(tr("NO TOOL IS THE MASTER: CHOOSE ONE IN ITS COLUMN WITH RETURN"))
            return
        self.relative = not self.relative

    def _add(self, key: str) -> None:
        if self.name == "remark" and not self.writing:
            self.desk.say(tr("PRESS RETURN TO WRITE A REMARK"))
            return
        if not self.text:
            self.desk.clear()
        self.type_text(key, REMARK_LONGEST if self.writing else LONGEST)

    def _go(self, number: int, column: int) -> None:
        """The cursor there; what was typed and not entered stays behind, and that is said."""
        if self.text or self.writing:
            self.desk.say(tr("PRESS RETURN TO SET IT, OR ESC TO LEAVE IT AS IT WAS"))
            return
        self.book.at = max(OFFSETS[0], min(OFFSETS[-1], number))
        self.column = max(0, min(len(COLUMNS) - 1, column))
        new = self.fields.new
        if new.number and self.number != new.number:
            self.desk.say(tr("T{number} IS NOT SET: X AND Z BELONG TOGETHER").format(number=new.number))
            self.drop()

    def _enter(self) -> None:
        if self.name == "master":
            self.history.answer(self.cell_barred() or self.fields.master(self.number))
        elif self.name == "remark" and not self.writing:
            self._open()
        elif self.text.strip() or self.writing:
            self._store(adding=False)
        else:
            self._go(self.number, self.column + 1)

    def _open(self) -> None:
        why = self.cell_barred()
        if why or self.tool is None:
            self.desk.say(why or self.fields.never_set(self.number))
            return
        self.writing, self.text = True, self.tool.remark

    def _store(self, *, adding: bool) -> None:
        """Save the cell; of a new tool go on to what is missing."""
        why = self.cell_barred()
        try:
            why = why or self.fields.save(self.number, self.name, self.text, adding=adding)
        except EntryError as error:
            why = tr("REFUSED: {why}").format(why=error)
        if why:
            self.desk.say(why)
            return
        self.text, self.writing = "", False
        if self.fields.new.number:
            self.column = COLUMNS.index(self.fields.new.missing)

    def take_back(self) -> bool:
        """What is typed, an open remark, or half of a new tool."""
        if not (self.text or self.writing or self.fields.new.number):
            return False
        self.drop()
        self.desk.say(tr("T{number} IS AS IT WAS").format(number=self.number))
        return True

    def drop(self) -> None:
        """Forget what is typed, an open remark and half of a new tool."""
        self.text, self.writing = "", False
        self.fields.new.drop()
