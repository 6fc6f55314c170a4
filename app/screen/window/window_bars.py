"""Horizontal bars of the window: title, lamps, notices, prompt line, comment and function keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QWidget

from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import MessageKind
from app.desk.status.readouts import Lamp
from app.desk.translation import tr
from app.screen.accessible import announce_text
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import (
    ALIGN_CENTER,
    ALIGN_LEFT,
    ALIGN_RIGHT,
    MIN_TEXT_SIZE,
    ScreenTheme,
    ThemedPainter,
    draw_state_symbol,
    draw_text,
    measure_text,
)
from app.screen.text_sizes import TextRole
from app.screen.window.key_table import NO_KEY, YES_KEY
from app.screen.window_layout import ACROSS, FINGERTIP_PX

ANSWER_KEY_WIDTH = 13.0  # Units: width of the touch target of an answer.
# Background color and sign.
MESSAGE_STYLES = {
    MessageKind.REFUSAL: ("pause", "!"),
    MessageKind.SUCCESS: ("run", "✓"),
    MessageKind.QUESTION: ("wait", "?"),
}
# Fractions of the prompt line's height for a message or question of one line and of two lines.
PROMPT_HEIGHT_FRACTION, TWO_LINE_HEIGHT_FRACTION = 0.47, 0.62
# Units: smallest height of the state, and of a message or question, for two lines.
MIN_TWO_LINE_HEIGHT, MIN_TWO_LINE_NOTICE_HEIGHT = 5.0, 3.2
SYMBOL_WIDTH = 5.0  # Units: width of the sign.
_STATE_LEFT, _STATE_WIDTH = 30.0, 92.0  # Units: box of the machine state in the title line.
_CLOCK_WIDTH = 15.0  # Units.
MIN_ONE_LINE_STRETCH = 0.8  # A text that would be drawn narrower in one line is drawn in two lines.


class TitleLine(Panel):
    """The title line, with page, program, machine state, signed-in user, machine name and clock."""

    background_color = "panel"

    page_title = RedrawingAttribute("")
    access_text = RedrawingAttribute("")  # The signed-in user and level; empty if access levels are off.
    _shown = RedrawingAttribute(("", "STARTING", StatusTone.OFF, "", ""))

    @property
    def program_text(self) -> str:
        """Return the text that the title line shows for the program."""
        return self._shown[0]

    @property
    def state_text(self) -> str:
        """Return the displayed state of the machine."""
        return self._shown[1]

    def show_texts(self, program: str, state: str, tone: StatusTone, machine: str, clock: str) -> None:
        """Show these texts in the title line."""
        self._shown = (program, state, tone, machine, clock)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the page title, program, machine state, signed-in user, machine name and clock."""
        program, state, tone, machine, clock = self._shown
        u, high = self.theme.unit_px, self.height()
        painter.fill_rect(QRectF(0, high - 0.16 * u, self.width(), 0.16 * u), "frame")
        upper = QRectF(1.4 * u, 0.1 * u, (_STATE_LEFT - 2.4) * u, 0.5 * high - 0.1 * u)
        lower = upper.translated(0, upper.height())
        painter.draw_text_line(upper, self.page_title, 1.9, "accent")
        painter.draw_text_line(lower, program or tr("NO PROGRAM"), 2.1, "text", raw=True)
        box = self._draw_state(painter, state, tone)
        left = box.right() + 0.8 * u
        for row in (upper, lower):
            row.setLeft(left)
            row.setRight(self.width() - 1.2 * u)
        painter.draw_text_line(upper, machine, 1.8, "soft", at=ALIGN_RIGHT, bold=False)
        painter.draw_text_line(lower, clock, 2.0, "text", at=ALIGN_RIGHT, bold=False)
        if self.access_text:
            lower.setRight(lower.right() - _CLOCK_WIDTH * u)
            painter.draw_text_line(lower, self.access_text, 1.7, "accent")

    def _draw_state(self, painter: ThemedPainter, state: str, tone: StatusTone) -> QRectF:
        """Draw the machine state as large as its distance requires, and return its box."""
        look, u, high, state = self.theme, self.theme.unit_px, self.height(), tr(state)
        box = QRectF(
            _STATE_LEFT * u, 0, max(_STATE_WIDTH * u, self.width() - (ACROSS - _STATE_WIDTH) * u), high
        )
        painter.fill_rect(box.adjusted(0, 0, 0, -0.2 * u), tone.value)
        ink = look.get_color("on_state")
        size = look.find_em_height(2.5, TextRole.STATE, 1.2 * box.height())
        side = max(2.4 * u, 0.5 * high)
        painter.setFont(look.fit_font(state, size, box.width() - 2.5 * u - side, is_bold=True))
        wide = measure_text(state, painter.font())
        left = box.center().x() - (wide + side + 0.8 * u) / 2
        draw_state_symbol(painter, QRectF(left, box.center().y() - side / 2, side, side), tone, ink)
        painter.setPen(ink)
        room = QRectF(left + side + 0.8 * u, box.y(), wide + u, box.height())
        draw_text(painter, room, ALIGN_LEFT, state)
        return box


class PromptLine(Panel):
    """Prompt line with a message and a question in one row, and the machine state below them.

    If there are both a message and a question, each uses half of the row. No text covers another, but a
    message or question of two lines replaces the state unless ``must_show_state`` is True. The question has
    two touch targets (yes and no), which are always at the right end.
    """

    must_show_state = RedrawingAttribute(True)

    state_text, reason_text, question_text, message_text, confirm_key = (
        RedrawingAttribute("") for _ in range(5)
    )
    message_kind: RedrawingAttribute[MessageKind | None] = RedrawingAttribute(None)  # Kind of the message.

    def __init__(
        self, theme: ScreenTheme, press: Callable[[str], None], parent: QWidget | None = None
    ) -> None:
        super().__init__(theme, parent)
        self._press = press
        self._announced = ""

    @property
    def main_text(self) -> str:
        """Return the most important text.

        This is the message if there is one, otherwise the question, and otherwise the state.
        """
        return self.message_text or self.question_text or self.state_text

    def show_state(self, text: str, reason: str = "") -> None:
        """Show what the operator can do now, and why the machine is stopped."""
        self.state_text, self.reason_text = text, reason

    def show_question(self, text: str, confirm_key: str = "") -> None:
        """Show a question.

        ``confirm_key`` is the key that means yes.
        """
        self.question_text, self.confirm_key = text, confirm_key

    def show_message(self, text: str, *, kind: MessageKind | None) -> None:
        """Show a message.

        ``kind`` determines its color and symbol.
        """
        self.message_text, self.message_kind = text, kind

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the message, the question and the state.

        If the main text has changed, a screen reader speaks it.
        """
        area = self.find_full_area()
        painter.fill_rect(area, "panel")
        if self.main_text != self._announced:
            self._announced = self.main_text
            announce_text(self, tr(self.main_text))
        if self.question_text and self.confirm_key:
            area.setRight(
                self._draw_answer_keys(painter, area)
            )  # The targets use the full height, for touch.
        upper = self._find_notice_area(area)
        if upper.bottom() < area.bottom():
            self._state(painter, area.adjusted(0, upper.height(), 0, 0))
        both = bool(self.message_text and self.question_text)
        half = upper.width() / 2
        if self.message_text:
            place = upper.adjusted(0, 0, -half - 2 if both else 0, 0)
            self._notice(painter, place, self.message_text, self.message_kind or MessageKind.REFUSAL)
        if self.question_text:
            place = upper.adjusted(half + 2 if both else 0, 0, 0, 0)
            self._notice(painter, place, self.question_text, MessageKind.QUESTION)

    def _find_notice_area(self, area: QRectF) -> QRectF:
        """Return the part of the prompt line that the message and the question use."""
        shown = [text for text in (self.message_text, self.question_text) if text]
        upper = area.adjusted(0, 0, 0, (PROMPT_HEIGHT_FRACTION - 1.0) * area.height())
        if not shown:
            upper.setHeight(0.0)
        elif len(shown) == 1 and self._needs_two_lines(shown[0], upper):
            upper.setHeight((TWO_LINE_HEIGHT_FRACTION if self.must_show_state else 1.0) * area.height())
        return upper

    def _state(self, painter: ThemedPainter, area: QRectF) -> None:
        u = self.theme.unit_px
        room = area.adjusted(1.4 * u, 0, -1.4 * u, 0)
        if self.reason_text:
            low = room.adjusted(0, 0.48 * room.height(), 0, -0.05 * room.height())
            painter.draw_text_line(low, self.reason_text, 1.9, "text", bold=False, role=TextRole.PROMPT)
            room.setBottom(low.top())
        lines = self._lines(tr(self.state_text), room, MIN_TWO_LINE_HEIGHT)
        high = room.height() / len(lines)
        for number, line in enumerate(lines):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            size = 2.1 if self.reason_text else 2.3
            painter.draw_text_line(row, line, size, "text", raw=True, role=TextRole.PROMPT)

    def _lines(self, text: str, room: QRectF, min_height: float) -> list[str]:
        """Return the text as one line, or as two lines if they can be drawn larger.

        ``min_height`` is the smallest height for two lines in units.
        """
        look, words = self.theme, text.split(" ")
        one = look.find_em_height(2.3, TextRole.PROMPT, room.height())
        two = look.find_em_height(2.3, TextRole.PROMPT, room.height() / 2)
        wide = MIN_ONE_LINE_STRETCH * measure_text(text, look.make_font(one, is_bold=True))
        if (
            len(words) < 2
            or room.height() < min_height * look.unit_px
            or wide <= room.width()
            or two <= one * room.width() / wide
        ):
            return [text]
        cuts = (" ".join(words[:at]) for at in range(1, len(words)))
        first = min(cuts, key=lambda part: abs(2 * len(part) - len(text)))
        return [first, text[len(first) + 1 :].strip()]

    def _needs_two_lines(self, text: str, row: QRectF) -> bool:
        """Return whether a notice is too wide for one line of the prompt line."""
        size = self.theme.find_em_height(2.3, TextRole.PROMPT, row.height())
        wide = MIN_ONE_LINE_STRETCH * measure_text(tr(text), self.theme.make_font(size, is_bold=True))
        return wide > row.width() - (SYMBOL_WIDTH + 1.4) * self.theme.unit_px

    def _notice(self, painter: ThemedPainter, area: QRectF, text: str, sort: MessageKind) -> None:
        u = self.theme.unit_px
        ground, sign = MESSAGE_STYLES[sort]
        painter.fill_rect(area, ground)
        painter.draw_text_line(
            QRectF(area.x(), area.y(), SYMBOL_WIDTH * u, area.height()),
            sign,
            3.0,
            "on_state",
            at=ALIGN_CENTER,
            raw=True,
        )
        room = area.adjusted(SYMBOL_WIDTH * u, 0, -1.4 * u, 0)
        lines = self._lines(tr(text), room, MIN_TWO_LINE_NOTICE_HEIGHT)
        room.setHeight(room.height() / len(lines))
        for number, line in enumerate(lines):
            row = room.translated(0, number * room.height())
            painter.draw_text_line(row, line, 2.3, "on_state", raw=True, role=TextRole.PROMPT)

    def _draw_answer_keys(self, painter: ThemedPainter, area: QRectF) -> float:
        """Draw the targets for yes and no at the right end.

        Return the x coordinate at which the question must end.
        """
        u = self.theme.unit_px
        left = area.right() - 2 * ANSWER_KEY_WIDTH * u
        for number, (word, key) in enumerate((("YES", YES_KEY), ("NO", NO_KEY))):
            box = QRectF(
                left + number * ANSWER_KEY_WIDTH * u, area.y(), (ANSWER_KEY_WIDTH - 0.6) * u, area.height()
            )
            self.key(painter, box, word, 2.1, partial(self._press, key))
        return left - 0.6 * u


class CommentLine(Panel):
    """Display of the program's last comment, in the lower left corner."""

    title = "COMMENT"
    text = RedrawingAttribute("")

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the last comment of the program."""
        u = self.theme.unit_px
        room = self.find_full_area().adjusted(
            1.4 * u, (self.theme.title_height - 0.3) * u, -1.2 * u, -0.2 * u
        )
        painter.draw_text_line(room, self.text, 2.0, "accent", bold=False, raw=True)


class FunctionKeyBar(Panel):
    """The function keys F1 to F10, each with a label of up to eight characters.

    Each key is a touch target.
    """

    accessible_name = "FUNCTION KEYS"
    key_labels: RedrawingAttribute[tuple[str, ...]] = RedrawingAttribute(
        ("",) * 10
    )  # An empty label means no key.
    disabled_keys: RedrawingAttribute[frozenset[str]] = RedrawingAttribute(
        frozenset()
    )  # Disabled keys, which are drawn dim.

    def __init__(
        self, theme: ScreenTheme, press: Callable[[int], None], parent: QWidget | None = None
    ) -> None:
        super().__init__(theme, parent)
        self._press = press

    def draw(self, painter: ThemedPainter) -> None:
        """Draw each function key that has a label, with disabled keys in a softer color."""
        u = self.theme.unit_px
        gap = 0.6 * u
        wide = (self.width() + gap) / len(self.key_labels)
        for number, label in enumerate(self.key_labels, 1):
            if not label:
                continue
            box = QRectF((number - 1) * wide, 0, wide - gap, self.height())
            barred = f"F{number}" in self.disabled_keys
            painter.fill_rect(box, "panel" if barred else "key")
            high = 0.47 * box.height()
            upper = QRectF(box.x(), box.y() + 0.03 * box.height(), box.width(), high)
            painter.draw_text_line(upper, f"F{number}", 1.8, "soft" if barred else "accent", at=ALIGN_CENTER)
            lower = upper.translated(0, high)
            painter.draw_text_line(
                lower, label, 2.1, "soft" if barred else "text", at=ALIGN_CENTER, margin=0.4
            )
            self.add_target(box, partial(self._press, number), is_disabled=barred)


# --- lamps --------------------------------------------------------------------------------------------


class LampStrip(Panel):
    """Row of indicator lamps.

    A lit lamp is filled and an unlit lamp is hollow, so that they can be distinguished without color.
    """

    accessible_name = "LAMPS"
    lamps: RedrawingAttribute[tuple[Lamp, ...]] = RedrawingAttribute(())
    hidden_keys: RedrawingAttribute[frozenset[str]] = RedrawingAttribute(
        frozenset()
    )  # Keys that are text input now. The lamps react to touch only.

    def __init__(
        self, theme: ScreenTheme, press: Callable[[str], None], parent: QWidget | None = None
    ) -> None:
        super().__init__(theme, parent)
        self._press = press

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the lamps in one row, and make each lamp with a key a touch target."""
        u = self.theme.unit_px
        gap = 0.6 * u
        wide = (self.width() + gap) / max(1, len(self.lamps))
        for number, lamp in enumerate(self.lamps):
            box = QRectF(number * wide, 0, wide - gap, self.height())
            self._lamp(painter, box, lamp)
            if lamp.switch_key:
                self.add_target(box, partial(self._press, lamp.switch_key), kind="lamp", is_on=lamp.is_lit)

    def _lamp(self, painter: ThemedPainter, box: QRectF, lamp: Lamp) -> None:
        look, u = self.theme, self.theme.unit_px
        lit = "pause" if lamp.is_warning else "lit"
        line = lit if lamp.is_lit else "frame"
        inset = look.make_pen(line, 0.14).widthF() / 2
        painter.draw_box(
            box.adjusted(inset, inset, -inset, -inset), line, 0.14, lit if lamp.is_lit else "panel"
        )
        ink = ("on_state" if lamp.is_warning else "on_lit") if lamp.is_lit else "soft"
        room = box.adjusted(0.4 * u, 0.4 * u, -0.4 * u, -0.4 * u)
        words = tr(lamp.label).split(" ", 1)
        room.setHeight(room.height() / len(words))
        rows = [room.translated(0, number * room.height()) for number in range(len(words))]
        if lamp.switch_key and lamp.switch_key not in self.hidden_keys:
            rows[-1].setLeft(self._draw_switch_key(painter, rows[-1], lamp.switch_key, ink))
        for row, word in zip(rows, words, strict=True):
            painter.draw_text_line(row, word, 1.75, ink, at=ALIGN_CENTER)

    def _draw_switch_key(self, painter: ThemedPainter, row: QRectF, key: str, ink: str) -> float:
        """Draw the key of a lamp at the left end of a row, and return where the label can begin."""
        u, high = self.theme.unit_px, min(row.height() - 2, self.theme.find_line_height(3.0))
        cap = QRectF(row.x() + 0.1 * u, row.center().y() - high / 2, max(2.4 * u, 0.8 * high), high)
        painter.setPen(self.theme.get_color(ink))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(cap)
        painter.draw_text_line(cap, key, 1.75, ink, at=ALIGN_CENTER)
        return cap.right() + 0.2 * u


# --- notices ------------------------------------------------------------------------------------------


NOTICE_ROW, NOTICE_KEY = 5.0, 17.0  # Units: height of a row, width of a key.
LOW_NOTICE_HEIGHT = 4.5  # Units: height of a row without keys.
CAPTION_HEIGHT, CAPTION_TEXT = 8.0, 3.4  # Units: height of a caption row and of its text.
_THREE_LINE_HEIGHT = 6.0  # Units: height of a row with room for three lines.


class NoticeRows(Panel):
    """Rows with notices and touch keys, each filled with the color for the kind of notice."""

    notice_rows: RedrawingAttribute[tuple[NoticeRow, ...]] = RedrawingAttribute(())

    def __init__(
        self, theme: ScreenTheme, press: Callable[[str], None], parent: QWidget | None = None
    ) -> None:
        super().__init__(theme, parent)
        self._press = press
        self._stand_for = 0

    @property
    def needed_height_px(self) -> int:
        """Return the height in pixels that the rows need."""
        return sum(self._find_row_height(row) for row in self.notice_rows)

    def _find_row_height(self, row: NoticeRow) -> int:
        """Return the height of a row in pixels.

        A row with keys is at least as high as a fingertip. A row without keys has two lines of text.
        """
        u = self.theme.unit_px
        if not row.keys:
            return round((CAPTION_HEIGHT if row.is_caption else LOW_NOTICE_HEIGHT) * u)
        wide = self._find_text_width(row, self.width())
        fits = measure_text(row.values_text, self.theme.fit_font(row.values_text, 1.7, wide)) <= wide
        return max(FINGERTIP_PX + 2, round(NOTICE_ROW * u) if fits else round(_THREE_LINE_HEIGHT * u) + 3)

    def _find_text_width(self, row: NoticeRow, wide: float) -> float:
        """Return the width that the keys of a row leave for its texts."""
        return wide - (len(row.keys) * NOTICE_KEY + 2.4) * self.theme.unit_px

    @property
    def needs_new_height(self) -> bool:
        """Return whether the rows need a height that differs from their current height."""
        return self.needed_height_px != self._stand_for

    def apply_needed_height(self) -> int:
        """Accept the height that the rows need as their current height, and return it in pixels."""
        self._stand_for = self.needed_height_px
        return self.needed_height_px

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the notices one below another. If the area is too low, the rows are less high."""
        share, top = (
            self.height() / max(1, self.needed_height_px),
            0.0,
        )  # The rows may get less height than they need.
        for row in self.notice_rows:
            high = share * self._find_row_height(row)
            self._row(painter, QRectF(0, top, self.width(), high - 2), row)
            top += high

    def _row(self, painter: ThemedPainter, box: QRectF, row: NoticeRow) -> None:
        u = self.theme.unit_px
        painter.fill_rect(box, row.color_name)
        wide = self._find_text_width(row, box.width())
        lines = [row.values_text] if row.values_text else []
        if box.height() > _THREE_LINE_HEIGHT * u and not row.is_caption:
            lines = _wrap_lines(row.values_text, self.theme.fit_font(row.values_text, 1.7, wide), wide)
        upper = QRectF(box.x() + 1.2 * u, box.y(), wide, box.height() * (1.0, 0.52, 0.4)[len(lines)])
        if row.is_caption and lines:
            upper.setHeight(0.64 * box.height())
        size, role = (CAPTION_TEXT, TextRole.PROMPT) if row.is_caption else (2.0, TextRole.TABLE)
        painter.draw_text_line(upper, row.text, size, "on_state", raw=True, role=role)
        high = (box.height() - upper.height()) / max(1, len(lines))
        for number, line in enumerate(lines):
            below = QRectF(upper.x(), upper.bottom() + number * high, wide, high)
            painter.draw_text_line(
                below, line, 1.7 if len(lines) == 1 else MIN_TEXT_SIZE, "on_state", bold=False, raw=True
            )
        for number, (name, label) in enumerate(row.keys):
            x = box.right() - (len(row.keys) - number) * NOTICE_KEY * u
            self._key(painter, QRectF(x, box.y(), NOTICE_KEY * u - 0.6 * u, box.height()), name, label)

    def _key(self, painter: ThemedPainter, box: QRectF, name: str, label: str) -> None:
        u = self.theme.unit_px
        painter.fill_rect(box, "key")
        key = name.replace("Shift+", "⇧")
        painter.draw_text_line(QRectF(box.x() + 0.8 * u, box.y(), 3.2 * u, box.height()), key, 1.8, "accent")
        painter.draw_text_line(
            box.adjusted(3.8 * u, 0, -0.4 * u, 0), label, 1.8, "text", at=ALIGN_CENTER, margin=0.2
        )
        self.add_target(box, partial(self._press, name))


def _wrap_lines(text: str, font: QFont, wide: float) -> list[str]:
    """Return the text in one line, or in two lines if it is too wide.

    The second line may still be elided.
    """
    if not text or measure_text(text, font) <= wide:
        return [text] if text else []
    words, first = text.split(" "), ""
    while words and measure_text(f"{first} {words[0]}".strip(), font) <= wide:
        first = f"{first} {words.pop(0)}".strip()
    return [first, " ".join(words)] if first else [text]
