"""A keyboard of large keys, so that a name or a search can be typed with a finger alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.screen.look import CENTRE, Look, put, put_raw
from app.screen.panel import Panel

_ROWS = ("1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm._ ")
_LAST = (("Esc", "ESC"), ("Back", "DEL"), ("Enter", "RETURN"))


class LetterPad(Panel):
    """Every key does what the key of the keyboard does."""

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press
        self.hide()

    def draw(self, painter: QPainter) -> None:
        gap = 0.5 * self.look.u
        high = (self.height() + gap) / (len(_ROWS) + 1)
        for row, keys in enumerate(_ROWS):
            wide = (self.width() + gap) / len(keys)
            for column, key in enumerate(keys):
                box = QRectF(column * wide, row * high, wide - gap, high - gap)
                self._key(painter, box, key, "SPACE" if key == " " else key)
        wide = (self.width() + gap) / len(_LAST)
        for column, (key, word) in enumerate(_LAST):
            self._key(painter, QRectF(column * wide, len(_ROWS) * high, wide - gap, high - gap), key, word)

    def _key(self, painter: QPainter, box: QRectF, key: str, shown: str) -> None:
        look = self.look
        painter.fillRect(box, look.colour("key"))
        painter.setPen(look.colour("text" if len(key) == 1 else "accent"))
        painter.setFont(look.fit(shown, 2.4, box.width() - 0.4 * look.u, bold=True))
        (put_raw if len(shown) == 1 else put)(painter, box, CENTRE, shown)
        self.place(box, partial(self._press, key))
