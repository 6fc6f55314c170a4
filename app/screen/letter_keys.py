"""Drawn keyboards for fingers: of names and searches, and of what programs are written with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QEvent, QRectF, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.translation import tr
from app.screen.look import Look, Painter
from app.screen.panel import Panel

Rows = Sequence[Sequence[str]]
NAMES: Rows = ("1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm._ ", ("Esc", "Back", "Enter"))
NAMES_WIDE: Rows = (
    (*"1234567890", "Back"),
    (*"qwertyuiop", "Enter"),
    (*"asdfghjkl-", "Esc"),
    "zxcvbnm._ ",
)  # where the whole width is free: a row less leaves more of a list
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
)  # of MDI: no row is longer than fingers allow beside the modal state
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
    """Every key does what the key of the keyboard does; hidden until somebody asks for it."""

    part_name = "KEYBOARD"

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget, rows: Rows = NAMES) -> None:
        super().__init__(look, parent)
        self._press, self._rows = press, rows
        self.hide()

    @property
    def least(self) -> int:
        """Height in which every key takes a finger, pixels."""
        return self.look.keys_high(len(self._rows))

    def write_into(self, field: QWidget) -> None:
        """A finger on a key leaves a stock field the keyboard, which Qt would give to the window."""
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
    """A key of ``PROGRAMS`` goes down and comes up in a widget, as one of the keyboard would."""
    code = _CODES.get(key)
    text = "\r" if key == "Enter" else "" if code is not None else key
    number = code if code is not None else Qt.Key(ord(key))
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
        QApplication.sendEvent(target, QKeyEvent(kind, number, Qt.KeyboardModifier.NoModifier, text))
