"""A sum beside every offset, setting, count, life and job: a row that is not as it was saved is not believed.

A connection that writes makes the sums by triggers of its own, so no place that writes can forget to. A
reader compares.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from hashlib import sha256

Key = int | str
Value = int | float | str | bytes | None

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
}
"""What has sums: tables, and the column that tells their rows apart."""


def sum_of(table: str, values: tuple[Value, ...]) -> str:
    """SHA-256 of a row, by all its columns in their order: texts as bytes, a float by every bit it has."""
    return sha256(repr((table, *values)).encode("utf-8", "surrogatepass")).hexdigest()


def watch(connection: sqlite3.Connection) -> None:
    """Have this connection give a sum to every row that it writes."""
    connection.create_function("row_sum", -1, _row_sum, deterministic=True)
    for table, key in KEYS.items():
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
    return sum_of(table, tuple(value.encode() if isinstance(value, str) else value for value in values))


def seal_all(connection: sqlite3.Connection, damaged: frozenset[tuple[str, Key]]) -> None:
    """Give every row its sum but those that are ``damaged``; within a transaction."""
    for table in KEYS:
        for key in _rows(connection, table).keys() | _sums(connection, table).keys():
            if (table, key) not in damaged:
                _seal(connection, table, key)


def all_broken(connection: sqlite3.Connection) -> frozenset[tuple[str, Key]]:
    """Table and key of every row that is not as it was saved."""
    return frozenset((table, key) for table in KEYS for key in broken(connection, table))


def broken(connection: sqlite3.Connection, table: str) -> frozenset[Key]:
    """The keys of the rows that are not as they were saved; of rows that have gone, too."""
    rows, sums = _rows(connection, table), _sums(connection, table)
    return frozenset(
        key
        for key in rows.keys() | sums.keys()
        if key not in rows or sums.get(key) != sum_of(table, rows[key])
    )


def is_whole(connection: sqlite3.Connection, table: str, key: Key) -> bool:
    """Whether this row is as it was saved; one that is not there and was not saved is."""
    found = row(connection, table, key)
    return saved_sum(connection, table, key) == (sum_of(table, found) if found is not None else "")


def row(connection: sqlite3.Connection, table: str, key: Key) -> tuple[Value, ...] | None:
    """All columns of a row, its texts as bytes; None: it is not there."""
    found = raw(connection, f"SELECT * FROM {table} WHERE {KEYS[table]} = ?", (key,))
    return found[0] if found else None


def saved_sum(connection: sqlite3.Connection, table: str, key: Key) -> str:
    """The sum with which a row was saved; empty: it was not."""
    found = connection.execute("SELECT sha256 FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
    return "".join(str(told) for (told,) in found)


def columns(connection: sqlite3.Connection, table: str) -> tuple[str, ...]:
    """The columns of a table, in the order in which their sum is made."""
    return tuple(each[1] for each in connection.execute(f"PRAGMA table_info({table})"))


def raw(connection: sqlite3.Connection, query: str, values: tuple[Key, ...] = ()) -> list[tuple[Value, ...]]:
    """Rows with their texts as bytes: a text that is damaged may be no UTF-8 any more."""
    before, connection.text_factory = connection.text_factory, bytes
    try:
        return connection.execute(query, values).fetchall()
    finally:
        connection.text_factory = before


def readable(values: Iterable[Value]) -> list[int | float | str | None]:
    """The same with texts, of a row that is whole."""
    return [value.decode() if isinstance(value, bytes) else value for value in values]


def _seal(connection: sqlite3.Connection, table: str, key: Key) -> None:
    found = row(connection, table, key)
    if found is None:
        connection.execute("DELETE FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
        return
    connection.execute(
        "INSERT INTO row_sums VALUES (?1, ?2, ?3) ON CONFLICT (tbl, key) DO UPDATE SET sha256 = ?3",
        (table, key, sum_of(table, found)),
    )


def _rows(connection: sqlite3.Connection, table: str) -> dict[Key, tuple[Value, ...]]:
    if not columns(connection, table):
        return {}  # a store of a version that had no such table yet
    found = raw(connection, f"SELECT {KEYS[table]}, * FROM {table}")
    return {_key(key): tuple(values) for key, *values in found}


def _key(value: Value) -> Key:
    """A key whose own bytes are damaged is one that nobody asks for."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "backslashreplace")
    return value if isinstance(value, int) else str(value)


def _sums(connection: sqlite3.Connection, table: str) -> dict[Key, str]:
    return dict(connection.execute("SELECT key, sha256 FROM row_sums WHERE tbl = ?", (table,)).fetchall())
