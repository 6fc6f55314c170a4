"""Log of alarms, E-stops, other stops and notices, with causes and remedies, newest first (F7).

Entries of this session come from the executor's events. Older entries come from the store's event log.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from app.desk.status.formats import format_wall_time
from core.alarms import CATALOG, AlarmCode
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import Alarm, LogEvent
from core.message import Message
from core.store.store_rows import EventRow

MAX_ENTRIES = 500
LOGGED_KINDS = frozenset({"alarm", "estop", "stop", "notice"})  # Kinds of events that the log shows.
_LOG_TEXT = re.compile(r"(\d{3}) (.*?): (.*)", re.DOTALL)
_CODES_BY_NUMBER: dict[int, AlarmCode] = {entry.number: code for code, entry in CATALOG.items()}


@dataclass(frozen=True, slots=True)
class LoggedStop:
    """One alarm or stop, with its local time of day."""

    local_time: str
    alarm: Alarm
    recording_name: str = (
        ""  # Name of the recording for ``Recorder.open_alarm_record``, empty without a recording.
    )


class AlarmLog:
    """List of logged alarms and stops.

    The executor's thread may call ``hear``. Only the screen's thread may call the other methods.
    """

    def __init__(self, format_local_time: Callable[[], str]) -> None:
        self._clock = format_local_time
        self._heard: deque[LoggedStop] = deque(maxlen=MAX_ENTRIES)
        self._entries: tuple[LoggedStop, ...] = ()

    def hear(self, event: LogEvent) -> None:
        """Add the alarm of an event. Events without an alarm are ignored."""
        if event.alarm is not None:
            self._heard.append(LoggedStop(self._clock(), event.alarm, event.record_name))

    def add_stored_entries(self, log_rows: Iterable[EventRow]) -> None:
        """Append older entries from the store, newest first, to the entries of this session."""
        kept = tuple(
            LoggedStop(format_wall_time(row.at, "%H:%M:%S"), alarm, row.record)
            for row in log_rows
            if (alarm := parse_alarm(row)) is not None
        )
        self._entries = (*self.entries, *kept)[:MAX_ENTRIES]

    @property
    def entries(self) -> tuple[LoggedStop, ...]:
        """Return all entries, newest first."""
        new: list[LoggedStop] = []
        while self._heard:
            new.append(self._heard.popleft())
        if new:
            self._entries = (*reversed(new), *self._entries)[:MAX_ENTRIES]
        return self._entries


def parse_alarm(row: EventRow) -> Alarm | None:
    """Return the alarm of a log row, or None if the row does not contain an alarm with a known number."""
    found = _LOG_TEXT.fullmatch(row.text) if row.kind in LOGGED_KINDS else None
    code = _CODES_BY_NUMBER.get(int(found[1])) if found is not None else None
    if found is None or code is None:
        return None
    cause = row.text.values.get("cause", found[3]) if isinstance(row.text, Message) else found[3]
    return make_alarm(code, str(cause), row.line, 0.0)
