"""What a tool's edge sweeps along a straight move: of each column along Z the radius that it reaches.

An edge is one side of a convex outline, towards the axis or away from it. Swept along a straight line it
bounds the convex hull of the edge at both ends: the part of the edge up to the point where it is tangent to
the move, the move itself, and the rest of the edge.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Point = tuple[float, float]
"""Z and r, mm."""

_UPRIGHT = 1e-9  # mm; a side no wider than this bounds no column


class Columns(NamedTuple):
    """Columns along Z: ``number`` of them, ``step`` apart, the first one's middle at ``first``; mm."""

    first: float
    step: float
    number: int

    @property
    def middles(self) -> FloatArray:
        """Z of each, (number,)."""
        middles: FloatArray = self.first + self.step * np.arange(self.number, dtype=np.float64)
        return middles

    def at(self, z: float) -> int:
        """The first column that does not lie before ``z``, held within what there is."""
        return min(max(math.ceil((z - self.first) / self.step), 0), self.number)


class Edge(NamedTuple):
    """The side of a convex outline that looks to the axis: Z rising (k,), r (k,), slopes rising (k - 1,)."""

    z: FloatArray
    r: FloatArray
    slope: FloatArray


def towards_axis(outline: FloatArray) -> Edge:
    """The side of a convex outline (k, 2) of Z and r that looks to the axis: its lower convex chain."""
    ordered = outline[np.lexsort((outline[:, 1], outline[:, 0]))]
    chain: list[Point] = []
    for z, r in ordered.tolist():
        if chain and z - chain[-1][0] <= _UPRIGHT:
            continue  # straight above: the sides of the outline bound no column
        while len(chain) > 1 and _turn(chain[-2], chain[-1], (z, r)) <= 0.0:
            chain.pop()
        chain.append((z, r))
    points = np.array(chain)
    return Edge(points[:, 0], points[:, 1], np.diff(points[:, 1]) / np.diff(points[:, 0]))


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def sweep(edge: Edge, start: Point, end: Point, columns: Columns) -> tuple[int, FloatArray]:
    """The first column that is reached, and the least r (m,) that the edge has in each on its way.

    ``start`` and ``end`` are where the outline's origin stands.
    """
    (z1, r1), (z0, r0) = (start, end) if start[0] <= end[0] else (end, start)
    way = z0 - z1
    if way <= _UPRIGHT:
        return _standing(edge, z1, min(r0, r1), columns)
    slope = (r0 - r1) / way
    tangent = int(edge.slope.searchsorted(slope))
    low, high = float(edge.z[0]), float(edge.z[-1])
    first, last = columns.at(low + z1), columns.at(high + z0)
    reached = np.empty(max(last - first, 0))
    if last <= first:
        return first, reached
    corner = float(edge.z[tangent])
    a, b = max(columns.at(corner + z1), first) - first, min(columns.at(corner + z0), last) - first
    begin, step = columns.first + columns.step * first, columns.step
    if a > 0:
        there = begin + step * np.arange(a)
        reached[:a] = np.interp(there, edge.z[: tangent + 1] + z1, edge.r[: tangent + 1] + r1)
    if a < b:
        along = float(edge.r[tangent]) + r1
        if slope == 0.0:
            reached[a:b] = along
        else:
            along += slope * (begin + step * a - (corner + z1))
            reached[a:b] = along + slope * step * np.arange(b - a)
    if b < len(reached):
        there = begin + step * np.arange(b, len(reached))
        reached[b:] = np.interp(there, edge.z[tangent:] + z0, edge.r[tangent:] + r0)
    return first, reached


def _standing(edge: Edge, z: float, r: float, columns: Columns) -> tuple[int, FloatArray]:
    first, last = columns.at(float(edge.z[0]) + z), columns.at(float(edge.z[-1]) + z)
    there = columns.first + columns.step * np.arange(first, max(first, last))
    return first, np.interp(there, edge.z + z, edge.r + r)
