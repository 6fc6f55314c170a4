"""Projection of a path and of the section of a part onto pixels, reduced to the visible points.

All functions process whole arrays without a Python loop over the points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from app.path.polyline import Polyline
    from core.part.stock import Clamping, Stock
    from core.proving.part_instant import Half, Hit


Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Projection:
    """Visible area: the point (z, x) in the middle, the size in pixels, and ``scale`` in pixels per mm."""

    z: float
    x: float
    scale: float
    width: int
    height: int

    def across(self, z: Floats | float) -> Floats | float:
        """Return the pixel column of a Z position. Z+ is to the right."""
        return self.width / 2 + (z - self.z) * self.scale

    def down(self, x: Floats | float) -> Floats | float:
        """Return the pixel row of an X radius. X+ is down, towards the operator."""
        return self.height / 2 + (x - self.x) * self.scale

    def zoomed(self, factor: float, column: float, row: float) -> Projection:
        """Return a projection magnified by ``factor``.

        The point at (column, row) remains in place.
        """
        scale = min(max(self.scale * factor, 0.02), 5000.0)
        z = self.z + (column - self.width / 2) * (1 / self.scale - 1 / scale)
        x = self.x + (row - self.height / 2) * (1 / self.scale - 1 / scale)
        return Projection(z, x, scale, self.width, self.height)

    def moved(self, columns: float, rows: float) -> Projection:
        """Return the projection shifted by a number of pixels."""
        z, x = self.z - columns / self.scale, self.x - rows / self.scale
        return Projection(z, x, self.scale, self.width, self.height)


def fitted(bounds: tuple[float, float, float, float], width: int, height: int, margin: float) -> Projection:
    """Return a projection of all cuts and their mirror image across X0, with a margin in pixels."""
    z0, z1, x0, x1 = bounds
    reach = max(abs(x0), abs(x1), 0.5)
    across, down = max(width - 2 * margin, 10.0), max(height - 2 * margin, 10.0)
    scale = min(across / max(z1 - z0, 1.0), down / (2 * reach))
    return Projection((z0 + z1) / 2, 0.0, scale, width, height)


def boxed(bounds: tuple[float, float, float, float], width: int, height: int, margin: float) -> Projection:
    """Return a projection of the bounds only, with a margin in pixels."""
    z0, z1, x0, x1 = bounds
    across, down = max(width - 2 * margin, 10.0), max(height - 2 * margin, 10.0)
    scale = min(across / max(z1 - z0, 1.0), down / max(x1 - x0, 1.0))
    return Projection((z0 + z1) / 2, (x0 + x1) / 2, scale, width, height)


class Shape(NamedTuple):
    """Points in pixels, with the stroke that ends at each point."""

    columns: Floats
    rows: Floats
    stroke: npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Run:
    """Consecutive points of one stroke, in pixels."""

    stroke: int
    columns: Floats
    rows: Floats


def points(polyline: Polyline, projection: Projection, start: int, end: int) -> Shape:
    """Return points ``start`` to ``end - 1`` and the preceding point, reduced to pixel resolution."""
    low = max(0, start - 1)
    columns = np.asarray(projection.across(polyline.z[low:end]), dtype=np.float64)
    rows = np.asarray(projection.down(polyline.x[low:end]), dtype=np.float64)
    stroke = polyline.stroke[low:end].copy()
    if start > 0 and len(stroke):
        stroke[0] = 0
    keep = _telling(columns, rows, stroke)
    return Shape(columns[keep], rows[keep], stroke[keep])


def runs(polyline: Polyline, projection: Projection, start: int, end: int) -> Iterator[Run]:
    """Yield the strokes that end in points ``start`` to ``end - 1``, reduced to pixels and clipped."""
    columns, rows, stroke = points(polyline, projection, start, end)
    stroke[1:][_outside(columns, rows, projection)] = 0
    edges = np.flatnonzero(np.diff(stroke)) + 1
    for a, b in zip(np.append(0, edges), np.append(edges, len(stroke)), strict=True):
        kind = int(stroke[a]) if b > a else 0
        if kind and a > 0:
            yield Run(kind, columns[a - 1 : b], rows[a - 1 : b])


def _telling(columns: Floats, rows: Floats, stroke: npt.NDArray[np.uint8]) -> npt.NDArray[np.bool_]:
    """Return a mask of points that are on another pixel than the preceding point or change the stroke."""
    c, r = np.rint(columns * 2), np.rint(rows * 2)
    keep = np.ones(len(c), dtype=np.bool_)
    keep[1:-1] = (c[1:-1] != c[:-2]) | (r[1:-1] != r[:-2]) | (stroke[1:-1] != stroke[2:])
    return keep


def _outside(columns: Floats, rows: Floats, projection: Projection) -> npt.NDArray[np.bool_]:
    """Return a mask of the chords with both ends outside the same edge."""
    out = np.zeros(max(0, len(columns) - 1), dtype=np.bool_)
    for beyond in (columns < 0, columns > projection.width, rows < 0, rows > projection.height):
        out |= beyond[1:] & beyond[:-1]
    return out


def travelled(polyline: Polyline, projection: Projection, block: int, z: float, x: float) -> Run | None:
    """Return the finished part of a block, or None if nothing is drawn.

    The part consists of the points of the block up to the tip at (z, x).
    """
    if not 1 <= block <= polyline.blocks:
        return None
    start, end = int(polyline.first[block - 1]), int(polyline.first[block])
    if start < end and polyline.stroke[start] == 0:
        start += 1  # a jump to the tip of another tool
    if start >= end or start == 0:
        return None
    zs, xs = polyline.z[start - 1 : end], polyline.x[start - 1 : end]
    last = _nearest_chord(zs, xs, z, x) + 1
    columns = np.append(np.asarray(projection.across(zs[:last])), projection.across(z))
    rows = np.append(np.asarray(projection.down(xs[:last])), projection.down(x))
    return Run(int(polyline.stroke[start]), columns, rows)


def _nearest_chord(zs: Floats, xs: Floats, z: float, x: float) -> int:
    """Return the index of the chord nearest to a point."""
    dz, dx = np.diff(zs), np.diff(xs)
    size = np.maximum(dz * dz + dx * dx, 1e-18)
    share = np.clip(((z - zs[:-1]) * dz + (x - xs[:-1]) * dx) / size, 0.0, 1.0)
    off = (zs[:-1] + share * dz - z) ** 2 + (xs[:-1] + share * dx - x) ** 2
    return int(np.argmin(off))


def scale_length(most: float, metric: bool) -> tuple[float, str]:
    """Return the longest round length up to ``most`` mm, and its text in the unit in force."""
    unit, name = (1.0, "mm") if metric else (25.4, "in")
    decade = 10.0 ** np.floor(np.log10(max(most / unit, 1e-9)))
    step = max((k for k in (1.0, 2.0, 5.0) if k * decade <= most / unit * (1 + 1e-9)), default=1.0)
    return float(step * decade * unit), f"{step * decade:g} {name}"


class Ends(NamedTuple):
    """Starts and ends of chords as columns and rows, in pixels."""

    c0: Floats
    r0: Floats
    c1: Floats
    r1: Floats


def clipped(ends: Ends, right: int, bottom: int) -> tuple[Ends, npt.NDArray[np.bool_]]:
    """Return the parts of chords within (0, 0) to (right, bottom), and a mask of the visible chords.

    The method is Liang–Barsky line clipping.
    """
    dc, dr = ends.c1 - ends.c0, ends.r1 - ends.r0
    enter, leave = np.zeros(len(dc)), np.ones(len(dc))
    inside = np.ones(len(dc), dtype=np.bool_)
    for towards, room in ((-dc, ends.c0), (dc, right - ends.c0), (-dr, ends.r0), (dr, bottom - ends.r0)):
        along = towards == 0
        inside &= ~(along & (room < 0))
        at = np.divide(room, towards, out=np.zeros(len(dc)), where=~along)
        enter = np.where(towards < 0, np.maximum(enter, at), enter)
        leave = np.where(towards > 0, np.minimum(leave, at), leave)
    inside &= enter <= leave
    c0, r0, dc, dr, enter, leave = (a[inside] for a in (ends.c0, ends.r0, dc, dr, enter, leave))
    return Ends(c0 + enter * dc, r0 + enter * dr, c0 + leave * dc, r0 + leave * dr), inside


def stepped(ends: Ends) -> tuple[Indices, Indices, Indices]:
    """Return column, row and chord index of every pixel of all chords, in chord order."""
    dc, dr = ends.c1 - ends.c0, ends.r1 - ends.r0
    steps = np.ceil(np.maximum(np.abs(dc), np.abs(dr))).astype(np.int64)
    count = steps + 1
    which = np.repeat(np.arange(len(count)), count)
    first = np.repeat(np.cumsum(count) - count, count)
    share = (np.arange(len(which)) - first) / np.maximum(steps, 1)[which]
    column = np.rint(ends.c0[which] + share * dc[which]).astype(np.int64)
    row = np.rint(ends.r0[which] + share * dr[which]).astype(np.int64)
    return column, row, which


_METAL = 1e-4  # mm; thinner material is ignored
_FINE = 4.0  # row resolution, in fractions of a pixel
_BEYOND = 40.0  # pixels outside the frame that are still drawn


class Line(NamedTuple):
    """Points in pixels. Both arrays have the shape (n,)."""

    columns: Floats
    rows: Floats


class Metal(NamedTuple):
    """One area of a section, with the edges that are drawn as lines."""

    area: Line
    edges: tuple[Line, ...]


def metal_of(half: Half, projection: Projection, *, far: bool) -> list[Metal]:
    """Return the material of one half of the section.

    ``far`` selects the upper half, beyond the axis.
    """
    first, last = _seen(half.edges, projection)
    found = []
    edges = half.edges[first : last + 1]
    for low, high in zip(half.low[:, first:last], half.high[:, first:last], strict=True):
        for run in _runs(high - low > _METAL):
            ends = edges[run.start : run.stop + 1]
            found.append(_piece(ends, low[run], high[run], projection, -1.0 if far else 1.0))
    return found


def hit_areas(hit: Hit, projection: Projection) -> list[Line]:
    """Return the areas of a collision on both sides of the axis."""
    gaps = np.flatnonzero(np.diff(hit.z) > 1.5 * hit.wide) + 1
    found = []
    for run in np.split(np.arange(len(hit.z)), gaps):
        z = np.concatenate([[hit.z[run[0]] - hit.wide / 2], hit.z[run], [hit.z[run[-1]] + hit.wide / 2]])
        low, high = (_padded(r[run]) for r in (hit.low, hit.high))
        found += [
            _ring(_line(z, side * low, projection), _line(z, side * high, projection)) for side in (1.0, -1.0)
        ]
    return found


def stock_outline(stock: Stock, projection: Projection) -> list[Line]:
    """Return the outline of the stock before the first cut."""
    found = []
    for profile in (stock.outside, stock.bore):
        if profile:
            z, r = np.array(profile).T
            found += [_line(z, side * r, projection) for side in (1.0, -1.0)]
    for z in (stock.back, stock.front):
        r = float(stock.outside_at(np.array([z]))[0])
        found.append(_line(np.array([z, z]), np.array([-r, r]), projection))
    return found


def stock_areas(stock: Stock, projection: Projection) -> list[Line]:
    """Return the areas of the section of the stock on both sides of the axis."""
    z, r = np.array(stock.outside).T
    inner_z, inner_r = np.array(stock.bore or ((stock.back, 0.0), (stock.front, 0.0))).T
    return [
        _ring(_line(z, side * r, projection), _line(inner_z, side * inner_r, projection))
        for side in (1.0, -1.0)
    ]


def clamping_areas(clamping: Clamping, stock: Stock, projection: Projection) -> list[Line]:
    """Return the areas of the chuck or collet on both sides, and of the tailstock center."""
    found: list[Line] = []
    if clamping.diameter:
        held = clamping.around(stock)
        (z, r), (inner_z, inner_r) = np.array(held.outside).T, np.array(held.bore).T
        found += [
            _ring(_line(z, side * r, projection), _line(inner_z, side * inner_r, projection))
            for side in (1.0, -1.0)
        ]
    tailstock = clamping.tailstock
    if tailstock is not None:
        z, r = np.array(tailstock.outside).T
        found.append(_ring(_line(z, r, projection), _line(z, -r, projection)))
    return found


def _piece(edges: Floats, low: Floats, high: Floats, projection: Projection, side: float) -> Metal:
    z = np.concatenate([edges[:1], (edges[1:] + edges[:-1]) / 2, edges[-1:]])
    low, high = _padded(low), _padded(high)
    outside, inside = _line(z, side * high, projection), _line(z, side * low, projection)
    first, last = (Line(inside.columns[[at]], inside.rows[[at]]) for at in (0, -1))
    contour = Line(
        np.concatenate([first.columns, outside.columns, last.columns]),
        np.concatenate([first.rows, outside.rows, last.rows]),
    )
    bores = [_line(z[run], side * low[run], projection) for run in _runs(_spread(low > _METAL))]
    return Metal(_ring(inside, outside), (contour, *bores))


def _spread(wanted: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return the mask extended by one element on both sides."""
    wider = wanted.copy()
    wider[1:] |= wanted[:-1]
    wider[:-1] |= wanted[1:]
    return wider


def _line(z: Floats, r: Floats, projection: Projection) -> Line:
    columns = np.asarray(projection.across(z), dtype=np.float64)
    rows = np.asarray(projection.down(r), dtype=np.float64)
    return _thinned(Line(columns, rows))


def _ring(there: Line, back: Line) -> Line:
    return Line(
        np.concatenate([there.columns, back.columns[::-1]]), np.concatenate([there.rows, back.rows[::-1]])
    )


def _thinned(line: Line) -> Line:
    """Return the line without points on straight level runs and without points on the same pixel."""
    c, r = np.rint(line.columns * 2.0), np.rint(line.rows * _FINE)
    keep = np.ones(len(c), dtype=np.bool_)
    keep[1:-1] = (r[1:-1] != r[:-2]) | (r[1:-1] != r[2:])
    there = np.flatnonzero(keep)
    c, r = c[there], r[there]
    same = np.zeros(len(there), dtype=np.bool_)
    same[1:-1] = (c[1:-1] == c[:-2]) & (r[1:-1] == r[:-2])
    there = there[~same]
    return Line(line.columns[there], line.rows[there])


def _padded(r: Floats) -> Floats:
    return np.concatenate([r[:1], r, r[-1:]])


def _seen(edges: Floats, projection: Projection) -> tuple[int, int]:
    """Return the range of visible columns: the first, and the last plus one."""
    half = (projection.width / 2 + _BEYOND) / projection.scale
    first = int(np.searchsorted(edges, projection.z - half)) - 1
    last = int(np.searchsorted(edges, projection.z + half))
    return max(first, 0), min(last, len(edges) - 1)


def _runs(wanted: npt.NDArray[np.bool_]) -> list[slice]:
    bounds = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).tolist()
    return [slice(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True)]
