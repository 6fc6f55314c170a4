"""The two cached images of the path view: everything to come, and upon a copy of it what is done.

Only new strokes are ever drawn. A new frame (zoom, pan, size) starts the images again, in slices, so that a
picture of a million strokes never holds up a key.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from app.desk.picture import Stroke
from app.screen import raster
from app.screen.look import Look
from app.screen.plot import Frame, Run, points, runs, stroke_run

if TYPE_CHECKING:
    from app.desk.picture import Picture

SMOOTH_TO = 3_000  # points up to which lines are smoothed, wide and dashed; above that they are pixels
SMOOTH_SLICE, SLICE = 150, 50_000  # points drawn at a time
BUDGET = 0.006  # seconds a frame may give to drawing


class Layers:
    """Images of one picture in one frame."""

    def __init__(self, look: Look, picture: Picture, frame: Frame) -> None:
        self.picture = picture
        self.frame = frame
        self._look = look
        self._smooth = len(picture.z) <= SMOOTH_TO
        self._slice = SMOOTH_SLICE if self._smooth else SLICE
        size = QSize(max(1, frame.width), max(1, frame.height))
        self._base = QImage(size, QImage.Format.Format_RGB32)
        self._base.fill(look.colour("panel"))
        self.image = self._base
        self._drawn = 0
        self._done = 0
        self._wanted = 0

    @property
    def complete(self) -> bool:
        """Whether everything wanted is drawn."""
        return self._drawn >= len(self.picture.z) and self._done >= self._wanted

    def want(self, blocks: int) -> None:
        """So many blocks are behind. Fewer than before: a new cycle, from the image of what is to come."""
        wanted = self.picture.points_done(blocks)
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
            if self._drawn < len(self.picture.z):
                end = min(self._drawn + self._slice, len(self.picture.z))
                self._draw(self._base, self._drawn, end, done=False)
                self._drawn = end
            else:
                self._draw_done()
        return True

    def pens(self, done: bool) -> dict[int, QPen]:
        """The pen of each stroke."""
        look = self._look
        rapid = look.pen("rapid", 0.10)
        rapid.setStyle(Qt.PenStyle.SolidLine if done else Qt.PenStyle.DashLine)
        cut = look.pen("done", 0.26) if done else look.pen("todo", 0.15)
        for pen in (cut, rapid):
            pen.setCapStyle(Qt.PenCapStyle.RoundCap)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        return {Stroke.RAPID: rapid, Stroke.TURN: cut, Stroke.MILL: cut}

    def _draw_done(self) -> None:
        if self.image is self._base:
            self.image = self._base.copy()
        end = min(self._done + self._slice, self._wanted)
        self._draw(self.image, self._done, end, done=True)
        self._done = end

    def _draw(self, image: QImage, start: int, end: int, *, done: bool) -> None:
        (self._draw_smooth if self._smooth else self._draw_pixels)(image, start, end, done)

    def _draw_smooth(self, image: QImage, start: int, end: int, done: bool) -> None:
        pens = self.pens(done)
        found = list(runs(self.picture, self.frame, start, end))
        with QPainter(image) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            if not done:
                painter.setPen(self._look.pen("ghost", 0.12))
                for run in found:
                    if run.stroke == Stroke.TURN:
                        stroke_run(painter, Run(run.stroke, run.columns, self._middle - run.rows))
            for run in found:
                painter.setPen(pens[run.stroke])
                stroke_run(painter, run)

    def _draw_pixels(self, image: QImage, start: int, end: int, done: bool) -> None:
        shape = points(self.picture, self.frame, start, end)
        look = self._look
        if not done:
            far_side = shape._replace(rows=self._middle - shape.rows)
            raster.draw(image, self.frame, far_side, {Stroke.TURN: look.colour("ghost")})
        cut = look.colour("done" if done else "todo")
        inks: dict[int, QColor] = {Stroke.RAPID: look.colour("rapid"), Stroke.TURN: cut, Stroke.MILL: cut}
        raster.draw(image, self.frame, shape, inks)

    @property
    def _middle(self) -> float:
        """Twice the row of X0: what a row is taken from to mirror it."""
        return 2 * float(self.frame.down(0.0))
