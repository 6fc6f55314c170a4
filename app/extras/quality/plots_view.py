"""Drawing of control charts and trends with pyqtgraph.

This module is imported when the first chart is opened.
"""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.extras.quality.section import ChartDrawing, HorizontalLine, Plot, PlotCurve
from app.screen import chart
from app.screen.chart import Chart, find_curve_color, make_line_pen, set_curve_points
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter, draw_raw_text

_STYLES = {
    "centre": Qt.PenStyle.SolidLine,
    "limit": Qt.PenStyle.DashLine,
    "tolerance": Qt.PenStyle.DotLine,
}
_INKS = {"centre": "soft", "limit": "pause", "tolerance": "alarm"}
_ROOM = 0.08  # ratio of the height: margin above and below the curves
_TITLE = 2.2  # units
_PLOTS = 2  # usual number of plots in a drawing


class PlotsPane(QWidget):
    """Pane that shows the plots of one chart.

    The plots are drawn again when the chart, the size or the theme changes.
    """

    accessible_name = "CHART"

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(parent)
        self.theme = theme
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._chart = Chart(theme, self)
        self._bars = BarsPane(theme, self)
        self._shown: ChartDrawing | None = None
        self._theme = ""
        self._u = 0.0

    def prepare_next_plot(self) -> bool:
        """Create one more plot in advance, and return whether all plots have been created."""
        return self._chart.prepare_plots(_PLOTS)

    def show_drawing(self, drawing: ChartDrawing) -> None:
        """Show a chart, unless it is already shown in the current size and theme."""
        look = self.theme
        if drawing == self._shown and (self._theme, self._u) == (look.palette.name, look.unit_px):
            return
        plots = [plot for plot in drawing.plots if not plot.is_empty]
        barred = bool(plots) and bool(plots[0].bars)
        if not (barred or self._chart.prepare_plots(len(plots))):
            return
        self._shown, self._theme, self._u = drawing, look.palette.name, look.unit_px
        self._bars.plot = plots[0] if barred else None
        self._bars.setVisible(barred or not plots)
        self._bars.update()
        self._chart.setVisible(bool(plots) and not barred)
        self._chart.remove_plots()
        if not barred:
            across = [
                float(each) for plot in plots for curve in plot.curves for each in curve.part_sequence_numbers
            ]
            for plot in plots:
                self._draw(plot, (min(across), max(across)))
        self._chart.apply_theme()
        self._chart.set_left_axis_width(9.0)
        for drawn in self._chart.plots:
            drawn.layout.activate()  # Otherwise a hidden window retains the old layout.
        self._lay_out()

    def apply_theme(self) -> None:
        """Draw the current drawing again after a change of theme."""
        if self._shown is not None:
            self.show_drawing(self._shown)

    def showEvent(self, _event: QShowEvent) -> None:
        """Request a new drawing, because plots that were drawn while hidden have no layout."""
        self._shown = None

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Resize the chart to the pane, and draw the plots again."""
        self._lay_out()
        self.apply_theme()

    def _lay_out(self) -> None:
        self._chart.setGeometry(0, 0, self.width(), self.height())
        self._bars.setGeometry(0, 0, self.width(), self.height())

    # --- one plot ------------------------------------------------------------------------------------

    def _draw(self, plot: Plot, across: tuple[float, float]) -> None:
        drawn = self._chart.add_plot()
        drawn.find_axis("bottom").setLabel(plot.x_label)
        for curve in plot.curves:
            self._curve(drawn, curve)
        self._range(drawn, plot, across)
        self._title(drawn, plot.title)
        for level in plot.horizontal_lines:
            self._level(drawn, level)
        if plot.violation_points:
            x, y = (np.asarray(each) for each in zip(*plot.violation_points, strict=True))
            pen = make_line_pen(self.theme.get_color("alarm"))
            pen.setWidthF(2.0)
            ring = pg.ScatterPlotItem(
                x=x, y=y, symbol="o", size=2.2 * self.theme.unit_px, brush=None, pen=pen
            )
            drawn.add_item(ring)

    def _curve(self, drawn: chart.ChartPlot, curve: PlotCurve) -> None:
        colour = find_curve_color(self.theme, curve.color_index)
        x, y = curve.part_sequence_numbers, curve.values
        if curve.is_stepped and len(x) > 1:
            x, y = np.repeat(x, 2)[1:], np.repeat(y, 2)[:-1]
        set_curve_points(drawn.add_curve(make_line_pen(colour)), x, y)
        if curve.has_dots:
            dots = pg.ScatterPlotItem(
                x=curve.part_sequence_numbers,
                y=curve.values,
                symbol="o",
                size=1.0 * self.theme.unit_px,
                pen=None,
                brush=colour,
            )
            drawn.add_item(dots)
        if curve.name and len(curve.part_sequence_numbers):
            label = pg.TextItem(curve.name, color=colour, anchor=(1.1, 0.5))
            label.setFont(self.theme.make_font(1.7, is_bold=True))
            label.setPos(float(curve.part_sequence_numbers[-1]), float(curve.values[-1]))
            drawn.add_item(label)

    def _level(self, drawn: chart.ChartPlot, level: HorizontalLine) -> None:
        pen = make_line_pen(self.theme.get_color(_INKS[level.line_type]), _STYLES[level.line_type])
        drawn.add_item(pg.InfiniteLine(level.value, angle=0, pen=pen))

    def _range(self, drawn: chart.ChartPlot, plot: Plot, across: tuple[float, float]) -> None:
        """Set the range of a plot so that all points and levels are visible below the title.

        All plots have the same horizontal range.
        """
        values = [float(each) for curve in plot.curves for each in curve.values]
        values += [level.value for level in plot.horizontal_lines]
        low, high = min(values), max(values)
        room = _ROOM * (high - low) or max(abs(high) * 0.01, 1e-4)
        drawn.vb.setYRange(low - room, high + 4.5 * room, padding=0)
        side = max(0.5, 0.02 * (across[1] - across[0]))
        drawn.vb.setXRange(across[0] - side, across[1] + side, padding=0)

    def _title(self, drawn: chart.ChartPlot, words: str) -> None:
        """Draw the title of a plot in the upper left corner.

        The title has a background, so that limit lines do not cross the text.
        """
        (left, _), (_, top) = drawn.vb.viewRange()
        ground = self.theme.get_color("panel")
        title = pg.TextItem(words, color=self.theme.get_color("text"), anchor=(0.0, 0.0), fill=ground)
        title.setZValue(10.0)
        title.setFont(self.theme.make_font(1.8, is_bold=True))
        title.setPos(left, top)
        drawn.add_item(title)


class BarsPane(QWidget):
    """Pane with labeled horizontal bars, the longest bar first.

    If there are no bars, the pane shows a text.
    """

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(parent)
        self.theme = theme
        self.plot: Plot | None = None

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Paint the bars."""
        with ThemedPainter(self, self.theme) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            room = QRectF(self.rect())
            painter.fill_rect(room, "panel")
            if self.plot is None:
                painter.draw_text_line(room, tr("NOTHING TO DRAW YET"), 2.2, "soft", at=ALIGN_CENTER)
                return
            self._bars(painter, room, self.plot)

    def _bars(self, painter: ThemedPainter, room: QRectF, plot: Plot) -> None:
        u = self.theme.unit_px
        painter.draw_text_line(
            QRectF(room.x(), room.y(), room.width(), _TITLE * u), plot.title, 1.9, "text", at=ALIGN_CENTER
        )
        room = room.adjusted(u, (_TITLE + 0.6) * u, -u, -0.6 * u)
        high = min(5.0 * u, room.height() / max(1, len(plot.bars)))
        most = max(value for _, value in plot.bars) or 1.0
        for number, (name, value) in enumerate(plot.bars):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            bar = QRectF(row.x(), row.bottom() - 0.42 * high, 0.8 * row.width() * value / most, 0.3 * high)
            painter.fillRect(bar, find_curve_color(self.theme, number))
            painter.setPen(self.theme.get_color("text"))
            painter.setFont(self.theme.fit_font(name, 1.9, row.width()))
            draw_raw_text(
                painter, QRectF(row.x(), row.y(), row.width(), 0.55 * high), Qt.AlignmentFlag.AlignLeft, name
            )
            painter.setFont(self.theme.make_font(1.7))
            side = QRectF(bar.right() + 0.5 * u, bar.y() - 0.3 * u, 12 * u, bar.height() + 0.6 * u)
            draw_raw_text(painter, side, Qt.AlignmentFlag.AlignLeft, f"{value:.1f}")
