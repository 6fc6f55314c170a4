"""Drawing of one pane of the path view, and of the title above all panes."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter

from app.path import path_marks_view as marks
from app.path.measuring_view import Measurement
from app.path.path_aspects import PART_ASPECTS, SPATIAL_ASPECTS, ApproachLeg, PathViewKind
from app.path.path_pane_view import PathPane
from app.screen.screen_theme import ALIGN_LEFT, ScreenTheme, draw_text


def draw_pane(
    painter: QPainter,
    theme: ScreenTheme,
    pane: PathPane,
    drawn_legs: Sequence[ApproachLeg],
    measurement: Measurement | None,
    *,
    is_metric: bool,
) -> None:
    """Draw the path of a pane with its marks, the approach, the measurement and the title."""
    painter.save()
    painter.setClipRect(pane.area)
    painter.translate(pane.area.topLeft())
    if pane.projection is not None:
        pane.draw_path(painter)
        marks.draw_center_lines(painter, theme, pane.aspect, pane.projection, pane.polyline)
        pane.draw_run_state(painter)
    if drawn_legs and pane.aspect is PathViewKind.PATH:
        marks.draw_approach(painter, theme, pane, drawn_legs)
    if measurement is not None and measurement.pane is pane and pane.aspect not in SPATIAL_ASPECTS:
        measurement.draw(painter)
    painter.restore()
    if pane.aspect is not PathViewKind.PATH:
        ink = "alarm" if pane.aspect in PART_ASPECTS and marks.find_displayed_part_errors(pane) else "soft"
        marks.draw_title(painter, theme, pane.area, marks.make_pane_title(pane, is_metric), ink)


def draw_view_title(painter: QPainter, theme: ScreenTheme, width_px: int, title: str) -> None:
    """Draw the title of the view above its panes."""
    u = theme.unit_px
    wide, high = width_px - 4 * u, theme.title_height * u
    painter.setFont(theme.fit_font(title, theme.find_table_size(1.7), wide, is_bold=True))
    painter.setPen(theme.get_color("soft"))
    draw_text(painter, QRectF(2.2 * u, 0, wide, high), ALIGN_LEFT, title)
