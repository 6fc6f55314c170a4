"""A drawn keyboard for fingers: the letters, figures and signs that programs use, shown on demand."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QEvent, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QPainter
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.words import tr
from app.screen.look import CENTRE, Look, put_raw
from app.screen.panel import Panel

ROWS = (
    (*"1234567890-.", "Back"),
    (*"QWERTYUIOP()", "Enter"),
    (*"ASDFGHJKL+/}", "Up"),
    (*"ZXCVBNM=~", "Space", "Left", "Right", "Down"),
)
HIGH = 29.0  # units: four rows, each of a finger's height
_GAP = 0.6
_ARROWS = {"Up": "↑", "Down": "↓", "Left": "←", "Right": "→"}
_KEYS = {
    "Back": Qt.Key.Key_Backspace,
    "Enter": Qt.Key.Key_Return,
    "Space": Qt.Key.Key_Space,
    "Up": Qt.Key.Key_Up,
    "Down": Qt.Key.Key_Down,
    "Left": Qt.Key.Key_Left,
    "Right": Qt.Key.Key_Right,
}


class LetterPad(Panel):
    """Every key does what the key of the keyboard does in the field that it writes into."""

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.hide()

    def write_into(self, field: QWidget) -> None:
        """From now on; a finger on a key leaves it the keyboard, which Qt would give to the window."""
        self.setFocusProxy(field)

    def draw(self, painter: QPainter) -> None:
        gap = _GAP * self.look.u
        high, wide = (self.height() + gap) / len(ROWS), (self.width() + gap) / len(ROWS[0])
        for row, keys in enumerate(ROWS):
            for column, key in enumerate(keys):
                box = QRectF(column * wide, row * high, wide - gap, high - gap)
                self._key(painter, box, key)

    def _key(self, painter: QPainter, box: QRectF, key: str) -> None:
        look = self.look
        painter.fillRect(box, look.colour("key"))
        painter.setPen(look.colour("text" if key.isalnum() and len(key) == 1 else "accent"))
        words = {"Back": tr("DEL"), "Enter": tr("RETURN"), "Space": tr("SPACE"), **_ARROWS}
        shown = words.get(key, key)
        painter.setFont(look.fit(shown, 3.0, box.width() - 0.6 * look.u, bold=True))
        put_raw(painter, box, CENTRE, shown)
        self.place(box, partial(self._press, key))


def strike(key: str, target: QWidget) -> None:
    """A key goes down and comes up in a widget; letters are capitals, as programs are written."""
    code = _KEYS.get(key)
    text = {"Space": " ", "Enter": "\r"}.get(key, "" if code is not None else key)
    number = code if code is not None else Qt.Key(ord(key))
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
        QApplication.sendEvent(target, QKeyEvent(kind, number, Qt.KeyboardModifier.NoModifier, text))
