"""The section of a part on the screen: outlines of its metal in pixels, thinned out to what can be seen."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from app.path.path_projection import Floats, Projection

if TYPE_CHECKING:
    from core.part.stock import Clamping, Stock
    from core.proving.part_instant import Half, Hit

_METAL = 1e-4  # mm; less is no metal
_FINE = 4.0  # parts of a pixel that rows are told apart by
_BEYOND = 40.0  # pixels beyond the frame that are drawn


class Line(NamedTuple):
    """Points in pixels (n,)."""

    columns: Floats
    rows: Floats


class Metal(NamedTuple):
    """One piece of a section: what to fill, and the edges of it that are lines of the drawing."""

    area: Line
    edges: tuple[Line, ...]


def metal_of(half: Half, projection: Projection, *, far: bool) -> list[Metal]:
    """The metal of one side of the section; ``far``: of that beyond the axis, which is the upper one."""
    first, last = _seen(half.edges, projection)
    found = []
    edges = half.edges[first : last + 1]
    for low, high in zip(half.low[:, first:last], half.high[:, first:last], strict=True):
        for run in _runs(high - low > _METAL):
            ends = edges[run.start : run.stop + 1]
            found.append(_piece(ends, low[run], high[run], projection, -1.0 if far else 1.0))
    return found


def hit_areas(hit: Hit, projection: Projection) -> list[Line]:
    """What was met where nothing may be met, on both sides of the axis."""
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
    """The stock before the first cut."""
    found = []
    for profile in (stock.outside, stock.bore):
        if profile:
            z, r = np.array(profile).T
            found += [_line(z, side * r, projection) for side in (1.0, -1.0)]
    for z in (stock.back, stock.front):
        r = float(stock.outside_at(np.array([z]))[0])
        found.append(_line(np.array([z, z]), np.array([-r, r]), projection))
    return found


def clamping_areas(clamping: Clamping, stock: Stock, projection: Projection) -> list[Line]:
    """Chuck or collet on both sides of what it holds, and the tailstock's centre."""
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
    """With the neighbours on both sides."""
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
    """Without the points that lie level between level neighbours, and those that fall on one pixel."""
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
    """The columns that are in the frame: the first, and behind the last."""
    half = (projection.width / 2 + _BEYOND) / projection.scale
    first = int(np.searchsorted(edges, projection.z - half)) - 1
    last = int(np.searchsorted(edges, projection.z + half))
    return max(first, 0), min(last, len(edges) - 1)


def _runs(wanted: npt.NDArray[np.bool_]) -> list[slice]:
    bounds = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).tolist()
    return [slice(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True)]
