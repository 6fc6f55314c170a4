"""Measuring in the path view with a cursor that snaps to points of the path.

Arrow keys move the cursor to the next end, center or intersection in that direction. Tab moves the cursor
along the path, and Shift with an arrow key moves it by one pixel. Enter sets the first point, then the
second, then a new first point. The pointer does the same.
"""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QPainter

from app.path import measuring
from app.path.measuring import Features, Point, PointKind, kind_words
from app.path.path_aspects import Aspect
from app.path.path_pane_view import Pane
from app.screen.look import LEFT, RIGHT, put

Key = Qt.Key
WAYS = {Key.Key_Left: (-1, 0), Key.Key_Right: (1, 0), Key.Key_Up: (0, -1), Key.Key_Down: (0, 1)}
CATCH = 2.2  # units: distance within which the pointer snaps to a point
TABLE = (22.0, 2.5)  # units: width of the table, height of a row


class Measure:
    """Measurement in one pane, with the ``cursor`` and the two measured points."""

    def __init__(self, pane: Pane) -> None:
        self.pane = pane
        self._free = not pane.by_hand  # whether the whole path is shown again at the end
        self._features = Features(pane.polyline)
        self.first: Point | None = None
        self.second: Point | None = None
        self.cursor = self._begin()

    def _begin(self) -> Point:
        at = self.pane.here(self.pane.room.center())
        return self._features.nearest(*at) or Point(*at)

    # --- keys and pointer ----------------------------------------------------------------------------

    def key(self, event: QKeyEvent) -> bool:
        """Handle a key press and return whether the key was used for measuring."""
        key, held = Key(event.key()), event.modifiers()
        if held & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier):
            return False
        if key in WAYS:
            fine = bool(held & Qt.KeyboardModifier.ShiftModifier)
            (self._creep if fine else self._jump)(WAYS[key])
        elif key in {Key.Key_Tab, Key.Key_Backtab}:
            back = key == Key.Key_Backtab or bool(held & Qt.KeyboardModifier.ShiftModifier)
            self._step(-1 if back else 1)
        elif key in {Key.Key_Return, Key.Key_Enter}:
            self.hold()
        elif key == Key.Key_Backspace:
            self.forget()
        else:
            return False
        return True

    def end(self) -> None:
        """Show the whole path again if it was shown before measuring."""
        if self._free:
            self.pane.fit()

    def point(self, at: QPointF) -> None:
        """Move the cursor to the snap point near a widget position, or to the position itself."""
        z, x = self.pane.here(at)
        self._features.look(self.pane.sight())
        near = self._features.nearest(z, x)
        if near is not None and _apart(self.pane, near, z, x) <= CATCH * self.pane.look.u:
            self.cursor = near
        else:
            self.cursor = Point(z, x)

    def hold(self) -> None:
        """Set the first or second measured point at the cursor."""
        if self.first is None or self.second is not None:
            self.first, self.second = self.cursor, None
        else:
            self.second = self.cursor

    def forget(self) -> None:
        """Clear the measured points."""
        self.first = self.second = None

    def block(self) -> int:
        """Return the number of the block that is drawn at the cursor, or 0 without a block."""
        pane = self.pane
        return pane.block_at(pane.room.topLeft() + pane.spot(*self.cursor[:2]))

    def renew(self) -> None:
        """Rebuild the snap points for the pane's new path. The measured points remain."""
        self._features = Features(self.pane.polyline)

    def _jump(self, way: tuple[int, int]) -> None:
        self._features.look(self.pane.sight())
        self._go(self._features.towards(self.cursor.z, self.cursor.x, way))

    def _creep(self, way: tuple[int, int]) -> None:
        step = self.pane.pixel
        self._go(Point(self.cursor.z + way[0] * step, self.cursor.x + way[1] * step))

    def _step(self, steps: int) -> None:
        self._go(self._features.following(self.cursor.z, self.cursor.x, steps))

    def _go(self, spot: Point | None) -> None:
        if spot is not None:
            self.cursor = spot
            self.pane.show_spot(spot.z, spot.x)

    # --- displayed values ----------------------------------------------------------------------------

    def rows(self, metric: bool) -> list[measuring.Row]:
        """Return the rows to display: the cursor position and the differences from the first point."""
        start, end = self.first, self.second or self.cursor
        aspect, scale = self.pane.aspect, self.pane.polyline.round
        if aspect in {Aspect.PATH, Aspect.SECTION}:
            place = measuring.place_on_path(end, metric)
            return place + (measuring.between_on_path(start, end, metric) if start else [])
        if aspect is Aspect.FACE:
            place = measuring.place_on_face(end, metric)
            return place + (measuring.between_on_face(start, end, metric) if start else [])
        place = measuring.place_on_side(end, metric, scale)
        return place + (measuring.between_on_side(start, end, metric, scale) if start else [])

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: QPainter) -> None:
        """Draw the measured points and the cursor. The painter's origin is the corner of the pane."""
        look, pane = self.pane.look, self.pane
        if self.first is not None:
            start, end = pane.spot(*self.first[:2]), pane.spot(*(self.second or self.cursor)[:2])
            painter.setPen(look.pen("lit", 0.3))
            painter.drawLine(start, end)
            for held in (start, end):
                painter.setBrush(look.colour("lit"))
                painter.drawEllipse(held, 0.6 * look.u, 0.6 * look.u)
        self._cross(painter, pane.spot(*self.cursor[:2]))

    def _cross(self, painter: QPainter, at: QPointF) -> None:
        look, u = self.pane.look, self.pane.look.u
        painter.setPen(look.pen("text", 0.16))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawLine(QPointF(at.x(), 0), QPointF(at.x(), self.pane.room.height()))
        painter.drawLine(QPointF(0, at.y()), QPointF(self.pane.room.width(), at.y()))
        if self.cursor.kind is not PointKind.FREE:
            painter.setPen(look.pen("tip", 0.3))
            painter.drawRect(QRectF(at.x() - u, at.y() - u, 2 * u, 2 * u))

    def draw_figures(self, painter: QPainter, room: QRectF, metric: bool) -> None:
        """Draw the table of values in the corner of ``room`` that is farthest from the cursor.

        ``room`` is in widget coordinates.
        """
        look, u, rows = self.pane.look, self.pane.look.u, self.rows(metric)
        wide, high = min(TABLE[0] * u, room.width() - 2 * u), TABLE[1] * u
        tall = (len(rows) + 1) * high + 0.6 * u
        cross = self.pane.room.topLeft() + self.pane.spot(*self.cursor[:2])
        x = room.x() + u if cross.x() > room.center().x() else room.right() - wide - u
        y = room.bottom() - tall - 2.8 * u if cross.y() < room.center().y() else room.y() + 2.6 * u
        box = QRectF(x, y, wide, tall)
        painter.fillRect(box, look.colour("ground"))
        painter.setPen(look.pen("lit", 0.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        row = QRectF(box.x() + 0.8 * u, box.y() + 0.3 * u, box.width() - 1.6 * u, high)
        self._row(painter, row, (kind_words(self.cursor.kind), "mm" if metric else "in"), "soft")
        for pair in rows:
            row.translate(0, high)
            self._row(painter, row, pair, "text")

    def _row(self, painter: QPainter, row: QRectF, pair: measuring.Row, ink: str) -> None:
        look = self.pane.look
        painter.setPen(look.colour("soft"))
        painter.setFont(look.fit(pair[0], 1.6, 0.5 * row.width(), bold=True))
        put(painter, row, LEFT, pair[0])
        painter.setPen(look.colour(ink))
        painter.setFont(look.font(1.9, bold=True))
        put(painter, row, RIGHT, pair[1])


def _apart(pane: Pane, spot: Point, z: float, x: float) -> float:
    """Return the distance between a point and a position, in pixels."""
    way = pane.spot(spot.z, spot.x) - pane.spot(z, x)
    return float((way.x() ** 2 + way.y() ** 2) ** 0.5)
