"""The common ground of the parts of the page: a frame, its title in the top line, places to press."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.look import LEFT, Look, put

Press = Callable[[], None]


class Panel(QWidget):
    """Draws itself from what it was last shown, and only when that has changed. Never takes the keyboard."""

    title = ""
    ground = "ground"

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.look = look
        self._places: list[tuple[QRectF, Press]] = []
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Qt's call to draw. The painter ends whatever happens: one left open takes the process with it."""
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.fillRect(self.rect(), self.look.colour(self.ground))
            self._places.clear()
            if self.title:
                self.frame(painter, self.title)
            self.draw(painter)

    def draw(self, painter: QPainter) -> None:
        """What a part of the page draws inside its frame."""

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A finger or the mouse acts when it goes down, as a key does."""
        self.touch(event.position())

    def touch(self, at: QPointF) -> bool:
        """Press whatever stands there; False when nothing does."""
        for rect, press in self._places:
            if rect.contains(at):
                press()
                return True
        return False

    def place(self, rect: QRectF, press: Press) -> None:
        """While drawing: remember that pressing inside ``rect`` does this."""
        self._places.append((rect, press))

    def area(self) -> QRectF:
        """The whole widget."""
        return QRectF(self.rect())

    def inside(self) -> QRectF:
        """The room inside a frame with a title, pixels."""
        u = self.look.u
        return self.area().adjusted(1.2 * u, 2.6 * u, -1.2 * u, -0.9 * u)

    def frame(self, painter: QPainter, title: str, colour: str = "frame", width: float = 0.16) -> None:
        """A box with its title set into the top line, as text screens drew them."""
        look, u, title = self.look, self.look.u, tr(title)
        top = 1.0 * u
        pen = look.pen(colour, width)
        half = pen.widthF() / 2
        box = self.area().adjusted(half, top, -half, -half)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("panel"))
        painter.drawRect(box)
        painter.setPen(QPen(pen))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        font = look.fit(title, 1.7, self.width() - 4 * u, bold=True)
        painter.setFont(font)
        wide = QFontMetricsF(font).horizontalAdvance(title)
        patch = QRectF(1.6 * u, 0.0, wide + 1.2 * u, 2.0 * u)
        painter.fillRect(
            QRectF(patch.x(), top - half - 1, patch.width(), 2 * half + 2), look.colour("ground")
        )
        painter.fillRect(QRectF(patch.x(), top, patch.width(), 1.0 * u), look.colour("panel"))
        painter.setPen(look.colour("soft"))
        put(painter, patch.adjusted(0.6 * u, 0, 0, 0), LEFT, title)
