"""The event log of the store."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, Any

from core.message import pack_message, unpack_message
from core.store.store_access import StoreAccess, WaitingEntries
from core.store.store_rows import EventRow, get_utc_now_text

if TYPE_CHECKING:
    from concurrent.futures import Future


def add_events(connection: sqlite3.Connection, events: Iterable[EventRow]) -> None:
    """Add events to the log."""
    connection.executemany(
        "INSERT INTO events (at, kind, text, line, record, who, message) VALUES (?, ?, ?, ?, ?, ?, ?)",
        ((*event, pack_message(event.text)) for event in events),
    )


def find_events(
    connection: sqlite3.Connection, search_text: str, limit: int, kinds: Collection[str] = ()
) -> tuple[EventRow, ...]:
    """Return the latest events whose kind or text contains ``search_text``, newest first.

    Case is ignored. If ``kinds`` is empty, events of all kinds are returned.
    """
    rows = connection.execute(
        "SELECT at, kind, text, line, record, who, message FROM events"
        " WHERE (?1 = '' OR instr(lower(text), lower(?1)) OR instr(lower(kind), lower(?1)))"
        " AND (?2 = '[]' OR kind IN (SELECT value FROM json_each(?2)))"
        " ORDER BY id DESC LIMIT ?3",
        (search_text, json.dumps(sorted(kinds)), limit),
    )
    return tuple(map(_event, rows))


def _event(row: tuple[Any, ...]) -> EventRow:
    at, kind, text, *more, packed = row
    return EventRow(at, kind, unpack_message(packed, text), *more)


def find_events_between(
    connection: sqlite3.Connection, kinds: Collection[str], since: str, until: str
) -> tuple[EventRow, ...]:
    """Return the events of these kinds from ``since`` to before ``until`` (UTC), oldest first."""
    rows = connection.execute(
        "SELECT at, kind, text, line, record, who, message FROM events WHERE at >= ?1 AND at < ?2"
        " AND kind IN (SELECT value FROM json_each(?3)) ORDER BY id",
        (since, until, json.dumps(sorted(kinds))),
    )
    return tuple(map(_event, rows))


class EventLog:
    """The event log of an open store. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess) -> None:
        self._store = store

    def read_events(
        self, search_text: str = "", limit: int = 100, kinds: Collection[str] = ()
    ) -> tuple[EventRow, ...]:
        """Return the latest events, newest first.

        ``search_text`` selects events whose kind or text contains this text, ignoring case. ``kinds`` selects
        events of these kinds; if it is empty, all kinds are selected.
        """
        return self._store.run_query(find_events, search_text, limit, kinds)

    def log_event(
        self, kind: str, text: str, line: int = 0, record: str = "", author: str = ""
    ) -> Future[None]:
        """Log an event with the current time. The event is not lost if the disk is full."""
        return self.log_events([EventRow(get_utc_now_text(), kind, text, line, record, author)])

    def log_events(self, events: Iterable[EventRow]) -> Future[None]:
        """Log several events with their own times. The events are not lost if the disk is full."""
        rows = tuple(events)

        def add_event_entries(unwritten: WaitingEntries) -> None:
            for row in rows:
                unwritten.add_event(row)

        return self._store.keep(add_event_entries)
