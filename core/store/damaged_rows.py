"""Detection and repair of database rows that do not match their checksums.

A damaged row is restored from the history where possible. Otherwise, the row is not used, and a message
reports the damage.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

from core.message import Message
from core.store import row_checksums
from core.store.offsets.offset_tables import HISTORY_TABLES, OFFSET_TABLES
from core.store.row_checksums import HISTORY_KEY_COLUMNS, KEY_COLUMNS, RowKey
from core.store.store_rows import ToolShapeRow
from core.tool_edges import format_edge_name

SCHEMA_CHANGED_MESSAGE = "the database schema differs from the schema that TurnDesk created"
TABLES_USED_BY_PROGRAMS = ("tool_offsets", "secondary_offsets", "zero_offsets", "mill_tools", "datum_presets")
"""Store tables with data used in proving programs."""
_DEFAULT_REMEDY = "enter the data again, or restore a backup"
_REMEDY = {
    "part_counts": "count the parts and enter the number, or restore a backup",
    "jobs": "clear the job from the queue ('turndesk jobs clear') and enter the job again",
    "people": "enter the PIN again, or reset the access levels ('turndesk access reset')",
}
_OTHERS = {
    "settings": "the setting",
    "part_counts": "the part-count record",
    "tool_lives": "the tool-life record",
    "mill_tool_lives": "the tool-life record",
    "jobs": "the job",
    "people": "the PIN entry",
    "runs": "the program-run record",
    "part_features": "the measured feature",
    "part_readings": "the reading",
    "insert_changes": "the insert-change record",
    "events": "the event",
    "programs": "the program record",
    "program_versions": "the program-version record",
    "part_cycles": "the part-cycle record",
    "production_stops": "the production-stop record",
    "shared_versions": "the shared version",
    "shared_here": "the shared program",
}


def repair_damaged_rows(connection: sqlite3.Connection) -> tuple[str, ...]:
    """Repair damaged rows, and return one message for each of them.

    A row is restored from its last history entry if this entry matches the saved checksum. If the entry
    equals the row, only the checksum is damaged, and it is corrected. A damaged row without a history is
    discarded if its values can restart from zero.
    """
    messages: list[str] = []
    connection.execute("DELETE FROM row_sums WHERE typeof(key) = 'blob'")  # no table has a key of this type
    for table, key in _broken(connection, KEY_COLUMNS):
        row = find_last_entered_values(
            connection, table, key, row_checksums.list_checksummed_columns(connection, table)
        )
        saved, now = (
            row_checksums.read_saved_checksum(connection, table, key),
            row_checksums.read_row(connection, table, key),
        )
        if row is not None and (row == now or row_checksums.calculate_checksum(table, row) == saved):
            marks = ", ".join("?" * len(row))
            connection.execute(f"DELETE FROM {table} WHERE {KEY_COLUMNS[table]} = ?", (key,))
            connection.execute(f"INSERT INTO {table} VALUES ({marks})", row_checksums.decode_values(row))
            messages.append(
                Message(
                    "{table} was damaged in the data store; the last values entered were restored "
                    "from the history",
                    table=make_row_label(table, key),
                )
            )
        elif table in _DISCARD_FUNCTIONS:
            messages.append(_discard_row(connection, table, key))
    return tuple(messages)


def _begin_anew(connection: sqlite3.Connection, program: RowKey) -> str:
    connection.execute("DELETE FROM runs WHERE program = ?", (program,))
    return Message(
        "{program} was damaged in the data store and was cleared", program=make_row_label("runs", program)
    )


def _retire_damaged_feature(connection: sqlite3.Connection, feature: RowKey) -> str:
    """Retire a damaged measured feature, and return the message for the operator.

    If the row contains a value that is not valid for any feature, the row and its readings are deleted.
    """
    row = row_checksums.read_row(connection, "part_features", feature)
    which = Message("{row} {row2}", row=_shown(row[1]), row2=_shown(row[2])) if row else feature
    message = Message(
        "{which} was damaged in the data store and was removed from the list of "
        "measured features; enter the feature again",
        which=make_row_label("part_features", which),
    )
    every = ", ".join(
        f"{column} = {column}"  # SQLite checks only the bounds of the columns that are set
        for column in row_checksums.list_checksummed_columns(connection, "part_features")
        if column not in {"id", "retired"}
    )
    try:
        retired = connection.execute(
            f"UPDATE part_features SET {every}, retired = 1 WHERE id = ? AND typeof(nominal) = 'real'"
            " AND typeof(low) = 'real' AND typeof(high) = 'real' AND typeof(name) = 'text'",
            (feature,),
        ).rowcount
    except sqlite3.IntegrityError:  # a value is outside its bounds
        retired = 0
    if retired:
        return message
    gone = connection.execute("DELETE FROM part_readings WHERE feature = ?", (feature,)).rowcount
    connection.execute("DELETE FROM part_features WHERE id = ?", (feature,))
    return Message(
        "{details}. The readings of this feature (number of readings: {gone}) were also lost",
        details=message,
        gone=gone,
    )


_DISCARD_FUNCTIONS = {"runs": _begin_anew, "part_features": _retire_damaged_feature}


def _discard_row(connection: sqlite3.Connection, table: str, key: RowKey) -> str:
    """Discard a damaged row that cannot be entered again, and return the message for the operator.

    If this deletes the row, its checksum is deleted too.
    """
    message = _DISCARD_FUNCTIONS[table](connection, key)
    if row_checksums.read_row(connection, table, key) is None:
        connection.execute("DELETE FROM row_sums WHERE tbl = ? AND key = ?", (table, key))
    return message


def _shown(value: row_checksums.ColumnValue) -> str:
    text = value.decode("utf-8", "backslashreplace") if isinstance(value, bytes) else str(value)
    return " ".join(text.split())


def find_damaged_rows(
    connection: sqlite3.Connection,
    tables: Collection[str] = KEY_COLUMNS,
    settings: Collection[str] = (),
    report_table: Callable[[], None] | None = None,
) -> tuple[str, ...]:
    """Return a message for each row that does not match its checksum.

    Such a row is treated as if it had never been set. ``tables`` are the tables to check. ``settings`` are
    the setting keys to check if ``tables`` does not include the settings table. ``report_table`` is called
    after each checked table.
    """
    looked = [table for table in KEY_COLUMNS if table in tables or (table == "settings" and settings)]
    return tuple(
        (
            Message(
                "{table} does not match its checksum and is not used; {table2}",
                table=make_row_label(table, key),
                table2=_REMEDY.get(table, _DEFAULT_REMEDY),
            )
        )
        for table, key in _broken(connection, looked, report_table)
        if table in tables or key in settings
    )


def find_damaged_history(
    connection: sqlite3.Connection, report_table: Callable[[], None] | None = None
) -> tuple[str, ...]:
    """Return a message for each damaged row of a history table, and one if the schema has changed.

    These tables grow for years. They are checked completely only by the command ``verify``.
    ``report_table`` is called after each checked table.
    """
    tables = () if row_checksums.is_schema_intact(connection) else (SCHEMA_CHANGED_MESSAGE,)
    return tables + tuple(
        Message("{table} was damaged in the data store", table=make_row_label(table, key))
        for table, key in _broken(connection, HISTORY_KEY_COLUMNS, report_table)
    )


def _broken(
    connection: sqlite3.Connection, tables: Collection[str], report_table: Callable[[], None] | None = None
) -> list[tuple[str, RowKey]]:
    order = list(tables)
    found = row_checksums.find_all_broken_rows(connection, _report_each(tables, report_table))
    return sorted(found, key=lambda row: (order.index(row[0]), isinstance(row[1], str), row[1]))


def _report_each(tables: Iterable[str], report_table: Callable[[], None] | None) -> Iterator[str]:
    """Yield the tables, and report each of them after the caller has checked it."""
    for table in tables:
        yield table
        if report_table is not None:
            report_table()


def make_row_label(name: str, key: row_checksums.RowKey) -> str:
    """Return the name that the operator sees for a row of a table with checksums."""
    table = next((each for each in OFFSET_TABLES.values() if each.name == name), None)
    if any(log.name == name for log in HISTORY_TABLES):
        return Message("entry {key} of the offset history", key=key)
    if table is None:
        return Message("{others} {text}", others=_OTHERS[name], text=" ".join(str(key).split()))
    if table.letter != "T" or not isinstance(key, int):
        return f"{table.letter}{key}"
    return (
        Message("the tool shape of {key}", key=format_edge_name(key))
        if table.row_type is ToolShapeRow
        else format_edge_name(key)
    )


def find_last_entered_values(
    connection: sqlite3.Connection, name: str, key: row_checksums.RowKey, columns: Sequence[str]
) -> tuple[row_checksums.ColumnValue, ...] | None:
    """Return the values of a row as last entered, in the order of ``columns``.

    The result is None if the row was never entered or has been cleared.
    """
    kind = next((kind for kind, table in OFFSET_TABLES.items() if table.name == name), None)
    if kind is None:
        return None
    log = OFFSET_TABLES[kind].history_table
    sides = ", ".join(log.key_column if column == log.key_column else f"new_{column}" for column in columns)
    last = f"WHERE {log.key_column} = ? AND {log.kind_sql_expression} = ? ORDER BY id DESC LIMIT 1"
    found = row_checksums.query_raw_rows(
        connection, f"SELECT {sides} FROM {log.name} {last}", (key, kind.value)
    )
    return None if not found or None in found[0] else found[0]
