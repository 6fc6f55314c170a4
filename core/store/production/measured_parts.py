"""Measured features of parts, and their readings.

The readings of a feature remain when the feature is retired.
"""

from __future__ import annotations

import math
import sqlite3
from typing import Any, NamedTuple

from core.message import Message
from core.store import row_checksums
from core.store.store_errors import StoreError
from core.store.store_rows import get_utc_now_text


class FeatureRow(NamedTuple):
    """A measured feature as stored, in mm.

    ``id`` is 0 for a feature that has not been stored yet. The table ``part_features`` in
    ``store.table_keys`` describes the columns.
    """

    id: int
    program: str
    name: str
    kind: str
    nominal: float
    low: float
    high: float
    by_kind: str
    number: int
    grows: int
    every: int
    sample: int


class ReadingRow(NamedTuple):
    """One reading of a feature, in mm.

    ``offset_change`` is the ID of the newest offset change at the start of the part's cycle, or -1 if it is
    unknown.
    """

    id: int
    feature: int
    part: int
    value: float
    unit: str
    at: str
    source: str
    gauge: str
    offset_change: int = -1


_COLUMNS = ", ".join(FeatureRow._fields)


def read_features(connection: sqlite3.Connection, program: str | None = None) -> tuple[FeatureRow, ...]:
    """Return the features that are measured, in the order of entry.

    If ``program`` is None, the features of all programs are returned. Damaged rows are omitted, because
    wear corrections are calculated from these values.
    """
    rows = connection.execute(
        f"SELECT {_COLUMNS} FROM part_features WHERE retired = 0 AND (?1 IS NULL OR program = ?1)"
        " ORDER BY program, id",
        (program,),
    ).fetchall()
    broken = row_checksums.find_broken_rows(connection, "part_features") if rows else frozenset()
    return tuple(FeatureRow(*row) for row in rows if row[0] not in broken)


def save_feature(connection: sqlite3.Connection, row: FeatureRow) -> int:
    """Add a feature or change a stored feature, and return its ID.

    Raises StoreError if the program has another feature of this name, or if the feature no longer exists.
    """
    taken = connection.execute(
        "SELECT id FROM part_features WHERE program = ? AND name = ? AND retired = 0 AND id <> ?",
        (row.program, row.name, row.id),
    ).fetchone()
    if taken is not None:
        raise StoreError(
            Message(
                "{program} already has a feature named {row}; give this feature another name",
                program=row.program,
                row=f"{row.name!r}",
            ),
            "name-in-use",
        )
    values = row[1:]
    if not row.id:
        marks = ", ".join("?" * len(values))
        done = connection.execute(
            f"INSERT INTO part_features ({_COLUMNS.partition(', ')[2]}) VALUES ({marks})", values
        )
        return int(done.lastrowid or 0)
    setting = ", ".join(f"{name} = ?" for name in FeatureRow._fields[1:])
    done = connection.execute(
        f"UPDATE part_features SET {setting} WHERE id = ? AND retired = 0", (*values, row.id)
    )
    if not done.rowcount:
        raise StoreError(
            Message(
                "{row} is not in the list of measured features anymore; enter the feature again",
                row=row.name,
            ),
            "feature-gone",
        )
    return row.id


def retire_feature(connection: sqlite3.Connection, feature_id: int) -> None:
    """Stop measuring a feature without deleting its readings."""
    connection.execute("UPDATE part_features SET retired = 1 WHERE id = ?", (feature_id,))


def add_reading(connection: sqlite3.Connection, row: ReadingRow) -> int:
    """Add a reading, with the current time if the reading has no time, and return its ID.

    Raises StoreError if the value is not finite, or if the feature does not exist or is retired.
    """
    if not math.isfinite(row.value):
        raise StoreError("a reading must be a number; measure again", "not-a-number")
    there = connection.execute(
        "SELECT 1 FROM part_features WHERE id = ? AND retired = 0", (row.feature,)
    ).fetchone()
    if there is None:
        raise StoreError(
            "the feature of this reading is not in the list of measured features anymore; nothing was saved",
            "feature-gone",
        )
    done = connection.execute(
        "INSERT INTO part_readings (feature, part, value, unit, at, source, gauge)"
        " VALUES (?, ?, ?, ?, ?, ?, ?)",
        (row.feature, row.part, row.value, row.unit, row.at or get_utc_now_text(), row.source, row.gauge),
    )
    return int(done.lastrowid or 0)


def void_reading(connection: sqlite3.Connection, reading_id: int) -> None:
    """Mark a reading as deleted without removing its row.

    Raises StoreError if the reading does not exist or is already deleted.
    """
    done = connection.execute("UPDATE part_readings SET void = 1 WHERE id = ? AND void = 0", (reading_id,))
    if not done.rowcount:
        raise StoreError("that reading has already been deleted", "already-removed")


def read_readings(connection: sqlite3.Connection, program: str, limit: int) -> tuple[ReadingRow, ...]:
    """Return the latest readings of a program's features, oldest first. Damaged rows are omitted."""
    rows = connection.execute(
        "SELECT r.id, r.feature, r.part, r.value, r.unit, r.at, r.source, r.gauge,"
        " coalesce((SELECT c.offset_change FROM part_cycles AS c WHERE c.program = f.program"
        "  AND c.part = r.part AND r.part > 0 ORDER BY c.id DESC LIMIT 1), -1)"
        " FROM part_readings AS r JOIN part_features AS f ON f.id = r.feature"
        " WHERE f.program = ? AND r.void = 0 AND f.retired = 0 ORDER BY r.id DESC LIMIT ?",
        (program, limit),
    )
    return tuple(ReadingRow(*row) for row in _select_intact_rows(connection, rows.fetchall()))[::-1]


def _select_intact_rows(connection: sqlite3.Connection, rows: list[Any]) -> list[Any]:
    """Return the rows whose reading, identified by the first column, matches its checksum."""
    return [
        row for row in rows if row_checksums.read_intact_row(connection, "part_readings", row[0]) is not None
    ]


def read_last_corrections(connection: sqlite3.Connection) -> dict[tuple[str, int, str], int]:
    """Return the ID of the newest change of each offset or wear, by kind, number and axis."""
    rows = connection.execute(
        "SELECT kind, number, 'x', max(id) FROM offset_changes"
        " WHERE old_x IS NOT new_x OR coalesce(old_wear_x, 0) IS NOT coalesce(new_wear_x, 0)"
        " GROUP BY kind, number"
        " UNION ALL SELECT kind, number, 'z', max(id) FROM offset_changes"
        " WHERE old_z IS NOT new_z OR coalesce(old_wear_z, 0) IS NOT coalesce(new_wear_z, 0)"
        " GROUP BY kind, number"
    )
    return {(kind, number, axis): newest for kind, number, axis, newest in rows}


def read_readings_between(
    connection: sqlite3.Connection, since: str, until: str
) -> tuple[tuple[FeatureRow, ReadingRow], ...]:
    """Return the readings from ``since`` to before ``until`` (UTC), each with its feature.

    Readings of retired features are included. Damaged rows are omitted.
    """
    columns = ", ".join(f"f.{name}" for name in FeatureRow._fields)
    rows = connection.execute(
        f"SELECT r.id, r.feature, r.part, r.value, r.unit, r.at, r.source, r.gauge, {columns}"
        " FROM part_readings AS r JOIN part_features AS f ON f.id = r.feature"
        " WHERE r.void = 0 AND r.at >= ? AND r.at < ? ORDER BY r.id",
        (since, until),
    )
    whole = _select_intact_rows(connection, rows.fetchall())
    return tuple((FeatureRow(*row[8:]), ReadingRow(*row[:8])) for row in whole)
