"""What lies over the panes: buttons, what the lines mean, a scale in each pane."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPen

from app.desk.words import tr
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Press
from app.screen.path.inks import Ink
from app.screen.path.plot import Frame, scale_length

BUTTON = (6.6, 6.6, 7.0)  # units: width, height, from one to the next; a fingertip
LOW = 5.0  # units: from one to the next at least


class Button(NamedTuple):
    """``lit`` while what it switches is on."""

    sign: str
    press: Press
    lit: bool = False


Entry = tuple[str, QPen]


def draw_buttons(
    painter: QPainter,
    look: Look,
    room: QRectF,
    buttons: Sequence[Button],
    place: Callable[[QRectF, Press], None],
) -> None:
    """A column at the right; in a low pane they are lower, and as many as there is room for."""
    wide, high, step = (k * look.u for k in BUTTON)
    close = max(LOW * look.u, (room.height() - 3.2 * look.u) / max(1, len(buttons)))
    high, step = high - max(0.0, step - close), min(step, close)
    for number, (sign, press, lit) in enumerate(buttons):
        box = QRectF(room.right() - wide - look.u, room.y() + 0.8 * look.u + number * step, wide, high)
        if box.bottom() > room.bottom() - 2.4 * look.u:
            return
        painter.fillRect(box, look.colour("lit" if lit else "key"))
        painter.setPen(look.colour("on_lit" if lit else "text"))
        painter.setFont(look.fit(sign, 1.6 if len(sign) > 1 else 2.8, wide - 0.4 * look.u, bold=True))
        put(painter, box, CENTRE, sign)
        place(box, press)


def run_legend(look: Look) -> list[Entry]:
    """Of a program that runs or will."""
    todo, done = Ink.TODO.pens(look), Ink.DONE.pens(look)
    return [(tr("done"), done[2]), (tr("to come"), todo[2]), (tr("rapid"), todo[1])]


def compared_legend(look: Look) -> list[Entry]:
    """Of a program before and after a change."""
    return [(tr("before"), Ink.BEFORE.pens(look)[2]), (tr("after"), Ink.AFTER.pens(look)[2])]


def draw_legend(painter: QPainter, look: Look, room: QRectF, entries: Sequence[Entry]) -> None:
    """A row at the lower left."""
    u = look.u
    x, y = room.x() + 1.2 * u, room.bottom() - 2.2 * u
    painter.setFont(look.font(1.5))
    metrics = QFontMetricsF(painter.font())
    for word, pen in entries:
        wide = metrics.horizontalAdvance(word) + 0.4 * u
        if x + 3.6 * u + wide > room.right() - 0.2 * room.width() - 6 * u:
            return
        painter.setPen(pen)
        painter.drawLine(QPointF(x, y + u), QPointF(x + 3 * u, y + u))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(x + 3.6 * u, y, wide, 2 * u), LEFT, word)
        x += 5.0 * u + wide


def draw_scale(painter: QPainter, look: Look, room: QRectF, frame: Frame, metric: bool) -> None:
    """A round length at the lower right of a pane, in the unit in force."""
    u = look.u
    mm, text = scale_length(min(14 * u, 0.2 * room.width()) / frame.scale, metric)
    wide = mm * frame.scale
    right, y = room.right() - 1.4 * u, room.bottom() - 1.0 * u
    painter.setPen(look.pen("soft", 0.16))
    for a, b in (((-wide, 0.0), (0.0, 0.0)), ((-wide, -0.7), (-wide, 0.0)), ((0.0, -0.7), (0.0, 0.0))):
        painter.drawLine(QPointF(right + a[0], y + a[1] * u), QPointF(right + b[0], y + b[1] * u))
    painter.setFont(look.font(1.5))
    painter.setPen(look.colour("soft"))
    put(painter, QRectF(right - wide - 12 * u, y - 1.2 * u, 11.2 * u, 2 * u), RIGHT, text)


def draw_border(painter: QPainter, look: Look, room: QRectF) -> None:
    """Between a pane and the one at its left."""
    painter.setPen(look.pen("frame", 0.12))
    painter.drawLine(room.topLeft(), room.bottomLeft())


def draw_words(painter: QPainter, look: Look, room: QRectF, words: str) -> None:
    """At the upper left of a pane: what it is, or what is to be said of it."""
    u = look.u
    painter.setPen(look.colour("soft"))
    painter.setFont(look.fit(words, 1.6, room.width() - 2 * u, bold=True))
    put(painter, QRectF(room.x() + 1.2 * u, room.y() + 0.9 * u, room.width() - 2 * u, 2 * u), LEFT, words)


def draw_nothing(painter: QPainter, look: Look, room: QRectF, why: str) -> None:
    """Where there is no path."""
    painter.setPen(look.colour("soft"))
    painter.setFont(look.fit(why, 2.0, room.width()))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    put(painter, room, CENTRE, why)
