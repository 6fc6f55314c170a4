"""Rows that are not as they were saved: put right where the history has them, else not used, and told."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection

from core.store import row_sums
from core.store.offset_tables import history_of, named
from core.store.row_sums import KEYS, Key


def repair(connection: sqlite3.Connection) -> tuple[str, ...]:
    """Put rows right that the history vouches for; tell which were.

    Its last entry has the sum with which the row was saved, or is the row itself and the sum is damaged.
    """
    told = []
    for table, key in _broken(connection):
        row = history_of(connection, table, key, row_sums.columns(connection, table))
        saved, now = row_sums.saved_sum(connection, table, key), row_sums.row(connection, table, key)
        if row is not None and (row == now or row_sums.sum_of(table, row) == saved):
            marks = ", ".join("?" * len(row))
            connection.execute(f"DELETE FROM {table} WHERE {KEYS[table]} = ?", (key,))
            connection.execute(f"INSERT INTO {table} VALUES ({marks})", row_sums.readable(row))
            told.append(f"{named(table, key)} was damaged in the store; it is again as it was entered")
    return tuple(told)


def damaged(
    connection: sqlite3.Connection, tables: Collection[str] = KEYS, settings: Collection[str] = ()
) -> tuple[str, ...]:
    """A sentence for each row that is not as it was saved; it is read as if it had never been set.

    Of some tables only, and of some settings.
    """
    return tuple(
        f"{named(table, key)} is not as it was saved, and is not used; {_REMEDY.get(table, _ANEW)}"
        for table, key in _broken(connection)
        if table in tables or (table == "settings" and key in settings)
    )


OF_PROGRAMS = ("tool_offsets", "secondary_offsets", "zero_offsets", "mill_tools", "datum_presets")
"""The tables of what programs are proved with."""

_ANEW = "enter it anew, or restore a backup"
_REMEDY = {
    "part_counts": "count the parts and enter them, or restore a backup",
    "jobs": "clear the queue of it ('turndesk jobs clear'), and enter it anew",
    "people": "enter it anew, or reset the levels ('turndesk access reset')",
}


def _broken(connection: sqlite3.Connection) -> list[tuple[str, Key]]:
    order = list(KEYS)
    found = row_sums.all_broken(connection)
    return sorted(found, key=lambda row: (order.index(row[0]), isinstance(row[1], str), row[1]))
