"""The list of special functions: a number, a name, what it is for; each a target for a finger."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.special.special import SpecialDesk
from app.screen.look import CENTRE, LEFT, Look, put
from app.screen.panel import Panel

ROW = 7.0  # units at most: a fingertip


class ItemList(Panel):
    """The one that is shown is filled; it has a bar while the keys are its own."""

    title = "SPECIAL FUNCTIONS"

    def __init__(self, look: Look, model: SpecialDesk, enter: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self.model, self._enter = model, enter
        self._shown: tuple[int, bool] | None = None

    def show_items(self) -> None:
        """Redraw when the mark has moved."""
        shown = (self.model.at, self.model.inside)
        if shown != self._shown:
            self._shown = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        room, sections = self.inside(), self.model.sections
        high = min(room.height() / max(1, len(sections)), ROW * self.look.u)
        for number, section in enumerate(sections):
            box = QRectF(room.x(), room.y() + number * high, room.width(), high - 0.4 * self.look.u)
            self._item(painter, box, number, section.name, section.use)
            self.place(box, partial(self._enter, number))

    def _item(self, painter: QPainter, box: QRectF, number: int, name: str, use: str) -> None:
        look, u = self.look, self.look.u
        here = number == self.model.at
        painter.fillRect(box, look.colour("here" if here else "key"))
        if here:
            wide = (1.0 if self.model.inside else 0.4) * u
            painter.fillRect(QRectF(box.x(), box.y(), wide, box.height()), look.colour("lit"))
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(2.6, bold=True))
        put(painter, QRectF(box.x() + u, box.y(), 3.6 * u, box.height()), CENTRE, str(number + 1))
        text = box.adjusted(5.2 * u, 0.1 * box.height(), -0.6 * u, -0.1 * box.height())
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(name, 2.0, text.width(), bold=True))
        put(painter, QRectF(text.x(), text.y(), text.width(), 0.55 * text.height()), LEFT, name)
        painter.setPen(look.colour("text" if here else "soft"))
        painter.setFont(look.fit(use, 1.6, text.width()))
        below = QRectF(text.x(), text.y() + 0.55 * text.height(), text.width(), 0.45 * text.height())
        put(painter, below, LEFT, use)
