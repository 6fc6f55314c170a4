"""Thirty-two offsets in two columns of sixteen."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.formats import length
from app.desk.offsets.dialogue import Mode
from app.desk.offsets.figures import NOT_SET, Triple, signed
from app.screen.look import LEFT, RIGHT, Look, put
from app.screen.panel import Panel

ROWS = 16
# Shares of a column: where the number, and each letter with its figure, end.
_NUMBER, _X, _Z = 0.09, 0.42, 0.73


class OffsetTable(Panel):
    """Each row is a target for a finger. The row being changed is filled, the last changed has a bar."""

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose
        self.offsets: Mapping[int, Triple] = {}
        self._number = 0
        self._marked: frozenset[int] = frozenset()
        self._mode = Mode()
        self.tools = False

    def show_offsets(
        self, offsets: Mapping[int, Triple], number: int, marked: Collection[int], mode: Mode
    ) -> None:
        """The table, the row that is being changed (0: none), those changed last, unit and Ø or R."""
        shown = (offsets, number, frozenset(marked), mode)
        if shown != (self.offsets, self._number, self._marked, self._mode):
            self.offsets, self._number, self._marked, self._mode = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        unit = "MM" if self._mode.metric else "INCH"
        self.frame(painter, f"{self._title()}  ·  {unit}")
        room = self.inside().adjusted(-0.6 * self.look.u, 0, 0.6 * self.look.u, 0.4 * self.look.u)
        high, gap = room.height() / ROWS, 2.0 * self.look.u
        wide = (room.width() - gap) / 2
        for number in range(1, 2 * ROWS + 1):
            column, row = divmod(number - 1, ROWS)
            box = QRectF(room.x() + column * (wide + gap), room.y() + row * high, wide, high)
            self._row(painter, box, number)
            self.place(box, partial(self._choose, number))

    def _title(self) -> str:
        if not self.tools:
            return "SECONDARY OFFSETS  ·  X STORED AS A RADIUS"
        return f"TOOL OFFSETS  ·  X IS A {'DIAMETER' if self._mode.diameter else 'RADIUS'}"

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
        if offset is None and self.tools:
            painter.setPen(look.colour("soft"))
            painter.setFont(look.font(1.9))
            put(painter, box.adjusted(_NUMBER * wide, 0, 0, 0), LEFT, NOT_SET)
            return
        self._figures(painter, box, offset or (0.0, 0.0, 0.0), bold=here or offset is not None)

    def _figures(self, painter: QPainter, box: QRectF, offset: Triple, bold: bool) -> None:
        x, z, r = offset
        metric, wide = self._mode.metric, box.width()
        doubled = self.tools and self._mode.diameter
        mark = ("Ø" if doubled else "R") if self.tools else ""
        cells = (
            ("X" if mark else "X:", mark, signed(2 * x if doubled else x, metric), _NUMBER, _X),
            ("Z:", "", signed(z, metric), _X, _Z),
            ("R:", "", length(r, metric), _Z, 1.0),
        )
        u = self.look.u
        for letter, sign, figure, left, right in cells:
            at = QRectF(box.x() + left * wide, box.y(), (right - left) * wide - 1.2 * u, box.height())
            self._cell(painter, at, letter, sign, figure, bold)

    def _cell(self, painter: QPainter, at: QRectF, letter: str, mark: str, figure: str, bold: bool) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.8, bold=True))
        put(painter, QRectF(at.x(), at.y(), 2.4 * u, at.height()), LEFT, letter)
        if mark:
            self._mark(painter, QRectF(at.x() + 1.7 * u, at.center().y() - u, 2.0 * u, 2.0 * u), mark)
        painter.setPen(look.colour("text" if bold else "soft"))
        room = at.adjusted((4.0 if mark else 2.4) * u, 0, 0, 0)
        painter.setFont(look.fit(figure, 2.0, room.width(), bold=bold))
        put(painter, room, RIGHT, figure)

    def _mark(self, painter: QPainter, box: QRectF, mark: str) -> None:
        look = self.look
        filled = mark == "Ø"
        painter.setPen(look.pen("mark", 0.14))
        painter.setBrush(look.colour("mark") if filled else Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        painter.setPen(look.colour("on_mark" if filled else "mark"))
        painter.setFont(look.font(1.5, bold=True))
        put(painter, box, Qt.AlignmentFlag.AlignCenter, mark)
