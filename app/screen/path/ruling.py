"""When the path view measures, and what a touch means: a point to measure from, or the block drawn there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF

if TYPE_CHECKING:
    from app.screen.path.measure import Measure
    from app.screen.path.pane import Pane
    from app.screen.pathview import PathView

Picked = Callable[[int], None]


class Ruling:
    """``now`` is what one measures with, None while one does not. The view has the keyboard meanwhile."""

    def __init__(self, view: PathView, picked: Picked | None) -> None:
        self._view, self._picked = view, picked
        self.now: Measure | None = None

    def switch(self, *, on: bool) -> None:
        """Begin, in the last pane, or end."""
        view = self._view
        if on and view.drawn and view.view is not None:
            self._begin(view.panes[-1])
            view.setFocus()
        elif not on and self.now is not None:
            self.now.end()
            self.now = None
            view.setMouseTracking(False)
            if view.hasFocus():
                view.window().setFocus()
        view.update()

    def renew(self, panes: Sequence[Pane]) -> None:
        """Other pictures are shown: go on where the pane is still there, else end."""
        if self.now is not None and self.now.pane in panes:
            self.now.renew()
        else:
            self.switch(on=False)

    def point(self, at: QPointF) -> None:
        """The pointer moves over the view."""
        if self.now is not None and self.now.pane.room.contains(at):
            self.now.point(at)
            self._view.update()

    def touched(self, pane: Pane, at: QPointF) -> None:
        """A pane was touched."""
        if self.now is not None:
            now = self.now if self.now.pane is pane else self._begin(pane)
            now.point(at)
            now.hold()
            self._view.update()
        elif self._picked is not None and (block := pane.block_at(at)):
            self._picked(block)

    def _begin(self, pane: Pane) -> Measure:
        from app.screen.path.measure import Measure

        now = self.now = Measure(pane)
        self._view.setMouseTracking(True)
        return now
