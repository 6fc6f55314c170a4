"""The model of F8: a table of 32 tools in which a cell is chosen, typed into, and saved."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.arithmetic import LONGEST, EntryError
from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets import offset_changes
from app.offsets.effect_shown import Rows
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_history import Ledger
from app.offsets.offset_values import marked, not_set, shown_value, value_typed, word
from app.offsets.secondary_dialogue import CHARACTERS
from app.offsets.tool_cells import ToolCells
from core.executor.snapshot import Snapshot
from core.store.store_rows import OFFSETS, REMARK_LONGEST, Kind, ToolRow

# --- F8 in words: the cells of the table, the question, and what an answer would change.


def cell(grid: ToolGrid, number: int, name: str) -> str:
    """A cell of the table; X and Z of another tool from the master when that is asked for."""
    book, mode = grid.book, grid.ledger.mode
    row, new = book.tools.get(number), grid.cells.new
    if row is None:
        known = number == new.number and name in new.values
        return shown_value(name, new.values[name], mode) if known else ""
    master = book.tools.get(book.master)
    if grid.relative and master is not None and name in {"x", "z"} and number != book.master:
        at = "xz".index(name)
        return shown_value(name, row.offset[at] - master.offset[at], mode)
    return shown_value(name, getattr(row, name), mode)


def question(grid: ToolGrid) -> str:
    """What is asked: tool and field."""
    mark = marked(grid.name, grid.ledger.mode)
    return f"T{grid.number}  {word(grid.name)}{f' {mark}' if mark else ''}?"


def old_to_new(grid: ToolGrid) -> str:
    """The cell before and after what is typed, or else the last change."""
    if not (grid.text or grid.writing):
        return grid.ledger.last_told
    was = cell(grid, grid.number, grid.name) or (not_set() if grid.tool is None else "")
    mode = grid.ledger.mode
    try:
        new = shown_value(grid.name, value_typed(grid.name, grid.text, mode), mode)
    except EntryError:
        new = "…"  # half a sum is no mistake yet
    return f"{was}  →  {new}"


def proposed(grid: ToolGrid) -> Rows:
    """The tables as they would be with what is typed."""
    tools, secondary, row = grid.book.tools, grid.book.secondary, grid.tool
    if row is None or not grid.text:
        return tools, secondary
    try:
        value = value_typed(grid.name, grid.text, grid.ledger.mode)
    except EntryError:
        return tools, secondary
    return {**tools, grid.number: row._replace(**{grid.name: value})}, secondary  # type: ignore[arg-type]


COLUMNS = ("x", "z", "nose_radius", "quadrant", "wear_x", "wear_z", "master", "remark")
PAGE = 5  # rows that are shown, each of a finger's height, and that Page up and Page down go
_MOVES = {"Up": (-1, 0), "Down": (1, 0), "Left": (0, -1), "Right": (0, 1), "Tab": (0, 1)}


@dataclass(slots=True)
class ToolGrid:
    """Where the cursor stands and what is typed there. A remark takes letters once Return has opened it."""

    desk: Desk
    book: OffsetBook
    ledger: Ledger = field(init=False)
    cells: ToolCells = field(init=False)
    number: int = 1
    column: int = 0
    text: str = ""
    writing: bool = False  # a remark is open
    relative: bool = False  # X and Z are shown from the master

    def __post_init__(self) -> None:
        self.ledger = Ledger(self.desk, self.book, Kind.TOOL)
        self.cells = ToolCells(self.ledger)

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The field under the cursor."""
        return COLUMNS[self.column]

    @property
    def tool(self) -> ToolRow | None:
        """The tool under the cursor; None when it was never set."""
        return self.book.tools.get(self.number)

    def proposed(self) -> Rows:
        """The tables as they would be with what is typed."""
        return proposed(self)

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        correction = self.name in offset_changes.CORRECTIONS
        why = self.book.locked or offset_changes.refusal(snapshot, correction=correction)
        if why:
            return why
        if self.ledger.looking_back is not None:
            return tr("F5 OR ESC LEAVES THE HISTORY; PAGE UP AND PAGE DOWN LOOK ON")
        if self.writing:
            return tr("TYPE THE REMARK; RETURN KEEPS IT, ESC LEAVES IT AS IT WAS; F-KEYS STILL WORK")
        standing = offset_changes.standing(snapshot)
        return standing or tr(
            "ARROWS CHOOSE A CELL; TYPE A VALUE OR A SUM; RETURN SETS IT, F2 ADDS IT TO WHAT IS THERE"
        )

    def barred(self, snapshot: Snapshot) -> str:
        """Why the cell under the cursor may not be changed now; empty when it may."""
        if self.relative and self.name in {"x", "z"}:
            return tr("X AND Z ARE SHOWN FROM THE MASTER: PRESS F3, THEN TYPE THEM FROM HOME")
        return self.book.locked or offset_changes.refusal(
            snapshot, correction=self.name in offset_changes.CORRECTIONS
        )

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: an entry in another unit is given up, or one of X where X has changed.

        Wear is a diameter whatever the control's X is, which every part changes as it begins.
        """
        before = self.ledger.mode
        self.ledger.look(snapshot)
        now = self.ledger.mode
        position = self.name not in offset_changes.CORRECTIONS or bool(self.cells.new.number)
        changed = now != before if position else now.metric != before.metric
        if changed and (self.text or self.cells.new.number):
            self._drop()
            self.desk.say(
                tr("THE CONTROL HAS CHANGED ITS UNIT OR ITS X: NOTHING WAS CHANGED, ENTER IT AGAIN")
            )

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Whether a character goes to the entry."""
        return self.writing or key in CHARACTERS

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if key == "Enter":
            self._enter()
        elif key in {"Page up", "Page down"}:
            self._go(self.number + (PAGE if key == "Page down" else -PAGE), self.column)
        elif key in _MOVES:
            down, right = _MOVES[key]
            self._go(self.number + down, self.column + right)
        elif key == "Back":
            self.text = self.text[:-1]
        elif key == "Delete":
            self.text = ""
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

    def _add(self, key: str) -> None:
        if self.name == "remark" and not self.writing:
            self.desk.say(tr("PRESS RETURN TO WRITE A REMARK"))
            return
        if not self.text:
            self.desk.clear()
        if len(self.text) < (REMARK_LONGEST if self.writing else LONGEST):
            self.text += key

    def _go(self, number: int, column: int) -> None:
        """The cursor there; what was typed and not entered stays behind, and that is said."""
        if self.text or self.writing:
            self.desk.say(tr("PRESS RETURN TO SET IT, OR ESC TO LEAVE IT AS IT WAS"))
            return
        self.number = max(OFFSETS[0], min(OFFSETS[-1], number))
        self.column = max(0, min(len(COLUMNS) - 1, column))
        new = self.cells.new
        if new.number and self.number != new.number:
            self.desk.say(tr("T{number} IS NOT SET: X AND Z BELONG TOGETHER").format(number=new.number))
            self._drop()

    def _enter(self) -> None:
        if self.name == "master":
            self._master()
        elif self.name == "remark" and not self.writing:
            self._open()
        elif self.text.strip() or self.writing:
            self._store(adding=False)
        else:
            self._go(self.number, self.column + 1)

    def _open(self) -> None:
        why = self.barred(self.desk.snapshot())
        if why or self.tool is None:
            self.desk.say(why or self.cells.never(self.number))
            return
        self.writing, self.text = True, self.tool.remark

    def _master(self) -> None:
        self.ledger.answer(self.barred(self.desk.snapshot()) or self.cells.master(self.number))

    def _store(self, *, adding: bool) -> None:
        """Save the cell; of a new tool go on to what is missing."""
        why = self.barred(self.desk.snapshot())
        try:
            why = why or self.cells.save(self.number, self.name, self.text, adding=adding)
        except EntryError as error:
            why = tr("REFUSED: {why}").format(why=error)
        if why:
            self.desk.say(why)
            return
        self.text, self.writing = "", False
        if self.cells.new.number:
            self.column = COLUMNS.index(self.cells.new.missing)

    def undo(self) -> None:
        """Take the last change of the tools back."""
        why = self.book.locked or offset_changes.refusal(self.desk.snapshot(), correction=False)
        if not why:
            self._drop()
        self.ledger.undo(why)

    def turn_relative(self) -> None:
        """X and Z from home, or from the master."""
        if not self.relative and not self.book.master:
            self.desk.say(tr("NO TOOL IS THE MASTER: CHOOSE ONE IN ITS COLUMN WITH RETURN"))
            return
        self.relative = not self.relative

    def escape(self) -> bool:
        """Esc closes the history, takes an entry back; False when the page may be left."""
        if self.ledger.looking_back is not None:
            self.ledger.looking_back = None
        elif self.text or self.writing or self.cells.new.number:
            self._drop()
            self.desk.say(tr("T{number} IS AS IT WAS").format(number=self.number))
        else:
            return False
        return True

    def _drop(self) -> None:
        self.text, self.writing = "", False
        self.cells.new.drop()

    def leave(self) -> None:
        """The page goes: nothing stays half entered."""
        self._drop()
        self.desk.clear()
        self.ledger.looking_back = None
