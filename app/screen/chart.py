"""Charts of figures over time or over parts: plots by pyqtgraph in the colours and the font of the desk.

Whoever imports this imports pyqtgraph, 0.3 s of it: only a ``_view`` that has a chart does, no page at the
start of the desk. A chart draws and does nothing else: fingers, wheel and keys go to the widget behind it,
which sets the ranges, so that no stock menu can take the keyboard and no drag can lose the curve.
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

_TICK, _NAME = 1.6, 1.5  # units: height of the figures on an axis, of the name of a plot
FloatArray = npt.NDArray[np.float64]


def curve_colour(look: Look, number: int) -> QColor:
    """The colour of the curve of this number, from 0 on; after eight they begin again."""
    colours = CURVES[look.palette.name]
    return QColor(colours[number % len(colours)])


def line_pen(colour: QColor, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    """A pen one pixel wide: a wider one takes Qt four times as long."""
    pen = QPen(colour, 1.0, style)
    pen.setCosmetic(True)
    return pen


class Axis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose figures are written as everywhere on the desk: a true minus, and no prefix of a unit."""

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation)
        self.enableAutoSIPrefix(False)
        self.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)  # its letters are drawn once

    def figures(self, low: float, high: float, size: float) -> list[float]:
        """Where figures stand on it between two values, ``size`` pixels apart."""
        levels = self.tickValues(low, high, size) if high > low and size > 0.0 else []
        return [float(value) for _spacing, values in levels[:1] for value in values]

    def tickStrings(self, values: Sequence[float], _scale: float, spacing: float) -> list[str]:
        """The figures, with as many places as their distance asks for."""
        places = max(0, int(np.ceil(-np.log10(spacing) - 1e-6))) if spacing > 0.0 else 0
        return [fixed(value, places) for value in values]


class Plot(pg.GraphicsWidget):  # type: ignore[misc]
    """One plot of a chart: curves with an axis at the left and one below. The ranges are its owner's alone.

    No PlotItem of pyqtgraph: its menus, which nobody may open here, take three quarters of its time.
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
        """The axis at the ``left`` or the ``bottom``."""
        return self._axes[side]

    def put(self, item: QGraphicsItem) -> None:
        """Have an item among the curves, in their units."""
        self.vb.addItem(item)

    def empty(self) -> None:
        """As it was made."""
        self.vb.clear()
        self.vb.invertY(False)
        for axis in self._axes.values():
            axis.show()
            axis.setStyle(showValues=True)
            if axis.labelText:
                axis.setLabel("")

    def curve(self, pen: QPen) -> pg.PlotCurveItem:
        """A curve that takes ready arrays: see ``set_curve``."""
        found = pg.PlotCurveItem(pen=pen, antialias=False, skipFiniteCheck=True)
        found.setSegmentedLineMode("on")  # lines, no path: half the time
        self.put(found)
        return found

    def room(self) -> QRectF:
        """Where its curves are drawn, in pixels of the chart."""
        found: QRectF = self.vb.sceneBoundingRect()
        return found

    def grid(self) -> list[QLineF]:
        """A line at each figure of both axes, in pixels of the chart."""
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
        """What stands at a place of the chart: across and up, in the units of the axes."""
        (x0, x1), (y0, y1) = self.vb.viewRange()
        room = self.room()
        across = (place.x() - room.x()) / max(1.0, room.width())
        down = (place.y() - room.y()) / max(1.0, room.height())
        return x0 + across * (x1 - x0), y1 - down * (y1 - y0)


def set_curve(curve: pg.PlotCurveItem, x: FloatArray, y: FloatArray, connect: object = "all") -> None:
    """Give a curve its points; ``connect`` is all, pairs, or an array with 0 where a line ends."""
    curve.setData(x=x, y=y, connect=connect, skipFiniteCheck=True)


class Chart(pg.GraphicsLayoutWidget):  # type: ignore[misc]
    """Plots below each other; see the module. ``dress`` follows theme and size of the window."""

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
        self.setCacheMode(QGraphicsView.CacheModeFlag.CacheNone)  # of the background: the grid moves
        self.dress()

    def ready(self, count: int) -> bool:
        """Whether so many plots are at hand; one is made a call: all at once take longer than a frame."""
        if len(self.plots) + len(self._spare) < count:
            self._spare.append(Plot())
            return False
        return True

    def add(self) -> Plot:
        """One more plot, below the others."""
        plot = self._spare.pop() if self._spare else Plot()
        self.addItem(plot, row=len(self.plots), col=0)
        self.plots.append(plot)
        self._dress(plot)
        return plot

    def empty(self) -> None:
        """No plot any more; those that were are kept for the next."""
        self.clear()
        for plot in self.plots:
            plot.empty()
        self._spare += self.plots
        self.plots.clear()

    def share_left(self, units: float) -> None:
        """All left axes as wide as this, in units: the plots stand exactly below each other."""
        for plot in self.plots:
            plot.axis("left").setWidth(round(units * self.look.u))

    def dress(self) -> None:
        """Colours and letters of now."""
        margin = round(0.4 * self.look.u)
        top = round(0.6 * _TICK * self.look.u)  # half a figure stands above the highest line
        self.ci.layout.setContentsMargins(margin, top, margin, margin)
        self.ci.layout.setSpacing(round(1.2 * self.look.u))  # figures of two axes never touch
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
                axis.setLabel(
                    axis.labelText
                )  # in its style of now; without words it would be set all the same

    def name(self, painter: QPainter, text: str, room: QRectF) -> None:
        """What a plot shows, in its upper left corner, on a ground of its own."""
        u = self.look.u
        painter.setFont(self.look.font(_NAME, bold=True))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(text)
        box = QRectF(room.x() + 0.4 * u, room.y() + 0.3 * u, wide + 0.8 * u, 2.0 * u)
        painter.fillRect(box, self.look.colour("panel"))
        painter.setPen(self.look.colour("soft"))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)

    def drawBackground(self, painter: QPainter, rect: QRectF) -> None:
        """The ground, and a line at each figure of an axis: all at once, in a tenth of the time of Qt's."""
        super().drawBackground(painter, rect)
        painter.setPen(line_pen(self.look.colour("ghost")))
        for plot in self.plots:
            painter.drawLines(plot.grid())
