"""Stored cycles and stops of production, with one row for each started part and for each stop."""

from __future__ import annotations

import sqlite3
from typing import TYPE_CHECKING, NamedTuple

from core.store.store_access import StoreAccess, WaitingEntries

if TYPE_CHECKING:
    from concurrent.futures import Future


class CycleRow(NamedTuple):
    """The cycle of one part, with UTC times and the cycle time in seconds without stops.

    ``part`` is 0 if no part was counted. ``ended`` is None if TurnDesk ended during the cycle.
    """

    key: str
    program: str
    part: int
    started: str
    ended: str | None = None
    seconds: float = 0.0
    outcome: str = ""
    load: float | None = None


class CycleTime(NamedTuple):
    """The start, end and cycle time of a ``CycleRow``, for lists of thousands of cycles."""

    started: str
    ended: str | None
    seconds: float


class ProductionStopRow(NamedTuple):
    """One stop of production, with its start (UTC), duration in seconds, reason and program line.

    ``cycle`` is empty for a stop between two cycles.
    """

    key: str
    cycle: str
    program: str
    at: str
    seconds: float
    reason: str
    line: int = 0


class CorrectionRow(NamedTuple):
    """A change of wear or of a secondary offset, in mm, with X as a radius.

    ``part`` is the number of parts that were started before the change.
    """

    id: int
    at: str
    kind: str
    number: int
    x: float
    z: float
    part: int
    why: str
    who: str
    was_x: float
    was_z: float


ProductionRow = CycleRow | ProductionStopRow
_CYCLE = ", ".join(CycleRow._fields)


def save_cycle(connection: sqlite3.Connection, row: CycleRow) -> None:
    """Save a cycle when it starts, or update the same cycle when it has ended."""
    connection.execute(
        f"INSERT INTO part_cycles ({_CYCLE}, offset_change)"
        " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, (SELECT coalesce(max(id), 0) FROM offset_changes))"
        " ON CONFLICT (key) DO UPDATE SET part = ?3, ended = ?5, seconds = ?6, outcome = ?7, load = ?8",
        row,
    )


def save_stop(connection: sqlite3.Connection, row: ProductionStopRow) -> None:
    """Save a stop that has ended, or update the duration and reason of the same stop."""
    marks = ", ".join("?" * len(row))
    connection.execute(
        f"INSERT INTO production_stops ({', '.join(ProductionStopRow._fields)}) VALUES ({marks})"
        " ON CONFLICT (key) DO UPDATE SET seconds = excluded.seconds, reason = excluded.reason",
        row,
    )


def queue_row(entries: WaitingEntries, row: ProductionRow) -> None:
    """Queue a cycle or a stop for writing to disk, replacing a queued entry of the same row."""
    if isinstance(row, CycleRow):
        entries.replace_operation(("cycle", row.key), lambda connection: save_cycle(connection, row))
    else:
        entries.replace_operation(("stop", row.key), lambda connection: save_stop(connection, row))


def programs(connection: sqlite3.Connection) -> set[str]:
    """Return the names of all programs with which at least one part was started."""
    return {name for (name,) in connection.execute("SELECT DISTINCT program FROM part_cycles")}


def read_cycles(connection: sqlite3.Connection, program: str | None, limit: int) -> tuple[CycleRow, ...]:
    """Return the latest cycles, oldest first.

    If ``program`` is None, the cycles of all programs are returned.
    """
    rows = connection.execute(
        f"SELECT {_CYCLE} FROM part_cycles WHERE ?1 IS NULL OR program = ?1 ORDER BY id DESC LIMIT ?2",
        (program, limit),
    )
    return tuple(CycleRow(*row) for row in rows)[::-1]


def read_cycle_times_since(connection: sqlite3.Connection, since: str) -> tuple[CycleTime, ...]:
    """Return the times of the cycles of all programs that started at ``since`` (UTC) or later.

    Only the latest 20 000 cycles are searched.
    """
    rows = connection.execute(
        "SELECT started, ended, seconds FROM part_cycles"
        " WHERE id > (SELECT max(id) FROM part_cycles) - 20000 AND started >= ? ORDER BY id",
        (since,),
    )
    return tuple(map(CycleTime._make, rows))


def read_stops(
    connection: sqlite3.Connection, program: str | None, limit: int
) -> tuple[ProductionStopRow, ...]:
    """Return the latest stops, oldest first.

    If ``program`` is None, the stops of all programs are returned.
    """
    rows = connection.execute(
        f"SELECT {', '.join(ProductionStopRow._fields)} FROM production_stops WHERE ?1 IS NULL OR "
        f"program = ?1"
        " ORDER BY id DESC LIMIT ?2",
        (program, limit),
    )
    return tuple(ProductionStopRow(*row) for row in rows)[::-1]


def read_corrections(connection: sqlite3.Connection, program: str, limit: int) -> tuple[CorrectionRow, ...]:
    """Return the latest changes of wear and secondary offsets, oldest first.

    The field ``part`` counts the parts of ``program`` that were started before the change. The values
    before and after the change are the wear of a tool, or X and Z of a secondary offset.
    """
    rows = connection.execute(
        "SELECT id, at, kind, number,"
        " CASE kind WHEN 'tool' THEN new_wear_x ELSE new_x END,"
        " CASE kind WHEN 'tool' THEN new_wear_z ELSE new_z END,"
        " (SELECT coalesce(max(c.part), 0) FROM part_cycles AS c"
        "   WHERE c.program = ?1 AND c.offset_change < offset_changes.id),"
        " why, who,"
        " coalesce(CASE kind WHEN 'tool' THEN old_wear_x ELSE old_x END, 0),"
        " coalesce(CASE kind WHEN 'tool' THEN old_wear_z ELSE old_z END, 0) FROM offset_changes"
        " WHERE (kind = 'tool' AND (coalesce(old_wear_x, 0) IS NOT new_wear_x"
        "   OR coalesce(old_wear_z, 0) IS NOT new_wear_z) AND new_wear_x IS NOT NULL)"
        " OR (kind = 'secondary' AND new_x IS NOT NULL)"
        " ORDER BY id DESC LIMIT ?2",
        (program, limit),
    )
    return tuple(CorrectionRow(*row) for row in rows)[::-1]


def read_cycles_between(connection: sqlite3.Connection, since: str, until: str) -> tuple[CycleRow, ...]:
    """Return the cycles of all programs that overlap the time from ``since`` to ``until`` (UTC)."""
    rows = connection.execute(
        f"SELECT {_CYCLE} FROM part_cycles"
        " WHERE started < ?2 AND max(started, coalesce(ended, started)) >= ?1 ORDER BY id",
        (since, until),
    )
    return tuple(CycleRow(*row) for row in rows)


def read_stops_between(
    connection: sqlite3.Connection, since: str, until: str
) -> tuple[ProductionStopRow, ...]:
    """Return the ended stops that overlap the time from ``since`` to ``until`` (UTC)."""
    rows = connection.execute(
        f"SELECT {', '.join(ProductionStopRow._fields)} FROM production_stops"
        " WHERE at < ?2 AND julianday(at) + seconds / 86400.0 > julianday(?1) ORDER BY id",
        (since, until),
    )
    return tuple(ProductionStopRow(*row) for row in rows)


class CycleRecords:
    """Records of cycles and stops in an open store.

    Methods raise StoreError as described in ``StoreAccess``. If the disk is full, a record is not lost but
    remains in memory and is written later.
    """

    def __init__(self, store: StoreAccess) -> None:
        self._store = store

    def record_row(self, row: ProductionRow) -> Future[None]:
        """Record the start of a cycle, the end of a recorded cycle, or a stop that has ended."""
        return self._store.keep(lambda entries: queue_row(entries, row))
