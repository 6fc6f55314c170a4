"""History of the offsets: changes, past states, and undo that does not affect other rows."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping, Sequence

from core.message import Message
from core.store import row_sums
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import (
    LOGS,
    MOST_STEPS,
    TABLES,
    Changes,
    Log,
    Reason,
    apply,
    damaged_entry,
    select,
)
from core.store.store_errors import StoreError
from core.store.store_rows import Change, Kind, Row, ToolRow
from core.tool_edges import edge_name, tool_of


def undo(connection: sqlite3.Connection, reason: Reason, kind: Kind) -> tuple[Change, ...]:
    """Undo the latest step of a table that is not undone yet and return the resulting changes.

    Another call undoes the step before it. Raises StoreError if no step is left.
    """
    return _undo(connection, reason, TABLES[kind].log, kind)


def undo_any(connection: sqlite3.Connection, reason: Reason) -> tuple[Change, ...]:
    """Undo the latest step of all tables and return the resulting changes.

    A step that changed several tables is undone in all of them. Another call undoes the step before it.
    Raises StoreError if no step is left.
    """
    last = {log: _last_step(connection, log, None) or 0 for log in LOGS}
    order = {log: step if isinstance(step, int) else MOST_STEPS for log, step in last.items()}
    newest = max(order.values())
    logs = [log for log in LOGS if order[log] == newest] if newest else LOGS[:1]
    return tuple(change for log in logs for change in _undo(connection, reason, log, None))


def _last_step(
    connection: sqlite3.Connection, log: Log, kind: Kind | None, number: int | None = None
) -> int | None:
    """Return the latest step that is not undone yet, or None.

    ``number`` limits the search to the steps that changed this row.
    """
    step: int | None
    (step,) = connection.execute(
        f"SELECT max(step) FROM {log.name}"
        f" WHERE undoes IS NULL AND {log.kind} = coalesce(?, {log.kind})"
        f" AND {log.key} = coalesce(?, {log.key})"
        f" AND step NOT IN (SELECT undoes FROM {log.name} WHERE undoes IS NOT NULL)",
        (kind.value if kind else None, number),
    ).fetchone()
    return step


def _undo(connection: sqlite3.Connection, reason: Reason, log: Log, kind: Kind | None) -> tuple[Change, ...]:
    rows = _step_to_undo(connection, log, kind)
    if not rows:
        raise StoreError(log.nothing_left, "nothing-to-undo")
    return apply(connection, rows[0].kind, backward(rows), reason, undoes=rows[0].step)


def _step_to_undo(
    connection: sqlite3.Connection, log: Log, kind: Kind | None, number: int | None = None
) -> tuple[Change, ...]:
    step = _last_step(connection, log, kind, number)
    rows = select(connection, log, "WHERE step = ? ORDER BY id", (step,)) if step is not None else ()
    first = rows[0].id if rows else 0
    # damage in this step, or in a later step that is hidden by the damage
    for entry in row_sums.broken(connection, log.name, first):
        raise damaged_entry(entry)
    return rows


def backward(rows: Sequence[Change]) -> Changes:
    """Return the opposite of these changes: from the new values to the old values."""
    return {row.number: (row.new, row.old) for row in rows}


def undoable(connection: sqlite3.Connection, kind: Kind, number: int | None) -> tuple[Change, ...]:
    """Return the changes of the step that ``undo_step`` would undo; () if no step is left.

    ``number`` selects the latest step that changed this row; None selects the latest step of the table.
    """
    return _step_to_undo(connection, TABLES[kind].log, kind, number)


def history(connection: sqlite3.Connection, kind: Kind, limit: int) -> tuple[Change, ...]:
    """Return the latest changes of a table, newest first."""
    log = TABLES[kind].log
    return select(connection, log, f"WHERE {log.kind} = ? ORDER BY id DESC LIMIT ?", (kind.value, limit))


def history_any(connection: sqlite3.Connection, limit: int) -> tuple[Change, ...]:
    """Return the latest changes of all tables, newest first. A negative ``limit`` returns all changes."""
    tail = "ORDER BY id DESC LIMIT ?"
    found = [each for log in LOGS for each in select(connection, log, tail, (limit,))]
    return tuple(sorted(found, key=lambda each: each.step, reverse=True)[: limit if limit >= 0 else None])


def as_of(connection: sqlite3.Connection, kind: Kind, moment: str) -> dict[int, Row]:
    """Return the offsets of a table as they were at ``moment`` (UTC), by number."""
    log = TABLES[kind].log
    changes = select(connection, log, f"WHERE {log.kind} = ? AND at <= ? ORDER BY id", (kind.value, moment))
    rows = {each.number: each.new for each in changes}
    return {number: row for number, row in rows.items() if row is not None}


def undo_step(
    connection: sqlite3.Connection, reason: Reason, kind: Kind, number: int | None, step: int
) -> tuple[Change, ...]:
    """Undo exactly this step and return the resulting changes.

    Raises StoreError if a later step has changed the row, or if another row of the step has changed since.
    """
    rows, now = undoable(connection, kind, number), offset_tables.current(connection, kind)
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
    return offset_tables.apply(connection, kind, backward(rows), reason, undoes=step)


def _check(kind: Kind, rows: Mapping[int, Row]) -> None:
    """Raise StoreError if the table would have two master tools, or a cutting edge without its tool."""
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
