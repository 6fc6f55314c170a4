"""A tool's tip as seen from above: the nose circle, and where the tip that is set lies on it."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainterPath

from app.screen.look import Painter
from core.tool_edges import TIP_DIRECTIONS

_SPREAD = 0.7  # radians from the tool's axis to its flanks


def draw_tip(painter: Painter, box: QRectF, quadrant: int, colour: str = "text") -> None:
    """The tip in a square: body away from the tip, nose circle, and a dot where X and Z are set."""
    side = min(box.width(), box.height())
    centre, radius = box.center(), 0.16 * side
    z, x = TIP_DIRECTIONS[quadrant]  # X+ is down on the screen
    middle = centre + QPointF(0.22 * side * z, 0.22 * side * x)
    painter.save()
    painter.setClipRect(box)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.look.colour("ghost"))
    if (z, x) != (0, 0):
        painter.drawPath(_body(middle, math.atan2(-x, -z), radius, side))
    painter.setPen(painter.look.pen(colour, 0.16))
    painter.drawEllipse(middle, radius, radius)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.look.colour("tip"))
    dot = max(1.5, 0.06 * side)
    painter.drawEllipse(middle + QPointF(radius * z, radius * x), dot, dot)
    painter.restore()


def _body(nose: QPointF, away: float, radius: float, side: float) -> QPainterPath:
    """Two flanks that touch the nose circle and run out of the picture."""
    path = QPainterPath(_on(nose, away + math.pi / 2 + _SPREAD, radius))
    path.lineTo(_on(_on(nose, away + math.pi / 2 + _SPREAD, radius), away + _SPREAD, 2 * side))
    path.lineTo(_on(_on(nose, away - math.pi / 2 - _SPREAD, radius), away - _SPREAD, 2 * side))
    path.lineTo(_on(nose, away - math.pi / 2 - _SPREAD, radius))
    path.closeSubpath()
    return path


def _on(at: QPointF, angle: float, far: float) -> QPointF:
    return at + QPointF(far * math.cos(angle), far * math.sin(angle))
