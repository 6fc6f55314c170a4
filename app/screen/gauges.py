"""Feed, spindle, tool and times: small instruments of one shape."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk import formats
from app.desk.motion import FeedView, SpindleView
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Panel


class Gauge(Panel):
    """Draws from one frozen value; another value redraws it."""

    def __init__(self, look: Look, title: str, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.title = title
        self.value: object = None

    def show_value(self, value: object) -> None:
        """Show this; the same value again costs a comparison."""
        if value != self.value:
            self.value = value
            self.update()

    def row(self, y: float, high: float) -> QRectF:
        """A row inside the frame; units."""
        u = self.look.u
        return QRectF(1.4 * u, y * u, self.width() - 2.8 * u, high * u)

    def label(self, painter: QPainter, at: QRectF, text: str, flags: Qt.AlignmentFlag = LEFT) -> None:
        """A small word that names a figure."""
        painter.setPen(self.look.colour("soft"))
        painter.setFont(self.look.fit(text, 1.6, at.width(), bold=True))
        put(painter, at, flags, text)

    def figure(
        self, painter: QPainter, at: QRectF, text: str, size: float, flags: Qt.AlignmentFlag = RIGHT
    ) -> None:
        """A figure."""
        painter.setPen(self.look.colour("text"))
        painter.setFont(self.look.fit(text, size, at.width(), bold=True))
        put(painter, at, flags, text)

    def bar(self, painter: QPainter, at: QRectF, fraction: float, most: float) -> None:
        """An override: a bar with its figure; anything but 100 % stands out."""
        look, u = self.look, self.look.u
        plain = abs(fraction - 1.0) < 0.005
        figure = QRectF(at.right() - 9 * u, at.y(), 9 * u, at.height())
        track = QRectF(at.x(), at.center().y() - 0.6 * u, at.width() - 9.6 * u, 1.2 * u)
        painter.fillRect(track, look.colour("key"))
        share = max(0.0, min(1.0, fraction / most))
        filled = QRectF(track.x(), track.y(), track.width() * share, track.height())
        painter.fillRect(filled, look.colour("accent" if plain else "pause"))
        full = track.x() + track.width() / most
        painter.fillRect(QRectF(full - 0.1 * u, track.y() - 0.4 * u, 0.2 * u, 2.0 * u), look.colour("text"))
        painter.setPen(look.colour("text" if plain else "pause"))
        painter.setFont(look.font(2.1, bold=True))
        put(painter, figure, RIGHT, formats.percent(fraction))


class FeedGauge(Gauge):
    """Programmed feed large, actual feed and override below."""

    def draw(self, painter: QPainter) -> None:
        view = self.value
        if not isinstance(view, FeedView):
            return
        top = self.row(2.3, 4.8)
        unit = QRectF(top.right() - 7.6 * self.look.u, top.y(), 7.6 * self.look.u, top.height())
        self.figure(painter, top.adjusted(0, 0, -8.2 * self.look.u, 0), view.value, 4.2)
        self.label(painter, unit.adjusted(0, 1.0 * self.look.u, 0, 1.0 * self.look.u), view.unit)
        actual = self.row(7.4, 2.8)
        self.label(painter, actual, "ACTUAL")
        self.figure(painter, actual.adjusted(7 * self.look.u, 0, -8.2 * self.look.u, 0), view.actual, 2.5)
        self.label(painter, QRectF(unit.x(), actual.y(), unit.width(), actual.height()), view.actual_unit)
        self.bar(painter, self.row(11.2, 2.8), view.override, 1.5)


class SpindleGauge(Gauge):
    """Commanded and actual rpm, surface speed, override and its switch."""

    def draw(self, painter: QPainter) -> None:
        view = self.value
        if not isinstance(view, SpindleView):
            return
        u = self.look.u
        top = self.row(2.3, 4.8)
        self.label(painter, QRectF(top.x(), top.y() - u, 11.6 * u, top.height()), view.direction)
        self._switch(painter, QRectF(top.x(), top.y() + 2.8 * u, 9.2 * u, 2.0 * u), view)
        unit = QRectF(top.right() - 5.0 * u, top.y() + u, 5.0 * u, top.height())
        self.figure(painter, top.adjusted(12 * u, 0, -5.6 * u, 0), view.rpm, 4.2)
        self.label(painter, unit, "rpm")
        actual = self.row(7.4, 2.8)
        half = actual.width() * 0.50
        self.label(painter, actual, "ACTUAL")
        self.figure(
            painter, QRectF(actual.x() + 7 * u, actual.y(), half - 7 * u, actual.height()), view.actual, 2.5
        )
        surface = QRectF(actual.x() + half + 1.6 * u, actual.y(), half - 1.6 * u, actual.height())
        self.label(painter, surface, view.surface_label)
        self.figure(painter, surface.adjusted(5 * u, 0, 0, 0), view.surface, 2.5)
        self.bar(painter, self.row(11.2, 2.8), view.override, 1.0)

    def _switch(self, painter: QPainter, box: QRectF, view: SpindleView) -> None:
        look = self.look
        painter.fillRect(box, look.colour("key" if view.auto else "alarm"))
        painter.setPen(look.colour("text" if view.auto else "on_state"))
        text = "AUTO" if view.auto else "SWITCH OFF"
        painter.setFont(look.fit(text, 1.5, box.width() - 0.4 * look.u, bold=True))
        put(painter, box, CENTRE, text)


class ToolGauge(Gauge):
    """Active tool and secondary offset."""

    def draw(self, painter: QPainter) -> None:
        if not isinstance(self.value, tuple):
            return
        tool, secondary = self.value
        room = self.inside()
        half = room.width() / 2
        left = QRectF(room.x(), room.y(), half, room.height())
        for at, text in ((left, tool), (left.translated(half, 0), secondary)):
            self.figure(painter, at, text, 4.6, CENTRE)


class TimesGauge(Gauge):
    """Part count, time of this cycle, time left."""

    def draw(self, painter: QPainter) -> None:
        if not isinstance(self.value, tuple):
            return
        room = self.inside()
        column = room.width() / len(self.value)
        longest = max((text for _name, text in self.value), key=len)
        font = self.look.fit(longest, 2.6, column - 0.6 * self.look.u, bold=True)
        for number, (name, text) in enumerate(self.value):
            at = QRectF(room.x() + number * column, room.y(), column - 0.6 * self.look.u, room.height())
            self.label(painter, at.adjusted(0, 0, 0, -room.height() * 0.62), name, CENTRE)
            painter.setFont(font)
            painter.setPen(self.look.colour("text"))
            put(painter, at.adjusted(0, room.height() * 0.36, 0, 0), CENTRE, text)
