"""Mouse and touch input of the path view: dragging, pinch zoom and touching a line or a point."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QNativeGestureEvent, QTouchEvent

from app.screen.look import Look

if TYPE_CHECKING:
    from app.path.part_bar_view import PartBar
    from app.path.path_pane_view import Pane

STILL = 0.8  # units: a press that moves less is a touch instead of a drag
NEAR = 8.0  # pixels: smaller finger distances are treated as this distance


@dataclass(slots=True, eq=False)
class Pointer:
    """Distinguishes drags from touches.

    ``pressed`` returns the pressed pane or time line, or None.
    """

    look: Look
    pressed: Callable[[QPointF], Pane | PartBar | None]
    hovers: Callable[[QPointF], None]  # called while the pointer moves without a pressed button
    dragged: Callable[[Pane | PartBar, QPointF], None]  # called with the distance in pixels
    # called if the pointer is released where it was pressed
    touched: Callable[[Pane | PartBar, QPointF], None]
    magnify: Callable[[float, QPointF], None]  # called with the factor and center of a pinch gesture
    _pane: Pane | PartBar | None = None  # the pressed target
    _down: QPointF = field(default_factory=QPointF)
    _last: QPointF = field(default_factory=QPointF)
    _dragging: bool = False
    _spread: float | None = None  # distance of two fingers in pixels; None until there are two

    def press(self, at: QPointF) -> None:
        """Start a press on a button of the view or on a pane."""
        self._pane = self.pressed(at)
        self._down = self._last = at
        self._dragging = False

    def move(self, at: QPointF) -> None:
        """Handle motion of the pointer. A pressed pointer drags the picture."""
        if self._pane is None:
            self.hovers(at)
            return
        if not self._dragging:
            self._dragging = (at - self._down).manhattanLength() > STILL * self.look.u
        if self._dragging:
            self.dragged(self._pane, at - self._last)
        self._last = at

    def release(self, at: QPointF) -> None:
        """End a press. A press without motion is a touch."""
        pane, self._pane = self._pane, None
        if pane is not None and not self._dragging:
            self.touched(pane, at)

    def takes(self, event: QEvent) -> bool:
        """Handle a touch or gesture event, and return whether the event was used."""
        if isinstance(event, QNativeGestureEvent):
            if event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture:
                self.magnify(1.0 + event.value(), event.position())
            return True
        if not isinstance(event, QTouchEvent):
            return False
        spots = [point.position() for point in event.points()]
        if len(spots) > 1:
            self._two(spots[0], spots[1])
        elif spots:
            self._one(event.type(), spots[0])
        if event.type() in {QEvent.Type.TouchEnd, QEvent.Type.TouchCancel}:
            self._pane, self._spread = None, None
        event.accept()
        return True

    def _one(self, kind: QEvent.Type, at: QPointF) -> None:
        """Handle one finger like the mouse. A finger that remains after a pinch does nothing."""
        if self._spread is not None:
            return
        if kind == QEvent.Type.TouchBegin:
            self.press(at)
        elif kind == QEvent.Type.TouchUpdate:
            self.move(at)
        elif kind == QEvent.Type.TouchEnd:
            self.release(at)

    def _two(self, one: QPointF, other: QPointF) -> None:
        """Magnify by the change of the finger distance, around the middle of the fingers."""
        self._pane = None
        way = one - other
        spread, before = max(NEAR, math.hypot(way.x(), way.y())), self._spread
        self._spread = spread
        if before is not None and before != spread:
            self.magnify(spread / before, (one + other) / 2)
