"""Path error along the part with the worst lines, and the ball-bar plot of an arc.

The measured path lies in the plane (u, v) of the slides. What is told holds for what the encoders see: on a
motor's encoder the play of the screw behind it is not to be seen, on a scale it is.
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
LEAST = 60  # samples
LEAST_ANGLE = 60.0  # degrees of arc
_ROUND = 0.002  # mm that setpoints of an arc may be off a circle
_SPIKE = 3.0  # degrees behind a reversal in which a spike is looked for
_TELL = 30.0  # a figure is told where it does not mix with the others by more than this (condition number)


@dataclass(frozen=True, slots=True)
class BallBar:
    """``angles`` degrees and ``deviation`` mm (m,): how far each sample lies outside the programmed arc.

    ``backlash`` and ``spike`` (u, v), mm; ``squareness`` mm a metre that v leans towards u, ``scale`` mm a
    metre by which u is longer than v; ``size`` mm by which the radius is larger. nan: too short to tell.
    """

    centre: tuple[float, float]
    radius: float
    angles: FloatArray
    deviation: FloatArray
    backlash: tuple[float, float]
    spike: tuple[float, float]
    squareness: float
    scale: float
    size: float

    @property
    def roundness(self) -> float:
        """From the least to the greatest deviation, mm."""
        return float(np.ptp(self.deviation))

    @property
    def covered(self) -> float:
        """Degrees of arc that were run through, 360 at most."""
        return float(min(360.0, np.ptp(np.unwrap(np.radians(self.angles))) * 180.0 / math.pi))


def circle_of(points: FloatArray) -> tuple[float, float, float]:
    """Centre and radius of the circle nearest to points (n, 2): least squares of u² + v² = 2au + 2bv + c."""
    middle = points.mean(axis=0)
    at = points - middle
    system = np.column_stack([2.0 * at, np.ones(len(at))])
    (a, b, c), *_ = np.linalg.lstsq(system, (at**2).sum(axis=1), rcond=None)
    return float(a + middle[0]), float(b + middle[1]), math.sqrt(max(c + a * a + b * b, 0.0))


def ball_bar(demand: FloatArray, actual: FloatArray) -> BallBar:
    """Setpoints (m, 2) and measured positions (m, 2) of one arc. Raises AnalysisError."""
    if len(demand) < LEAST or len(actual) != len(demand):
        raise AnalysisError(
            Message(
                "a ball-bar plot needs {minimum} samples of an arc; use a lower feed or a larger arc",
                minimum=LEAST,
            ),
            "too-few-samples",
        )
    if not (np.isfinite(demand).all() and np.isfinite(actual).all()):
        raise AnalysisError(
            "the driver does not report the axis positions, so no arc can be shown", "no-positions"
        )
    u0, v0, radius = circle_of(demand)
    away = demand - (u0, v0)
    if np.abs(np.hypot(*away.T) - radius).max() > _ROUND or not np.isfinite(radius):
        raise AnalysisError(
            "this time range does not contain an arc; choose a line that programs an arc", "no-arc"
        )
    turned = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    if abs(np.ptp(turned)) < math.radians(LEAST_ANGLE):
        raise AnalysisError(
            Message(
                "the arc is shorter than {least_angle} degrees, too short for a ball-bar plot",
                least_angle=f"{LEAST_ANGLE:g}",
            ),
            "arc-too-short",
        )
    seen = actual - (u0, v0)
    theta = np.arctan2(seen[:, 1], seen[:, 0])
    deviation = np.hypot(*seen.T) - radius
    told, rest = _fitted(theta, turned, deviation)
    spike = (_spike(demand[:, 0], turned, rest), _spike(demand[:, 1], turned, rest))
    return BallBar(
        (u0, v0),
        radius,
        np.degrees(np.unwrap(theta)),
        deviation,
        (told[1], told[2]),
        spike,
        1000.0 * 2.0 * told[3] / radius,
        1000.0 * 2.0 * told[4] / radius,
        told[0],
    )


def _fitted(theta: FloatArray, turned: FloatArray, deviation: FloatArray) -> tuple[list[float], FloatArray]:
    """Size, backlash of u and v, the parts in sin 2θ and cos 2θ; and what none of them explains.

    A play b of u leaves its slide b/2 short of where it is sent: −(b/2)·sign(u′)·cos θ of the radius. A lean
    φ gives φR/2·sin 2θ, a scale e between u and v eR/2·cos 2θ.
    """
    way = 1.0 if turned[-1] > turned[0] else -1.0
    towards_u, towards_v = -way * np.sign(np.sin(theta)), way * np.sign(np.cos(theta))
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
    """What is not explained at most, a few degrees behind a reversal of this axis; nan: it has none."""
    step = np.sign(np.diff(position))
    moving = np.flatnonzero(step)
    if not len(moving):
        return math.nan
    turns = moving[1:][step[moving[1:]] != step[moving[:-1]]]
    peaks = []
    for at in turns:
        behind = np.abs(turned - turned[at]) <= math.radians(_SPIKE)
        behind[:at] = False
        if behind.any():
            peaks.append(float(np.abs(rest[behind]).max()))
    return max(peaks) if peaks else math.nan


def arcs_in(demand: FloatArray, lines: FloatArray) -> tuple[tuple[int, slice], ...]:
    """Lines whose setpoints (m, 2) lie on an arc that is long enough: the line and its samples."""
    if not len(lines):
        return ()
    edges = np.flatnonzero(np.diff(lines)) + 1
    bounds = [0, *edges.tolist(), len(lines)]
    found = []
    for first, last in pairwise(bounds):
        if last - first < LEAST or not lines[first] > 0:
            continue
        part = demand[first:last]
        moved = np.append(True, (np.abs(np.diff(part, axis=0)) > 1e-9).any(axis=1))
        if moved.sum() < LEAST or np.linalg.matrix_rank(part - part.mean(axis=0), tol=1e-3) < 2:
            continue
        u, v, radius = circle_of(part[moved])
        away = part - (u, v)
        turned = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
        on_it = np.abs(np.hypot(*away.T) - radius).max() <= _ROUND
        if on_it and np.ptp(turned) >= math.radians(LEAST_ANGLE):
            found.append((int(lines[first]), slice(first, last)))
    return tuple(found)


IntArray = npt.NDArray[np.int64]
LEAST_SAMPLES = 10  # samples that a path needs
UNTOLD = "the driver does not report the axis positions, so no path can be compared"
STOOD = "no axis moved in this time range; record while a program runs"
_SAME = 1e-9  # mm: points nearer than that are one


@dataclass(frozen=True, slots=True)
class PathError:
    """Of each measured sample (m,): its distance to the path, mm; of two slides positive to the left of the
    way it goes, of three without a sign.

    ``foot`` (m, 2 or 3) is the nearest point of the path, ``along`` how far along the path that lies, mm,
    ``lines`` the source line there.
    """

    distance: FloatArray
    foot: FloatArray
    along: FloatArray
    lines: IntArray
    measured: FloatArray

    @property
    def greatest(self) -> float:
        """The greatest distance on either side, mm."""
        return float(np.abs(self.distance).max())

    def magnified(self, factor: float) -> FloatArray:
        """The measured path (m, 2 or 3) with its distance from the programmed one so many times as large."""
        return self.foot + factor * (self.measured - self.foot)


@dataclass(frozen=True, slots=True)
class WorstPlace:
    """Where a line is farthest off: its distance, mm, and where on the path."""

    line: int
    distance: float
    place: tuple[float, ...]
    sample: int


def path_error(
    programmed: FloatArray, lines: IntArray, measured: FloatArray, due: IntArray, reach: int
) -> PathError:
    """Distances of ``measured`` (m, k) from the polyline ``programmed`` (n, k) of k = 2 or 3 slides.

    ``lines`` (n,) are the source lines of its points.

    ``due`` (m,) is the point of the polyline at which each sample was to be; its foot is sought ``reach``
    points to both sides of it, so that a path that crosses itself is not taken for its own neighbour.
    Raises AnalysisError.
    """
    _check(programmed, lines, measured, due)
    n = len(programmed)
    lengths = np.linalg.norm(np.diff(programmed, axis=0), axis=1)
    come = np.concatenate([[0.0], np.cumsum(lengths)])
    best = np.full(len(measured), np.inf)
    segment, share = np.zeros(len(measured), dtype=np.int64), np.zeros(len(measured))
    for step in range(-reach, reach):
        at = np.clip(due + step, 0, n - 2)
        start, way = programmed[at], programmed[at + 1] - programmed[at]
        square = (way**2).sum(axis=1)
        dot = ((measured - start) * way).sum(axis=1)
        part = np.clip(np.divide(dot, square, out=np.zeros_like(dot), where=square > _SAME**2), 0.0, 1.0)
        off = ((measured - start - part[:, None] * way) ** 2).sum(axis=1)
        nearer = off < best
        best[nearer], segment[nearer], share[nearer] = off[nearer], at[nearer], part[nearer]
    start, way = programmed[segment], programmed[segment + 1] - programmed[segment]
    foot = start + share[:, None] * way
    distance = np.sqrt(best)
    if programmed.shape[1] == 2:
        beside = measured - foot
        side = np.sign(way[:, 0] * beside[:, 1] - way[:, 1] * beside[:, 0])
        distance = np.where(side < 0.0, -1.0, 1.0) * distance
    return PathError(distance, foot, come[segment] + share * lengths[segment], lines[segment], measured)


def _check(programmed: FloatArray, lines: IntArray, measured: FloatArray, due: IntArray) -> None:
    if len(measured) < LEAST_SAMPLES or len(programmed) < 2:
        raise AnalysisError(
            Message(
                "a path error plot needs at least {minimum} samples of a path; record while a program runs",
                minimum=LEAST_SAMPLES,
            ),
            "too-few-samples",
        )
    if len(lines) != len(programmed) or len(due) != len(measured):
        raise AnalysisError(
            "the number of path points and the number of line numbers differ", "lengths-differ"
        )
    if not (np.isfinite(programmed).all() and np.isfinite(measured).all()):
        raise AnalysisError(UNTOLD, "no-positions")
    if not (np.ptp(programmed, axis=0) > _SAME).any():
        raise AnalysisError(STOOD, "at-rest")


def of_samples(
    demand: FloatArray, actual: FloatArray, lines: FloatArray, rate: float, late: float = 0.1
) -> PathError:
    """Of a record: the setpoints (m, 2 or 3) are the programmed path, ``actual`` what was measured.

    A sample's foot is sought within ``late`` s of the path before and behind. Raises AnalysisError.
    """
    if len(demand) < LEAST_SAMPLES:
        raise AnalysisError(
            Message(
                "a path error plot needs at least {minimum} samples of a path; record while a program runs",
                minimum=LEAST_SAMPLES,
            ),
            "too-few-samples",
        )
    if not (np.isfinite(demand).all() and np.isfinite(actual).all()):
        raise AnalysisError(UNTOLD, "no-positions")
    moved = np.append(True, (np.abs(np.diff(demand, axis=0)) > _SAME).any(axis=1))
    if moved.sum() < 2:
        raise AnalysisError(STOOD, "at-rest")
    due = np.cumsum(moved) - 1
    known = np.where(np.isfinite(lines), lines, 0.0).astype(np.int64)
    path = demand[moved]
    reach = max(2, round(late * rate))
    return path_error(path, known[moved], actual, due.astype(np.int64), reach)


def worst_places(error: PathError, most: int = 10) -> tuple[WorstPlace, ...]:
    """The lines that are farthest off, the worst first; samples of no line (0) are left out."""
    found = []
    for line in np.unique(error.lines[error.lines > 0]):
        of_line = np.flatnonzero(error.lines == line)
        sample = int(of_line[np.argmax(np.abs(error.distance[of_line]))])
        place = tuple(float(each) for each in error.foot[sample])
        found.append(WorstPlace(int(line), float(error.distance[sample]), place, sample))
    return tuple(sorted(found, key=lambda each: -abs(each.distance))[:most])
