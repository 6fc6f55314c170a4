"""The path of a program as the operator sees it, wherever one is shown: run, editor, lists, offsets.

From above X+ is down, Z+ to the right, both sides of X0; beside it what is cut with C locked, on the face of
the part or on its side unrolled. Feed it with ``show_picture`` or ``show_compared``, tell ``show_tip`` where
the machine is, and call ``advance`` once a frame. Nothing here computes but where things stand on the screen;
numpy comes with the first picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QMouseEvent, QPainter, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel, Press
from app.screen.path.aspects import Aspect, Tip, View, trail_of, views_of

if TYPE_CHECKING:
    from app.desk.drawing.approach import Leg
    from app.desk.picture import Picture
    from app.screen.path.pane import Pane, Place
    from app.screen.path.plot import Frame


class PathView(Panel):
    """Panes side by side, each with its own zoom; keys act on the first, fingers on the one they touch."""

    title = "PATH"
    keeps = False  # whether what is looked at by hand stays when the picture changes

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._picture: Picture | None = None
        self._before: Picture | None = None
        self._legs: tuple[Leg, ...] = ()
        self._panes: list[Pane] = []
        self._views: list[View] = []
        self._view = 0
        self._tip = Tip()
        self._held: tuple[Pane, QPointF] | None = None

    @property
    def view(self) -> Frame | None:
        """What is looked at in the first pane."""
        return self._panes[0].frame if self._panes else None

    @property
    def panes(self) -> Sequence[Pane]:
        """What is side by side now."""
        return self._panes

    # --- what is shown -------------------------------------------------------------------------------

    def show_picture(self, picture: Picture | None) -> None:
        """Another program's path, or none."""
        self._show(picture, None)

    def show_compared(self, before: Picture | None, after: Picture | None) -> None:
        """One program before and after a change, both on one view with a legend; no tip, nothing done.

        With ``after`` None there is nothing to show, with ``before`` None ``after`` is shown alone.
        """
        self._show(after, before)

    def show_approach(self, legs: Sequence[Leg] | None) -> None:
        """The way back into the program, over its path; the first leg is where the tool stands."""
        if tuple(legs or ()) != self._legs:
            self._legs = tuple(legs or ())
            self.update()

    def show_tip(self, tip: Tip) -> None:
        """Where the run is now."""
        if tip != self._tip:
            self._tip = tip
            self._stand()
            self.update()

    def advance(self) -> None:
        """Once a frame: draw on what is not drawn yet, for a few milliseconds at most."""
        drawn = [pane.advance() for pane in self._panes]
        if any(drawn):
            self.update()

    def _show(self, picture: Picture | None, before: Picture | None) -> None:
        if picture is self._picture and before is self._before:
            return
        self._picture, self._before = picture, before
        self._tip = self._tip._replace(block=0)
        views = views_of(picture) if picture is not None else []
        if views != self._views:
            self._views, self._view, self._panes = views, 0, []
        self._set_panes()

    def _set_panes(self) -> None:
        from app.screen.path.pane import Pane

        aspects = self._views[self._view] if self._views else ()
        keep = self.keeps and tuple(pane.aspect for pane in self._panes) == aspects
        panes = self._panes if keep else []
        for number, aspect in enumerate(aspects):
            trail, before = trail_of(self._picture, aspect), trail_of(self._before, aspect)
            assert trail is not None
            if keep:
                panes[number].take(trail, before)
            else:
                panes.append(Pane(self.look, aspect, trail, before))
        self._panes = panes
        self._lay_out()

    def _lay_out(self) -> None:
        room = self._room()
        if self.width() <= 40 or not self._panes:
            self.update()
            return
        wide = room.width() / len(self._panes)
        for number, pane in enumerate(self._panes):
            box = QRectF(room.x() + number * wide, room.y(), wide, room.height())
            pane.lay(box.toRect().toRectF())
        self._stand()
        self.update()

    def _stand(self) -> None:
        for pane in self._panes:
            pane.stand(self._tip.block, self._place_in(pane))

    def _place_in(self, pane: Pane) -> Place:
        """Where the tip is seen in a pane."""
        return pane.place_of(self._tip)

    # --- looking around ------------------------------------------------------------------------------

    def next_view(self) -> None:
        """Another choice of panes, where the program gives one."""
        if len(self._views) > 1:
            self._view = (self._view + 1) % len(self._views)
            self._panes = []
            self._set_panes()

    def fit(self) -> None:
        """The whole part, in every pane."""
        for pane in self._panes:
            pane.fit()
        self.update()

    def restart(self) -> None:
        """The same again, in other colours."""
        for pane in self._panes:
            pane.restart()
        self.update()

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Nearer (positive) or farther, about a point of the widget or about the middle."""
        pane = self._pane_at(at)
        if pane is not None:
            pane.zoom(steps, at)
            self.update()

    def pan(self, across: int, down: int) -> None:
        """Look further right and down by so many steps."""
        pane = self._pane_at(None)
        if pane is not None:
            pane.pan(across, down)
            self.update()

    def _pane_at(self, at: QPointF | None) -> Pane | None:
        """The pane under a point, or the first one."""
        if at is not None:
            found = next((pane for pane in self._panes if pane.room.contains(at)), None)
            if found is not None:
                return found
        return self._panes[0] if self._panes else None

    # --- Qt's calls ----------------------------------------------------------------------------------

    def wheelEvent(self, event: QWheelEvent) -> None:
        """The wheel zooms about the pointer."""
        self.zoom(1 if event.angleDelta().y() > 0 else -1, event.position())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A button of the view, or the start of a drag."""
        pane = self._pane_at(event.position())
        if not self.touch(event.position()) and pane is not None:
            self._held = (pane, event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the picture along."""
        if self._held is not None:
            pane, last = self._held
            self._held = (pane, event.position())
            pane.drag(event.position() - last)
            self.update()

    def mouseReleaseEvent(self, _event: QMouseEvent) -> None:
        """The drag is over."""
        self._held = None

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Another size: the whole part again."""
        self._lay_out()

    # --- drawing -------------------------------------------------------------------------------------

    def _room(self) -> QRectF:
        u = self.look.u
        return self.area().adjusted(0.2 * u, 1.2 * u, -0.2 * u, -0.2 * u).toRect().toRectF()

    def draw(self, painter: QPainter) -> None:
        from app.screen.path import furniture

        look = self.look
        if not self._panes:
            furniture.draw_nothing(
                painter, look, self.inside(), tr("The path is shown when a program is loaded.")
            )
            return
        for pane in self._panes:
            self._draw_pane(painter, pane)
        self._title_again(painter)
        furniture.draw_buttons(painter, look, self._room(), self._buttons(), self.place)
        legend = furniture.run_legend if self._before is None else furniture.compared_legend
        furniture.draw_legend(painter, look, self._panes[0].room, legend(look))

    def _draw_pane(self, painter: QPainter, pane: Pane) -> None:
        from app.screen.path import furniture
        from app.screen.path.approach import draw_approach

        painter.save()
        painter.setClipRect(pane.room)
        painter.translate(pane.room.topLeft())
        pane.draw(painter)
        if self._legs and pane.aspect is Aspect.PATH:
            draw_approach(painter, self.look, pane, self._legs)
        painter.restore()
        if pane.frame is not None:
            furniture.draw_scale(painter, self.look, pane.room, pane.frame, self._tip.metric)
        if pane.aspect is not Aspect.PATH:
            furniture.draw_pane_name(painter, self.look, pane.room, self._name_of(pane))

    def _name_of(self, pane: Pane) -> str:
        if pane.aspect is Aspect.FACE:
            return tr("FACE  ·  SEEN FROM THE TAILSTOCK")
        return tr("SIDE  ·  UNROLLED")

    def _buttons(self) -> list[tuple[str, Press]]:
        found: list[tuple[str, Press]] = [
            ("+", lambda: self.zoom(1)),
            ("−", lambda: self.zoom(-1)),
            (tr("FIT"), self.fit),
        ]
        if len(self._views) > 1:
            found.append((tr("VIEW"), self.next_view))
        return found

    def _title_again(self, painter: QPainter) -> None:
        """The panes have covered the lower half of the title."""
        look, u = self.look, self.look.u
        painter.setFont(look.font(1.7, bold=True))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(2.2 * u, 0, 20 * u, 2.0 * u), LEFT, self.title)
