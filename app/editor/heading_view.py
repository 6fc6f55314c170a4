"""The line over the text (what is edited, whether it differs from its file), and where all parts stand."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.code_choices_view import CODE_LINE
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.page_base import HeadKey
from app.screen.panel import Panel, Shown
from app.screen.window_layout import FINGER, Rect

KEYS = 14.0  # units: width of the place that shows the keyboard, and of those that open a panel


class Heading(NamedTuple):
    """``mark`` is CHANGED, SAMPLE or NEW, empty for what is as its file."""

    name: str = ""
    mark: str = ""
    place: str = ""


class HeadLine(Panel):
    """The program being written, which need not be the one on the desk that the title line names."""

    ground = "panel"
    heading = Shown(Heading())
    panel_keys: Shown[tuple[HeadKey, ...]] = Shown(())  # what optional features write into this program

    def __init__(
        self, look: Look, keys: Callable[[], None], panel: Callable[[str], None], parent: QWidget
    ) -> None:
        """``keys`` shows the drawn keyboard, or takes it away; ``panel`` is told the key that opens it."""
        super().__init__(look, parent)
        self._keys, self._panel = keys, panel

    def draw(self, painter: Painter) -> None:
        look, u, high, now = self.look, self.look.u, self.height(), self.heading
        painter.write(QRectF(1.4 * u, 0, 41 * u, high), now.name, 2.3, "text", raw=True, margin=1.0)
        left = 3.0 * u + min(40 * u, QFontMetricsF(painter.font()).horizontalAdvance(now.name))
        if now.mark:
            wide = QFontMetricsF(look.font(1.7, bold=True)).horizontalAdvance(now.mark) + 1.6 * u
            box = QRectF(left, high / 2 - 1.4 * u, wide, 2.8 * u)
            painter.fill(box, "mark")
            painter.write(box, now.mark, 1.7, "on_mark", at=CENTRE, fit=False)
        place = QRectF(self.width() - (40 + 3 * KEYS) * u, 0, 38.0 * u, high)
        painter.write(place, now.place, 1.9, "soft", at=RIGHT, bold=False, fit=False)
        key = QRectF(self.width() - KEYS * u, 0, KEYS * u, high)
        self.key(painter, key, tr("KEYBOARD"), 1.9, self._keys, ink="accent", margin=1.0)
        for label, name in self.panel_keys:
            key = key.translated(-(KEYS + 0.6) * u, 0)  # a place of its own: the one before is kept
            self.key(painter, key, label, 1.9, partial(self._panel, name), ink="accent", margin=1.0)


# --- where everything stands on the page, in the unit of the Automatic page --------------------------------


KEYBOARD = 29.0  # units: height of the drawn keyboard, four rows of a finger's height
NOWHERE = Rect(0, 0, 0, 0)
HEAD_LINE = 6.8  # units: a finger's height, for the place that shows the keyboard


class EditorPlaces(NamedTuple):
    """The parts of the page; ``ask`` is empty while nothing is asked, ``keys`` without the drawn keyboard.

    ``code`` is the line that says what the code at the cursor means, ``codes`` what the list of codes takes;
    ``path`` is the place of all pictures of the program: one of the part being cut is one more choice.
    """

    head: Rect
    text: Rect
    path: Rect
    findings: Rect
    code: Rect
    codes: Rect
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
        return EditorPlaces(head, body, NOWHERE, NOWHERE, NOWHERE, NOWHERE, ask, keyboard, body)
    text = Rect(0, top, round(0.56 * width), body.h)
    x = text.right + gap
    findings_h, code_h = round(min(0.34 * body.h, 24 * u)), max(FINGER, round(CODE_LINE * u))
    path = Rect(x, top, width - x, body.h - findings_h - code_h - 2 * gap)
    findings = Rect(x, path.bottom + gap, path.w, findings_h)
    code = Rect(x, findings.bottom + gap, path.w, code_h)
    codes = Rect(x, top, path.w, body.h)
    return EditorPlaces(head, text, path, findings, code, codes, ask, keyboard, body)
