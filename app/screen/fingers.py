"""A panel under several fingers at once: each touch holds the control it went down on until it comes up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QEventPoint, QMouseEvent, QTouchEvent
from PySide6.QtWidgets import QWidget

from app.screen.look import Look
from app.screen.panel import Panel

MOUSE = -1  # the pointer's place among the touches


@dataclass(frozen=True, slots=True)
class Control:
    """One thing to press: what going down on it, moving along it and coming up do."""

    box: QRectF
    down: Callable[[QPointF], None]
    along: Callable[[QPointF], None] | None = None
    up: Callable[[], None] | None = None
    always: bool = False  # it stops the machine: it acts however late the finger is seen


class FingerPanel(Panel):
    """Drawing declares the controls; fingers and the mouse find them."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.controls: list[Control] = []
        self._held: dict[int, Control] = {}
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def stops_at(self, at: QPointF) -> bool:
        """Whether what stands there stops the machine."""
        return any(control.always and control.box.contains(at) for control in self.controls)

    @property
    def fingers(self) -> int:
        """How many hold something."""
        return len(self._held)

    def mouse_is_up(self) -> None:
        """The button was let go where nobody could see it."""
        self._up(MOUSE)

    def let_go(self) -> None:
        """Forget what fingers hold: their release will not arrive any more."""
        for finger in tuple(self._held):
            self._up(finger)

    def event(self, event: QEvent) -> bool:
        """Touches come here; everything else goes its usual way."""
        if not isinstance(event, QTouchEvent):
            return super().event(event)
        for point in event.points():
            self._finger(point)
        if event.type() == QEvent.Type.TouchCancel:
            self.let_go()
        event.accept()
        return True

    def _finger(self, point: QEventPoint) -> None:
        state = point.state()
        if state == QEventPoint.State.Pressed:
            self._down(point.id(), point.position())
        elif state == QEventPoint.State.Updated:
            self._along(point.id(), point.position())
        elif state == QEventPoint.State.Released:
            self._up(point.id())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """The mouse is one finger, and its left button; what stops takes any."""
        if event.button() is Qt.MouseButton.LeftButton or self.stops_at(event.position()):
            self._up(MOUSE)
            self._down(MOUSE, event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Along the control that it went down on."""
        self._along(MOUSE, event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Up again, wherever it is now."""
        if not event.buttons() & Qt.MouseButton.LeftButton:
            self._up(MOUSE)

    def _down(self, finger: int, at: QPointF) -> None:
        for control in self.controls:
            if control.box.contains(at):
                self._held[finger] = control
                control.down(at)
                return

    def _along(self, finger: int, at: QPointF) -> None:
        control = self._held.get(finger)
        if control and control.along:
            control.along(at)

    def _up(self, finger: int) -> None:
        control = self._held.pop(finger, None)
        if control and control.up:
            control.up()
