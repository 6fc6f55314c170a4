"""Stored tool lives: the limits, the use since the last insert change, and every insert change."""

from __future__ import annotations

import sqlite3
from typing import NamedTuple

from core.message import Message
from core.store import row_checksums
from core.store.store_errors import StoreError
from core.store.store_rows import MILL_TOOL_NUMBERS, OFFSET_NUMBERS, OffsetKind, get_utc_now_text


class ToolLifeRow(NamedTuple):
    """The tool life of one tool, with feed times in seconds.

    A limit of 0 means unlimited.
    """

    number: int
    limit_parts: int = 0
    limit_seconds: float = 0.0
    warn: float = 0.9
    stops: bool = False
    parts: int = 0
    seconds: float = 0.0


class InsertChange(NamedTuple):
    """The change of an insert or of a milling tool.

    ``parts`` and ``seconds`` are the number of parts and the feed time of the old insert or tool.
    """

    id: int
    at: str
    number: int
    parts: int
    seconds: float
    why: str
    kind: str = OffsetKind.TOOL.value
    who: str = ""


_USE = {OffsetKind.TOOL: "tool_lives", OffsetKind.MILL_TOOL: "mill_tool_lives"}
_NUMBERS = {OffsetKind.TOOL: OFFSET_NUMBERS, OffsetKind.MILL_TOOL: MILL_TOOL_NUMBERS}
_OF_MILL = (
    "SELECT number, 0, 60 * life, 0.9, stops, coalesce(parts, 0), coalesce(seconds, 0)"
    " FROM mill_tools LEFT JOIN mill_tool_lives USING (number) ORDER BY number"
)


def read_tool_lives(
    connection: sqlite3.Connection, kind: OffsetKind = OffsetKind.TOOL
) -> dict[int, ToolLifeRow]:
    """Return the tool life of all tools with a limit or with recorded use, by number.

    For a mill, the result contains all tools of the tool table. Damaged rows are omitted.
    """
    of_lathe = f"SELECT {', '.join(ToolLifeRow._fields)} FROM tool_lives ORDER BY number"
    rows = connection.execute(_OF_MILL if kind is OffsetKind.MILL_TOOL else of_lathe).fetchall()
    broken = row_checksums.find_broken_rows(connection, _USE[kind])
    if kind is OffsetKind.MILL_TOOL:
        broken |= row_checksums.find_broken_rows(connection, "mill_tools")
    whole = (row for row in rows if isinstance(row[0], int) and row[0] not in broken)
    return {row[0]: ToolLifeRow(*row)._replace(stops=bool(row[4])) for row in whole}


def save_tool_life_limits(connection: sqlite3.Connection, row: ToolLifeRow) -> None:
    """Save the limits of a lathe tool without changing its recorded use.

    Raises StoreError if the tool does not exist.
    """
    _demand_tool(row.number, OffsetKind.TOOL)
    connection.execute(
        "INSERT INTO tool_lives (number, limit_parts, limit_seconds, warn, stops) VALUES (?1, ?2, ?3, ?4, ?5)"
        " ON CONFLICT (number) DO UPDATE SET limit_parts = ?2, limit_seconds = ?3, warn = ?4, stops = ?5",
        (row.number, row.limit_parts, row.limit_seconds, row.warn, row.stops),
    )


def save_insert_use(
    connection: sqlite3.Connection,
    number: int,
    parts: int,
    seconds: float,
    kind: OffsetKind = OffsetKind.TOOL,
) -> None:
    """Save the number of parts and the feed time in seconds of an insert since its last change."""
    connection.execute(
        f"INSERT INTO {_USE[kind]} (number, parts, seconds) VALUES (?1, ?2, ?3)"
        " ON CONFLICT (number) DO UPDATE SET parts = ?2, seconds = ?3",
        (number, parts, seconds),
    )


def record_insert_change(
    connection: sqlite3.Connection,
    number: int,
    reason: str,
    kind: OffsetKind = OffsetKind.TOOL,
    author: str = "",
) -> None:
    """Record an insert change: save the use of the old insert and reset the counts to zero.

    Raises StoreError if the tool does not exist.
    """
    _demand_tool(number, kind)
    connection.execute(
        "INSERT INTO insert_changes (at, number, parts, seconds, why, kind, who)"
        " SELECT ?2, ?1, coalesce(max(parts), 0), coalesce(max(seconds), 0), ?3, ?4, ?5"
        f" FROM {_USE[kind]} WHERE number = ?1",
        (number, get_utc_now_text(), reason, kind.value, author),
    )
    connection.execute(f"UPDATE {_USE[kind]} SET parts = 0, seconds = 0 WHERE number = ?", (number,))


def read_insert_changes(connection: sqlite3.Connection, limit: int) -> tuple[InsertChange, ...]:
    """Return the latest insert changes, newest first."""
    rows = connection.execute("SELECT * FROM insert_changes ORDER BY id DESC LIMIT ?", (limit,))
    return tuple(InsertChange(*row) for row in rows)


def _demand_tool(number: int, kind: OffsetKind) -> None:
    numbers = _NUMBERS[kind]
    if number not in numbers:
        raise StoreError(
            Message(
                "tool T{number} does not exist; tools are T{numbers} to T{numbers2}",
                number=number,
                numbers=numbers[0],
                numbers2=numbers[-1],
            ),
            "unknown-tool",
        )
