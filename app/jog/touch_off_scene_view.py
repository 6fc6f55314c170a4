"""Painting of the touch-off picture: part, tool at its old and new offset, dimension and texts."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainterPath, QPen, QPolygonF, QTransform

from app.desk.translation import tr
from app.jog.touch_off_picture import TouchOffPicture
from app.jog.touch_off_scene import Bounds, TouchedSurface, TouchOffScene
from app.screen.drawings import draw_arrowhead, make_outline_polygon
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ThemedPainter
from core.message import join_messages
from core.sketch import Point

_TEXT_WIDTH_RATIO = 0.36  # Width of the texts as a ratio to the width of the picture.
_TEXT_SIZE = 1.9  # Units: height of the texts.
_LABEL_RATIO = 0.46  # Width of a label as a ratio to the width of the texts.
_ROW_COUNT = 5  # The title, three values and the note.
_HATCHING_STEP, _HATCHING_OPACITY = 1.5, 0.4  # Units between the lines of a section.
_CROSS_SIZE = 1.0  # Units: arm of the cross at the control point.
_ZERO_RADIUS = 0.6  # Units: circle of the symbol of part zero.


def draw_touch_off_picture(painter: ThemedPainter, area: QRectF, picture: TouchOffPicture) -> None:
    """Draw the texts of the picture, the drawing next to or below them, and the warning below both."""
    u, line = painter.theme.unit_px, painter.theme.find_line_height(2.2)
    rest = QRectF(area)
    if picture.shown_warning:
        rest.setBottom(area.bottom() - line - 0.4 * u)
        _draw_warning(painter, QRectF(area.x(), rest.bottom() + 0.4 * u, area.width(), line), picture)
    if rest.height() > rest.width():  # The texts are above the drawing.
        high = _ROW_COUNT * line
        texts, drawing = rest.adjusted(0, 0, 0, high - rest.height()), rest.adjusted(0, high + u, 0, 0)
    else:
        wide = _TEXT_WIDTH_RATIO * rest.width()
        texts, drawing = rest.adjusted(0, 0, wide - rest.width(), 0), rest.adjusted(wide + u, 0, 0, 0)
    _draw_texts(painter, texts, picture)
    _draw_scene(painter, drawing, picture)


def _draw_warning(painter: ThemedPainter, box: QRectF, picture: TouchOffPicture) -> None:
    painter.draw_box(box, "alarm", 0.2, "key")
    painter.draw_text_line(box, picture.shown_warning, 2.0, "alarm", at=ALIGN_CENTER, margin=1.0)


def _draw_texts(painter: ThemedPainter, area: QRectF, picture: TouchOffPicture) -> None:
    """Draw the surface with the unit, the old and the new size, their difference and the note."""
    u, ink = painter.theme.unit_px, _find_new_color(picture)
    rows = (
        (tr("OLD"), picture.old_text, "pause", Qt.PenStyle.DashLine),
        (tr("NEW"), picture.new_text, ink, Qt.PenStyle.SolidLine),
        (tr("SIZE CHANGE"), picture.size_change_text, "", Qt.PenStyle.NoPen),
    )
    high = min(painter.theme.find_line_height(3.4), area.height() / _ROW_COUNT)
    row = QRectF(area.x(), area.y(), area.width(), high)
    title = join_messages(", ", [each for each in (picture.title, picture.unit_text) if each])
    painter.draw_text_line(row, title, _TEXT_SIZE, "accent")
    for name, value, color, style in rows:
        row.translate(0, high)
        if not value:
            continue
        label = QRectF(row.x(), row.y(), _LABEL_RATIO * row.width() - 0.6 * u, high)
        if color:
            _draw_legend(painter, QRectF(row.x(), row.y(), 2.2 * u, high), color, style)
            label.setLeft(row.x() + 2.8 * u)
        painter.draw_text_line(label, name, 1.5, "soft")
        value_box = row.adjusted(_LABEL_RATIO * row.width(), 0, 0, 0)
        painter.draw_text_line(value_box, value, _TEXT_SIZE, "text", at=ALIGN_RIGHT, raw=True)
    row.moveBottom(area.bottom())
    painter.draw_text_line(row, picture.note_text, 1.5, "soft", bold=False)


def _find_new_color(picture: TouchOffPicture) -> str:
    return "alarm" if picture.shown_warning else "text"


def _draw_legend(painter: ThemedPainter, box: QRectF, color: str, style: Qt.PenStyle) -> None:
    """Draw a short line in the style of an outline."""
    pen = painter.theme.make_pen(color, 0.24)
    pen.setStyle(style)
    painter.setPen(pen)
    painter.drawLine(QLineF(box.left(), box.center().y(), box.right(), box.center().y()))


# --- the drawing ---------------------------------------------------------------------------------------


def _draw_scene(painter: ThemedPainter, area: QRectF, picture: TouchOffPicture) -> None:
    """Draw the part, the tool at both offsets and the dimension, with Z to the right and X+ down."""
    scene, place = picture.scene, make_scene_transform(area, picture.scene.visible_area)
    painter.draw_box(area, "frame", 0.12, "ground")
    painter.save()
    painter.setClipRect(area)
    _draw_part(painter, scene, place, area)
    if scene.new_tip is not None:
        _draw_tool(painter, scene, place, scene.new_tip, _find_new_color(picture))
    if scene.old_tip is not None:
        _draw_old_tool(painter, scene, place, scene.old_tip, is_only=scene.new_tip is None)
    _draw_dimension(painter, scene, place, area, picture.size_texts)
    painter.restore()


def make_scene_transform(area: QRectF, bounds: Bounds) -> QTransform:
    """Return the transform from (z, x) in mm to pixels at which the bounds fill the area."""
    low_z, high_z, low_x, high_x = bounds
    scale = min(area.width() / (high_z - low_z), area.height() / (high_x - low_x))
    middle_z, middle_x = (low_z + high_z) / 2.0, (low_x + high_x) / 2.0
    return QTransform(
        scale, 0, 0, scale, area.center().x() - scale * middle_z, area.center().y() - scale * middle_x
    )


def _map(place: QTransform, points: Iterable[Point]) -> QPolygonF:
    return place.map(QPolygonF([QPointF(z, x) for z, x in points]))


def _draw_part(painter: ThemedPainter, scene: TouchOffScene, place: QTransform, area: QRectF) -> None:
    """Draw the section of the part, its axis and the touched edge."""
    for each in scene.part_outlines:
        polygon = _map(place, each)
        painter.setPen(painter.theme.make_pen("frame", 0.16))
        painter.setBrush(painter.theme.get_color("key"))
        painter.drawPolygon(polygon)
        _hatch(painter, polygon, area)
    axis = place.map(QPointF(0.0, 0.0)).y()
    pen = painter.theme.make_pen("centre", 0.14)
    pen.setStyle(Qt.PenStyle.DashDotLine)
    painter.setPen(pen)
    painter.drawLine(QLineF(area.left(), axis, area.right(), axis))
    if scene.touched_edge is not None:
        painter.setPen(painter.theme.make_pen("accent", 0.5))
        painter.drawPolyline(_map(place, scene.touched_edge))


def _hatch(painter: ThemedPainter, polygon: QPolygonF, area: QRectF) -> None:
    """Draw the hatching of a section.

    The lines of Qt's own hatching are too close to each other on a screen with small pixels.
    """
    painter.save()
    outline = QPainterPath()
    outline.addPolygon(polygon)
    painter.setClipPath(outline, Qt.ClipOperation.IntersectClip)
    color = painter.theme.get_color("frame")
    color.setAlphaF(_HATCHING_OPACITY)
    painter.setPen(QPen(color, 1.0))
    step, high = _HATCHING_STEP * painter.theme.unit_px, area.height()
    for number in range(int((area.width() + high) / step) + 1):
        left = area.left() - high + number * step
        painter.drawLine(QLineF(left, area.bottom(), left + high, area.top()))
    painter.restore()


def _draw_tool(
    painter: ThemedPainter, scene: TouchOffScene, place: QTransform, tip: Point, color: str
) -> None:
    """Draw the tool at its new offset, with a cross at its control point."""
    u, outline = painter.theme.unit_px, scene.tool_outline
    moved = QTransform.fromTranslate(*tip) * place
    for polygons, fill in ((outline.body_outlines, "ghost"), (outline.cutting_outlines, "here")):
        painter.setPen(painter.theme.make_pen(color, 0.24))
        painter.setBrush(painter.theme.get_color(fill))
        for points in polygons:
            painter.drawPolygon(moved.map(make_outline_polygon(points)))
    at = moved.map(QPointF(0.0, 0.0))
    painter.setPen(painter.theme.make_pen("tip", 0.2))
    painter.drawLine(at - QPointF(_CROSS_SIZE * u, 0), at + QPointF(_CROSS_SIZE * u, 0))
    painter.drawLine(at - QPointF(0, _CROSS_SIZE * u), at + QPointF(0, _CROSS_SIZE * u))


def _draw_old_tool(
    painter: ThemedPainter, scene: TouchOffScene, place: QTransform, tip: Point, *, is_only: bool
) -> None:
    """Draw the outline of the tool at its old offset with a dashed line."""
    moved = QTransform.fromTranslate(*tip) * place
    pen = painter.theme.make_pen("pause", 0.24)
    pen.setStyle(Qt.PenStyle.DashLine)
    painter.setPen(pen)
    painter.setBrush(painter.theme.get_color("ghost") if is_only else Qt.BrushStyle.NoBrush)
    for points in (*scene.tool_outline.body_outlines, *scene.tool_outline.cutting_outlines):
        painter.drawPolygon(moved.map(make_outline_polygon(points)))


def _draw_dimension(
    painter: ThemedPainter, scene: TouchOffScene, place: QTransform, area: QRectF, texts: tuple[str, ...]
) -> None:
    """Draw the dimension with the entered size.

    A diameter has its text between the centerline and the tool. Its other end can be outside the drawing.
    """
    start, end = (place.map(QPointF(*each)) for each in scene.dimension)
    tip = scene.new_tip or scene.old_tip
    painter.setPen(QPen(painter.theme.get_color("text"), 1.0))
    if tip is not None:
        painter.drawLine(QLineF(end, place.map(QPointF(*tip))))
    line = QLineF(start, end)
    painter.drawLine(line)
    draw_arrowhead(painter, line)
    draw_arrowhead(painter, QLineF(end, start))
    if scene.surface is TouchedSurface.FACE:
        _draw_part_zero(painter, place.map(QPointF(0.0, 0.0)), start)
        _draw_size(painter, area, line, texts, area.right())
    else:  # Z of the tip is 0, and the text must not cover the tool.
        tip_column = place.map(QPointF(0.0, 0.0)).x() - _CROSS_SIZE * painter.theme.unit_px
        _draw_size(painter, area, QLineF(line.center(), end), texts, tip_column)


def _draw_part_zero(painter: ThemedPainter, zero: QPointF, dimension_start: QPointF) -> None:
    """Draw the symbol of part zero, and the line from it to the dimension, with the current pen."""
    radius = _ZERO_RADIUS * painter.theme.unit_px
    painter.drawLine(QLineF(zero, dimension_start))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(zero, radius, radius)
    painter.drawLine(zero - QPointF(2 * radius, 0), zero + QPointF(2 * radius, 0))
    painter.drawLine(zero - QPointF(0, 2 * radius), zero + QPointF(0, 2 * radius))


def _draw_size(
    painter: ThemedPainter, area: QRectF, line: QLineF, texts: tuple[str, ...], right: float
) -> None:
    """Draw the lines of the dimension text in a box that is completely inside the drawing.

    ``line`` is the dimension line. The box is on the middle of the line, or next to a line that it would
    cover. It ends at ``right`` if there is room for it.
    """
    u, theme = painter.theme.unit_px, painter.theme
    font = theme.make_font(theme.find_table_size(_TEXT_SIZE), is_bold=True)
    wide = min(max(QFontMetricsF(font).horizontalAdvance(text) for text in texts) + u, area.width() - 2.0)
    row_height = theme.find_line_height(2.2)
    high = len(texts) * row_height
    box = QRectF(line.center().x() - wide / 2.0, line.center().y() - high / 2.0, wide, high)
    if abs(line.dx()) < wide and abs(line.dy()) < high:
        box.moveBottom(min(line.y1(), line.y2()) - 0.5 * u)
    box.moveLeft(max(area.left() + 1.0, min(box.left(), min(right, area.right()) - wide - 1.0)))
    box.moveTop(max(area.top() + 1.0, min(box.top(), area.bottom() - high - 1.0)))
    painter.fill_rect(box, "panel")
    for number, text in enumerate(texts):
        row = QRectF(box.x(), box.y() + number * row_height, wide, row_height)
        painter.draw_text_line(row, text, _TEXT_SIZE, "text", at=ALIGN_CENTER, raw=True)
