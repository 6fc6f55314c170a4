"""Spans of a spline between its knots, and a fit of two arcs (a biarc) to every span at once.

A spline in a drawing of 2 MB has tens of thousands of spans, most of which are so short that two arcs fit.
``reader_tools.fit_arcs`` uses the same fit, and halves spans that two arcs do not fit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.extras.drawings.reader_tools import CURVE_SAMPLES, STRAIGHT_TOLERANCE, CurveFunction, CurvePoint
from core.geometry.lines_and_arcs import Point

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_SHORTEST = 1e-12  # parameter difference below which knots are equal
_INSIDE = 1e-6  # fraction of a span; directions are measured this far inside, because a knot may be a corner
_TINY = 1e-12
_AT_ONCE = 4096  # spans calculated together, which limits the memory


class SplineSpans(NamedTuple):
    """The spans of a spline as homogeneous Bézier points and parameter lengths.

    ``control_points`` (n, degree+1, 3) contains x·w, y·w and w. ``parameter_lengths`` has the shape (n,).
    """

    control_points: FloatArray
    parameter_lengths: FloatArray


class Biarc(NamedTuple):
    """Two tangent arcs from ``start`` through their common point ``joint`` to ``end``.

    ``bulges`` contains the tangents of a quarter of their angles.
    """

    start: Point
    joint: Point
    end: Point
    bulges: tuple[float, float]


def make_spans(
    points: Iterable[Sequence[float]], weights: Iterable[float], knots: Iterable[float], degree: int
) -> SplineSpans:
    """Return the spans of a spline with these control points.

    If ``weights`` is empty, all weights are 1. The Bézier points of a span are values of the spline's polar
    form (blossom) at the knots of the span. Raises ValueError if the knots interrupt the spline.
    """
    control, knot = _homogeneous(points, weights), np.sort(np.array(list(knots), dtype=np.float64))
    at = np.arange(degree, len(control))
    low, inside = knot[:-degree], (knot > knot[degree]) & (knot < knot[len(control)])
    if ((knot[degree:] == low) & inside[:-degree]).any():
        raise ValueError("a knot is repeated too often")
    at = at[knot[at + 1] - knot[at] > _SHORTEST]
    made = np.empty((len(at), degree + 1, 3))
    for number in range(degree + 1):
        polar = control[at[:, None] + np.arange(-degree, 1)]
        for level in range(1, degree + 1):
            first = at[:, None] + np.arange(level - degree, 1)
            low, high = knot[first], knot[first + degree + 1 - level]
            argument = knot[at + 1 if level <= number else at][:, None]
            share = ((argument - low) / (high - low))[:, :, None]
            polar = (1.0 - share) * polar[:, :-1] + share * polar[:, 1:]
        made[:, number] = polar[:, 0]
    return SplineSpans(made, knot[at + 1] - knot[at])


def _homogeneous(points: Iterable[Sequence[float]], weights: Iterable[float]) -> FloatArray:
    places = np.array([(p[0], p[1], 1.0) for p in points], dtype=np.float64)
    factors = np.array(list(weights), dtype=np.float64)
    return places * factors[:, None] if len(factors) else places


def make_span_curve(spans: SplineSpans, number: int) -> CurveFunction:
    """Return one span as a curve with a parameter from 0 to 1."""
    points: list[list[float]] = spans.control_points[number].tolist()
    length = float(spans.parameter_lengths[number])
    scale = (len(points) - 1) / length

    def compute_last_point_pair(u: float) -> list[list[float]]:
        """Return the last two weighted points of De Casteljau's algorithm at ``u``."""
        found = points
        while len(found) > 2:
            found = [[a + (b - a) * u for a, b in zip(p, q, strict=True)] for p, q in pairwise(found)]
        return found

    def compute_curve_point(u: float) -> CurvePoint:
        (ax, ay, aw), (bx, by, bw) = compute_last_point_pair(u)
        w = aw + (bw - aw) * u
        at = (ax + (bx - ax) * u) / w, (ay + (by - ay) * u) / w
        held = min(max(u, _INSIDE), 1.0 - _INSIDE)
        if held != u:
            (ax, ay, aw), (bx, by, bw) = compute_last_point_pair(held)
            w = aw + (bw - aw) * held
        size = scale / (w * w)
        return CurvePoint(at, (size * (bx * aw - ax * bw), size * (by * aw - ay * bw)))

    return compute_curve_point


# --- Two arcs for each span. Points and directions are (n, 2).


def fit_biarcs(spans: SplineSpans, tolerance: float) -> Iterator[Biarc | None]:
    """Yield two arcs for each span, or None for a span that no two arcs fit within ``tolerance``."""
    for first in range(0, len(spans.parameter_lengths), _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        with np.errstate(all="ignore"):
            yield from _fitted(
                SplineSpans(spans.control_points[part], spans.parameter_lengths[part]), tolerance
            )


def _fitted(spans: SplineSpans, tolerance: float) -> Iterator[Biarc | None]:
    (a, start_tangents), (b, end_tangents) = _ends(spans, 0.0), _ends(spans, 1.0)
    joint, good = _joints(a, start_tangents, b, end_tangents)
    bulges = np.array([_bulges(a, start_tangents, joint), -_bulges(b, -end_tangents, joint)])
    good &= np.abs(bulges).max(axis=0) <= 1.0
    off = np.zeros(len(a))
    for k in range(1, CURVE_SAMPLES + 1):
        p = _points(spans.control_points, k / (CURVE_SAMPLES + 1))
        np.maximum(off, np.minimum(_apart(p, a, joint, bulges[0]), _apart(p, joint, b, bulges[1])), out=off)
    good &= off <= tolerance
    for fits, *row in zip(
        good.tolist(), a.tolist(), joint.tolist(), b.tolist(), bulges.T.tolist(), strict=True
    ):
        yield Biarc(*map(tuple, row)) if fits else None


def _levels(control: FloatArray, u: float, keep: int) -> FloatArray:
    while control.shape[1] > keep:
        control = control[:, :-1] + (control[:, 1:] - control[:, :-1]) * u
    return control


def _points(control: FloatArray, u: float) -> FloatArray:
    last = _levels(control, u, 1)[:, 0]
    return last[:, :2] / last[:, 2:]


def _ends(spans: SplineSpans, u: float) -> tuple[FloatArray, FloatArray]:
    """Return the points of all spans at ``u``, and the tangent directions just inside the spans."""
    held = min(max(u, _INSIDE), 1.0 - _INSIDE)
    pair = _levels(spans.control_points, held, 2)
    p, q = pair[:, 0], pair[:, 1]
    w = p[:, 2] + (q[:, 2] - p[:, 2]) * held
    size = (spans.control_points.shape[1] - 1) / (spans.parameter_lengths * w * w)
    return _points(spans.control_points, u), size[:, None] * (q[:, :2] * p[:, 2:] - p[:, :2] * q[:, 2:])


def _joints(
    a: FloatArray, start_tangents: FloatArray, b: FloatArray, end_tangents: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the points at which the two arcs of each span meet, and whether each point exists."""
    sizes = np.array([np.hypot(*start_tangents.T), np.hypot(*end_tangents.T)])
    one, other, v = start_tangents / sizes[0][:, None], end_tangents / sizes[1][:, None], b - a
    vt, vv = (v * (one + other)).sum(axis=1), (v * v).sum(axis=1)
    both = 2.0 * (1.0 - (one * other).sum(axis=1))
    along = (v * other).sum(axis=1)
    straight = both < 1e-9
    far = np.where(straight, vv / (4.0 * along), (-vt + np.sqrt(vt * vt + both * vv)) / both)
    good = (sizes > _TINY).all(axis=0) & (vv >= 1e-24) & (far > 0.0)
    good &= ~straight | (np.abs(along) >= _TINY)
    return 0.5 * (a + b + far[:, None] * (one - other)), good


def _bulges(at: FloatArray, tangents: FloatArray, to: FloatArray) -> FloatArray:
    """Return the bulges of arcs, given their start points, start directions and end points."""
    d = to - at
    half = np.arctan2(tangents[:, 0] * d[:, 1] - tangents[:, 1] * d[:, 0], (tangents * d).sum(axis=1))
    return np.where(np.abs(half) < STRAIGHT_TOLERANCE, 0.0, np.tan(0.5 * half))


def _apart(p: FloatArray, a: FloatArray, b: FloatArray, bulge: FloatArray) -> FloatArray:
    """Return the distance (n,) of each point from its arc or line.

    If the foot of the perpendicular is outside the arc or line, the distance from the nearer end is
    returned.
    """
    d = b - a
    chord = np.hypot(*d.T)
    from_ends = np.minimum(np.hypot(*(p - a).T), np.hypot(*(p - b).T))
    along = ((p - a) * d).sum(axis=1) / chord
    side = (p[:, 0] - a[:, 0]) * d[:, 1] - (p[:, 1] - a[:, 1]) * d[:, 0]
    off = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = 0.5 * (a + b) + off[:, None] * np.stack([-d[:, 1], d[:, 0]], axis=1)
    radius = np.hypot(*(centre - a).T)
    line = np.abs(bulge) < 1e-9
    on_line = (along >= 0.0) & (along <= chord)
    on_arc = (side * bulge >= 0.0) | (np.abs(side) < chord * radius * 1e-6)
    to = np.where(line, np.abs(side) / chord, np.abs(np.hypot(*(p - centre).T) - radius))
    near = np.where(np.where(line, on_line, on_arc), to, from_ends)
    apart: FloatArray = np.where(chord < _TINY, np.hypot(*(p - a).T), near)
    return apart
