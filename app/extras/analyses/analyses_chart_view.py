"""Chart of an analysis: a path with magnified error, screw thread passes or a ball-bar plot."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.extras.analyses.drawing import AnalysisDrawing
from app.screen.chart import Chart, ChartPlot, find_curve_color, make_line_pen, set_curve_points
from app.screen.screen_theme import ScreenTheme

FloatArray = npt.NDArray[np.float64]
_LEFT = 9.0  # units
_ROOM = 0.06  # ratio: margin around the lines


class AnalysisChart(Chart):
    """Chart of an analysis.

    ``show_drawing`` sets the lines and scales the chart to fit them.
    """

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self.drawing = AnalysisDrawing()

    def show_drawing(self, drawing: AnalysisDrawing) -> bool:
        """Show a drawing, and return whether it is shown.

        While the plots are still being created, the result is False. The caller must then call this method
        again.
        """
        if not self.prepare_plots(bool(drawing.upper_curves) + bool(drawing.lower_curves)):
            return False
        self.drawing = drawing
        self.remove_plots()
        if not drawing.upper_curves:
            return True
        upper = self.add_plot()
        upper.vb.invertY(drawing.is_vertical_axis_inverted)
        self._fill(upper, drawing.commanded_points, drawing.upper_curves)
        if drawing.lower_curves:
            self._fill(self.add_plot(), np.empty((0, 2)), drawing.lower_curves)
        self.set_left_axis_width(_LEFT)
        self._fit()
        return True

    def _fill(self, plot: ChartPlot, soft: FloatArray, curves: tuple[FloatArray, ...]) -> None:
        if len(soft):
            line = plot.add_curve(make_line_pen(self.theme.get_color("todo")))
            set_curve_points(line, soft[:, 0], soft[:, 1])
        for number, points in enumerate(curves):
            line = plot.add_curve(make_line_pen(find_curve_color(self.theme, number)))
            set_curve_points(line, points[:, 0], points[:, 1])

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Adjust axes that share a scale after the chart is resized."""
        super().resizeEvent(event)
        if self.isVisible() and self.plots:  # Qt also calls this method while pyqtgraph creates the chart.
            self._fit()

    def _fit(self) -> None:
        self.ci.layout.activate()
        drawing = self.drawing
        _range(self.plots[0], [drawing.commanded_points, *drawing.upper_curves], equal=drawing.has_equal_axes)
        if drawing.lower_curves:
            _range(self.plots[1], list(drawing.lower_curves), equal=False)

    def apply_theme(self) -> None:
        """Apply the current colors and fonts."""
        super().apply_theme()
        if self.plots:
            self.show_drawing(self.drawing)

    def drawForeground(self, painter: QPainter, rect: QRectF) -> None:
        """Draw a circle and a label at each labeled point."""
        super().drawForeground(painter, rect)
        if not self.plots:
            return
        u, plot, names = self.theme.unit_px, self.plots[0], self.drawing.axis_labels
        for shown, text in zip(self.plots, names, strict=False):
            self.name(painter, text, shown.find_curve_area())
        last = self.plots[-1].find_curve_area()
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignBottom
        painter.drawText(last.adjusted(0, 0, -0.6 * u, -0.3 * u), right, names[2])
        (x0, x1), (y0, y1) = plot.vb.viewRange()
        room = plot.find_curve_area()
        for x, y, word in self.drawing.labeled_points:
            down = (y - y0) / (y1 - y0) if self.drawing.has_equal_axes else (y1 - y) / (y1 - y0)
            at = QPointF(room.x() + (x - x0) / (x1 - x0) * room.width(), room.y() + down * room.height())
            painter.setPen(self.theme.make_pen("pause", 0.2))
            painter.drawEllipse(at, 1.4 * u, 1.4 * u)
            painter.setFont(self.theme.make_font(1.7, is_bold=True))
            box = QRectF(at.x() - 8 * u, at.y() - 4.2 * u, 16 * u, 2.4 * u)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, word)


def _range(plot: ChartPlot, parts: list[FloatArray], *, equal: bool) -> None:
    """Set the range of the plot so that all points are visible.

    If ``equal`` is True, both axes have the same scale.
    """
    points = np.concatenate([each for each in parts if len(each)])
    low, high = points.min(axis=0), points.max(axis=0)
    middle, wide = 0.5 * (low + high), np.maximum((1.0 + 2.0 * _ROOM) * (high - low), 1e-6)
    room = plot.find_curve_area()
    if equal and room.width() > 1.0 and room.height() > 1.0:
        scale = max(wide[0] / room.width(), wide[1] / room.height())
        wide = scale * np.array([room.width(), room.height()])
    plot.vb.setXRange(middle[0] - wide[0] / 2, middle[0] + wide[0] / 2, padding=0)
    plot.vb.setYRange(middle[1] - wide[1] / 2, middle[1] + wide[1] / 2, padding=0)
