"""Thirty-two secondary offsets in two columns of sixteen."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.formats import length
from app.desk.offsets.figures import Mode, signed
from app.desk.words import tr
from app.screen.look import LEFT, RIGHT, Look, put
from app.screen.panel import Panel
from core.store.rows import SecondaryRow

ROWS = 16
# Shares of a column: where the number, and each letter with its figure, end.
_NUMBER, _X, _Z = 0.09, 0.42, 0.73


class OffsetTable(Panel):
    """Each row is a target for a finger. The row being changed is filled, the last changed has a bar."""

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose
        self.offsets: Mapping[int, SecondaryRow] = {}
        self._number = 0
        self._marked: frozenset[int] = frozenset()
        self._mode = Mode()

    def show_offsets(
        self, offsets: Mapping[int, SecondaryRow], number: int, marked: Collection[int], mode: Mode
    ) -> None:
        """The table, the row that is being changed (0: none), those changed last, and the unit."""
        shown = (offsets, number, frozenset(marked), mode)
        if shown != (self.offsets, self._number, self._marked, self._mode):
            self.offsets, self._number, self._marked, self._mode = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        unit = tr("MM") if self._mode.metric else tr("INCH")
        self.frame(painter, f"{tr('SECONDARY OFFSETS  ·  X STORED AS A RADIUS')}  ·  {unit}")
        room = self.inside().adjusted(-0.6 * self.look.u, 0, 0.6 * self.look.u, 0.4 * self.look.u)
        high, gap = room.height() / ROWS, 2.0 * self.look.u
        wide = (room.width() - gap) / 2
        for number in range(1, 2 * ROWS + 1):
            column, row = divmod(number - 1, ROWS)
            box = QRectF(room.x() + column * (wide + gap), room.y() + row * high, wide, high)
            self._row(painter, box, number)
            self.place(box, partial(self._choose, number))

    def _row(self, painter: QPainter, box: QRectF, number: int) -> None:
        look, u = self.look, self.look.u
        here = number == self._number
        if here:
            painter.fillRect(box, look.colour("here"))
        if number in self._marked:
            painter.fillRect(QRectF(box.x(), box.y(), 0.5 * u, box.height()), look.colour("lit"))
        offset = self.offsets.get(number)
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(1.9, bold=True))
        wide = box.width()
        put(painter, QRectF(box.x(), box.y(), _NUMBER * wide - u, box.height()), RIGHT, str(number))
        self._figures(painter, box, offset or SecondaryRow(), bold=here or offset is not None)

    def _figures(self, painter: QPainter, box: QRectF, offset: SecondaryRow, bold: bool) -> None:
        x, z, r = offset
        metric, wide = self._mode.metric, box.width()
        cells = (
            ("X:", signed(x, metric), _NUMBER, _X),
            ("Z:", signed(z, metric), _X, _Z),
            ("R:", length(r, metric), _Z, 1.0),
        )
        u = self.look.u
        for letter, figure, left, right in cells:
            at = QRectF(box.x() + left * wide, box.y(), (right - left) * wide - 1.2 * u, box.height())
            self._cell(painter, at, letter, figure, bold)

    def _cell(self, painter: QPainter, at: QRectF, letter: str, figure: str, bold: bool) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.8, bold=True))
        put(painter, QRectF(at.x(), at.y(), 2.4 * u, at.height()), LEFT, letter)
        painter.setPen(look.colour("text" if bold else "soft"))
        room = at.adjusted(2.4 * u, 0, 0, 0)
        painter.setFont(look.fit(figure, 2.0, room.width(), bold=bold))
        put(painter, room, RIGHT, figure)
