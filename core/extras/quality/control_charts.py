"""Shewhart control charts (X-bar/R, I-MR) and process capability (ISO 22514-2).

The control limits are three within-sample standard deviations from the center line. The constants are from
ISO 7870-2 and ASTM E2587, for normally distributed values. Lengths may have any unit. The rules that detect
drift are those of Western Electric (1956) and Nelson (1984), with Nelson's numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.message import CodedError, Message

MIN_READINGS = 10  # least number of readings for a capability; fewer would make it random
_ONE_SIDED_95 = 1.645  # quantile of the normal distribution


@dataclass(frozen=True, slots=True)
class Capability:
    """Process capability of a measured feature.

    ``cp`` and ``pp`` are None if one of the tolerance limits is missing. All indices are None if the values
    do not vary.
    """

    count: int
    mean: float
    within: float  # =
    cp: float | None
    cpk: float | None
    pp: float | None
    ppk: float | None

    @property
    def cpk_lower_bound(self) -> float | None:
        """Return the lower 95 % confidence limit of Cpk (Bissell 1990), or None if Cpk is unknown.

        With few readings, this limit is far below Cpk.
        """
        if self.cpk is None:
            return None
        n = self.count
        return self.cpk - _ONE_SIDED_95 * math.sqrt(1.0 / (9.0 * n) + self.cpk**2 / (2.0 * (n - 1)))


def calculate_capability(
    values: Sequence[float], lower: float | None, upper: float | None, sample_size: int = 1
) -> Capability:
    """Calculate the capability from values in the order of the parts, in samples of ``sample_size``.

    Raises QualityError if there are fewer than 10 values, or if the tolerance limits are missing or
    reversed. Also raises it in the same cases as ``make_charts``, for example with fewer than 2 complete
    samples.
    """
    if lower is None and upper is None:
        raise QualityError(
            "process capability needs a tolerance; enter a tolerance for this feature", "no-tolerance"
        )
    if lower is not None and upper is not None and lower >= upper:
        raise QualityError(
            "the lower limit must be below the upper limit; correct the tolerance", "limits-reversed"
        )
    if len(values) < MIN_READINGS:
        raise QualityError(
            Message(
                "{values_count} readings are not enough; a Cpk needs at least {minimum} readings",
                values_count=len(values),
                minimum=MIN_READINGS,
            ),
            "too-few-readings",
        )
    within = make_charts(values, sample_size).within_sigma
    # standard deviation of all values with n − 1
    mean, overall = float(np.mean(values)), float(np.std(values, ddof=1))
    cp, cpk = _indices(mean, within, lower, upper)
    pp, ppk = _indices(mean, overall, lower, upper)
    return Capability(len(values), mean, within, cp, cpk, pp, ppk)


def _indices(
    mean: float, sigma: float, lower: float | None, upper: float | None
) -> tuple[float | None, float | None]:
    """Return two capability indices, such as Cp and Cpk.

    The first is the tolerance divided by six standard deviations. The second also considers the position of
    the mean: it is the distance from the mean to the nearer limit, divided by three standard deviations.
    """
    if sigma <= 1e-12:
        return None, None  # the resolution of the gauge is too coarse to show the variation
    near = [
        (upper - mean) if upper is not None else math.inf,
        (mean - lower) if lower is not None else math.inf,
    ]
    width = (upper - lower) / (6.0 * sigma) if upper is not None and lower is not None else None
    return width, min(near) / (3.0 * sigma)


FloatArray = npt.NDArray[np.float64]
# number of samples from which the limits are settled; before, each sample changes them noticeably
MIN_STABLE_POINTS = 20


class ChartFactors(NamedTuple):
    """Control chart factors for a sample of n values.

    ``a2`` is for the limits of averages, and ``d3`` and ``d4`` for the limits of ranges. ``d2`` is the
    ratio of the mean range to the standard deviation.
    """

    a2: float
    d3: float
    d4: float
    d2: float


# =
CHART_FACTORS: dict[int, ChartFactors] = {
    2: ChartFactors(1.880, 0.0, 3.267, 1.128),
    3: ChartFactors(1.023, 0.0, 2.575, 1.693),
    4: ChartFactors(0.729, 0.0, 2.282, 2.059),
    5: ChartFactors(0.577, 0.0, 2.114, 2.326),
    6: ChartFactors(0.483, 0.0, 2.004, 2.534),
    7: ChartFactors(0.419, 0.076, 1.924, 2.704),
    8: ChartFactors(0.373, 0.136, 1.864, 2.847),
    9: ChartFactors(0.337, 0.184, 1.816, 2.970),
    10: ChartFactors(0.308, 0.223, 1.777, 3.078),
}
SAMPLE_SIZES = range(2, 11)


@dataclass(frozen=True, slots=True)
class ControlChart:
    """A control chart: its points in order, its center line and its control limits."""

    point_values: FloatArray
    center_line: float
    lower_limit: float
    upper_limit: float

    @property
    def standard_deviation(self) -> float:
        """Return the standard deviation that corresponds to the limits.

        The result is 0 if the points do not vary.
        """
        return (self.upper_limit - self.center_line) / 3.0

    @property
    def has_stable_limits(self) -> bool:
        """Return whether the chart has enough points for stable control limits."""
        return len(self.point_values) >= MIN_STABLE_POINTS


@dataclass(frozen=True, slots=True)
class ControlChartPair:
    """Control charts of location and spread.

    ``within_sigma`` is the standard deviation within the samples.
    """

    location: ControlChart
    spread: ControlChart
    within_sigma: float
    sample_size: int  # values in a sample; 1 means individuals


def make_charts(values: Sequence[float], sample_size: int) -> ControlChartPair:
    """Return the control charts of values in the order of the parts.

    If ``sample_size`` is 1, the charts are individuals charts, otherwise X-bar/R charts. An incomplete last
    sample is omitted. Raises QualityError if the sample size is not supported, a value is not a number, or
    fewer than 2 values or complete samples exist.
    """
    if sample_size == 1:
        return make_individuals_charts(values)
    if sample_size not in SAMPLE_SIZES:
        raise QualityError(
            Message(
                "a control chart is not possible for samples of {size}; use samples of 1 to "
                "{sample_sizes} parts",
                size=sample_size,
                sample_sizes=SAMPLE_SIZES[-1],
            ),
            "sample-size",
        )
    whole = len(values) // sample_size * sample_size
    return make_xbar_r_charts(np.asarray(values[:whole], dtype=np.float64).reshape(-1, sample_size))


def make_xbar_r_charts(samples: npt.ArrayLike) -> ControlChartPair:
    """Return X-bar/R charts, one sample per row.

    Raises QualityError if a sample does not have 2 to 10 values, if a value is not finite, or if there are
    fewer than 2 samples.
    """
    try:
        table = np.asarray(samples, dtype=np.float64)
    except ValueError:  # rows of different lengths
        table = np.empty(0)
    if table.ndim != 2 or table.shape[1] not in SAMPLE_SIZES:
        raise QualityError(
            "the samples of an X-bar chart must all have the same size, 2 to 10 values", "sample-size"
        )
    _demand_finite(table)
    if len(table) < 2:
        raise QualityError(
            Message(
                "an X-bar chart needs at least 2 complete samples of {shape} parts; measure more parts",
                shape=table.shape[1],
            ),
            "too-few-readings",
        )
    factors = CHART_FACTORS[table.shape[1]]
    means, ranges = table.mean(axis=1), np.ptp(table, axis=1)
    mean, spread = float(means.mean()), float(ranges.mean())
    return ControlChartPair(
        ControlChart(means, mean, mean - factors.a2 * spread, mean + factors.a2 * spread),
        ControlChart(ranges, spread, factors.d3 * spread, factors.d4 * spread),
        spread / factors.d2,
        table.shape[1],
    )


def make_individuals_charts(values: Sequence[float]) -> ControlChartPair:
    """Return the charts of individuals and of moving ranges of two values.

    The individuals' limits are at 2.660 (3/d2) mean ranges. Raises QualityError for fewer than 2 values, or
    if a value is not finite.
    """
    points = np.asarray(values, dtype=np.float64)
    _demand_finite(points)
    if len(points) < 2:
        raise QualityError(
            "an individuals chart needs at least 2 values; measure more parts", "too-few-readings"
        )
    factors = CHART_FACTORS[2]
    moving = np.abs(np.diff(points))
    mean, spread = float(points.mean()), float(moving.mean())
    reach = 3.0 / factors.d2 * spread
    return ControlChartPair(
        ControlChart(points, mean, mean - reach, mean + reach),
        ControlChart(moving, spread, factors.d3 * spread, factors.d4 * spread),
        spread / factors.d2,
        1,
    )


def _demand_finite(values: FloatArray) -> None:
    if not np.isfinite(values).all():
        raise QualityError("a value is not a number; delete that reading", "not-a-number")


ZoneArray = npt.NDArray[np.float64]


class RuleViolation(NamedTuple):
    """A violation of a control chart rule.

    It contains the index (from 0) of the last point of the run, the number of the rule, and its text.
    """

    point_index: int
    rule_number: int
    rule_text: str


def find_rule_violations(chart: ControlChart) -> tuple[RuleViolation, ...]:
    """Return the violations of all rules, sorted by point, or () if the points do not vary."""
    if chart.standard_deviation <= 0.0 or not len(chart.point_values):
        return ()
    zones = (chart.point_values - chart.center_line) / chart.standard_deviation
    found = [
        RuleViolation(point, number, words)
        for number, (words, rule) in CONTROL_RULES.items()
        for point in rule(zones)
    ]
    return tuple(sorted(found))


def _beyond(zones: ZoneArray) -> Iterator[int]:
    yield from (int(at) for at in np.nonzero(np.abs(zones) > 3.0)[0])


def _runs(zones: ZoneArray, length: int, whole: Callable[[ZoneArray], bool]) -> Iterator[int]:
    """Yield the last point of each sequence of ``length`` points for which ``whole`` is true.

    ``whole`` receives the zones of all points of the sequence.
    """
    for end in range(length, len(zones) + 1):
        if whole(zones[end - length : end]):
            yield end - 1


def _one_side(zones: ZoneArray) -> bool:
    return bool((zones > 0.0).all() or (zones < 0.0).all())


def _steady(zones: ZoneArray) -> bool:
    steps = np.diff(zones)
    return bool((steps > 0.0).all() or (steps < 0.0).all())


def _alternating(zones: ZoneArray) -> bool:
    steps = np.diff(zones)
    return bool((steps[1:] * steps[:-1] < 0.0).all())


def _so_many(zones: ZoneArray, count: int, beyond: float) -> bool:
    """Return whether enough points exceed a limit on the same side of the center line.

    The last point must be one of them. ``count`` is the required number of points, and ``beyond`` is the
    limit in sigma.
    """
    side = 1.0 if zones[-1] > 0.0 else -1.0
    far = zones * side > beyond
    return bool(far[-1] and far.sum() >= count)


CONTROL_RULES: dict[int, tuple[str, Callable[[ZoneArray], Iterator[int]]]] = {
    1: ("one point beyond a control limit", _beyond),
    2: ("nine points in a row on one side of the center line", lambda z: _runs(z, 9, _one_side)),
    3: ("six points in a row rising or falling", lambda z: _runs(z, 6, _steady)),
    4: ("fourteen points in a row alternating up and down", lambda z: _runs(z, 14, _alternating)),
    5: (
        "two of three points beyond two sigma on one side",
        lambda z: _runs(z, 3, lambda s: _so_many(s, 2, 2.0)),
    ),
    6: (
        "four of five points beyond one sigma on one side",
        lambda z: _runs(z, 5, lambda s: _so_many(s, 4, 1.0)),
    ),
    7: (
        "fifteen points in a row within one sigma",
        lambda z: _runs(z, 15, lambda s: bool((np.abs(s) < 1.0).all())),
    ),
    8: (
        "eight points in a row beyond one sigma",
        lambda z: _runs(z, 8, lambda s: bool((np.abs(s) > 1.0).all())),
    ),
}
"""Nelson rules by number, each with its text and a function that finds the violations.

Rules 1, 5 and 6 are also Western Electric rules.
"""


class QualityError(CodedError, ValueError):
    """An error raised for values that cannot be evaluated. The text states the reason and a remedy."""
