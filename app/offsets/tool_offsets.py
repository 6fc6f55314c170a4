"""The model of the tool offsets (F8), a table of 32 tools that the operator edits cell by cell."""

from __future__ import annotations

from app.desk.arithmetic import InvalidEntryError
from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.change_rules import CORRECTION_FIELDS
from app.offsets.offset_changes import describe_effective_time
from app.offsets.offset_table import ProposedOffsets, ToolFieldEditor, ToolFieldTable
from app.offsets.offset_values import (
    describe_missing_offset,
    format_value,
    parse_field_value,
)
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import OFFSET_NUMBERS, OffsetKind, replace_fields
from core.tool_edges import EDGE_NUMBERS, format_edge_suffix, get_tool_number, make_edge_row_number

TABLE_COLUMNS = ("x", "z", "nose_radius", "quadrant", "wear_x", "wear_z", "master", "remark")
CUTTING_EDGE_KEY = "D"  # Adds a cutting edge to the tool, in a language with cutting edges.
_CURSOR_MOVES = {"Up": (-1, 0), "Down": (1, 0), "Left": (0, -1), "Right": (0, 1), "Tab": (0, 1)}


class ToolOffsetTable(ToolFieldTable):
    """Table of tool offsets, with its cursor and the entered text.

    A cell with a remark accepts letters after the operator opens it with Enter.
    """

    kind = OffsetKind.TOOL
    open_text_hint = "PRESS ENTER TO TYPE A REMARK"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.page_key = CUTTING_EDGE_KEY if desk.machine.program_language == "sinumerik" else ""
        self.tool_fields = ToolFieldEditor(self.offset_history)
        self.column_index = 0
        self.is_relative = False  # X and Z are shown relative to the master.
        self.new_edge = 0  # A new cutting edge whose values are not entered yet.

    # --- display -------------------------------------------------------------------------------------

    @property
    def row_numbers(self) -> tuple[int, ...]:
        """Return the row numbers of the table: each tool, followed by its additional cutting edges."""
        edges = sorted(
            {
                key
                for key in (*self.offset_book.tool_offsets, self.new_edge)
                if key not in OFFSET_NUMBERS and key
            }
        )
        return tuple(
            key
            for tool in OFFSET_NUMBERS
            for key in (tool, *(each for each in edges if get_tool_number(each) == tool))
        )

    @property
    def row_index(self) -> int:
        """Return the index of the cursor's row, counted from 0."""
        rows = self.row_numbers
        return rows.index(self.tool_number if self.tool_number in rows else get_tool_number(self.tool_number))

    @property
    def name(self) -> str:
        """Return the name of the field under the cursor."""
        return TABLE_COLUMNS[self.column_index]

    def format_cell(self, number: int, name: str) -> str:
        """Return a cell of the table as text.

        X and Z are relative to the master tool if the operator has selected that display.
        """
        book, mode, new = self.offset_book, self.unit_mode, self.tool_fields.incomplete_tool
        row = book.tool_offsets.get(number)
        if row is None:
            known = number == new.tool_number and name in new.known_values
            return format_value(name, new.known_values[name], mode) if known else ""
        master = book.tool_offsets.get(book.master_tool_number)
        if (
            self.is_relative
            and master is not None
            and name in {"x", "z"}
            and number != book.master_tool_number
        ):
            at = "xz".index(name)
            return format_value(name, row.offset[at] - master.offset[at], mode)
        return format_value(name, getattr(row, name), mode)

    @property
    def is_editing_text(self) -> bool:
        """Return whether a remark is being edited."""
        return self.is_text_open

    @property
    def stored_value_text(self) -> str:
        """Return the saved value of the cell as text."""
        return self.format_cell(self.tool_number, self.name) or (
            describe_missing_offset(is_unreadable=self.offset_book.has_read_failed)
            if self.tool_row is None
            else ""
        )

    @property
    def footer_text(self) -> str:
        """Return the hint about the keys F2, F3 and Esc."""
        if self.page_key:
            return tr(
                "F2: add typed value   F3: X and Z relative to master   F8: shape   D: other edge   Esc: exit"
            )
        return tr("F2: add typed value   F3: X and Z relative to master   F8: tool shape   Esc: exit")

    def make_hint(self, snapshot: Snapshot) -> str:
        """Return how to enter a remark or a value, or when a change takes effect."""
        if self.is_text_open:
            return tr("TYPE A REMARK. ENTER: SAVE   ESC: CANCEL   F-KEYS STILL WORK")
        return describe_effective_time(snapshot) or tr("TYPE A NUMBER OR EXPRESSION   ENTER: SET   F2: ADD")

    def make_proposed_offsets(self) -> ProposedOffsets:
        """Return all tool offsets with the current entry applied."""
        tools, secondary = super().make_proposed_offsets()
        if self.tool_row is None or not self.text:
            return tools, secondary
        try:
            value = parse_field_value(self.name, self.text, self.unit_mode)
        except InvalidEntryError:
            return tools, secondary
        return {**tools, self.tool_number: replace_fields(self.tool_row, {self.name: value})}, secondary

    @property
    def is_correction(self) -> bool:
        """Return whether the selected field is a wear value or a remark.

        These fields may be changed while parts run.
        """
        return self.name in CORRECTION_FIELDS[OffsetKind.TOOL]

    def find_cell_refusal(self) -> str:
        """Return why the cell under the cursor cannot be changed now, or an empty string if it can."""
        if self.is_relative and self.name in {"x", "z"}:
            return tr("X, Z RELATIVE TO MASTER: READ-ONLY. F3: SHOW X, Z FROM HOME")
        return super().find_cell_refusal()

    def update(self, snapshot: Snapshot) -> None:
        """Read the unit and diameter mode of the control, and discard an entry that no longer fits them.

        This is called once a frame. A new unit discards every entry. A new diameter mode discards an entry
        of X or Z, but not of wear, because wear is always a diameter.
        """
        before = self.unit_mode
        super().update(snapshot)
        position = not self.is_correction or bool(self.tool_fields.incomplete_tool.tool_number)
        changed = self.unit_mode != before if position else self.unit_mode.is_metric != before.is_metric
        if changed and (self.text or self.tool_fields.incomplete_tool.tool_number):
            self.discard_entry()
            self.desk.say(tr("UNITS OR DIAMETER/RADIUS CHANGED. NOT SAVED. RE-ENTER VALUE"))

    # --- keys ----------------------------------------------------------------------------------------

    def handle_entry_key(self, key: str) -> bool:
        """Handle a key of the table.

        The arrow keys move the cursor, and Enter saves the entered value.
        """
        if key in _CURSOR_MOVES:
            self._step(*_CURSOR_MOVES[key])
        elif self.page_key and key.upper() == self.page_key and not self.is_text_open:
            self.add_cutting_edge()
        else:
            return super().handle_entry_key(key)
        return True

    def select_row(self, row: int) -> None:
        """Move the cursor to a row by its index, without a change of the column."""
        self._step(row - self.row_index, 0)

    def select_cell(self, number: int, column: int) -> None:
        """Select a touched cell.

        A second touch opens a remark for editing, or makes the tool the master tool.
        """
        again = (number, column) == (self.tool_number, self.column_index)
        self._select_cell(number, column)
        if again and self.name in {"remark", "master"} and not self.is_text_open:
            self.handle_enter()

    def add_entered_value(self) -> None:
        """Handle F2: add the entered value to the stored value of the cell."""
        if why := self.find_add_refusal():
            self.desk.say(why)
            return
        self._save_entry(is_increment=True)

    def find_add_refusal(self) -> str:
        """Return why F2 cannot add a value now, or an empty string if it can."""
        if self.tool_row is None or not self.text.strip():
            return tr("TYPE THE VALUE TO ADD, THEN PRESS F2")
        return ""

    def find_relative_display_refusal(self) -> str:
        """Return why X and Z relative to the master are not possible, or an empty string if they are."""
        if not self.is_relative and not self.offset_book.master_tool_number:
            return tr("NO MASTER TOOL. PRESS ENTER IN MASTER COLUMN TO CHOOSE ONE")
        return ""

    def toggle_relative_display(self) -> None:
        """Handle F3: show X and Z relative to the master tool, or relative to home again."""
        if why := self.find_relative_display_refusal():
            self.desk.say(why)
            return
        self.is_relative = not self.is_relative

    def _step(self, down: int, right: int) -> None:
        rows = self.row_numbers
        self._select_cell(rows[max(0, min(len(rows) - 1, self.row_index + down))], self.column_index + right)

    def add_cutting_edge(self) -> None:
        """Handle D: add a row for the next cutting edge of the selected tool.

        The new cutting edge is saved only when its X and Z have been entered.
        """
        tool = get_tool_number(self.tool_number)
        free = (
            make_edge_row_number(tool, edge)
            for edge in EDGE_NUMBERS
            if make_edge_row_number(tool, edge) not in self.offset_book.tool_offsets
        )
        key = next(free, 0)
        if self.is_entry_unfinished():
            return
        if tool not in self.offset_book.tool_offsets:
            self.desk.say(self.tool_fields.describe_unset_tool(tool))
        elif not key:
            self.desk.say(tr(Message("T{number} ALREADY HAS ALL CUTTING EDGES, D1 TO D9", number=tool)))
        else:
            self.new_edge = key
            self._select_cell(key, TABLE_COLUMNS.index("x"))
            self.desk.say(tr(Message("T{number}: TYPE X AND Z", number=format_edge_suffix(key))))

    def _select_cell(self, number: int, column: int) -> None:
        """Move the cursor, unless there is an unfinished entry.

        An incomplete new tool is discarded.
        """
        if self.is_entry_unfinished():
            return
        if self.new_edge not in {0, number} and self.tool_fields.incomplete_tool.tool_number != self.new_edge:
            self.new_edge = 0
        self.offset_book.at = number
        self.column_index = max(0, min(len(TABLE_COLUMNS) - 1, column))
        new = self.tool_fields.incomplete_tool
        if new.tool_number and self.tool_number != new.tool_number:
            self.desk.say(
                tr(
                    Message(
                        "T{number} IS NOT SET: ENTER BOTH X AND Z", number=format_edge_suffix(new.tool_number)
                    )
                )
            )
            self.discard_entry()

    def handle_enter(self) -> None:
        """Handle Enter: save the entry, set the master tool, open a remark, or go to the next cell."""
        if self.name == "master":
            self.offset_history.show_refusal(
                self.find_cell_refusal() or self.tool_fields.ask_to_toggle_master(self.tool_number)
            )
        elif self.name == "remark" and not self.is_text_open:
            self._open()
        elif self.text.strip() or self.is_text_open:
            self._save_entry(is_increment=False)
        else:
            self._select_cell(self.tool_number, self.column_index + 1)

    def _open(self) -> None:
        why = self.find_cell_refusal()
        if why or self.tool_row is None:
            self.desk.say(why or self.tool_fields.describe_unset_tool(self.tool_number))
            return
        self.is_text_open, self.text = True, self.tool_row.remark

    def _save_entry(self, *, is_increment: bool) -> None:
        """Save the entered value of the cell.

        For a new tool, then move the cursor to X or Z, whichever is missing.
        """
        saved = self.save_field(
            lambda: self.tool_fields.save_field(
                self.tool_number, self.name, self.text, is_increment=is_increment
            )
        )
        if saved and self.tool_fields.incomplete_tool.tool_number:
            self.column_index = TABLE_COLUMNS.index(self.tool_fields.incomplete_tool.missing_axis)

    @property
    def has_entry(self) -> bool:
        """Return whether Esc can discard an entry or an incomplete new tool."""
        return super().has_entry or bool(self.tool_fields.incomplete_tool.tool_number)

    def discard_entry(self) -> None:
        """Discard the entry, an open remark and an incomplete new tool."""
        super().discard_entry()
        self.tool_fields.incomplete_tool.discard_values()
