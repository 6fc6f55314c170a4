"""Rows of setpoints into HAL: one stream plays, the other takes what shall be played instead."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Protocol

_NEVER = -1.0  # a row that does not come
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


MakeRow = Callable[[float], tuple[float, ...]]


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
        self._due: deque[tuple[int, float]] = deque()
        pins["switch-at"] = _NEVER
        pins["play-b"] = 0

    @property
    def ahead(self) -> int:
        """Rows written and not yet played."""
        return self.last - self.played

    @property
    def changing(self) -> bool:
        """Whether a change to the other stream is under way."""
        return self._change is not None

    def write(self, t: float, values: tuple[float, ...]) -> bool:
        """One more row, due at ``t``; False where the stream is full."""
        stream = self._streams[self._active if self._change is None else 1 - self._active]
        if not stream.writable:
            return False
        self.last += 1
        self.last_t = t
        stream.write((float(self.last), *values))
        self._due.append((self.last, t))
        return True

    def seen(self, row: int) -> float:
        """The servo thread plays this row; when it was due."""
        while self._due and self._due[0][0] <= row:
            self.played, self.played_t = self._due.popleft()
        return self.played_t

    def first_from(self, t: float) -> int | None:
        """The first row due at ``t`` or later that can still be recalled; None where it is too late."""
        soonest = self.played + _MARGIN
        for row, due in self._due:
            if due >= t - 1e-9:
                return row if row >= soonest else None
        return self.last + 1

    def soonest(self) -> float:
        """From when on rows can still be recalled, s."""
        for row, due in self._due:
            if row >= self.played + _MARGIN + 1:
                return due
        return self.last_t

    @property
    def busy(self) -> bool:
        """Whether a change is too near to be made another one: wait for it."""
        return self._change is not None and self.played + _MARGIN >= self._change

    def recall(self, t: float, make: MakeRow) -> bool:
        """Make every row from ``t`` on anew; False where that comes too late, and nothing has changed."""
        first = self.first_from(t)
        if first is None or self.busy:
            return False
        if self._change is not None:  # what it was to change is changed with this
            first = min(first, self._change)
            self._pins["switch-at"] = _NEVER
            self._drain(1 - self._active)
            self._change = None
        if first <= self.last:
            self._begin(first, make)
        return True

    def _begin(self, first: int, make: MakeRow) -> None:
        idle = self._streams[1 - self._active]
        for row, due in self._due:
            if row >= first:
                idle.write((float(row), *make(due)))
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
        self._pins["switch-at"] = _NEVER
        self._change = None
        changed = plays != self._active
        self._drain(1 - plays)
        self._active = plays
        return changed

    def drained(self) -> bool:
        """Whether the stream that plays has nothing left."""
        return not self._streams[self._active].depth

    def _drain(self, which: int) -> None:
        stream = self._streams[which]
        while stream.readable:
            stream.read()
