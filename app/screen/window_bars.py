"""The lines across the window: title, lit words, what stands until somebody acts, prompt line, comment,
function keys.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.machine_status import Tone
from app.desk.readouts import Lamp
from app.desk.translation import tr
from app.screen.keys import ANSWER
from app.screen.look import CENTRE, LEFT, RIGHT, Look, draw_sign, put, put_raw
from app.screen.panel import Panel
from app.screen.window_layout import FINGER

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
        """The name of the program in the title line."""
        return self._shown[0]

    @property
    def state(self) -> str:
        """The state of the machine in words, as shown."""
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
            self.place(box, partial(self._press, number))


# --- lit words ----------------------------------------------------------------------------------------


class LampStrip(Panel):
    """A row of words. Lit is filled and dark is hollow, so that the difference needs no colour."""

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self._lamps: tuple[Lamp, ...] = ()
        self.mute: frozenset[str] = frozenset()  # keys that are text now: the finger's alone

    def show_lamps(self, lamps: Sequence[Lamp], mute: frozenset[str] = frozenset()) -> None:
        """The words from left to right; the keys that are ``mute`` are not shown."""
        if (tuple(lamps), mute) != (self._lamps, self.mute):
            self._lamps, self.mute = tuple(lamps), mute
            self.update()

    def draw(self, painter: QPainter) -> None:
        u = self.look.u
        gap = 0.6 * u
        wide = (self.width() + gap) / max(1, len(self._lamps))
        for number, lamp in enumerate(self._lamps):
            box = QRectF(number * wide, 0, wide - gap, self.height())
            self._lamp(painter, box, lamp)
            if lamp.key:
                self.place(box, partial(self._press, lamp.key))

    def _lamp(self, painter: QPainter, box: QRectF, lamp: Lamp) -> None:
        look, u = self.look, self.look.u
        lit = "pause" if lamp.warn else "lit"
        line = look.pen(lit if lamp.lit else "frame", 0.14)
        inset = line.widthF() / 2
        painter.setPen(line)
        painter.setBrush(look.colour(lit) if lamp.lit else look.colour("panel"))
        painter.drawRect(box.adjusted(inset, inset, -inset, -inset))
        ink = look.colour(("on_state" if lamp.warn else "on_lit") if lamp.lit else "soft")
        painter.setBrush(Qt.BrushStyle.NoBrush)
        room = box.adjusted(0.5 * u, 0.5 * u, -0.5 * u, -0.5 * u)
        if lamp.key and lamp.key not in self.mute:
            cap = QRectF(room.x() + 0.1 * u, room.center().y() - 1.5 * u, 2.6 * u, 3.0 * u)
            painter.setPen(ink)
            painter.setFont(look.font(2.2, bold=True))
            painter.drawRect(cap)
            put(painter, cap, CENTRE, lamp.key)
            room.setLeft(cap.right() + 0.4 * u)
        painter.setPen(ink)
        words = tr(lamp.word).split(" ", 1)
        high = room.height() / 2 if len(words) > 1 else room.height()
        for number, word in enumerate(words):
            painter.setFont(look.fit(word, 1.75, room.width(), bold=True))
            put(painter, QRectF(room.x(), room.y() + number * high, room.width(), high), CENTRE, word)


# --- notices that stay --------------------------------------------------------------------------------


NOTICE_ROW, NOTICE_KEY = 5.0, 17.0  # units: height of a row, width of a key


@dataclass(frozen=True, slots=True)
class NoticeRow:
    """A bold text, figures under it, and keys at its right: name and label."""

    text: str
    figures: str = ""
    keys: tuple[tuple[str, str], ...] = ()


class NoticeRows(Panel):
    """Filled in the colour of what waits for an operator; a finger on a key presses it."""

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self.rows: tuple[NoticeRow, ...] = ()
        self._stand_for = 0

    @property
    def high(self) -> int:
        """Pixels that the rows need."""
        return len(self.rows) * max(FINGER, round(NOTICE_ROW * self.look.u))

    @property
    def other_room(self) -> bool:
        """Whether there are more or fewer rows than have been given room."""
        return len(self.rows) != self._stand_for

    def take_room(self) -> int:
        """They have what they need from now on: how many pixels."""
        self._stand_for = len(self.rows)
        return self.high

    def show_rows(self, rows: Sequence[NoticeRow]) -> None:
        """Show these notices in the place of those before."""
        before, self.rows = self.rows, tuple(rows)
        if before != self.rows:
            self.update()

    def draw(self, painter: QPainter) -> None:
        high = self.height() / max(1, len(self.rows))
        for number, row in enumerate(self.rows):
            self._row(painter, QRectF(0, number * high, self.width(), high - 2), row)

    def _row(self, painter: QPainter, box: QRectF, row: NoticeRow) -> None:
        look, u = self.look, self.look.u
        painter.fillRect(box, look.colour("pause"))
        painter.setPen(look.colour("on_state"))
        wide = box.width() - len(row.keys) * NOTICE_KEY * u - 2.4 * u
        upper = QRectF(box.x() + 1.2 * u, box.y(), wide, box.height() * (0.52 if row.figures else 1.0))
        painter.setFont(look.fit(row.text, 2.0, wide, bold=True))
        put_raw(painter, upper, LEFT, row.text)
        if row.figures:
            painter.setFont(look.fit(row.figures, 1.7, wide))
            put_raw(painter, upper.translated(0, upper.height()), LEFT, row.figures)
        for number, (name, label) in enumerate(row.keys):
            x = box.right() - (len(row.keys) - number) * NOTICE_KEY * u
            self._key(painter, QRectF(x, box.y(), NOTICE_KEY * u - 0.6 * u, box.height()), name, label)

    def _key(self, painter: QPainter, box: QRectF, name: str, label: str) -> None:
        look, u = self.look, self.look.u
        painter.fillRect(box, look.colour("key"))
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(1.8, bold=True))
        put(painter, QRectF(box.x() + 0.8 * u, box.y(), 3.2 * u, box.height()), LEFT, name)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(tr(label), 1.8, box.width() - 4.4 * u, bold=True))
        put(painter, box.adjusted(3.8 * u, 0, -0.4 * u, 0), CENTRE, label)
        self.place(box, partial(self._press, name))
