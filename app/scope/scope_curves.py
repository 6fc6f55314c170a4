"""Curves of the scope, prepared on a worker from a record or from live samples.

Both sources produce a ``ScopePicture``, whose arrays are ready to draw and in the displayed units. Live
curves are extended only by the samples since the last picture.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from app.scope.curve_points import CurveColumns, CurvePoints, FloatArray, make_curve_points, update_range
from app.scope.signals import Quantity, ScopeSignal
from app.scope.time_window import Trigger
from core.executor.snapshot import MachineState
from core.records.record import Channel, ScopeRecord

ValueRange = tuple[float, float]
QUERY_LEAD_S = 0.02  # seconds that a query starts earlier than derived signals need
_REST_INTERVAL_S = 0.25  # seconds; a machine at rest is sampled every 0.1 s
ALARM_STATES = (MachineState.FAULT.value, MachineState.ESTOP.value)


class LiveSamples(Protocol):
    """Ring buffer of the samples of the last few minutes, which any thread can read."""

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Return the recorded channels."""
        ...

    @property
    def newest_time_s(self) -> float:
        """Return the time of the newest sample in seconds of the monotonic clock.

        Return minus infinity if there are no samples.
        """
        ...

    @property
    def buffer_duration_s(self) -> float:
        """Return the length of the ring buffer in seconds."""
        ...

    def read_samples_between(
        self, start_s: float, end_s: float, channel_names: Collection[str] | None = None
    ) -> ScopeRecord:
        """Return the samples from ``start_s`` to ``end_s``, both included.

        ``channel_names`` restricts the channels.
        """
        ...


@dataclass(frozen=True, slots=True)
class ScopeCurve:
    """Curve of one signal in displayed units.

    ``latest_value`` is the newest value, or NaN if there is no value.
    """

    signal: ScopeSignal
    points: CurvePoints
    latest_value: float = np.nan


@dataclass(frozen=True, slots=True, eq=False)
class ScopePicture:
    """Prepared picture of the scope, with times relative to ``zero_s``, in seconds.

    ``lane_ranges`` are the ranges of the lanes in displayed units. ``cursor_values`` contains the values at
    both cursors by signal.
    """

    curves: tuple[ScopeCurve, ...] = ()
    overlay_curves: tuple[ScopeCurve, ...] = ()  # curves of the overlaid record
    begin_s: float = -1.0
    end_s: float = 0.0
    zero_time_s: float = 0.0
    sample_rate_hz: float = 0.0
    is_live: bool = True
    is_metric: bool = False
    lane_ranges: Mapping[Quantity, ValueRange] = field(default_factory=dict)
    cursor_values: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    trigger_time_s: float | None = None  # trigger time in seconds of the clock
    constant_values: tuple[float, ...] | None = None  # values of live curves if all are constant


@dataclass(frozen=True, slots=True)
class PictureRequest:
    """Request for a picture: signals, time window, width in pixels and units.

    ``begin`` and ``end`` are in seconds, relative to the zero time of a record or, if the curves are live,
    to the newest sample.
    """

    signals: tuple[ScopeSignal, ...]
    begin: float
    end: float
    width_px: int
    metric: bool
    trigger: Trigger = field(default_factory=Trigger)
    cursors: tuple[float, float] | None = None
    ranges: Mapping[Quantity, ValueRange] = field(default_factory=dict)  # ranges that the user has set
    armed: float = -np.inf  # time of the newest sample when the trigger was armed

    @property
    def window_span_s(self) -> float:
        """Return the width of the window in seconds."""
        return self.end - self.begin

    @property
    def width(self) -> float:
        """Return the width of one pixel in seconds."""
        return self.window_span_s / max(1, self.width_px)


def convert_to_display_units(points: CurvePoints, scale: float, zero_s: float) -> CurvePoints:
    """Return the points in displayed units, with times relative to ``zero_s``."""
    return CurvePoints(
        points.times_s - zero_s, points.values * scale, points.has_line_pairs, points.is_joined_to_next
    )


def find_lane_ranges(
    curves: Sequence[ScopeCurve], present_ranges: Mapping[Quantity, ValueRange], request: PictureRequest
) -> dict[Quantity, ValueRange]:
    """Return the vertical range of each lane.

    This is the range that the user has set, or a range that contains the curves.
    """
    found: dict[Quantity, ValueRange] = {}
    for quantity in dict.fromkeys(each.signal.quantity for each in curves):
        chosen = request.ranges.get(quantity)
        values = [each.points.values for each in curves if each.signal.quantity is quantity]
        values = [each for each in values if len(each)]
        if chosen is not None:
            found[quantity] = chosen
        elif not values:
            found[quantity] = present_ranges.get(quantity, (0.0, 1.0))
        else:
            low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
            least = quantity.smallest_range * quantity.find_display_scale(request.metric)
            found[quantity] = update_range(present_ranges.get(quantity), low, high, least)
    return found


def find_constant_values(
    curves: Sequence[ScopeCurve], begin_s: float, pixel_width_s: float
) -> tuple[float, ...] | None:
    """Return the values of the curves if each curve is constant across the window, or None otherwise.

    An empty curve has the value NaN. A picture of constant curves does not change while it scrolls.
    """
    levels = []
    for curve in curves:
        times, values = curve.points.times_s, curve.points.values
        if not len(values):
            levels.append(np.nan)
        elif (
            times[0] <= begin_s + max(_REST_INTERVAL_S, 2.0 * pixel_width_s) and values.min() == values.max()
        ):
            levels.append(float(values[0]))
        else:
            return None
    return tuple(levels)


# --- record ---------------------------------------------------------------------------------------------


@dataclass(slots=True, eq=False)
class RecordingCurves:
    """Curves of one record, with a cache of derived signal values.

    ``zero_s`` is the zero time of the record, in seconds of its clock.
    """

    record: ScopeRecord
    zero_time_s: float
    _columns: dict[str, FloatArray] = field(default_factory=dict)
    _ranges: Mapping[Quantity, ValueRange] = field(default_factory=dict)
    _metric: bool | None = None

    def read_signal_values(self, signal: ScopeSignal) -> FloatArray | None:
        """Return all values of a signal in internal units, or None if it is not in the record."""
        source = self.record.values_by_channel.get(signal.channel_name)
        if source is None:
            return None
        if signal.key not in self._columns:
            self._columns[signal.key] = signal.calculate_values(self.record.times_s, source)
        return self._columns[signal.key]

    def make_curves(self, request: PictureRequest) -> tuple[ScopeCurve, ...]:
        """Return the curves of the window."""
        times = self.record.times_s
        begin, end = self.zero_time_s + request.begin, self.zero_time_s + request.end
        first = max(0, int(np.searchsorted(times, begin)) - 1)
        last = int(np.searchsorted(times, end, side="right")) + 1
        found = []
        for signal in request.signals:
            column = self.read_signal_values(signal)
            if column is not None:
                points = make_curve_points(times[first:last], column[first:last], request.width)
                scale = signal.quantity.find_display_scale(request.metric)
                found.append(ScopeCurve(signal, convert_to_display_units(points, scale, self.zero_time_s)))
        return tuple(found)

    def make_picture(self, request: PictureRequest, overlay: RecordingCurves | None = None) -> ScopePicture:
        """Return the picture of a time window.

        An overlaid record is shifted so that the zero times of both records coincide.
        """
        curves = self.make_curves(request)
        earlier = overlay.make_curves(request) if overlay is not None else ()
        if self._metric is not request.metric:
            self._ranges, self._metric = {}, request.metric
        ranges = find_lane_ranges((*curves, *earlier), self._ranges, request)
        self._ranges = ranges
        at = {}
        if request.cursors is not None:
            for signal in request.signals:
                at[signal.key] = self._find_cursor_values(signal, request.cursors, request.metric)
        return ScopePicture(
            curves,
            earlier,
            request.begin,
            request.end,
            self.zero_time_s,
            self.record.sampling_rate_hz,
            False,
            request.metric,
            ranges,
            at,
        )

    def _find_cursor_values(
        self, signal: ScopeSignal, cursors: tuple[float, float], metric: bool
    ) -> tuple[float, float]:
        """Return the values of the curves at the samples nearest to the two cursors.

        If a cursor is outside the recorded time, its values are NaN.
        """
        column, times = self.read_signal_values(signal), self.record.times_s
        if column is None or not len(times):
            return np.nan, np.nan
        scale, values = signal.quantity.find_display_scale(metric), []
        for cursor in cursors:
            when = self.zero_time_s + cursor
            i = int(np.searchsorted(times, when))
            if i > 0 and (i == len(times) or when - times[i - 1] <= times[i] - when):
                i -= 1
            one = 1.0 / max(self.record.sampling_rate_hz, 1.0)
            outside = not times[0] - one <= when <= times[-1] + one
            values.append(np.nan if outside else float(column[i]) * scale)
        return values[0], values[1]


# --- live -----------------------------------------------------------------------------------------------


@dataclass(slots=True, eq=False)
class LiveCurves:
    """Curves of live samples, which are extended with each picture.

    The curves restart when the window, the size or the signals change.
    """

    live_samples: LiveSamples
    _of: object = None
    _columns: dict[str, CurveColumns] = field(default_factory=dict)
    _done: dict[str, float] = field(default_factory=dict)
    _latest: dict[str, float] = field(default_factory=dict)
    _ranges: Mapping[Quantity, ValueRange] = field(default_factory=dict)
    _watched: float = np.nan  # time up to which the trigger has examined the samples
    _trigger: tuple[Trigger, float] | None = None  # the trigger and its arming time

    def make_picture(self, request: PictureRequest, overlay: RecordingCurves | None = None) -> ScopePicture:
        """Return the picture of the time window that ends at the newest sample."""
        newest = self.live_samples.newest_time_s
        width = request.width
        known = (request.signals, request.window_span_s, request.width_px, request.metric)
        if known != self._of or not np.isfinite(newest):
            self._of = known
            self._columns = {each.key: CurveColumns.make_empty(width) for each in request.signals}
            self._done, self._latest = {}, {}
            self._ranges = {}
        if not np.isfinite(newest):
            return ScopePicture(begin_s=-request.window_span_s, end_s=0.0, is_metric=request.metric)
        end = np.ceil(newest / width) * width  # Partial columns would make the curve flicker.
        rate = self._extend_curves(request, newest)
        curves = []
        for signal in request.signals:
            columns = self._columns[signal.key]
            columns.remove_columns_before(end - request.window_span_s - width)
            scale = signal.quantity.find_display_scale(request.metric)
            latest = self._latest.get(signal.key, np.nan) * scale
            curves.append(
                ScopeCurve(signal, convert_to_display_units(columns.make_points(), scale, end), latest)
            )
        earlier = overlay.make_curves(request) if overlay is not None else ()
        self._ranges = find_lane_ranges((*curves, *earlier), self._ranges, request)
        released = self._find_trigger_time(request, newest)
        begin = -request.window_span_s
        return ScopePicture(
            tuple(curves),
            earlier,
            begin,
            0.0,
            end,
            rate,
            True,
            request.metric,
            self._ranges,
            {},
            released,
            None if earlier else find_constant_values(curves, begin, request.width),
        )

    def _extend_curves(self, wanted: PictureRequest, newest: float) -> float:
        """Add the new samples to the curves' columns, and return the sample rate."""
        start = newest - wanted.window_span_s
        back = max((each.calculation_window_s for each in wanted.signals), default=0.0) + QUERY_LEAD_S
        done = min((self._done.get(each.key, start) for each in wanted.signals), default=start)
        names = {each.channel_name for each in wanted.signals}
        record = self.live_samples.read_samples_between(max(done, start) - back, newest, names)
        times = record.times_s
        for signal in wanted.signals:
            source = record.values_by_channel.get(signal.channel_name)
            if source is None or not len(times):
                continue
            values = signal.calculate_values(times, source)
            sure = (
                float(times[-1]) - 0.5 * signal.calculation_window_s
                if signal.calculation_window_s
                else float(times[-1])
            )
            first, last = np.searchsorted(times, (self._done.get(signal.key, start), sure), side="right")
            if signal.calculation_window_s:
                finite_index = np.flatnonzero(np.isfinite(values[first:last]))
                last = first + (finite_index[-1] + 1 if len(finite_index) else 0)
            if last > first:
                self._columns[signal.key].append_samples(times[first:last], values[first:last])
                self._done[signal.key] = float(times[last - 1])
                self._latest[signal.key] = float(values[last - 1])
        return record.sampling_rate_hz

    def _find_trigger_time(self, wanted: PictureRequest, newest: float) -> float | None:
        """Return the time at which a new sample fired the trigger, or None if no sample fired it.

        Samples from before the trigger was armed are ignored.
        """
        trigger = wanted.trigger
        if (trigger, wanted.armed) != self._trigger:
            self._trigger = trigger, wanted.armed
            self._watched = wanted.armed if np.isfinite(wanted.armed) else newest
        name = trigger.watched_key
        if not name:
            return None
        signal = next((each for each in wanted.signals if each.key == name), None)
        channel, back = (
            (signal.channel_name, signal.calculation_window_s) if signal is not None else (name, 0.0)
        )
        record = self.live_samples.read_samples_between(
            self._watched - back - QUERY_LEAD_S, newest, {channel}
        )
        column = record.values_by_channel.get(channel)
        if column is None or len(record.times_s) < 2:
            return None
        values = signal.calculate_values(record.times_s, column) if signal is not None else column
        finite_index = np.flatnonzero(np.isfinite(values))
        if not len(finite_index):
            return None
        first = max(0, int(np.searchsorted(record.times_s, self._watched)) - 1)
        cut = slice(first, int(finite_index[-1]) + 1)
        self._watched = max(self._watched, float(record.times_s[finite_index[-1]]))
        return trigger.find_trigger_time(record.times_s[cut], values[cut], find_alarm_state_values(record))


def find_alarm_state_values(record: ScopeRecord) -> frozenset[int]:
    """Return the values of the channel ``state`` that mean an alarm or an E-stop."""
    words = record.about.get("states", "").split("|")
    return frozenset(i for i, word in enumerate(words) if word in ALARM_STATES)
