"""Curves of the scope, prepared on a worker from a record or from live samples.

Both sources produce a ``Sight``: arrays that are ready to draw, in the displayed units. Live curves are
extended by the samples since the last picture only.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.scope.signals import Quantity, Signal
from app.scope.time_window import Trigger
from core.executor.snapshot import State
from core.records.record import Channel, Record

IntArray = npt.NDArray[np.int64]
DENSE = 2.0  # number of samples per column above which columns are drawn instead of samples


@dataclass(frozen=True, slots=True)
class Points:
    """Points of a curve. ``times`` are seconds of the record's clock.

    If ``pairs`` is set, each two points are one line. Otherwise ``joined`` marks the points that are
    connected to the next point.
    """

    times: FloatArray
    values: FloatArray
    pairs: bool = False
    joined: npt.NDArray[np.bool_] | None = None  # None: all points are connected


@dataclass(slots=True)
class Columns:
    """Minimum and maximum per column. Column n of ``numbers`` starts at n · ``width`` seconds."""

    width: float
    numbers: IntArray
    least: FloatArray
    greatest: FloatArray
    entries: FloatArray  # sample before each column, or nan after a gap
    last: float = np.nan  # sample before the next one

    @classmethod
    def none(cls, width: float) -> Columns:
        """Return an empty set of columns of a width in seconds."""
        nothing = np.empty(0)
        return cls(width, np.empty(0, dtype=np.int64), nothing, nothing, nothing)

    def append(self, times: FloatArray, values: FloatArray) -> None:
        """Append samples that are later than all earlier samples.

        Values that are not finite leave a gap.
        """
        if not len(values):
            return
        last, self.last = self.last, float(values[-1])
        told = np.flatnonzero(np.isfinite(values))
        if not len(told):
            return
        times, values = times[told], values[told]
        of = np.floor(times / self.width).astype(np.int64)
        first = np.flatnonzero(np.diff(of, prepend=of[0] - 1))
        numbers = of[first]
        low, high = np.minimum.reduceat(values, first), np.maximum.reduceat(values, first)
        behind = first[1:] - 1
        joined = np.where(told[first[1:]] == told[behind] + 1, values[behind], np.nan)
        before = np.concatenate([[last if told[0] == 0 else np.nan], joined])
        np.fmin(low, before, out=low)
        np.fmax(high, before, out=high)
        if len(self.numbers) and self.numbers[-1] == numbers[0]:
            self.least[-1], self.greatest[-1] = (
                min(self.least[-1], low[0]),
                max(self.greatest[-1], high[0]),
            )
            numbers, low, high, before = numbers[1:], low[1:], high[1:], before[1:]
        self.numbers = np.concatenate([self.numbers, numbers])
        self.least = np.concatenate([self.least, low])
        self.greatest = np.concatenate([self.greatest, high])
        self.entries = np.concatenate([self.entries, before])

    def forget(self, before: float) -> None:
        """Remove the columns that ended before a time in seconds."""
        cut = int(np.searchsorted(self.numbers, int(np.floor(before / self.width))))
        self.numbers, self.entries = self.numbers[cut:], self.entries[cut:]
        self.least, self.greatest = self.least[cut:], self.greatest[cut:]

    def points(self) -> Points:
        """Return one vertical line per column, and a horizontal line over each gap in a connected curve."""
        at = (self.numbers + 0.5) * self.width
        later = 1 + np.flatnonzero((np.diff(self.numbers) > 1) & np.isfinite(self.entries[1:]))
        n = len(at)
        times, values = np.empty(2 * (n + len(later))), np.empty(2 * (n + len(later)))
        times[0 : 2 * n : 2] = times[1 : 2 * n : 2] = at
        values[0 : 2 * n : 2], values[1 : 2 * n : 2] = self.least, self.greatest
        times[2 * n :: 2], times[2 * n + 1 :: 2] = at[later - 1], at[later]
        values[2 * n :: 2] = values[2 * n + 1 :: 2] = self.entries[later]
        return Points(times, values, pairs=True)


def points_of(times: FloatArray, values: FloatArray, width: float) -> Points:
    """Return the points to draw for samples, at a pixel width of ``width`` seconds."""
    if len(times) < 2 or len(times) < DENSE * (times[-1] - times[0]) / width:
        told = np.flatnonzero(np.isfinite(values))
        if len(told) == len(values):
            return Points(times, values)
        return Points(times[told], values[told], joined=np.diff(told, append=told[-1:] + 2) == 1)
    columns = Columns.none(width)
    columns.append(times, values)
    return columns.points()


# --- range of a lane ------------------------------------------------------------------------------------

_EDGE = 0.01
_ROUND = (1.0, 2.0, 2.5, 5.0, 10.0)


def round_range(low: float, high: float, least: float) -> tuple[float, float]:
    """Return a range with round limits around two values, at least ``least`` wide and with a margin."""
    middle, wide = 0.5 * (low + high), max(1.08 * (high - low), least)
    power = 10.0 ** np.floor(np.log10(wide / 4.0))
    step = float(next(power * each for each in _ROUND if power * each >= wide / 4.0 - 1e-12))
    bottom, top = np.floor((middle - wide / 2.0) / step) * step, np.ceil((middle + wide / 2.0) / step) * step
    return float(bottom), float(top)


def kept_range(
    before: tuple[float, float] | None, low: float, high: float, least: float
) -> tuple[float, float]:
    """Return the present range while the curve is inside and fills a quarter. Otherwise return a new range.

    This prevents frequent small changes of the scale.
    """
    if before is not None:
        wide = before[1] - before[0]
        edge = _EDGE * wide  # A curve exactly on the edge would be half hidden.
        inside = before[0] + edge <= low and high <= before[1] - edge
        if inside and (4.0 * (high - low) >= wide or wide <= 4.0 * least):
            return before
    return round_range(low, high, least)


FloatArray = npt.NDArray[np.float64]
Range = tuple[float, float]
GAP = 0.02  # seconds that a query starts earlier than derived signals need
_REST = 0.25  # seconds; a machine at rest is sampled every 0.1 s
ALARMED = (State.FAULT.value, State.ESTOP.value)


class LiveSamples(Protocol):
    """Ring buffer of the samples of the last minutes; readable from any thread."""

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Recorded channels."""
        ...

    @property
    def last(self) -> float:
        """Time of the newest sample in seconds of the monotonic clock, or minus infinity without samples."""
        ...

    @property
    def lasts(self) -> float:
        """Length of the ring buffer in seconds."""
        ...

    def between(self, begin: float, end: float, names: Collection[str] | None = None) -> Record:
        """Return the samples from ``begin`` to ``end`` inclusive.

        ``names`` restricts the channels.
        """
        ...


@dataclass(frozen=True, slots=True)
class Curve:
    """Curve of one signal in displayed units.

    ``latest`` is the newest value, or nan without a value.
    """

    signal: Signal
    points: Points
    latest: float = np.nan


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """Prepared picture of the scope. Times of curves and window are seconds relative to ``zero``.

    ``ranges`` are the ranges of the lanes in displayed units. ``at`` contains the values at both cursors by
    signal.
    """

    curves: tuple[Curve, ...] = ()
    earlier: tuple[Curve, ...] = ()  # curves of the overlaid record
    begin: float = -1.0
    end: float = 0.0
    zero: float = 0.0
    rate: float = 0.0
    live: bool = True
    metric: bool = False
    ranges: Mapping[Quantity, Range] = field(default_factory=dict)
    at: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    released: float | None = None  # trigger time in seconds of the clock
    level: tuple[float, ...] | None = None  # values of live curves if all are constant


@dataclass(frozen=True, slots=True)
class Wanted:
    """Request for a picture: signals, time window, width in pixels and units.

    ``begin`` and ``end`` are relative to ``zero`` of a record, or to the newest sample when live.
    """

    signals: tuple[Signal, ...]
    begin: float
    end: float
    pixels: int
    metric: bool
    trigger: Trigger = field(default_factory=Trigger)
    cursors: tuple[float, float] | None = None
    ranges: Mapping[Quantity, Range] = field(default_factory=dict)  # ranges that the user has set
    armed: float = -np.inf  # time of the newest sample when the trigger was armed

    @property
    def span(self) -> float:
        """Width of the window in seconds."""
        return self.end - self.begin

    @property
    def width(self) -> float:
        """Duration of one pixel in seconds."""
        return self.span / max(1, self.pixels)


def shown(points: Points, scale: float, zero: float) -> Points:
    """Return the points in displayed units, with times relative to ``zero``."""
    return Points(points.times - zero, points.values * scale, points.pairs, points.joined)


def ranges_of(
    curves: Sequence[Curve], before: Mapping[Quantity, Range], wanted: Wanted
) -> dict[Quantity, Range]:
    """Return the range of each lane: the range that the user has set, or one that contains the curves."""
    found: dict[Quantity, Range] = {}
    for quantity in dict.fromkeys(each.signal.quantity for each in curves):
        chosen = wanted.ranges.get(quantity)
        values = [each.points.values for each in curves if each.signal.quantity is quantity]
        values = [each for each in values if len(each)]
        if chosen is not None:
            found[quantity] = chosen
        elif not values:
            found[quantity] = before.get(quantity, (0.0, 1.0))
        else:
            low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
            least = quantity.least * quantity.scale(wanted.metric)
            found[quantity] = kept_range(before.get(quantity), low, high, least)
    return found


def level_of(curves: Sequence[Curve], begin: float, width: float) -> tuple[float, ...] | None:
    """Return the values of the curves if all are constant across the window, else None.

    An empty curve has the value nan. A picture of constant curves does not change while it scrolls.
    """
    levels = []
    for curve in curves:
        times, values = curve.points.times, curve.points.values
        if not len(values):
            levels.append(np.nan)
        elif times[0] <= begin + max(_REST, 2.0 * width) and values.min() == values.max():
            levels.append(float(values[0]))
        else:
            return None
    return tuple(levels)


# --- record ---------------------------------------------------------------------------------------------


@dataclass(slots=True, eq=False)
class RecordCurves:
    """Curves of one record, with cached derived columns.

    ``zero`` is the instant 0 on the record's clock.
    """

    record: Record
    zero: float
    _columns: dict[str, FloatArray] = field(default_factory=dict)
    _ranges: Mapping[Quantity, Range] = field(default_factory=dict)
    _metric: bool | None = None

    def column(self, signal: Signal) -> FloatArray | None:
        """Return all values of a signal in internal units, or None if the record does not contain it."""
        source = self.record.columns.get(signal.channel)
        if source is None:
            return None
        if signal.key not in self._columns:
            self._columns[signal.key] = signal.values(self.record.times, source)
        return self._columns[signal.key]

    def curves(self, wanted: Wanted) -> tuple[Curve, ...]:
        """Return the curves of the window."""
        times = self.record.times
        begin, end = self.zero + wanted.begin, self.zero + wanted.end
        first = max(0, int(np.searchsorted(times, begin)) - 1)
        last = int(np.searchsorted(times, end, side="right")) + 1
        found = []
        for signal in wanted.signals:
            column = self.column(signal)
            if column is not None:
                points = points_of(times[first:last], column[first:last], wanted.width)
                scale = signal.quantity.scale(wanted.metric)
                found.append(Curve(signal, shown(points, scale, self.zero)))
        return tuple(found)

    def sight(self, wanted: Wanted, overlay: RecordCurves | None = None) -> Sight:
        """Return the picture of a window, with an overlaid record aligned at its own instant 0."""
        curves = self.curves(wanted)
        earlier = overlay.curves(wanted) if overlay is not None else ()
        if self._metric is not wanted.metric:
            self._ranges, self._metric = {}, wanted.metric
        ranges = ranges_of((*curves, *earlier), self._ranges, wanted)
        self._ranges = ranges
        at = {}
        if wanted.cursors is not None:
            for signal in wanted.signals:
                at[signal.key] = self._at(signal, wanted.cursors, wanted.metric)
        return Sight(
            curves,
            earlier,
            wanted.begin,
            wanted.end,
            self.zero,
            self.record.rate,
            False,
            wanted.metric,
            ranges,
            at,
        )

    def _at(self, signal: Signal, cursors: tuple[float, float], metric: bool) -> tuple[float, float]:
        """Return the values of the samples nearest to both cursors, or nan outside the record."""
        column, times = self.column(signal), self.record.times
        if column is None or not len(times):
            return np.nan, np.nan
        scale, values = signal.quantity.scale(metric), []
        for cursor in cursors:
            when = self.zero + cursor
            i = int(np.searchsorted(times, when))
            if i > 0 and (i == len(times) or when - times[i - 1] <= times[i] - when):
                i -= 1
            one = 1.0 / max(self.record.rate, 1.0)
            outside = not times[0] - one <= when <= times[-1] + one
            values.append(np.nan if outside else float(column[i]) * scale)
        return values[0], values[1]


# --- live -----------------------------------------------------------------------------------------------


@dataclass(slots=True, eq=False)
class LiveCurves:
    """Live curves that are extended with each picture, and restarted when window, size or signals change."""

    source: LiveSamples
    _of: object = None
    _columns: dict[str, Columns] = field(default_factory=dict)
    _done: dict[str, float] = field(default_factory=dict)
    _latest: dict[str, float] = field(default_factory=dict)
    _ranges: Mapping[Quantity, Range] = field(default_factory=dict)
    _watched: float = np.nan  # time up to which the trigger has examined the samples
    _trigger: tuple[Trigger, float] | None = None  # the trigger and its arming time

    def sight(self, wanted: Wanted, overlay: RecordCurves | None = None) -> Sight:
        """Return the picture of the last seconds up to the newest sample."""
        newest = self.source.last
        width = wanted.width
        known = (wanted.signals, wanted.span, wanted.pixels, wanted.metric)
        if known != self._of or not np.isfinite(newest):
            self._of = known
            self._columns = {each.key: Columns.none(width) for each in wanted.signals}
            self._done, self._latest = {}, {}
            self._ranges = {}
        if not np.isfinite(newest):
            return Sight(begin=-wanted.span, end=0.0, metric=wanted.metric)
        end = np.ceil(newest / width) * width  # Partial columns would make the curve flicker.
        rate = self._carry_on(wanted, newest)
        curves = []
        for signal in wanted.signals:
            columns = self._columns[signal.key]
            columns.forget(end - wanted.span - width)
            scale = signal.quantity.scale(wanted.metric)
            latest = self._latest.get(signal.key, np.nan) * scale
            curves.append(Curve(signal, shown(columns.points(), scale, end), latest))
        earlier = overlay.curves(wanted) if overlay is not None else ()
        self._ranges = ranges_of((*curves, *earlier), self._ranges, wanted)
        released = self._released(wanted, newest)
        begin = -wanted.span
        return Sight(
            tuple(curves),
            earlier,
            begin,
            0.0,
            end,
            rate,
            True,
            wanted.metric,
            self._ranges,
            {},
            released,
            None if earlier else level_of(curves, begin, wanted.width),
        )

    def _carry_on(self, wanted: Wanted, newest: float) -> float:
        """Add the new samples to the columns, and return the sample rate."""
        start = newest - wanted.span
        back = max((each.span for each in wanted.signals), default=0.0) + GAP
        done = min((self._done.get(each.key, start) for each in wanted.signals), default=start)
        names = {each.channel for each in wanted.signals}
        record = self.source.between(max(done, start) - back, newest, names)
        times = record.times
        for signal in wanted.signals:
            source = record.columns.get(signal.channel)
            if source is None or not len(times):
                continue
            values = signal.values(times, source)
            sure = float(times[-1]) - 0.5 * signal.span if signal.span else float(times[-1])
            first, last = np.searchsorted(times, (self._done.get(signal.key, start), sure), side="right")
            if signal.span:
                told = np.flatnonzero(np.isfinite(values[first:last]))
                last = first + (told[-1] + 1 if len(told) else 0)
            if last > first:
                self._columns[signal.key].append(times[first:last], values[first:last])
                self._done[signal.key] = float(times[last - 1])
                self._latest[signal.key] = float(values[last - 1])
        return record.rate

    def _released(self, wanted: Wanted, newest: float) -> float | None:
        """Return the time at which new samples fired the trigger, or None.

        Samples from before the trigger was armed are ignored.
        """
        trigger = wanted.trigger
        if (trigger, wanted.armed) != self._trigger:
            self._trigger = trigger, wanted.armed
            self._watched = wanted.armed if np.isfinite(wanted.armed) else newest
        name = trigger.wants
        if not name:
            return None
        signal = next((each for each in wanted.signals if each.key == name), None)
        channel, back = (signal.channel, signal.span) if signal is not None else (name, 0.0)
        record = self.source.between(self._watched - back - GAP, newest, {channel})
        column = record.columns.get(channel)
        if column is None or len(record.times) < 2:
            return None
        values = signal.values(record.times, column) if signal is not None else column
        told = np.flatnonzero(np.isfinite(values))
        if not len(told):
            return None
        first = max(0, int(np.searchsorted(record.times, self._watched)) - 1)
        cut = slice(first, int(told[-1]) + 1)
        self._watched = max(self._watched, float(record.times[told[-1]]))
        return trigger.released(record.times[cut], values[cut], alarmed_of(record))


def alarmed_of(record: Record) -> frozenset[int]:
    """Return the values of the channel ``state`` that mean an alarm or an E-stop."""
    words = record.about.get("states", "").split("|")
    return frozenset(i for i, word in enumerate(words) if word in ALARMED)
