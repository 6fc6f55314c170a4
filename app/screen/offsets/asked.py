"""The dialogue under the table: which offset, what is asked, what was typed, and old → new."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.offsets.desk import CLEAR, LEAVE, OffsetDesk
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel
from core.store.rows import Kind


class AskedPanel(Panel):
    """Draws from what the model says, and only when that has changed."""

    ground = "panel"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.which = self.question = self.text = self.change = self.foot = ""

    def show_dialogue(self, model: OffsetDesk) -> None:
        """The model's words of now."""
        dialogue, number = model.dialogue, model.dialogue.number
        secondary = model.kind is Kind.SECONDARY
        name = "Secondary offset number:" if secondary else "Tool offset number:"
        which = f"{name} {number}" if number else name
        foot = f"{LEAVE}        {CLEAR}" if secondary else LEAVE
        words = (which, dialogue.question, dialogue.text, model.old_to_new, foot)
        if words != (self.which, self.question, self.text, self.change, self.foot):
            self.which, self.question, self.text, self.change, self.foot = words
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        room = self.area().adjusted(1.4 * u, 0.4 * u, -1.4 * u, -0.3 * u)
        painter.setPen(look.colour("text"))
        painter.setFont(look.font(1.9))
        put(painter, QRectF(room.x(), room.y(), 27 * u, 3.2 * u), LEFT, self.which)
        change = QRectF(room.x() + 28 * u, room.y(), room.width() - 28 * u, 3.2 * u)
        painter.setPen(look.colour("accent"))
        painter.setFont(look.fit(self.change, 2.0, change.width(), bold=True))
        put(painter, change, LEFT, self.change)
        self._ask(painter, QRectF(room.x(), room.y() + 3.5 * u, room.width(), 4.8 * u))
        painter.setPen(look.colour("soft"))
        painter.setFont(look.fit(self.foot, 1.8, room.width()))
        put(painter, QRectF(room.x(), room.bottom() - 3.0 * u, room.width(), 3.0 * u), LEFT, self.foot)

    def _ask(self, painter: QPainter, row: QRectF) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("text"))
        painter.setFont(look.font(2.4, bold=True))
        put(painter, QRectF(row.x(), row.y(), 36 * u, row.height()), LEFT, self.question)
        box = row.adjusted(37 * u, 0.2 * u, 0, -0.2 * u)
        painter.setPen(look.pen("accent", 0.2))
        painter.setBrush(look.colour("ground"))
        painter.drawRect(box)
        inside = box.adjusted(u, 0, -u, 0)
        font = look.fit(self.text, 2.8, inside.width() - u, bold=True)
        painter.setFont(font)
        painter.setPen(look.colour("text"))
        put(painter, inside, LEFT, self.text)
        at = inside.x() + min(QFontMetricsF(font).horizontalAdvance(self.text), inside.width() - u) + 0.3 * u
        painter.fillRect(QRectF(at, box.center().y() - 1.5 * u, 0.3 * u, 3.0 * u), look.colour("accent"))
