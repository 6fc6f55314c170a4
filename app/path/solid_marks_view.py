"""Marks over the part in space: the dimension at the pointer, and the places of collisions."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter

from app.desk.status import formats
from app.desk.translation import tr
from app.path.part_player import PlaybackResult
from app.path.path_marks_view import move_box_inside
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, draw_text
from core.message import Message
from core.part.picture.solid_view import SolidView
from core.proving.part_instant import PartState

_SNAP_PX = 1.5  # pixels: largest difference between the picture and the model of the part
_RING_SIZE = 1.4  # units: radius of the ring at a collision
_OPERATOR_ANGLE_DEG = 180.0  # polar angle of the operator's side with C at 0


def find_dimension(shown: PlaybackResult, position: QPointF) -> tuple[float, float] | None:
    """Return Z and the radius of the part in mm at a position in the picture, or None without a part.

    The radius is that of the model of the part if it agrees with the picture.
    """
    if shown.picture is None or shown.view is None or shown.pixel_size != 1:
        return None
    place = shown.picture.find_surface_point(shown.view, math.floor(position.x()), math.floor(position.y()))
    if place is None:
        return None
    z, radius = place
    return z, find_exact_radius(shown.part_instant, z, radius, _SNAP_PX / shown.view.pixels_per_mm)


def find_exact_radius(part: PartState, z: float, radius: float, tolerance_mm: float) -> float:
    """Return the radius of the section at ``z`` that is closest to ``radius``.

    If no radius of the section is within the tolerance, ``radius`` is returned unchanged.
    """
    half = part.x_plus_half
    if half is None:
        return radius
    column = int(np.searchsorted(half.column_edges, z, side="right")) - 1
    column = min(max(column, 0), len(half.column_edges) - 2)
    inner, outer = half.inner_radii[:, column], half.outer_radii[:, column]
    candidates = np.concatenate((inner[outer > inner], outer[outer > inner]))
    if not len(candidates):
        return radius
    nearest = float(candidates[np.argmin(np.abs(candidates - radius))])
    return nearest if abs(nearest - radius) <= tolerance_mm else radius


def draw_dimension(
    painter: QPainter,
    theme: ScreenTheme,
    place: tuple[float, float],
    position: QPointF,
    room: QRectF,
    *,
    is_metric: bool,
) -> None:
    """Draw the diameter and Z of a place next to the pointer, within ``room``."""
    z, radius = place
    text = f"Ø {formats.format_length(2.0 * radius, is_metric)}  Z {formats.format_length(z, is_metric)}"
    u = theme.unit_px
    painter.setFont(theme.make_font(theme.find_table_size(1.6), is_bold=True))
    width = QFontMetricsF(painter.font()).horizontalAdvance(text) + 1.6 * u
    box = move_box_inside(QRectF(position.x() + 1.2 * u, position.y() - 3.6 * u, width, 2.8 * u), room)
    painter.fillRect(box, theme.get_color("panel"))
    painter.setPen(theme.make_pen("frame", 0.12))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRect(box)
    painter.setPen(theme.get_color("text"))
    draw_text(painter, box, ALIGN_CENTER, text)


def draw_collisions(
    painter: QPainter, theme: ScreenTheme, part: PartState, view: SolidView, room: QRectF
) -> None:
    """Draw a ring with the line number at the place of each collision.

    The tool is on the operator's side. The ring is dashed if the part hides this side.
    """
    u = theme.unit_px
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setFont(theme.make_font(theme.find_table_size(1.5), is_bold=True))
    angle = _OPERATOR_ANGLE_DEG - view.roll_deg
    for hit in part.material_hits:
        deepest = int(np.argmax(hit.outer_radii - hit.inner_radii))
        place = np.array([[float(hit.outer_radii[deepest]), float(hit.z_positions[deepest]), angle]])
        x, y = view.project_to_screen(place, round(room.width()), round(room.height()))[0].tolist()
        phi = float(view.convert_to_viewer_angles(np.radians(place[0, 2:]))[0])
        pen = theme.make_pen("alarm", 0.35)
        pen.setStyle(Qt.PenStyle.SolidLine if math.cos(phi) >= 0.0 else Qt.PenStyle.DotLine)
        painter.setPen(pen)
        painter.drawEllipse(QPointF(x, y), _RING_SIZE * u, _RING_SIZE * u)
        text = tr(Message("LINE {line}", line=hit.finding.line))
        width = QFontMetricsF(painter.font()).horizontalAdvance(text) + u
        box = move_box_inside(QRectF(x + (_RING_SIZE + 0.3) * u, y - 1.1 * u, width, 2.2 * u), room)
        painter.fillRect(box, theme.get_color("panel"))
        draw_text(painter, box, ALIGN_CENTER, text)
