"""Comparison of threading passes by entry angle, lead error and spindle speed under load.

A pass is a period of at least two revolutions with a constant axis travel per revolution. A pass is
described by its best-fit line, distance = lead · revolutions + entry.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.records.record import AnalysisError

FloatArray = npt.NDArray[np.float64]
MIN_REVOLUTIONS = 2.0
_EVEN = 0.04  # largest relative difference in travel per revolution within a pass
_ALIKE = 0.02  # largest relative difference between the leads of the passes of one thread
_ON_LINE = 0.1  # largest distance between two pieces of a pass, as a fraction of the lead
_LEAST_LEAD = 0.05  # mm per revolution
_EDGE = 0.5  # revolutions at both ends in which the axis still accelerates
_POINTS = 24  # points per revolution at which the travel is compared


@dataclass(frozen=True, slots=True)
class MeasuredThreadPass:
    """Measured values of one threading pass.

    - ``first_sample`` and ``last_sample``: sample numbers
    - ``spindle_revolutions`` and ``deviations_mm`` (k,): revolutions since the start of the thread, and
      deviations
    - ``entry_angle_deg``: spindle angle at the start of the thread, relative to the first pass
    - ``lead_mm``: lead in mm per revolution; speeds are in rpm
    - ``depth_mm``: position of the other axis
    """

    first_sample: int
    last_sample: int
    spindle_revolutions: FloatArray
    deviations_mm: FloatArray
    entry_angle_deg: float
    lead_mm: float
    depth_mm: float
    speed_before_cut_rpm: float
    min_speed_rpm: float
    speed_ripple_rpm: float

    @property
    def speed_drop_rpm(self) -> float:
        """Return the drop of the spindle speed during the cut, in rpm.

        The drop is measured from the highest speed just before the cut.
        """
        return self.speed_before_cut_rpm - self.min_speed_rpm


@dataclass(frozen=True, slots=True)
class ThreadAnalysis:
    """The passes of one thread, with the signed reference lead in mm per revolution."""

    reference_lead_mm: float
    passes: tuple[MeasuredThreadPass, ...]

    @property
    def entry_spread_deg(self) -> float:
        """Return the difference between the largest and the smallest entry angle, in degrees."""
        entries = [each.entry_angle_deg for each in self.passes]
        return max(entries) - min(entries)

    @property
    def max_lead_error_mm(self) -> float:
        """Return the largest deviation of a lead from the reference lead, in mm per revolution."""
        return max((each.lead_mm - self.reference_lead_mm for each in self.passes), key=abs)


def calculate_max_threading_rpm(lead: float, max_axis_speed: float) -> float:
    """Return the highest spindle speed in rpm at which an axis can follow the lead.

    ``lead`` is in mm per revolution, and ``max_axis_speed`` is the speed limit of the axis in mm/s.
    """
    return 60.0 * max_axis_speed / abs(lead) if lead else math.inf


def analyze_thread(
    spindle_revolutions: FloatArray,
    axis_positions: FloatArray,
    depth: FloatArray,
    speed: FloatArray,
    lead: float | None = None,
) -> ThreadAnalysis:
    """Find the threading passes in samples (n,).

    ``axis_positions`` and ``depth`` are the positions in mm along the thread and of the other axis.
    ``speed`` is in rpm. ``lead`` is in mm per revolution; if it is None, it is derived from the passes.
    Raises AnalysisError if no pass is found or data is missing.
    """
    if len(spindle_revolutions) < 100:
        raise AnalysisError(
            "an analysis of thread passes needs at least 100 samples; record while a thread is cut",
            "too-few-samples",
        )
    if not np.isfinite(spindle_revolutions).all():
        raise AnalysisError(
            "no spindle encoder count is available, so the spindle angle is not in the record", "no-encoder"
        )
    if abs(spindle_revolutions[-1] - spindle_revolutions[0]) < MIN_REVOLUTIONS:
        raise AnalysisError(
            "the spindle does not turn in this time range; record while a thread is cut", "spindle-stopped"
        )
    runs = _runs(spindle_revolutions, axis_positions)
    if lead is not None:
        runs = [each for each in runs if abs(each[2] - lead) <= _EVEN * abs(lead)]
    else:
        runs = _alike(runs)
    if not runs:
        raise AnalysisError(
            "this time range does not contain a thread pass, because no axis moves at a "
            "steady speed for two spindle revolutions",
            "no-pass",
        )
    if lead is None:
        slopes = [
            np.polyfit(spindle_revolutions[a : b + 1] - spindle_revolutions[a], axis_positions[a : b + 1], 1)[
                0
            ]
            for a, b, *_ in runs
        ]
        lead = float(np.median(slopes))
    return ThreadAnalysis(lead, _passes(runs, lead, spindle_revolutions, axis_positions, depth, speed))


# first sample, last sample, travel per revolution, sample at which the axis started
SampleRange = tuple[int, int, float, int]


def _runs(turns: FloatArray, along: FloatArray) -> list[SampleRange]:
    """Return the periods of the record with a constant travel per revolution."""
    direction = 1.0 if turns[-1] >= turns[0] else -1.0
    t = np.maximum.accumulate(direction * turns)
    grid = np.arange(t[0], t[-1], 1.0 / _POINTS)
    where = np.interp(grid, t, along)
    slope = _POINTS * np.gradient(where) * direction if len(grid) > 2 else np.zeros(len(grid))
    even = np.zeros(len(grid), dtype=bool)
    even[1:] = np.abs(np.diff(slope)) <= _EVEN * np.abs(slope[1:]) / 2.0
    even &= np.abs(slope) >= _LEAST_LEAD
    edges = np.flatnonzero(np.diff(np.concatenate([[False], even, [False]]).astype(int)))
    found = []
    for begin, end in zip(edges[0::2], edges[1::2], strict=True):
        if end - begin < MIN_REVOLUTIONS * _POINTS:
            continue
        middle = float(np.median(slope[begin:end]))
        good = np.flatnonzero(np.abs(slope[begin:end] - middle) <= _EVEN * abs(middle))
        a, b = begin + good[0], begin + good[-1]
        if grid[b] - grid[a] >= MIN_REVOLUTIONS:
            edge = min(_EDGE, 0.1 * (grid[b] - grid[a]))
            first, last = np.searchsorted(t, (grid[a] + edge, grid[b] - edge))
            found.append((int(first), int(last), middle, int(np.searchsorted(t, grid[a]))))
    return _joined(found, direction * turns, along, direction)


def _joined(
    runs: list[SampleRange], turns: FloatArray, along: FloatArray, direction: float
) -> list[SampleRange]:
    """Return the periods, with adjacent periods of the same threading pass joined into one.

    A period belongs to the same pass if it continues the best-fit line of the preceding period.
    """
    found: list[SampleRange] = []
    for run in runs:
        if found:
            first, last, slope, out = found[-1]
            on = along[last] + direction * slope * (turns[run[0]] - turns[last])
            same = abs(run[2] - slope) <= _EVEN * abs(slope)
            if same and abs(along[run[0]] - on) <= _ON_LINE * abs(slope):
                found[-1] = (first, run[1], slope, out)
                continue
        found.append(run)
    return found


def _alike(runs: list[SampleRange]) -> list[SampleRange]:
    """Return the passes with the same lead: the coarsest lead that occurs more than once.

    If no lead occurs more than once, return the passes with the coarsest lead.
    """
    if not runs:
        return []
    groups = [[each for each in runs if abs(each[2] - one[2]) <= _ALIKE * abs(one[2])] for one in runs]
    several = [group for group in groups if len(group) > 1] or groups
    return max(several, key=lambda group: (abs(group[0][2]) > _LEAST_LEAD, len(group), abs(group[0][2])))


def _passes(
    runs: list[SampleRange],
    lead: float,
    turns: FloatArray,
    along: FloatArray,
    depth: FloatArray,
    speed: FloatArray,
) -> tuple[MeasuredThreadPass, ...]:
    """Return the threading passes with their best-fit lines and entry angles.

    Entry angles differ by at most half a revolution from that of the first pass.
    """
    begin = float(np.median([along[first] for first, *_ in runs]))
    found: list[MeasuredThreadPass] = []
    base = 0.0
    for number, (first, last, _, out) in enumerate(runs):
        cut = slice(first, last + 1)
        t = turns[cut]
        slope, start = np.polyfit(t - t[0], along[cut], 1)
        crossing = t[0] + (begin - start) / slope
        base = crossing if number == 0 else base
        entry = 360.0 * ((crossing - base + 0.5) % 1.0 - 0.5)
        whole = base + round(crossing - base)
        off = along[cut] - (begin + lead * (t - whole))
        before = speed[max(0, out - max(1, (last - first) // 4)) : first + 1]
        within = speed[cut]
        found.append(
            MeasuredThreadPass(
                first,
                last,
                t - whole,
                off,
                float(entry),
                float(slope),
                float(np.median(depth[cut])),
                _most(before),
                float(np.nanmin(within)) if np.isfinite(within).any() else math.nan,
                float(np.nanmax(within) - np.nanmin(within)) if np.isfinite(within).any() else math.nan,
            )
        )
    return tuple(found)


def _most(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else math.nan
