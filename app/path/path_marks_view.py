"""Marks of the path view: center lines, approach legs, legend, scale and buttons."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPen, QPolygonF

from app.desk.status import formats
from app.desk.translation import tr
from app.path.measuring import LargestDistance
from app.path.path_aspects import PART_ASPECTS, SPATIAL_ASPECTS, ApproachLeg, PathViewKind
from app.path.path_layers_view import LineStyle
from app.path.path_pane_view import PathPane
from app.path.path_projection import ChordEnds, Projection, clip_chords, find_scale_length
from app.path.polyline import Polyline
from app.screen.panel import OnPress
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ALIGN_RIGHT, ScreenTheme, draw_text
from app.screen.window_layout import FINGERTIP_PX
from core.language.diagnostics import Diagnostic
from core.message import Message
from core.proving.checks.part_checks import is_serious_finding

BUTTON_SIZE = (6.6, 6.6, 0.4)  # units: width, height and gap; the size is at least that of a fingertip


class ViewButton(NamedTuple):
    """Button of the path view. ``is_lit`` is True while the button's function is active."""

    symbol: str
    on_press: OnPress
    is_lit: bool = False


LegendItem = tuple[str, QPen]


def count_button_columns(theme: ScreenTheme, area: QRectF, button_count: int) -> int:
    """Return the number of button columns.

    Several columns are needed if the area is not high enough for one.
    """
    _, high, gap = _button(theme)
    rows = max(1, int((area.height() - 3.2 * theme.unit_px + gap) / (high + gap)))
    return math.ceil(button_count / rows)


def find_button_columns_width(column_count: int, theme: ScreenTheme) -> float:
    """Return the total width in pixels of the button columns at the right edge of a view."""
    wide, _, gap = _button(theme)
    return column_count * (wide + gap)


def _button(look: ScreenTheme) -> tuple[float, float, float]:
    wide, high, gap = (k * look.unit_px for k in BUTTON_SIZE)
    return max(wide, FINGERTIP_PX), max(high, FINGERTIP_PX), gap


def draw_buttons(
    painter: QPainter,
    theme: ScreenTheme,
    area: QRectF,
    buttons: Sequence[ViewButton],
    add_target: Callable[[QRectF, OnPress], None],
) -> None:
    """Draw the buttons on the right of the area, column by column."""
    wide, high, gap = _button(theme)
    columns = count_button_columns(theme, area, len(buttons))
    rows = math.ceil(len(buttons) / columns)
    left = area.right() - find_button_columns_width(columns, theme) - 0.6 * theme.unit_px
    for number, (sign, press, lit) in enumerate(buttons):
        column, row = divmod(number, rows)
        x, y = left + column * (wide + gap), area.y() + 0.8 * theme.unit_px + row * (high + gap)
        box = QRectF(x, y, wide, high)
        painter.fillRect(box, theme.get_color("lit" if lit else "key"))
        painter.setPen(theme.get_color("on_lit" if lit else "text"))
        painter.setFont(
            theme.fit_font(
                sign,
                theme.find_table_size(1.6) if len(sign) > 1 else 2.8,
                wide - 0.4 * theme.unit_px,
                is_bold=True,
            )
        )
        draw_text(painter, box, ALIGN_CENTER, sign)
        add_target(box, press)


def make_run_legend(theme: ScreenTheme) -> list[LegendItem]:
    """Return the legend entries for a path that is running or ready to run."""
    todo, done = LineStyle.REMAINING.make_pens(theme), LineStyle.FINISHED.make_pens(theme)
    return [(tr("done"), done[2]), (tr("remaining"), todo[2]), (tr("rapid"), todo[1])]


def make_comparison_legend(theme: ScreenTheme) -> list[LegendItem]:
    """Return the legend entries for the comparison of a program before and after a change."""
    return [
        (tr("before"), LineStyle.OLD_PATH.make_pens(theme)[2]),
        (tr("after"), LineStyle.NEW_PATH.make_pens(theme)[2]),
    ]


def draw_footer(
    painter: QPainter,
    theme: ScreenTheme,
    footer_area: QRectF,
    panes: Sequence[tuple[QRectF, Projection | None]],
    legend: Sequence[LegendItem],
    is_metric: bool,
) -> None:
    """Draw the row below the panes, with the legend and the scale of each pane."""
    painter.fillRect(footer_area, theme.get_color("panel"))
    painter.setFont(theme.make_font(theme.find_table_size(1.5)))
    for room, projection in panes:
        below = QRectF(room.x(), footer_area.y(), room.width(), footer_area.height())
        left = (
            _draw_scale(painter, theme, below, projection, is_metric)
            if projection is not None
            else below.right()
        )
        if room.x() <= footer_area.x():
            _draw_legend(painter, theme, QRectF(below.topLeft(), QPointF(left, below.bottom())), legend)


def _draw_legend(painter: QPainter, look: ScreenTheme, box: QRectF, entries: Sequence[LegendItem]) -> None:
    """Draw as many entries of the legend as fit, starting at the left."""
    u, x = look.unit_px, box.x() + 1.2 * look.unit_px
    metrics = QFontMetricsF(painter.font())
    for word, pen in entries:
        wide = metrics.horizontalAdvance(word) + 0.4 * u
        if x + 3.6 * u + wide > box.right():
            return
        painter.setPen(pen)
        painter.drawLine(QPointF(x, box.center().y()), QPointF(x + 3 * u, box.center().y()))
        painter.setPen(look.get_color("soft"))
        draw_text(painter, QRectF(x + 3.6 * u, box.y(), wide, box.height()), ALIGN_LEFT, word)
        x += 5.0 * u + wide


def _draw_scale(
    painter: QPainter, look: ScreenTheme, box: QRectF, projection: Projection, metric: bool
) -> float:
    """Draw a scale bar with a round length in the current unit.

    Return the x coordinate of the left edge of its text.
    """
    u = look.unit_px
    mm, text = find_scale_length(min(14 * u, 0.2 * box.width()) / projection.pixels_per_mm, metric)
    wide = mm * projection.pixels_per_mm
    right, y = box.right() - 1.4 * u, box.center().y() + 0.4 * u
    painter.setPen(look.make_pen("soft", 0.16))
    for a, b in (((-wide, 0.0), (0.0, 0.0)), ((-wide, -0.7), (-wide, 0.0)), ((0.0, -0.7), (0.0, 0.0))):
        painter.drawLine(QPointF(right + a[0], y + a[1] * u), QPointF(right + b[0], y + b[1] * u))
    left = right - wide - 0.8 * u
    long = QFontMetricsF(painter.font()).horizontalAdvance(text)
    draw_text(painter, QRectF(left - 12 * u, box.y(), 12 * u, box.height()), ALIGN_RIGHT, text)
    return left - long


def draw_border(painter: QPainter, theme: ScreenTheme, area: QRectF) -> None:
    """Draw the border between a pane and the pane to its left."""
    painter.setPen(theme.make_pen("frame", 0.12))
    painter.drawLine(area.topLeft(), area.bottomLeft())


def draw_title(painter: QPainter, theme: ScreenTheme, area: QRectF, text: str, color: str = "soft") -> None:
    """Draw the title or status of a pane in its upper left corner."""
    u = theme.unit_px
    painter.setFont(theme.fit_font(text, theme.find_table_size(1.6), area.width() - 2 * u, is_bold=True))
    box = QRectF(area.x() + 1.2 * u, area.y() + 0.9 * u, area.width() - 2 * u, 2 * u)
    long = min(QFontMetricsF(painter.font()).horizontalAdvance(tr(text)), box.width())
    painter.fillRect(
        QRectF(box.x() - 0.4 * u, box.y(), long + 0.8 * u, box.height()), theme.get_color("ground")
    )
    painter.setPen(theme.get_color(color))
    draw_text(painter, box, ALIGN_LEFT, text)


def draw_no_path_reason(painter: QPainter, theme: ScreenTheme, area: QRectF, reason: str) -> None:
    """Draw the reason why no path is shown."""
    painter.setPen(theme.get_color("soft"))
    painter.setFont(theme.fit_font(reason, theme.find_table_size(2.0), area.width()))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    draw_text(painter, area, ALIGN_CENTER, reason)


def draw_approach(painter: QPainter, theme: ScreenTheme, pane: PathPane, legs: Sequence[ApproachLeg]) -> None:
    """Draw the visible parts of all legs, starting at the current tool position.

    The origin of the painter is the corner of the pane.
    """
    u = theme.unit_px
    spots = [pane.map_to_pane(leg.z, leg.x) for leg in legs]
    size = pane.area.size()
    labels = []
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for leg, (start, end) in zip(legs[1:], pairwise(spots), strict=True):
        seen = clip_line(start, end, size)
        if seen is None:
            continue
        pen = theme.make_pen("lit", 0.34)
        pen.setStyle(Qt.PenStyle.DashLine if leg.is_rapid else Qt.PenStyle.SolidLine)
        painter.setPen(pen)
        painter.drawLine(*seen)
        _draw_arrow(painter, theme, *seen)
        labels.append(((seen[0] + seen[1]) / 2, leg.label))
    painter.setPen(theme.make_pen("lit", 0.34))
    painter.setBrush(theme.get_color("panel"))
    for spot in spots[:1]:
        painter.drawEllipse(spot, 0.8 * u, 0.8 * u)
    room = QRectF(QPointF(), size)
    for box, text in make_leg_labels(theme, [at for at, _ in labels], [label for _, label in labels]):
        _label(painter, theme, move_box_inside(box, room), text)


def clip_line(start: QPointF, end: QPointF, size: QSizeF) -> tuple[QPointF, QPointF] | None:
    """Return the part of a line that is inside a pane of this size, or None if no part is visible."""
    ends = ChordEnds(*(np.array([value]) for value in (start.x(), start.y(), end.x(), end.y())))
    cut, inside = clip_chords(ends, round(size.width()), round(size.height()))
    if not inside[0]:
        return None
    c0, r0, c1, r1 = (float(value[0]) for value in cut)
    return QPointF(c0, r0), QPointF(c1, r1)


def move_box_inside(box: QRectF, area: QRectF) -> QRectF:
    """Return the box, moved only as far as necessary to be inside the area."""
    across = max(area.x() - box.x(), 0.0) + min(area.right() - box.right(), 0.0)
    down = max(area.y() - box.y(), 0.0) + min(area.bottom() - box.bottom(), 0.0)
    return box.translated(across, down)


def _draw_arrow(painter: QPainter, theme: ScreenTheme, start: QPointF, end: QPointF) -> None:
    """Draw an arrowhead at the end of a leg if the leg is long enough."""
    leg_vector, u = end - start, theme.unit_px
    length = math.hypot(leg_vector.x(), leg_vector.y())
    if length < 2.5 * u:
        return
    along = leg_vector / length
    across = QPointF(-along.y(), along.x())
    back = end - along * 1.6 * u
    painter.save()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.get_color("lit"))
    painter.drawPolygon(QPolygonF([end, back + across * 0.7 * u, back - across * 0.7 * u]))
    painter.restore()


def make_leg_labels(
    theme: ScreenTheme, middles: Sequence[QPointF], labels: Sequence[str]
) -> list[tuple[QRectF, str]]:
    """Return the boxes and texts of the labels at the middle of each leg.

    Labels that overlap are merged into a range, for example ``5–15``.
    """
    drawn: list[tuple[QRectF, str]] = []
    for at, label in zip(middles, labels, strict=True):
        if not label:
            continue
        box = _label_box(theme, at, label)
        near = next((n for n, (other, _) in enumerate(drawn) if other.intersects(box)), None)
        if near is None:
            drawn.append((box, label))
        else:
            other, first = drawn[near]
            text = f"{first.partition(' ')[0].partition('–')[0]}–{label.partition(' ')[0]}"
            drawn[near] = _label_box(theme, other.center(), text), text
    return drawn


def _label_box(look: ScreenTheme, at: QPointF, text: str) -> QRectF:
    wide = (
        QFontMetricsF(look.make_font(look.find_table_size(1.6), is_bold=True)).horizontalAdvance(text)
        + 1.2 * look.unit_px
    )
    return QRectF(at.x() - wide / 2, at.y() - 1.2 * look.unit_px, wide, 2.4 * look.unit_px)


def _label(painter: QPainter, look: ScreenTheme, box: QRectF, text: str) -> None:
    painter.setFont(look.make_font(look.find_table_size(1.6), is_bold=True))
    painter.fillRect(box, look.get_color("lit"))
    painter.setPen(look.get_color("on_lit"))
    draw_text(painter, box, ALIGN_CENTER, text)


def describe_largest_difference(difference: LargestDistance, is_metric: bool) -> str:
    """Return the text for the largest distance between the paths of two pictures."""
    if not difference.distance_mm:
        return tr("NO CUTTING MOVE HAS CHANGED")
    length = formats.format_length(difference.distance_mm, is_metric)
    return tr(
        Message(
            "LARGEST DIFFERENCE {length} {unit}  ·  CIRCLED",
            length=length,
            unit="mm" if is_metric else "in",
        )
    )


def find_displayed_part_errors(pane: PathPane) -> list[Diagnostic]:
    """Return the part errors that have occurred up to the moment that a pane displays."""
    shown = pane.part_player.latest_result if pane.part_player is not None else None
    found = shown.part_instant.findings if shown is not None else ()
    return [each for each in found if is_serious_finding(each)]


def make_part_title(pane: PathPane) -> str:
    """Return the title of a part pane: the latest error, or else the tool that is cutting."""
    shown = pane.part_player.latest_result if pane.part_player is not None else None
    if pane.part_player is None or shown is None:
        error_text = pane.part_player.error_text if pane.part_player is not None else ""
        return error_text or tr("PART  ·  CALCULATING …")
    wrong = find_displayed_part_errors(pane)
    if wrong:
        return tr(Message("LINE {line}: {what}", line=wrong[-1].line, what=tr(wrong[-1].message)))
    if shown.part_instant.stock is None:
        return tr("PART  ·  NOTHING CUT")
    tool = shown.part_instant.tool
    return (
        tr(Message("PART  ·  T{tool}", tool=tool.tool_number))
        if tool is not None
        else tr("PART  ·  UNCUT STOCK")
    )


def make_pane_title(pane: PathPane, is_metric: bool) -> str:
    """Return the title of a pane, which names the visible side of the part."""
    if pane.aspect in PART_ASPECTS:
        return make_part_title(pane)
    if pane.aspect is PathViewKind.FACE:
        return tr("FACE  ·  VIEW FROM THE TAILSTOCK")
    diameter = formats.format_length(pane.polyline.mm_per_degree * 360.0 / math.pi, is_metric)
    return tr(Message("SIDE  ·  UNROLLED AT Ø {diameter}", diameter=diameter))


QUARTER_ANGLES_DEG = (0, 90, 180, 270)
MIN_C_LINE_DISTANCE = 9.0  # units: minimum distance between the C lines of the side view


def draw_center_lines(
    painter: QPainter, theme: ScreenTheme, aspect: PathViewKind, projection: Projection, polyline: Polyline
) -> None:
    """Draw the center lines, and the C angles as a circle on a face or as lines on a side.

    Marks that move, such as the tool tip, are drawn over them later. The origin of the painter is the
    corner of the pane.
    """
    if aspect in SPATIAL_ASPECTS:
        return
    if aspect in {PathViewKind.PATH, PathViewKind.SECTION}:
        _cross(painter, theme, projection)
    elif aspect is PathViewKind.FACE:
        _cross(painter, theme, projection)
        _draw_c_circle(painter, theme, projection, polyline)
    else:
        _draw_c_lines(painter, theme, projection, polyline)


def _pen(look: ScreenTheme, dashes: list[float]) -> QPen:
    pen = look.make_pen("centre", 0.12)
    pen.setDashPattern(dashes)
    return pen


def _cross(painter: QPainter, look: ScreenTheme, projection: Projection) -> None:
    painter.setPen(_pen(look, [14, 4, 2, 4]))
    row = round(float(projection.find_pixel_row(0.0))) + 0.5
    painter.drawLine(QPointF(0, row), QPointF(projection.width_px, row))
    column = round(float(projection.find_pixel_column(0.0))) + 0.5
    painter.setPen(_pen(look, [2, 6]))
    painter.drawLine(QPointF(column, 0), QPointF(column, projection.height_px))


def _draw_c_circle(painter: QPainter, theme: ScreenTheme, projection: Projection, polyline: Polyline) -> None:
    """Draw a circle around all cuts, and mark where the tool is at C 0, 90, 180 and 270 degrees."""
    u = theme.unit_px
    reach = polyline.bounds[1]
    middle = QPointF(float(projection.find_pixel_column(0.0)), float(projection.find_pixel_row(0.0)))
    radius = reach * projection.pixels_per_mm + 0.9 * u
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(_pen(theme, [3, 4]))
    painter.drawEllipse(middle, radius, radius)
    painter.setFont(theme.make_font(theme.find_table_size(1.5)))
    painter.setPen(theme.get_color("soft"))
    for degrees in QUARTER_ANGLES_DEG:
        at = math.radians(degrees)
        place = middle + QPointF(math.cos(at), math.sin(at)) * (radius + 1.7 * u)
        draw_text(
            painter, QRectF(place.x() - 3 * u, place.y() - u, 6 * u, 2 * u), ALIGN_CENTER, f"C{degrees}"
        )


def _draw_c_lines(painter: QPainter, theme: ScreenTheme, projection: Projection, polyline: Polyline) -> None:
    """Draw lines along Z at equal angles, with their C values.

    Lines at full revolutions have the style of center lines.
    """
    u, scale = theme.unit_px, polyline.mm_per_degree
    step = next(
        (
            s
            for s in (15, 30, 45, 90, 180, 360)
            if s * scale * projection.pixels_per_mm >= MIN_C_LINE_DISTANCE * u
        ),
        360,
    )
    top, bottom = (
        projection.center_x - projection.height_px / 2 / projection.pixels_per_mm,
        projection.center_x + projection.height_px / 2 / projection.pixels_per_mm,
    )
    painter.setFont(theme.make_font(theme.find_table_size(1.5)))
    for number in range(math.ceil(-bottom / scale / step), math.floor(-top / scale / step) + 1):
        degrees = number * step
        row = round(float(projection.find_pixel_row(-degrees * scale))) + 0.5
        painter.setPen(_pen(theme, [14, 4, 2, 4] if degrees % 360 == 0 else [2, 6]))
        painter.drawLine(QPointF(0, row), QPointF(projection.width_px, row))
        painter.setPen(theme.get_color("soft"))
        text = f"C{formats.format_fixed(degrees, 0)}"
        draw_text(painter, QRectF(0.8 * u, row - 2.0 * u, 8 * u, 2 * u), ALIGN_LEFT, text)
    column = round(float(projection.find_pixel_column(0.0))) + 0.5
    painter.setPen(_pen(theme, [2, 6]))
    painter.drawLine(QPointF(column, 0), QPointF(column, projection.height_px))
