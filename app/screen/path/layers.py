"""The two cached images of a pane: everything to come, and upon a copy of it what is done.

Only new strokes are ever drawn. A new frame (zoom, pan, size) starts the images again, in slices, so that a
picture of a million strokes never holds up a key.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QImage, QPainter

from app.desk.drawing.trail import Stroke
from app.screen.look import Look
from app.screen.path import raster
from app.screen.path.inks import Ink
from app.screen.path.plot import Frame, Run, points, runs, stroke_run

if TYPE_CHECKING:
    from app.desk.drawing.trail import Trail

SMOOTH_TO = 3_000  # points up to which lines are smoothed, wide and dashed; above that they are pixels
SMOOTH_SLICE, SLICE = 150, 20_000  # points drawn at a time
BUDGET = 0.006  # seconds a frame may give to drawing


class Layers:
    """Images of one trail in one frame; ``before`` is what it was before a change, drawn under it."""

    def __init__(self, look: Look, trail: Trail, frame: Frame, before: Trail | None = None) -> None:
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

    def _draw(self, image: QImage, trail: Trail, part: tuple[int, int], ink: Ink) -> None:
        (self._draw_smooth if self._smooth else self._draw_pixels)(image, trail, part, ink)

    def _draw_smooth(self, image: QImage, trail: Trail, part: tuple[int, int], ink: Ink) -> None:
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

    def _draw_pixels(self, image: QImage, trail: Trail, part: tuple[int, int], ink: Ink) -> None:
        shape = points(trail, self.frame, *part)
        if ink is not Ink.DONE:
            far_side = shape._replace(rows=self._middle - shape.rows)
            raster.draw(image, self.frame, far_side, {Stroke.TURN: self._look.colour("ghost")})
        raster.draw(image, self.frame, shape, ink.colours(self._look))

    @property
    def _middle(self) -> float:
        """Twice the row of X0: what a row is taken from to mirror it."""
        return 2 * float(self.frame.down(0.0))
