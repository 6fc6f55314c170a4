"""Rows of setpoints into HAL: one stream plays, the other takes what shall be played instead.

The change-over is asked for some rows ahead of the servo thread. On a computer without real-time priority
that may be past it when it is heard. Nothing is lost then as long as both streams have the same in their
rows, as a path that goes on has far beyond where it is handed over: the change is asked for further on.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

_NEVER = -1.0  # a row that does not come
_PAST = 400  # rows that were played and are still known
_SAME = 1e-6  # mm, mm a turn
_MARGIN = 4  # rows between the change being asked for and its row: the servo thread must not have passed it


class Stream(Protocol):
    """``hal.stream`` as far as it is used."""

    @property
    def depth(self) -> int: ...
    @property
    def writable(self) -> bool: ...
    @property
    def readable(self) -> bool: ...
    def write(self, row: tuple[float, ...]) -> None: ...
    def read(self) -> object: ...


class Pins(Protocol):
    """Pins of a HAL component by their names; bits are 0 and 1."""

    def __getitem__(self, name: str, /) -> float: ...
    def __setitem__(self, name: str, value: float, /) -> None: ...


Row = tuple[float, ...]
MakeRow = Callable[[float], Row]


class _Due(NamedTuple):
    """A row that was written: when it is due, and what is in it."""

    row: int
    t: float
    values: Row


class RowStreams:
    """Numbers rows, knows when each is due, and recalls those that are not yet played."""

    def __init__(self, streams: tuple[Stream, Stream], pins: Pins) -> None:
        self._streams = streams
        self._pins = pins
        self._active = 0
        self._change: int | None = None  # the row at which the other stream takes over
        self.last = 0  # number of the row written last
        self.last_t = 0.0  # s, when it is due
        self.played = 0  # number of the row that is played now, and when it was due
        self.played_t = 0.0
        self._due: deque[_Due] = deque()
        self._past: deque[_Due] = deque(maxlen=_PAST)
        self._old: dict[int, Row] = {}  # of the stream that plays, from the change on
        self._parts = 0  # the first row from there on that is another in the other stream
        self._same_until = 0.0  # s; before that both are the same path
        pins["switch-at"] = _NEVER
        pins["play-b"] = 0

    @property
    def ahead(self) -> int:
        """Rows written and not yet played."""
        return self.last - self.played

    def write(self, t: float, values: tuple[float, ...]) -> bool:
        """One more row, due at ``t``; False where the stream is full."""
        stream = self._streams[self._active if self._change is None else 1 - self._active]
        if not stream.writable:
            return False
        self.last += 1
        self.last_t = t
        stream.write((float(self.last), *values))
        self._due.append(_Due(self.last, t, values))
        return True

    def seen(self, row: int) -> float:
        """The servo thread plays this row; when it was due."""
        while self._due and self._due[0].row <= row:
            self._past.append(self._due.popleft())
            self.played, self.played_t = self._past[-1].row, self._past[-1].t
        return self.played_t

    def first_from(self, t: float) -> int | None:
        """The first row due at ``t`` or later that can still be recalled; None where it is too late."""
        soonest = self.played + _MARGIN
        for each in self._due:
            if each.t >= t - 1e-9:
                return each.row if each.row >= soonest else None
        return self.last + 1

    def plays_anyway(self, t: float, make: MakeRow) -> bool:
        """Whether what can no longer be recalled of ``t`` and later is what ``make`` has there."""
        until = self.played + _MARGIN
        rows = [each for each in (*self._past, *self._due) if each.row <= until]
        return (
            bool(rows) and rows[0].t <= t and all(_same(e.values, make(e.t)) for e in rows if e.t >= t - 1e-9)
        )

    def soonest(self) -> float:
        """From when on rows can still be recalled, s."""
        for each in self._due:
            if each.row >= self.played + _MARGIN + 1:
                return each.t
        return self.last_t

    @property
    def busy(self) -> bool:
        """Whether a change is too near to be made another one: wait for it."""
        return self._change is not None and self.played + _MARGIN >= self._change

    def recall(self, t: float, make: MakeRow, same_until: float = -math.inf) -> bool:
        """Make every row from ``t`` on anew; False where that comes too late, and nothing has changed.

        ``same_until``: what it replaces is the same path until then, s.
        """
        first = self.first_from(t)
        if first is None or self.busy:
            return False
        if self._change is not None:  # what it was to change is changed with this
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
        """The other stream takes over from this row on."""
        idle = self._streams[1 - self._active]
        for each in self._due:
            if each.row >= first:
                idle.write((float(each.row), *each.values))
        self._change = first
        self._pins["play-b"] = 1 - self._active
        self._pins["switch-at"] = float(first - 1)

    def settle(self, plays_b: bool) -> bool:
        """After a look at what is played: False where it is not what was asked for."""
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
    """``hal.stream`` of the sampler."""

    @property
    def readable(self) -> bool: ...
    def read(self) -> Sequence[float]: ...
