"""The line over the text (what is edited, whether it differs from its file), and where all parts stand."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put, put_raw
from app.screen.panel import Panel
from app.screen.window_layout import Rect

KEYS = 14.0  # units: width of the place that shows the keyboard


class Heading(NamedTuple):
    """``mark`` is CHANGED, SAMPLE or NEW, empty for what is as its file."""

    name: str = ""
    mark: str = ""
    place: str = ""


class HeadLine(Panel):
    """The program being written, which need not be the one on the desk that the title line names."""

    ground = "panel"

    def __init__(self, look: Look, keys: Callable[[], None], parent: QWidget) -> None:
        """``keys`` shows the drawn keyboard, or takes it away."""
        super().__init__(look, parent)
        self._keys = keys
        self.heading = Heading()

    def show_heading(self, heading: Heading) -> None:
        """Show another name, mark or place."""
        if heading != self.heading:
            self.heading = heading
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u, high, now = self.look, self.look.u, self.height(), self.heading
        painter.setPen(look.colour("text"))
        font = look.fit(now.name, 2.3, 40 * u, bold=True)
        painter.setFont(font)
        put_raw(painter, QRectF(1.4 * u, 0, 41 * u, high), LEFT, now.name)
        left = 3.0 * u + min(40 * u, QFontMetricsF(font).horizontalAdvance(now.name))
        if now.mark:
            painter.setFont(look.font(1.7, bold=True))
            wide = QFontMetricsF(painter.font()).horizontalAdvance(now.mark) + 1.6 * u
            box = QRectF(left, high / 2 - 1.4 * u, wide, 2.8 * u)
            painter.fillRect(box, look.colour("mark"))
            painter.setPen(look.colour("on_mark"))
            put(painter, box, CENTRE, now.mark)
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.9))
        put(painter, QRectF(self.width() - (46 + KEYS) * u, 0, 44.6 * u, high), RIGHT, now.place)
        key = QRectF(self.width() - KEYS * u, 0, KEYS * u, high)
        painter.fillRect(key, look.colour("key"))
        painter.setPen(look.colour("accent"))
        painter.setFont(look.fit(tr("KEYBOARD"), 1.9, key.width() - u, bold=True))
        put(painter, key, CENTRE, tr("KEYBOARD"))
        self.place(key, self._keys)


# --- where everything stands on the page, in the unit of the Automatic page --------------------------------


KEYBOARD = 29.0  # units: height of the drawn keyboard, four rows of a finger's height
NOWHERE = Rect(0, 0, 0, 0)
HEAD_LINE = 6.8  # units: a finger's height, for the place that shows the keyboard


class EditorPlaces(NamedTuple):
    """The parts of the page; ``ask`` is empty while nothing is asked, ``keys`` without the drawn keyboard.

    ``path`` is the place of all pictures of the program: one of the part being cut is one more choice.
    """

    head: Rect
    text: Rect
    path: Rect
    findings: Rect
    ask: Rect
    keys: Rect
    body: Rect  # text, path and findings together: the history takes it


def editor_places(width: int, height: int, u: float, *, asking: bool, keys: float = 0.0) -> EditorPlaces:
    """Divide the room that the frame leaves to its page; ``u`` is its unit.

    ``keys`` units of it are the drawn keyboard's: the text then has the whole width over it.
    """
    gap = max(4, round(0.7 * u))
    head = Rect(0, 0, width, round(HEAD_LINE * u))
    keys_h = round(keys * u)
    foot = height - keys_h
    ask_h = round(6.2 * u) if asking else 0
    low = foot - gap if keys_h else foot
    ask = Rect(0, low - ask_h, width, ask_h)
    top = head.bottom + gap
    body = Rect(0, top, width, (ask.y - gap if asking else low) - top)
    keyboard = Rect(0, foot, width, keys_h)
    if keys_h:
        return EditorPlaces(head, body, NOWHERE, NOWHERE, ask, keyboard, body)
    text = Rect(0, top, round(0.56 * width), body.h)
    x = text.right + gap
    findings_h = round(min(0.4 * body.h, 24 * u))
    path = Rect(x, top, width - x, body.h - findings_h - gap)
    findings = Rect(x, path.bottom + gap, path.w, findings_h)
    return EditorPlaces(head, text, path, findings, ask, keyboard, body)
