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
