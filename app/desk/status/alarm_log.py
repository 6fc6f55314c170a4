"""The alarm log, which F7 shows: alarms, E-stops and stops, newest first, with cause and remedy.

Entries of this session come from the executor's events. Older entries come from the store's event log.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from app.desk.status.formats import wall_time
from core.alarms import CATALOGUE, Code
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import Alarm, Event
from core.message import Message
from core.store.store_rows import EventRow

KEPT = 500
KINDS = frozenset({"alarm", "estop", "stop"})  # Kinds of events that the log shows.
_WRITTEN = re.compile(r"(\d{3}) (.*?): (.*)", re.DOTALL)
_BY_NUMBER: dict[int, Code] = {entry.number: code for code, entry in CATALOGUE.items()}


@dataclass(frozen=True, slots=True)
class LoggedStop:
    """One alarm or stop, with its local time of day."""

    at: str
    alarm: Alarm
    record: str = ""  # Name of the recording for ``Recorder.alarm_record``, empty without a recording.


class AlarmLog:
    """The list of logged alarms and stops.

    ``hear`` may be called from the executor's thread. All other methods belong to the screen's thread.
    """

    def __init__(self, clock: Callable[[], str]) -> None:
        self._clock = clock
        self._heard: deque[LoggedStop] = deque(maxlen=KEPT)
        self._entries: tuple[LoggedStop, ...] = ()

    def hear(self, event: Event) -> None:
        """Add the alarm of an event. Events without an alarm are ignored."""
        if event.alarm is not None:
            self._heard.append(LoggedStop(self._clock(), event.alarm, event.record))

    def recall(self, rows: Iterable[EventRow]) -> None:
        """Add older entries from the store, newest first, after the entries of this session."""
        kept = tuple(
            LoggedStop(wall_time(row.at, "%H:%M:%S"), alarm, row.record)
            for row in rows
            if (alarm := read_back(row)) is not None
        )
        self._entries = (*self.entries, *kept)[:KEPT]

    @property
    def entries(self) -> tuple[LoggedStop, ...]:
        """All entries, newest first."""
        new: list[LoggedStop] = []
        while self._heard:
            new.append(self._heard.popleft())
        if new:
            self._entries = (*reversed(new), *self._entries)[:KEPT]
        return self._entries


def read_back(row: EventRow) -> Alarm | None:
    """Return the alarm of a log row, or None if the row contains no alarm with a known number."""
    found = _WRITTEN.fullmatch(row.text) if row.kind in KINDS else None
    code = _BY_NUMBER.get(int(found[1])) if found is not None else None
    if found is None or code is None:
        return None
    cause = row.text.values.get("cause", found[3]) if isinstance(row.text, Message) else found[3]
    return make_alarm(code, str(cause), row.line, 0.0)
