"""Small drawn signs: fonts of a bare system lack them, and a shape says what a colour alone may not."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPen, QPolygonF

from app.desk.view import Tone


def draw_sign(painter: QPainter, box: QRectF, tone: Tone, colour: QColor) -> None:
    """The sign of a state: triangle runs, bars pause, dots wait, barred triangle alarms, square is ready."""
    side = min(box.width(), box.height())
    square = QRectF(box.center().x() - side / 2, box.center().y() - side / 2, side, side)
    painter.save()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QBrush(colour))
    _SIGNS[tone](painter, square, colour)
    painter.restore()


def _run(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    painter.drawPolygon(QPolygonF([box.topLeft(), QPointF(box.right(), box.center().y()), box.bottomLeft()]))


def _pause(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    bar = box.width() * 0.36
    painter.drawRect(QRectF(box.left(), box.top(), bar, box.height()))
    painter.drawRect(QRectF(box.right() - bar, box.top(), bar, box.height()))


def _wait(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    size = box.width() * 0.24
    for k in range(3):
        x = box.left() + k * (box.width() - size) / 2
        painter.drawEllipse(QRectF(x, box.center().y() - size / 2, size, size))


def _alarm(painter: QPainter, box: QRectF, colour: QColor) -> None:
    painter.setBrush(Qt.BrushStyle.NoBrush)
    pen = QPen(colour, box.width() * 0.12)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.setPen(pen)
    inner = box.adjusted(box.width() * 0.06, box.width() * 0.06, -box.width() * 0.06, -box.width() * 0.06)
    painter.drawPolygon(
        QPolygonF([QPointF(inner.center().x(), inner.top()), inner.bottomRight(), inner.bottomLeft()])
    )
    x = box.center().x()
    painter.drawLine(QPointF(x, box.top() + box.height() * 0.40), QPointF(x, box.top() + box.height() * 0.62))
    painter.drawPoint(QPointF(x, box.top() + box.height() * 0.79))


def _ready(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    inset = box.width() * 0.12
    painter.drawRect(box.adjusted(inset, inset, -inset, -inset))


def _off(painter: QPainter, box: QRectF, colour: QColor) -> None:
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(colour, box.width() * 0.14))
    inset = box.width() * 0.12
    painter.drawEllipse(box.adjusted(inset, inset, -inset, -inset))


_SIGNS = {
    Tone.RUN: _run,
    Tone.PAUSE: _pause,
    Tone.WAIT: _wait,
    Tone.ALARM: _alarm,
    Tone.READY: _ready,
    Tone.OFF: _off,
}
