"""Setpoint rows for HAL in two streams: HAL plays one, and the other receives replacement rows.

The bridge requests a change of streams at a row that the servo thread has not reached yet. Without
real-time priority, the thread may pass this row before it reads the request. The bridge then requests the
change for a later row. This is possible while both streams contain the same rows, as at the start of a path
that continues the old path.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

_NO_ROW = -1.0  # Row number that never occurs.
_MAX_PLAYED_ROWS = 400  # Number of played rows that are stored.
_SAME_TOLERANCE = 1e-6  # Mm, and mm per revolution.
_MARGIN = 4  # Minimum rows between the request of a change and its row.


class RowStream(Protocol):
    """Interface of LinuxCNC's ``hal.stream``, with the methods that the bridge uses."""

    @property
    def row_count(self) -> int:
        """Return the number of rows that are buffered in the stream."""
        ...

    @property
    def writable(self) -> bool:
        """Return whether the stream has space for another row."""
        ...

    @property
    def readable(self) -> bool:
        """Return whether the stream contains a row to read."""
        ...

    def write(self, row: tuple[float, ...]) -> None:
        """Write one row of setpoints to the stream."""
        ...

    def read(self) -> object:
        """Remove the oldest row from the stream and return it."""
        ...


class HalPins(Protocol):
    """The pins of a HAL component by name; bits are 0 and 1."""

    def __getitem__(self, name: str, /) -> float: ...
    def __setitem__(self, name: str, value: float, /) -> None: ...


SetpointRow = tuple[float, ...]
RowFunction = Callable[[float], SetpointRow]


class _PendingRow(NamedTuple):
    """A written row with its number, its due time and its values."""

    row_number: int
    due_time_s: float
    values: SetpointRow


class RowStreamPair:
    """Pair of setpoint streams, in which rows that HAL has not played yet can be replaced."""

    def __init__(self, streams: tuple[RowStream, RowStream], pins: HalPins) -> None:
        self._streams = streams
        self._pins = pins
        self._active = 0
        self._change: int | None = None  # Row at which the other stream takes over.
        self.last_row_number = 0  # Number of the last written row.
        self.last_row_due_s = 0.0  # Due time of the last written row in s.
        self.played_row_number = 0  # Number of the row that is played now.
        self.played_row_due_s = 0.0
        self._due: deque[_PendingRow] = deque()
        self._past: deque[_PendingRow] = deque(maxlen=_MAX_PLAYED_ROWS)
        self._old: dict[int, SetpointRow] = {}  # Rows of the playing stream, from the change on.
        self._parts = 0  # First row from the change on that differs in the other stream.
        self._same_until = 0.0  # Seconds; until then both are the same path.
        pins["switch-at"] = _NO_ROW
        pins["play-b"] = 0

    @property
    def pending_row_count(self) -> int:
        """Return the number of rows that have been written but not played yet."""
        return self.last_row_number - self.played_row_number

    def write_row(self, due_time_s: float, values: tuple[float, ...]) -> bool:
        """Write one row that is due at ``due_time_s``, and return False if the stream is full."""
        stream = self._streams[self._active if self._change is None else 1 - self._active]
        if not stream.writable:
            return False
        self.last_row_number += 1
        self.last_row_due_s = due_time_s
        stream.write((float(self.last_row_number), *values))
        self._due.append(_PendingRow(self.last_row_number, due_time_s, values))
        return True

    def record_played_row(self, row_number: int) -> float:
        """Record that the servo thread plays this row, and return its due time in seconds."""
        while self._due and self._due[0].row_number <= row_number:
            self._past.append(self._due.popleft())
            self.played_row_number, self.played_row_due_s = (
                self._past[-1].row_number,
                self._past[-1].due_time_s,
            )
        return self.played_row_due_s

    def find_first_recallable_row(self, time_s: float) -> int | None:
        """Return the first row due at ``time_s`` or later, or None if it can no longer be recalled.

        ``time_s`` is in seconds.
        """
        soonest = self.played_row_number + _MARGIN
        for each in self._due:
            if each.due_time_s >= time_s - 1e-9:
                return each.row_number if each.row_number >= soonest else None
        return self.last_row_number + 1

    def has_same_locked_rows(self, time_s: float, make_row: RowFunction) -> bool:
        """Return whether the rows that can no longer be recalled equal those of ``make_row``.

        Only the rows from ``time_s`` on are compared.
        """
        until = self.played_row_number + _MARGIN
        rows = [each for each in (*self._past, *self._due) if each.row_number <= until]
        return (
            bool(rows)
            and rows[0].due_time_s <= time_s
            and all(_same(e.values, make_row(e.due_time_s)) for e in rows if e.due_time_s >= time_s - 1e-9)
        )

    def find_earliest_recall_time(self) -> float:
        """Return the due time in seconds from which rows can be recalled."""
        for each in self._due:
            if each.row_number >= self.played_row_number + _MARGIN + 1:
                return each.due_time_s
        return self.last_row_due_s

    @property
    def is_change_locked(self) -> bool:
        """Return whether HAL is about to change streams, so that the request can no longer be modified."""
        return self._change is not None and self.played_row_number + _MARGIN >= self._change

    def recall_rows(self, time_s: float, make_row: RowFunction, unchanged_until: float = -math.inf) -> bool:
        """Replace all rows due from ``time_s`` on, and return whether this was possible.

        If it is too late, nothing is changed. Until ``unchanged_until``, a time in seconds, the replacement
        follows the same path.
        """
        first = self.find_first_recallable_row(time_s)
        if first is None or self.is_change_locked:
            return False
        if self._change is not None:  # The pending change is included in this one.
            first, unchanged_until = min(first, self._change), min(unchanged_until, self._same_until)
            self._pins["switch-at"] = _NO_ROW
            self._drain(1 - self._active)
        if first <= self.last_row_number:
            self._begin(first, make_row, unchanged_until)
        else:
            self._change = None
        return True

    def _begin(self, first: int, make: RowFunction, same_until: float) -> None:
        kept = self._old if self._change is not None else {each.row_number: each.values for each in self._due}
        between = {
            each.row_number: each.values
            for each in self._due
            if first <= each.row_number < (self._change or first)
        }
        self._old = {row: values for row, values in {**kept, **between}.items() if row >= first}
        self._due = deque(
            [e if e.row_number < first else e._replace(values=make(e.due_time_s)) for e in self._due]
        )
        others = (
            each.row_number
            for each in self._due
            if each.row_number >= first
            and (
                each.row_number not in self._old
                or (each.due_time_s >= same_until and not _same(each.values, self._old[each.row_number]))
            )
        )
        self._parts = next(others, self.last_row_number + 1)
        self._same_until = same_until
        self._request_change(first)

    def _request_change(self, first: int) -> None:
        """Request that the other stream is played from row ``first`` on."""
        idle = self._streams[1 - self._active]
        for each in self._due:
            if each.row_number >= first:
                idle.write((float(each.row_number), *each.values))
        self._change = first
        self._pins["play-b"] = 1 - self._active
        self._pins["switch-at"] = float(first - 1)

    def finish_stream_change(self, is_second_playing: bool) -> bool:
        """Complete a requested change of streams, based on the stream that HAL plays.

        Returns False if HAL does not play the expected stream.
        """
        plays = int(is_second_playing)
        if self._change is None or self.played_row_number < self._change:
            unasked = self._change is None and plays != self._active
            self._active = plays if unasked else self._active
            return not unasked
        changed = plays != self._active
        if not changed and self.played_row_number + _MARGIN < self._parts:
            self._pins["switch-at"] = _NO_ROW
            self._drain(1 - plays)
            self._request_change(self.played_row_number + _MARGIN + 1)
            return True
        self._pins["switch-at"] = _NO_ROW
        self._change = None
        self._drain(1 - plays)
        self._active = plays
        return changed

    def _drain(self, which: int) -> None:
        stream = self._streams[which]
        while stream.readable:
            stream.read()


def _same(one: SetpointRow, other: SetpointRow) -> bool:
    return all(abs(a - b) <= _SAME_TOLERANCE for a, b in zip(one, other, strict=True))


class SampleStream(Protocol):
    """A stream of samples from HAL, as ``hal.stream`` provides it."""

    @property
    def readable(self) -> bool:
        """Return whether the stream contains a sample to read."""
        ...

    def read(self) -> Sequence[float]:
        """Remove the oldest sample from the stream and return it."""
        ...
