"""The mouse or a finger on the path view: drag it along, spread two fingers, touch a line or a point."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QNativeGestureEvent
from PySide6.QtWidgets import QGesture, QGestureEvent, QPinchGesture

if TYPE_CHECKING:
    from app.screen.path.pane import Pane
    from app.screen.pathview import PathView

STILL = 0.8  # units: a press that moves less is a touch, not a drag


class Pointer:
    """Tells drags from touches; the view says what a touch means."""

    def __init__(self, view: PathView) -> None:
        self._view = view
        self._pane: Pane | None = None  # that was pressed
        self._down = self._last = QPointF()
        self._dragging = False

    def press(self, event: QMouseEvent) -> None:
        """It went down on a pane."""
        self._pane = self._view.pane_at(event.position())
        self._down = self._last = event.position()
        self._dragging = False

    def move(self, event: QMouseEvent) -> None:
        """It moves; held down it takes the picture along."""
        at = event.position()
        if self._pane is None:
            self._view.ruling.point(at)
            return
        if not self._dragging:
            self._dragging = (at - self._down).manhattanLength() > STILL * self._view.look.u
        if self._dragging:
            self._pane.drag(at - self._last)
            self._view.update()
        self._last = at

    def release(self, event: QMouseEvent) -> None:
        """It came up again; where it has not moved something was touched."""
        pane, self._pane = self._pane, None
        if pane is not None and not self._dragging:
            self._view.ruling.touched(pane, event.position())

    def gesture(self, event: QEvent) -> bool:
        """Two fingers on the screen or on a touch pad; whether the event was one of theirs."""
        if isinstance(event, QNativeGestureEvent):
            if event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture:
                self._view.magnify(1.0 + event.value(), event.position())
            return True
        if not isinstance(event, QGestureEvent):
            return False
        found: QGesture | None = event.gesture(Qt.GestureType.PinchGesture)
        if found is not None:
            pinch = cast("QPinchGesture", found)
            self._dragging = True  # the first finger's release is no touch
            self._view.magnify(pinch.scaleFactor(), self._view.mapFromGlobal(pinch.centerPoint()))
        return True
