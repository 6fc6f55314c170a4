"""The log of alarms: every one that a snapshot has shown, newest first, with the time of day."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.executor.snapshot import Alarm

KEPT = 500


@dataclass(frozen=True, slots=True)
class Entry:
    """One alarm and when it came, as a wall clock shows it."""

    at: str
    alarm: Alarm


class AlarmLog:
    """Remembers alarms by number; seeing the same alarm again in the next snapshot is not another one."""

    def __init__(self, clock: Callable[[], str]) -> None:
        self._clock = clock
        self._last: tuple[Alarm, ...] = ()
        self.entries: tuple[Entry, ...] = ()

    def see(self, alarms: tuple[Alarm, ...]) -> bool:
        """Take the alarms of a snapshot; True when any of them is new."""
        if alarms == self._last:
            return False
        new = [alarm for alarm in alarms if alarm not in self._last]
        self._last = alarms
        at = self._clock()
        self.entries = (tuple(Entry(at, alarm) for alarm in reversed(new)) + self.entries)[:KEPT]
        return bool(new)
