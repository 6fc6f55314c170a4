"""Mouse and touch input of the path view: drag, pinch zoom, and selection of a line or point."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QNativeGestureEvent, QTouchEvent

from app.screen.screen_theme import ScreenTheme

if TYPE_CHECKING:
    from app.path.part_bar_view import PartTimeline
    from app.path.path_pane_view import PathPane

DRAG_THRESHOLD = 0.8  # units: a press that moves less is a touch instead of a drag
MIN_PINCH_PX = 8.0  # pixels: smaller finger distances are treated as this distance


@dataclass(slots=True, eq=False)
class PathPointerHandler:
    """Input handler that distinguishes drags from touches.

    ``find_target`` returns the pressed pane or timeline, or None.
    """

    theme: ScreenTheme
    find_target: Callable[[QPointF], PathPane | PartTimeline | None]
    on_hover: Callable[[QPointF], None]  # called while the pointer moves without a pressed button
    on_drag: Callable[[PathPane | PartTimeline, QPointF], None]  # called with the distance in pixels
    # called if the pointer is released where it was pressed
    on_touch: Callable[[PathPane | PartTimeline, QPointF], None]
    on_magnify: Callable[[float, QPointF], None]  # called with the factor and center of a pinch gesture
    _pane: PathPane | PartTimeline | None = None  # the pressed target
    _down: QPointF = field(default_factory=QPointF)
    _last: QPointF = field(default_factory=QPointF)
    _dragging: bool = False
    _spread: float | None = None  # distance of two fingers in pixels; None until there are two

    def begin_press(self, position: QPointF) -> None:
        """Start a press on a button of the view or on a pane."""
        self._pane = self.find_target(position)
        self._down = self._last = position
        self._dragging = False

    def handle_pointer_motion(self, position: QPointF) -> None:
        """Handle motion of the pointer.

        The picture is dragged while the pointer is pressed.
        """
        if self._pane is None:
            self.on_hover(position)
            return
        if not self._dragging:
            self._dragging = (position - self._down).manhattanLength() > DRAG_THRESHOLD * self.theme.unit_px
        if self._dragging:
            self.on_drag(self._pane, position - self._last)
        self._last = position

    def end_press(self, position: QPointF) -> None:
        """End a press.

        A press without motion is a touch.
        """
        pane, self._pane = self._pane, None
        if pane is not None and not self._dragging:
            self.on_touch(pane, position)

    def handle_touch_event(self, event: QEvent) -> bool:
        """Handle a touch or gesture event, and return whether the event was processed."""
        if isinstance(event, QNativeGestureEvent):
            if event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture:
                self.on_magnify(1.0 + event.value(), event.position())
            return True
        if not isinstance(event, QTouchEvent):
            return False
        spots = [point.position() for point in event.points()]
        if len(spots) > 1:
            self._handle_two_touches(spots[0], spots[1])
        elif spots:
            self._handle_one_touch(event.type(), spots[0])
        if event.type() in {QEvent.Type.TouchEnd, QEvent.Type.TouchCancel}:
            self._pane, self._spread = None, None
        event.accept()
        return True

    def _handle_one_touch(self, kind: QEvent.Type, at: QPointF) -> None:
        """Handle a single touch like a press of the mouse button.

        After a pinch, the finger that remains on the screen has no effect.
        """
        if self._spread is not None:
            return
        if kind == QEvent.Type.TouchBegin:
            self.begin_press(at)
        elif kind == QEvent.Type.TouchUpdate:
            self.handle_pointer_motion(at)
        elif kind == QEvent.Type.TouchEnd:
            self.end_press(at)

    def _handle_two_touches(self, one: QPointF, other: QPointF) -> None:
        """Magnify by the change in the distance between two touches, around their midpoint."""
        self._pane = None
        finger_offset = one - other
        spread, before = max(MIN_PINCH_PX, math.hypot(finger_offset.x(), finger_offset.y())), self._spread
        self._spread = spread
        if before is not None and before != spread:
            self.on_magnify(spread / before, (one + other) / 2)
