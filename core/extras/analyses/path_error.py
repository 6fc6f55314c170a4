"""Deviation of a measured path from its program, and ball-bar analysis of an arc.

The measured path is in the plane (u, v) of two axes. The results describe encoder positions. A motor
encoder does not show the backlash of the ball screw, but a linear scale does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from core.message import Message
from core.records.record import AnalysisError

FloatArray = npt.NDArray[np.float64]
MIN_ARC_SAMPLES = 60  # samples
MIN_ARC_ANGLE_DEG = 60.0  # degrees of arc
_ROUND = 0.002  # mm, largest deviation of an arc's setpoints from a circle
_SPIKE = 3.0  # degrees after a reversal that are searched for a spike
_TELL = 30.0  # largest condition number at which the values can be separated


@dataclass(frozen=True, slots=True)
class BallBarResult:
    """Result of a ball-bar analysis of one arc. A value is NaN if the arc is too short for it.

    - ``angles_deg`` (m,): angles of the samples
    - ``deviations_mm`` (m,): radial distances of the samples from the programmed arc, outside positive
    - ``backlash_mm`` and ``reversal_spike_mm``: pairs for the axes (u, v)
    - ``squareness_error_mm_m``: tilt of v toward u in mm per meter
    - ``scale_error_mm_m``: excess length of u over v in mm per meter
    - ``size_error_mm``: excess of the radius
    """

    center: tuple[float, float]
    radius_mm: float
    angles_deg: FloatArray
    deviations_mm: FloatArray
    backlash_mm: tuple[float, float]
    reversal_spike_mm: tuple[float, float]
    squareness_error_mm_m: float
    scale_error_mm_m: float
    size_error_mm: float

    @property
    def circularity_mm(self) -> float:
        """Return the difference between the largest and the smallest deviation, in mm."""
        return float(np.ptp(self.deviations_mm))

    @property
    def arc_angle_deg(self) -> float:
        """Return the angle of the arc in degrees, at most 360."""
        return float(min(360.0, np.ptp(np.unwrap(np.radians(self.angles_deg))) * 180.0 / math.pi))


def fit_circle(points: FloatArray) -> tuple[float, float, float]:
    """Return the center (u, v) and the radius of the best-fit circle of the points (n, 2).

    The circle is the least-squares solution of u² + v² = 2au + 2bv + c.
    """
    middle = points.mean(axis=0)
    at = points - middle
    system = np.column_stack([2.0 * at, np.ones(len(at))])
    (a, b, c), *_ = np.linalg.lstsq(system, (at**2).sum(axis=1), rcond=None)
    return float(a + middle[0]), float(b + middle[1]), math.sqrt(max(c + a * a + b * b, 0.0))


def analyze_ball_bar(setpoints: FloatArray, actual: FloatArray) -> BallBarResult:
    """Analyze setpoints and positions (m, 2) of one arc.

    Raises AnalysisError if the samples do not contain a usable arc.
    """
    if len(setpoints) < MIN_ARC_SAMPLES or len(actual) != len(setpoints):
        raise AnalysisError(
            Message(
                "a ball-bar plot needs {minimum} samples of an arc; use a lower feed or a larger arc",
                minimum=MIN_ARC_SAMPLES,
            ),
            "too-few-samples",
        )
    if not (np.isfinite(setpoints).all() and np.isfinite(actual).all()):
        raise AnalysisError(
            "the driver does not report the axis positions, so no arc can be shown", "no-positions"
        )
    u0, v0, radius = fit_circle(setpoints)
    away = setpoints - (u0, v0)
    if np.abs(np.hypot(*away.T) - radius).max() > _ROUND or not np.isfinite(radius):
        raise AnalysisError(
            "this time range does not contain an arc; choose a line that programs an arc", "no-arc"
        )
    turned = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    if abs(np.ptp(turned)) < math.radians(MIN_ARC_ANGLE_DEG):
        raise AnalysisError(
            Message(
                "the arc is shorter than {least_angle} degrees, too short for a ball-bar plot",
                least_angle=f"{MIN_ARC_ANGLE_DEG:g}",
            ),
            "arc-too-short",
        )
    seen = actual - (u0, v0)
    theta = np.arctan2(seen[:, 1], seen[:, 0])
    deviation = np.hypot(*seen.T) - radius
    fit_coefficients, rest = _fitted(theta, turned, deviation)
    spike = (_spike(setpoints[:, 0], turned, rest), _spike(setpoints[:, 1], turned, rest))
    return BallBarResult(
        (u0, v0),
        radius,
        np.degrees(np.unwrap(theta)),
        deviation,
        (fit_coefficients[1], fit_coefficients[2]),
        spike,
        1000.0 * 2.0 * fit_coefficients[3] / radius,
        1000.0 * 2.0 * fit_coefficients[4] / radius,
        fit_coefficients[0],
    )


def _fitted(theta: FloatArray, turned: FloatArray, deviation: FloatArray) -> tuple[list[float], FloatArray]:
    """Return the fitted coefficients of the radial deviation, and the residual.

    The coefficients are the size error, the backlash of u and v, and the factors of sin 2θ and cos 2θ. A
    backlash b of u leaves the axis b/2 short of its setpoint, which changes the radius by
    −(b/2)·sign(u′)·cos θ. A tilt φ contributes φR/2·sin 2θ. A scale error e between u and v contributes
    eR/2·cos 2θ.
    """
    rotation_sign = 1.0 if turned[-1] > turned[0] else -1.0
    towards_u, towards_v = -rotation_sign * np.sign(np.sin(theta)), rotation_sign * np.sign(np.cos(theta))
    shapes = np.column_stack(
        [
            np.ones_like(theta),
            -0.5 * towards_u * np.cos(theta),
            -0.5 * towards_v * np.sin(theta),
            np.sin(2.0 * theta),
            np.cos(2.0 * theta),
            np.cos(theta),
            np.sin(theta),
        ]
    )
    found, *_ = np.linalg.lstsq(shapes, deviation, rcond=None)
    rest = deviation - shapes @ found
    scaled = shapes / np.linalg.norm(shapes, axis=0)
    if np.linalg.cond(scaled) > _TELL:
        return [float(deviation.mean()), *[math.nan] * 4], rest
    return [float(each) for each in found[:5]], rest


def _spike(position: FloatArray, turned: FloatArray, rest: FloatArray) -> float:
    """Return the largest residual shortly after this axis reverses, or NaN if it does not reverse."""
    step = np.sign(np.diff(position))
    moving = np.flatnonzero(step)
    if not len(moving):
        return math.nan
    turns = moving[1:][step[moving[1:]] != step[moving[:-1]]]
    peaks = []
    for at in turns:
        is_after_reversal = np.abs(turned - turned[at]) <= math.radians(_SPIKE)
        is_after_reversal[:at] = False
        if is_after_reversal.any():
            peaks.append(float(np.abs(rest[is_after_reversal]).max()))
    return max(peaks) if peaks else math.nan


def find_arcs(setpoints: FloatArray, lines: FloatArray) -> tuple[tuple[int, slice], ...]:
    """Return the program lines whose setpoints (m, 2) form an arc that is long enough to analyze.

    Each line is returned with the range of its samples.
    """
    if not len(lines):
        return ()
    edges = np.flatnonzero(np.diff(lines)) + 1
    bounds = [0, *edges.tolist(), len(lines)]
    found = []
    for first, last in pairwise(bounds):
        if last - first < MIN_ARC_SAMPLES or not lines[first] > 0:
            continue
        part = setpoints[first:last]
        moved = np.append(True, (np.abs(np.diff(part, axis=0)) > 1e-9).any(axis=1))
        if moved.sum() < MIN_ARC_SAMPLES or np.linalg.matrix_rank(part - part.mean(axis=0), tol=1e-3) < 2:
            continue
        u, v, radius = fit_circle(part[moved])
        away = part - (u, v)
        turned = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
        on_it = np.abs(np.hypot(*away.T) - radius).max() <= _ROUND
        if on_it and np.ptp(turned) >= math.radians(MIN_ARC_ANGLE_DEG):
            found.append((int(lines[first]), slice(first, last)))
    return tuple(found)


IntArray = npt.NDArray[np.int64]
MIN_SAMPLES = 10  # samples that an analysis of a path needs
NO_POSITIONS_MESSAGE = "the driver does not report the axis positions, so no path can be compared"
NO_MOTION_MESSAGE = "no axis moved in this time range; record while a program runs"
_SAME = 1e-9  # mm, distance below which points are treated as equal


@dataclass(frozen=True, slots=True)
class PathError:
    """Deviations of the measured samples (m,) from the path.

    - ``distances_mm``: with two axes, positive to the left of the path direction; with three axes,
      unsigned
    - ``nearest_path_points`` (m, 2 or 3): nearest points of the path
    - ``path_positions_mm``: path length up to these points
    - ``line_numbers``: source line at each of these points
    """

    distances_mm: FloatArray
    nearest_path_points: FloatArray
    path_positions_mm: FloatArray
    line_numbers: IntArray
    measured_points: FloatArray

    @property
    def max_distance_mm(self) -> float:
        """Return the largest distance on either side of the path, in mm."""
        return float(np.abs(self.distances_mm).max())

    def magnify_deviation(self, factor: float) -> FloatArray:
        """Return the measured path (m, 2 or 3) with its deviation multiplied by ``factor``."""
        return self.nearest_path_points + factor * (self.measured_points - self.nearest_path_points)


@dataclass(frozen=True, slots=True)
class WorstDeviation:
    """The largest deviation of a program line, with its position and its distance in mm."""

    line_number: int
    distance_mm: float
    position: tuple[float, ...]
    sample_index: int


def calculate_path_error(
    programmed: FloatArray,
    lines: IntArray,
    measured: FloatArray,
    expected_point_indices: IntArray,
    search_point_count: int,
) -> PathError:
    """Return the deviations of measured positions (m, k) from a polyline (n, k) of 2 or 3 axes.

    ``lines`` (n,) are the source lines of the points of ``programmed``. ``expected_point_indices`` (m,) are
    the indices of the points that the samples should have reached. For each sample, only
    ``search_point_count`` points on either side are searched, because the path may cross itself. Raises
    AnalysisError if the samples are unusable.
    """
    _check(programmed, lines, measured, expected_point_indices)
    n = len(programmed)
    lengths = np.linalg.norm(np.diff(programmed, axis=0), axis=1)
    come = np.concatenate([[0.0], np.cumsum(lengths)])
    best = np.full(len(measured), np.inf)
    segment, share = np.zeros(len(measured), dtype=np.int64), np.zeros(len(measured))
    for step in range(-search_point_count, search_point_count):
        at = np.clip(expected_point_indices + step, 0, n - 2)
        start, segments = programmed[at], programmed[at + 1] - programmed[at]
        square = (segments**2).sum(axis=1)
        dot = ((measured - start) * segments).sum(axis=1)
        part = np.clip(np.divide(dot, square, out=np.zeros_like(dot), where=square > _SAME**2), 0.0, 1.0)
        off = ((measured - start - part[:, None] * segments) ** 2).sum(axis=1)
        nearer = off < best
        best[nearer], segment[nearer], share[nearer] = off[nearer], at[nearer], part[nearer]
    start, segments = programmed[segment], programmed[segment + 1] - programmed[segment]
    foot = start + share[:, None] * segments
    distance = np.sqrt(best)
    if programmed.shape[1] == 2:
        deviations = measured - foot
        side = np.sign(segments[:, 0] * deviations[:, 1] - segments[:, 1] * deviations[:, 0])
        distance = np.where(side < 0.0, -1.0, 1.0) * distance
    return PathError(distance, foot, come[segment] + share * lengths[segment], lines[segment], measured)


def _check(programmed: FloatArray, lines: IntArray, measured: FloatArray, due: IntArray) -> None:
    if len(measured) < MIN_SAMPLES or len(programmed) < 2:
        raise AnalysisError(
            Message(
                "a path error plot needs at least {minimum} samples of a path; record while a program runs",
                minimum=MIN_SAMPLES,
            ),
            "too-few-samples",
        )
    if len(lines) != len(programmed) or len(due) != len(measured):
        raise AnalysisError(
            "the number of path points and the number of line numbers differ", "lengths-differ"
        )
    if not (np.isfinite(programmed).all() and np.isfinite(measured).all()):
        raise AnalysisError(NO_POSITIONS_MESSAGE, "no-positions")
    if not (np.ptp(programmed, axis=0) > _SAME).any():
        raise AnalysisError(NO_MOTION_MESSAGE, "at-rest")


def calculate_path_error_from_samples(
    setpoints: FloatArray, actual: FloatArray, lines: FloatArray, sample_rate_hz: float, delay_s: float = 0.1
) -> PathError:
    """Return the deviations in a record, with ``setpoints`` (m, 2 or 3) as the programmed path.

    ``actual`` contains the measured positions. The nearest point is searched within ``delay_s`` seconds of
    each sample. Raises AnalysisError if samples or positions are missing or no axis moves.
    """
    if len(setpoints) < MIN_SAMPLES:
        raise AnalysisError(
            Message(
                "a path error plot needs at least {minimum} samples of a path; record while a program runs",
                minimum=MIN_SAMPLES,
            ),
            "too-few-samples",
        )
    if not (np.isfinite(setpoints).all() and np.isfinite(actual).all()):
        raise AnalysisError(NO_POSITIONS_MESSAGE, "no-positions")
    moved = np.append(True, (np.abs(np.diff(setpoints, axis=0)) > _SAME).any(axis=1))
    if moved.sum() < 2:
        raise AnalysisError(NO_MOTION_MESSAGE, "at-rest")
    due = np.cumsum(moved) - 1
    known = np.where(np.isfinite(lines), lines, 0.0).astype(np.int64)
    path = setpoints[moved]
    reach = max(2, round(delay_s * sample_rate_hz))
    return calculate_path_error(path, known[moved], actual, due.astype(np.int64), reach)


def find_worst_deviations(error: PathError, max_count: int = 10) -> tuple[WorstDeviation, ...]:
    """Return the worst deviation of each program line, in descending order.

    At most ``max_count`` lines are returned. Samples without a line (0) are ignored.
    """
    found = []
    for line in np.unique(error.line_numbers[error.line_numbers > 0]):
        of_line = np.flatnonzero(error.line_numbers == line)
        sample = int(of_line[np.argmax(np.abs(error.distances_mm[of_line]))])
        place = tuple(float(each) for each in error.nearest_path_points[sample])
        found.append(WorstDeviation(int(line), float(error.distances_mm[sample]), place, sample))
    return tuple(sorted(found, key=lambda each: -abs(each.distance_mm))[:max_count])
