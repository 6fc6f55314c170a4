"""Two cached images of a pane: the whole path, and a copy with the finished blocks drawn over it.

Only new strokes are drawn. After a change of the projection (zoom, pan or size), the images are drawn again
in time slices, so that a path with a million strokes never delays a key press. Qt draws each change of pen
with a separate call. Long paths are therefore drawn pixel by pixel with numpy, and later chords overwrite
earlier chords.
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

from app.path.path_projection import (
    ChordEnds,
    FloatArray,
    Projection,
    Shape,
    StrokeRun,
    clip_chords,
    project_points,
    project_strokes,
    rasterize_chords,
)
from app.path.polyline import StrokeKind
from app.screen.screen_theme import ScreenTheme

if TYPE_CHECKING:
    from app.path.polyline import Polyline

PenStyle = Qt.PenStyle


BAND_OPACITY = 0.45  # opacity of the band over a marked line
# number of points up to which lines are antialiased, wide and dashed; longer paths are drawn as pixels
MAX_SMOOTH_CHORDS = 3_000
FRAME_BUDGET_S = 0.006  # seconds of drawing per frame
SMOOTH_SLICE, SLICE = 150, 20_000  # number of points per drawing step
PIXELS_PER_SLICE = 120_000  # pixels per step; one pixel takes 15 ns, and most are set twice
# Address, bytes (two doubles per point), writable. The stub of VoidPtr declares only the address.
_map_memory = cast("Callable[[object, int, bool], bytes]", shiboken6.VoidPtr)


class LineStyle(Enum):
    """Styles of a polyline: the color of cuts, the line width in screen units, and the pen style."""

    REMAINING = ("todo", 0.15, PenStyle.SolidLine)
    FINISHED = ("done", 0.26, PenStyle.SolidLine)
    OLD_PATH = ("mark", 0.16, PenStyle.DashLine)
    NEW_PATH = ("accent", 0.24, PenStyle.SolidLine)
    MARKED = ("lit", 1.2, PenStyle.SolidLine)  # a band along the blocks of the line under the cursor

    def make_pens(self, theme: ScreenTheme) -> dict[int, QPen]:
        """Return the pen of each kind of stroke.

        A comparison of two programs has pens only for cuts.
        """
        colour, width, style = self.value
        cut = _round(theme.make_pen(colour, width), style)
        if self is LineStyle.MARKED:
            band = cut.color()
            band.setAlphaF(BAND_OPACITY)
            cut.setColor(band)
        if self in {LineStyle.OLD_PATH, LineStyle.NEW_PATH}:
            return {StrokeKind.TURN: cut, StrokeKind.MILL: cut}
        rapid = _round(
            theme.make_pen("rapid", 0.10),
            PenStyle.SolidLine if self is LineStyle.FINISHED else PenStyle.DashLine,
        )
        return {
            StrokeKind.RAPID: cut if self is LineStyle.MARKED else rapid,
            StrokeKind.TURN: cut,
            StrokeKind.MILL: cut,
        }

    def make_colors(self, theme: ScreenTheme) -> dict[int, QColor]:
        """Return the color of each kind of stroke, for lines that are one pixel wide."""
        return {stroke: pen.color() for stroke, pen in self.make_pens(theme).items()}


def _round(pen: QPen, style: Qt.PenStyle) -> QPen:
    pen.setStyle(style)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen


class PathLayers:
    """Images of one path in one projection.

    ``polyline_before`` is the path before a change, which is drawn below the path. ``draw_background`` draws
    the background of the path.
    """

    def __init__(
        self,
        theme: ScreenTheme,
        polyline: Polyline,
        projection: Projection,
        polyline_before: Polyline | None = None,
        draw_background: Callable[[QPainter], None] | None = None,
    ) -> None:
        self.polyline = polyline
        self.projection = projection
        self._look = theme
        self._under = (
            [(polyline_before, LineStyle.OLD_PATH), (polyline, LineStyle.NEW_PATH)]
            if polyline_before is not None
            else [(polyline, LineStyle.REMAINING)]
        )
        self._smooth = len(polyline.z) <= MAX_SMOOTH_CHORDS
        self._slice = SMOOTH_SLICE if self._smooth else SLICE
        size = QSize(max(1, projection.width_px), max(1, projection.height_px))
        self._base = QImage(size, QImage.Format.Format_RGB32)
        self._base.fill(theme.get_color("panel"))
        if draw_background is not None:
            with QPainter(self._base) as painter:
                draw_background(painter)
        self.image = self._base
        self._stage = 0  # index of the polyline that is being drawn into the base image
        self._drawn = 0  # number of its points that are drawn
        self._done = 0
        self._wanted = 0

    @property
    def is_complete(self) -> bool:
        """Return whether everything that was requested is drawn."""
        return self._stage >= len(self._under) and self._done >= self._wanted

    def request_finished_blocks(self, block_count: int) -> None:
        """Request that the first ``block_count`` blocks are drawn as finished.

        If the number is smaller than before, drawing starts again from the image of the whole path.
        """
        wanted = self.polyline.count_finished_points(block_count)
        if wanted < self._wanted:
            self._done = 0
            self.image = self._base
        self._wanted = wanted

    def continue_drawing(self) -> bool:
        """Draw during part of the frame time, and return whether anything was drawn."""
        if self.is_complete:
            return False
        until = time.perf_counter() + FRAME_BUDGET_S
        while not self.is_complete and time.perf_counter() < until:
            if self._stage < len(self._under):
                self._draw_base()
            else:
                self._draw_done()
        return True

    def _draw_base(self) -> None:
        polyline, ink = self._under[self._stage]
        end = self._find_slice_end(polyline, self._drawn, len(polyline.z))
        self._draw(self._base, polyline, (self._drawn, end), ink)
        self._drawn = end
        if end >= len(polyline.z):
            self._stage, self._drawn = self._stage + 1, 0

    def _draw_done(self) -> None:
        if self.image is self._base:
            self.image = self._base.copy()
        end = self._find_slice_end(self.polyline, self._done, self._wanted)
        self._draw(self.image, self.polyline, (self._done, end), LineStyle.FINISHED)
        self._done = end

    def _find_slice_end(self, polyline: Polyline, begin: int, maximum: int) -> int:
        """Return the end index of the next slice of points to draw.

        A slice of long chords is limited by its pixels, and a slice of short chords by its points.
        """
        end = min(begin + self._slice, maximum)
        if self._smooth or end - begin < 2:
            return end
        z, x, seen = polyline.z[begin:end], polyline.x[begin:end], self.projection
        far = seen.pixels_per_mm * np.maximum(np.abs(np.diff(z)), np.abs(np.diff(x)))
        pixels = np.cumsum(1.0 + np.minimum(far, max(seen.width_px, seen.height_px)))
        return begin + 1 + int(np.searchsorted(pixels, PIXELS_PER_SLICE))

    def _draw(self, image: QImage, polyline: Polyline, part: tuple[int, int], ink: LineStyle) -> None:
        (self._draw_smooth if self._smooth else self._draw_pixels)(image, polyline, part, ink)

    def _draw_smooth(self, image: QImage, polyline: Polyline, part: tuple[int, int], ink: LineStyle) -> None:
        pens = ink.make_pens(self._look)
        found = [run for run in project_strokes(polyline, self.projection, *part) if run.stroke_kind in pens]
        with QPainter(image) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            if ink is not LineStyle.FINISHED:
                painter.setPen(self._look.make_pen("ghost", 0.12))
                for run in found:
                    if run.stroke_kind == StrokeKind.TURN:
                        draw_stroke_run(
                            painter, StrokeRun(run.stroke_kind, run.columns, self._mirror_sum - run.rows)
                        )
            for run in found:
                painter.setPen(pens[run.stroke_kind])
                draw_stroke_run(painter, run)

    def _draw_pixels(self, image: QImage, polyline: Polyline, part: tuple[int, int], ink: LineStyle) -> None:
        shape = project_points(polyline, self.projection, *part)
        if ink is not LineStyle.FINISHED:
            far_side = shape._replace(rows=self._mirror_sum - shape.rows)
            draw_chord_pixels(
                image, self.projection, far_side, {StrokeKind.TURN: self._look.get_color("ghost")}
            )
        draw_chord_pixels(image, self.projection, shape, ink.make_colors(self._look))

    @property
    def _mirror_sum(self) -> float:
        """Return twice the pixel row of X0.

        This value minus a row is the row mirrored at X0.
        """
        return 2 * float(self.projection.find_pixel_row(0.0))


def make_polygon(columns: FloatArray, rows: FloatArray) -> QPolygonF:
    """Return the points as a ``QPolygonF``, which is filled in a single memory copy."""
    count = len(columns)
    shape = QPolygonF()
    shape.resize(count)
    memory = np.frombuffer(_map_memory(shape.data(), count * 16, True), dtype=np.float64).reshape(count, 2)
    memory[:, 0] = columns
    memory[:, 1] = rows
    return shape


def draw_stroke_run(painter: QPainter, run: StrokeRun) -> None:
    """Draw a run of strokes with the current pen of the painter."""
    painter.drawPolyline(make_polygon(run.columns, run.rows))


def draw_chord_pixels(image: QImage, projection: Projection, shape: Shape, colors: dict[int, QColor]) -> None:
    """Draw the lines of a shape pixel by pixel, each in the color of its kind of stroke.

    Kinds of stroke without a color are skipped.
    """
    table = np.zeros(256, dtype=np.uint32)
    inked = np.zeros(256, dtype=np.bool_)
    for kind, ink in colors.items():
        table[kind], inked[kind] = ink.rgb() & 0xFFFFFFFF, True
    wanted = inked[shape.stroke_kinds[1:]]
    columns, rows, strokes = shape.columns, shape.rows, shape.stroke_kinds[1:][wanted]
    ends = ChordEnds(columns[:-1][wanted], rows[:-1][wanted], columns[1:][wanted], rows[1:][wanted])
    cut, inside = clip_chords(ends, projection.width_px - 1, projection.height_px - 1)
    column, row, which = rasterize_chords(cut)
    get_pixel_array(image)[row, column] = table[strokes[inside]][which]


def get_pixel_array(image: QImage) -> npt.NDArray[np.uint32]:
    """Return an array (rows, columns) that shares the memory of the image, with 32 bits per pixel.

    The array is valid only as long as the image exists.
    """
    stride = image.bytesPerLine() // 4
    memory = np.frombuffer(image.bits(), dtype=np.uint32)
    return memory.reshape(image.height(), stride)[:, : image.width()]
