"""The lines across the page: title line, prompt line, comment, and the row of function keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.view import Tone
from app.desk.words import tr
from app.screen.keys import ANSWER
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put, put_raw
from app.screen.panel import Panel
from app.screen.shapes import draw_sign

TARGET = 13.0  # units: width of an answer to touch


class TitleLine(Panel):
    """Program of the desk, page, program name, machine state in words, clock."""

    ground = "panel"

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._shown = ("", "STARTING", Tone.OFF, "", "")
        self.page = ""

    @property
    def program(self) -> str:
        """The program's name."""
        return self._shown[0]

    @property
    def state(self) -> str:
        """The state in words."""
        return self._shown[1]

    def show_page(self, page: str) -> None:
        """The page that is in front."""
        if page != self.page:
            self.page = page
            self.update()

    def show_state(self, program: str, state: str, tone: Tone, machine: str, clock: str) -> None:
        """What stands in the line."""
        if (program, state, tone, machine, clock) != self._shown:
            self._shown = (program, state, tone, machine, clock)
            self.update()

    def draw(self, painter: QPainter) -> None:
        program, state, tone, machine, clock = self._shown
        look, u, high = self.look, self.look.u, self.height()
        painter.fillRect(QRectF(0, high - 0.16 * u, self.width(), 0.16 * u), look.colour("frame"))
        painter.setFont(look.fit(self.page, 2.2, 24 * u, bold=True))
        painter.setPen(look.colour("accent"))
        put(painter, QRectF(1.4 * u, 0, 24 * u, high), LEFT, self.page)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(program, 2.4, 31 * u, bold=True))
        put_raw(painter, QRectF(27 * u, 0, 31 * u, high), LEFT, program or tr("NO PROGRAM"))
        self._draw_state(painter, state, tone)
        painter.setPen(look.colour("soft"))
        painter.setFont(look.fit(machine, 1.8, 30 * u))
        put(painter, QRectF(self.width() - 47 * u, 0, 30 * u, high), RIGHT, machine)
        painter.setFont(look.font(2.2))
        painter.setPen(look.colour("text"))
        put(painter, QRectF(self.width() - 16 * u, 0, 14.6 * u, high), RIGHT, clock)

    def _draw_state(self, painter: QPainter, state: str, tone: Tone) -> None:
        look, u, high, state = self.look, self.look.u, self.height(), tr(state)
        box = QRectF(60 * u, 0.6 * u, 50 * u, high - 1.3 * u)
        painter.fillRect(box, look.colour(tone.value))
        ink = look.colour("on_state")
        font = look.fit(state, 2.5, box.width() - 8 * u, bold=True)
        painter.setFont(font)
        wide = QFontMetricsF(font).horizontalAdvance(state)
        left = box.center().x() - (wide + 3.6 * u) / 2
        draw_sign(painter, QRectF(left, box.center().y() - 1.2 * u, 2.4 * u, 2.4 * u), tone, ink)
        painter.setPen(ink)
        put(painter, QRectF(left + 3.6 * u, box.y(), wide + u, box.height()), LEFT, state)


class PromptLine(Panel):
    """What can be done now, or the answer to the last key; below it why the machine stands.

    A question has two targets for a finger.
    """

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self.text = self.reason = ""
        self._answer = False
        self.asked = ""

    def show_text(self, text: str, *, answer: bool, asked: str = "", reason: str = "") -> None:
        """``answer`` when it answers a key: it stands out then. ``asked``: the key that means yes."""
        shown = (text, answer, asked, reason)
        if shown != (self.text, self._answer, self.asked, self.reason):
            self.text, self._answer, self.asked, self.reason = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        area = self.area()
        painter.fillRect(area, look.colour("pause" if self._answer else "panel"))
        if self.asked:
            area.setRight(self._targets(painter, area))
        painter.setPen(look.colour("on_state" if self._answer else "text"))
        room = area.adjusted(1.4 * u, 0, -1.4 * u, 0)
        if self.reason:
            low = room.adjusted(0, 0.48 * room.height(), 0, -0.05 * room.height())
            painter.setFont(look.fit(self.reason, 1.9, room.width()))
            put(painter, low, LEFT, self.reason)
            room.setBottom(low.top())
        painter.setFont(look.fit(self.text, 2.1 if self.reason else 2.3, room.width(), bold=True))
        put(painter, room, LEFT, self.text)

    def _targets(self, painter: QPainter, area: QRectF) -> float:
        """Yes and no for a finger, at the right end, where no key is that asks; where the text ends."""
        look, u = self.look, self.look.u
        left = area.right() - 2 * TARGET * u
        for number, (word, key) in enumerate((("YES", ANSWER), ("NO", "Esc"))):
            box = QRectF(left + number * TARGET * u, area.y(), (TARGET - 0.6) * u, area.height())
            painter.fillRect(box, look.colour("key"))
            painter.setPen(look.colour("text"))
            painter.setFont(look.font(2.1, bold=True))
            put(painter, box, CENTRE, word)
            self.place(box, partial(self._press, key))
        return left


class CommentLine(Panel):
    """The last comment of the program, at the lower left."""

    title = "COMMENT"

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.text = ""

    def show_text(self, text: str) -> None:
        """The comment's own text, untouched."""
        if text != self.text:
            self.text = text
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("accent"))
        room = self.area().adjusted(1.4 * u, 1.5 * u, -1.2 * u, -0.5 * u)
        painter.setFont(look.fit(self.text, 2.0, room.width()))
        put_raw(painter, room, LEFT, self.text)


class FunctionKeys(Panel):
    """F1 to F10 with labels of up to eight characters; each is a target for a finger too."""

    def __init__(self, look: Look, press: Callable[[int], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self.labels: tuple[str, ...] = ("",) * 10

    def show_labels(self, labels: tuple[str, ...]) -> None:
        """The labels of another page; an empty one is no key."""
        if labels != self.labels:
            self.labels = labels
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        gap = 0.6 * u
        wide = (self.width() + gap) / len(self.labels)
        for number, label in enumerate(self.labels, 1):
            if not label:
                continue
            box = QRectF((number - 1) * wide, 0, wide - gap, self.height())
            painter.fillRect(box, look.colour("key"))
            painter.setPen(look.colour("accent"))
            painter.setFont(look.font(1.8, bold=True))
            put(painter, QRectF(box.x(), box.y() + 0.5 * u, box.width(), 2.4 * u), CENTRE, f"F{number}")
            painter.setPen(look.colour("text"))
            painter.setFont(look.fit(label, 2.1, box.width() - u, bold=True))
            put(painter, QRectF(box.x(), box.y() + 3.0 * u, box.width(), 3.2 * u), CENTRE, label)
            self.place(box, self._presser(number))

    def _presser(self, number: int) -> Callable[[], None]:
        return lambda: self._press(number)
