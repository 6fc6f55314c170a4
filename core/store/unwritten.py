"""What is still to be written: events, part counts, runs and settings, held until the disk takes them."""

from __future__ import annotations

import sqlite3
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from core.store import programs, records, runs
from core.store.errors import StoreError
from core.store.rows import EventRow, utc_now

EVENTS = 20_000  # more than a week of them; beyond that the oldest go, and how many is told
Operation = Callable[[sqlite3.Connection], object]


@dataclass(frozen=True, slots=True)
class Held:
    """How much waits in memory, and why."""

    why: str
    events: int = 0
    parts: int = 0
    others: int = 0
    dropped: int = 0  # events for which there was no room in memory either
    counts: Mapping[str, tuple[bool, int]] = field(
        default_factory=dict
    )  # by program: put to nought first, and so many more

    @property
    def words(self) -> str:
        """What would be lost if the control ended now."""
        counts = ((self.parts, "part"), (self.events, "event"), (self.others, "other entry"))
        found = [f"{count} {_many(name, count)}" for count, name in counts if count]
        return ", ".join(found) or "nothing"


class _Parts(NamedTuple):
    """Of one program: put to nought first, then so many more."""

    reset: bool = False
    more: int = 0
    last: str = ""


class _Cycles(NamedTuple):
    """Of one program: whole cycles, and their times in seconds."""

    made: int
    best: float
    latest: float


class Unwritten:
    """Takes what happens and writes all of it in one transaction. On the writer's thread alone.

    Counts add up and of settings only the last stays, so that what is held does not grow with the days.
    """

    def __init__(self) -> None:
        self._events: deque[EventRow] = deque()
        self._dropped = 0
        self._parts: dict[str, _Parts] = {}
        self._cycles: dict[str, _Cycles] = {}
        self._latest: dict[tuple[str, str], Operation] = {}

    def __bool__(self) -> bool:
        return bool(self._events or self._parts or self._cycles or self._latest or self._dropped)

    def event(self, row: EventRow) -> None:
        """One line of the log."""
        if len(self._events) >= EVENTS:
            self._events.popleft()
            self._dropped += 1
        self._events.append(row)

    def count_parts(self, program: str, by: int) -> None:
        """Parts made, or added and taken away by hand."""
        before = self._parts.get(program, _Parts())
        self._parts[program] = before._replace(more=before.more + by, last=utc_now())

    def reset_parts(self, program: str) -> None:
        """The count begins again at nought."""
        self._parts[program] = _Parts(reset=True, last=utc_now())

    def cycle(self, program: str, seconds: float) -> None:
        """One whole cycle and its time."""
        before = self._cycles.get(program, _Cycles(0, seconds, seconds))
        self._cycles[program] = _Cycles(before.made + 1, min(before.best, seconds), seconds)

    def latest(self, name: tuple[str, str], operation: Operation) -> None:
        """Of several under one name only the last counts."""
        self._latest.pop(name, None)  # what comes last is written last
        self._latest[name] = operation

    def held(self, why: str) -> Held:
        """How much there is of everything."""
        parts = sum(abs(each.more) for each in self._parts.values())
        others = len(self._latest) + len(self._cycles) + sum(each.reset for each in self._parts.values())
        counts = {program: (each.reset, each.more) for program, each in self._parts.items()}
        return Held(why, len(self._events), parts, others, self._dropped, counts)

    def write(self, connection: sqlite3.Connection) -> None:
        """Everything, inside the caller's transaction. What the store would never take is told in its log."""
        refused = [why for why in (_done(each, connection) for each in self._operations()) if why]
        if self._dropped:
            refused.append(f"{self._dropped} events had no room while nothing could be written")
        now = utc_now()
        records.log(connection, (*self._events, *(EventRow(now, "warning", why) for why in refused)))

    def clear(self) -> None:
        """All of it is on the disk."""
        self._events.clear()
        self._dropped = 0
        self._parts.clear()
        self._cycles.clear()
        self._latest.clear()

    def _operations(self) -> list[Operation]:
        return [
            *(_writing_parts(program, each) for program, each in self._parts.items()),
            *(_writing_cycles(program, each) for program, each in self._cycles.items()),
            *self._latest.values(),
        ]


def _done(operation: Operation, connection: sqlite3.Connection) -> str:
    """Why it can never be written; a disk that takes nothing now raises, and all of it is tried again."""
    try:
        operation(connection)
    except (StoreError, sqlite3.IntegrityError) as error:
        return f"not kept: {error}"
    return ""


def _writing_parts(program: str, parts: _Parts) -> Operation:
    def write(connection: sqlite3.Connection) -> None:
        if parts.reset:
            programs.reset_parts(connection, program)
        if parts.more:
            programs.add_parts(connection, program, parts.more, parts.last)

    return write


def _writing_cycles(program: str, cycles: _Cycles) -> Operation:
    return lambda connection: runs.finished(
        connection, program, cycles.latest, count=cycles.made, best=cycles.best
    )


def _many(name: str, count: int) -> str:
    if count == 1:
        return name
    return name.replace("entry", "entries") if name.endswith("entry") else f"{name}s"
