"""Checksums of database rows, which prevent TurnDesk from using rows that were damaged on disk.

Offsets, settings, part counts, tool lives and jobs have checksums. Entries of the histories also have
checksums, because the undo function uses their values, and so do events and program versions. Triggers of
each writing connection update the checksums, so no writing function can omit them. Readers compare the rows
with the checksums.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from hashlib import sha256

RowKey = int | str
ColumnValue = int | float | str | bytes | None
RowValues = tuple[ColumnValue, ...]

KEY_COLUMNS = {
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
"""Tables that are checked whenever a store is opened, with the column that identifies a row."""

HISTORY_KEY_COLUMNS = {
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
"""Tables that grow for years, with the column that identifies a row.

Each entry is checked when it is read, and ``verify`` checks the whole table.
"""

CHECKSUMMED_TABLES = KEY_COLUMNS | HISTORY_KEY_COLUMNS
FIRST_CHECKSUM_VERSION = 11
"""Store version that introduced checksums."""

_SINCE = dict.fromkeys(("runs", "part_features", *HISTORY_KEY_COLUMNS), 15) | dict.fromkeys(
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
)  # tables whose checksums a later version introduced
_LEFT_OUT = {"program_versions": "text"}  # the text is long, and the row already has its SHA-256


class TextBytes(bytes):
    """A text value of the database as its stored bytes, which may be invalid UTF-8 if it is damaged."""


def calculate_checksum(table: str, values: RowValues) -> str:
    """Return the SHA-256 of a row over all its columns in order.

    Text values are included as bytes. Floats are included with full precision.
    """
    if table not in _WITH_BLOBS:  # a blob in another table is a text whose type is damaged
        shown = [("blob", value) if type(value) is bytes else value for value in values]
        return _digest_of((table, *shown))
    return _digest_of((table, *values))


def _digest_of(row: tuple[object, ...]) -> str:
    return sha256(repr(row).encode("utf-8", "surrogatepass")).hexdigest()


_WITH_BLOBS = frozenset({"people"})


def create_checksum_triggers(connection: sqlite3.Connection) -> None:
    """Create connection triggers that update the checksum of every row that this connection writes."""
    connection.create_function("row_sum", -1, _row_sum, deterministic=True)
    for table, key in CHECKSUMMED_TABLES.items():
        if not list_checksummed_columns(connection, table):
            continue
        now = ", ".join(f"NEW.{column}" for column in list_checksummed_columns(connection, table))
        gone = f"DELETE FROM row_sums WHERE tbl = '{table}' AND key = OLD.{key};"
        there = f"INSERT OR REPLACE INTO row_sums VALUES ('{table}', NEW.{key}, row_sum('{table}', {now}));"
        for event, does in (("INSERT", there), ("UPDATE", gone + there), ("DELETE", gone)):
            name = f"sum_{table}_{event}"
            connection.execute(f"DROP TRIGGER IF EXISTS temp.{name}")
            connection.execute(f"CREATE TEMP TRIGGER {name} AFTER {event} ON main.{table} BEGIN {does} END")


def _row_sum(table: str, *values: ColumnValue) -> str:
    return calculate_checksum(
        table, tuple(TextBytes(value.encode()) if isinstance(value, str) else value for value in values)
    )


def write_all_checksums(connection: sqlite3.Connection, damaged: frozenset[tuple[str, RowKey]]) -> None:
    """Write the checksum of every row that is not in ``damaged``.

    The caller must have begun a transaction.
    """
    for table in CHECKSUMMED_TABLES:
        for key in _rows(connection, table).keys() | _sums(connection, table).keys():
            if (table, key) not in damaged:
                _seal(connection, table, key)
    _keep(connection, *_SCHEMA, calculate_schema_checksum(connection))


def list_tables_with_checksums(version: int) -> frozenset[str]:
    """Return the tables that have checksums in a store of this version."""
    return frozenset(
        table for table in CHECKSUMMED_TABLES if _SINCE.get(table, FIRST_CHECKSUM_VERSION) <= version
    )


def find_all_broken_rows(
    connection: sqlite3.Connection, tables: Iterable[str] = tuple(KEY_COLUMNS)
) -> frozenset[tuple[str, RowKey]]:
    """Return the table and the key of every row that does not match its checksum."""
    return frozenset((table, key) for table in tables for key in find_broken_rows(connection, table))


def find_broken_rows(
    connection: sqlite3.Connection, table: str, first_key: int | None = None
) -> frozenset[RowKey]:
    """Return the keys of rows that do not match their checksums, including rows that no longer exist.

    ``first_key`` limits the check of a history to the entries from this key on.
    """
    rows, sums = _rows(connection, table, first_key), _sums(connection, table, first_key)
    return frozenset(
        key
        for key in rows.keys() | sums.keys()
        if key not in rows or sums.get(key) != calculate_checksum(table, rows[key])
    )


def read_intact_rows(connection: sqlite3.Connection, table: str) -> dict[RowKey, RowValues]:
    """Return the rows that match their checksums, by key, with text values as bytes."""
    sums = _sums(connection, table)
    rows = _rows(connection, table).items()
    return {key: values for key, values in rows if sums.get(key) == calculate_checksum(table, values)}


def read_intact_row(connection: sqlite3.Connection, table: str, key: RowKey) -> RowValues | None:
    """Return a row that matches its checksum (text values as bytes), or None if missing or damaged."""
    found = read_row(connection, table, key)
    if found is None or read_saved_checksum(connection, table, key) != calculate_checksum(table, found):
        return None
    return found


def read_row(connection: sqlite3.Connection, table: str, key: RowKey) -> RowValues | None:
    """Return the columns of a row that its checksum covers, or None if the row is missing.

    Text values are returned as bytes. The row is read without an index, because a damaged index can have
    wrong keys.
    """
    named = ", ".join(list_checksummed_columns(connection, table))
    found = query_raw_rows(
        connection, f"SELECT {named} FROM {table} NOT INDEXED WHERE {CHECKSUMMED_TABLES[table]} = ?", (key,)
    )
    return found[0] if found else None


def read_saved_checksum(connection: sqlite3.Connection, table: str, key: RowKey) -> str:
    """Return the saved checksum of a row, or an empty string if it has none."""
    found = query_raw_rows(connection, "SELECT sha256 FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
    return "".join(_digest(raw_sum) for (raw_sum,) in found)


def list_checksummed_columns(connection: sqlite3.Connection, table: str) -> tuple[str, ...]:
    """Return the columns that a table's checksums cover, in order, or () if the table does not exist."""
    names = (each[1] for each in connection.execute(f"PRAGMA table_info({table})"))
    return tuple(name for name in names if name != _LEFT_OUT.get(table))


def query_raw_rows(
    connection: sqlite3.Connection, query: str, values: tuple[ColumnValue, ...] = ()
) -> list[RowValues]:
    """Run a query and return its rows with text values as bytes.

    A damaged value may not be valid UTF-8.
    """
    before, connection.text_factory = connection.text_factory, TextBytes
    try:
        return connection.execute(query, values).fetchall()
    finally:
        connection.text_factory = before


def decode_values(values: Iterable[ColumnValue]) -> list[int | float | str | None]:
    """Return the values of an intact row with its text values decoded."""
    return [value.decode() if isinstance(value, bytes) else value for value in values]


def is_schema_intact(connection: sqlite3.Connection) -> bool:
    """Return whether the definitions of tables and indexes are unchanged since their creation.

    The definitions include column constraints and defaults.
    """
    return read_saved_checksum(connection, *_SCHEMA) == calculate_schema_checksum(connection)


def calculate_schema_checksum(connection: sqlite3.Connection) -> str:
    """Return the SHA-256 of the SQL that created all tables and indexes."""
    made = query_raw_rows(
        connection, "SELECT type, name, tbl_name, sql FROM main.sqlite_master ORDER BY type, name"
    )
    return _digest_of(tuple(made))


_SCHEMA = ("sqlite_master", "")


def _seal(connection: sqlite3.Connection, table: str, key: RowKey) -> None:
    found = read_row(connection, table, key)
    if found is None:
        connection.execute("DELETE FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
        return
    _keep(connection, table, key, calculate_checksum(table, found))


def _keep(connection: sqlite3.Connection, table: str, key: RowKey, digest: str) -> None:
    connection.execute(
        "INSERT INTO row_sums VALUES (?1, ?2, ?3) ON CONFLICT (tbl, key) DO UPDATE SET sha256 = ?3",
        (table, key, digest),
    )


def _rows(connection: sqlite3.Connection, table: str, since: int | None = None) -> dict[RowKey, RowValues]:
    named = ", ".join((CHECKSUMMED_TABLES[table], *list_checksummed_columns(connection, table)))
    if named == CHECKSUMMED_TABLES[table]:
        return {}  # the store version does not have this table yet
    every = f"SELECT {named} FROM {table} NOT INDEXED"
    later = f"SELECT {named} FROM {table} WHERE {CHECKSUMMED_TABLES[table]} >= ?"
    found = (
        query_raw_rows(connection, every) if since is None else query_raw_rows(connection, later, (since,))
    )
    return {_key(key): tuple(values) for key, *values in found}


def _key(value: ColumnValue) -> RowKey:
    """Return a row key from the checksum table as an integer or a string.

    A damaged key becomes a string that matches no other key.
    """
    if isinstance(value, TextBytes):
        return value.decode("utf-8", "backslashreplace")
    return value if isinstance(value, int) else repr(value)


def _sums(connection: sqlite3.Connection, table: str, since: int | None = None) -> dict[RowKey, str]:
    asked = "SELECT key, sha256 FROM row_sums WHERE tbl = ?1 AND (?2 IS NULL OR key >= ?2)"
    return {_key(key): _digest(raw_sum) for key, raw_sum in query_raw_rows(connection, asked, (table, since))}


def _digest(value: ColumnValue) -> str:
    """Return a saved checksum as a string.

    A damaged checksum becomes a string that matches no row.
    """
    return value.decode("ascii", "replace") if isinstance(value, bytes) else str(value)
