"""Rows of setpoints in HAL: one stream plays, and the other receives replacement rows.

The change between the streams is requested some rows ahead of the servo thread. Without real-time priority,
the thread may have passed this row before it reads the request. The change is then requested at a later row.
This is possible while both streams contain the same rows, as they do at the start of a continued path.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

_NEVER = -1.0  # Row number that never occurs.
_PAST = 400  # Number of played rows that are stored.
_SAME = 1e-6  # Mm, and mm per revolution.
_MARGIN = 4  # Minimum rows between the request of a change and its row.


class Stream(Protocol):
    """Methods of ``hal.stream`` that the bridge uses."""

    @property
    def depth(self) -> int: ...
    @property
    def writable(self) -> bool: ...
    @property
    def readable(self) -> bool: ...
    def write(self, row: tuple[float, ...]) -> None: ...
    def read(self) -> object: ...


class Pins(Protocol):
    """Pins of a HAL component by name; bits are 0 and 1."""

    def __getitem__(self, name: str, /) -> float: ...
    def __setitem__(self, name: str, value: float, /) -> None: ...


Row = tuple[float, ...]
MakeRow = Callable[[float], Row]


class _Due(NamedTuple):
    """Written row with its due time and its values."""

    row: int
    t: float
    values: Row


class RowStreams:
    """Pair of streams that numbers the rows and recalls those that are not yet played."""

    def __init__(self, streams: tuple[Stream, Stream], pins: Pins) -> None:
        self._streams = streams
        self._pins = pins
        self._active = 0
        self._change: int | None = None  # Row at which the other stream takes over.
        self.last = 0  # Number of the last written row.
        self.last_t = 0.0  # Due time of the last written row in s.
        self.played = 0  # Number of the row that is played now.
        self.played_t = 0.0
        self._due: deque[_Due] = deque()
        self._past: deque[_Due] = deque(maxlen=_PAST)
        self._old: dict[int, Row] = {}  # Rows of the playing stream, from the change on.
        self._parts = 0  # First row from the change on that differs in the other stream.
        self._same_until = 0.0  # Seconds; until then both are the same path.
        pins["switch-at"] = _NEVER
        pins["play-b"] = 0

    @property
    def ahead(self) -> int:
        """The number of rows that are written but not yet played."""
        return self.last - self.played

    def write(self, t: float, values: tuple[float, ...]) -> bool:
        """Write one row that is due at ``t``; return False if the stream is full."""
        stream = self._streams[self._active if self._change is None else 1 - self._active]
        if not stream.writable:
            return False
        self.last += 1
        self.last_t = t
        stream.write((float(self.last), *values))
        self._due.append(_Due(self.last, t, values))
        return True

    def seen(self, row: int) -> float:
        """Record that the servo thread plays this row, and return its due time in seconds."""
        while self._due and self._due[0].row <= row:
            self._past.append(self._due.popleft())
            self.played, self.played_t = self._past[-1].row, self._past[-1].t
        return self.played_t

    def first_from(self, t: float) -> int | None:
        """Return the first row due at ``t`` or later that can be recalled, or None if it is too late."""
        soonest = self.played + _MARGIN
        for each in self._due:
            if each.t >= t - 1e-9:
                return each.row if each.row >= soonest else None
        return self.last + 1

    def plays_anyway(self, t: float, make: MakeRow) -> bool:
        """Return whether the rows that can no longer be recalled equal those of ``make`` from ``t`` on."""
        until = self.played + _MARGIN
        rows = [each for each in (*self._past, *self._due) if each.row <= until]
        return (
            bool(rows) and rows[0].t <= t and all(_same(e.values, make(e.t)) for e in rows if e.t >= t - 1e-9)
        )

    def soonest(self) -> float:
        """Return the due time in seconds from which rows can be recalled."""
        for each in self._due:
            if each.row >= self.played + _MARGIN + 1:
                return each.t
        return self.last_t

    @property
    def busy(self) -> bool:
        """Whether a pending change is too close to be modified."""
        return self._change is not None and self.played + _MARGIN >= self._change

    def recall(self, t: float, make: MakeRow, same_until: float = -math.inf) -> bool:
        """Replace all rows from ``t`` on; return False without a change if it is too late.

        Until ``same_until`` seconds, the replacement is the same path.
        """
        first = self.first_from(t)
        if first is None or self.busy:
            return False
        if self._change is not None:  # The pending change is included in this one.
            first, same_until = min(first, self._change), min(same_until, self._same_until)
            self._pins["switch-at"] = _NEVER
            self._drain(1 - self._active)
        if first <= self.last:
            self._begin(first, make, same_until)
        else:
            self._change = None
        return True

    def _begin(self, first: int, make: MakeRow, same_until: float) -> None:
        kept = self._old if self._change is not None else {each.row: each.values for each in self._due}
        between = {each.row: each.values for each in self._due if first <= each.row < (self._change or first)}
        self._old = {row: values for row, values in {**kept, **between}.items() if row >= first}
        self._due = deque([e if e.row < first else e._replace(values=make(e.t)) for e in self._due])
        others = (
            each.row
            for each in self._due
            if each.row >= first
            and (
                each.row not in self._old
                or (each.t >= same_until and not _same(each.values, self._old[each.row]))
            )
        )
        self._parts = next(others, self.last + 1)
        self._same_until = same_until
        self._ask(first)

    def _ask(self, first: int) -> None:
        """Request that the other stream takes over at this row."""
        idle = self._streams[1 - self._active]
        for each in self._due:
            if each.row >= first:
                idle.write((float(each.row), *each.values))
        self._change = first
        self._pins["play-b"] = 1 - self._active
        self._pins["switch-at"] = float(first - 1)

    def settle(self, plays_b: bool) -> bool:
        """Complete a change by the stream that plays; return False if this is not the requested stream."""
        plays = int(plays_b)
        if self._change is None or self.played < self._change:
            unasked = self._change is None and plays != self._active
            self._active = plays if unasked else self._active
            return not unasked
        changed = plays != self._active
        if not changed and self.played + _MARGIN < self._parts:
            self._pins["switch-at"] = _NEVER
            self._drain(1 - plays)
            self._ask(self.played + _MARGIN + 1)
            return True
        self._pins["switch-at"] = _NEVER
        self._change = None
        self._drain(1 - plays)
        self._active = plays
        return changed

    def _drain(self, which: int) -> None:
        stream = self._streams[which]
        while stream.readable:
            stream.read()


def _same(one: Row, other: Row) -> bool:
    return all(abs(a - b) <= _SAME for a, b in zip(one, other, strict=True))


class Sampler(Protocol):
    """Stream of samples from HAL, as ``hal.stream`` provides it."""

    @property
    def readable(self) -> bool: ...
    def read(self) -> Sequence[float]: ...
