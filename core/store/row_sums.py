"""A sum beside every offset, setting, count, life and job: a row that is not as it was saved is not believed.

Entries of the histories have one too, for an undo takes its figures from there, and so have events and
versions. A connection that writes makes the sums by triggers of its own, so no place that writes can forget
to. A reader compares.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from hashlib import sha256

Key = int | str
Value = int | float | str | bytes | None
Row = tuple[Value, ...]

KEYS = {
    "tool_offsets": "number",
    "secondary_offsets": "number",
    "zero_offsets": "code",
    "tool_shapes": "number",
    "mill_tools": "number",
    "datum_presets": "number",
    "tool_lives": "number",
    "mill_tool_lives": "number",
    "part_counts": "program",
    "settings": "key",
    "jobs": "id",
    "people": "name",
    "runs": "program",
    "part_features": "id",
}
"""What is looked through whenever a store is opened: tables, and the column that tells their rows apart."""

HISTORIES = {
    "offset_changes": "id",
    "zero_offset_changes": "id",
    "tool_shape_changes": "id",
    "mill_tool_changes": "id",
    "datum_preset_changes": "id",
    "insert_changes": "id",
    "part_readings": "id",
    "events": "id",
    "programs": "id",
    "program_versions": "id",
    "part_cycles": "id",
    "production_stops": "id",
    "shared_versions": "id",
    "shared_here": "program",
}
"""What grows for years: looked at entry by entry when it is read, and as a whole by ``verify``."""

SUMMED = KEYS | HISTORIES
SINCE = 11
"""The version that brought sums."""

_SINCE = dict.fromkeys(("runs", "part_features", *HISTORIES), 15) | dict.fromkeys(
    (
        "events",
        "programs",
        "program_versions",
        "part_cycles",
        "production_stops",
        "shared_versions",
        "shared_here",
    ),
    16,
)  # tables that got theirs later
_LEFT_OUT = {"program_versions": "text"}  # it is long, and the row has its SHA-256


class Text(bytes):
    """A text by the bytes that stand in the file: one that is damaged may be no UTF-8 any more."""


def sum_of(table: str, values: Row) -> str:
    """SHA-256 of a row, by all its columns in their order: texts as bytes, a float by every bit it has."""
    if table not in _WITH_BLOBS:  # elsewhere one is a text whose type is damaged
        shown = [("blob", value) if type(value) is bytes else value for value in values]
        return _digest_of((table, *shown))
    return _digest_of((table, *values))


def _digest_of(row: tuple[object, ...]) -> str:
    return sha256(repr(row).encode("utf-8", "surrogatepass")).hexdigest()


_WITH_BLOBS = frozenset({"people"})


def watch(connection: sqlite3.Connection) -> None:
    """Have this connection give a sum to every row that it writes."""
    connection.create_function("row_sum", -1, _row_sum, deterministic=True)
    for table, key in SUMMED.items():
        if not columns(connection, table):
            continue
        now = ", ".join(f"NEW.{column}" for column in columns(connection, table))
        gone = f"DELETE FROM row_sums WHERE tbl = '{table}' AND key = OLD.{key};"
        there = f"INSERT OR REPLACE INTO row_sums VALUES ('{table}', NEW.{key}, row_sum('{table}', {now}));"
        for event, does in (("INSERT", there), ("UPDATE", gone + there), ("DELETE", gone)):
            name = f"sum_{table}_{event}"
            connection.execute(f"DROP TRIGGER IF EXISTS temp.{name}")
            connection.execute(f"CREATE TEMP TRIGGER {name} AFTER {event} ON main.{table} BEGIN {does} END")


def _row_sum(table: str, *values: Value) -> str:
    return sum_of(table, tuple(Text(value.encode()) if isinstance(value, str) else value for value in values))


def seal_all(connection: sqlite3.Connection, damaged: frozenset[tuple[str, Key]]) -> None:
    """Give every row its sum but those that are ``damaged``; within a transaction."""
    for table in SUMMED:
        for key in _rows(connection, table).keys() | _sums(connection, table).keys():
            if (table, key) not in damaged:
                _seal(connection, table, key)
    _keep(connection, *_SCHEMA, schema_sum(connection))


def sealed_before(version: int) -> frozenset[str]:
    """The tables that had sums in a store of this version."""
    return frozenset(table for table in SUMMED if _SINCE.get(table, SINCE) <= version)


def all_broken(
    connection: sqlite3.Connection, tables: Iterable[str] = tuple(KEYS)
) -> frozenset[tuple[str, Key]]:
    """Table and key of every row that is not as it was saved."""
    return frozenset((table, key) for table in tables for key in broken(connection, table))


def broken(connection: sqlite3.Connection, table: str, since: int | None = None) -> frozenset[Key]:
    """The keys of the rows that are not as they were saved; of rows that have gone, too.

    ``since``: of a history only from this entry on.
    """
    rows, sums = _rows(connection, table, since), _sums(connection, table, since)
    return frozenset(
        key
        for key in rows.keys() | sums.keys()
        if key not in rows or sums.get(key) != sum_of(table, rows[key])
    )


def whole_rows(connection: sqlite3.Connection, table: str) -> dict[Key, Row]:
    """The rows that are as they were saved, by their keys; texts as bytes."""
    sums = _sums(connection, table)
    rows = _rows(connection, table).items()
    return {key: values for key, values in rows if sums.get(key) == sum_of(table, values)}


def whole_row(connection: sqlite3.Connection, table: str, key: Key) -> Row | None:
    """A row that is as it was saved, its texts as bytes; None: it is not there, or not as it was saved."""
    found = row(connection, table, key)
    if found is None or saved_sum(connection, table, key) != sum_of(table, found):
        return None
    return found


def row(connection: sqlite3.Connection, table: str, key: Key) -> Row | None:
    """The columns of a row that its sum is made of, texts as bytes; None: it is not there.

    By the table alone: an index that is damaged has other keys than its rows.
    """
    named = ", ".join(columns(connection, table))
    found = raw(connection, f"SELECT {named} FROM {table} NOT INDEXED WHERE {SUMMED[table]} = ?", (key,))
    return found[0] if found else None


def saved_sum(connection: sqlite3.Connection, table: str, key: Key) -> str:
    """The sum with which a row was saved; empty: it was not."""
    found = raw(connection, "SELECT sha256 FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
    return "".join(_digest(told) for (told,) in found)


def columns(connection: sqlite3.Connection, table: str) -> tuple[str, ...]:
    """The columns of a table, in the order in which their sum is made."""
    names = (each[1] for each in connection.execute(f"PRAGMA table_info({table})"))
    return tuple(name for name in names if name != _LEFT_OUT.get(table))


def raw(connection: sqlite3.Connection, query: str, values: tuple[Value, ...] = ()) -> list[Row]:
    """Rows with their texts as bytes: a text that is damaged may be no UTF-8 any more."""
    before, connection.text_factory = connection.text_factory, Text
    try:
        return connection.execute(query, values).fetchall()
    finally:
        connection.text_factory = before


def readable(values: Iterable[Value]) -> list[int | float | str | None]:
    """The same with texts, of a row that is whole."""
    return [value.decode() if isinstance(value, bytes) else value for value in values]


def schema_is_whole(connection: sqlite3.Connection) -> bool:
    """Whether the tables are those that were made: a bound or a usual value of a column is text there."""
    return saved_sum(connection, *_SCHEMA) == schema_sum(connection)


def schema_sum(connection: sqlite3.Connection) -> str:
    """SHA-256 of all tables and indexes as they are made."""
    made = raw(connection, "SELECT type, name, tbl_name, sql FROM main.sqlite_master ORDER BY type, name")
    return _digest_of(tuple(made))


_SCHEMA = ("sqlite_master", "")


def _seal(connection: sqlite3.Connection, table: str, key: Key) -> None:
    found = row(connection, table, key)
    if found is None:
        connection.execute("DELETE FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
        return
    _keep(connection, table, key, sum_of(table, found))


def _keep(connection: sqlite3.Connection, table: str, key: Key, digest: str) -> None:
    connection.execute(
        "INSERT INTO row_sums VALUES (?1, ?2, ?3) ON CONFLICT (tbl, key) DO UPDATE SET sha256 = ?3",
        (table, key, digest),
    )


def _rows(connection: sqlite3.Connection, table: str, since: int | None = None) -> dict[Key, Row]:
    named = ", ".join((SUMMED[table], *columns(connection, table)))
    if named == SUMMED[table]:
        return {}  # a store of a version that had no such table yet
    every = f"SELECT {named} FROM {table} NOT INDEXED"
    later = f"SELECT {named} FROM {table} WHERE {SUMMED[table]} >= ?"
    found = raw(connection, every) if since is None else raw(connection, later, (since,))
    return {_key(key): tuple(values) for key, *values in found}


def _key(value: Value) -> Key:
    """A key whose own bytes, or whose type, are damaged is one that nobody asks for."""
    if isinstance(value, Text):
        return value.decode("utf-8", "backslashreplace")
    return value if isinstance(value, int) else repr(value)


def _sums(connection: sqlite3.Connection, table: str, since: int | None = None) -> dict[Key, str]:
    asked = "SELECT key, sha256 FROM row_sums WHERE tbl = ?1 AND (?2 IS NULL OR key >= ?2)"
    return {_key(key): _digest(told) for key, told in raw(connection, asked, (table, since))}


def _digest(value: Value) -> str:
    """A sum that is damaged itself is any text, and that of no row."""
    return value.decode("ascii", "replace") if isinstance(value, bytes) else str(value)
