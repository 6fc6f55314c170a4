"""The model of the tool offsets (F8), a table of 32 tools that the operator edits cell by cell."""

from __future__ import annotations

from app.desk.arithmetic import EntryError
from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.change_rules import CORRECTIONS
from app.offsets.offset_changes import counts_from
from app.offsets.offset_table import Proposed, ToolEntry, ToolFields
from app.offsets.offset_values import (
    not_set,
    shown_value,
    value_typed,
)
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import OFFSETS, Kind, with_fields
from core.tool_edges import EDGES, edge_key, edge_number, tool_of

COLUMNS = ("x", "z", "nose_radius", "quadrant", "wear_x", "wear_z", "master", "remark")
PAGE = 5  # Rows that fit on the smallest screen, each as high as a fingertip.
EDGE_KEY = "D"  # Adds a cutting edge to the tool, in a language with cutting edges.
_MOVES = {"Up": (-1, 0), "Down": (1, 0), "Left": (0, -1), "Right": (0, 1), "Tab": (0, 1)}


class ToolOffsets(ToolEntry):
    """The table with its cursor and the entered text. A remark accepts letters after Enter has opened it."""

    kind = Kind.TOOL
    to_write = "PRESS ENTER TO TYPE A REMARK"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.own_key = EDGE_KEY if desk.machine.language == "sinumerik" else ""
        self.fields = ToolFields(self.history)
        self.column = 0
        self.page = PAGE  # Rows that fit now, by which Page up and Page down move.
        self.relative = False  # X and Z are shown relative to the master.
        self.opened_edge = 0  # A new cutting edge whose values are not entered yet.

    # --- display -------------------------------------------------------------------------------------

    @property
    def rows(self) -> tuple[int, ...]:
        """The rows of the table: every tool, followed by its further cutting edges."""
        edges = sorted({key for key in (*self.book.tools, self.opened_edge) if key not in OFFSETS and key})
        return tuple(
            key for tool in OFFSETS for key in (tool, *(each for each in edges if tool_of(each) == tool))
        )

    @property
    def row(self) -> int:
        """The index of the cursor's row, counted from 0."""
        rows = self.rows
        return rows.index(self.number if self.number in rows else tool_of(self.number))

    @property
    def name(self) -> str:
        """The field under the cursor."""
        return COLUMNS[self.column]

    def cell(self, number: int, name: str) -> str:
        """Return a cell of the table as text. X and Z are relative to the master if this is selected."""
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
    def is_writing(self) -> bool:
        """Whether a remark is being edited."""
        return self.writing

    @property
    def value_before(self) -> str:
        """The saved value of the cell as text."""
        return self.cell(self.number, self.name) or (
            not_set(unread=self.book.unread) if self.tool is None else ""
        )

    @property
    def foot(self) -> str:
        """The hint for the keys F2, F3 and Esc."""
        if self.own_key:
            return tr(
                "F2: add typed value   F3: X and Z relative to master   F8: shape   D: other edge   Esc: exit"
            )
        return tr("F2: add typed value   F3: X and Z relative to master   F8: tool shape   Esc: exit")

    def hint(self, snapshot: Snapshot) -> str:
        """Return how to enter a remark or a value, or from when a change applies."""
        if self.writing:
            return tr("TYPE A REMARK. ENTER: SAVE   ESC: CANCEL   F-KEYS STILL WORK")
        return counts_from(snapshot) or tr("TYPE A NUMBER OR EXPRESSION   ENTER: SET   F2: ADD")

    def proposed(self) -> Proposed:
        """Return the offsets as they would be with the entered text."""
        tools, secondary = super().proposed()
        if self.tool is None or not self.text:
            return tools, secondary
        try:
            value = value_typed(self.name, self.text, self.mode)
        except EntryError:
            return tools, secondary
        return {**tools, self.number: with_fields(self.tool, {self.name: value})}, secondary

    @property
    def corrects(self) -> bool:
        """Whether the field is wear or remark, which may change while parts run."""
        return self.name in CORRECTIONS[Kind.TOOL]

    def cell_barred(self) -> str:
        """Return why the cell under the cursor cannot be changed now. Empty if it can."""
        if self.relative and self.name in {"x", "z"}:
            return tr("X, Z RELATIVE TO MASTER: READ-ONLY. F3: SHOW X, Z FROM HOME")
        return super().cell_barred()

    def look(self, snapshot: Snapshot) -> None:
        """Update the unit of the control; called once a frame. A change of the unit discards the entry.

        An entry of X or Z is also discarded if the diameter mode changes. Wear is always a diameter.
        """
        before = self.mode
        super().look(snapshot)
        position = not self.corrects or bool(self.fields.new.number)
        changed = self.mode != before if position else self.mode.metric != before.metric
        if changed and (self.text or self.fields.new.number):
            self.drop()
            self.desk.say(tr("UNITS OR DIAMETER/RADIUS CHANGED. NOT SAVED. RE-ENTER VALUE"))

    # --- keys ----------------------------------------------------------------------------------------

    def enter_key(self, key: str) -> bool:
        """Handle a key of the table: arrow keys move the cursor, and Enter saves the entered value."""
        if key in {"Page up", "Page down"}:
            self._step(self.page if key == "Page down" else -self.page, 0)
        elif key in _MOVES:
            self._step(*_MOVES[key])
        elif self.own_key and key.upper() == self.own_key and not self.writing:
            self.open_edge()
        else:
            return super().enter_key(key)
        return True

    def choose(self, number: int, column: int) -> None:
        """Select a touched cell. A second touch opens a remark or sets the master."""
        again = (number, column) == (self.number, self.column)
        self._go(number, column)
        if again and self.name in {"remark", "master"} and not self.writing:
            self.enter()

    def add(self) -> None:
        """Handle F2: add the entered value to the present value."""
        if why := self.add_barred():
            self.desk.say(why)
            return
        self._save(adding=True)

    def add_barred(self) -> str:
        """Return why no value can be added now. Empty if it can."""
        if self.tool is None or not self.text.strip():
            return tr("TYPE THE VALUE TO ADD, THEN PRESS F2")
        return ""

    def relative_barred(self) -> str:
        """Return why X and Z cannot be shown relative to the master. Empty if they can."""
        if not self.relative and not self.book.master:
            return tr("NO MASTER TOOL. PRESS ENTER IN MASTER COLUMN TO CHOOSE ONE")
        return ""

    def turn_relative(self) -> None:
        """Handle F3: show X and Z from home, or relative to the master."""
        if why := self.relative_barred():
            self.desk.say(why)
            return
        self.relative = not self.relative

    def _step(self, down: int, right: int) -> None:
        rows = self.rows
        self._go(rows[max(0, min(len(rows) - 1, self.row + down))], self.column + right)

    def open_edge(self) -> None:
        """Handle D: add a row for the next cutting edge of this tool. Entering X and Z sets the edge."""
        tool = tool_of(self.number)
        free = (edge_key(tool, edge) for edge in EDGES if edge_key(tool, edge) not in self.book.tools)
        key = next(free, 0)
        if self.left_open():
            return
        if tool not in self.book.tools:
            self.desk.say(self.fields.never_set(tool))
        elif not key:
            self.desk.say(tr(Message("T{number} ALREADY HAS ALL CUTTING EDGES, D1 TO D9", number=tool)))
        else:
            self.opened_edge = key
            self._go(key, COLUMNS.index("x"))
            self.desk.say(tr(Message("T{number}: TYPE X AND Z", number=edge_number(key))))

    def _go(self, number: int, column: int) -> None:
        """Move the cursor, unless there is an unfinished entry. An incomplete new tool is discarded."""
        if self.left_open():
            return
        if self.opened_edge not in {0, number} and self.fields.new.number != self.opened_edge:
            self.opened_edge = 0
        self.book.at = number
        self.column = max(0, min(len(COLUMNS) - 1, column))
        new = self.fields.new
        if new.number and self.number != new.number:
            self.desk.say(
                tr(Message("T{number} IS NOT SET: ENTER BOTH X AND Z", number=edge_number(new.number)))
            )
            self.drop()

    def enter(self) -> None:
        """Handle Enter: save the entered value, choose the master, open a remark, or go to the next cell."""
        if self.name == "master":
            self.history.answer(self.cell_barred() or self.fields.master(self.number))
        elif self.name == "remark" and not self.writing:
            self._open()
        elif self.text.strip() or self.writing:
            self._save(adding=False)
        else:
            self._go(self.number, self.column + 1)

    def _open(self) -> None:
        why = self.cell_barred()
        if why or self.tool is None:
            self.desk.say(why or self.fields.never_set(self.number))
            return
        self.writing, self.text = True, self.tool.remark

    def _save(self, *, adding: bool) -> None:
        """Save the cell. For a new tool, move the cursor to the missing value."""
        saved = self.store(lambda: self.fields.save(self.number, self.name, self.text, adding=adding))
        if saved and self.fields.new.number:
            self.column = COLUMNS.index(self.fields.new.missing)

    @property
    def entering(self) -> bool:
        """Whether Esc can discard an entry or an incomplete new tool."""
        return super().entering or bool(self.fields.new.number)

    def drop(self) -> None:
        """Discard the entry, an open remark and an incomplete new tool."""
        super().drop()
        self.fields.new.drop()
