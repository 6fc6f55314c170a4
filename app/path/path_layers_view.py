"""Two cached images of a pane: the whole path, and a copy with the finished blocks drawn over it.

Only new strokes are drawn. A changed projection (zoom, pan or size) starts the images again in time slices,
so that a path with a million strokes never delays a key press. Qt draws each change of pen with a separate
call. Long paths are therefore set pixel by pixel with numpy, and later chords overwrite earlier ones.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, cast

import numpy as np
import numpy.typing as npt
import shiboken6
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

from app.path.path_projection import Ends, Floats, Projection, Run, Shape, clipped, points, runs, stepped
from app.path.polyline import Stroke
from app.screen.look import Look

if TYPE_CHECKING:
    from app.path.polyline import Polyline

Line = Qt.PenStyle


BAND = 0.45  # opacity of the band over a marked line
# number of points up to which lines are antialiased, wide and dashed; longer paths are drawn as pixels
SMOOTH_TO = 3_000
BUDGET = 0.006  # seconds of drawing per frame
SMOOTH_SLICE, SLICE = 150, 20_000  # number of points per drawing step
PIXELS = 120_000  # pixels per step; one pixel takes 15 ns, and most are set twice
# Address, bytes (two doubles per point), writable. The stub of VoidPtr declares only the address.
_MEMORY = cast("Callable[[object, int, bool], bytes]", shiboken6.VoidPtr)


class Ink(Enum):
    """Style of a polyline: color of cuts, width in units, and line style."""

    TODO = ("todo", 0.15, Line.SolidLine)
    DONE = ("done", 0.26, Line.SolidLine)
    BEFORE = ("mark", 0.16, Line.DashLine)
    AFTER = ("accent", 0.24, Line.SolidLine)
    MARKED = ("lit", 1.2, Line.SolidLine)  # a band along the blocks of the line under the cursor

    def pens(self, look: Look) -> dict[int, QPen]:
        """Return the pen of each stroke. A comparison of two programs has pens for cuts only."""
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
        """Return the color of each stroke, for lines that are one pixel wide."""
        return {stroke: pen.color() for stroke, pen in self.pens(look).items()}


def _round(pen: QPen, style: Qt.PenStyle) -> QPen:
    pen.setStyle(style)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen


class Layers:
    """Images of one path in one projection.

    ``before`` is the path before a change, drawn below it. ``ground`` draws the background of the path.
    """

    def __init__(
        self,
        look: Look,
        polyline: Polyline,
        projection: Projection,
        before: Polyline | None = None,
        ground: Callable[[QPainter], None] | None = None,
    ) -> None:
        self.polyline = polyline
        self.projection = projection
        self._look = look
        self._under = (
            [(before, Ink.BEFORE), (polyline, Ink.AFTER)] if before is not None else [(polyline, Ink.TODO)]
        )
        self._smooth = len(polyline.z) <= SMOOTH_TO
        self._slice = SMOOTH_SLICE if self._smooth else SLICE
        size = QSize(max(1, projection.width), max(1, projection.height))
        self._base = QImage(size, QImage.Format.Format_RGB32)
        self._base.fill(look.colour("panel"))
        if ground is not None:
            with QPainter(self._base) as painter:
                ground(painter)
        self.image = self._base
        self._stage = 0  # index of the polyline that is being drawn into the base image
        self._drawn = 0  # number of its points that are drawn
        self._done = 0
        self._wanted = 0

    @property
    def complete(self) -> bool:
        """Whether everything requested is drawn."""
        return self._stage >= len(self._under) and self._done >= self._wanted

    def want(self, blocks: int) -> None:
        """Request that the first ``blocks`` blocks are drawn as finished.

        A smaller number than before starts a new cycle from the image of the whole path.
        """
        wanted = self.polyline.points_done(blocks)
        if wanted < self._wanted:
            self._done = 0
            self.image = self._base
        self._wanted = wanted

    def advance(self) -> bool:
        """Draw for a part of the frame time, and return whether anything was drawn."""
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
        polyline, ink = self._under[self._stage]
        end = self._slice_end(polyline, self._drawn, len(polyline.z))
        self._draw(self._base, polyline, (self._drawn, end), ink)
        self._drawn = end
        if end >= len(polyline.z):
            self._stage, self._drawn = self._stage + 1, 0

    def _draw_done(self) -> None:
        if self.image is self._base:
            self.image = self._base.copy()
        end = self._slice_end(self.polyline, self._done, self._wanted)
        self._draw(self.image, self.polyline, (self._done, end), Ink.DONE)
        self._done = end

    def _slice_end(self, polyline: Polyline, begin: int, most: int) -> int:
        """Return the end of the next slice.

        Pixels limit slices of long chords, and points limit slices of short chords.
        """
        end = min(begin + self._slice, most)
        if self._smooth or end - begin < 2:
            return end
        z, x, seen = polyline.z[begin:end], polyline.x[begin:end], self.projection
        far = seen.scale * np.maximum(np.abs(np.diff(z)), np.abs(np.diff(x)))
        pixels = np.cumsum(1.0 + np.minimum(far, max(seen.width, seen.height)))
        return begin + 1 + int(np.searchsorted(pixels, PIXELS))

    def _draw(self, image: QImage, polyline: Polyline, part: tuple[int, int], ink: Ink) -> None:
        (self._draw_smooth if self._smooth else self._draw_pixels)(image, polyline, part, ink)

    def _draw_smooth(self, image: QImage, polyline: Polyline, part: tuple[int, int], ink: Ink) -> None:
        pens = ink.pens(self._look)
        found = [run for run in runs(polyline, self.projection, *part) if run.stroke in pens]
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

    def _draw_pixels(self, image: QImage, polyline: Polyline, part: tuple[int, int], ink: Ink) -> None:
        shape = points(polyline, self.projection, *part)
        if ink is not Ink.DONE:
            far_side = shape._replace(rows=self._middle - shape.rows)
            draw_pixels(image, self.projection, far_side, {Stroke.TURN: self._look.colour("ghost")})
        draw_pixels(image, self.projection, shape, ink.colours(self._look))

    @property
    def _middle(self) -> float:
        """Twice the row of X0. A row is mirrored by subtracting it from this value."""
        return 2 * float(self.projection.down(0.0))


def polygon(columns: Floats, rows: Floats) -> QPolygonF:
    """Return the points as a ``QPolygonF``, copied as one block of memory."""
    count = len(columns)
    shape = QPolygonF()
    shape.resize(count)
    memory = np.frombuffer(_MEMORY(shape.data(), count * 16, True), dtype=np.float64).reshape(count, 2)
    memory[:, 0] = columns
    memory[:, 1] = rows
    return shape


def stroke_run(painter: QPainter, run: Run) -> None:
    """Draw a run with the painter's current pen."""
    painter.drawPolyline(polygon(run.columns, run.rows))


def draw_pixels(image: QImage, projection: Projection, shape: Shape, inks: dict[int, QColor]) -> None:
    """Draw the chords of a shape, each in the color of its stroke.

    Strokes without a color are skipped.
    """
    table = np.zeros(256, dtype=np.uint32)
    inked = np.zeros(256, dtype=np.bool_)
    for kind, ink in inks.items():
        table[kind], inked[kind] = ink.rgb() & 0xFFFFFFFF, True
    wanted = inked[shape.stroke[1:]]
    columns, rows, strokes = shape.columns, shape.rows, shape.stroke[1:][wanted]
    ends = Ends(columns[:-1][wanted], rows[:-1][wanted], columns[1:][wanted], rows[1:][wanted])
    cut, inside = clipped(ends, projection.width - 1, projection.height - 1)
    column, row, which = stepped(cut)
    pixels_of(image)[row, column] = table[strokes[inside]][which]


def pixels_of(image: QImage) -> npt.NDArray[np.uint32]:
    """Return the memory of the image as an array (rows, columns) with 32 bits per pixel.

    The array is valid only as long as the image exists.
    """
    stride = image.bytesPerLine() // 4
    memory = np.frombuffer(image.bits(), dtype=np.uint32)
    return memory.reshape(image.height(), stride)[:, : image.width()]
