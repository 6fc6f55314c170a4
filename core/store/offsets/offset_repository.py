"""The offset tables of an open store, and their history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Generic

from core.store.offsets import offset_history, offset_tables, touch_off
from core.store.offsets.offset_tables import Reason
from core.store.offsets.touch_off import Touch
from core.store.store_access import StoreAccess
from core.store.store_rows import (
    Change,
    Kind,
    MillRow,
    PresetRow,
    Row,
    RowT,
    SecondaryRow,
    ShapeRow,
    ToolRow,
    Value,
    ZeroRow,
)

if TYPE_CHECKING:
    from concurrent.futures import Future


class OffsetTable(Generic[RowT]):
    """One table of offsets: rows by number, in mm and degrees, X as a radius.

    ``why`` and ``who`` of a change are stored in its history. Methods raise StoreError as described in
    ``StoreAccess``; the future of a change also raises it for a number or value out of range.
    """

    def __init__(self, store: StoreAccess, kind: Kind, row: type[RowT]) -> None:
        self._store, self._kind, self._row = store, kind, row

    def read_rows(self) -> dict[int, RowT]:
        """Return the rows that have been set, by number. Damaged rows are left out."""
        return self._store.query(offset_tables.rows_of, self._kind, self._row)

    def read_rows_at(self, moment: str) -> dict[int, RowT]:
        """Return the rows as they were set at ``moment``, a UTC time as in the history."""
        rows = self._store.query(offset_history.as_of, self._kind, moment)
        return {number: row for number, row in rows.items() if isinstance(row, self._row)}

    def change_row(
        self, number: int, why: str, values: Mapping[str, Value], *, who: str = "operator"
    ) -> Future[Row]:
        """Set the fields in ``values``, by name, and leave the others; the result is the new row."""
        reason, wanted = Reason(why, who), dict(values)
        return self._store.write(lambda c: offset_tables.change(c, self._kind, number, reason, wanted))

    def remove_row(self, number: int, why: str, *, who: str = "operator") -> Future[bool]:
        """Remove a row; the result is whether it was set."""
        return self._store.write(lambda c: offset_tables.remove(c, self._kind, number, Reason(why, who)))

    def remove_all_rows(self, why: str, *, who: str = "operator") -> Future[int]:
        """Remove all rows as one step of the history; the result is the number of rows removed."""
        return self._store.write(lambda c: offset_tables.clear(c, self._kind, Reason(why, who)))

    def read_history(self, limit: int = 100) -> tuple[Change, ...]:
        """Return the last changes of this table, newest first."""
        return self._store.query(offset_history.history, self._kind, limit)

    def find_undoable(self, number: int | None = None) -> tuple[Change, ...]:
        """Return the changes that ``undo_step`` would take back; () if there are none.

        They are the last step that changed the row ``number``; None: the last step of the table.
        """
        return self._store.query(offset_history.undoable, self._kind, number)

    def undo_last_step(self, why: str = "undo", *, who: str = "operator") -> Future[tuple[Change, ...]]:
        """Take the last step of this table back; calling it again takes the step before it back.

        The result is the changes made. The future raises StoreError if there is no step left.
        """
        return self._store.write(lambda c: offset_history.undo(c, Reason(why, who), self._kind))

    def undo_step(
        self, number: int | None, step: int, why: str = "undo", *, who: str = "operator"
    ) -> Future[tuple[Change, ...]]:
        """Take back exactly this step of ``find_undoable``; the result is the changes made.

        The future raises StoreError if the rows of the step have changed since.
        """
        reason = Reason(why, who)
        return self._store.write(lambda c: offset_history.undo_step(c, reason, self._kind, number, step))


class ToolTable(OffsetTable[ToolRow]):
    """The tool offsets of a lathe, one of which may be the master."""

    def __init__(self, store: StoreAccess) -> None:
        super().__init__(store, Kind.TOOL, ToolRow)

    def touch_off(
        self, number: int, touch: Touch, why: str, *, who: str = "operator"
    ) -> Future[tuple[Change, ...]]:
        """Set a tool to the position where it touched; all tools follow the master tool.

        The result is the changes made.
        """
        return self._store.write(lambda c: touch_off.touch_off(c, number, touch, Reason(why, who)))

    def choose_master(self, number: int, why: str, *, who: str = "operator") -> Future[tuple[Change, ...]]:
        """Make a tool the master that other tools are relative to; 0: no tool. Tool tips do not move.

        The result is the changes made.
        """
        return self._store.write(lambda c: touch_off.choose_master(c, number, Reason(why, who)))


class OffsetTables:
    """All offset tables of an open store. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess) -> None:
        self._store = store
        self.tools = ToolTable(store)
        self.secondary = OffsetTable(store, Kind.SECONDARY, SecondaryRow)
        self.zero = OffsetTable(store, Kind.ZERO, ZeroRow)
        self.shapes = OffsetTable(store, Kind.SHAPE, ShapeRow)
        self.mill_tools = OffsetTable(store, Kind.MILL_TOOL, MillRow)
        self.presets = OffsetTable(store, Kind.PRESET, PresetRow)

    def table(self, kind: Kind) -> OffsetTable[Row]:
        """Return the table of this kind, where the type of its rows does not matter."""
        return OffsetTable(self._store, kind, offset_tables.TABLES[kind].row)

    def read_history(self, limit: int = 100) -> tuple[Change, ...]:
        """Return the last changes of all tables, newest first."""
        return self._store.query(offset_history.history_any, limit)

    def undo_last_step(self, why: str = "undo", *, who: str = "operator") -> Future[tuple[Change, ...]]:
        """Take the last step of all tables back; calling it again takes the step before it back.

        The result is the changes made. The future raises StoreError if there is no step left.
        """
        return self._store.write(lambda c: offset_history.undo_any(c, Reason(why, who)))
