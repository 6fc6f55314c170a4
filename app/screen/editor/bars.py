"""The lines across the editor: what is edited, and what each function key does now."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.view import Tone
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Panel
from app.screen.shapes import draw_sign

KEYS = 10


class Heading(NamedTuple):
    """What stands in the title line."""

    name: str = ""
    mark: str = ""  # CHANGED, SAMPLE, NEW
    state: str = ""
    tone: Tone = Tone.OFF
    place: str = ""  # line and column
    clock: str = ""


class EditorTitle(Panel):
    """The program and whether it differs from its file; the machine's state, as on every page."""

    ground = "panel"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.heading = Heading()

    def show_heading(self, heading: Heading) -> None:
        """What stands in the line."""
        if heading != self.heading:
            self.heading = heading
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u, high, now = self.look, self.look.u, self.height(), self.heading
        painter.fillRect(QRectF(0, high - 0.16 * u, self.width(), 0.16 * u), look.colour("frame"))
        painter.setFont(look.font(2.2, bold=True))
        painter.setPen(look.colour("accent"))
        put(painter, QRectF(1.4 * u, 0, 16 * u, high), LEFT, "EDITOR")
        painter.setPen(look.colour("text"))
        font = look.fit(now.name, 2.4, 30 * u, bold=True)
        painter.setFont(font)
        put(painter, QRectF(14 * u, 0, 30 * u, high), LEFT, now.name or "NO PROGRAM")
        if now.mark:
            left = 15.6 * u + min(30 * u, QFontMetricsF(font).horizontalAdvance(now.name))
            self._patch(painter, left, now.mark)
        self._state(painter)
        painter.setFont(look.font(2.0))
        painter.setPen(look.colour("text"))
        put(painter, QRectF(self.width() - 46 * u, 0, 29 * u, high), RIGHT, now.place)
        put(painter, QRectF(self.width() - 16 * u, 0, 14.6 * u, high), RIGHT, now.clock)

    def _patch(self, painter: QPainter, left: float, words: str) -> None:
        look, u = self.look, self.look.u
        painter.setFont(look.font(1.7, bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(words) + 1.6 * u
        box = QRectF(left, 0.9 * u, wide, self.height() - 1.9 * u)
        painter.fillRect(box, look.colour("mark"))
        painter.setPen(look.colour("on_mark"))
        put(painter, box, CENTRE, words)

    def _state(self, painter: QPainter) -> None:
        look, u, now = self.look, self.look.u, self.heading
        box = QRectF(72 * u, 0.6 * u, 38 * u, self.height() - 1.3 * u)
        painter.fillRect(box, look.colour(now.tone.value))
        ink = look.colour("on_state")
        painter.setFont(look.fit(now.state, 2.3, box.width() - 8 * u, bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(now.state)
        left = box.center().x() - (wide + 3.6 * u) / 2
        draw_sign(painter, QRectF(left, box.center().y() - 1.2 * u, 2.4 * u, 2.4 * u), now.tone, ink)
        painter.setPen(ink)
        put(painter, QRectF(left + 3.6 * u, box.y(), wide + u, box.height()), LEFT, now.state)


class KeyRow(Panel):
    """F1 to F10 with what they do now; a key without a label does nothing. Each is a target for a finger."""

    def __init__(self, look: Look, press: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press
        self._labels: dict[int, str] = {}

    def show_labels(self, labels: Mapping[int, str]) -> None:
        """The labels by number."""
        if labels != self._labels:
            self._labels = dict(labels)
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        gap = 0.6 * u
        wide = (self.width() + gap) / KEYS
        for number in range(1, KEYS + 1):
            label = self._labels.get(number, "")
            box = QRectF((number - 1) * wide, 0, wide - gap, self.height())
            painter.fillRect(box, look.colour("key" if label else "panel"))
            painter.setPen(look.colour("accent" if label else "off"))
            painter.setFont(look.font(1.8, bold=True))
            put(painter, QRectF(box.x(), box.y() + 0.5 * u, box.width(), 2.4 * u), CENTRE, f"F{number}")
            painter.setPen(look.colour("text"))
            painter.setFont(look.fit(label, 2.1, box.width() - u, bold=True))
            put(painter, QRectF(box.x(), box.y() + 3.0 * u, box.width(), 3.2 * u), CENTRE, label)
            if label:
                self.place(box, self._presser(number))

    def _presser(self, number: int) -> Callable[[], None]:
        return lambda: self._press(number)
