"""Undo of one step of the history of offsets, of a chosen row, without changing other rows unseen."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping

from core.message import Message
from core.store import offset_tables
from core.store.offset_tables import Reason
from core.store.store_errors import StoreError
from core.store.store_rows import Change, Kind, Row, ToolRow
from core.tool_edges import edge_name, tool_of


def undo_step(
    connection: sqlite3.Connection, reason: Reason, kind: Kind, number: int | None, step: int
) -> tuple[Change, ...]:
    """Take back exactly this step; return the changes that this made.

    Raises StoreError if it is no longer the last step of the row, or if a row of it has changed since.
    """
    rows, now = offset_tables.undoable(connection, kind, number), offset_tables.current(connection, kind)
    changed_since = [str(row.number) for row in rows if now.get(row.number) != row.new]
    if not rows or rows[0].step != step or changed_since:
        raise StoreError(
            Message(
                "offset {changed_since} was changed later; undo that change first",
                changed_since=", ".join(changed_since) or number or "",
            ),
            "changed-since",
        )
    after = {**now, **{row.number: row.old for row in rows}}
    _check(kind, {n: row for n, row in after.items() if row is not None})
    return offset_tables.apply(connection, kind, offset_tables.backward(rows), reason, undoes=step)


def _check(kind: Kind, rows: Mapping[int, Row]) -> None:
    """Raise StoreError if the table would have two masters, or a cutting edge without its tool."""
    if kind is not Kind.TOOL:
        return
    masters = [edge_name(n) for n, row in rows.items() if isinstance(row, ToolRow) and row.master]
    if len(masters) > 1:
        raise StoreError(
            Message(
                "{masters} would both be master tools; clear the current master first",
                masters=" and ".join(masters),
            ),
            "two-masters",
        )
    if orphans := [edge_name(n) for n in rows if tool_of(n) not in rows]:
        raise StoreError(
            Message(
                "cutting edge {orphans} would be left without a tool; clear this cutting edge first",
                orphans=", ".join(orphans),
            ),
            "has-further-edges",
        )
