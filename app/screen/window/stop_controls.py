"""Drawn controls and keys of pages that stop something, and the rectangles of the controls."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QRectF
from PySide6.QtGui import QInputEvent, QKeyEvent, QPointerEvent
from PySide6.QtWidgets import QWidget

from app.desk.stop_keys.stop_records import StopArea, StopKind
from app.screen.panel import TouchPanel
from app.screen.window.key_table import find_typed_text
from app.screen.window.window_frame import WindowFrame


def is_stop_control_at(frame: WindowFrame, event: QInputEvent) -> bool:
    """Return whether a mouse press or touch is on a visible control that stops something."""
    if not isinstance(event, QPointerEvent):
        return False
    return any(_has_stop_control_at(frame.window(), point.globalPosition()) for point in event.points())


def _has_stop_control_at(window: QWidget, position: QPointF) -> bool:
    """Return whether the part of the window at a position of the screen has a stop control there."""
    part = window.childAt(window.mapFromGlobal(position).toPoint())
    return isinstance(part, TouchPanel) and part.has_stop_control_at(part.mapFromGlobal(position))


def is_page_stop_key(frame: WindowFrame, event: QKeyEvent) -> bool:
    """Return whether a key stops something on the current page, such as 0 (SPINDLE STOP) on the Jog page."""
    return not frame.has_text_field() and (
        find_typed_text(event) in frame.current_page.make_stop_key_actions()
    )


def find_stop_areas(frame: WindowFrame) -> tuple[StopArea, ...]:
    """Return the rectangles of the visible controls for which the key watcher sends a stop.

    A control whose center is covered by another part of the window is not included.
    """
    dock, window = frame.station_dock, frame.window()
    if dock is None or not dock.isVisible() or window.isMinimized():
        return ()
    corner = QPointF(dock.mapTo(window, QPoint(0, 0)))
    return tuple(
        _make_stop_area(control.box.translated(corner), control.watched_stop, window)
        for control in dock.controls
        if control.watched_stop is not None
        and window.childAt((control.box.center() + corner).toPoint()) is dock
    )


def _make_stop_area(box: QRectF, stop_kind: StopKind, window: QWidget) -> StopArea:
    """Return a rectangle of the window in pixels of X."""
    scale = window.devicePixelRatioF()
    left, top = round(box.left() * scale), round(box.top() * scale)
    width, height = round(box.right() * scale) - left, round(box.bottom() * scale) - top
    return StopArea(int(window.winId()), left, top, width, height, stop_kind)
