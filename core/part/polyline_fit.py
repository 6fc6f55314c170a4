"""A polyline with as few of its points as hold it within a tolerance (Ramer, Douglas and Peucker)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def simplified(points: FloatArray, tolerance: float) -> FloatArray:
    """Points (k, 2) of (n, 2), ends included: no other lies further off their polyline than ``tolerance``."""
    kept = np.zeros(len(points), dtype=bool)
    kept[[0, -1]] = True
    todo = [(0, len(points) - 1)]
    while todo:
        first, last = todo.pop()
        if last - first < 2:
            continue
        off = _distances(points[first + 1 : last], points[first], points[last])
        worst = int(off.argmax())
        if off[worst] > tolerance:
            middle = first + 1 + worst
            kept[middle] = True
            todo += [(first, middle), (middle, last)]
    return points[kept]


def _distances(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """How far each point (n, 2) lies from the straight line between two."""
    way: FloatArray = end - start
    length = float(np.hypot(*way))
    away = points - start
    if length == 0.0:
        return np.hypot(away[:, 0], away[:, 1])
    off: FloatArray = np.abs(way[0] * away[:, 1] - way[1] * away[:, 0]) / length
    return off
