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
from app.path.measuring import Apart
from app.path.path_aspects import IN_SPACE, OF_PART, Aspect, DrawnLeg
from app.path.path_layers_view import Ink
from app.path.path_pane_view import Pane
from app.path.path_projection import Ends, Projection, clipped, scale_length
from app.path.polyline import Polyline
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Press
from app.screen.window_layout import FINGER
from core.language.diagnostics import Diagnostic
from core.message import Message
from core.proving.checks.part_checks import is_serious

BUTTON = (6.6, 6.6, 0.4)  # units: width, height and gap; the size is at least that of a fingertip


class Button(NamedTuple):
    """Button of the view. ``lit`` is set while the function of the button is on."""

    sign: str
    press: Press
    lit: bool = False


LegendEntry = tuple[str, QPen]


def button_columns(look: Look, room: QRectF, count: int) -> int:
    """Return the number of button columns. A low room needs several columns."""
    _, high, gap = _button(look)
    rows = max(1, int((room.height() - 3.2 * look.u + gap) / (high + gap)))
    return math.ceil(count / rows)


def columns_wide(columns: int, look: Look) -> float:
    """Return the width of the button columns at the right of a view, in pixels."""
    wide, _, gap = _button(look)
    return columns * (wide + gap)


def _button(look: Look) -> tuple[float, float, float]:
    wide, high, gap = (k * look.u for k in BUTTON)
    return max(wide, FINGER), max(high, FINGER), gap


def draw_buttons(
    painter: QPainter,
    look: Look,
    room: QRectF,
    buttons: Sequence[Button],
    place: Callable[[QRectF, Press], None],
) -> None:
    """Draw the buttons at the right of the room, column by column."""
    wide, high, gap = _button(look)
    columns = button_columns(look, room, len(buttons))
    rows = math.ceil(len(buttons) / columns)
    left = room.right() - columns_wide(columns, look) - 0.6 * look.u
    for number, (sign, press, lit) in enumerate(buttons):
        column, row = divmod(number, rows)
        x, y = left + column * (wide + gap), room.y() + 0.8 * look.u + row * (high + gap)
        box = QRectF(x, y, wide, high)
        painter.fillRect(box, look.colour("lit" if lit else "key"))
        painter.setPen(look.colour("on_lit" if lit else "text"))
        painter.setFont(look.fit(sign, 1.6 if len(sign) > 1 else 2.8, wide - 0.4 * look.u, bold=True))
        put(painter, box, CENTRE, sign)
        place(box, press)


def run_legend(look: Look) -> list[LegendEntry]:
    """Return the legend entries for a path that runs or is ready to run."""
    todo, done = Ink.TODO.pens(look), Ink.DONE.pens(look)
    return [(tr("done"), done[2]), (tr("remaining"), todo[2]), (tr("rapid"), todo[1])]


def compared_legend(look: Look) -> list[LegendEntry]:
    """Return the legend entries for the comparison of a program before and after a change."""
    return [(tr("before"), Ink.BEFORE.pens(look)[2]), (tr("after"), Ink.AFTER.pens(look)[2])]


def draw_foot(
    painter: QPainter,
    look: Look,
    foot: QRectF,
    panes: Sequence[tuple[QRectF, Projection | None]],
    legend: Sequence[LegendEntry],
    metric: bool,
) -> None:
    """Draw the row below the panes: the legend, and the scale of each pane below its right edge."""
    painter.fillRect(foot, look.colour("panel"))
    painter.setFont(look.font(1.5))
    for room, projection in panes:
        below = QRectF(room.x(), foot.y(), room.width(), foot.height())
        left = (
            _draw_scale(painter, look, below, projection, metric) if projection is not None else below.right()
        )
        if room.x() <= foot.x():
            _draw_legend(painter, look, QRectF(below.topLeft(), QPointF(left, below.bottom())), legend)


def _draw_legend(painter: QPainter, look: Look, box: QRectF, entries: Sequence[LegendEntry]) -> None:
    """Draw as many entries of the legend as fit, from the left."""
    u, x = look.u, box.x() + 1.2 * look.u
    metrics = QFontMetricsF(painter.font())
    for word, pen in entries:
        wide = metrics.horizontalAdvance(word) + 0.4 * u
        if x + 3.6 * u + wide > box.right():
            return
        painter.setPen(pen)
        painter.drawLine(QPointF(x, box.center().y()), QPointF(x + 3 * u, box.center().y()))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(x + 3.6 * u, box.y(), wide, box.height()), LEFT, word)
        x += 5.0 * u + wide


def _draw_scale(painter: QPainter, look: Look, box: QRectF, projection: Projection, metric: bool) -> float:
    """Draw a scale bar with a round length in the unit in force, and return its left edge with its text."""
    u = look.u
    mm, text = scale_length(min(14 * u, 0.2 * box.width()) / projection.scale, metric)
    wide = mm * projection.scale
    right, y = box.right() - 1.4 * u, box.center().y() + 0.4 * u
    painter.setPen(look.pen("soft", 0.16))
    for a, b in (((-wide, 0.0), (0.0, 0.0)), ((-wide, -0.7), (-wide, 0.0)), ((0.0, -0.7), (0.0, 0.0))):
        painter.drawLine(QPointF(right + a[0], y + a[1] * u), QPointF(right + b[0], y + b[1] * u))
    left = right - wide - 0.8 * u
    long = QFontMetricsF(painter.font()).horizontalAdvance(text)
    put(painter, QRectF(left - 12 * u, box.y(), 12 * u, box.height()), RIGHT, text)
    return left - long


def draw_border(painter: QPainter, look: Look, room: QRectF) -> None:
    """Draw the border between a pane and the pane to its left."""
    painter.setPen(look.pen("frame", 0.12))
    painter.drawLine(room.topLeft(), room.bottomLeft())


def draw_words(painter: QPainter, look: Look, room: QRectF, words: str, ink: str = "soft") -> None:
    """Draw the title or status of a pane at its upper left."""
    u = look.u
    painter.setFont(look.fit(words, 1.6, room.width() - 2 * u, bold=True))
    box = QRectF(room.x() + 1.2 * u, room.y() + 0.9 * u, room.width() - 2 * u, 2 * u)
    long = min(QFontMetricsF(painter.font()).horizontalAdvance(tr(words)), box.width())
    painter.fillRect(QRectF(box.x() - 0.4 * u, box.y(), long + 0.8 * u, box.height()), look.colour("ground"))
    painter.setPen(look.colour(ink))
    put(painter, box, LEFT, words)


def draw_nothing(painter: QPainter, look: Look, room: QRectF, why: str) -> None:
    """Draw the reason why no path is shown."""
    painter.setPen(look.colour("soft"))
    painter.setFont(look.fit(why, 2.0, room.width()))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    put(painter, room, CENTRE, why)


def draw_approach(painter: QPainter, look: Look, pane: Pane, legs: Sequence[DrawnLeg]) -> None:
    """Draw the visible parts of all legs from the present tool position.

    The painter's origin is the corner of the pane.
    """
    u = look.u
    spots = [pane.spot(leg.z, leg.x) for leg in legs]
    size = pane.room.size()
    labels = []
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for leg, (start, end) in zip(legs[1:], pairwise(spots), strict=True):
        seen = visible_part(start, end, size)
        if seen is None:
            continue
        pen = look.pen("lit", 0.34)
        pen.setStyle(Qt.PenStyle.DashLine if leg.rapid else Qt.PenStyle.SolidLine)
        painter.setPen(pen)
        painter.drawLine(*seen)
        _arrow(painter, look, *seen)
        labels.append(((seen[0] + seen[1]) / 2, leg.label))
    painter.setPen(look.pen("lit", 0.34))
    painter.setBrush(look.colour("panel"))
    for spot in spots[:1]:
        painter.drawEllipse(spot, 0.8 * u, 0.8 * u)
    room = QRectF(QPointF(), size)
    for box, text in leg_labels(look, [at for at, _ in labels], [label for _, label in labels]):
        _label(painter, look, inside_room(box, room), text)


def visible_part(start: QPointF, end: QPointF, size: QSizeF) -> tuple[QPointF, QPointF] | None:
    """Return the part of a line that is inside a pane of this size, or None if no part is visible."""
    ends = Ends(*(np.array([value]) for value in (start.x(), start.y(), end.x(), end.y())))
    cut, inside = clipped(ends, round(size.width()), round(size.height()))
    if not inside[0]:
        return None
    c0, r0, c1, r1 = (float(value[0]) for value in cut)
    return QPointF(c0, r0), QPointF(c1, r1)


def inside_room(box: QRectF, room: QRectF) -> QRectF:
    """Return the box, moved as far as necessary to be inside the room."""
    across = max(room.x() - box.x(), 0.0) + min(room.right() - box.right(), 0.0)
    down = max(room.y() - box.y(), 0.0) + min(room.bottom() - box.bottom(), 0.0)
    return box.translated(across, down)


def _arrow(painter: QPainter, look: Look, start: QPointF, end: QPointF) -> None:
    """Draw an arrow head at the end of a leg that is long enough."""
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


def leg_labels(look: Look, middles: Sequence[QPointF], labels: Sequence[str]) -> list[tuple[QRectF, str]]:
    """Return the boxes and texts of the labels at the middle of each leg.

    Labels that overlap are merged into a range, for example ``5–15``.
    """
    drawn: list[tuple[QRectF, str]] = []
    for at, label in zip(middles, labels, strict=True):
        if not label:
            continue
        box = _label_box(look, at, label)
        near = next((n for n, (other, _) in enumerate(drawn) if other.intersects(box)), None)
        if near is None:
            drawn.append((box, label))
        else:
            other, first = drawn[near]
            text = f"{first.partition(' ')[0].partition('–')[0]}–{label.partition(' ')[0]}"
            drawn[near] = _label_box(look, other.center(), text), text
    return drawn


def _label_box(look: Look, at: QPointF, text: str) -> QRectF:
    wide = QFontMetricsF(look.font(1.6, bold=True)).horizontalAdvance(text) + 1.2 * look.u
    return QRectF(at.x() - wide / 2, at.y() - 1.2 * look.u, wide, 2.4 * look.u)


def _label(painter: QPainter, look: Look, box: QRectF, text: str) -> None:
    painter.setFont(look.font(1.6, bold=True))
    painter.fillRect(box, look.colour("lit"))
    painter.setPen(look.colour("on_lit"))
    put(painter, box, CENTRE, text)


def apart_words(apart: Apart, in_mm: bool) -> str:
    """Return the text for the largest difference between two pictures."""
    if not apart.distance:
        return tr("NO CUTTING MOVE HAS CHANGED")
    length = formats.length(apart.distance, in_mm)
    return tr(
        Message(
            "LARGEST DIFFERENCE {length} {unit}  ·  CIRCLED",
            length=length,
            unit="mm" if in_mm else "in",
        )
    )


def errors_of(pane: Pane) -> list[Diagnostic]:
    """Return the errors of the part that a pane shows, up to the displayed moment."""
    shown = pane.player.played if pane.player is not None else None
    found = shown.instant.findings if shown is not None else ()
    return [each for each in found if is_serious(each)]


def part_words(pane: Pane) -> str:
    """Return the title of a part pane: its latest error, or else the tool that cuts."""
    shown = pane.player.played if pane.player is not None else None
    if pane.player is None or shown is None:
        trouble = pane.player.trouble if pane.player is not None else ""
        return trouble or tr("PART  ·  CALCULATING …")
    wrong = errors_of(pane)
    if wrong:
        return tr(Message("LINE {line}: {what}", line=wrong[-1].line, what=tr(wrong[-1].message)))
    if shown.instant.stock is None:
        return tr("PART  ·  NOTHING CUT")
    tool = shown.instant.tool
    return (
        tr(Message("PART  ·  T{tool}", tool=tool.number)) if tool is not None else tr("PART  ·  UNCUT STOCK")
    )


def pane_words(pane: Pane, in_mm: bool) -> str:
    """Return the title of a pane, which names the visible side of the part."""
    if pane.aspect in OF_PART:
        return part_words(pane)
    if pane.aspect is Aspect.FACE:
        return tr("FACE  ·  VIEW FROM THE TAILSTOCK")
    diameter = formats.length(pane.polyline.round * 360.0 / math.pi, in_mm)
    return tr(Message("SIDE  ·  UNROLLED AT Ø {diameter}", diameter=diameter))


QUARTERS = (0, 90, 180, 270)
TIGHT = 9.0  # units: minimum distance between the C lines of the side view


def draw_centre_lines(
    painter: QPainter, look: Look, aspect: Aspect, projection: Projection, polyline: Polyline
) -> None:
    """Draw the center lines, the C circle of a face, and the C lines of a side below all moving marks.

    The painter's origin is the corner of the pane.
    """
    if aspect in IN_SPACE:
        return
    if aspect in {Aspect.PATH, Aspect.SECTION}:
        _cross(painter, look, projection)
    elif aspect is Aspect.FACE:
        _cross(painter, look, projection)
        _ring(painter, look, projection, polyline)
    else:
        _degrees(painter, look, projection, polyline)


def _pen(look: Look, dashes: list[float]) -> QPen:
    pen = look.pen("centre", 0.12)
    pen.setDashPattern(dashes)
    return pen


def _cross(painter: QPainter, look: Look, projection: Projection) -> None:
    painter.setPen(_pen(look, [14, 4, 2, 4]))
    row = round(float(projection.down(0.0))) + 0.5
    painter.drawLine(QPointF(0, row), QPointF(projection.width, row))
    column = round(float(projection.across(0.0))) + 0.5
    painter.setPen(_pen(look, [2, 6]))
    painter.drawLine(QPointF(column, 0), QPointF(column, projection.height))


def _ring(painter: QPainter, look: Look, projection: Projection, polyline: Polyline) -> None:
    """Draw the circle around all cuts, with the tool positions at C 0, 90, 180 and 270 degrees."""
    u = look.u
    reach = polyline.bounds[1]
    middle = QPointF(float(projection.across(0.0)), float(projection.down(0.0)))
    radius = reach * projection.scale + 0.9 * u
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(_pen(look, [3, 4]))
    painter.drawEllipse(middle, radius, radius)
    painter.setFont(look.font(1.5))
    painter.setPen(look.colour("soft"))
    for degrees in QUARTERS:
        at = math.radians(degrees)
        place = middle + QPointF(math.cos(at), math.sin(at)) * (radius + 1.7 * u)
        put(painter, QRectF(place.x() - 3 * u, place.y() - u, 6 * u, 2 * u), CENTRE, f"C{degrees}")


def _degrees(painter: QPainter, look: Look, projection: Projection, polyline: Polyline) -> None:
    """Draw lines along Z at equal angles with their C.

    Full revolutions are drawn like center lines.
    """
    u, scale = look.u, polyline.round
    step = next((s for s in (15, 30, 45, 90, 180, 360) if s * scale * projection.scale >= TIGHT * u), 360)
    top, bottom = (
        projection.x - projection.height / 2 / projection.scale,
        projection.x + projection.height / 2 / projection.scale,
    )
    painter.setFont(look.font(1.5))
    for number in range(math.ceil(-bottom / scale / step), math.floor(-top / scale / step) + 1):
        degrees = number * step
        row = round(float(projection.down(-degrees * scale))) + 0.5
        painter.setPen(_pen(look, [14, 4, 2, 4] if degrees % 360 == 0 else [2, 6]))
        painter.drawLine(QPointF(0, row), QPointF(projection.width, row))
        painter.setPen(look.colour("soft"))
        text = f"C{formats.fixed(degrees, 0)}"
        put(painter, QRectF(0.8 * u, row - 2.0 * u, 8 * u, 2 * u), LEFT, text)
    column = round(float(projection.across(0.0))) + 0.5
    painter.setPen(_pen(look, [2, 6]))
    painter.drawLine(QPointF(column, 0), QPointF(column, projection.height))
