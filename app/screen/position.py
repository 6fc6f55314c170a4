"""The large figures: X with its mark, Z, C, and a second smaller figure beside each."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.readout import AxisView, PositionView
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Panel

FIGURES = 9  # −12.34567
LATHE_ROWS = 3
ROOMY = 6.3  # units of height that figures of the full size need


class PositionPanel(Panel):
    """The readout. X is marked by a filled Ø or a hollow R, so that one is never taken for the other."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._view: PositionView | None = None

    @property
    def readout(self) -> str:
        """What the large figures are."""
        return self._view.readout.value if self._view else ""

    def show_position(self, view: PositionView) -> None:
        """All figures at once: they belong to one instant and one unit."""
        if view != self._view:
            self._view = view
            self.update()

    def draw(self, painter: QPainter) -> None:
        view = self._view
        if view is None:
            self.frame(painter, "POSITION")
            return
        u = self.look.u
        self.frame(painter, f"{view.readout.value}  ·  {view.unit}  ·  {view.x_words}")
        self._heading(painter, view)
        room = QRectF(0, 3.0 * u, self.width(), self.height() - 3.6 * u)
        high = min(room.height() / len(view.axes), 10.5 * u)
        top = room.center().y() - high * len(view.axes) / 2
        for row, axis in enumerate(view.axes):
            self._row(painter, QRectF(0, top + row * high, room.width(), high), axis)
            if row:
                line = QRectF(1.2 * u, top + row * high, room.width() - 2.4 * u, max(1.0, 0.08 * u))
                painter.fillRect(line, self.look.colour("key"))

    def _heading(self, painter: QPainter, view: PositionView) -> None:
        look, u = self.look, self.look.u
        painter.setFont(look.font(1.5, bold=True))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(0, 1.8 * u, self.width() - 1.6 * u, 2.0 * u), RIGHT, view.beside.value)

    def _row(self, painter: QPainter, row: QRectF, axis: AxisView) -> None:
        look, u = self.look, self.look.u
        share = self._share(row)
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(5.6 * share, bold=True))
        put(painter, QRectF(1.8 * u, row.y(), 5.6 * u, row.height()), LEFT, axis.name)
        if axis.mark:
            self._mark(painter, QRectF(7.2 * u, row.center().y() - 2.8 * u, 5.2 * u, 5.6 * u), axis.mark)
        painter.setPen(look.colour("text" if axis.homed else "soft"))
        painter.setFont(look.font(7.0 * share, bold=True))
        put(painter, QRectF(12.6 * u, row.y(), 39.0 * u, row.height()), RIGHT, axis.value)
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(2.7 * max(share, 0.8)))
        put(painter, QRectF(52.4 * u, row.y(), self.width() - 54.0 * u, row.height()), RIGHT, axis.beside)
        if not axis.homed:
            painter.setPen(look.colour("alarm"))
            painter.setFont(look.font(1.5, bold=True))
            at = QRectF(52.4 * u, row.y() + 0.6 * u, self.width() - 54.0 * u, 2.0 * u)
            put(painter, at, RIGHT, "NOT HOMED")

    def _share(self, row: QRectF) -> float:
        """Of the full size: five axes of a mill leave less room than three of a lathe."""
        few = self._view is None or len(self._view.axes) <= LATHE_ROWS
        return 1.0 if few else min(1.0, row.height() / (ROOMY * self.look.u))

    def _mark(self, painter: QPainter, box: QRectF, mark: str) -> None:
        look, u = self.look, self.look.u
        filled = mark == "Ø"
        painter.setPen(look.pen("mark", 0.4))
        painter.setBrush(look.colour("mark") if filled else Qt.BrushStyle.NoBrush)
        painter.drawRect(box.adjusted(0.2 * u, 0.2 * u, -0.2 * u, -0.2 * u))
        painter.setPen(look.colour("on_mark" if filled else "mark"))
        painter.setFont(look.font(4.6, bold=True))
        put(painter, box, CENTRE, mark)
