"""Where a mill meets the rays of a part: intervals of r that its cylinder covers, exact on straight moves.

A ray runs from the axis outwards at a polar angle. A convex cross-section of what a mill sweeps covers one
interval of it, so that a move is a handful of intervals and no raster of points.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

_TINY = 1e-12


def capsules(
    start: FloatArray, end: FloatArray, radius: float, angles: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The r between which discs moved from ``start`` to ``end`` (m, 2) cover rays at ``angles`` (n,).

    Both (m, n); where nothing is covered the first is not less than the second. mm and radians.
    """
    cos, sin = np.cos(angles), np.sin(angles)
    low0, high0 = _discs(start, radius, cos, sin)
    low1, high1 = _discs(end, radius, cos, sin)
    low2, high2 = _between(start, end, radius, cos, sin)
    # The three overlap or touch wherever the ray meets more than one: what is swept is convex.
    return np.minimum(np.minimum(low0, low1), low2), np.maximum(np.maximum(high0, high1), high2)


def _discs(
    centre: FloatArray, radius: float, cos: FloatArray, sin: FloatArray
) -> tuple[FloatArray, FloatArray]:
    x, y = centre[:, :1], centre[:, 1:]
    along = x * cos + y * sin
    across = x * sin - y * cos
    square = radius * radius - across * across
    half = np.sqrt(np.maximum(square, 0.0))
    return _cleaned(np.maximum(along - half, 0.0), along + half, square > 0.0)


def _between(
    start: FloatArray, end: FloatArray, radius: float, cos: FloatArray, sin: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The rectangle between the first disc and the last."""
    way = end - start
    length = np.hypot(way[:, :1], way[:, 1:])
    unit = way / np.maximum(length, _TINY)
    ux, uy = unit[:, :1], unit[:, 1:]
    along, across = start[:, :1] * ux + start[:, 1:] * uy, start[:, 1:] * ux - start[:, :1] * uy
    low, high = clipped(ux * cos + uy * sin, along, along + length)
    low1, high1 = clipped(ux * sin - uy * cos, across - radius, across + radius)
    low, high = np.maximum(low, low1), np.minimum(high, high1)
    return _cleaned(low, high, (length > _TINY) & (high > low))


def clipped(
    factor: FloatArray, least: FloatArray | float, most: FloatArray | float
) -> tuple[FloatArray, FloatArray]:
    """The r >= 0 for which ``factor`` r lies between two bounds; the first not less than the second: none."""
    upright = np.abs(factor) < _TINY
    safe = np.where(upright, 1.0, factor)
    one, other = least / safe, most / safe
    within = (np.less_equal(least, 0.0)) & (np.greater_equal(most, 0.0))
    low = np.where(upright, np.where(within, 0.0, np.inf), np.maximum(np.minimum(one, other), 0.0))
    high = np.where(upright, np.where(within, np.inf, 0.0), np.maximum(one, other))
    return low, high


def _cleaned(
    low: FloatArray, high: FloatArray, there: npt.NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    there = there & (high > low)
    return np.where(there, low, np.inf), np.where(there, high, -np.inf)


def joined(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The union of intervals (m, n) along the first axis: as few layers (k, n) as hold it, ascending in r.

    Intervals whose high is not above their low are none; in what is returned they stand at infinity.
    """
    there = high > low
    low, high = np.where(there, low, np.inf), np.where(there, high, -np.inf)
    order = np.argsort(low, axis=0)
    low, high = np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)
    reach = np.maximum.accumulate(high, axis=0)
    begins = low < np.inf
    begins[1:] &= low[1:] > reach[:-1]
    layer = np.cumsum(begins, axis=0) - 1
    count = max(int(layer[-1].max()) + 1, 1)
    first, last = np.full((count, low.shape[1]), np.inf), np.full((count, low.shape[1]), -np.inf)
    rows, columns = np.nonzero(begins)
    first[layer[rows, columns], columns] = low[rows, columns]
    rows, columns = np.nonzero(low < np.inf)
    np.maximum.at(last, (layer[rows, columns], columns), high[rows, columns])
    return first, last


def radial_mill(
    turned: FloatArray, half: FloatArray, end: float, length: float, height: float
) -> tuple[FloatArray, FloatArray]:
    """The r (columns, rays) that a mill on a radius of the part covers.

    ``turned`` (rays,) is the angle from the tool's axis to each ray, radians; ``half`` (columns,) half the
    width that the mill has at each column, 0 where it has none; ``end`` and ``length`` where its end stands
    and how far it reaches from there outwards; ``height`` how far its axis passes the part's, mm.
    """
    low, high = clipped(np.cos(turned), end, end + length)
    if height:
        low1, high1 = clipped(np.sin(turned), height - half[:, None], height + half[:, None])
        low, high = np.maximum(low, low1), np.minimum(high, high1)
    else:
        low = np.broadcast_to(low, (len(half), len(turned)))
        high = np.minimum(high, half[:, None] / np.maximum(np.abs(np.sin(turned)), _TINY))
    return _cleaned(low, high, half[:, None] > 0.0)


def nearest_turn(turned: FloatArray, way: float) -> FloatArray:
    """The least angle between each ray and a tool's axis that goes on by ``way``, radians, signed.

    ``turned`` (rays,) is the angle from the axis at its start to each ray.
    """
    middle = np.remainder(turned - 0.5 * way + np.pi, 2.0 * np.pi) - np.pi
    left = np.maximum(np.abs(middle) - 0.5 * abs(way), 0.0)
    return np.asarray(np.copysign(left, middle), dtype=np.float64)
