"""Input fields with a question and the entered text, and touch keyboards."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

from PySide6.QtCore import QEvent, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QKeyEvent
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget

from app.desk.pages.sheet import RefusedText
from app.desk.translation import tr
from app.screen.look import Look, Painter
from app.screen.panel import Panel, Shown

Rows = Sequence[Sequence[str]]
NAMES: Rows = ("1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm._ ", ("Esc", "Back", "Enter"))
NAMES_WIDE: Rows = (
    (*"1234567890", "Back"),
    (*"qwertyuiop", "Enter"),
    (*"asdfghjkl-", "Esc"),
    "zxcvbnm._ ",
)  # For the full width. One row fewer leaves more room for a list.
PROGRAMS: Rows = (
    (*"1234567890-.", "Back"),
    (*"QWERTYUIOP()", "Enter"),
    (*"ASDFGHJKL+/}", "Up"),
    (*"ZXCVBNM=~ ", "Left", "Right", "Down"),
)
LINES: Rows = (
    "1234567890-.",
    "QWERTYUIOP()",
    "ASDFGHJKL+/}",
    "ZXCVBNM=~ ",
    ("Back", "Left", "Right", "Up", "Down", "Enter"),
)  # For MDI. The rows are short enough to fit next to the modal state.
_CODES = {
    "Back": Qt.Key.Key_Backspace,
    "Enter": Qt.Key.Key_Return,
    "Up": Qt.Key.Key_Up,
    "Down": Qt.Key.Key_Down,
    "Left": Qt.Key.Key_Left,
    "Right": Qt.Key.Key_Right,
}
_ARROWS = {"Up": "↑", "Down": "↓", "Left": "←", "Right": "→"}


class LetterPad(Panel):
    """A touch keyboard whose keys act like keys of the keyboard. It is hidden at first."""

    part_name = "KEYBOARD"

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget, rows: Rows = NAMES) -> None:
        super().__init__(look, parent)
        self._press, self._rows = press, rows
        self.hide()

    @property
    def least(self) -> int:
        """The height in pixels at which every key is large enough for a fingertip."""
        return self.look.keys_high(len(self._rows))

    def write_into(self, field: QWidget) -> None:
        """Keep the focus in this standard field when a key is touched.

        Otherwise Qt would give the focus to the window.
        """
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setFocusProxy(field)

    def draw(self, painter: Painter) -> None:
        gap = 0.6 * self.look.u
        high = (self.height() + gap) / len(self._rows)
        for row, keys in enumerate(self._rows):
            wide = (self.width() + gap) / len(keys)
            for column, key in enumerate(keys):
                self.draw_key(painter, QRectF(column * wide, row * high, wide - gap, high - gap), key)

    def draw_key(self, painter: Painter, box: QRectF, key: str) -> None:
        """Draw one key."""
        words = {"Esc": "ESC", "Back": tr("DEL"), "Enter": tr("ENTER"), " ": tr("SPACE"), **_ARROWS}
        shown = words.get(key, key)
        ink = "text" if key.isalnum() and len(key) == 1 else "accent"
        self.key(painter, box, shown, 2.8, partial(self._press, key), ink=ink, raw=True, margin=0.4)


def strike(key: str, target: QWidget) -> None:
    """Send the press and release of a key of ``PROGRAMS`` to a widget, like a real key."""
    code = _CODES.get(key)
    text = "\r" if key == "Enter" else "" if code is not None else key
    number = code if code is not None else Qt.Key(ord(key))
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
        QApplication.sendEvent(target, QKeyEvent(kind, number, Qt.KeyboardModifier.NoModifier, text))


@dataclass(frozen=True, slots=True)
class EntryWords:
    """The texts of an entry.

    They are its subject, question, input text, change (old → new) and a hint for other keys.
    """

    which: str = ""
    question: str = ""
    text: str = ""
    change: str = ""
    foot: str = ""
    refused: bool = field(init=False)  # The next character replaces the text.

    def __post_init__(self) -> None:
        object.__setattr__(self, "refused", isinstance(self.text, RefusedText))


class EntryPanel(Panel):
    """A panel with one input field. It is redrawn when one of its texts changes."""

    ground = "panel"
    asked = Shown(EntryWords())

    def draw(self, painter: Painter) -> None:
        u, asked = self.look.u, self.asked
        room = self.area().adjusted(1.4 * u, 0.4 * u, -1.4 * u, -0.3 * u)
        painter.write(QRectF(room.x(), room.y(), 27 * u, 3.2 * u), asked.which, 1.9, "text", bold=False)
        left = 28 * u if asked.which else 0.0
        change = QRectF(room.x() + left, room.y(), room.width() - left, 3.2 * u)
        painter.write(change, asked.change, 2.0, "accent")
        self._ask(painter, QRectF(room.x(), room.y() + 3.5 * u, room.width(), 4.8 * u))
        room.setTop(room.bottom() - 3.0 * u)
        painter.write(room, asked.foot, 1.8, "soft", bold=False)

    def _ask(self, painter: Painter, row: QRectF) -> None:
        u, asked = self.look.u, self.asked
        painter.write(QRectF(row.x(), row.y(), 36 * u, row.height()), asked.question, 2.4, "text")
        if not asked.question:
            return
        box = row.adjusted(37 * u, 0.2 * u, 0, -0.2 * u)
        draw_entry_box(painter, box, asked.text)


def draw_entry(
    painter: Painter, inside: QRectF, text: str, *, size: float = 2.8, cursor: bool = True
) -> None:
    """Draw an input text, ``size`` units high, with a caret if the field has the keyboard.

    A rejected text is drawn as selected, because the next character replaces it.
    """
    u, selected = painter.look.u, painter.look.caret and isinstance(text, RefusedText)
    painter.setFont(painter.look.fit(text, size, inside.width() - u, bold=True))
    wide = min(QFontMetricsF(painter.font()).horizontalAdvance(text), inside.width() - u)
    high = (size + 0.2) * u
    if selected:
        painter.fill(QRectF(inside.x(), inside.center().y() - high / 2, wide, high), "lit")
    painter.write(inside, text, size, "on_lit" if selected else "text", raw=True, margin=1.0)
    if cursor and painter.look.caret:
        at = inside.x() + wide + 0.3 * u
        painter.fill(QRectF(at, inside.center().y() - high / 2, 0.3 * u, high), "accent")


def draw_entry_box(painter: Painter, box: QRectF, text: str, size: float = 2.8) -> None:
    """Draw an input field with its frame and text."""
    painter.box(box, "accent", 0.2, "ground")
    draw_entry(painter, box.adjusted(painter.look.u, 0, -painter.look.u, 0), text, size=size)


def dress_line(edit: QLineEdit, look: Look, size: float, left: float) -> None:
    """Apply the present font and colors to a line edit, with ``left`` units of padding before its text."""
    u, colours = look.u, look.palette
    edit.setFont(look.font(size, bold=True))
    edit.setStyleSheet(
        f"QLineEdit {{ background: {colours.ground}; color: {colours.text};"
        f" border: {max(1, round(0.2 * u))}px solid {colours.accent}; padding-left: {round(left * u)}px;"
        f" selection-background-color: {colours.lit}; selection-color: {colours.on_lit}; }}"
    )


# --- number pad --------------------------------------------------------------------------------------------


_FREE = "C"  # The key to which a page gives its own meaning.
_KEYS: Rows = ("789/", "456*", "123-", "0.(+", (_FREE, "Esc", ")", "Back"), ("Enter",))
_SHOWN = {"-": "−", "*": "×", "/": "÷", "Back": "DEL", "Enter": "ENTER"}


class KeyPad(LetterPad):
    """A touch keyboard for numbers and arithmetic."""

    part_name = "NUMBER PAD"
    own: Shown[tuple[str, str] | None] = Shown(None)  # Key name and label of the page's own key.

    def __init__(
        self, look: Look, press: Callable[[str], None], *, own: tuple[str, str] | None, parent: QWidget
    ) -> None:
        """Create the pad. ``own`` is the name and label of the page's own key, or None for an empty place."""
        super().__init__(look, press, parent, _KEYS)
        self.own = own
        self.show()

    def draw_key(self, painter: Painter, box: QRectF, key: str) -> None:
        """Draw one key. The place of the page's own key remains empty without such a key."""
        key, shown = (self.own or ("", "")) if key == _FREE else (key, _SHOWN.get(key, key.upper()))
        if key:
            ink = "text" if key.isdigit() or key == "." else "accent"
            self.key(painter, box, shown, 3.0, partial(self._press, key), ink=ink, margin=1.0)
