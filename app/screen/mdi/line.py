"""The line that is typed: large, with its cursor, and under it what is wrong, marked where it is."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QFontMetricsF, QPainter, QPolygonF
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.look import LEFT, Look, put, put_raw
from app.screen.panel import Panel, Press
from core.language.diagnostics import Diagnostic, Severity

Shown = tuple[str, int, tuple[Diagnostic, ...], bool]


class LinePanel(Panel):
    """Draws from what it was shown last, and only when that has changed. A finger on it asks for letters."""

    def __init__(self, look: Look, touched: Press, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._touched = touched
        self.text, self.at, self.ready = "", 0, False
        self.found: tuple[Diagnostic, ...] = ()
        self._shown: Shown | None = None

    def show_line(self, text: str, at: int, found: tuple[Diagnostic, ...], ready: bool) -> None:
        """The text, its cursor, the findings of its proof, and whether it would start now."""
        shown = (text, at, found, ready)
        if shown != self._shown:
            self._shown = shown
            self.text, self.at, self.found, self.ready = shown
            self.update()

    @property
    def message(self) -> str:
        """The first finding: an error before a warning."""
        return f"{self._first.message} {self._first.hint}".strip() if self._first else ""

    @property
    def _first(self) -> Diagnostic | None:
        errors = (each for each in self.found if each.severity is Severity.ERROR)
        return next(errors, self.found[0] if self.found else None)

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        title = tr("LINE  ·  READY, CYCLE START RUNS IT") if self.ready else tr("LINE")
        self.frame(painter, title, "lit" if self.ready else "frame", 0.3 if self.ready else 0.16)
        room = self.inside()
        self.place(self.area(), self._touched)
        font = look.fit(self.text, 4.4, room.width() - 2 * u, bold=True)
        metrics = QFontMetricsF(font)
        row = QRectF(room.x(), room.y(), room.width(), 5.6 * u)
        painter.setFont(font)
        painter.setPen(look.colour("text"))
        put_raw(painter, row, LEFT, self.text)
        at = row.x() + metrics.horizontalAdvance(self.text[: self.at])
        painter.fillRect(QRectF(at, row.center().y() - 2.2 * u, 0.35 * u, 4.4 * u), look.colour("accent"))
        if self._first is not None:
            self._finding(painter, room, metrics, self._first)

    def _finding(self, painter: QPainter, room: QRectF, metrics: QFontMetricsF, found: Diagnostic) -> None:
        look, u = self.look, self.look.u
        bad = found.severity is Severity.ERROR
        colour = look.colour("alarm" if bad else "accent")
        if found.column > 0:
            at = room.x() + metrics.horizontalAdvance(self.text[: found.column - 1]) + 0.9 * u
            top = room.y() + 5.4 * u
            tip = QPolygonF(
                [QPointF(at, top), QPointF(at - u, top + 1.6 * u), QPointF(at + u, top + 1.6 * u)]
            )
            painter.setPen(colour)
            painter.setBrush(colour)
            painter.drawPolygon(tip)
        painter.setPen(colour)
        lines = (found.message, found.hint)
        for number, (text, size) in enumerate(zip(lines, (2.3, 1.9), strict=True)):
            painter.setFont(look.fit(text, size, room.width(), bold=number == 0))
            box = QRectF(room.x(), room.y() + (7.2 + 2.9 * number) * u, room.width(), 2.9 * u)
            put(painter, box, LEFT, text)
            painter.setPen(look.colour("soft"))
