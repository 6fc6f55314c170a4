"""Chart of the scope: one lane per quantity, one below the other, over a common time axis."""

from __future__ import annotations

from collections.abc import Sequence

import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.scope.scope_curves import Curve, Points, Sight
from app.scope.signals import Quantity
from app.scope.time_window import Cursors
from app.screen.chart import Chart, Plot, curve_colour, line_pen, set_curve
from app.screen.look import Look

_LEFT = 8.6  # units: width of the axis values at the left
_HIGH, _STEP = 0.66, 1.0  # ratios: height of a logic curve and spacing between two
_DIM = 0.45  # share of its color that the curve of an earlier record has
_LETTERS = 1.5  # units
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class ScopeChart(Chart):
    """Chart of the scope.

    ``show_sight`` draws a picture, and other quantities rebuild the lanes.
    """

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._lanes: dict[Quantity, Plot] = {}
        self._curves: dict[tuple[str, bool], pg.PlotCurveItem] = {}
        self._known: object = None  # signals for which lanes and curves exist
        self._waiting: list[Quantity] = []  # lanes that are still to be created
        self.sight = Sight()
        self.cursors = Cursors()
        self.colours: dict[str, int] = {}  # number of the color by signal key

    # --- drawing -------------------------------------------------------------------------------------

    def show_sight(self, sight: Sight, cursors: Cursors) -> bool:
        """Draw a prepared picture and return whether it was drawn.

        The result is False while lanes are still being created, and the caller then repeats the call.
        """
        if not (self.ready(len(_quantities(sight))) and self._made_for(sight)):
            return False
        self.sight, self.cursors = sight, cursors
        for quantity, plot in self._lanes.items():
            low, high = sight.ranges.get(quantity, (0.0, 1.0))
            if quantity is Quantity.LOGIC:
                low, high = -_STEP * self._count(sight.curves) + _HIGH, 1.0
            plot.vb.setXRange(sight.begin, sight.end, padding=0)
            plot.vb.setYRange(low, high, padding=0)
        place = 0
        for curve in sight.curves:
            down = 0.0
            if curve.signal.quantity is Quantity.LOGIC:
                down, place = -_STEP * place, place + 1
            self._draw(curve, False, down)
        for curve in sight.earlier:
            if curve.signal.quantity is not Quantity.LOGIC:
                self._draw(curve, True, 0.0)
        self.viewport().update()
        return True

    def _draw(self, curve: Curve, earlier: bool, down: float) -> None:
        item = self._curves.get((curve.signal.key, earlier))
        if item is None:
            return
        points = curve.points
        values = points.values
        if curve.signal.quantity is Quantity.LOGIC:
            values = values * _HIGH + down
        set_curve(item, points.times, values, _connect(points))

    def _made_for(self, sight: Sight) -> bool:
        """Return whether lanes and curves match the picture. Each call creates one lane."""
        shown = [*((each, True) for each in sight.earlier), *((each, False) for each in sight.curves)]
        known = tuple((each.signal.key, earlier) for each, earlier in shown)
        if known != self._known:
            self._known, self._waiting = known, _quantities(sight)
            self.viewport().setUpdatesEnabled(False)
            self.empty()
            self._lanes.clear()
            self._curves.clear()
            self.colours = {each.signal.key: number for number, each in enumerate(sight.curves)}
        if self._waiting:
            self._make(self._waiting.pop(0), shown)
        if not self._waiting:
            self.viewport().setUpdatesEnabled(True)
        return not self._waiting

    def _make(self, quantity: Quantity, shown: list[tuple[Curve, bool]]) -> None:
        """Create the lane of a quantity with its curves."""
        plot = self._lanes[quantity] = self.add()
        plot.axis("bottom").setVisible(not self._waiting)
        plot.axis("left").setStyle(showValues=quantity is not Quantity.LOGIC)
        for each, earlier in shown:
            if each.signal.quantity is quantity:
                self._curves[each.signal.key, earlier] = plot.curve(line_pen(self._ink(each, earlier)))
        self.share_left(_LEFT)

    def _ink(self, curve: Curve, earlier: bool) -> QColor:
        full = curve_colour(self.look, self.colours.get(curve.signal.key, 0))
        return mixed(full, self.look.colour("panel"), _DIM) if earlier else full

    def dress(self) -> None:
        """Apply the present colors and fonts. The next picture rebuilds the chart."""
        super().dress()
        self._known = None

    @staticmethod
    def _count(curves: Sequence[Curve]) -> int:
        return sum(each.signal.quantity is Quantity.LOGIC for each in curves)

    # --- coordinates ---------------------------------------------------------------------------------

    @property
    def room(self) -> QRectF:
        """Area of the curves across all lanes, in pixels of the chart."""
        rooms = [plot.room() for plot in self.plots]
        return rooms[0].united(rooms[-1]) if rooms else QRectF()

    def time_at(self, place: QPointF) -> float:
        """Return the time at a chart position, in seconds of the window."""
        room, sight = self.room, self.sight
        share = (place.x() - room.x()) / max(1.0, room.width())
        return sight.begin + share * (sight.end - sight.begin)

    def across(self, instant: float) -> float:
        """Return the horizontal chart position of a time, in pixels."""
        room, sight = self.room, self.sight
        return room.x() + (instant - sight.begin) / (sight.end - sight.begin) * room.width()

    def quantity_at(self, place: QPointF) -> Quantity | None:
        """Return the quantity of the lane at a chart position, or None."""
        found = (each for each, plot in self._lanes.items() if plot.room().bottom() >= place.y())
        return next(found, None)

    # --- over the curves -----------------------------------------------------------------------------

    def drawForeground(self, painter: QPainter, rect: QRectF) -> None:
        """Draw the names of the lanes, instant 0 of a record, and the cursors."""
        super().drawForeground(painter, rect)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        if not self.plots or not self.room.width():
            return
        for quantity, plot in self._lanes.items():
            self._lane(painter, quantity, plot.room())
        sight, room, u = self.sight, self.room, self.look.u
        painter.setPen(self.look.colour("soft"))
        painter.drawText(QRectF(room.right() - 2 * u, room.bottom() + 0.4 * u, 2 * u, 2 * u), _RIGHT, "s")
        if not sight.live and sight.begin < 0.0 < sight.end:
            self._upright(painter, 0.0, "pause", "0")
        if self.cursors.shown:
            for number, (time, word) in enumerate(zip(self.cursors.times, "AB", strict=True)):
                if room.x() <= self.across(time) <= room.right():
                    self._upright(painter, time, "accent" if number == self.cursors.at else "soft", word)

    def _lane(self, painter: QPainter, quantity: Quantity, room: QRectF) -> None:
        u = self.look.u
        painter.setFont(self.look.font(_LETTERS, bold=True))
        if quantity is Quantity.LOGIC:
            logic = [each for each in self.sight.curves if each.signal.quantity is quantity]
            high = room.height() / max(1, len(logic))
            for number, curve in enumerate(logic):
                painter.setPen(curve_colour(self.look, self.colours.get(curve.signal.key, 0)))
                painter.drawText(
                    QPointF(room.x() + 0.6 * u, room.y() + (number + 0.62) * high), curve.signal.title
                )
            return
        unit = quantity.unit(self.sight.metric)
        text = tr(quantity.title) + (f"  {unit}" if unit else "")
        self.name(painter, text, room)

    def _upright(self, painter: QPainter, time: float, ink: str, word: str) -> None:
        u, room, x = self.look.u, self.room, round(self.across(time))
        painter.setPen(line_pen(self.look.colour(ink)))
        painter.drawLine(x, round(room.y()), x, round(room.bottom()))
        box = QRectF(x - 1.0 * u, room.y(), 2.0 * u, 2.2 * u)
        painter.fillRect(box, self.look.colour(ink))
        painter.setPen(self.look.colour("panel"))
        painter.setFont(self.look.font(_LETTERS, bold=True))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, word)


def _quantities(sight: Sight) -> list[Quantity]:
    """Return the lanes of a picture from top to bottom, with inputs and outputs last."""
    found = list(dict.fromkeys(each.signal.quantity for each in sight.curves))
    return sorted(found, key=lambda each: each is Quantity.LOGIC)


def _connect(points: Points) -> object:
    if points.pairs:
        return "pairs"
    return "all" if points.joined is None else points.joined


def mixed(ink: QColor, ground: QColor, share: float) -> QColor:
    """Return a mix of two colors. Opaque lines are drawn faster than transparent lines."""
    parts = ((ink.red(), ground.red()), (ink.green(), ground.green()), (ink.blue(), ground.blue()))
    return QColor(*(round(share * a + (1.0 - share) * b) for a, b in parts))
