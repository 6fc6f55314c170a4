"""Drawings of tool outlines and tips, and of sketches whose dimensions are input fields."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainterPath, QPen, QPolygonF, QTransform
from PySide6.QtWidgets import QWidget

from app.screen.look import CENTRE, Look, Painter
from app.screen.panel import Panel, Shown
from app.screen.window_layout import FINGER
from core.part.tool_outline import ToolOutline
from core.part.tool_polygons import FloatArray
from core.sketch import Dim, Outline, Sketch
from core.tool_edges import TIP_DIRECTIONS

_INKS = {
    "part": ("frame", 0.16),
    "cut": ("accent", 0.36),
    "tool": ("tip", 0.16),
    "axis": ("centre", 0.12),
    "far": ("soft", 0.16),
    "left": ("alarm", 0.5),
}
_GROUNDS = {"part": "key", "tool": "here"}
_FIGURE = 1.9  # Units: height of a number.
_ARROW = 0.7
_ACROSS = (0.12, 0.32)  # Positions on the line of a diameter, from below, so that two numbers do not overlap.
_ROOM = 5.0  # Units around the drawing, for dimensions.


class SketchPanel(Panel):
    """Panel that draws a sketch with its dimensions.

    ``shown`` contains the sketch, the values by dimension word, the word of the selected field, and the words
    of fields with errors.
    """

    title = "DRAWING"
    shown: Shown[tuple[Sketch, tuple[tuple[str, str], ...], str, frozenset[str]]] = Shown(
        (Sketch(), (), "", frozenset())
    )

    def __init__(
        self,
        look: Look,
        touch: Callable[[str], None],
        beside: Callable[[tuple[float, float]], None],
        parent: QWidget,
    ) -> None:
        """Create the panel. ``touch`` gets the word of a touched dimension.

        ``beside`` gets the point of any other touch, in coordinates of the sketch.
        """
        super().__init__(look, parent)
        self._touch, self._beside = touch, beside
        self._scale, self._middle, self._centre = 1.0, (0.0, 0.0), QPointF()

    def draw(self, painter: Painter) -> None:
        drawn, figures, here, wrong = self.shown
        if not drawn.outlines:
            return
        self._fit(drawn)
        for each in drawn.outlines:
            self._outline(painter, each)
        said = dict(figures)
        for number, dim in enumerate(sorted(drawn.dims, key=lambda dim: dim.word == here)):
            if said.get(dim.word, ""):
                ink = "alarm" if dim.word in wrong else "lit" if dim.word == here else "text"
                share = _ACROSS[number % len(_ACROSS)] if _is_diameter(dim) else 0.5
                self._dimension(painter, dim, said[dim.word], ink, share, marked=dim.word == here)

    def _fit(self, drawn: Sketch) -> None:
        """Center the drawing in the panel at the largest possible scale."""
        points = [p for each in drawn.outlines for p in each.points]
        points += [(dim.a[0], dim.a[1] + dim.away) for dim in drawn.dims]
        low = min(p[0] for p in points), min(p[1] for p in points)
        high = max(p[0] for p in points), max(p[1] for p in points)
        room = self.inside().adjusted(*(k * _ROOM * self.look.u for k in (0.8, 0.4, -0.8, -0.4)))
        wide, tall = max(high[0] - low[0], 1e-6), max(high[1] - low[1], 1e-6)
        self._scale = max(1e-6, min(room.width() / wide, room.height() / tall))
        self._middle = (low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0
        self._centre = room.center()

    def _at(self, point: tuple[float, float]) -> QPointF:
        x = self._centre.x() + (point[0] - self._middle[0]) * self._scale
        return QPointF(x, self._centre.y() - (point[1] - self._middle[1]) * self._scale)

    def touch(self, at: QPointF) -> bool:
        """Handle a touch on a dimension or on any other point of the sketch."""
        if not super().touch(at):
            away = at - self._centre
            self._beside((self._middle[0] + away.x() / self._scale, self._middle[1] - away.y() / self._scale))
        return True

    def _outline(self, painter: Painter, each: Outline) -> None:
        ink, width = _INKS[each.ink]
        pen = self.look.pen(ink, width)
        if each.ink == "axis":
            pen.setStyle(Qt.PenStyle.DashDotLine)
        painter.setPen(pen)
        shape = QPolygonF([self._at(p) for p in each.points])
        ground = _GROUNDS.get(each.ink)
        if each.closed:
            painter.setBrush(self.look.colour(ground) if ground else Qt.BrushStyle.NoBrush)
            painter.drawPolygon(shape)
        else:
            painter.drawPolyline(shape)

    def _dimension(
        self, painter: Painter, dim: Dim, figure: str, ink: str, share: float, *, marked: bool
    ) -> None:
        middle = self._at(dim.a)
        if dim.b is not None:
            a, b = self._at(dim.a), self._at(dim.b)
            lift = QPointF(0.0, -dim.away * self._scale)
            painter.setPen(QPen(self.look.colour(ink), 1.0))
            if dim.away:
                painter.drawLine(a, a + lift)
                painter.drawLine(b, b + lift)
            line = QLineF(a + lift, b + lift)
            painter.drawLine(line)
            self._arrow(painter, line)
            self._arrow(painter, QLineF(line.p2(), line.p1()))
            middle = line.pointAt(share)
        self._figure(painter, middle, dim.before + figure, ink, dim.word, marked=marked)

    def _arrow(self, painter: Painter, line: QLineF) -> None:
        """Draw an arrowhead at the first point of a line."""
        if line.length() < 1e-6:
            return
        for turn in (20.0, -20.0):
            side = QLineF(line)
            side.setLength(_ARROW * self.look.u)
            side.setAngle(line.angle() + turn)
            painter.drawLine(side)

    def _figure(
        self, painter: Painter, at: QPointF, figure: str, ink: str, word: str, *, marked: bool
    ) -> None:
        u = self.look.u
        metrics = QFontMetricsF(self.look.font(_FIGURE, bold=True))
        wide, tall = metrics.horizontalAdvance(figure) + 1.2 * u, 2.6 * u
        box = QRectF(at.x() - wide / 2.0, at.y() - tall / 2.0, wide, tall)
        box.moveLeft(max(1.0, min(box.x(), self.width() - wide - 1.0)))
        box.moveTop(max(1.0, min(box.y(), self.height() - tall - 1.0)))
        painter.fill(box, "lit" if marked else "panel")
        painter.write(box, figure, _FIGURE, "on_lit" if marked else ink, at=CENTRE, raw=True, fit=False)
        self.place(self._finger_about(box), partial(self._touch, word))

    def _finger_about(self, box: QRectF) -> QRectF:
        """Return a rectangle around a number that is large enough for a touch and inside the panel."""
        least = max(5.0 * self.look.u, FINGER)
        side, up = (max(0.0, least - have) / 2.0 for have in (box.width(), box.height()))
        place = box.adjusted(-side, -up, side, up)
        place.moveLeft(max(0.0, min(place.x(), self.width() - place.width())))
        place.moveTop(max(0.0, min(place.y(), self.height() - place.height())))
        return place


def _is_diameter(dim: Dim) -> bool:
    """Return whether the dimension line crosses the axis at a right angle."""
    return dim.b is not None and dim.a[1] < 0.0 < dim.b[1] and dim.a[0] == dim.b[0]


_AROUND = 1.9  # Size of the drawing relative to the cutting edges, for a tool with an insert.


def draw_outline(painter: Painter, box: QRectF, outline: ToolOutline, *, small: bool = False) -> None:
    """Draw the body, cutting edges and control point of a tool. Z points right and X points down.

    ``small`` omits the arrows of the axes and draws a smaller cross.
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
    """Return the transform from (z, x) in mm to the box.

    Axial tools are shown completely, other tools only around their cutting edges.
    """
    cutting = _polygon(outline.cutting[0]).boundingRect()
    for points in outline.cutting[1:]:
        cutting = cutting.united(_polygon(points).boundingRect())
    share = 1.15 if outline.axial else _AROUND
    if outline.axial and outline.body:
        cutting = cutting.united(_polygon(outline.body[0]).boundingRect())
    scale = min(box.width() / cutting.width(), box.height() / cutting.height()) / share
    # Shift the center of the drawing toward the body.
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
    """Draw the arrows Z+ to the right and X+ down, in the upper left corner."""
    u = painter.look.u
    at, long = QPointF(box.x() + 1.2 * u, box.y() + 1.2 * u), 3.0 * u
    painter.setPen(painter.look.pen("soft", 0.14))
    painter.drawLine(at, at + QPointF(long, 0))
    painter.drawLine(at, at + QPointF(0, long))
    painter.write(QRectF(at.x() + long + 0.3 * u, at.y() - u, 3 * u, 2 * u), "Z+", 1.4, "soft", raw=True)
    painter.write(QRectF(at.x() - 0.6 * u, at.y() + long, 3 * u, 2 * u), "X+", 1.4, "soft", raw=True)


_SPREAD = 0.7  # Radians from the tool's axis to its flanks.


def draw_tip(painter: Painter, box: QRectF, quadrant: int, colour: str = "text") -> None:
    """Draw a tool tip: the body, the nose circle, and a dot at the point where X and Z are set."""
    side = min(box.width(), box.height())
    centre, radius = box.center(), 0.16 * side
    z, x = TIP_DIRECTIONS[quadrant]  # X+ points down on the screen.
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
    """Return two flanks that touch the nose circle and extend out of the drawing."""
    path = QPainterPath(_on(nose, away + math.pi / 2 + _SPREAD, radius))
    path.lineTo(_on(_on(nose, away + math.pi / 2 + _SPREAD, radius), away + _SPREAD, 2 * side))
    path.lineTo(_on(_on(nose, away - math.pi / 2 - _SPREAD, radius), away - _SPREAD, 2 * side))
    path.lineTo(_on(nose, away - math.pi / 2 - _SPREAD, radius))
    path.closeSubpath()
    return path


def _on(at: QPointF, angle: float, far: float) -> QPointF:
    return at + QPointF(far * math.cos(angle), far * math.sin(angle))
