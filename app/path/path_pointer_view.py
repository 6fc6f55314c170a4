"""The mouse or fingers on the path view: drag it along, spread two fingers, touch a line or a point."""

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

STILL = 0.8  # units: a press that moves less is a touch, not a drag
NEAR = 8.0  # pixels: fingers that lie closer tell no spread


@dataclass(slots=True, eq=False)
class Pointer:
    """Tells drags from touches. ``pressed`` says on which pane, or time line, it went down, if any."""

    look: Look
    pressed: Callable[[QPointF], Pane | PartBar | None]
    hovers: Callable[[QPointF], None]  # it moves over the view and is not held down
    dragged: Callable[[Pane | PartBar, QPointF], None]  # by so many pixels
    touched: Callable[[Pane | PartBar, QPointF], None]  # it came up where it went down
    magnify: Callable[[float, QPointF], None]  # by two fingers, about a point
    _pane: Pane | PartBar | None = None  # that was pressed
    _down: QPointF = field(default_factory=QPointF)
    _last: QPointF = field(default_factory=QPointF)
    _dragging: bool = False
    _spread: float | None = None  # of two fingers, pixels; None until there are two

    def press(self, at: QPointF) -> None:
        """It went down: on a button of the view, or on a pane."""
        self._pane = self.pressed(at)
        self._down = self._last = at
        self._dragging = False

    def move(self, at: QPointF) -> None:
        """It moves; held down it takes the picture along."""
        if self._pane is None:
            self.hovers(at)
            return
        if not self._dragging:
            self._dragging = (at - self._down).manhattanLength() > STILL * self.look.u
        if self._dragging:
            self.dragged(self._pane, at - self._last)
        self._last = at

    def release(self, at: QPointF) -> None:
        """It came up again; where it has not moved something was touched."""
        pane, self._pane = self._pane, None
        if pane is not None and not self._dragging:
            self.touched(pane, at)

    def takes(self, event: QEvent) -> bool:
        """Fingers on the screen or on a touch pad; whether the event was one of theirs."""
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
        """One finger is as the mouse; the one that is left of two does nothing any more."""
        if self._spread is not None:
            return
        if kind == QEvent.Type.TouchBegin:
            self.press(at)
        elif kind == QEvent.Type.TouchUpdate:
            self.move(at)
        elif kind == QEvent.Type.TouchEnd:
            self.release(at)

    def _two(self, one: QPointF, other: QPointF) -> None:
        """Nearer by as much as the fingers spread, about the middle between them."""
        self._pane = None
        way = one - other
        spread, before = max(NEAR, math.hypot(way.x(), way.y())), self._spread
        self._spread = spread
        if before is not None and before != spread:
            self.magnify(spread / before, (one + other) / 2)
