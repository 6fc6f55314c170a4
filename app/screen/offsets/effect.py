"""The path before and after a change of offsets on one picture."""

from __future__ import annotations

import math
from functools import partial

from PySide6.QtWidgets import QWidget

from app.desk.offsets.shown import ShownEffect
from app.screen.look import Look
from app.screen.pages import Doings
from app.screen.path.sight import ZOOM_STEP
from app.screen.pathview import PathView

NEAR = 0.06  # of the width: how far apart the greatest change is shown from near


class EffectView(PathView):
    """Two pictures of the loaded program; the model says which."""

    def __init__(self, look: Look, model: ShownEffect, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self._near = False
        self.hide()

    def show_effect(self) -> None:
        """What is drawn now, and draw on."""
        pair = self._model.pictures
        self.show_compared(pair.before if pair else None, pair.after if pair else None)
        if pair is not None and self._model.near != self._near:
            self._near = self._model.near
            self._go_near(pair.furthest) if self._near else self.fit()
        self.advance()

    def _go_near(self, apart: float) -> None:
        """So near to the greatest change that both paths are seen beside each other."""
        frame = self.view
        if frame is not None and math.isfinite(apart) and apart > 0.0:
            factor = NEAR * self.width() / (apart * frame.scale)
            self.zoom(max(0, math.ceil(math.log(factor, ZOOM_STEP))))

    def doings(self) -> Doings:
        """Looking around by keys, as on the Automatic page."""
        return {
            "Zoom in": partial(self.zoom, 1),
            "Zoom out": partial(self.zoom, -1),
            "Pan left": partial(self.pan, -1, 0),
            "Pan right": partial(self.pan, 1, 0),
            "Pan up": partial(self.pan, 0, -1),
            "Pan down": partial(self.pan, 0, 1),
        }
