"""What is known of the marked program: runs, parts, times, proof."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.files.rows import Program
from app.desk.files.shown import details_of
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel

LABEL = 11.0  # units


class RecordPanel(Panel):
    """Two columns: what, and its figure."""

    title = "RECORD"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._shown: tuple[Program | None, str] = (None, "")

    def show_program(self, program: Program | None, trouble: str) -> None:
        """Another program, or what is wrong with its picture."""
        if (program, trouble) != self._shown:
            self._shown = (program, trouble)
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        program, trouble = self._shown
        rows = list(details_of(program)) if program is not None else []
        if trouble:
            rows.append(("PREVIEW", trouble))
        room = self.inside()
        high = min(3.0 * u, room.height() / max(1, len(rows)))
        for number, (label, text) in enumerate(rows):
            y = room.y() + number * high
            painter.setPen(look.colour("soft"))
            painter.setFont(look.fit(label, 1.6, (LABEL - 0.6) * u, bold=True))
            put(painter, QRectF(room.x(), y, (LABEL - 0.6) * u, high), LEFT, label)
            value = QRectF(room.x() + LABEL * u, y, room.width() - LABEL * u, high)
            painter.setPen(look.colour("text"))
            painter.setFont(look.fit(text, 1.9, value.width(), bold=True))
            put(painter, value, LEFT, text)
