"""What is in force, one row for each group of codes."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.inforce import InForce
from app.desk.words import tr
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel

SHARE = 0.4  # of a row for its label


class InForcePanel(Panel):
    """All rows at once, as large as the room lets them be."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.rows: tuple[InForce, ...] = ()

    def show_rows(self, rows: tuple[InForce, ...]) -> None:
        """The state of this instant."""
        if rows != self.rows:
            self.rows = rows
            self.update()

    def draw(self, painter: QPainter) -> None:
        self.frame(painter, tr("IN FORCE"))
        look, u, room = self.look, self.look.u, self.inside()
        high = min(2.7 * u, room.height() / max(1, len(self.rows)))
        size = min(1.9, high / u * 0.78)
        left = SHARE * room.width()
        for number, row in enumerate(self.rows):
            box = QRectF(room.x(), room.y() + number * high, room.width(), high)
            painter.setPen(look.colour("soft"))
            painter.setFont(look.fit(row.label, size, left - u))
            put(painter, QRectF(box.x(), box.y(), left - u, high), LEFT, row.label)
            painter.setPen(look.colour("text"))
            painter.setFont(look.fit(row.value, size, room.width() - left, bold=True))
            put(painter, box.adjusted(left, 0, 0, 0), LEFT, row.value)
