"""The path before and after a change of offsets on one picture."""

from __future__ import annotations

from functools import partial

from PySide6.QtWidgets import QWidget

from app.desk.offsets.shown import ShownEffect
from app.screen.look import Look
from app.screen.pages import Doings
from app.screen.pathview import PathView


class EffectView(PathView):
    """Two pictures of the loaded program; the model says which."""

    def __init__(self, look: Look, model: ShownEffect, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self.hide()

    def show_effect(self) -> None:
        """What is drawn now, and draw on."""
        pair = self._model.pictures
        self.show_compared(pair.before if pair else None, pair.after if pair else None)
        self.advance()

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
