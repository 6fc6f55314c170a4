"""The lines across the window: title, lit words, what stands until somebody acts, prompt line, comment,
function keys.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF
from PySide6.QtWidgets import QWidget

from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import Sort
from app.desk.status.readouts import Lamp
from app.desk.translation import tr
from app.screen.accessible import announce
from app.screen.look import CENTRE, LEAST, LEFT, RIGHT, Look, Painter, draw_sign, put, width_of
from app.screen.panel import Panel, Shown
from app.screen.window.keys import ANSWER, NO
from app.screen.window_layout import FINGER

TARGET = 13.0  # units: width of an answer to touch
ANSWERS = {Sort.ANSWER: ("pause", "!"), Sort.DONE: ("run", "✓"), Sort.ASKED: ("wait", "?")}  # ground, sign
PROMPT_SHARE = 0.47  # of the prompt line: the row of answer and question
SIGN = 5.0  # units: width of the sign


class TitleLine(Panel):
    """Program of the desk, page, program name, machine state in words, who is in force, clock."""

    ground = "panel"

    page = Shown("")
    access = Shown("")  # who has signed in, and the level in force; empty: there are no levels
    _shown = Shown(("", "STARTING", Tone.OFF, "", ""))

    @property
    def program(self) -> str:
        """The name of the program in the title line."""
        return self._shown[0]

    @property
    def state(self) -> str:
        """The state of the machine in words, as shown."""
        return self._shown[1]

    def show_state(self, program: str, state: str, tone: Tone, machine: str, clock: str) -> None:
        """What stands in the line."""
        self._shown = (program, state, tone, machine, clock)

    def draw(self, painter: Painter) -> None:
        program, state, tone, machine, clock = self._shown
        u, high = self.look.u, self.height()
        painter.fill(QRectF(0, high - 0.16 * u, self.width(), 0.16 * u), "frame")
        painter.write(QRectF(1.4 * u, 0, 24 * u, high), self.page, 2.2, "accent")
        painter.write(QRectF(27 * u, 0, 31 * u, high), program or tr("NO PROGRAM"), 2.4, "text", raw=True)
        self._draw_state(painter, state, tone)
        right = QRectF(self.width() - 47 * u, 0, 30 * u, high)
        if self.access:
            half = 0.5 * high
            below = QRectF(right.x(), half, right.width(), half - 0.2 * u)
            painter.write(below, self.access, 1.7, "accent", at=RIGHT)
            right.setHeight(half)
        painter.write(right, machine, 1.8, "soft", at=RIGHT, bold=False)
        right = QRectF(self.width() - 16 * u, 0, 14.6 * u, high)
        painter.write(right, clock, 2.2, "text", at=RIGHT, bold=False)

    def _draw_state(self, painter: Painter, state: str, tone: Tone) -> None:
        look, u, high, state = self.look, self.look.u, self.height(), tr(state)
        box = QRectF(60 * u, 0.6 * u, 50 * u, high - 1.3 * u)
        painter.fill(box, tone.value)
        ink = look.colour("on_state")
        painter.setFont(look.fit(state, 2.5, box.width() - 8 * u, bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(state)
        left = box.center().x() - (wide + 3.6 * u) / 2
        draw_sign(painter, QRectF(left, box.center().y() - 1.2 * u, 2.4 * u, 2.4 * u), tone, ink)
        painter.setPen(ink)
        put(painter, QRectF(left + 3.6 * u, box.y(), wide + u, box.height()), LEFT, state)


class PromptLine(Panel):
    """Three places above the function keys: answer and question in one row, the state below them.

    Each place has one subject, and none covers another. Where there is an answer and a question, each has
    half of the row. The question has two targets, always at the right end.
    """

    state, reason, question, answer, asked = (Shown("") for _ in range(5))
    sort: Shown[Sort | None] = Shown(None)  # of the answer

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self._announced = ""

    @property
    def text(self) -> str:
        """What there is to read first: the answer to the last key, a question, or else the state."""
        return self.answer or self.question or self.state

    def show_state(self, text: str, reason: str = "") -> None:
        """Show what can be done now, and the reason why the machine is stopped."""
        self.state, self.reason = text, reason

    def show_question(self, text: str, asked: str = "") -> None:
        """Show a question; ``asked`` is the key that means yes."""
        self.question, self.asked = text, asked

    def show_answer(self, text: str, *, sort: Sort | None) -> None:
        """Show an answer; ``sort`` gives its color and its sign."""
        self.answer, self.sort = text, sort

    def draw(self, painter: Painter) -> None:
        area = self.area()
        painter.fill(area, "panel")
        if self.text != self._announced:
            self._announced = self.text
            announce(self, tr(self.text))
        if self.question and self.asked:
            area.setRight(self._targets(painter, area))  # as high as a finger needs them
        upper = QRectF(area.x(), area.y(), area.width(), PROMPT_SHARE * area.height())
        self._state(painter, area.adjusted(0, upper.height(), 0, 0))
        both = bool(self.answer and self.question)
        half = upper.width() / 2
        if self.answer:
            place = upper.adjusted(0, 0, -half - 2 if both else 0, 0)
            self._notice(painter, place, self.answer, self.sort or Sort.ANSWER)
        if self.question:
            place = upper.adjusted(half + 2 if both else 0, 0, 0, 0)
            self._notice(painter, place, self.question, Sort.ASKED)

    def _state(self, painter: Painter, area: QRectF) -> None:
        u = self.look.u
        room = area.adjusted(1.4 * u, 0, -1.4 * u, 0)
        if self.reason:
            low = room.adjusted(0, 0.48 * room.height(), 0, -0.05 * room.height())
            painter.write(low, self.reason, 1.9, "text", bold=False)
            room.setBottom(low.top())
        painter.write(room, self.state, 2.1 if self.reason else 2.3, "text")

    def _notice(self, painter: Painter, area: QRectF, text: str, sort: Sort) -> None:
        u = self.look.u
        ground, sign = ANSWERS[sort]
        painter.fill(area, ground)
        painter.write(
            QRectF(area.x(), area.y(), SIGN * u, area.height()), sign, 3.0, "on_state", at=CENTRE, raw=True
        )
        painter.write(area.adjusted(SIGN * u, 0, -1.4 * u, 0), text, 2.3, "on_state")

    def _targets(self, painter: Painter, area: QRectF) -> float:
        """Draw yes and no at the right end, where no key is that asks; return where the text ends."""
        u = self.look.u
        left = area.right() - 2 * TARGET * u
        for number, (word, key) in enumerate((("YES", ANSWER), ("NO", NO))):
            box = QRectF(left + number * TARGET * u, area.y(), (TARGET - 0.6) * u, area.height())
            self.key(painter, box, word, 2.1, partial(self._press, key))
        return left - 0.6 * u


class CommentLine(Panel):
    """The last comment of the program, at the lower left."""

    title = "COMMENT"
    text = Shown("")

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        room = self.area().adjusted(1.4 * u, 1.5 * u, -1.2 * u, -0.5 * u)
        painter.write(room, self.text, 2.0, "accent", bold=False, raw=True)


class FunctionKeys(Panel):
    """F1 to F10 with labels of up to eight characters; each is a target for a finger too."""

    part_name = "FUNCTION KEYS"
    labels: Shown[tuple[str, ...]] = Shown(("",) * 10)  # an empty one is no key
    barred: Shown[frozenset[str]] = Shown(frozenset())  # keys that would be refused now: drawn dim

    def __init__(self, look: Look, press: Callable[[int], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        gap = 0.6 * u
        wide = (self.width() + gap) / len(self.labels)
        for number, label in enumerate(self.labels, 1):
            if not label:
                continue
            box = QRectF((number - 1) * wide, 0, wide - gap, self.height())
            barred = f"F{number}" in self.barred
            painter.fill(box, "panel" if barred else "key")
            upper = QRectF(box.x(), box.y() + 0.5 * u, box.width(), 2.4 * u)
            painter.write(upper, f"F{number}", 1.8, "soft" if barred else "accent", at=CENTRE)
            lower = QRectF(box.x(), box.y() + 3.0 * u, box.width(), 3.2 * u)
            painter.write(lower, label, 2.1, "soft" if barred else "text", at=CENTRE, margin=1.0)
            self.place(box, partial(self._press, number), barred=barred)


# --- lit words ----------------------------------------------------------------------------------------


class LampStrip(Panel):
    """A row of words. Lit is filled and dark is hollow, so that the difference needs no colour."""

    part_name = "LAMPS"
    lamps: Shown[tuple[Lamp, ...]] = Shown(())
    mute: Shown[frozenset[str]] = Shown(
        frozenset()
    )  # keys that are text now, and not shown: the finger's alone

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        gap = 0.6 * u
        wide = (self.width() + gap) / max(1, len(self.lamps))
        for number, lamp in enumerate(self.lamps):
            box = QRectF(number * wide, 0, wide - gap, self.height())
            self._lamp(painter, box, lamp)
            if lamp.key:
                self.place(box, partial(self._press, lamp.key), kind="lamp", on=lamp.lit)

    def _lamp(self, painter: Painter, box: QRectF, lamp: Lamp) -> None:
        look, u = self.look, self.look.u
        lit = "pause" if lamp.warn else "lit"
        line = lit if lamp.lit else "frame"
        inset = look.pen(line, 0.14).widthF() / 2
        painter.box(box.adjusted(inset, inset, -inset, -inset), line, 0.14, lit if lamp.lit else "panel")
        ink = ("on_state" if lamp.warn else "on_lit") if lamp.lit else "soft"
        room = box.adjusted(0.5 * u, 0.5 * u, -0.5 * u, -0.5 * u)
        if lamp.key and lamp.key not in self.mute:
            cap = QRectF(room.x() + 0.1 * u, room.center().y() - 1.5 * u, 2.6 * u, 3.0 * u)
            painter.setPen(look.colour(ink))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(cap)
            painter.write(cap, lamp.key, 2.2, ink, at=CENTRE)
            room.setLeft(cap.right() + 0.4 * u)
        words = tr(lamp.word).split(" ", 1)
        room.setHeight(room.height() / len(words))
        for number, word in enumerate(words):
            painter.write(room.translated(0, number * room.height()), word, 1.75, ink, at=CENTRE)


# --- notices that stay --------------------------------------------------------------------------------


NOTICE_ROW, NOTICE_KEY = 5.0, 17.0  # units: height of a row, width of a key
NOTICE_LOW = 4.5  # units: height of a row that is only read
_THREE_LINES = 6.0  # units: height of a row that has room for them


class NoticeRows(Panel):
    """Each filled in the colour of what it says; a finger on a key presses it."""

    rows: Shown[tuple[NoticeRow, ...]] = Shown(())

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self._stand_for = 0

    @property
    def high(self) -> int:
        """Pixels that the rows need."""
        return sum(self._high_of(row) for row in self.rows)

    def _high_of(self, row: NoticeRow) -> int:
        """A fingertip where there is something to press, or more for words that need it; else two lines."""
        u = self.look.u
        if not row.keys:
            return round(NOTICE_LOW * u)
        wide = self._room(row, self.width())
        fits = width_of(row.figures, self.look.fit(row.figures, 1.7, wide)) <= wide
        return max(FINGER + 2, round(NOTICE_ROW * u) if fits else round(_THREE_LINES * u) + 3)

    def _room(self, row: NoticeRow, wide: float) -> float:
        """For its words, beside its keys."""
        return wide - (len(row.keys) * NOTICE_KEY + 2.4) * self.look.u

    @property
    def other_room(self) -> bool:
        """Whether the rows need more or less than the room they have been given."""
        return self.high != self._stand_for

    def take_room(self) -> int:
        """They have what they need from now on: how many pixels."""
        self._stand_for = self.high
        return self.high

    def draw(self, painter: Painter) -> None:
        share, top = self.height() / max(1, self.high), 0.0  # less than they need where there is no more
        for row in self.rows:
            high = share * self._high_of(row)
            self._row(painter, QRectF(0, top, self.width(), high - 2), row)
            top += high

    def _row(self, painter: Painter, box: QRectF, row: NoticeRow) -> None:
        u = self.look.u
        painter.fill(box, row.tone)
        wide = self._room(row, box.width())
        lines = [row.figures] if row.figures else []
        if box.height() > _THREE_LINES * u:
            lines = _in_lines(row.figures, self.look.fit(row.figures, 1.7, wide), wide)
        upper = QRectF(box.x() + 1.2 * u, box.y(), wide, box.height() * (1.0, 0.52, 0.4)[len(lines)])
        painter.write(upper, row.text, 2.0, "on_state", raw=True)
        high = (box.height() - upper.height()) / max(1, len(lines))
        for number, line in enumerate(lines):
            below = QRectF(upper.x(), upper.bottom() + number * high, wide, high)
            painter.write(below, line, 1.7 if len(lines) == 1 else LEAST, "on_state", bold=False, raw=True)
        for number, (name, label) in enumerate(row.keys):
            x = box.right() - (len(row.keys) - number) * NOTICE_KEY * u
            self._key(painter, QRectF(x, box.y(), NOTICE_KEY * u - 0.6 * u, box.height()), name, label)

    def _key(self, painter: Painter, box: QRectF, name: str, label: str) -> None:
        u = self.look.u
        painter.fill(box, "key")
        painter.write(QRectF(box.x() + 0.8 * u, box.y(), 3.2 * u, box.height()), name, 1.8, "accent")
        painter.write(box.adjusted(3.8 * u, 0, -0.4 * u, 0), label, 1.8, "text", at=CENTRE, margin=0.2)
        self.place(box, partial(self._press, name))


def _in_lines(text: str, font: QFont, wide: float) -> list[str]:
    """Two lines where one has no room even in the smallest letters; the second may still be cut off."""
    if not text or width_of(text, font) <= wide:
        return [text] if text else []
    words, first = text.split(" "), ""
    while words and width_of(f"{first} {words[0]}".strip(), font) <= wide:
        first = f"{first} {words.pop(0)}".strip()
    return [first, " ".join(words)] if first else [text]
