"""Projection of a path and of the section of a part onto pixels.

Only the visible points are calculated. All functions process whole arrays without a Python loop over the
points.
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
    from core.proving.part_instant import MaterialHit, SectionHalf


FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Projection:
    """Mapping of the viewed plane to pixels: the middle of the view (z, x), its size and its scale.

    The size is in pixels, and ``pixels_per_mm`` is the scale in pixels per mm.
    """

    center_z: float
    center_x: float
    pixels_per_mm: float
    width_px: int
    height_px: int

    def find_pixel_column(self, z: FloatArray | float) -> FloatArray | float:
        """Return the pixel column of a Z position. Z+ is to the right."""
        return self.width_px / 2 + (z - self.center_z) * self.pixels_per_mm

    def find_pixel_row(self, x: FloatArray | float) -> FloatArray | float:
        """Return the pixel row of an X radius. X+ is down, towards the operator."""
        return self.height_px / 2 + (x - self.center_x) * self.pixels_per_mm

    def magnify(self, factor: float, column: float, row: float) -> Projection:
        """Return a projection magnified by ``factor``.

        The point at (column, row) does not move.
        """
        scale = min(max(self.pixels_per_mm * factor, 0.02), 5000.0)
        z = self.center_z + (column - self.width_px / 2) * (1 / self.pixels_per_mm - 1 / scale)
        x = self.center_x + (row - self.height_px / 2) * (1 / self.pixels_per_mm - 1 / scale)
        return Projection(z, x, scale, self.width_px, self.height_px)

    def shift(self, column_count: float, row_count: float) -> Projection:
        """Return the projection shifted by a number of pixels."""
        z, x = (
            self.center_z - column_count / self.pixels_per_mm,
            self.center_x - row_count / self.pixels_per_mm,
        )
        return Projection(z, x, self.pixels_per_mm, self.width_px, self.height_px)


def fit_mirrored_projection(
    bounds: tuple[float, float, float, float], width: int, height: int, margin: float
) -> Projection:
    """Return a projection that shows all cuts and their mirror image on the other side of X0.

    The margin is in pixels.
    """
    z0, z1, x0, x1 = bounds
    reach = max(abs(x0), abs(x1), 0.5)
    across, down = max(width - 2 * margin, 10.0), max(height - 2 * margin, 10.0)
    scale = min(across / max(z1 - z0, 1.0), down / (2 * reach))
    return Projection((z0 + z1) / 2, 0.0, scale, width, height)


def fit_projection(
    bounds: tuple[float, float, float, float], width: int, height: int, margin: float
) -> Projection:
    """Return a projection that shows only the bounds, with a margin in pixels."""
    z0, z1, x0, x1 = bounds
    across, down = max(width - 2 * margin, 10.0), max(height - 2 * margin, 10.0)
    scale = min(across / max(z1 - z0, 1.0), down / max(x1 - x0, 1.0))
    return Projection((z0 + z1) / 2, (x0 + x1) / 2, scale, width, height)


class Shape(NamedTuple):
    """Points of a polyline in pixels, each with the kind of stroke that ends there."""

    columns: FloatArray
    rows: FloatArray
    stroke_kinds: npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class StrokeRun:
    """Consecutive points of the same kind of stroke, in pixels."""

    stroke_kind: int
    columns: FloatArray
    rows: FloatArray


def project_points(polyline: Polyline, projection: Projection, start: int, end: int) -> Shape:
    """Return points ``start`` to ``end - 1`` and the preceding point, reduced to pixel resolution."""
    low = max(0, start - 1)
    columns = np.asarray(projection.find_pixel_column(polyline.z[low:end]), dtype=np.float64)
    rows = np.asarray(projection.find_pixel_row(polyline.x[low:end]), dtype=np.float64)
    stroke = polyline.stroke[low:end].copy()
    if start > 0 and len(stroke):
        stroke[0] = 0
    keep = _find_visible_points(columns, rows, stroke)
    return Shape(columns[keep], rows[keep], stroke[keep])


def project_strokes(polyline: Polyline, projection: Projection, start: int, end: int) -> Iterator[StrokeRun]:
    """Yield the strokes that end at points ``start`` to ``end - 1``, reduced to pixels and clipped."""
    columns, rows, stroke = project_points(polyline, projection, start, end)
    stroke[1:][_find_outside(columns, rows, projection)] = 0
    edges = np.flatnonzero(np.diff(stroke)) + 1
    for a, b in zip(np.append(0, edges), np.append(edges, len(stroke)), strict=True):
        kind = int(stroke[a]) if b > a else 0
        if kind and a > 0:
            yield StrokeRun(kind, columns[a - 1 : b], rows[a - 1 : b])


def _find_visible_points(
    columns: FloatArray, rows: FloatArray, stroke: npt.NDArray[np.uint8]
) -> npt.NDArray[np.bool_]:
    """Return a mask of the points to draw.

    A point is drawn if its pixel differs from that of the preceding point, or if the stroke changes there.
    """
    c, r = np.rint(columns * 2), np.rint(rows * 2)
    keep = np.ones(len(c), dtype=np.bool_)
    keep[1:-1] = (c[1:-1] != c[:-2]) | (r[1:-1] != r[:-2]) | (stroke[1:-1] != stroke[2:])
    return keep


def _find_outside(columns: FloatArray, rows: FloatArray, projection: Projection) -> npt.NDArray[np.bool_]:
    """Return a mask of the lines that are completely outside the same edge of the visible area."""
    out = np.zeros(max(0, len(columns) - 1), dtype=np.bool_)
    for beyond in (columns < 0, columns > projection.width_px, rows < 0, rows > projection.height_px):
        out |= beyond[1:] & beyond[:-1]
    return out


def project_block_progress(
    polyline: Polyline, projection: Projection, block_number: int, z: float, x: float
) -> StrokeRun | None:
    """Return the finished part of a block in pixels, or None if nothing is drawn.

    The finished part consists of the points of the block up to the tip at (z, x).
    """
    if not 1 <= block_number <= polyline.blocks:
        return None
    start, end = int(polyline.first[block_number - 1]), int(polyline.first[block_number])
    if start < end and polyline.stroke[start] == 0:
        start += 1  # a jump to the tip of another tool
    if start >= end or start == 0:
        return None
    zs, xs = polyline.z[start - 1 : end], polyline.x[start - 1 : end]
    last = _find_nearest_chord(zs, xs, z, x) + 1
    columns = np.append(np.asarray(projection.find_pixel_column(zs[:last])), projection.find_pixel_column(z))
    rows = np.append(np.asarray(projection.find_pixel_row(xs[:last])), projection.find_pixel_row(x))
    return StrokeRun(int(polyline.stroke[start]), columns, rows)


def _find_nearest_chord(zs: FloatArray, xs: FloatArray, z: float, x: float) -> int:
    """Return the index of the chord nearest to a point."""
    dz, dx = np.diff(zs), np.diff(xs)
    size = np.maximum(dz * dz + dx * dx, 1e-18)
    share = np.clip(((z - zs[:-1]) * dz + (x - xs[:-1]) * dx) / size, 0.0, 1.0)
    off = (zs[:-1] + share * dz - z) ** 2 + (xs[:-1] + share * dx - x) ** 2
    return int(np.argmin(off))


def find_scale_length(maximum_mm: float, is_metric: bool) -> tuple[float, str]:
    """Return the longest round length up to ``maximum_mm``, and its text in the current unit."""
    unit, name = (1.0, "mm") if is_metric else (25.4, "in")
    decade = 10.0 ** np.floor(np.log10(max(maximum_mm / unit, 1e-9)))
    step = max((k for k in (1.0, 2.0, 5.0) if k * decade <= maximum_mm / unit * (1 + 1e-9)), default=1.0)
    return float(step * decade * unit), f"{step * decade:g} {name}"


class ChordEnds(NamedTuple):
    """Start and end points of chords (lines between path points) as columns and rows, in pixels."""

    start_columns: FloatArray
    start_rows: FloatArray
    end_columns: FloatArray
    end_rows: FloatArray


def clip_chords(chords: ChordEnds, right: int, bottom: int) -> tuple[ChordEnds, npt.NDArray[np.bool_]]:
    """Return the parts of the chords within (0, 0) to (right, bottom), and a mask of the visible chords.

    The method is Liang–Barsky line clipping.
    """
    dc, dr = chords.end_columns - chords.start_columns, chords.end_rows - chords.start_rows
    enter, leave = np.zeros(len(dc)), np.ones(len(dc))
    inside = np.ones(len(dc), dtype=np.bool_)
    for towards, room in (
        (-dc, chords.start_columns),
        (dc, right - chords.start_columns),
        (-dr, chords.start_rows),
        (dr, bottom - chords.start_rows),
    ):
        along = towards == 0
        inside &= ~(along & (room < 0))
        at = np.divide(room, towards, out=np.zeros(len(dc)), where=~along)
        enter = np.where(towards < 0, np.maximum(enter, at), enter)
        leave = np.where(towards > 0, np.minimum(leave, at), leave)
    inside &= enter <= leave
    c0, r0, dc, dr, enter, leave = (
        a[inside] for a in (chords.start_columns, chords.start_rows, dc, dr, enter, leave)
    )
    return ChordEnds(c0 + enter * dc, r0 + enter * dr, c0 + leave * dc, r0 + leave * dr), inside


def rasterize_chords(chords: ChordEnds) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Return every pixel of all lines as arrays of column, row and line index, line by line."""
    dc, dr = chords.end_columns - chords.start_columns, chords.end_rows - chords.start_rows
    steps = np.ceil(np.maximum(np.abs(dc), np.abs(dr))).astype(np.int64)
    count = steps + 1
    which = np.repeat(np.arange(len(count)), count)
    first = np.repeat(np.cumsum(count) - count, count)
    share = (np.arange(len(which)) - first) / np.maximum(steps, 1)[which]
    column = np.rint(chords.start_columns[which] + share * dc[which]).astype(np.int64)
    row = np.rint(chords.start_rows[which] + share * dr[which]).astype(np.int64)
    return column, row, which


_MIN_THICKNESS_MM = 1e-4  # mm; thinner material is ignored
_ROWS_PER_PIXEL = 4.0  # row resolution, in fractions of a pixel
_OVERDRAW_PX = 40.0  # pixels outside the frame that are still drawn


class PixelLine(NamedTuple):
    """Points of a line in pixels. Both arrays have the shape (n,)."""

    columns: FloatArray
    rows: FloatArray


class SectionArea(NamedTuple):
    """One filled area of the section of a part, with those of its edges that are drawn as lines."""

    outline: PixelLine
    edge_lines: tuple[PixelLine, ...]


def project_section(half: SectionHalf, projection: Projection, *, is_upper: bool) -> list[SectionArea]:
    """Return the material in one half of the section as areas in pixels.

    If ``is_upper`` is True, it is the upper half, on the far side of the axis.
    """
    first, last = _find_visible_range(half.column_edges, projection)
    found = []
    edges = half.column_edges[first : last + 1]
    for low, high in zip(half.inner_radii[:, first:last], half.outer_radii[:, first:last], strict=True):
        for run in _runs(high - low > _MIN_THICKNESS_MM):
            ends = edges[run.start : run.stop + 1]
            found.append(_piece(ends, low[run], high[run], projection, -1.0 if is_upper else 1.0))
    return found


def project_collision(collision: MaterialHit, projection: Projection) -> list[PixelLine]:
    """Return the areas of a collision in pixels, both above and below the part axis."""
    gaps = np.flatnonzero(np.diff(collision.z_positions) > 1.5 * collision.column_width_mm) + 1
    found = []
    for run in np.split(np.arange(len(collision.z_positions)), gaps):
        z = np.concatenate(
            [
                [collision.z_positions[run[0]] - collision.column_width_mm / 2],
                collision.z_positions[run],
                [collision.z_positions[run[-1]] + collision.column_width_mm / 2],
            ]
        )
        low, high = (_padded(r[run]) for r in (collision.inner_radii, collision.outer_radii))
        found += [
            _ring(_line(z, side * low, projection), _line(z, side * high, projection)) for side in (1.0, -1.0)
        ]
    return found


def project_stock_outline(stock: Stock, projection: Projection) -> list[PixelLine]:
    """Return the outline of the stock before the first cut, in pixels."""
    found = []
    for profile in (stock.outside_profile, stock.bore_profile):
        if profile:
            z, r = np.array(profile).T
            found += [_line(z, side * r, projection) for side in (1.0, -1.0)]
    for z in (stock.back_z_mm, stock.front_z_mm):
        r = float(stock.find_outside_radii(np.array([z]))[0])
        found.append(_line(np.array([z, z]), np.array([-r, r]), projection))
    return found


def project_stock_section(stock: Stock, projection: Projection) -> list[PixelLine]:
    """Return the areas of the stock section, both above and below the axis."""
    z, r = np.array(stock.outside_profile).T
    inner_z, inner_r = np.array(stock.bore_profile or ((stock.back_z_mm, 0.0), (stock.front_z_mm, 0.0))).T
    return [
        _ring(_line(z, side * r, projection), _line(inner_z, side * inner_r, projection))
        for side in (1.0, -1.0)
    ]


def project_clamping(clamping: Clamping, stock: Stock, projection: Projection) -> list[PixelLine]:
    """Return the areas of the chuck or collet above and below the axis, and of the tailstock center."""
    found: list[PixelLine] = []
    if clamping.chuck_diameter:
        held = clamping.make_chuck_for_stock(stock)
        (z, r), (inner_z, inner_r) = np.array(held.outside_profile).T, np.array(held.bore_profile).T
        found += [
            _ring(_line(z, side * r, projection), _line(inner_z, side * inner_r, projection))
            for side in (1.0, -1.0)
        ]
    tailstock = clamping.tailstock_solid
    if tailstock is not None:
        z, r = np.array(tailstock.outside_profile).T
        found.append(_ring(_line(z, r, projection), _line(z, -r, projection)))
    return found


def _piece(
    edges: FloatArray, low: FloatArray, high: FloatArray, projection: Projection, side: float
) -> SectionArea:
    z = np.concatenate([edges[:1], (edges[1:] + edges[:-1]) / 2, edges[-1:]])
    low, high = _padded(low), _padded(high)
    outside, inside = _line(z, side * high, projection), _line(z, side * low, projection)
    first, last = (PixelLine(inside.columns[[at]], inside.rows[[at]]) for at in (0, -1))
    contour = PixelLine(
        np.concatenate([first.columns, outside.columns, last.columns]),
        np.concatenate([first.rows, outside.rows, last.rows]),
    )
    bores = [
        _line(z[run], side * low[run], projection) for run in _runs(_widen_mask(low > _MIN_THICKNESS_MM))
    ]
    return SectionArea(_ring(inside, outside), (contour, *bores))


def _widen_mask(wanted: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return the mask extended by one element on each side of its true elements."""
    wider = wanted.copy()
    wider[1:] |= wanted[:-1]
    wider[:-1] |= wanted[1:]
    return wider


def _line(z: FloatArray, r: FloatArray, projection: Projection) -> PixelLine:
    columns = np.asarray(projection.find_pixel_column(z), dtype=np.float64)
    rows = np.asarray(projection.find_pixel_row(r), dtype=np.float64)
    return _thin_line(PixelLine(columns, rows))


def _ring(there: PixelLine, back: PixelLine) -> PixelLine:
    return PixelLine(
        np.concatenate([there.columns, back.columns[::-1]]), np.concatenate([there.rows, back.rows[::-1]])
    )


def _thin_line(line: PixelLine) -> PixelLine:
    """Return the line without points that do not change the picture.

    These are points inside horizontal runs, and points on the same pixel as the preceding point.
    """
    c, r = np.rint(line.columns * 2.0), np.rint(line.rows * _ROWS_PER_PIXEL)
    keep = np.ones(len(c), dtype=np.bool_)
    keep[1:-1] = (r[1:-1] != r[:-2]) | (r[1:-1] != r[2:])
    there = np.flatnonzero(keep)
    c, r = c[there], r[there]
    same = np.zeros(len(there), dtype=np.bool_)
    same[1:-1] = (c[1:-1] == c[:-2]) & (r[1:-1] == r[:-2])
    there = there[~same]
    return PixelLine(line.columns[there], line.rows[there])


def _padded(r: FloatArray) -> FloatArray:
    return np.concatenate([r[:1], r, r[-1:]])


def _find_visible_range(edges: FloatArray, projection: Projection) -> tuple[int, int]:
    """Return the first visible column, and the column after the last visible one."""
    half = (projection.width_px / 2 + _OVERDRAW_PX) / projection.pixels_per_mm
    first = int(np.searchsorted(edges, projection.center_z - half)) - 1
    last = int(np.searchsorted(edges, projection.center_z + half))
    return max(first, 0), min(last, len(edges) - 1)


def _runs(wanted: npt.NDArray[np.bool_]) -> list[slice]:
    bounds = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).tolist()
    return [slice(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True)]
