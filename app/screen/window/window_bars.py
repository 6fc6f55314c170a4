"""The rows across the window: title, lamps, notices, prompt line, comment and function keys."""

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
from app.screen.text_sizes import Role
from app.screen.window.keys import ANSWER, NO
from app.screen.window_layout import FINGER

TARGET = 13.0  # Units: width of the touch target of an answer.
# Background color and sign.
ANSWERS = {Sort.ANSWER: ("pause", "!"), Sort.DONE: ("run", "✓"), Sort.ASKED: ("wait", "?")}
PROMPT_SHARE = 0.47  # Fraction of the prompt line's height for message and question.
LEAST_TWO = 5.0  # Units: smallest height of the state for two lines.
SIGN = 5.0  # Units: width of the sign.


class TitleLine(Panel):
    """The title line: page, program, machine state, signed-in user, machine name and clock."""

    ground = "panel"

    page = Shown("")
    access = Shown("")  # The signed-in user and level; empty if access levels are off.
    _shown = Shown(("", "STARTING", Tone.OFF, "", ""))

    @property
    def program(self) -> str:
        """The program name in the title line."""
        return self._shown[0]

    @property
    def state(self) -> str:
        """The displayed state of the machine."""
        return self._shown[1]

    def show_state(self, program: str, state: str, tone: Tone, machine: str, clock: str) -> None:
        """Show these texts in the title line."""
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
        box = QRectF(60 * u, 0.2 * u, 50 * u, high - 0.5 * u)
        painter.fill(box, tone.value)
        ink = look.colour("on_state")
        size = look.em(2.5, Role.STATE, box.height())
        painter.setFont(look.fit(state, size, box.width() - 8 * u, bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(state)
        left = box.center().x() - (wide + 3.6 * u) / 2
        draw_sign(painter, QRectF(left, box.center().y() - 1.2 * u, 2.4 * u, 2.4 * u), tone, ink)
        painter.setPen(ink)
        put(painter, QRectF(left + 3.6 * u, box.y(), wide + u, box.height()), LEFT, state)


class PromptLine(Panel):
    """Three places above the function keys: message and question in one row, the state below them.

    Each place has one subject, and none covers another. If there are both a message and a question, each has
    half of the row. The question has two targets, always at the right end.
    """

    state, reason, question, answer, asked = (Shown("") for _ in range(5))
    sort: Shown[Sort | None] = Shown(None)  # Kind of the message.

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self._announced = ""

    @property
    def text(self) -> str:
        """The most important text: the message, else the question, else the state."""
        return self.answer or self.question or self.state

    def show_state(self, text: str, reason: str = "") -> None:
        """Show what the operator can do now, and the reason why the machine is stopped."""
        self.state, self.reason = text, reason

    def show_question(self, text: str, asked: str = "") -> None:
        """Show a question. ``asked`` is the key that means yes."""
        self.question, self.asked = text, asked

    def show_answer(self, text: str, *, sort: Sort | None) -> None:
        """Show a message. ``sort`` determines its color and sign."""
        self.answer, self.sort = text, sort

    def draw(self, painter: Painter) -> None:
        area = self.area()
        painter.fill(area, "panel")
        if self.text != self._announced:
            self._announced = self.text
            announce(self, tr(self.text))
        if self.question and self.asked:
            area.setRight(self._targets(painter, area))  # The targets use the full height, for touch.
        upper = QRectF(area.x(), area.y(), area.width(), PROMPT_SHARE * area.height())
        noticed = bool(self.answer or self.question)
        self._state(painter, area.adjusted(0, upper.height() if noticed else 0, 0, 0))
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
            painter.write(low, self.reason, 1.9, "text", bold=False, role=Role.PROMPT)
            room.setBottom(low.top())
        lines = self._lines(tr(self.state), room)
        high = room.height() / len(lines)
        for number, line in enumerate(lines):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            size = 2.1 if self.reason else 2.3
            painter.write(row, line, size, "text", raw=True, role=Role.PROMPT)

    def _lines(self, text: str, room: QRectF) -> list[str]:
        """Return the text as one line, or as two lines if it can be larger then."""
        look, words = self.look, text.split(" ")
        one = look.em(2.3, Role.PROMPT, room.height())
        two = look.em(2.3, Role.PROMPT, room.height() / 2)
        wide = width_of(text, look.font(one, bold=True))
        if (
            len(words) < 2
            or room.height() < LEAST_TWO * look.u
            or wide <= room.width()
            or two <= one * room.width() / wide
        ):
            return [text]
        cuts = (" ".join(words[:at]) for at in range(1, len(words)))
        first = min(cuts, key=lambda part: abs(2 * len(part) - len(text)))
        return [first, text[len(first) + 1 :].strip()]

    def _notice(self, painter: Painter, area: QRectF, text: str, sort: Sort) -> None:
        u = self.look.u
        ground, sign = ANSWERS[sort]
        painter.fill(area, ground)
        painter.write(
            QRectF(area.x(), area.y(), SIGN * u, area.height()), sign, 3.0, "on_state", at=CENTRE, raw=True
        )
        painter.write(area.adjusted(SIGN * u, 0, -1.4 * u, 0), text, 2.3, "on_state", role=Role.PROMPT)

    def _targets(self, painter: Painter, area: QRectF) -> float:
        """Draw the targets for yes and no at the right end, and return where the text must end."""
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
    """The function keys F1 to F10, each with a label of up to eight characters. Each is a touch target."""

    part_name = "FUNCTION KEYS"
    labels: Shown[tuple[str, ...]] = Shown(("",) * 10)  # An empty label means no key.
    barred: Shown[frozenset[str]] = Shown(frozenset())  # Disabled keys, which are drawn dim.

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


# --- lamps --------------------------------------------------------------------------------------------


class LampStrip(Panel):
    """A row of lamps. A lit lamp is filled and a dark lamp is hollow, so that color is not needed."""

    part_name = "LAMPS"
    lamps: Shown[tuple[Lamp, ...]] = Shown(())
    mute: Shown[frozenset[str]] = Shown(
        frozenset()
    )  # Keys that are text input now. The lamps react to touch only.

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


# --- notices ------------------------------------------------------------------------------------------


NOTICE_ROW, NOTICE_KEY = 5.0, 17.0  # Units: height of a row, width of a key.
NOTICE_LOW = 4.5  # Units: height of a row without keys.
_THREE_LINES = 6.0  # Units: height of a row with room for three lines.


class NoticeRows(Panel):
    """Rows with notices, each filled with the color of its tone and with keys for touch."""

    rows: Shown[tuple[NoticeRow, ...]] = Shown(())

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self._stand_for = 0

    @property
    def high(self) -> int:
        """The height in pixels that the rows need."""
        return sum(self._high_of(row) for row in self.rows)

    def _high_of(self, row: NoticeRow) -> int:
        """Return the height of a row in pixels.

        A row with keys is at least as high as a fingertip. A row without keys has two lines of text.
        """
        u = self.look.u
        if not row.keys:
            return round(NOTICE_LOW * u)
        wide = self._room(row, self.width())
        fits = width_of(row.figures, self.look.fit(row.figures, 1.7, wide)) <= wide
        return max(FINGER + 2, round(NOTICE_ROW * u) if fits else round(_THREE_LINES * u) + 3)

    def _room(self, row: NoticeRow, wide: float) -> float:
        """Return the width for the texts of a row, next to its keys."""
        return wide - (len(row.keys) * NOTICE_KEY + 2.4) * self.look.u

    @property
    def other_room(self) -> bool:
        """Whether the rows need another height than they have."""
        return self.high != self._stand_for

    def take_room(self) -> int:
        """Note that the rows get the height that they need, and return it in pixels."""
        self._stand_for = self.high
        return self.high

    def draw(self, painter: Painter) -> None:
        share, top = self.height() / max(1, self.high), 0.0  # The rows may get less height than they need.
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
    """Return the text in one line, or in two lines if it is too wide. The second line may still be elided."""
    if not text or width_of(text, font) <= wide:
        return [text] if text else []
    words, first = text.split(" "), ""
    while words and width_of(f"{first} {words[0]}".strip(), font) <= wide:
        first = f"{first} {words.pop(0)}".strip()
    return [first, " ".join(words)] if first else [text]
