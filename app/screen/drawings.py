"""Drawings of tool outlines and tool tips, and of sketches with dimensions for input."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainterPath, QPen, QPolygonF, QTransform
from PySide6.QtWidgets import QWidget

from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from core.part.tool_outline import ToolOutline
from core.part.tool_polygons import FloatArray
from core.sketch import Dimension, Outline, Sketch
from core.tool_edges import TIP_DIRECTIONS

_LINE_COLORS = {
    "part": ("frame", 0.16),
    "cut": ("accent", 0.36),
    "tool": ("tip", 0.16),
    "axis": ("centre", 0.12),
    "far": ("soft", 0.16),
    "left": ("alarm", 0.5),
}
_FILL_COLORS = {"part": "key", "tool": "here"}
_NUMBER_HEIGHT = 1.9  # Units: height of a number.
_ARROW_SIZE = 0.7
_NUMBER_POSITIONS = (
    0.12,
    0.32,
)  # Positions on the line of a diameter, from below, so that two numbers do not overlap.
_DRAWING_MARGIN = 5.0  # Units around the drawing, for dimensions.


class SketchPanel(Panel):
    """Panel that draws a sketch with its dimensions.

    ``displayed_sketch`` contains the sketch, the (word, value) pairs of its dimensions, the word of the
    selected field, and the words of fields with errors.
    """

    title = "DRAWING"
    displayed_sketch: RedrawingAttribute[tuple[Sketch, tuple[tuple[str, str], ...], str, frozenset[str]]] = (
        RedrawingAttribute((Sketch(), (), "", frozenset()))
    )

    def __init__(
        self,
        theme: ScreenTheme,
        on_dimension_touch: Callable[[str], None],
        on_other_touch: Callable[[tuple[float, float]], None],
        parent: QWidget,
    ) -> None:
        """Create the panel.

        ``on_dimension_touch`` is called with the word of a touched dimension. ``on_other_touch`` is
        called with the point of any other touch, in coordinates of the sketch.
        """
        super().__init__(theme, parent)
        self._touch, self._beside = on_dimension_touch, on_other_touch
        self._scale, self._middle, self._centre = 1.0, (0.0, 0.0), QPointF()

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the outlines of the sketch and the dimensions that have a value.

        The dimension of the selected field is highlighted, and dimensions with errors have the alarm color.
        """
        drawn, labels, here, wrong = self.displayed_sketch
        if not drawn.outlines:
            return
        self._fit_sketch(drawn)
        for each in drawn.outlines:
            self._outline(painter, each)
        said = dict(labels)
        for number, dim in enumerate(sorted(drawn.dimensions, key=lambda dim: dim.field_label == here)):
            if said.get(dim.field_label, ""):
                ink = "alarm" if dim.field_label in wrong else "lit" if dim.field_label == here else "text"
                share = _NUMBER_POSITIONS[number % len(_NUMBER_POSITIONS)] if _is_diameter(dim) else 0.5
                self._dimension(
                    painter, dim, said[dim.field_label], ink, share, marked=dim.field_label == here
                )

    def _fit_sketch(self, drawn: Sketch) -> None:
        """Center the drawing in the panel at the largest possible scale."""
        points = [p for each in drawn.outlines for p in each.points]
        points += [(dim.start[0], dim.start[1] + dim.line_distance) for dim in drawn.dimensions]
        low = min(p[0] for p in points), min(p[1] for p in points)
        high = max(p[0] for p in points), max(p[1] for p in points)
        room = self.inside().adjusted(
            *(k * _DRAWING_MARGIN * self.theme.unit_px for k in (0.8, 0.4, -0.8, -0.4))
        )
        wide, tall = max(high[0] - low[0], 1e-6), max(high[1] - low[1], 1e-6)
        self._scale = max(1e-6, min(room.width() / wide, room.height() / tall))
        self._middle = (low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0
        self._centre = room.center()

    def _at(self, point: tuple[float, float]) -> QPointF:
        x = self._centre.x() + (point[0] - self._middle[0]) * self._scale
        return QPointF(x, self._centre.y() - (point[1] - self._middle[1]) * self._scale)

    def press_target_at(self, position: QPointF) -> bool:
        """Handle a touch on a dimension or on any other point of the sketch."""
        if not super().press_target_at(position):
            away = position - self._centre
            self._beside((self._middle[0] + away.x() / self._scale, self._middle[1] - away.y() / self._scale))
        return True

    def _outline(self, painter: ThemedPainter, each: Outline) -> None:
        ink, width = _LINE_COLORS[each.role]
        pen = self.theme.make_pen(ink, width)
        if each.role == "axis":
            pen.setStyle(Qt.PenStyle.DashDotLine)
        painter.setPen(pen)
        shape = QPolygonF([self._at(p) for p in each.points])
        ground = _FILL_COLORS.get(each.role)
        if each.is_closed:
            painter.setBrush(self.theme.get_color(ground) if ground else Qt.BrushStyle.NoBrush)
            painter.drawPolygon(shape)
        else:
            painter.drawPolyline(shape)

    def _dimension(
        self, painter: ThemedPainter, dim: Dimension, figure: str, ink: str, share: float, *, marked: bool
    ) -> None:
        middle = self._at(dim.start)
        if dim.end is not None:
            a, b = self._at(dim.start), self._at(dim.end)
            lift = QPointF(0.0, -dim.line_distance * self._scale)
            painter.setPen(QPen(self.theme.get_color(ink), 1.0))
            if dim.line_distance:
                painter.drawLine(a, a + lift)
                painter.drawLine(b, b + lift)
            line = QLineF(a + lift, b + lift)
            painter.drawLine(line)
            draw_arrowhead(painter, line)
            draw_arrowhead(painter, QLineF(line.p2(), line.p1()))
            middle = line.pointAt(share)
        self._figure(painter, middle, dim.prefix + figure, ink, dim.field_label, marked=marked)

    def _figure(
        self, painter: ThemedPainter, at: QPointF, figure: str, ink: str, word: str, *, marked: bool
    ) -> None:
        u = self.theme.unit_px
        metrics = QFontMetricsF(self.theme.make_font(_NUMBER_HEIGHT, is_bold=True))
        wide, tall = metrics.horizontalAdvance(figure) + 1.2 * u, 2.6 * u
        box = QRectF(at.x() - wide / 2.0, at.y() - tall / 2.0, wide, tall)
        box.moveLeft(max(1.0, min(box.x(), self.width() - wide - 1.0)))
        box.moveTop(max(1.0, min(box.y(), self.height() - tall - 1.0)))
        painter.fill_rect(box, "lit" if marked else "panel")
        painter.draw_text_line(
            box, figure, _NUMBER_HEIGHT, "on_lit" if marked else ink, at=ALIGN_CENTER, raw=True, fit=False
        )
        self.add_target(self._make_touch_box(box), partial(self._touch, word))

    def _make_touch_box(self, box: QRectF) -> QRectF:
        """Return a touchable rectangle around a dimension's number, placed inside the panel."""
        least = max(5.0 * self.theme.unit_px, FINGERTIP_PX)
        side, up = (max(0.0, least - have) / 2.0 for have in (box.width(), box.height()))
        place = box.adjusted(-side, -up, side, up)
        place.moveLeft(max(0.0, min(place.x(), self.width() - place.width())))
        place.moveTop(max(0.0, min(place.y(), self.height() - place.height())))
        return place


def draw_arrowhead(painter: ThemedPainter, line: QLineF) -> None:
    """Draw an arrowhead at the first point of a line with the current pen."""
    if line.length() < 1e-6:
        return
    for turn in (20.0, -20.0):
        side = QLineF(line)
        side.setLength(_ARROW_SIZE * painter.theme.unit_px)
        side.setAngle(line.angle() + turn)
        painter.drawLine(side)


def _is_diameter(dim: Dimension) -> bool:
    """Return whether a dimension is a diameter: its line crosses the axis at a right angle."""
    return dim.end is not None and dim.start[1] < 0.0 < dim.end[1] and dim.start[0] == dim.end[0]


_DRAWING_SCALE = 1.9  # Size of the drawing relative to the cutting edges, for a tool with an insert.


def draw_tool_outline(
    painter: ThemedPainter, box: QRectF, outline: ToolOutline, *, is_small: bool = False
) -> None:
    """Draw the body, cutting edges and control point of a tool.

    Z points right and X points down. ``is_small`` omits the arrows of the axes and draws a smaller cross.
    """
    look, u = painter.theme, painter.theme.unit_px
    place = _make_transform(box, outline)
    painter.save()
    painter.setClipRect(box)
    for polygons, ink, width, ground in (
        (outline.body_outlines, "frame", 0.16, "ghost"),
        (outline.cutting_outlines, "accent", 0.32, "key"),
    ):
        for points in polygons:
            painter.setPen(look.make_pen(ink, width))
            painter.setBrush(look.get_color(ground))
            painter.drawPolygon(place.map(make_outline_polygon(points)))
    at = place.map(QPointF(0.0, 0.0))
    painter.setPen(look.make_pen("tip", 0.2))
    arm, circle = (0.7 * u, 0.3 * u) if is_small else (1.6 * u, 0.6 * u)
    painter.drawLine(at - QPointF(arm, 0), at + QPointF(arm, 0))
    painter.drawLine(at - QPointF(0, arm), at + QPointF(0, arm))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(at, circle, circle)
    painter.restore()
    if not is_small:
        _draw_axes(painter, box)


def _make_transform(box: QRectF, outline: ToolOutline) -> QTransform:
    """Return the transform from (z, x) in mm to pixels of the box.

    Axial tools are shown completely. For other tools, only the surroundings of the cutting edges are shown.
    """
    cutting = make_outline_polygon(outline.cutting_outlines[0]).boundingRect()
    for points in outline.cutting_outlines[1:]:
        cutting = cutting.united(make_outline_polygon(points).boundingRect())
    share = 1.15 if outline.is_axially_symmetric else _DRAWING_SCALE
    if outline.is_axially_symmetric and outline.body_outlines:
        cutting = cutting.united(make_outline_polygon(outline.body_outlines[0]).boundingRect())
    scale = min(box.width() / cutting.width(), box.height() / cutting.height()) / share
    # Shift the center of the drawing toward the body.
    middle = cutting.center()
    if outline.body_outlines and not outline.is_axially_symmetric:
        whole = make_outline_polygon(outline.body_outlines[0]).boundingRect().center() - middle
        reach = max(abs(whole.x()), abs(whole.y()), 1e-9)
        middle += whole * (0.3 * min(cutting.width(), cutting.height()) / reach)
    return QTransform(
        scale, 0, 0, scale, box.center().x() - scale * middle.x(), box.center().y() - scale * middle.y()
    )


def make_outline_polygon(points: FloatArray) -> QPolygonF:
    """Return points (z, x) in mm as a polygon."""
    return QPolygonF([QPointF(z, x) for z, x in points.tolist()])


def _draw_axes(painter: ThemedPainter, box: QRectF) -> None:
    """Draw the axis arrows in the upper left corner, with Z+ to the right and X+ down."""
    u = painter.theme.unit_px
    at, long = QPointF(box.x() + 1.2 * u, box.y() + 1.2 * u), 3.0 * u
    painter.setPen(painter.theme.make_pen("soft", 0.14))
    painter.drawLine(at, at + QPointF(long, 0))
    painter.drawLine(at, at + QPointF(0, long))
    painter.draw_text_line(
        QRectF(at.x() + long + 0.3 * u, at.y() - u, 3 * u, 2 * u), "Z+", 1.4, "soft", raw=True
    )
    painter.draw_text_line(QRectF(at.x() - 0.6 * u, at.y() + long, 3 * u, 2 * u), "X+", 1.4, "soft", raw=True)


_FLANK_ANGLE = 0.7  # Radians from the tool's axis to its flanks.


def draw_tool_tip(painter: ThemedPainter, box: QRectF, quadrant: int, color: str = "text") -> None:
    """Draw a tool tip with its body, its nose circle, and a dot at the point that X and Z refer to."""
    side = min(box.width(), box.height())
    centre, radius = box.center(), 0.16 * side
    z, x = TIP_DIRECTIONS[quadrant]  # X+ points down on the screen.
    middle = centre + QPointF(0.22 * side * z, 0.22 * side * x)
    painter.save()
    painter.setClipRect(box)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.theme.get_color("ghost"))
    if (z, x) != (0, 0):
        painter.drawPath(_make_body_path(middle, math.atan2(-x, -z), radius, side))
    painter.setPen(painter.theme.make_pen(color, 0.16))
    painter.drawEllipse(middle, radius, radius)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.theme.get_color("tip"))
    dot = max(1.5, 0.06 * side)
    painter.drawEllipse(middle + QPointF(radius * z, radius * x), dot, dot)
    painter.restore()


def _make_body_path(nose: QPointF, away: float, radius: float, side: float) -> QPainterPath:
    """Return the outline of the body of a tool tip.

    Its two flanks touch the nose circle and extend out of the drawing.
    """
    path = QPainterPath(_on(nose, away + math.pi / 2 + _FLANK_ANGLE, radius))
    path.lineTo(_on(_on(nose, away + math.pi / 2 + _FLANK_ANGLE, radius), away + _FLANK_ANGLE, 2 * side))
    path.lineTo(_on(_on(nose, away - math.pi / 2 - _FLANK_ANGLE, radius), away - _FLANK_ANGLE, 2 * side))
    path.lineTo(_on(nose, away - math.pi / 2 - _FLANK_ANGLE, radius))
    path.closeSubpath()
    return path


def _on(at: QPointF, angle: float, far: float) -> QPointF:
    return at + QPointF(far * math.cos(angle), far * math.sin(angle))
