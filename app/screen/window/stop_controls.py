"""Drawn controls that stop the machine: which control a press hits, and where the controls are."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QRectF
from PySide6.QtGui import QInputEvent, QPointerEvent
from PySide6.QtWidgets import QWidget

from app.desk.stop_keys.stop_records import StopArea, StopKind
from app.screen.window.window_frame import WindowFrame


def is_stop_control_at(frame: WindowFrame, event: QInputEvent) -> bool:
    """Return whether a mouse press or touch is on a control that stops the machine."""
    dock = frame.station_dock
    if dock is None or not dock.isVisible() or not isinstance(event, QPointerEvent):
        return False
    places = (dock.mapFromGlobal(point.globalPosition()) for point in event.points())
    return any(dock.has_stop_control_at(place) for place in places)


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
