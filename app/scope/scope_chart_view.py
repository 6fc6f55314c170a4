"""Chart of the scope, with one plot (lane) per quantity, stacked over a common time axis."""

from __future__ import annotations

from collections.abc import Sequence

import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.scope.curve_points import CurvePoints
from app.scope.scope_curves import ScopeCurve, ScopePicture
from app.scope.signals import Quantity
from app.scope.time_window import TimeCursors
from app.screen.chart import Chart, ChartPlot, find_curve_color, make_line_pen, set_curve_points
from app.screen.screen_theme import ScreenTheme

_LEFT_AXIS_WIDTH = 8.6  # units: width of the axis values at the left
_HIGH, _STEP = 0.66, 1.0  # ratios: height of a logic curve and spacing between two
_OVERLAY_COLOR_SHARE = 0.45  # share of its color that the curve of an earlier record has
_TEXT_SIZE = 1.5  # units
_ALIGN_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class ScopeChart(Chart):
    """Chart of the scope.

    ``show_picture`` draws a picture. If the picture contains other quantities than before, the lanes are
    created again.
    """

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._lanes: dict[Quantity, ChartPlot] = {}
        self._curves: dict[tuple[str, bool], pg.PlotCurveItem] = {}
        self._known: object = None  # signals for which lanes and curves exist
        self._waiting: list[Quantity] = []  # lanes that are still to be created
        self.picture = ScopePicture()
        self.cursors = TimeCursors()
        self.curve_colors: dict[str, int] = {}  # number of the color by signal key

    # --- drawing -------------------------------------------------------------------------------------

    def show_picture(self, picture: ScopePicture, cursors: TimeCursors) -> bool:
        """Draw a prepared picture, and return whether it was drawn.

        The result is False while lanes are still being created. The caller then repeats the call.
        """
        if not (self.prepare_plots(len(_quantities(picture))) and self._prepare_lanes(picture)):
            return False
        self.picture, self.cursors = picture, cursors
        for quantity, plot in self._lanes.items():
            low, high = picture.lane_ranges.get(quantity, (0.0, 1.0))
            if quantity is Quantity.LOGIC_LEVEL:
                low, high = -_STEP * self._count(picture.curves) + _HIGH, 1.0
            plot.vb.setXRange(picture.begin_s, picture.end_s, padding=0)
            plot.vb.setYRange(low, high, padding=0)
        place = 0
        for curve in picture.curves:
            down = 0.0
            if curve.signal.quantity is Quantity.LOGIC_LEVEL:
                down, place = -_STEP * place, place + 1
            self._draw(curve, False, down)
        for curve in picture.overlay_curves:
            if curve.signal.quantity is not Quantity.LOGIC_LEVEL:
                self._draw(curve, True, 0.0)
        self.viewport().update()
        return True

    def _draw(self, curve: ScopeCurve, earlier: bool, down: float) -> None:
        item = self._curves.get((curve.signal.key, earlier))
        if item is None:
            return
        points = curve.points
        values = points.values
        if curve.signal.quantity is Quantity.LOGIC_LEVEL:
            values = values * _HIGH + down
        set_curve_points(item, points.times_s, values, _connect(points))

    def _prepare_lanes(self, sight: ScopePicture) -> bool:
        """Return whether lanes and curves match the picture.

        Each call creates at most one lane.
        """
        shown = [*((each, True) for each in sight.overlay_curves), *((each, False) for each in sight.curves)]
        known = tuple((each.signal.key, earlier) for each, earlier in shown)
        if known != self._known:
            self._known, self._waiting = known, _quantities(sight)
            self.viewport().setUpdatesEnabled(False)
            self.remove_plots()
            self._lanes.clear()
            self._curves.clear()
            self.curve_colors = {each.signal.key: number for number, each in enumerate(sight.curves)}
        if self._waiting:
            self._make_lane(self._waiting.pop(0), shown)
        if not self._waiting:
            self.viewport().setUpdatesEnabled(True)
        return not self._waiting

    def _make_lane(self, quantity: Quantity, shown: list[tuple[ScopeCurve, bool]]) -> None:
        """Create the lane of a quantity with its curves."""
        plot = self._lanes[quantity] = self.add_plot()
        plot.find_axis("bottom").setVisible(not self._waiting)
        plot.find_axis("left").setStyle(showValues=quantity is not Quantity.LOGIC_LEVEL)
        for each, earlier in shown:
            if each.signal.quantity is quantity:
                self._curves[each.signal.key, earlier] = plot.add_curve(
                    make_line_pen(self._ink(each, earlier))
                )
        self.set_left_axis_width(_LEFT_AXIS_WIDTH)

    def _ink(self, curve: ScopeCurve, earlier: bool) -> QColor:
        full = find_curve_color(self.theme, self.curve_colors.get(curve.signal.key, 0))
        return mix_colors(full, self.theme.get_color("panel"), _OVERLAY_COLOR_SHARE) if earlier else full

    def apply_theme(self) -> None:
        """Apply the current colors and fonts.

        The next picture rebuilds the chart.
        """
        super().apply_theme()
        self._known = None

    @staticmethod
    def _count(curves: Sequence[ScopeCurve]) -> int:
        return sum(each.signal.quantity is Quantity.LOGIC_LEVEL for each in curves)

    # --- coordinates ---------------------------------------------------------------------------------

    @property
    def curve_area(self) -> QRectF:
        """Return the area of the curves across all lanes, in pixels of the chart."""
        rooms = [plot.find_curve_area() for plot in self.plots]
        return rooms[0].united(rooms[-1]) if rooms else QRectF()

    def find_time(self, position: QPointF) -> float:
        """Return the time at a horizontal chart position, in seconds relative to the picture's zero time."""
        room, sight = self.curve_area, self.picture
        share = (position.x() - room.x()) / max(1.0, room.width())
        return sight.begin_s + share * (sight.end_s - sight.begin_s)

    def find_column(self, time_s: float) -> float:
        """Return the horizontal position of a time in the chart, in pixels."""
        room, sight = self.curve_area, self.picture
        return room.x() + (time_s - sight.begin_s) / (sight.end_s - sight.begin_s) * room.width()

    def find_quantity(self, position: QPointF) -> Quantity | None:
        """Return the quantity of the lane at a chart position, or None if there is no lane."""
        found = (
            each for each, plot in self._lanes.items() if plot.find_curve_area().bottom() >= position.y()
        )
        return next(found, None)

    # --- over the curves -----------------------------------------------------------------------------

    def drawForeground(self, painter: QPainter, rect: QRectF) -> None:
        """Draw the names of the lanes, the zero time of a record, and the cursors."""
        super().drawForeground(painter, rect)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        if not self.plots or not self.curve_area.width():
            return
        for quantity, plot in self._lanes.items():
            self._lane(painter, quantity, plot.find_curve_area())
        sight, room, u = self.picture, self.curve_area, self.theme.unit_px
        painter.setPen(self.theme.get_color("soft"))
        painter.drawText(
            QRectF(room.right() - 2 * u, room.bottom() + 0.4 * u, 2 * u, 2 * u), _ALIGN_RIGHT, "s"
        )
        if not sight.is_live and sight.begin_s < 0.0 < sight.end_s:
            self._upright(painter, 0.0, "pause", "0")
        if self.cursors.shown:
            for number, (time, word) in enumerate(zip(self.cursors.times_s, "AB", strict=True)):
                if room.x() <= self.find_column(time) <= room.right():
                    self._upright(
                        painter, time, "accent" if number == self.cursors.active_index else "soft", word
                    )

    def _lane(self, painter: QPainter, quantity: Quantity, room: QRectF) -> None:
        u = self.theme.unit_px
        painter.setFont(self.theme.make_font(_TEXT_SIZE, is_bold=True))
        if quantity is Quantity.LOGIC_LEVEL:
            logic = [each for each in self.picture.curves if each.signal.quantity is quantity]
            high = room.height() / max(1, len(logic))
            for number, curve in enumerate(logic):
                painter.setPen(find_curve_color(self.theme, self.curve_colors.get(curve.signal.key, 0)))
                painter.drawText(
                    QPointF(room.x() + 0.6 * u, room.y() + (number + 0.62) * high), curve.signal.title
                )
            return
        unit = quantity.unit(self.picture.is_metric)
        text = tr(quantity.title) + (f"  {unit}" if unit else "")
        self.name(painter, text, room)

    def _upright(self, painter: QPainter, time: float, ink: str, word: str) -> None:
        u, room, x = self.theme.unit_px, self.curve_area, round(self.find_column(time))
        painter.setPen(make_line_pen(self.theme.get_color(ink)))
        painter.drawLine(x, round(room.y()), x, round(room.bottom()))
        box = QRectF(x - 1.0 * u, room.y(), 2.0 * u, 2.2 * u)
        painter.fillRect(box, self.theme.get_color(ink))
        painter.setPen(self.theme.get_color("panel"))
        painter.setFont(self.theme.make_font(_TEXT_SIZE, is_bold=True))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, word)


def _quantities(sight: ScopePicture) -> list[Quantity]:
    """Return the quantities of a picture's lanes from top to bottom, with inputs and outputs last."""
    found = list(dict.fromkeys(each.signal.quantity for each in sight.curves))
    return sorted(found, key=lambda each: each is Quantity.LOGIC_LEVEL)


def _connect(points: CurvePoints) -> object:
    if points.has_line_pairs:
        return "pairs"
    return "all" if points.is_joined_to_next is None else points.is_joined_to_next


def mix_colors(foreground: QColor, background: QColor, foreground_fraction: float) -> QColor:
    """Return a mix of two colors.

    An opaque mixed color is used because opaque lines are drawn faster than transparent lines.
    """
    parts = (
        (foreground.red(), background.red()),
        (foreground.green(), background.green()),
        (foreground.blue(), background.blue()),
    )
    return QColor(*(round(foreground_fraction * a + (1.0 - foreground_fraction) * b) for a, b in parts))
