"""What is drawn on the targets of the Jog page: the arrow of a direction, and the middle of the cross."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPolygonF

from app.screen.look import CENTRE, Look, put


def draw_arrow(painter: QPainter, look: Look, box: QRectF, to: tuple[int, int], colour: str) -> None:
    """At the side of its target to which it points."""
    size = 0.16 * min(box.width(), box.height())
    centre = box.center() + QPointF(to[0] * 0.30 * box.width(), to[1] * 0.28 * box.height())
    forward, side = QPointF(to[0] * size, to[1] * size), QPointF(to[1] * size, to[0] * size)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour(colour))
    painter.drawPolygon(QPolygonF([centre + forward, centre - forward + side, centre - forward - side]))


def draw_middle(painter: QPainter, look: Look, box: QRectF, words: tuple[str, str, str]) -> None:
    """What an arrow does now: its kind, the figure, the unit."""
    kind, figure, unit = words
    high, edge = 2.2 * look.u, 0.1 * box.height()
    painter.setPen(look.colour("soft"))
    painter.setFont(look.font(1.6, bold=True))
    put(painter, QRectF(box.x(), box.y() + edge, box.width(), high), CENTRE, kind)
    put(painter, QRectF(box.x(), box.bottom() - edge - high, box.width(), high), CENTRE, unit)
    painter.setPen(look.colour("text"))
    painter.setFont(look.fit(figure, 3.2, box.width() - look.u, bold=True))
    put(painter, box, CENTRE, figure)
