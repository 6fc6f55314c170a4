"""Measuring in the path view with a cursor that snaps to points of the path.

Arrow keys move the cursor to the next end, center or intersection in that direction. Tab moves the cursor
along the path, and Shift with an arrow key moves it by one pixel. Enter sets the first point, then the
second, then a new first point. Clicking with the pointer also sets the points.
"""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QPainter

from app.path import measuring
from app.path.measuring import SnapPoint, SnapPointKind, SnapPoints, describe_snap_point_kind
from app.path.path_aspects import PathViewKind
from app.path.path_pane_view import PathPane
from app.screen.screen_theme import ALIGN_LEFT, ALIGN_RIGHT, draw_text

Key = Qt.Key
KEY_DIRECTIONS = {Key.Key_Left: (-1, 0), Key.Key_Right: (1, 0), Key.Key_Up: (0, -1), Key.Key_Down: (0, 1)}
SNAP_DISTANCE = 2.2  # units: distance within which the pointer snaps to a point
TABLE_SIZE = (22.0, 2.5)  # units: width of the table, height of a row


class Measurement:
    """Measurement in one pane of the path view, with the cursor and the two measured points."""

    def __init__(self, pane: PathPane) -> None:
        self.pane = pane
        self._free = not pane.is_adjusted  # whether the whole path is shown again at the end
        self._features = SnapPoints(pane.polyline)
        self.first_point: SnapPoint | None = None
        self.second_point: SnapPoint | None = None
        self.cursor = self._begin()

    def _begin(self) -> SnapPoint:
        at = self.pane.map_to_plane(self.pane.area.center())
        return self._features.find_nearest_point(*at) or SnapPoint(*at)

    # --- keys and pointer ----------------------------------------------------------------------------

    def key(self, event: QKeyEvent) -> bool:
        """Handle a key press. Return False if measuring does not use the key."""
        key, held = Key(event.key()), event.modifiers()
        if held & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier):
            return False
        if key in KEY_DIRECTIONS:
            fine = bool(held & Qt.KeyboardModifier.ShiftModifier)
            (self._creep if fine else self._jump)(KEY_DIRECTIONS[key])
        elif key in {Key.Key_Tab, Key.Key_Backtab}:
            back = key == Key.Key_Backtab or bool(held & Qt.KeyboardModifier.ShiftModifier)
            self._step(-1 if back else 1)
        elif key in {Key.Key_Return, Key.Key_Enter}:
            self.set_measured_point()
        elif key == Key.Key_Backspace:
            self.clear_points()
        else:
            return False
        return True

    def end_measuring(self) -> None:
        """End measuring, and show the whole path again if it was shown before measuring."""
        if self._free:
            self.pane.fit_view()

    def move_cursor(self, position: QPointF) -> None:
        """Move the cursor to a widget position, or to a snap point near it."""
        z, x = self.pane.map_to_plane(position)
        self._features.update_intersections(self.pane.find_visible_area())
        near = self._features.find_nearest_point(z, x)
        if (
            near is not None
            and _find_distance(self.pane, near, z, x) <= SNAP_DISTANCE * self.pane.theme.unit_px
        ):
            self.cursor = near
        else:
            self.cursor = SnapPoint(z, x)

    def set_measured_point(self) -> None:
        """Set the first or second measured point at the cursor."""
        if self.first_point is None or self.second_point is not None:
            self.first_point, self.second_point = self.cursor, None
        else:
            self.second_point = self.cursor

    def clear_points(self) -> None:
        """Clear the measured points."""
        self.first_point = self.second_point = None

    def find_block(self) -> int:
        """Return the number of the block that is drawn at the cursor, or 0 if there is no block."""
        pane = self.pane
        return pane.find_block(pane.area.topLeft() + pane.map_to_pane(*self.cursor[:2]))

    def rebuild_snap_points(self) -> None:
        """Rebuild the snap points for the pane's new path.

        The measured points are retained.
        """
        self._features = SnapPoints(self.pane.polyline)

    def _jump(self, direction: tuple[int, int]) -> None:
        self._features.update_intersections(self.pane.find_visible_area())
        self._go(self._features.find_point_in_direction(self.cursor.z, self.cursor.x, direction))

    def _creep(self, direction: tuple[int, int]) -> None:
        step = self.pane.pixel_size_mm
        self._go(SnapPoint(self.cursor.z + direction[0] * step, self.cursor.x + direction[1] * step))

    def _step(self, steps: int) -> None:
        self._go(self._features.find_next_path_point(self.cursor.z, self.cursor.x, steps))

    def _go(self, spot: SnapPoint | None) -> None:
        if spot is not None:
            self.cursor = spot
            self.pane.pan_to_point(spot.z, spot.x)

    # --- displayed values ----------------------------------------------------------------------------

    def make_value_rows(self, is_metric: bool) -> list[measuring.MeasurementRow]:
        """Return the rows to display: the cursor position, and its differences from the first point."""
        start, end = self.first_point, self.second_point or self.cursor
        aspect, scale = self.pane.aspect, self.pane.polyline.mm_per_degree
        if aspect in {PathViewKind.PATH, PathViewKind.SECTION}:
            place = measuring.make_path_position_rows(end, is_metric)
            return place + (measuring.make_path_distance_rows(start, end, is_metric) if start else [])
        if aspect is PathViewKind.FACE:
            place = measuring.make_face_position_rows(end, is_metric)
            return place + (measuring.make_face_distance_rows(start, end, is_metric) if start else [])
        place = measuring.make_side_position_rows(end, is_metric, scale)
        return place + (measuring.make_side_distance_rows(start, end, is_metric, scale) if start else [])

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: QPainter) -> None:
        """Draw the measured points and the cursor.

        The origin of the painter is the corner of the pane.
        """
        look, pane = self.pane.theme, self.pane
        if self.first_point is not None:
            start, end = (
                pane.map_to_pane(*self.first_point[:2]),
                pane.map_to_pane(*(self.second_point or self.cursor)[:2]),
            )
            painter.setPen(look.make_pen("lit", 0.3))
            painter.drawLine(start, end)
            for held in (start, end):
                painter.setBrush(look.get_color("lit"))
                painter.drawEllipse(held, 0.6 * look.unit_px, 0.6 * look.unit_px)
        self._cross(painter, pane.map_to_pane(*self.cursor[:2]))

    def _cross(self, painter: QPainter, at: QPointF) -> None:
        look, u = self.pane.theme, self.pane.theme.unit_px
        painter.setPen(look.make_pen("text", 0.16))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawLine(QPointF(at.x(), 0), QPointF(at.x(), self.pane.area.height()))
        painter.drawLine(QPointF(0, at.y()), QPointF(self.pane.area.width(), at.y()))
        if self.cursor.kind is not SnapPointKind.FREE:
            painter.setPen(look.make_pen("tip", 0.3))
            painter.drawRect(QRectF(at.x() - u, at.y() - u, 2 * u, 2 * u))

    def draw_values(self, painter: QPainter, area: QRectF, is_metric: bool) -> None:
        """Draw the table of values in the corner of ``area`` that is farthest from the cursor.

        ``area`` is in widget coordinates.
        """
        look, u, rows = self.pane.theme, self.pane.theme.unit_px, self.make_value_rows(is_metric)
        wide, high = min(TABLE_SIZE[0] * u, area.width() - 2 * u), TABLE_SIZE[1] * u
        tall = (len(rows) + 1) * high + 0.6 * u
        cross = self.pane.area.topLeft() + self.pane.map_to_pane(*self.cursor[:2])
        x = area.x() + u if cross.x() > area.center().x() else area.right() - wide - u
        y = area.bottom() - tall - 2.8 * u if cross.y() < area.center().y() else area.y() + 2.6 * u
        box = QRectF(x, y, wide, tall)
        painter.fillRect(box, look.get_color("ground"))
        painter.setPen(look.make_pen("lit", 0.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        row = QRectF(box.x() + 0.8 * u, box.y() + 0.3 * u, box.width() - 1.6 * u, high)
        self._row(
            painter, row, (describe_snap_point_kind(self.cursor.kind), "mm" if is_metric else "in"), "soft"
        )
        for pair in rows:
            row.translate(0, high)
            self._row(painter, row, pair, "text")

    def _row(self, painter: QPainter, row: QRectF, pair: measuring.MeasurementRow, ink: str) -> None:
        look = self.pane.theme
        painter.setPen(look.get_color("soft"))
        painter.setFont(look.fit_font(pair[0], look.find_table_size(1.6), 0.5 * row.width(), is_bold=True))
        draw_text(painter, row, ALIGN_LEFT, pair[0])
        painter.setPen(look.get_color(ink))
        painter.setFont(look.make_font(look.find_table_size(1.9), is_bold=True))
        draw_text(painter, row, ALIGN_RIGHT, pair[1])


def _find_distance(pane: PathPane, spot: SnapPoint, z: float, x: float) -> float:
    """Return the distance on the screen from a snap point to the position (z, x), in pixels."""
    offset_px = pane.map_to_pane(spot.z, spot.x) - pane.map_to_pane(z, x)
    return float((offset_px.x() ** 2 + offset_px.y() ** 2) ** 0.5)
