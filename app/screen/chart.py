"""Charts of values over time or over parts, drawn by pyqtgraph in the colors and font of TurnDesk.

Importing pyqtgraph takes 0.3 s, so only a ``_view`` module that has a chart imports this module. A chart only
draws. Touches, the wheel and keys go to the parent widget, which sets the ranges. A context menu can
therefore not take the keyboard, and dragging cannot move the curve out of view.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pyqtgraph as pg
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen
from PySide6.QtWidgets import QFrame, QGraphicsGridLayout, QGraphicsItem, QGraphicsView, QWidget

from app.desk.status.formats import fixed
from app.desk.translation import tr
from app.screen.look import CURVES, FAMILY, LEAST, Look

_TICK, _NAME = 1.6, 1.5  # Units: height of the numbers on an axis, and of the name of a plot.
FloatArray = npt.NDArray[np.float64]


def curve_colour(look: Look, number: int) -> QColor:
    """Return the color of a curve by its index, counted from 0. After eight curves, the colors repeat."""
    colours = CURVES[look.palette.name]
    return QColor(colours[number % len(colours)])


def line_pen(colour: QColor, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    """Return a pen one pixel wide. Qt needs four times as long for a wider pen."""
    pen = QPen(colour, 1.0, style)
    pen.setCosmetic(True)
    return pen


class Axis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose numbers have TurnDesk's format: a true minus sign and no SI prefix."""

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation)
        self.enableAutoSIPrefix(False)
        self.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)  # Draw the labels only once.

    def figures(self, low: float, high: float, size: float) -> list[float]:
        """Return the values that have labels between ``low`` and ``high`` on an axis of ``size`` pixels."""
        levels = self.tickValues(low, high, size) if high > low and size > 0.0 else []
        return [float(value) for _spacing, values in levels[:1] for value in values]

    def tickStrings(self, values: Sequence[float], _scale: float, spacing: float) -> list[str]:
        """Return the labels, with as many decimals as their spacing requires."""
        places = max(0, int(np.ceil(-np.log10(spacing) - 1e-6))) if spacing > 0.0 else 0
        return [fixed(value, places) for value in values]


class Plot(pg.GraphicsWidget):  # type: ignore[misc]
    """One plot of a chart, with curves, a left axis and a bottom axis. Its owner sets the ranges.

    It replaces the PlotItem of pyqtgraph, which spends three quarters of its time on menus that are not used
    here.
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
        self._axes = {side: Axis(side) for side in ("left", "bottom")}
        for side, place in (("left", (0, 0)), ("bottom", (1, 1))):
            axis = self._axes[side]
            axis.linkToView(self.vb)
            axis.setZValue(0.5)
            self.layout.addItem(axis, *place)

    def axis(self, side: str) -> Axis:
        """Return the axis at the ``left`` or the ``bottom``."""
        return self._axes[side]

    def put(self, item: QGraphicsItem) -> None:
        """Add an item to the plot, in the units of the axes."""
        self.vb.addItem(item)

    def empty(self) -> None:
        """Remove all curves and restore the initial state of the axes."""
        self.vb.clear()
        self.vb.invertY(False)
        for axis in self._axes.values():
            axis.show()
            axis.setStyle(showValues=True)
            if axis.labelText:
                axis.setLabel("")

    def curve(self, pen: QPen) -> pg.PlotCurveItem:
        """Add a curve and return it. Set its points with ``set_curve``."""
        found = pg.PlotCurveItem(pen=pen, antialias=False, skipFiniteCheck=True)
        found.setSegmentedLineMode("on")  # Drawing lines takes half as long as drawing a path.
        self.put(found)
        return found

    def room(self) -> QRectF:
        """Return the rectangle in which the curves are drawn, in pixels of the chart."""
        found: QRectF = self.vb.sceneBoundingRect()
        return found

    def grid(self) -> list[QLineF]:
        """Return a grid line for each label of both axes, in pixels of the chart."""
        room, ((x0, x1), (y0, y1)) = self.room(), self.vb.viewRange()
        lines = []
        for value in self.axis("bottom").figures(x0, x1, room.width()):
            x = room.x() + (value - x0) / (x1 - x0) * room.width()
            lines.append(QLineF(x, room.y(), x, room.bottom()))
        for value in self.axis("left").figures(y0, y1, room.height()):
            y = room.bottom() - (value - y0) / (y1 - y0) * room.height()
            lines.append(QLineF(room.x(), y, room.right(), y))
        return lines

    def value_at(self, place: QPointF) -> tuple[float, float]:
        """Return the horizontal and vertical axis values at a position in pixels of the chart."""
        (x0, x1), (y0, y1) = self.vb.viewRange()
        room = self.room()
        across = (place.x() - room.x()) / max(1.0, room.width())
        down = (place.y() - room.y()) / max(1.0, room.height())
        return x0 + across * (x1 - x0), y1 - down * (y1 - y0)


def set_curve(curve: pg.PlotCurveItem, x: FloatArray, y: FloatArray, connect: object = "all") -> None:
    """Set the points of a curve. ``connect`` is all, pairs, or an array with 0 where a line ends."""
    curve.setData(x=x, y=y, connect=connect, skipFiniteCheck=True)


class Chart(pg.GraphicsLayoutWidget):  # type: ignore[misc]
    """A column of plots. Call ``dress`` when the theme or the size of the window changes."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.look = look
        self.plots: list[Plot] = []
        self._spare: list[Plot] = []
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.viewport().setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents, False)
        self.setAntialiasing(False)
        # The background is not cached, because the grid moves.
        self.setCacheMode(QGraphicsView.CacheModeFlag.CacheNone)
        self.dress()

    def ready(self, count: int) -> bool:
        """Return whether ``count`` plots exist.

        Each call creates at most one missing plot, so that no call takes longer than a frame.
        """
        if len(self.plots) + len(self._spare) < count:
            self._spare.append(Plot())
            return False
        return True

    def add(self) -> Plot:
        """Add a plot below the others and return it."""
        plot = self._spare.pop() if self._spare else Plot()
        self.addItem(plot, row=len(self.plots), col=0)
        self.plots.append(plot)
        self._dress(plot)
        return plot

    def empty(self) -> None:
        """Remove all plots. They are reused later."""
        self.clear()
        for plot in self.plots:
            plot.empty()
        self._spare += self.plots
        self.plots.clear()

    def share_left(self, units: float) -> None:
        """Set the width of all left axes in units, so that the plots are aligned."""
        for plot in self.plots:
            plot.axis("left").setWidth(round(units * self.look.u))

    def dress(self) -> None:
        """Apply the present colors and font sizes."""
        margin = round(0.4 * self.look.u)
        top = round(0.6 * _TICK * self.look.u)  # Half of the top label is above the highest line.
        self.ci.layout.setContentsMargins(margin, top, margin, margin)
        self.ci.layout.setSpacing(round(1.2 * self.look.u))  # Keep the labels of two axes apart.
        self.setAccessibleName(tr("CHART"))
        self.setBackground(self.look.colour("panel"))
        for plot in self.plots:
            self._dress(plot)

    def _dress(self, plot: Plot) -> None:
        look = self.look
        font = look.font(_TICK)
        for side in ("left", "bottom"):
            axis = plot.axis(side)
            axis.setPen(line_pen(look.colour("frame")))
            axis.setTextPen(line_pen(look.colour("soft")))
            axis.setStyle(tickFont=font, tickLength=-round(0.5 * look.u))
            axis.labelStyle = {
                "color": look.palette.soft,
                "font-size": f"{max(8, round(LEAST * look.u))}px",
                "font-family": FAMILY,
            }
            if axis.labelText:
                axis.setLabel(axis.labelText)  # Setting an empty text would show an empty label.

    def name(self, painter: QPainter, text: str, room: QRectF) -> None:
        """Draw the name of a plot in its upper left corner, on a filled background."""
        u = self.look.u
        painter.setFont(self.look.font(_NAME, bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(text)
        box = QRectF(room.x() + 0.4 * u, room.y() + 0.3 * u, wide + 0.8 * u, 2.0 * u)
        painter.fillRect(box, self.look.colour("panel"))
        painter.setPen(self.look.colour("soft"))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)

    def drawBackground(self, painter: QPainter, rect: QRectF) -> None:
        """Draw the background and all grid lines together, in a tenth of the time of pyqtgraph's grid."""
        super().drawBackground(painter, rect)
        painter.setPen(line_pen(self.look.colour("ghost")))
        for plot in self.plots:
            painter.drawLines(plot.grid())
