"""Curves by pixel columns: of all samples of a column the least and the greatest, so that no spike is lost.

Columns lie at whole multiples of their width in time, never beside each other's samples: a curve that rolls
does not flicker. Each reaches back to the last sample of the column before it, so that steep flanks close.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
DENSE = 2.0  # samples a column from which on columns are drawn; fewer are drawn as they are


@dataclass(frozen=True, slots=True)
class Points:
    """What is drawn: ``pairs`` are lines of two points each; else ``joined`` says where a line goes on.

    ``times`` are seconds of the record's clock.
    """

    times: FloatArray
    values: FloatArray
    pairs: bool = False
    joined: npt.NDArray[np.bool_] | None = None  # None: all


@dataclass(slots=True)
class Columns:
    """Least and greatest of each column that has samples; column n of ``numbers`` begins at n·``width`` s."""

    width: float
    numbers: IntArray
    least: FloatArray
    greatest: FloatArray
    entries: FloatArray  # the sample before the column, nan where it does not go on from it
    last: float = np.nan  # sample before the next one

    @classmethod
    def none(cls, width: float) -> Columns:
        """Nothing yet."""
        nothing = np.empty(0)
        return cls(width, np.empty(0, dtype=np.int64), nothing, nothing, nothing)

    def append(self, times: FloatArray, values: FloatArray) -> None:
        """Take samples that are later than all before; what is not a number leaves a gap."""
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
        """What ended before this instant is not shown any more."""
        cut = int(np.searchsorted(self.numbers, int(np.floor(before / self.width))))
        self.numbers, self.entries = self.numbers[cut:], self.entries[cut:]
        self.least, self.greatest = self.least[cut:], self.greatest[cut:]

    def points(self) -> Points:
        """One upright line a column, and a level one over columns in which nothing was sampled."""
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
    """What is drawn of these samples where a pixel is ``width`` s wide."""
    if len(times) < 2 or len(times) < DENSE * (times[-1] - times[0]) / width:
        told = np.flatnonzero(np.isfinite(values))
        if len(told) == len(values):
            return Points(times, values)
        return Points(times[told], values[told], joined=np.diff(told, append=told[-1:] + 2) == 1)
    columns = Columns.none(width)
    columns.append(times, values)
    return columns.points()


# --- the range of a lane --------------------------------------------------------------------------------

_EDGE = 0.01
_ROUND = (1.0, 2.0, 2.5, 5.0, 10.0)


def round_range(low: float, high: float, least: float) -> tuple[float, float]:
    """A range of round figures about these two, ``least`` wide at least, with some room above and below."""
    middle, wide = 0.5 * (low + high), max(1.08 * (high - low), least)
    power = 10.0 ** np.floor(np.log10(wide / 4.0))
    step = float(next(power * each for each in _ROUND if power * each >= wide / 4.0 - 1e-12))
    bottom, top = np.floor((middle - wide / 2.0) / step) * step, np.ceil((middle + wide / 2.0) / step) * step
    return float(bottom), float(top)


def kept_range(
    before: tuple[float, float] | None, low: float, high: float, least: float
) -> tuple[float, float]:
    """The range of before as long as the curve lies in it and fills a quarter: a lane does not twitch."""
    if before is not None:
        wide = before[1] - before[0]
        edge = _EDGE * wide  # a curve on the edge itself is half a line beyond it, and not seen
        inside = before[0] + edge <= low and high <= before[1] - edge
        if inside and (4.0 * (high - low) >= wide or wide <= 4.0 * least):
            return before
    return round_range(low, high, least)
