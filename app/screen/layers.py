"""The two cached images of the path view: everything to come, and upon a copy of it what is done.

Only new strokes are ever drawn. A new frame (zoom, pan, size) starts the images again, in slices, so that a
picture of a million strokes never holds up a key.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QImage, QPainter, QPen

from app.desk.picture import Stroke
from app.screen.look import Look
from app.screen.plot import Frame, Run, runs, stroke_run

if TYPE_CHECKING:
    from app.desk.picture import Picture

SLICE = 20_000  # points drawn at a time
BUDGET = 0.006  # seconds a frame may give to drawing
SMOOTH_TO = 30_000  # points up to which lines are smoothed and rapids dashed


class Layers:
    """Images of one picture in one frame."""

    def __init__(self, look: Look, picture: Picture, frame: Frame) -> None:
        self.picture = picture
        self.frame = frame
        self._look = look
        self._smooth = len(picture.z) <= SMOOTH_TO
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
        points = self.picture.points_done(blocks)
        if points < self._wanted:
            self._done = 0
            self.image = self._base
        self._wanted = points

    def advance(self) -> bool:
        """Draw on for a slice of a frame's time; True when anything was drawn."""
        if self.complete:
            return False
        until = time.perf_counter() + BUDGET
        while not self.complete and time.perf_counter() < until:
            if self._drawn < len(self.picture.z):
                self._draw_base()
            else:
                self._draw_done()
        return True

    def pens(self, done: bool) -> dict[int, QPen]:
        """The pen of each stroke."""
        look = self._look
        rapid = look.pen("rapid", 0.10)
        if self._smooth:
            rapid.setStyle(Qt.PenStyle.SolidLine if done else Qt.PenStyle.DashLine)
        cut = look.pen("done", 0.26) if done else look.pen("todo", 0.15)
        for pen in (cut, rapid):
            pen.setCapStyle(Qt.PenCapStyle.RoundCap if self._smooth else Qt.PenCapStyle.FlatCap)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin if self._smooth else Qt.PenJoinStyle.BevelJoin)
        return {Stroke.RAPID: rapid, Stroke.TURN: cut, Stroke.MILL: cut}

    def _draw_base(self) -> None:
        end = min(self._drawn + SLICE, len(self.picture.z))
        painter = self._painter(self._base)
        pens = self.pens(done=False)
        found = list(runs(self.picture, self.frame, self._drawn, end))
        painter.setPen(self._look.pen("ghost", 0.12))
        middle = 2 * float(self.frame.down(0.0))
        for run in found:
            if run.stroke == Stroke.TURN:
                stroke_run(painter, Run(run.stroke, run.columns, middle - run.rows))
        for run in found:
            painter.setPen(pens[run.stroke])
            stroke_run(painter, run)
        painter.end()
        self._drawn = end

    def _draw_done(self) -> None:
        if self.image is self._base:
            self.image = self._base.copy()
        end = min(self._done + SLICE, self._wanted)
        painter = self._painter(self.image)
        pens = self.pens(done=True)
        for run in runs(self.picture, self.frame, self._done, end):
            painter.setPen(pens[run.stroke])
            stroke_run(painter, run)
        painter.end()
        self._done = end

    def _painter(self, image: QImage) -> QPainter:
        painter = QPainter(image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, self._smooth)
        return painter
