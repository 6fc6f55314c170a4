"""The two cached images of a pane: everything to come, and upon a copy of it what is done.

Only new strokes are ever drawn. A new frame (zoom, pan, size) starts the images again, in slices, so that a
picture of a million strokes never holds up a key.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np
import numpy.typing as npt
import shiboken6
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

from app.path.polyline import Stroke
from app.screen.look import Look

if TYPE_CHECKING:
    from app.path.polyline import Polyline

# --- Many short lines at once, set pixel by pixel in numpy: a million strokes in a few dozen milliseconds.


PixelFloats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


class Shape(NamedTuple):
    """Points in pixels, with the stroke that ends in each."""

    columns: PixelFloats
    rows: PixelFloats
    stroke: npt.NDArray[np.uint8]


class Ends(NamedTuple):
    """Where stretches begin and end: columns and rows, pixels."""

    c0: PixelFloats
    r0: PixelFloats
    c1: PixelFloats
    r1: PixelFloats


def pixels_of(image: QImage) -> npt.NDArray[np.uint32]:
    """The image's own memory (rows, columns), 32 bits a pixel; valid as long as the image."""
    stride = image.bytesPerLine() // 4
    memory = np.frombuffer(image.bits(), dtype=np.uint32)
    return memory.reshape(image.height(), stride)[:, : image.width()]


def draw_pixels(image: QImage, frame: Frame, shape: Shape, inks: dict[int, QColor]) -> None:
    """Draw the stretches that end in points 1… in the ink of their stroke; those without ink are skipped."""
    table = np.zeros(256, dtype=np.uint32)
    inked = np.zeros(256, dtype=np.bool_)
    for kind, ink in inks.items():
        table[kind], inked[kind] = ink.rgb() & 0xFFFFFFFF, True
    wanted = inked[shape.stroke[1:]]
    columns, rows, strokes = shape.columns, shape.rows, shape.stroke[1:][wanted]
    ends = Ends(columns[:-1][wanted], rows[:-1][wanted], columns[1:][wanted], rows[1:][wanted])
    cut, inside = clipped(ends, frame.width - 1, frame.height - 1)
    column, row, which = stepped(cut)
    pixels_of(image)[row, column] = table[strokes[inside]][which]


def clipped(ends: Ends, right: int, bottom: int) -> tuple[Ends, npt.NDArray[np.bool_]]:
    """The parts of stretches within 0…right, 0…bottom, and which stretches have one (Liang and Barsky)."""
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
    """Column, row and number of the stretch of every pixel of all stretches, in their order."""
    dc, dr = ends.c1 - ends.c0, ends.r1 - ends.r0
    steps = np.ceil(np.maximum(np.abs(dc), np.abs(dr))).astype(np.int64)
    count = steps + 1
    which = np.repeat(np.arange(len(count)), count)
    first = np.repeat(np.cumsum(count) - count, count)
    share = (np.arange(len(which)) - first) / np.maximum(steps, 1)[which]
    column = np.rint(ends.c0[which] + share * dc[which]).astype(np.int64)
    row = np.rint(ends.r0[which] + share * dr[which]).astype(np.int64)
    return column, row, which


# --- From a trail's points to pixels: projection, thinning out, strokes without a Python loop a point.


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


def points(trail: Polyline, frame: Frame, start: int, end: int) -> Shape:
    """Points ``start`` … ``end - 1`` and the one before, thinned out to the pixel."""
    low = max(0, start - 1)
    columns = np.asarray(frame.across(trail.z[low:end]), dtype=np.float64)
    rows = np.asarray(frame.down(trail.x[low:end]), dtype=np.float64)
    stroke = trail.stroke[low:end].copy()
    if start > 0 and len(stroke):
        stroke[0] = 0
    keep = _telling(columns, rows, stroke)
    return Shape(columns[keep], rows[keep], stroke[keep])


def runs(trail: Polyline, frame: Frame, start: int, end: int) -> Iterator[Run]:
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


def travelled(trail: Polyline, frame: Frame, block: int, z: float, x: float) -> Run | None:
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


# --- Colour, width and style of lines by their stroke; width and style tell it without the colour.


Line = Qt.PenStyle
BAND = 0.45  # how much of a band covers what it marks


class Ink(Enum):
    """What a trail is drawn as: colour of cuts, their width in units, line style."""

    TODO = ("todo", 0.15, Line.SolidLine)
    DONE = ("done", 0.26, Line.SolidLine)
    BEFORE = ("mark", 0.16, Line.DashLine)
    AFTER = ("accent", 0.24, Line.SolidLine)
    MARKED = ("lit", 1.2, Line.SolidLine)  # a band along the blocks of the line under the cursor

    def pens(self, look: Look) -> dict[int, QPen]:
        """The pen of each stroke; two programs are compared by their cuts alone."""
        colour, width, style = self.value
        cut = _round(look.pen(colour, width), style)
        if self is Ink.MARKED:
            band = cut.color()
            band.setAlphaF(BAND)
            cut.setColor(band)
        if self in {Ink.BEFORE, Ink.AFTER}:
            return {Stroke.TURN: cut, Stroke.MILL: cut}
        rapid = _round(look.pen("rapid", 0.10), Line.SolidLine if self is Ink.DONE else Line.DashLine)
        return {Stroke.RAPID: cut if self is Ink.MARKED else rapid, Stroke.TURN: cut, Stroke.MILL: cut}

    def colours(self, look: Look) -> dict[int, QColor]:
        """The same where lines are one pixel wide."""
        return {stroke: pen.color() for stroke, pen in self.pens(look).items()}


def _round(pen: QPen, style: Qt.PenStyle) -> QPen:
    pen.setStyle(style)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen


SMOOTH_TO = 3_000  # points up to which lines are smoothed, wide and dashed; above that they are pixels
SMOOTH_SLICE, SLICE = 150, 20_000  # points drawn at a time
BUDGET = 0.006  # seconds a frame may give to drawing


class Layers:
    """Images of one trail in one frame; ``before`` is what it was before a change, drawn under it."""

    def __init__(self, look: Look, trail: Polyline, frame: Frame, before: Polyline | None = None) -> None:
        self.trail = trail
        self.frame = frame
        self._look = look
        self._under = (
            [(before, Ink.BEFORE), (trail, Ink.AFTER)] if before is not None else [(trail, Ink.TODO)]
        )
        self._smooth = len(trail.z) <= SMOOTH_TO
        self._slice = SMOOTH_SLICE if self._smooth else SLICE
        size = QSize(max(1, frame.width), max(1, frame.height))
        self._base = QImage(size, QImage.Format.Format_RGB32)
        self._base.fill(look.colour("panel"))
        self.image = self._base
        self._stage = 0  # which trail of the base is being drawn
        self._drawn = 0  # points of it that are
        self._done = 0
        self._wanted = 0

    @property
    def complete(self) -> bool:
        """Whether everything wanted is drawn."""
        return self._stage >= len(self._under) and self._done >= self._wanted

    def want(self, blocks: int) -> None:
        """So many blocks are behind. Fewer than before: a new cycle, from the image of what is to come."""
        wanted = self.trail.points_done(blocks)
        if wanted < self._wanted:
            self._done = 0
            self.image = self._base
        self._wanted = wanted

    def advance(self) -> bool:
        """Draw on for a slice of a frame's time; True when anything was drawn."""
        if self.complete:
            return False
        until = time.perf_counter() + BUDGET
        while not self.complete and time.perf_counter() < until:
            if self._stage < len(self._under):
                self._draw_base()
            else:
                self._draw_done()
        return True

    def _draw_base(self) -> None:
        trail, ink = self._under[self._stage]
        end = min(self._drawn + self._slice, len(trail.z))
        self._draw(self._base, trail, (self._drawn, end), ink)
        self._drawn = end
        if end >= len(trail.z):
            self._stage, self._drawn = self._stage + 1, 0

    def _draw_done(self) -> None:
        if self.image is self._base:
            self.image = self._base.copy()
        end = min(self._done + self._slice, self._wanted)
        self._draw(self.image, self.trail, (self._done, end), Ink.DONE)
        self._done = end

    def _draw(self, image: QImage, trail: Polyline, part: tuple[int, int], ink: Ink) -> None:
        (self._draw_smooth if self._smooth else self._draw_pixels)(image, trail, part, ink)

    def _draw_smooth(self, image: QImage, trail: Polyline, part: tuple[int, int], ink: Ink) -> None:
        pens = ink.pens(self._look)
        found = [run for run in runs(trail, self.frame, *part) if run.stroke in pens]
        with QPainter(image) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            if ink is not Ink.DONE:
                painter.setPen(self._look.pen("ghost", 0.12))
                for run in found:
                    if run.stroke == Stroke.TURN:
                        stroke_run(painter, Run(run.stroke, run.columns, self._middle - run.rows))
            for run in found:
                painter.setPen(pens[run.stroke])
                stroke_run(painter, run)

    def _draw_pixels(self, image: QImage, trail: Polyline, part: tuple[int, int], ink: Ink) -> None:
        shape = points(trail, self.frame, *part)
        if ink is not Ink.DONE:
            far_side = shape._replace(rows=self._middle - shape.rows)
            draw_pixels(image, self.frame, far_side, {Stroke.TURN: self._look.colour("ghost")})
        draw_pixels(image, self.frame, shape, ink.colours(self._look))

    @property
    def _middle(self) -> float:
        """Twice the row of X0: what a row is taken from to mirror it."""
        return 2 * float(self.frame.down(0.0))
