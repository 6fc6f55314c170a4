"""The event log and the settings."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Collection, Iterable
from typing import Any

from core.message import Message, pack_message, unpack_message
from core.store import row_sums
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow


def log(connection: sqlite3.Connection, events: Iterable[EventRow]) -> None:
    """Adds to the log."""
    connection.executemany(
        "INSERT INTO events (at, kind, text, line, record, who, message) VALUES (?, ?, ?, ?, ?, ?, ?)",
        ((*event, pack_message(event.text)) for event in events),
    )


def events(
    connection: sqlite3.Connection, search: str, limit: int, kinds: Collection[str] = ()
) -> tuple[EventRow, ...]:
    """The last events whose kind or text holds ``search``, newest first; no ``kinds``: of every kind."""
    rows = connection.execute(
        "SELECT at, kind, text, line, record, who, message FROM events"
        " WHERE (?1 = '' OR instr(lower(text), lower(?1)) OR instr(lower(kind), lower(?1)))"
        " AND (?2 = '[]' OR kind IN (SELECT value FROM json_each(?2)))"
        " ORDER BY id DESC LIMIT ?3",
        (search, json.dumps(sorted(kinds)), limit),
    )
    return tuple(map(_event, rows))


def _event(row: tuple[Any, ...]) -> EventRow:
    at, kind, text, *more, packed = row
    return EventRow(at, kind, unpack_message(packed, text), *more)


def setting(connection: sqlite3.Connection, key: str) -> object:
    """What was stored under ``key``, None: nothing, or it is not as it was stored."""
    row = row_sums.whole_row(connection, "settings", key)
    return json.loads(str(row_sums.readable(row)[1])) if row else None


def set_setting(connection: sqlite3.Connection, key: str, value: object) -> None:
    """Stores anything that JSON can hold; None forgets the key. Raises StoreError for what it cannot."""
    if value is None:
        connection.execute("DELETE FROM settings WHERE key = ?", (key,))
        return
    text = setting_text(key, value)
    connection.execute(
        "INSERT INTO settings VALUES (?, ?) ON CONFLICT (key) DO UPDATE SET value = excluded.value",
        (key, text),
    )


def setting_text(key: str, value: object) -> str:
    """As it is stored. Raises StoreError for what JSON cannot hold."""
    try:
        return json.dumps(value, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise StoreError(
            Message("the setting {key} cannot be stored: {error}", key=key, error=error), "unstorable-setting"
        ) from error


def events_between(
    connection: sqlite3.Connection, kinds: Collection[str], since: str, until: str
) -> tuple[EventRow, ...]:
    """Events of these kinds within this time (UTC), in their order."""
    rows = connection.execute(
        "SELECT at, kind, text, line, record, who, message FROM events WHERE at >= ?1 AND at < ?2"
        " AND kind IN (SELECT value FROM json_each(?3)) ORDER BY id",
        (since, until, json.dumps(sorted(kinds))),
    )
    return tuple(map(_event, rows))
