"""Position, feed, spindle and tool in one low row, above every page that has them not large."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.formats import percent
from app.desk.readout import AxisView
from app.desk.view import View
from app.desk.words import tr
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Panel

LATHE_COLUMNS = 3  # X, Z and C; a mill has more


class HeadLine(Panel):
    """Everything of one snapshot; X keeps its filled Ø or hollow R."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.view: View | None = None
        self._shown: object = None

    def show_view(self, view: View) -> None:
        """Redraw when one of its figures has changed."""
        self.view = view
        shown = (view.position, view.feed, view.spindle, view.tool, view.secondary)
        if shown != self._shown:
            self._shown = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        view = self.view
        if view is None:
            return
        position = view.position
        self.frame(painter, f"{position.readout.value}  ·  {position.unit}  ·  {position.x_words}")
        u, room = (
            self.look.u,
            self.area().adjusted(
                1.2 * self.look.u, 2.2 * self.look.u, -1.2 * self.look.u, -0.6 * self.look.u
            ),
        )
        columns = max(LATHE_COLUMNS, len(position.axes))
        share = (0.58 if columns == LATHE_COLUMNS else 0.7) * room.width() / columns
        for number, axis in enumerate(position.axes):
            at = QRectF(room.x() + number * share, room.y(), share - 1.4 * u, room.height())
            self._axis(painter, at, axis)
        taken = columns * share
        rest = QRectF(room.x() + taken, room.y(), room.width() - taken, room.height())
        self._figures(painter, rest, view)

    def _axis(self, painter: QPainter, at: QRectF, axis: AxisView) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(2.8, bold=True))
        put(painter, QRectF(at.x(), at.y(), 3 * u, at.height()), LEFT, axis.name)
        if axis.mark:
            box = QRectF(at.x() + 2.8 * u, at.center().y() - 1.5 * u, 3.0 * u, 3.0 * u)
            painter.setPen(look.pen("mark", 0.25))
            painter.setBrush(look.colour("mark") if axis.mark == "Ø" else Qt.BrushStyle.NoBrush)
            painter.drawRect(box)
            painter.setPen(look.colour("on_mark" if axis.mark == "Ø" else "mark"))
            painter.setFont(look.font(2.4, bold=True))
            put(painter, box, CENTRE, axis.mark)
        painter.setPen(look.colour("text" if axis.homed else "alarm"))
        room = at.adjusted((6.4 if axis.mark else 3.2) * u, 0, 0, 0)
        painter.setFont(look.fit(axis.value, 3.4, room.width(), bold=True))
        put(painter, room, RIGHT, axis.value)

    def _figures(self, painter: QPainter, room: QRectF, view: View) -> None:
        look, u = self.look, self.look.u
        feed, spindle = view.feed, view.spindle
        cells = (
            (f"FEED {percent(feed.override)}", f"{feed.actual} {tr(feed.actual_unit)}", 0.42),
            (
                f"SPINDLE {percent(spindle.override)}",
                f"{tr(spindle.direction)} {spindle.rpm}/{spindle.actual}",
                0.36,
            ),
            ("TOOL", f"{view.tool} {view.secondary}", 0.22),
        )
        x = room.x() + 1.6 * u
        for label, figure, share in cells:
            wide = share * (room.width() - 1.6 * u)
            painter.setPen(look.colour("soft"))
            painter.setFont(look.fit(label, 1.5, wide - u, bold=True))
            put(painter, QRectF(x, room.y() - 0.4 * u, wide - u, 1.9 * u), LEFT, label)
            painter.setPen(look.colour("text"))
            painter.setFont(look.fit(figure, 2.3, wide - u, bold=True))
            put(painter, QRectF(x, room.y() + 1.5 * u, wide - u, room.height() - 1.7 * u), LEFT, figure)
            x += wide
