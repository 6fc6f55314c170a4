"""Ball-bar plot of an arc: roundness, backlash and spikes at reversals, squareness and scale of two axes.

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
