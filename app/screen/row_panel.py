"""Panels that show a list of rows: as many as fit, scrolled by the wheel, by a finger and by the mark."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.screen.look import Look, Painter
from app.screen.panel import Panel
from app.screen.window_layout import FINGER

KEY = 5.0  # units: size of the two keys that scroll; at least a fingertip
NARROW = 50.0  # units: a list of less width leaves all of it to its rows


class RowPanel(Panel):
    """A list of rows of one height.

    A drawing subclass gets the room for its rows from ``scrolled``, and each visible row from ``boxes``.
    The mark stays visible when it moves or when the room changes. Scrolling does not move the mark.
    """

    lists = True
    notch = 3  # rows that one notch of the wheel scrolls
    margin = 0  # rows that stay visible on both sides of the mark

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.top = 0  # first visible row
        self.rows = 1  # how many rows fit
        self._count = 0
        self._followed = (-1, 0)  # mark and number of visible rows when the list last followed the mark

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Scroll by ``notch`` rows for each notch of the wheel."""
        self.scroll_by(-round(event.angleDelta().y() * self.notch / 120))

    def scroll_by(self, rows: int) -> None:
        """Scroll down by this number of rows; a negative number scrolls up."""
        self.top = self._limited(self.top + rows)
        self.update()

    def _limited(self, top: int) -> int:
        return max(0, min(top, self._count - self.rows))

    def scrolled(self, painter: Painter, room: QRectF, fits: int, count: int, marked: int = -1) -> QRectF:
        """Draw the keys that scroll if ``count`` rows do not fit; return the room that is left for rows.

        ``fits`` is the number of rows that fit; ``marked`` is the row that has the mark, or -1.
        """
        self.rows, self._count = fits, count
        if (marked, fits) != self._followed and marked >= 0 and fits:
            lowest, highest = marked - fits + 1 + self.margin, max(0, marked - self.margin)
            self.top = min(max(self.top, lowest), highest)
        self._followed = (marked, fits)
        self.top = self._limited(self.top)
        return self._with_keys(painter, room) if 0 < fits < count else room

    def boxes(self, room: QRectF, high: float) -> Iterator[tuple[int, QRectF]]:
        """Yield number and box of each visible row; ``high`` is the height of a row in pixels."""
        for number in range(self.top, min(self._count, self.top + self.rows)):
            yield number, QRectF(room.x(), room.y() + (number - self.top) * high, room.width(), high)

    def fitting(self, room: QRectF, high: float, count: int) -> int:
        """Return how many rows of this height fit, at least one.

        The keys that scroll a narrow list are below its rows and take some of the height.
        """
        fits = int(room.height() / high)
        if fits < count and self.is_narrow(room.width()):
            fits = int((room.height() - self.key_size[1] - 0.6 * self.look.u) / high)
        return max(1, fits)

    @property
    def key_size(self) -> tuple[float, float]:
        """Width and least height of a key that scrolls, in pixels."""
        size = max(KEY * self.look.u, float(FINGER))
        return size, size

    def is_narrow(self, width: float) -> bool:
        """Return whether a list of this width has its keys below the rows, not to their right."""
        return width < NARROW * self.look.u

    def _with_keys(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the two keys and the scroll bar.

        The keys are at the right, or below a narrow list. They are side by side if there is little height.
        """
        gap, (wide, high) = 0.6 * self.look.u, self.key_size
        foot = self.is_narrow(room.width())
        beside = foot or room.height() < 2 * high + gap
        strip = QRectF(room.right() - wide - beside * (wide + gap), room.y(), wide, room.height())
        if foot:
            wide = (room.width() - gap) / 2
            strip = QRectF(room.x(), room.bottom() - high, wide, high)
        right, down = (wide + gap, 0.0) if beside else (0.0, (strip.height() + gap) / 2)
        for number, sign in enumerate((-1, 1)):
            box = QRectF(strip.x(), strip.y(), wide, strip.height() if beside else down - gap)
            self._scroll_key(painter, box.translated(number * right, number * down), sign)
        left = room.adjusted(0, 0, -2 * gap, -high - gap)
        if not foot:
            left = room.adjusted(0, 0, strip.x() - 2 * gap - room.right(), 0)
        self._scroll_bar(painter, QRectF(left.right() + gap, left.y(), 0.6 * gap, left.height()))
        return left

    def _scroll_key(self, painter: Painter, box: QRectF, sign: int) -> None:
        at, size = box.center(), 1.2 * self.look.u
        ends = self.top <= 0 if sign < 0 else self.top + self.rows >= self._count
        painter.fill(box, "key")
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.look.colour("ghost" if ends else "accent"))
        tip, foot = QPointF(at.x(), at.y() + sign * size), at.y() - sign * size
        painter.drawPolygon(QPolygonF([tip, QPointF(at.x() - size, foot), QPointF(at.x() + size, foot)]))
        name = "PREVIOUS ROWS" if sign < 0 else "NEXT ROWS"
        self.place(box, partial(self.scroll_by, sign * self.rows), name)

    def _scroll_bar(self, painter: Painter, track: QRectF) -> None:
        painter.fill(track, "key")
        part = QRectF(track.x(), 0, track.width(), track.height() * self.rows / self._count)
        part.moveTop(track.y() + track.height() * self.top / self._count)
        painter.fill(part, "accent")
