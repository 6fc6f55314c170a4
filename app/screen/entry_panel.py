"""What all entries of figures look like: what is asked, what was typed, old → new, and keys for fingers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QFontMetricsF, QPainter
from PySide6.QtWidgets import QLineEdit, QWidget

from app.screen.look import CENTRE, LEFT, Look, put, put_raw
from app.screen.panel import Panel


@dataclass(frozen=True, slots=True)
class EntryWords:
    """What an entry shows: which, question, typed text, old → new, and what other keys do."""

    which: str = ""
    question: str = ""
    text: str = ""
    change: str = ""
    foot: str = ""


class EntryPanel(Panel):
    """Redrawn when one of its words has changed."""

    ground = "panel"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.asked = EntryWords()

    def show_entry(self, asked: EntryWords) -> None:
        """Show these words; redraw when one of them is another."""
        if asked != self.asked:
            self.asked = asked
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u, asked = self.look, self.look.u, self.asked
        room = self.area().adjusted(1.4 * u, 0.4 * u, -1.4 * u, -0.3 * u)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(asked.which, 1.9, 27 * u))
        put(painter, QRectF(room.x(), room.y(), 27 * u, 3.2 * u), LEFT, asked.which)
        left = 28 * u if asked.which else 0.0
        change = QRectF(room.x() + left, room.y(), room.width() - left, 3.2 * u)
        painter.setPen(look.colour("accent"))
        painter.setFont(look.fit(asked.change, 2.0, change.width(), bold=True))
        put(painter, change, LEFT, asked.change)
        self._ask(painter, QRectF(room.x(), room.y() + 3.5 * u, room.width(), 4.8 * u))
        painter.setPen(look.colour("soft"))
        painter.setFont(look.fit(asked.foot, 1.8, room.width()))
        put(painter, QRectF(room.x(), room.bottom() - 3.0 * u, room.width(), 3.0 * u), LEFT, asked.foot)

    def _ask(self, painter: QPainter, row: QRectF) -> None:
        look, u, asked = self.look, self.look.u, self.asked
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(asked.question, 2.4, 36 * u, bold=True))
        put(painter, QRectF(row.x(), row.y(), 36 * u, row.height()), LEFT, asked.question)
        if not asked.question:
            return
        box = row.adjusted(37 * u, 0.2 * u, 0, -0.2 * u)
        draw_entry_box(painter, look, box, asked.text)


def draw_entry(
    painter: QPainter, look: Look, inside: QRectF, text: str, *, size: float = 2.8, cursor: bool = True
) -> None:
    """What is typed, in letters of ``size`` units, and the bar behind it."""
    u = look.u
    font = look.fit(text, size, inside.width() - u, bold=True)
    painter.setFont(font)
    painter.setPen(look.colour("text"))
    put_raw(painter, inside, LEFT, text)
    if cursor:
        at = inside.x() + min(QFontMetricsF(font).horizontalAdvance(text), inside.width() - u) + 0.3 * u
        high = (size + 0.2) * u
        painter.fillRect(QRectF(at, inside.center().y() - high / 2, 0.3 * u, high), look.colour("accent"))


def draw_entry_box(painter: QPainter, look: Look, box: QRectF, text: str, size: float = 2.8) -> None:
    """A frame to type in, and what is typed."""
    painter.setPen(look.pen("accent", 0.2))
    painter.setBrush(look.colour("ground"))
    painter.drawRect(box)
    draw_entry(painter, look, box.adjusted(look.u, 0, -look.u, 0), text, size=size)


def dress_line(edit: QLineEdit, look: Look, size: float, left: float) -> None:
    """A stock line to type in, in font and colours of now; ``left`` units before its text."""
    u, colours = look.u, look.palette
    edit.setFont(look.font(size, bold=True))
    edit.setStyleSheet(
        f"QLineEdit {{ background: {colours.ground}; color: {colours.text};"
        f" border: {max(1, round(0.2 * u))}px solid {colours.accent}; padding-left: {round(left * u)}px;"
        f" selection-background-color: {colours.lit}; selection-color: {colours.on_lit}; }}"
    )


# --- the keys of a finger ----------------------------------------------------------------------------------


_KEYS = (
    ("7", "8", "9", "/"),
    ("4", "5", "6", "*"),
    ("1", "2", "3", "-"),
    ("0", ".", "(", "+"),
    ("C", "Esc", ")", "Back"),
)
_SHOWN = {"-": "−", "*": "×", "/": "÷", "Back": "DEL", "Enter": "RETURN"}
_FREE = "C"  # the place that a page gives its own meaning


class KeyPad(Panel):
    """Every key does what the key of the keyboard does."""

    def __init__(
        self, look: Look, press: Callable[[str], None], *, own: tuple[str, str] | None, parent: QWidget
    ) -> None:
        """``own``: a key of this page and the word on it; None leaves its place empty."""
        super().__init__(look, parent)
        self._press, self._own = press, own

    def draw(self, painter: QPainter) -> None:
        u = self.look.u
        gap = 0.6 * u
        high = (self.height() + gap) / (len(_KEYS) + 1)
        wide = (self.width() + gap) / len(_KEYS[0])
        for row, keys in enumerate(_KEYS):
            for column, key in enumerate(keys):
                box = QRectF(column * wide, row * high, wide - gap, high - gap)
                if key != _FREE:
                    self._key(painter, box, key, _SHOWN.get(key, key.upper()))
                elif self._own is not None:
                    self._key(painter, box, *self._own)
        foot = QRectF(0, len(_KEYS) * high, self.width(), high - gap)
        self._key(painter, foot, "Enter", _SHOWN["Enter"])

    def _key(self, painter: QPainter, box: QRectF, key: str, shown: str) -> None:
        look = self.look
        figure = key.isdigit() or key == "."
        painter.fillRect(box, look.colour("key"))
        painter.setPen(look.colour("text" if figure else "accent"))
        painter.setFont(look.fit(shown, 3.0, box.width() - look.u, bold=True))
        put(painter, box, CENTRE, shown)
        self.place(box, partial(self._press, key))
