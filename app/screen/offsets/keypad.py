"""A pad of large keys, so that an offset can be entered with a finger alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.screen.look import CENTRE, Look, put
from app.screen.panel import Panel

_KEYS = (
    ("7", "8", "9", "/"),
    ("4", "5", "6", "*"),
    ("1", "2", "3", "-"),
    ("0", ".", "(", "+"),
    ("C", "Esc", ")", "Back"),
)
_SHOWN = {"-": "−", "*": "×", "/": "÷", "Back": "DEL", "Enter": "RETURN"}


class KeyPad(Panel):
    """Every key does what the key of the keyboard does."""

    def __init__(self, look: Look, press: Callable[[str], None], *, clears: bool, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press, self._clears = press, clears

    def draw(self, painter: QPainter) -> None:
        u = self.look.u
        gap = 0.6 * u
        high = (self.height() + gap) / (len(_KEYS) + 1)
        wide = (self.width() + gap) / len(_KEYS[0])
        for row, keys in enumerate(_KEYS):
            for column, key in enumerate(keys):
                if key != "C" or self._clears:
                    self._key(painter, QRectF(column * wide, row * high, wide - gap, high - gap), key)
        self._key(painter, QRectF(0, len(_KEYS) * high, self.width(), high - gap), "Enter")

    def _key(self, painter: QPainter, box: QRectF, key: str) -> None:
        look = self.look
        figure = key.isdigit() or key == "."
        painter.fillRect(box, look.colour("key"))
        painter.setPen(look.colour("text" if figure else "accent"))
        shown = _SHOWN.get(key, key.upper())
        painter.setFont(look.fit(shown, 3.0, box.width() - look.u, bold=True))
        put(painter, box, CENTRE, shown)
        self.place(box, partial(self._press, key))
