"""From a trail's points to pixels: projection, thinning out, strokes without a Python loop a point."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
import numpy.typing as npt
import shiboken6
from PySide6.QtGui import QPainter, QPolygonF

from app.screen.path.raster import Shape

if TYPE_CHECKING:
    from app.desk.drawing.trail import Trail

Floats = npt.NDArray[np.float64]

# Address, bytes (two doubles a point), writable. The stub of VoidPtr knows only a bare address.
_MEMORY = cast("Callable[[object, int, bool], bytes]", shiboken6.VoidPtr)


@dataclass(frozen=True, slots=True)
class Frame:
    """What is looked at: the point (z, x) in the middle of ``width`` by ``height`` pixels, pixels a mm."""

    z: float
    x: float
    scale: float
    width: int
    height: int

    def across(self, z: Floats | float) -> Floats | float:
        """Pixel column of a Z: Z+ goes to the right."""
        return self.width / 2 + (z - self.z) * self.scale

    def down(self, x: Floats | float) -> Floats | float:
        """Pixel row of an X, a radius: X+ goes down, towards the operator."""
        return self.height / 2 + (x - self.x) * self.scale

    def zoomed(self, factor: float, column: float, row: float) -> Frame:
        """Nearer by ``factor``, the point under (column, row) staying where it is."""
        scale = min(max(self.scale * factor, 0.02), 5000.0)
        z = self.z + (column - self.width / 2) * (1 / self.scale - 1 / scale)
        x = self.x + (row - self.height / 2) * (1 / self.scale - 1 / scale)
        return Frame(z, x, scale, self.width, self.height)

    def moved(self, columns: float, rows: float) -> Frame:
        """The picture shifted by so many pixels."""
        z, x = self.z - columns / self.scale, self.x - rows / self.scale
        return Frame(z, x, self.scale, self.width, self.height)


def fitted(bounds: tuple[float, float, float, float], width: int, height: int, margin: float) -> Frame:
    """All that is cut and its mirror image on the other side of X0, ``margin`` pixels around it."""
    z0, z1, x0, x1 = bounds
    reach = max(abs(x0), abs(x1), 0.5)
    across, down = max(width - 2 * margin, 10.0), max(height - 2 * margin, 10.0)
    scale = min(across / max(z1 - z0, 1.0), down / (2 * reach))
    return Frame((z0 + z1) / 2, 0.0, scale, width, height)


def boxed(bounds: tuple[float, float, float, float], width: int, height: int, margin: float) -> Frame:
    """Just what is within the bounds, ``margin`` pixels around it."""
    z0, z1, x0, x1 = bounds
    across, down = max(width - 2 * margin, 10.0), max(height - 2 * margin, 10.0)
    scale = min(across / max(z1 - z0, 1.0), down / max(x1 - x0, 1.0))
    return Frame((z0 + z1) / 2, (x0 + x1) / 2, scale, width, height)


@dataclass(frozen=True, slots=True)
class Run:
    """Neighbouring points under one stroke, in pixels."""

    stroke: int
    columns: Floats
    rows: Floats


def points(trail: Trail, frame: Frame, start: int, end: int) -> Shape:
    """Points ``start`` … ``end - 1`` and the one before, thinned out to the pixel."""
    low = max(0, start - 1)
    columns = np.asarray(frame.across(trail.z[low:end]), dtype=np.float64)
    rows = np.asarray(frame.down(trail.x[low:end]), dtype=np.float64)
    stroke = trail.stroke[low:end].copy()
    if start > 0 and len(stroke):
        stroke[0] = 0
    keep = _telling(columns, rows, stroke)
    return Shape(columns[keep], rows[keep], stroke[keep])


def runs(trail: Trail, frame: Frame, start: int, end: int) -> Iterator[Run]:
    """The strokes that end in points ``start`` … ``end - 1``, thinned out to the pixel, cut to the frame."""
    columns, rows, stroke = points(trail, frame, start, end)
    stroke[1:][_outside(columns, rows, frame)] = 0
    edges = np.flatnonzero(np.diff(stroke)) + 1
    for a, b in zip(np.append(0, edges), np.append(edges, len(stroke)), strict=True):
        kind = int(stroke[a]) if b > a else 0
        if kind and a > 0:
            yield Run(kind, columns[a - 1 : b], rows[a - 1 : b])


def _telling(columns: Floats, rows: Floats, stroke: npt.NDArray[np.uint8]) -> npt.NDArray[np.bool_]:
    """Points that fall on another pixel than the one before, or where the stroke changes."""
    c, r = np.rint(columns * 2), np.rint(rows * 2)
    keep = np.ones(len(c), dtype=np.bool_)
    keep[1:-1] = (c[1:-1] != c[:-2]) | (r[1:-1] != r[:-2]) | (stroke[1:-1] != stroke[2:])
    return keep


def _outside(columns: Floats, rows: Floats, frame: Frame) -> npt.NDArray[np.bool_]:
    """Stretches with both ends beyond the same edge."""
    out = np.zeros(max(0, len(columns) - 1), dtype=np.bool_)
    for beyond in (columns < 0, columns > frame.width, rows < 0, rows > frame.height):
        out |= beyond[1:] & beyond[:-1]
    return out


def polygon(columns: Floats, rows: Floats) -> QPolygonF:
    """The points as Qt's polygon, copied as one block of memory."""
    count = len(columns)
    shape = QPolygonF()
    shape.resize(count)
    memory = np.frombuffer(_MEMORY(shape.data(), count * 16, True), dtype=np.float64).reshape(count, 2)
    memory[:, 0] = columns
    memory[:, 1] = rows
    return shape


def stroke_run(painter: QPainter, run: Run) -> None:
    """Draw a run with the pen in force."""
    painter.drawPolyline(polygon(run.columns, run.rows))


def travelled(trail: Trail, frame: Frame, block: int, z: float, x: float) -> Run | None:
    """What of a block lies behind the tip at (z, x): its points up to the nearest chord, then the tip."""
    if not 1 <= block <= trail.blocks:
        return None
    start, end = int(trail.first[block - 1]), int(trail.first[block])
    if start < end and trail.stroke[start] == 0:
        start += 1  # a jump to another tool's tip
    if start >= end or start == 0:
        return None
    zs, xs = trail.z[start - 1 : end], trail.x[start - 1 : end]
    last = _nearest_chord(zs, xs, z, x) + 1
    columns = np.append(np.asarray(frame.across(zs[:last])), frame.across(z))
    rows = np.append(np.asarray(frame.down(xs[:last])), frame.down(x))
    return Run(int(trail.stroke[start]), columns, rows)


def _nearest_chord(zs: Floats, xs: Floats, z: float, x: float) -> int:
    """Index of the chord that comes nearest to a point."""
    dz, dx = np.diff(zs), np.diff(xs)
    size = np.maximum(dz * dz + dx * dx, 1e-18)
    share = np.clip(((z - zs[:-1]) * dz + (x - xs[:-1]) * dx) / size, 0.0, 1.0)
    off = (zs[:-1] + share * dz - z) ** 2 + (xs[:-1] + share * dx - x) ** 2
    return int(np.argmin(off))


def scale_length(most: float, metric: bool) -> tuple[float, str]:
    """The longest round length up to ``most`` mm, and how it is written in the unit in force."""
    unit, name = (1.0, "mm") if metric else (25.4, "in")
    decade = 10.0 ** np.floor(np.log10(max(most / unit, 1e-9)))
    step = max((k for k in (1.0, 2.0, 5.0) if k * decade <= most / unit * (1 + 1e-9)), default=1.0)
    return float(step * decade * unit), f"{step * decade:g} {name}"
