"""Draws control charts and trends by pyqtgraph; imported when the first of them is opened."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.extras.quality.section import ChartDrawing, Curve, Level, Plot
from app.screen import chart
from app.screen.chart import Chart, curve_colour, line_pen, set_curve
from app.screen.look import CENTRE, Look, Painter, put_raw

_STYLES = {
    "centre": Qt.PenStyle.SolidLine,
    "limit": Qt.PenStyle.DashLine,
    "tolerance": Qt.PenStyle.DotLine,
}
_INKS = {"centre": "soft", "limit": "pause", "tolerance": "alarm"}
_ROOM = 0.08  # of the height, above and below what is drawn
_TITLE = 2.2  # units
_PLOTS = 2  # of a drawing, mostly


class PlotsPane(QWidget):
    """The plots of one drawing with their titles; drawn anew when it is another one, a size or a theme."""

    part_name = "CHART"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.look = look
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._chart = Chart(look, self)
        self._bars = BarsPane(look, self)
        self._shown: ChartDrawing | None = None
        self._theme = ""
        self._u = 0.0

    def ahead(self) -> bool:
        """Make one plot more of those that a drawing may have; whether all are there."""
        return self._chart.ready(_PLOTS)

    def show_drawing(self, drawing: ChartDrawing) -> None:
        """Draw it where it is another one than before."""
        look = self.look
        if drawing == self._shown and (self._theme, self._u) == (look.palette.name, look.u):
            return
        plots = [plot for plot in drawing.plots if not plot.empty]
        barred = bool(plots) and bool(plots[0].bars)
        if not (barred or self._chart.ready(len(plots))):
            return
        self._shown, self._theme, self._u = drawing, look.palette.name, look.u
        self._bars.plot = plots[0] if barred else None
        self._bars.setVisible(barred or not plots)
        self._bars.update()
        self._chart.setVisible(bool(plots) and not barred)
        self._chart.empty()
        if not barred:
            across = [float(each) for plot in plots for curve in plot.curves for each in curve.x]
            for plot in plots:
                self._draw(plot, (min(across), max(across)))
        self._chart.dress()
        self._chart.share_left(9.0)
        for drawn in self._chart.plots:
            drawn.layout.activate()  # else a hidden window keeps the room of before
        self._lay_out()

    def dress(self) -> None:
        """The theme has changed: what is drawn is drawn anew."""
        if self._shown is not None:
            self.show_drawing(self._shown)

    def showEvent(self, _event: QShowEvent) -> None:
        """What was drawn while it was hidden has no layout: the next frame draws it anew."""
        self._shown = None

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """All of it is the chart's."""
        self._lay_out()
        self.dress()

    def _lay_out(self) -> None:
        self._chart.setGeometry(0, 0, self.width(), self.height())
        self._bars.setGeometry(0, 0, self.width(), self.height())

    # --- one plot ------------------------------------------------------------------------------------

    def _draw(self, plot: Plot, across: tuple[float, float]) -> None:
        drawn = self._chart.add()
        drawn.axis("bottom").setLabel(plot.across)
        for curve in plot.curves:
            self._curve(drawn, curve)
        self._range(drawn, plot, across)
        self._title(drawn, plot.title)
        for level in plot.levels:
            self._level(drawn, level)
        if plot.marks:
            x, y = (np.asarray(each) for each in zip(*plot.marks, strict=True))
            pen = line_pen(self.look.colour("alarm"))
            pen.setWidthF(2.0)
            ring = pg.ScatterPlotItem(x=x, y=y, symbol="o", size=2.2 * self.look.u, brush=None, pen=pen)
            drawn.put(ring)

    def _curve(self, drawn: chart.Plot, curve: Curve) -> None:
        colour = curve_colour(self.look, curve.number)
        x, y = curve.x, curve.y
        if curve.steps and len(x) > 1:
            x, y = np.repeat(x, 2)[1:], np.repeat(y, 2)[:-1]
        set_curve(drawn.curve(line_pen(colour)), x, y)
        if curve.dots:
            dots = pg.ScatterPlotItem(
                x=curve.x, y=curve.y, symbol="o", size=1.0 * self.look.u, pen=None, brush=colour
            )
            drawn.put(dots)
        if curve.name and len(curve.x):
            label = pg.TextItem(curve.name, color=colour, anchor=(1.1, 0.5))
            label.setFont(self.look.font(1.7, bold=True))
            label.setPos(float(curve.x[-1]), float(curve.y[-1]))
            drawn.put(label)

    def _level(self, drawn: chart.Plot, level: Level) -> None:
        pen = line_pen(self.look.colour(_INKS[level.kind]), _STYLES[level.kind])
        drawn.put(pg.InfiniteLine(level.value, angle=0, pen=pen))

    def _range(self, drawn: chart.Plot, plot: Plot, across: tuple[float, float]) -> None:
        """All points and levels, with room for the title; plots stand exactly over one another."""
        values = [float(each) for curve in plot.curves for each in curve.y]
        values += [level.value for level in plot.levels]
        low, high = min(values), max(values)
        room = _ROOM * (high - low) or max(abs(high) * 0.01, 1e-4)
        drawn.vb.setYRange(low - room, high + 4.5 * room, padding=0)
        side = max(0.5, 0.02 * (across[1] - across[0]))
        drawn.vb.setXRange(across[0] - side, across[1] + side, padding=0)

    def _title(self, drawn: chart.Plot, words: str) -> None:
        """In the upper corner, over what is drawn, on a ground of its own: no limit strikes it out."""
        (left, _), (_, top) = drawn.vb.viewRange()
        ground = self.look.colour("panel")
        title = pg.TextItem(words, color=self.look.colour("text"), anchor=(0.0, 0.0), fill=ground)
        title.setZValue(10.0)
        title.setFont(self.look.font(1.8, bold=True))
        title.setPos(left, top)
        drawn.put(title)


class BarsPane(QWidget):
    """Bars below one another, the longest first, each with its name; words where there is nothing to draw."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.look = look
        self.plot: Plot | None = None

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Qt's call to draw."""
        with Painter(self, self.look) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            room = QRectF(self.rect())
            painter.fill(room, "panel")
            if self.plot is None:
                painter.write(room, tr("NOTHING TO DRAW YET"), 2.2, "soft", at=CENTRE)
                return
            self._bars(painter, room, self.plot)

    def _bars(self, painter: Painter, room: QRectF, plot: Plot) -> None:
        u = self.look.u
        painter.write(
            QRectF(room.x(), room.y(), room.width(), _TITLE * u), plot.title, 1.9, "text", at=CENTRE
        )
        room = room.adjusted(u, (_TITLE + 0.6) * u, -u, -0.6 * u)
        high = min(5.0 * u, room.height() / max(1, len(plot.bars)))
        most = max(value for _, value in plot.bars) or 1.0
        for number, (name, value) in enumerate(plot.bars):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            bar = QRectF(row.x(), row.bottom() - 0.42 * high, 0.8 * row.width() * value / most, 0.3 * high)
            painter.fillRect(bar, curve_colour(self.look, number))
            painter.setPen(self.look.colour("text"))
            painter.setFont(self.look.fit(name, 1.9, row.width()))
            put_raw(
                painter, QRectF(row.x(), row.y(), row.width(), 0.55 * high), Qt.AlignmentFlag.AlignLeft, name
            )
            painter.setFont(self.look.font(1.7))
            side = QRectF(bar.right() + 0.5 * u, bar.y() - 0.3 * u, 12 * u, bar.height() + 0.6 * u)
            put_raw(painter, side, Qt.AlignmentFlag.AlignLeft, f"{value:.1f}")
