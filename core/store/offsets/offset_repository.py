"""The offset tables of an open store, and their history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Generic

from core.store.offsets import offset_history, offset_tables, touch_off
from core.store.offsets.offset_tables import ChangeReason
from core.store.offsets.touch_off import TouchPosition
from core.store.store_access import StoreAccess
from core.store.store_rows import (
    FieldValue,
    MillToolRow,
    OffsetChange,
    OffsetKind,
    OffsetRow,
    PresetRow,
    RowT,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
)

if TYPE_CHECKING:
    from concurrent.futures import Future


class OffsetTable(Generic[RowT]):
    """One table of offsets in mm and degrees, with X as a radius.

    The rows are identified by number. The reason and the author of a change are stored in the history.
    Methods raise StoreError as described in ``StoreAccess``. The future of a change also raises StoreError
    if a number or value is out of range.
    """

    def __init__(self, store: StoreAccess, kind: OffsetKind, row: type[RowT]) -> None:
        self._store, self._kind, self._row = store, kind, row

    def read_rows(self) -> dict[int, RowT]:
        """Return the rows that have been set, by number. Damaged rows are omitted."""
        return self._store.run_query(offset_tables.read_typed_rows, self._kind, self._row)

    def read_rows_at(self, moment: str) -> dict[int, RowT]:
        """Return the rows as they were at ``moment``, by number.

        ``moment`` is a UTC time as in the history.
        """
        rows = self._store.run_query(offset_history.read_rows_at, self._kind, moment)
        return {number: row for number, row in rows.items() if isinstance(row, self._row)}

    def change_row(
        self, number: int, why: str, values: Mapping[str, FieldValue], *, who: str = "operator"
    ) -> Future[OffsetRow]:
        """Set the fields that ``values`` contains by name, and leave the other fields unchanged.

        The result is the new row.
        """
        reason, wanted = ChangeReason(why, who), dict(values)
        return self._store.write(lambda c: offset_tables.change_row(c, self._kind, number, reason, wanted))

    def remove_row(self, number: int, reason: str, *, author: str = "operator") -> Future[bool]:
        """Remove a row.

        The future returns True if the row existed.
        """
        return self._store.write(
            lambda c: offset_tables.remove_row(c, self._kind, number, ChangeReason(reason, author))
        )

    def remove_all_rows(self, reason: str, *, author: str = "operator") -> Future[int]:
        """Remove all rows as one step of the history.

        The result is the number of removed rows.
        """
        return self._store.write(lambda c: offset_tables.clear(c, self._kind, ChangeReason(reason, author)))

    def read_history(self, limit: int = 100) -> tuple[OffsetChange, ...]:
        """Return the latest changes of this table, newest first."""
        return self._store.run_query(offset_history.history, self._kind, limit)

    def find_undoable_changes(self, number: int | None = None) -> tuple[OffsetChange, ...]:
        """Return the changes that ``undo_step`` would undo, or () if no step remains.

        The changes are those of the latest step that changed the row ``number``. None selects the latest
        step of the table.
        """
        return self._store.run_query(offset_history.find_undoable_changes, self._kind, number)

    def undo_last_step(self, why: str = "undo", *, who: str = "operator") -> Future[tuple[OffsetChange, ...]]:
        """Undo the latest step of this table.

        Calling the function again undoes the previous step. The future returns the changes that were made,
        and raises StoreError if no step remains.
        """
        return self._store.write(lambda c: offset_history.undo(c, ChangeReason(why, who), self._kind))

    def undo_step(
        self, number: int | None, step: int, reason_text: str = "undo", *, author: str = "operator"
    ) -> Future[tuple[OffsetChange, ...]]:
        """Undo the step ``step``, as returned by ``find_undoable_changes``, and no other step.

        The result contains the changes that were made. The future raises StoreError if the rows of the step
        have changed since.
        """
        reason = ChangeReason(reason_text, author)
        return self._store.write(
            lambda c: offset_history.undo_given_step(c, reason, self._kind, number, step)
        )


class ToolOffsetTable(OffsetTable[ToolOffsetRow]):
    """The tool offsets of a lathe; one of the tools may be the master tool."""

    def __init__(self, store: StoreAccess) -> None:
        super().__init__(store, OffsetKind.TOOL, ToolOffsetRow)

    def set_touched_offset(
        self, number: int, touch: TouchPosition, reason: str, *, author: str = "operator"
    ) -> Future[tuple[OffsetChange, ...]]:
        """Set the offset of a tool to the position at which the tool touched part zero.

        If the tool is the master tool, all other tools move with it. The result contains the changes that
        were made.
        """
        return self._store.write(
            lambda c: touch_off.store_touch_off(c, number, touch, ChangeReason(reason, author))
        )

    def set_master_tool(
        self, number: int, reason: str, *, author: str = "operator"
    ) -> Future[tuple[OffsetChange, ...]]:
        """Make a tool the master tool, to which the other tools are relative; 0 clears the master tool.

        The positions of the tool tips do not change. The result contains the changes that were made.
        """
        return self._store.write(lambda c: touch_off.set_master_tool(c, number, ChangeReason(reason, author)))


class OffsetTables:
    """All offset tables of an open store. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess) -> None:
        self._store = store
        self.tool_offsets = ToolOffsetTable(store)
        self.secondary_offsets = OffsetTable(store, OffsetKind.SECONDARY, SecondaryOffsetRow)
        self.zero_offsets = OffsetTable(store, OffsetKind.ZERO, ZeroOffsetRow)
        self.tool_shapes = OffsetTable(store, OffsetKind.SHAPE, ToolShapeRow)
        self.mill_tools = OffsetTable(store, OffsetKind.MILL_TOOL, MillToolRow)
        self.presets = OffsetTable(store, OffsetKind.PRESET, PresetRow)

    def get_table(self, kind: OffsetKind) -> OffsetTable[OffsetRow]:
        """Return the table of this kind, for callers that do not need the type of its rows."""
        return OffsetTable(self._store, kind, offset_tables.OFFSET_TABLES[kind].row_type)

    def read_history(self, limit: int = 100) -> tuple[OffsetChange, ...]:
        """Return the latest changes of all tables, newest first."""
        return self._store.run_query(offset_history.read_store_history, limit)

    def undo_last_step(
        self, reason: str = "undo", *, author: str = "operator"
    ) -> Future[tuple[OffsetChange, ...]]:
        """Undo the latest step of all tables.

        Calling the function again undoes the previous step. The future returns the changes that were made,
        and raises StoreError if no step remains.
        """
        return self._store.write(
            lambda c: offset_history.undo_last_step_in_store(c, ChangeReason(reason, author))
        )
