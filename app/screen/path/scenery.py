"""What stands still in a pane: centre lines, the circle of the part with C round it, lines along the side."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen

from app.desk import formats
from app.desk.drawing.trail import Trail
from app.screen.look import CENTRE, LEFT, Look, put
from app.screen.path.aspects import Aspect
from app.screen.path.plot import Frame

QUARTERS = (0, 90, 180, 270)
TIGHT = 9.0  # units: C lines of the side stand no nearer to each other


def draw_scenery(painter: QPainter, look: Look, aspect: Aspect, frame: Frame, trail: Trail) -> None:
    """Under everything that moves; the painter's origin is the corner of the pane."""
    if aspect is Aspect.PATH:
        _cross(painter, look, frame)
    elif aspect is Aspect.FACE:
        _cross(painter, look, frame)
        _ring(painter, look, frame, trail)
    else:
        _degrees(painter, look, frame, trail)


def _pen(look: Look, dashes: list[float]) -> QPen:
    pen = look.pen("centre", 0.12)
    pen.setDashPattern(dashes)
    return pen


def _cross(painter: QPainter, look: Look, frame: Frame) -> None:
    painter.setPen(_pen(look, [14, 4, 2, 4]))
    row = round(float(frame.down(0.0))) + 0.5
    painter.drawLine(QPointF(0, row), QPointF(frame.width, row))
    column = round(float(frame.across(0.0))) + 0.5
    painter.setPen(_pen(look, [2, 6]))
    painter.drawLine(QPointF(column, 0), QPointF(column, frame.height))


def _ring(painter: QPainter, look: Look, frame: Frame, trail: Trail) -> None:
    """The circle that holds all cuts, and where on it the tool is at C 0, 90, 180 and 270."""
    u = look.u
    reach = trail.bounds[1]
    middle = QPointF(float(frame.across(0.0)), float(frame.down(0.0)))
    radius = reach * frame.scale + 0.9 * u
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(_pen(look, [3, 4]))
    painter.drawEllipse(middle, radius, radius)
    painter.setFont(look.font(1.5))
    painter.setPen(look.colour("soft"))
    for degrees in QUARTERS:
        at = math.radians(degrees)
        place = middle + QPointF(math.cos(at), math.sin(at)) * (radius + 1.7 * u)
        put(painter, QRectF(place.x() - 3 * u, place.y() - u, 6 * u, 2 * u), CENTRE, f"C{degrees}")


def _degrees(painter: QPainter, look: Look, frame: Frame, trail: Trail) -> None:
    """Lines along Z at even angles, with their C; whole turns are as strong as a centre line."""
    u, scale = look.u, trail.round
    step = next((s for s in (15, 30, 45, 90, 180, 360) if s * scale * frame.scale >= TIGHT * u), 360)
    top, bottom = (frame.x - frame.height / 2 / frame.scale, frame.x + frame.height / 2 / frame.scale)
    painter.setFont(look.font(1.5))
    for number in range(math.ceil(-bottom / scale / step), math.floor(-top / scale / step) + 1):
        degrees = number * step
        row = round(float(frame.down(-degrees * scale))) + 0.5
        painter.setPen(_pen(look, [14, 4, 2, 4] if degrees % 360 == 0 else [2, 6]))
        painter.drawLine(QPointF(0, row), QPointF(frame.width, row))
        painter.setPen(look.colour("soft"))
        text = f"C{formats.fixed(degrees, 0)}"
        put(painter, QRectF(0.8 * u, row - 2.0 * u, 8 * u, 2 * u), LEFT, text)
    column = round(float(frame.across(0.0))) + 0.5
    painter.setPen(_pen(look, [2, 6]))
    painter.drawLine(QPointF(column, 0), QPointF(column, frame.height))
