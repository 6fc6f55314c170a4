"""Tool and secondary offsets: what is valid now, and every change that made it so."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from core.store.offset_fields import FIELDS, Field, Sort
from core.store.store_errors import StoreError
from core.store.store_rows import OFFSETS, Change, Kind, Row, SecondaryRow, ToolRow, Value, inches, utc_now

Changes = Mapping[int, tuple[Row | None, Row | None]]
_TABLE = {Kind.TOOL: "tool_offsets", Kind.SECONDARY: "secondary_offsets"}
_LETTER = {Kind.TOOL: "T", Kind.SECONDARY: "D"}
_COLUMNS = {kind: [field.column for field in fields.values()] for kind, fields in FIELDS.items()}


class Reason(NamedTuple):
    """Why an offset is changed and by whom."""

    why: str
    who: str


def current(connection: sqlite3.Connection, kind: Kind) -> dict[int, Row]:
    """All offsets of one table by number."""
    rows = connection.execute(
        f"SELECT number, {', '.join(_COLUMNS[kind])} FROM {_TABLE[kind]} ORDER BY number"
    )
    return {number: _row(kind, values) for number, *values in rows}


def tools(connection: sqlite3.Connection) -> dict[int, ToolRow]:
    """The tool offsets that have been set."""
    return {n: row for n, row in current(connection, Kind.TOOL).items() if isinstance(row, ToolRow)}


def secondary(connection: sqlite3.Connection) -> dict[int, SecondaryRow]:
    """The secondary offsets that have been set."""
    return {n: row for n, row in current(connection, Kind.SECONDARY).items() if isinstance(row, SecondaryRow)}


def change(
    connection: sqlite3.Connection, kind: Kind, number: int, reason: Reason, wanted: Mapping[str, Value]
) -> Row:
    """Sets the fields that ``wanted`` names and keeps the rest; answers the new offset.

    A tool that becomes the master takes that from the one before. Raises StoreError for what cannot be kept.
    """
    check_number(kind, number)
    rows = current(connection, kind)
    old = rows.get(number)
    if old is None and wanted.get("master") and not {"x", "z"} <= wanted.keys():
        raise StoreError(never_set(number))
    new = changed(kind, number, old, wanted)
    if new != old:
        changes: dict[int, tuple[Row | None, Row | None]] = {number: (old, new)}
        if isinstance(new, ToolRow) and new.master:
            changes |= {n: (row, row._replace(master=False)) for n, row in _other_masters(rows, number)}
        apply(connection, kind, changes, reason)
    return new


def _other_masters(rows: Mapping[int, Row], number: int) -> list[tuple[int, ToolRow]]:
    return [(n, row) for n, row in rows.items() if n != number and isinstance(row, ToolRow) and row.master]


def never_set(number: int) -> str:
    """Why a tool cannot be the master."""
    return f"T{number} was never set, so nothing can be relative to it; touch it off first"


def check_number(kind: Kind, number: int) -> None:
    """Raises StoreError for an offset that does not exist."""
    if number not in OFFSETS:
        raise StoreError(f"{_LETTER[kind]}{number} does not exist; offsets are {_LETTER[kind]}1…32")


def changed(kind: Kind, number: int, old: Row | None, wanted: Mapping[str, Value]) -> Row:
    """The row with the fields of ``wanted``. Raises StoreError for a value that is not kept."""
    for name, value in wanted.items():
        field = FIELDS[kind][name]
        if not field.takes(value):
            told = f"{_LETTER[kind]}{number} {field.word} {_told(field, value)}"
            raise StoreError(f"{told} is out of range; enter {field.range}")
    before = old or (ToolRow() if kind is Kind.TOOL else SecondaryRow())
    return _row(kind, [wanted.get(name, getattr(before, name)) for name in FIELDS[kind]])


def _told(field: Field, value: Value) -> str:
    if isinstance(value, str):
        return repr(value)
    return f"{inches(value):g} in" if field.sort is Sort.LENGTH else f"{value:g}"


def _row(kind: Kind, values: Sequence[Value | None]) -> Row:
    """A row from its columns; those that were not kept yet when it was written are as they were then."""
    whole = [_plain(field, value) for field, value in zip(FIELDS[kind].values(), values, strict=True)]
    return ToolRow(*whole) if kind is Kind.TOOL else SecondaryRow(*whole)  # type: ignore[arg-type]


def _plain(field: Field, value: Value | None) -> Value:
    if field.sort is Sort.TEXT:
        return str(value or "")
    if field.sort is Sort.FLAG:
        return bool(value)
    return int(value or 0) if field.sort is Sort.WHOLE else float(value or 0.0)


def clear(connection: sqlite3.Connection, kind: Kind, reason: Reason) -> int:
    """Removes every offset of a table as one step; answers how many there were."""
    rows = current(connection, kind)
    if rows:
        apply(connection, kind, {number: (old, None) for number, old in rows.items()}, reason)
    return len(rows)


def apply(
    connection: sqlite3.Connection, kind: Kind, changes: Changes, reason: Reason, undoes: int | None = None
) -> int:
    """Writes offsets and their history as one step; answers the step's number."""
    step = int(connection.execute("SELECT coalesce(max(step), 0) + 1 FROM offset_changes").fetchone()[0])
    at, columns = utc_now(), _COLUMNS[kind]
    # All go before any comes: there is never more than one master.
    connection.executemany(f"DELETE FROM {_TABLE[kind]} WHERE number = ?", [(number,) for number in changes])
    _insert(
        connection,
        _TABLE[kind],
        ["number", *columns],
        [(number, *new) for number, (_old, new) in changes.items() if new is not None],
    )
    sides = [f"{side}_{column}" for side in ("old", "new") for column in columns]
    nothing = (None,) * len(columns)
    _insert(
        connection,
        "offset_changes",
        ["step", "undoes", "at", "kind", "number", "why", "who", *sides],
        [
            (step, undoes, at, kind.value, number, *reason, *(old or nothing), *(new or nothing))
            for number, (old, new) in changes.items()
        ],
    )
    return step


def _insert(
    connection: sqlite3.Connection, table: str, columns: list[str], rows: list[tuple[object, ...]]
) -> None:
    marks = ", ".join("?" * len(columns))
    connection.executemany(f"INSERT INTO {table} ({', '.join(columns)}) VALUES ({marks})", rows)


def undo(connection: sqlite3.Connection, reason: Reason, kind: Kind | None = None) -> tuple[Change, ...]:
    """Takes the last step back that is not undone yet; answers the changes this made.

    With ``kind`` the last step of that table. Undoing is itself a step of the history; asking again goes
    further back. Raises StoreError when there is nothing left to undo.
    """
    step = connection.execute(
        "SELECT max(step) FROM offset_changes WHERE undoes IS NULL AND kind = coalesce(?, kind)"
        " AND step NOT IN (SELECT undoes FROM offset_changes WHERE undoes IS NOT NULL)",
        (kind.value if kind else None,),
    ).fetchone()[0]
    if step is None:
        raise StoreError("there is no offset change to undo")
    rows = step_of(connection, step)
    backward = {row.number: (row.new, row.old) for row in rows}
    done = apply(connection, rows[0].kind, backward, reason, undoes=step)
    return step_of(connection, done)


def step_of(connection: sqlite3.Connection, step: int) -> tuple[Change, ...]:
    """The changes of one step."""
    return _select(connection, "WHERE step = ? ORDER BY id", (step,))


def history(connection: sqlite3.Connection, kind: Kind | None, limit: int) -> tuple[Change, ...]:
    """The last changes, newest first."""
    if kind is None:
        return _select(connection, "ORDER BY id DESC LIMIT ?", (limit,))
    return _select(connection, "WHERE kind = ? ORDER BY id DESC LIMIT ?", (kind.value, limit))


def _select(connection: sqlite3.Connection, tail: str, values: tuple[int | str, ...]) -> tuple[Change, ...]:
    columns = _COLUMNS[Kind.TOOL]
    sides = ", ".join(f"{side}_{column}" for side in ("old", "new") for column in columns)
    rows = connection.execute(
        f"SELECT id, step, undoes, at, kind, number, why, who, {sides} FROM offset_changes {tail}", values
    )
    return tuple(
        Change(
            i, step, undoes, at, Kind(kind), number, _side(kind, old), _side(kind, both[len(old) :]), why, who
        )
        for i, step, undoes, at, kind, number, why, who, *both in rows
        for old in (both[: len(columns)],)
    )


def _side(kind: str, values: list[Value | None]) -> Row | None:
    """A row of the history; the columns of a secondary offset are the first of those of a tool."""
    if values[0] is None:
        return None
    return _row(Kind(kind), values[: len(FIELDS[Kind(kind)])])
