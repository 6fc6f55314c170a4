"""Which panes stand side by side, and what each of them shows."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF

from app.desk.picture import Picture
from app.screen.look import Look
from app.screen.path.aspects import View, trail_of, views_of
from app.screen.path.pane import Pane

LEAST = 40  # pixels: in less room nothing is laid out


class Panes:
    """``picture`` and, where two are compared, what it was ``before``; one of several views onto them.

    ``keeps``: what is looked at by hand stays when the picture changes.
    """

    def __init__(self, look: Look, keeps: bool) -> None:
        self._look, self._keeps = look, keeps
        self.picture: Picture | None = None
        self.before: Picture | None = None
        self.now: list[Pane] = []
        self._views: list[View] = []
        self._view = 0
        self._room = QRectF()

    def show(self, picture: Picture | None, before: Picture | None) -> None:
        """Other pictures; the same view where there still is one."""
        self.picture, self.before = picture, before
        views = views_of(picture) if picture is not None else []
        if views != self._views:
            self._views, self._view = views, 0
        self._fill()

    @property
    def several(self) -> bool:
        """Whether there is another view."""
        return len(self._views) > 1

    def next_view(self) -> None:
        """Another view."""
        self._view = (self._view + 1) % max(1, len(self._views))
        self._fill()

    def lay(self, room: QRectF) -> None:
        """Share this room."""
        self._room = room
        if room.width() <= LEAST or not self.now:
            return
        wide = room.width() / len(self.now)
        for number, pane in enumerate(self.now):
            box = QRectF(room.x() + number * wide, room.y(), wide, room.height())
            pane.lay(box.toRect().toRectF())

    def at(self, place: QPointF) -> Pane | None:
        """The pane under a place of the widget."""
        return next((pane for pane in self.now if pane.room.contains(place)), None)

    def advance(self) -> bool:
        """Draw on for a few milliseconds at most; whether there is anything new."""
        drawn = [pane.advance() for pane in self.now]
        return any(drawn)

    def _fill(self) -> None:
        aspects = self._views[self._view] if self._views else ()
        kept = {pane.aspect: pane for pane in self.now} if self._keeps else {}
        panes = []
        for aspect in aspects:
            trail, before = trail_of(self.picture, aspect), trail_of(self.before, aspect)
            assert trail is not None
            pane = kept.get(aspect)
            if pane is None:
                pane = Pane(self._look, aspect, trail, before)
            else:
                pane.take(trail, before)
            panes.append(pane)
        self.now = panes
        self.lay(self._room)
