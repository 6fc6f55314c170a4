"""A tool's outline with insert, holder and control point, as tool shapes and setup sheet show it."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF, QTransform

from app.screen.look import Painter
from core.part.tool_outline import ToolOutline
from core.part.tool_polygons import FloatArray

_AROUND = 1.9  # how much more than the cutting edges the picture shows of a tool with an insert


def draw_outline(painter: Painter, box: QRectF, outline: ToolOutline, *, small: bool = False) -> None:
    """Body and cutting edges of a tool, and the control point; Z to the right, X downwards.

    ``small``: without the arrows of the axes, and a smaller cross.
    """
    look, u = painter.look, painter.look.u
    place = _placing(box, outline)
    painter.save()
    painter.setClipRect(box)
    for polygons, ink, ground in ((outline.body, "frame", "ghost"), (outline.cutting, "accent", "key")):
        for points in polygons:
            painter.setPen(look.pen(ink, 0.16))
            painter.setBrush(look.colour(ground))
            painter.drawPolygon(place.map(_polygon(points)))
    at = place.map(QPointF(0.0, 0.0))
    painter.setPen(look.pen("tip", 0.2))
    arm, circle = (0.7 * u, 0.3 * u) if small else (1.6 * u, 0.6 * u)
    painter.drawLine(at - QPointF(arm, 0), at + QPointF(arm, 0))
    painter.drawLine(at - QPointF(0, arm), at + QPointF(0, arm))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(at, circle, circle)
    painter.restore()
    if not small:
        _axes(painter, box)


def _placing(box: QRectF, outline: ToolOutline) -> QTransform:
    """From (z, x) in mm to the box: round tools whole, of others the edges and what lies around them."""
    cutting = _polygon(outline.cutting[0]).boundingRect()
    for points in outline.cutting[1:]:
        cutting = cutting.united(_polygon(points).boundingRect())
    share = 1.15 if outline.axial else _AROUND
    if outline.axial and outline.body:
        cutting = cutting.united(_polygon(outline.body[0]).boundingRect())
    scale = min(box.width() / cutting.width(), box.height() / cutting.height()) / share
    # Where the body lies beside the edges, the picture looks that way.
    middle = cutting.center()
    if outline.body and not outline.axial:
        whole = _polygon(outline.body[0]).boundingRect().center() - middle
        reach = max(abs(whole.x()), abs(whole.y()), 1e-9)
        middle += whole * (0.3 * min(cutting.width(), cutting.height()) / reach)
    return QTransform(
        scale, 0, 0, scale, box.center().x() - scale * middle.x(), box.center().y() - scale * middle.y()
    )


def _polygon(points: FloatArray) -> QPolygonF:
    return QPolygonF([QPointF(z, x) for z, x in points.tolist()])


def _axes(painter: Painter, box: QRectF) -> None:
    """Z+ to the right and X+ downwards, in the corner that is the chuck's."""
    u = painter.look.u
    at, long = QPointF(box.x() + 1.2 * u, box.y() + 1.2 * u), 3.0 * u
    painter.setPen(painter.look.pen("soft", 0.14))
    painter.drawLine(at, at + QPointF(long, 0))
    painter.drawLine(at, at + QPointF(0, long))
    painter.write(QRectF(at.x() + long + 0.3 * u, at.y() - u, 3 * u, 2 * u), "Z+", 1.4, "soft", raw=True)
    painter.write(QRectF(at.x() - 0.6 * u, at.y() + long, 3 * u, 2 * u), "X+", 1.4, "soft", raw=True)
