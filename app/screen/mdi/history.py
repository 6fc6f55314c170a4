"""The lines typed before, newest at the bottom as they were typed; a finger takes one up again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.look import LEFT, Look, put, put_raw
from app.screen.panel import Panel

ROW = 3.4  # units


class HistoryPanel(Panel):
    """``back`` is how far up the line stands that was taken up, 0: none."""

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose
        self.lines: tuple[str, ...] = ()
        self.back = 0

    def show_history(self, lines: Sequence[str], back: int) -> None:
        """All of them, oldest first."""
        shown = (tuple(lines), back)
        if shown != (self.lines, self.back):
            self.lines, self.back = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        self.frame(painter, tr("HISTORY  ·  ARROW UP AND DOWN"))
        look, u, room = self.look, self.look.u, self.inside()
        rows = max(1, int(room.height() / (ROW * u)))
        bottom = max(rows, len(self.lines) - max(0, self.back - rows))
        for place, number in enumerate(range(max(0, bottom - rows), min(bottom, len(self.lines)))):
            back = len(self.lines) - number
            row = QRectF(room.x(), room.y() + place * ROW * u, room.width(), ROW * u)
            if back == self.back:
                painter.fillRect(row, look.colour("here"))
            painter.setFont(look.font(2.2, bold=back == self.back))
            painter.setPen(look.colour("text"))
            put_raw(painter, row.adjusted(0.8 * u, 0, -0.8 * u, 0), LEFT, self.lines[number])
            self.place(row, partial(self._choose, back))
        if not self.lines:
            painter.setFont(look.font(2.0))
            painter.setPen(look.colour("soft"))
            empty = QRectF(room.x(), room.y(), room.width(), 3 * u)
            put(painter, empty, LEFT, tr("No line was run yet."))
