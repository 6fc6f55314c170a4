"""The history of the offsets: changes, earlier states, and an undo of one step.

The undo changes only the rows that the step has changed.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping, Sequence

from core.message import Message
from core.store import row_checksums
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import (
    HISTORY_TABLES,
    MAX_STEP_NUMBER,
    OFFSET_TABLES,
    ChangeReason,
    ChangesByNumber,
    HistoryTable,
    apply_changes,
    make_damaged_entry_error,
    select_changes,
)
from core.store.store_errors import StoreError
from core.store.store_rows import OffsetChange, OffsetKind, OffsetRow, ToolOffsetRow
from core.tool_edges import format_edge_name, get_tool_number


def undo(connection: sqlite3.Connection, reason: ChangeReason, kind: OffsetKind) -> tuple[OffsetChange, ...]:
    """Undo the latest step of a table that is not undone yet, and return the resulting changes.

    Calling the function again undoes the previous step. Raises StoreError if no step remains, or if a
    history entry of this step or of a later step is damaged.
    """
    return _undo(connection, reason, OFFSET_TABLES[kind].history_table, kind)


def undo_last_step_in_store(connection: sqlite3.Connection, reason: ChangeReason) -> tuple[OffsetChange, ...]:
    """Undo the latest step of all tables, and return the resulting changes.

    A step that changed several tables is undone in all of them. Calling the function again undoes the
    previous step. Raises StoreError if no step remains, or if a history entry of this step or of a later
    step is damaged.
    """
    last = {log: _last_step(connection, log, None) or 0 for log in HISTORY_TABLES}
    order = {log: step if isinstance(step, int) else MAX_STEP_NUMBER for log, step in last.items()}
    newest = max(order.values())
    logs = [log for log in HISTORY_TABLES if order[log] == newest] if newest else HISTORY_TABLES[:1]
    return tuple(change for log in logs for change in _undo(connection, reason, log, None))


def _last_step(
    connection: sqlite3.Connection, log: HistoryTable, kind: OffsetKind | None, number: int | None = None
) -> int | None:
    """Return the number of the latest step that is not undone yet, or None if no step remains.

    ``number`` limits the search to the steps that changed this row.
    """
    step: int | None
    (step,) = connection.execute(
        f"SELECT max(step) FROM {log.name}"
        f" WHERE undoes IS NULL AND {log.kind_sql_expression} = coalesce(?, {log.kind_sql_expression})"
        f" AND {log.key_column} = coalesce(?, {log.key_column})"
        f" AND step NOT IN (SELECT undoes FROM {log.name} WHERE undoes IS NOT NULL)",
        (kind.value if kind else None, number),
    ).fetchone()
    return step


def _undo(
    connection: sqlite3.Connection, reason: ChangeReason, log: HistoryTable, kind: OffsetKind | None
) -> tuple[OffsetChange, ...]:
    rows = _step_to_undo(connection, log, kind)
    if not rows:
        raise StoreError(log.nothing_to_undo_message, "nothing-to-undo")
    return apply_changes(connection, rows[0].kind, invert_changes(rows), reason, undone_step=rows[0].step)


def _step_to_undo(
    connection: sqlite3.Connection, log: HistoryTable, kind: OffsetKind | None, number: int | None = None
) -> tuple[OffsetChange, ...]:
    step = _last_step(connection, log, kind, number)
    rows = select_changes(connection, log, "WHERE step = ? ORDER BY id", (step,)) if step is not None else ()
    first = rows[0].id if rows else 0
    # damage in this step, or in a later step that is hidden by the damage
    for entry in row_checksums.find_broken_rows(connection, log.name, first):
        raise make_damaged_entry_error(entry)
    return rows


def invert_changes(rows: Sequence[OffsetChange]) -> ChangesByNumber:
    """Return the changes that undo the given changes, from the new values back to the old values."""
    return {row.number: (row.new, row.old) for row in rows}


def find_undoable_changes(
    connection: sqlite3.Connection, kind: OffsetKind, number: int | None
) -> tuple[OffsetChange, ...]:
    """Return the changes of the step that ``undo_given_step`` would undo, or () if no step remains.

    ``number`` selects the latest step that changed this row. If it is None, the latest step of the table is
    selected.
    """
    return _step_to_undo(connection, OFFSET_TABLES[kind].history_table, kind, number)


def history(connection: sqlite3.Connection, kind: OffsetKind, limit: int) -> tuple[OffsetChange, ...]:
    """Return the latest changes of a table, newest first."""
    log = OFFSET_TABLES[kind].history_table
    return select_changes(
        connection, log, f"WHERE {log.kind_sql_expression} = ? ORDER BY id DESC LIMIT ?", (kind.value, limit)
    )


def read_store_history(connection: sqlite3.Connection, limit: int) -> tuple[OffsetChange, ...]:
    """Return the latest changes of all tables, newest first.

    If ``limit`` is negative, all changes are returned.
    """
    tail = "ORDER BY id DESC LIMIT ?"
    found = [each for log in HISTORY_TABLES for each in select_changes(connection, log, tail, (limit,))]
    return tuple(sorted(found, key=lambda each: each.step, reverse=True)[: limit if limit >= 0 else None])


def read_rows_at(connection: sqlite3.Connection, kind: OffsetKind, moment: str) -> dict[int, OffsetRow]:
    """Return the offsets of a table as they were at ``moment`` (UTC), by number."""
    log = OFFSET_TABLES[kind].history_table
    changes = select_changes(
        connection, log, f"WHERE {log.kind_sql_expression} = ? AND at <= ? ORDER BY id", (kind.value, moment)
    )
    rows = {each.number: each.new for each in changes}
    return {number: row for number, row in rows.items() if row is not None}


def undo_given_step(
    connection: sqlite3.Connection, reason: ChangeReason, kind: OffsetKind, number: int | None, step: int
) -> tuple[OffsetChange, ...]:
    """Undo the step ``step`` and no other step, and return the resulting changes.

    Raises StoreError if ``step`` is not the latest step that can be undone for the row ``number``, or for
    the table if ``number`` is None. Also raises StoreError if a row of the step has changed since, if the
    history is damaged, or if the table would have two master tools or a cutting edge without its tool.
    """
    rows, now = (
        find_undoable_changes(connection, kind, number),
        offset_tables.read_current_rows(connection, kind),
    )
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
    return offset_tables.apply_changes(connection, kind, invert_changes(rows), reason, undone_step=step)


def _check(kind: OffsetKind, rows: Mapping[int, OffsetRow]) -> None:
    """Raise StoreError if the table would have two master tools, or a cutting edge without its tool."""
    if kind is not OffsetKind.TOOL:
        return
    masters = [
        format_edge_name(n) for n, row in rows.items() if isinstance(row, ToolOffsetRow) and row.master
    ]
    if len(masters) > 1:
        raise StoreError(
            Message(
                "{masters} would both be master tools; clear the current master first",
                masters=" and ".join(masters),
            ),
            "two-masters",
        )
    if orphans := [format_edge_name(n) for n in rows if get_tool_number(n) not in rows]:
        raise StoreError(
            Message(
                "cutting edge {orphans} would be left without a tool; clear this cutting edge first",
                orphans=", ".join(orphans),
            ),
            "has-further-edges",
        )
