"""The path of a program as the operator sees it, wherever one is shown: run, editor, lists, offsets.

From above X+ is down, Z+ to the right, both sides of X0; beside it what is cut with C locked, on the face of
the part or on its side unrolled. Feed it with ``show_picture`` or ``show_compared``, tell ``show_tip`` where
the machine is, and call ``advance`` once a frame. Nothing here computes but where things stand on the screen;
numpy comes with the first picture.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.path.path_aspects import Aspect, Tip
from app.path.path_pointer_view import Pointer
from app.screen.look import Look
from app.screen.panel import Panel

if TYPE_CHECKING:
    from app.path.measuring_view import Measure
    from app.path.path_aspects import DrawnLeg
    from app.path.path_layers_view import Frame
    from app.path.path_pane_view import Pane, Panes, Place
    from app.path.path_picture import Picture

# --- What is shown of programs' paths, side by side: pictures, the way back into one, the tip.


COLUMN = 6.4  # units at the right of a view that are the buttons'


class PathBoard(Panel):
    """Panes side by side, each with its own zoom. Nothing here computes but where things stand on the screen;
    numpy comes with the first picture.
    """

    keeps = False  # whether what is looked at by hand stays when the picture changes

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.legs: tuple[DrawnLeg, ...] = ()
        self._set: Panes | None = None
        self._tip: Tip | None = None  # not drawn before somebody tells it

    def renewed(self, panes: Sequence[Pane]) -> None:
        """Other pictures are in the panes."""

    @property
    def panes(self) -> Sequence[Pane]:
        """What is side by side now."""
        return self._set.now if self._set is not None else ()

    @property
    def view(self) -> Frame | None:
        """What is looked at in the first pane."""
        return self.panes[0].frame if self.panes else None

    @property
    def several(self) -> bool:
        """Whether there is another choice of panes."""
        return self._set is not None and self._set.several

    @property
    def comparing(self) -> bool:
        """Whether two pictures are shown."""
        return self._set is not None and self._set.before is not None

    @property
    def picture(self) -> Picture | None:
        """What is shown."""
        return self._set.picture if self._set is not None else None

    @property
    def drawn(self) -> bool:
        """Whether there is anything to look at."""
        return self.picture is not None and len(self.picture.z) > 0

    @property
    def in_mm(self) -> bool:
        """The unit of the program."""
        return self.picture is not None and self.picture.metric

    # --- what is shown -------------------------------------------------------------------------------

    def show_picture(self, picture: Picture | None) -> None:
        """Another program's path, or none."""
        self._show(picture, None)

    def show_compared(self, before: Picture | None, after: Picture | None) -> None:
        """One program before and after a change, both on one view with a legend; no tip, nothing done.

        With ``after`` None there is nothing to show, with ``before`` None ``after`` is shown alone.
        """
        self._show(after, before)

    def show_approach(self, legs: Sequence[DrawnLeg] | None) -> None:
        """The way back into the program, over its path; the first leg is where the tool stands."""
        if tuple(legs or ()) != self.legs:
            self.legs = tuple(legs or ())
            self._include()
            self.update()

    def show_tip(self, tip: Tip) -> None:
        """Where the run is now."""
        if tip != self._tip:
            self._tip = tip
            self._stand()
            self.update()

    def mark(self, blocks: list[tuple[int, int]]) -> None:
        """Draw blocks thick: ranges of numbers from 1, the last one in them."""
        for pane in self.panes:
            pane.mark(blocks)
        self.update()

    def advance(self) -> None:
        """Once a frame: draw on what is not drawn yet, for a few milliseconds at most."""
        if self._set is not None and self._set.advance():
            self.update()

    def _show(self, picture: Picture | None, before: Picture | None) -> None:
        from app.path.path_pane_view import Panes

        if self._set is None:
            self._set = Panes(self.look, self.keeps)
        if picture is self._set.picture and before is self._set.before:
            return
        if self._tip is not None:
            self._tip = self._tip._replace(block=0)
        self._set.show(picture, before)
        self.renewed(self._set.now)
        self._lay_out()

    def _lay_out(self) -> None:
        if self._set is not None:
            self._include()
            self._set.lay(self.room().adjusted(0, 0, -COLUMN * self.look.u, 0))
            self._stand()
        self.update()

    def _include(self) -> None:
        """The way back is seen whole."""
        for pane in self.panes:
            if pane.aspect is Aspect.PATH:
                pane.include([(leg.z, leg.x) for leg in self.legs])

    def _stand(self) -> None:
        if self._tip is not None:
            for pane in self.panes:
                pane.stand(self._tip.block, self._place_in(pane, self._tip), self._tip.stood)

    def _place_in(self, pane: Pane, tip: Tip) -> Place | None:
        """Where the tip is seen in a pane."""
        return pane.place_of(tip)

    def fit(self) -> None:
        """The whole part, in every pane."""
        for pane in self.panes:
            pane.fit()
        self.update()

    def restart(self) -> None:
        """The same again, in other colours."""
        for pane in self.panes:
            pane.restart()
        self.update()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Another size: the whole part again."""
        self._lay_out()

    def room(self) -> QRectF:
        """The view within its frame; the panes share what the column of buttons leaves of it."""
        u = self.look.u
        return self.area().adjusted(0.2 * u, 1.2 * u, -0.2 * u, -0.2 * u).toRect().toRectF()


# --- When the path view measures, and what a touch means: a point to measure from, or the block drawn there.


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
        from app.path.measuring_view import Measure

        now = self.now = Measure(pane)
        self._view.setMouseTracking(True)
        return now


class PathView(PathBoard):
    """Panes side by side, each with its own zoom; keys act on the first, fingers on the one they touch.

    ``picked`` is called with the block (from 1) whose line was touched. While measuring the view has the
    keyboard; keys that mean nothing there go on to the window.
    """

    title = "PATH"

    def __init__(self, look: Look, parent: QWidget | None = None, picked: Picked | None = None) -> None:
        super().__init__(look, parent)
        self._pointer, self.ruling = Pointer(self), Ruling(self, picked)
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    # --- looking around ------------------------------------------------------------------------------

    def next_view(self) -> None:
        """Another choice of panes, where the program gives one."""
        if self._set is not None and self.several:
            measuring = self.ruler is not None
            self.measure(on=False)
            self._set.next_view()
            self._lay_out()
            self.measure(on=measuring)

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Nearer (positive) or farther, about a point of the widget or about the middle."""
        pane = self.pane_at(at)
        if pane is not None:
            pane.zoom(steps, at)
            self.update()

    def magnify(self, factor: float, at: QPointF) -> None:
        """Nearer by a factor about a point of the widget."""
        pane = self.pane_at(at)
        if pane is not None:
            pane.magnify(factor, at)
            self.update()

    def pan(self, across: int, down: int) -> None:
        """Look further right and down by so many steps."""
        pane = self.pane_at(None)
        if pane is not None:
            pane.pan(across, down)
            self.update()

    def pane_at(self, at: QPointF | None) -> Pane | None:
        """The pane under a point, or else the one that is measured in, or the first."""
        found = self._set.at(at) if self._set is not None and at is not None else None
        if found is None:
            found = self.ruler.pane if self.ruler is not None else next(iter(self.panes), None)
        return found

    def renewed(self, panes: Sequence[Pane]) -> None:
        """What is measured is of the picture that was."""
        self.ruling.renew(panes)

    # --- measuring and picking -----------------------------------------------------------------------

    @property
    def ruler(self) -> Measure | None:
        """What one measures with; None while one does not."""
        return self.ruling.now

    def measure(self, *, on: bool | None = None) -> None:
        """Begin or end measuring; None: the other way round."""
        self.ruling.switch(on=self.ruler is None if on is None else on)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Keys of measuring; all others are the window's."""
        if self.ruler is not None and self.ruler.key(event):
            self.update()
        else:
            event.ignore()

    def focusNextPrevChild(self, _next: bool) -> bool:
        """Tab is a key of measuring."""
        return False

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Another field has the keyboard: measuring is over. Another window: it waits."""
        if event.reason() is not Qt.FocusReason.ActiveWindowFocusReason:
            self.measure(on=False)

    def event(self, event: QEvent) -> bool:
        """Fingers; everything else goes its usual way."""
        return self._pointer.takes(event) or super().event(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """The wheel zooms about the pointer."""
        self.zoom(1 if event.angleDelta().y() > 0 else -1, event.position())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A button of the view, or the start of a drag."""
        self._pointer.press(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the picture along."""
        self._pointer.move(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """The drag is over."""
        self._pointer.release(event.position())

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: QPainter) -> None:
        from app.path.path_marks_view import draw_view

        draw_view(painter, self)
