"""Charts of values over time or over parts, drawn by pyqtgraph in the colors and font of TurnDesk.

Importing pyqtgraph takes 0.3 s. Only view modules that contain a chart therefore import this module. A
chart only draws. Touches, the wheel and keys go to the parent widget, which sets the ranges. Therefore a
context menu cannot take the keyboard focus, and dragging cannot move the curve out of view.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pyqtgraph as pg
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen
from PySide6.QtWidgets import QFrame, QGraphicsGridLayout, QGraphicsItem, QGraphicsView, QWidget

from app.desk.status.formats import format_fixed
from app.desk.translation import tr
from app.screen.color_palettes import CURVE_COLORS
from app.screen.screen_theme import FONT_FAMILY, MIN_TEXT_SIZE, ScreenTheme

_TICK, _NAME = 1.6, 1.5  # Units: height of the numbers on an axis, and of the name of a plot.
FloatArray = npt.NDArray[np.float64]


def find_curve_color(theme: ScreenTheme, index: int) -> QColor:
    """Return the color of a curve by its index, counted from 0.

    After eight curves, the colors repeat.
    """
    colours = CURVE_COLORS[theme.palette.name]
    return QColor(colours[index % len(colours)])


def make_line_pen(color: QColor, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    """Return a pen with a width of one pixel.

    Qt takes four times as long to draw a wider line.
    """
    pen = QPen(color, 1.0, style)
    pen.setCosmetic(True)
    return pen


class ChartAxis(pg.AxisItem):  # type: ignore[misc]
    """Axis with numbers in TurnDesk's format, with a true minus sign and no SI prefix."""

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation)
        self.enableAutoSIPrefix(False)
        self.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)  # Draw the labels only once.

    def find_label_values(self, low: float, high: float, length_px: float) -> list[float]:
        """Return the values that get a label on an axis from ``low`` to ``high``.

        The axis is ``length_px`` pixels long.
        """
        levels = self.tickValues(low, high, length_px) if high > low and length_px > 0.0 else []
        return [float(value) for _spacing, values in levels[:1] for value in values]

    def tickStrings(self, values: Sequence[float], _scale: float, spacing: float) -> list[str]:
        """Return the labels, with as many decimals as their spacing requires."""
        places = max(0, int(np.ceil(-np.log10(spacing) - 1e-6))) if spacing > 0.0 else 0
        return [format_fixed(value, places) for value in values]


class ChartPlot(pg.GraphicsWidget):  # type: ignore[misc]
    """One plot of a chart, with curves, a left axis and a bottom axis.

    The owner of the plot sets the ranges. This class replaces the PlotItem of pyqtgraph, which spends three
    quarters of its time on menus that are not used here.
    """

    def __init__(self) -> None:
        super().__init__()
        self.layout = QGraphicsGridLayout()
        self.layout.setContentsMargins(1, 1, 1, 1)
        self.layout.setSpacing(0)
        self.setLayout(self.layout)
        self.vb = pg.ViewBox(parent=self, enableMouse=False, enableMenu=False, defaultPadding=0.0)
        self.vb.disableAutoRange()
        self.layout.addItem(self.vb, 0, 1)
        self._axes = {side: ChartAxis(side) for side in ("left", "bottom")}
        for side, place in (("left", (0, 0)), ("bottom", (1, 1))):
            axis = self._axes[side]
            axis.linkToView(self.vb)
            axis.setZValue(0.5)
            self.layout.addItem(axis, *place)

    def find_axis(self, side: str) -> ChartAxis:
        """Return the axis at the left or at the bottom.

        ``side`` is "left" or "bottom".
        """
        return self._axes[side]

    def add_item(self, item: QGraphicsItem) -> None:
        """Add an item whose coordinates are values of the axes."""
        self.vb.addItem(item)

    def clear_plot(self) -> None:
        """Remove all curves, and restore the initial state of the axes."""
        self.vb.clear()
        self.vb.invertY(False)
        for axis in self._axes.values():
            axis.show()
            axis.setStyle(showValues=True)
            if axis.labelText:
                axis.setLabel("")

    def add_curve(self, pen: QPen) -> pg.PlotCurveItem:
        """Add a curve, and return it.

        Set the points of the curve with ``set_curve_points``.
        """
        found = pg.PlotCurveItem(pen=pen, antialias=False, skipFiniteCheck=True)
        found.setSegmentedLineMode("on")  # Drawing lines takes half as long as drawing a path.
        self.add_item(found)
        return found

    def find_curve_area(self) -> QRectF:
        """Return the rectangle in which the curves are drawn, in pixels of the chart."""
        found: QRectF = self.vb.sceneBoundingRect()
        return found

    def find_grid_lines(self) -> list[QLineF]:
        """Return a grid line for each label of both axes, in pixels of the chart."""
        room, ((x0, x1), (y0, y1)) = self.find_curve_area(), self.vb.viewRange()
        lines = []
        for value in self.find_axis("bottom").find_label_values(x0, x1, room.width()):
            x = room.x() + (value - x0) / (x1 - x0) * room.width()
            lines.append(QLineF(x, room.y(), x, room.bottom()))
        for value in self.find_axis("left").find_label_values(y0, y1, room.height()):
            y = room.bottom() - (value - y0) / (y1 - y0) * room.height()
            lines.append(QLineF(room.x(), y, room.right(), y))
        return lines

    def map_to_axis_values(self, position: QPointF) -> tuple[float, float]:
        """Return the horizontal and vertical axis values at a position in pixels of the chart."""
        (x0, x1), (y0, y1) = self.vb.viewRange()
        room = self.find_curve_area()
        across = (position.x() - room.x()) / max(1.0, room.width())
        down = (position.y() - room.y()) / max(1.0, room.height())
        return x0 + across * (x1 - x0), y1 - down * (y1 - y0)


def set_curve_points(curve: pg.PlotCurveItem, x: FloatArray, y: FloatArray, connect: object = "all") -> None:
    """Set the points of a curve.

    ``connect`` is "all", "pairs", or an array with 0 where a line ends.
    """
    curve.setData(x=x, y=y, connect=connect, skipFiniteCheck=True)


class Chart(pg.GraphicsLayoutWidget):  # type: ignore[misc]
    """Chart that consists of plots, one below the other.

    Call ``apply_theme`` when the theme or the size of the window changes.
    """

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(parent)
        self.theme = theme
        self.plots: list[ChartPlot] = []
        self._spare: list[ChartPlot] = []
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.viewport().setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents, False)
        self.setAntialiasing(False)
        # The background is not cached, because the grid moves.
        self.setCacheMode(QGraphicsView.CacheModeFlag.CacheNone)
        self.apply_theme()

    def prepare_plots(self, plot_count: int) -> bool:
        """Create a missing plot, and return whether ``plot_count`` plots exist.

        Each call creates at most one plot, so that no call takes longer than a frame.
        """
        if len(self.plots) + len(self._spare) < plot_count:
            self._spare.append(ChartPlot())
            return False
        return True

    def add_plot(self) -> ChartPlot:
        """Add a plot below the existing plots, and return it."""
        plot = self._spare.pop() if self._spare else ChartPlot()
        self.addItem(plot, row=len(self.plots), col=0)
        self.plots.append(plot)
        self._dress(plot)
        return plot

    def remove_plots(self) -> None:
        """Remove all plots from the chart.

        The plot objects are reused later.
        """
        self.clear()
        for plot in self.plots:
            plot.clear_plot()
        self._spare += self.plots
        self.plots.clear()

    def set_left_axis_width(self, units: float) -> None:
        """Set the width of all left axes in theme units, so that the plots are aligned."""
        for plot in self.plots:
            plot.find_axis("left").setWidth(round(units * self.theme.unit_px))

    def apply_theme(self) -> None:
        """Apply the current colors and font sizes."""
        margin = round(0.4 * self.theme.unit_px)
        top = round(0.6 * _TICK * self.theme.unit_px)  # Half of the top label is above the highest line.
        self.ci.layout.setContentsMargins(margin, top, margin, margin)
        self.ci.layout.setSpacing(round(1.2 * self.theme.unit_px))  # Keep the labels of two axes apart.
        self.setAccessibleName(tr("CHART"))
        self.setBackground(self.theme.get_color("panel"))
        for plot in self.plots:
            self._dress(plot)

    def _dress(self, plot: ChartPlot) -> None:
        look = self.theme
        font = look.make_font(_TICK)
        for side in ("left", "bottom"):
            axis = plot.find_axis(side)
            axis.setPen(make_line_pen(look.get_color("frame")))
            axis.setTextPen(make_line_pen(look.get_color("soft")))
            axis.setStyle(tickFont=font, tickLength=-round(0.5 * look.unit_px))
            axis.labelStyle = {
                "color": look.palette.soft,
                "font-size": f"{max(8, round(MIN_TEXT_SIZE * look.unit_px))}px",
                "font-family": FONT_FAMILY,
            }
            if axis.labelText:
                axis.setLabel(axis.labelText)  # Setting an empty text would show an empty label.

    def name(self, painter: QPainter, text: str, area: QRectF) -> None:
        """Draw the name of a plot in its upper left corner, on a filled background."""
        u = self.theme.unit_px
        painter.setFont(self.theme.make_font(_NAME, is_bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(text)
        box = QRectF(area.x() + 0.4 * u, area.y() + 0.3 * u, wide + 0.8 * u, 2.0 * u)
        painter.fillRect(box, self.theme.get_color("panel"))
        painter.setPen(self.theme.get_color("soft"))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)

    def drawBackground(self, painter: QPainter, rect: QRectF) -> None:
        """Draw the background and all grid lines.

        The lines are drawn together, which takes a tenth of the time of pyqtgraph's grid.
        """
        super().drawBackground(painter, rect)
        painter.setPen(make_line_pen(self.theme.get_color("ghost")))
        for plot in self.plots:
            painter.drawLines(plot.find_grid_lines())
