"""The lit words: modes with the keys that switch them, what is on, and the two keys that make ready again."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.lamps import Lamp
from app.desk.words import tr
from app.screen.look import CENTRE, Look, put
from app.screen.panel import Panel


class Strip(Panel):
    """A row of words. Lit is filled and dark is hollow, so that the difference needs no colour."""

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._press = press
        self._lamps: tuple[Lamp, ...] = ()
        self.mute: frozenset[str] = frozenset()  # keys that are text now: the finger's alone

    def show_lamps(self, lamps: Sequence[Lamp], mute: frozenset[str] = frozenset()) -> None:
        """The words from left to right; the keys that are ``mute`` are not shown."""
        if (tuple(lamps), mute) != (self._lamps, self.mute):
            self._lamps, self.mute = tuple(lamps), mute
            self.update()

    def draw(self, painter: QPainter) -> None:
        u = self.look.u
        gap = 0.6 * u
        wide = (self.width() + gap) / max(1, len(self._lamps))
        for number, lamp in enumerate(self._lamps):
            box = QRectF(number * wide, 0, wide - gap, self.height())
            self._lamp(painter, box, lamp)
            if lamp.key:
                self.place(box, self._presser(lamp.key))

    def _lamp(self, painter: QPainter, box: QRectF, lamp: Lamp) -> None:
        look, u = self.look, self.look.u
        lit = "pause" if lamp.warn else "lit"
        line = look.pen(lit if lamp.lit else "frame", 0.14)
        inset = line.widthF() / 2
        painter.setPen(line)
        painter.setBrush(look.colour(lit) if lamp.lit else look.colour("panel"))
        painter.drawRect(box.adjusted(inset, inset, -inset, -inset))
        ink = look.colour(("on_state" if lamp.warn else "on_lit") if lamp.lit else "soft")
        painter.setBrush(Qt.BrushStyle.NoBrush)
        room = box.adjusted(0.5 * u, 0.5 * u, -0.5 * u, -0.5 * u)
        if lamp.key and lamp.key not in self.mute:
            cap = QRectF(room.x() + 0.1 * u, room.center().y() - 1.5 * u, 2.6 * u, 3.0 * u)
            painter.setPen(ink)
            painter.setFont(look.font(2.2, bold=True))
            painter.drawRect(cap)
            put(painter, cap, CENTRE, lamp.key)
            room.setLeft(cap.right() + 0.4 * u)
        painter.setPen(ink)
        words = tr(lamp.word).split(" ", 1)
        high = room.height() / 2 if len(words) > 1 else room.height()
        for number, word in enumerate(words):
            painter.setFont(look.fit(word, 1.75, room.width(), bold=True))
            put(painter, QRectF(room.x(), room.y() + number * high, room.width(), high), CENTRE, word)

    def _presser(self, key: str) -> Callable[[], None]:
        return lambda: self._press(key)
