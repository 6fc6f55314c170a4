"""The way back into a program, drawn over the path: legs in their order, rapids dashed, feeds solid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPolygonF

from app.desk.drawing.approach import Leg
from app.screen.look import CENTRE, Look, put
from app.screen.path.pane import Pane


def draw_approach(painter: QPainter, look: Look, pane: Pane, legs: Sequence[Leg]) -> None:
    """All legs from where the tool stands now; the painter's origin is the corner of the pane."""
    u = look.u
    spots = [pane.spot(leg.z, leg.x) for leg in legs]
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for leg, (start, end) in zip(legs[1:], pairwise(spots), strict=True):
        pen = look.pen("lit", 0.34)
        pen.setStyle(Qt.PenStyle.DashLine if leg.rapid else Qt.PenStyle.SolidLine)
        painter.setPen(pen)
        painter.drawLine(start, end)
        _arrow(painter, look, start, end)
    painter.setPen(look.pen("lit", 0.34))
    painter.setBrush(look.colour("panel"))
    for spot in spots[:1]:
        painter.drawEllipse(spot, 0.8 * u, 0.8 * u)
    for leg, (start, end) in zip(legs[1:], pairwise(spots), strict=True):
        _label(painter, look, (start + end) / 2, leg.label)


def _arrow(painter: QPainter, look: Look, start: QPointF, end: QPointF) -> None:
    """A head at the end of a leg that is long enough to have one."""
    way, u = end - start, look.u
    length = math.hypot(way.x(), way.y())
    if length < 2.5 * u:
        return
    along = way / length
    across = QPointF(-along.y(), along.x())
    back = end - along * 1.6 * u
    painter.save()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("lit"))
    painter.drawPolygon(QPolygonF([end, back + across * 0.7 * u, back - across * 0.7 * u]))
    painter.restore()


def _label(painter: QPainter, look: Look, at: QPointF, text: str) -> None:
    if not text:
        return
    u = look.u
    painter.setFont(look.font(1.6, bold=True))
    wide = QFontMetricsF(painter.font()).horizontalAdvance(text) + 1.2 * u
    box = QRectF(at.x() - wide / 2, at.y() - 1.2 * u, wide, 2.4 * u)
    painter.fillRect(box, look.colour("lit"))
    painter.setPen(look.colour("on_lit"))
    put(painter, box, CENTRE, text)
