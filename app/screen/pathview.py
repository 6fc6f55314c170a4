"""The path of a program as the operator sees it, wherever one is shown: run, editor, lists, offsets.

From above X+ is down, Z+ to the right, both sides of X0; beside it what is cut with C locked, on the face of
the part or on its side unrolled. Feed it with ``show_picture`` or ``show_compared``, tell ``show_tip`` where
the machine is, and call ``advance`` once a frame. Nothing here computes but where things stand on the screen;
numpy comes with the first picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.screen.look import Look
from app.screen.path.board import PathBoard
from app.screen.path.pointer import Pointer
from app.screen.path.ruling import Picked, Ruling

if TYPE_CHECKING:
    from app.screen.path.measure import Measure
    from app.screen.path.pane import Pane


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
        from app.screen.path.whole import draw_view

        draw_view(painter, self)
