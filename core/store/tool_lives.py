"""Tool life as it is kept: limits, what the insert has made since it was changed, and every change of it."""

from __future__ import annotations

import sqlite3
from typing import NamedTuple

from core.store.store_errors import StoreError
from core.store.store_rows import OFFSETS, utc_now


class LifeRow(NamedTuple):
    """Of one tool; seconds at feed, a limit of 0 is none."""

    number: int
    limit_parts: int = 0
    limit_seconds: float = 0.0
    warn: float = 0.9
    stops: bool = False
    parts: int = 0
    seconds: float = 0.0


class InsertChange(NamedTuple):
    """An insert was changed after so many parts and seconds at feed."""

    id: int
    at: str
    number: int
    parts: int
    seconds: float
    why: str


def lives(connection: sqlite3.Connection) -> dict[int, LifeRow]:
    """Of all tools that have a limit or have cut, by number."""
    rows = connection.execute(f"SELECT {', '.join(LifeRow._fields)} FROM tool_lives ORDER BY number")
    return {row[0]: LifeRow(*row)._replace(stops=bool(row[4])) for row in rows}


def set_limits(connection: sqlite3.Connection, row: LifeRow) -> None:
    """Limits of a tool; what it has made stays. Raises StoreError for a number that no tool has."""
    _demand_tool(row.number)
    connection.execute(
        "INSERT INTO tool_lives (number, limit_parts, limit_seconds, warn, stops) VALUES (?1, ?2, ?3, ?4, ?5)"
        " ON CONFLICT (number) DO UPDATE SET limit_parts = ?2, limit_seconds = ?3, warn = ?4, stops = ?5",
        (row.number, row.limit_parts, row.limit_seconds, row.warn, row.stops),
    )


def set_use(connection: sqlite3.Connection, number: int, parts: int, seconds: float) -> None:
    """What the insert has made by now, in parts and seconds at feed."""
    connection.execute(
        "INSERT INTO tool_lives (number, parts, seconds) VALUES (?1, ?2, ?3)"
        " ON CONFLICT (number) DO UPDATE SET parts = ?2, seconds = ?3",
        (number, parts, seconds),
    )


def change_insert(connection: sqlite3.Connection, number: int, why: str) -> None:
    """A fresh insert: the count begins at nought, and what the old one has made is kept."""
    _demand_tool(number)
    connection.execute(
        "INSERT INTO insert_changes (at, number, parts, seconds, why)"
        " SELECT ?2, ?1, coalesce(max(parts), 0), coalesce(max(seconds), 0), ?3"
        " FROM tool_lives WHERE number = ?1",
        (number, utc_now(), why),
    )
    connection.execute("UPDATE tool_lives SET parts = 0, seconds = 0 WHERE number = ?", (number,))


def insert_changes(connection: sqlite3.Connection, limit: int) -> tuple[InsertChange, ...]:
    """Changes of inserts, newest first."""
    rows = connection.execute("SELECT * FROM insert_changes ORDER BY id DESC LIMIT ?", (limit,))
    return tuple(InsertChange(*row) for row in rows)


def _demand_tool(number: int) -> None:
    if number not in OFFSETS:
        raise StoreError(f"there is no tool T{number}; tools are T{OFFSETS[0]} to T{OFFSETS[-1]}")
