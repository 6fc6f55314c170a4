"""What is typed to find a line."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.entry_panel import draw_entry
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel


class AskedPanel(Panel):
    """The question and the answer as far as it is typed."""

    ground = "panel"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.text = ""

    def show_text(self, text: str) -> None:
        """What is typed."""
        if text != self.text:
            self.text = text
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        room = self.area().adjusted(1.2 * u, 0.4 * u, -0.8 * u, -0.4 * u)
        painter.setPen(look.colour("text"))
        question = tr("LINE OR TEXT?")
        painter.setFont(look.fit(question, 1.9, 14 * u, bold=True))
        put(painter, QRectF(room.x(), room.y(), 14 * u, room.height()), LEFT, question)
        box = room.adjusted(14.5 * u, 0, 0, 0)
        painter.setPen(look.pen("accent", 0.2))
        painter.setBrush(look.colour("ground"))
        painter.drawRect(box)
        draw_entry(painter, look, box.adjusted(0.8 * u, 0, -0.8 * u, 0), self.text)
