"""Points of the scope's curves, reduced to pixel columns, and round ranges of the lanes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
MIN_SAMPLES_PER_COLUMN = 2.0  # number of samples per column above which columns are drawn instead of samples


@dataclass(frozen=True, slots=True)
class CurvePoints:
    """Points of a curve to draw.

    ``times_s`` are in seconds of the record's clock. If ``has_line_pairs`` is True, each pair of points is
    one line. Otherwise ``is_joined_to_next`` marks the points that are connected to the next point.
    """

    times_s: FloatArray
    values: FloatArray
    has_line_pairs: bool = False
    is_joined_to_next: npt.NDArray[np.bool_] | None = None  # None: all points are connected


@dataclass(slots=True)
class CurveColumns:
    """Minimum and maximum of a curve in equal time intervals, which are the pixel columns of a chart.

    Column n of ``column_numbers`` starts at n · ``width_s`` seconds.
    """

    column_width_s: float
    column_numbers: IntArray
    minima: FloatArray
    maxima: FloatArray
    preceding_samples: FloatArray  # sample before each column, or nan after a gap
    last_value: float = np.nan  # sample before the next one

    @classmethod
    def make_empty(cls, width_s: float) -> CurveColumns:
        """Return an empty set of columns with a width in seconds."""
        nothing = np.empty(0)
        return cls(width_s, np.empty(0, dtype=np.int64), nothing, nothing, nothing)

    def append_samples(self, times: FloatArray, values: FloatArray) -> None:
        """Append samples that are later than all earlier samples.

        Values that are not finite leave a gap.
        """
        if not len(values):
            return
        last, self.last_value = self.last_value, float(values[-1])
        finite_index = np.flatnonzero(np.isfinite(values))
        if not len(finite_index):
            return
        times, values = times[finite_index], values[finite_index]
        of = np.floor(times / self.column_width_s).astype(np.int64)
        first = np.flatnonzero(np.diff(of, prepend=of[0] - 1))
        numbers = of[first]
        low, high = np.minimum.reduceat(values, first), np.maximum.reduceat(values, first)
        ends = first[1:] - 1
        joined = np.where(finite_index[first[1:]] == finite_index[ends] + 1, values[ends], np.nan)
        before = np.concatenate([[last if finite_index[0] == 0 else np.nan], joined])
        np.fmin(low, before, out=low)
        np.fmax(high, before, out=high)
        if len(self.column_numbers) and self.column_numbers[-1] == numbers[0]:
            self.minima[-1], self.maxima[-1] = (
                min(self.minima[-1], low[0]),
                max(self.maxima[-1], high[0]),
            )
            numbers, low, high, before = numbers[1:], low[1:], high[1:], before[1:]
        self.column_numbers = np.concatenate([self.column_numbers, numbers])
        self.minima = np.concatenate([self.minima, low])
        self.maxima = np.concatenate([self.maxima, high])
        self.preceding_samples = np.concatenate([self.preceding_samples, before])

    def remove_columns_before(self, time_s: float) -> None:
        """Remove the columns that ended before a time in seconds."""
        cut = int(np.searchsorted(self.column_numbers, int(np.floor(time_s / self.column_width_s))))
        self.column_numbers, self.preceding_samples = self.column_numbers[cut:], self.preceding_samples[cut:]
        self.minima, self.maxima = self.minima[cut:], self.maxima[cut:]

    def make_points(self) -> CurvePoints:
        """Return a vertical line for each column.

        For a continuous curve, also return lines across columns that contain no samples.
        """
        at = (self.column_numbers + 0.5) * self.column_width_s
        later = 1 + np.flatnonzero(
            (np.diff(self.column_numbers) > 1) & np.isfinite(self.preceding_samples[1:])
        )
        n = len(at)
        times, values = np.empty(2 * (n + len(later))), np.empty(2 * (n + len(later)))
        times[0 : 2 * n : 2] = times[1 : 2 * n : 2] = at
        values[0 : 2 * n : 2], values[1 : 2 * n : 2] = self.minima, self.maxima
        times[2 * n :: 2], times[2 * n + 1 :: 2] = at[later - 1], at[later]
        values[2 * n :: 2] = values[2 * n + 1 :: 2] = self.preceding_samples[later]
        return CurvePoints(times, values, has_line_pairs=True)


def make_curve_points(times: FloatArray, values: FloatArray, pixel_width_s: float) -> CurvePoints:
    """Return the points that are drawn for the samples.

    One pixel is ``pixel_width_s`` seconds wide.
    """
    if len(times) < 2 or len(times) < MIN_SAMPLES_PER_COLUMN * (times[-1] - times[0]) / pixel_width_s:
        index = np.flatnonzero(np.isfinite(values))
        if len(index) == len(values):
            return CurvePoints(times, values)
        return CurvePoints(
            times[index], values[index], is_joined_to_next=np.diff(index, append=index[-1:] + 2) == 1
        )
    columns = CurveColumns.make_empty(pixel_width_s)
    columns.append_samples(times, values)
    return columns.make_points()


# --- range of a lane ------------------------------------------------------------------------------------

_EDGE_MARGIN = 0.01
_ROUND_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


def make_round_range(low: float, high: float, min_width: float) -> tuple[float, float]:
    """Return a range with round limits that contains two values and a margin.

    The range is at least ``min_width`` wide.
    """
    middle, wide = 0.5 * (low + high), max(1.08 * (high - low), min_width)
    power = 10.0 ** np.floor(np.log10(wide / 4.0))
    step = float(next(power * each for each in _ROUND_STEPS if power * each >= wide / 4.0 - 1e-12))
    bottom, top = np.floor((middle - wide / 2.0) / step) * step, np.ceil((middle + wide / 2.0) / step) * step
    return float(bottom), float(top)


def update_range(
    present_range: tuple[float, float] | None, low: float, high: float, min_width: float
) -> tuple[float, float]:
    """Return the current range if it still suits the curve, and otherwise a new range.

    The current range suits the curve if the curve is inside it and fills at least a quarter of it. This
    prevents frequent small changes of the scale.
    """
    if present_range is not None:
        wide = present_range[1] - present_range[0]
        edge = _EDGE_MARGIN * wide  # A curve exactly on the edge would be half hidden.
        inside = present_range[0] + edge <= low and high <= present_range[1] - edge
        if inside and (4.0 * (high - low) >= wide or wide <= 4.0 * min_width):
            return present_range
    return make_round_range(low, high, min_width)
