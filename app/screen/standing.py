"""What must stay in sight on every page until somebody has done something: rows under the lamps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.layout import FINGER
from app.screen.look import CENTRE, LEFT, Look, put, put_raw
from app.screen.panel import Panel

ROW, KEY = 5.0, 17.0  # units: height of a row, width of a key


@dataclass(frozen=True, slots=True)
class Row:
    """A bold text, figures under it, and keys at its right: name and label."""

    text: str
    figures: str = ""
    keys: tuple[tuple[str, str], ...] = ()


class StandingRows(Panel):
    """Filled in the colour of what waits for an operator; a finger on a key presses it."""

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self.rows: tuple[Row, ...] = ()
        self._stand_for = 0

    @property
    def high(self) -> int:
        """Pixels that the rows need."""
        return len(self.rows) * max(FINGER, round(ROW * self.look.u))

    @property
    def other_room(self) -> bool:
        """Whether there are more or fewer rows than have been given room."""
        return len(self.rows) != self._stand_for

    def take_room(self) -> int:
        """They have what they need from now on: how many pixels."""
        self._stand_for = len(self.rows)
        return self.high

    def show_rows(self, rows: Sequence[Row]) -> None:
        """Other rows."""
        before, self.rows = self.rows, tuple(rows)
        if before != self.rows:
            self.update()

    def draw(self, painter: QPainter) -> None:
        high = self.height() / max(1, len(self.rows))
        for number, row in enumerate(self.rows):
            self._row(painter, QRectF(0, number * high, self.width(), high - 2), row)

    def _row(self, painter: QPainter, box: QRectF, row: Row) -> None:
        look, u = self.look, self.look.u
        painter.fillRect(box, look.colour("pause"))
        painter.setPen(look.colour("on_state"))
        wide = box.width() - len(row.keys) * KEY * u - 2.4 * u
        upper = QRectF(box.x() + 1.2 * u, box.y(), wide, box.height() * (0.52 if row.figures else 1.0))
        painter.setFont(look.fit(row.text, 2.0, wide, bold=True))
        put_raw(painter, upper, LEFT, row.text)
        if row.figures:
            painter.setFont(look.fit(row.figures, 1.7, wide))
            put_raw(painter, upper.translated(0, upper.height()), LEFT, row.figures)
        for number, (name, label) in enumerate(row.keys):
            x = box.right() - (len(row.keys) - number) * KEY * u
            self._key(painter, QRectF(x, box.y(), KEY * u - 0.6 * u, box.height()), name, label)

    def _key(self, painter: QPainter, box: QRectF, name: str, label: str) -> None:
        look, u = self.look, self.look.u
        painter.fillRect(box, look.colour("key"))
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(1.8, bold=True))
        put(painter, QRectF(box.x() + 0.8 * u, box.y(), 3.2 * u, box.height()), LEFT, name)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(tr(label), 1.8, box.width() - 4.4 * u, bold=True))
        put(painter, box.adjusted(3.8 * u, 0, -0.4 * u, 0), CENTRE, label)
        self.place(box, lambda: self._press(name))
