"""The alarm log, which F7 lists: alarms, E-stops and stops, newest first, with time, cause and remedy.

Those of today come from the executor's events, those of before from the store's log of events.
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
KINDS = frozenset({"alarm", "estop", "stop"})  # of events
_WRITTEN = re.compile(r"(\d{3}) (.*?): (.*)", re.DOTALL)
_BY_NUMBER: dict[int, Code] = {entry.number: code for code, entry in CATALOGUE.items()}


@dataclass(frozen=True, slots=True)
class LoggedStop:
    """One alarm or stop and when it came, as a wall clock shows it."""

    at: str
    alarm: Alarm
    record: str = ""  # of the seconds before it, for ``Recorder.alarm_record``; empty: there is none


class AlarmLog:
    """``hear`` may be called from the executor's thread, all else belongs to the screen's."""

    def __init__(self, clock: Callable[[], str]) -> None:
        self._clock = clock
        self._heard: deque[LoggedStop] = deque(maxlen=KEPT)
        self._entries: tuple[LoggedStop, ...] = ()

    def hear(self, event: Event) -> None:
        """Remember what stopped the machine; other events are none of this log."""
        if event.alarm is not None:
            self._heard.append(LoggedStop(self._clock(), event.alarm, event.record))

    def recall(self, rows: Iterable[EventRow]) -> None:
        """What the store has kept, newest first: it comes behind what was heard since."""
        kept = tuple(
            LoggedStop(wall_time(row.at, "%H:%M:%S"), alarm, row.record)
            for row in rows
            if (alarm := read_back(row)) is not None
        )
        self._entries = (*self.entries, *kept)[:KEPT]

    @property
    def entries(self) -> tuple[LoggedStop, ...]:
        """All of them, newest first."""
        new: list[LoggedStop] = []
        while self._heard:
            new.append(self._heard.popleft())
        if new:
            self._entries = (*reversed(new), *self._entries)[:KEPT]
        return self._entries


def read_back(row: EventRow) -> Alarm | None:
    """An alarm as it was written into the log; None for what is none, or has no number."""
    found = _WRITTEN.fullmatch(row.text) if row.kind in KINDS else None
    code = _BY_NUMBER.get(int(found[1])) if found is not None else None
    if found is None or code is None:
        return None
    cause = row.text.values.get("cause", found[3]) if isinstance(row.text, Message) else found[3]
    return make_alarm(code, str(cause), row.line, 0.0)
