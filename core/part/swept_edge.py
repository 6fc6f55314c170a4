"""Area that a tool's edge sweeps on a straight move, as the least radius in each column along Z.

An edge is the side of a convex outline that faces the axis or faces away from it. Its sweep along a
straight line is the convex hull of the edge at both ends of the line. The hull consists of the edge up to
the point where it is tangent to the move, the move itself, and the rest of the edge.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Point = tuple[float, float]
"""Point with Z and radius, in mm."""

_UPRIGHT = 1e-9  # mm; a narrower side does not bound a column


class ColumnGrid(NamedTuple):
    """Equally spaced columns along Z, in mm.

    ``column_count`` is the number of columns, ``step_mm`` is their spacing, and ``first_z_mm`` is the middle
    of the first column.
    """

    first_z_mm: float
    step_mm: float
    column_count: int

    @property
    def column_centers(self) -> FloatArray:
        """Return the Z of the middle of each column (number,), as a read-only array."""
        return _find_column_centers(self)

    def find_column(self, z: float) -> int:
        """Return the index of the first column whose middle is at ``z`` or greater.

        The index is limited to the range of the columns.
        """
        return min(max(math.ceil((z - self.first_z_mm) / self.step_mm), 0), self.column_count)


@lru_cache(maxsize=4)
def _find_column_centers(columns: ColumnGrid) -> FloatArray:
    centers: FloatArray = columns.first_z_mm + columns.step_mm * np.arange(
        columns.column_count, dtype=np.float64
    )
    centers.flags.writeable = False
    return centers


class AxisFacingEdge(NamedTuple):
    """The side of a convex outline that faces the axis, as a chain of k points.

    ``z`` (k,) is ascending, ``r`` has the shape (k,), and ``slopes`` (k - 1,) is ascending.
    """

    z: FloatArray
    r: FloatArray
    slopes: FloatArray


def find_axis_facing_edge(outline: FloatArray) -> AxisFacingEdge:
    """Return the side of a convex outline (k, 2) that faces the axis.

    This is the lower convex chain of the outline in Z and r.
    """
    ordered = outline[np.lexsort((outline[:, 1], outline[:, 0]))]
    chain: list[Point] = []
    for z, r in ordered.tolist():
        if chain and z - chain[-1][0] <= _UPRIGHT:
            continue  # directly above, because vertical sides do not bound a column
        while len(chain) > 1 and _turn(chain[-2], chain[-1], (z, r)) <= 0.0:
            chain.pop()
        chain.append((z, r))
    points = np.array(chain)
    return AxisFacingEdge(points[:, 0], points[:, 1], np.diff(points[:, 1]) / np.diff(points[:, 0]))


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def sweep_edge(
    edge: AxisFacingEdge, start: Point, end: Point, columns: ColumnGrid, max_radius_mm: float = math.inf
) -> tuple[int, FloatArray]:
    """Return the first column that the edge reaches, and the smallest r (m,) in each swept column.

    ``start`` and ``end`` are the positions of the outline's origin. Columns at both ends are omitted if the
    edge does not reach a radius less than ``max_radius_mm`` in them.
    """
    (z1, r1), (z0, r0) = (start, end) if start[0] <= end[0] else (end, start)
    z_travel_mm = z0 - z1
    if z_travel_mm <= _UPRIGHT:
        z, r = edge.z + z1, edge.r + min(r0, r1)
    else:
        at = int(edge.slopes.searchsorted((r0 - r1) / z_travel_mm))  # the edge is tangent to the move
        z = np.concatenate((edge.z[: at + 1] + z1, edge.z[at:] + z0))
        r = np.concatenate((edge.r[: at + 1] + r1, edge.r[at:] + r0))
    low, high = _ends_below(z, r, max_radius_mm)
    first, last = columns.find_column(low), columns.find_column(high)
    return first, np.interp(columns.column_centers[first:last], z, r)


def _ends_below(z: FloatArray, r: FloatArray, below: float) -> Point:
    """Return the Z values between which a convex chain (k,) of points has an r less than ``below``."""
    inside = (r < below).nonzero()[0]
    if not len(inside):
        return float(z[0]), float(z[0])
    i, k = int(inside[0]), int(inside[-1])
    low, high = float(z[i]), float(z[k])
    if i > 0:
        low -= (low - float(z[i - 1])) * (below - float(r[i])) / float(r[i - 1] - r[i])
    if k < len(z) - 1:
        high += (float(z[k + 1]) - high) * (below - float(r[k])) / float(r[k + 1] - r[k])
    return low, high
