"""Every change of the offsets: when, which, from, to, why."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel

Entry = tuple[str, str, str, str]
ROW = 5.2  # units


class HistoryList(Panel):
    """Newest on top, two lines each."""

    title = "HISTORY  ·  NEWEST ON TOP"

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.entries: tuple[Entry, ...] = ()
        self.top = 0
        self.hide()

    def show_entries(self, entries: tuple[Entry, ...]) -> None:
        """All of it, newest first."""
        if entries != self.entries:
            self.entries = entries
            self.look_at(self.top)

    @property
    def rows(self) -> int:
        """How many changes fit."""
        return max(1, int((self.height() - 3.4 * self.look.u) / (ROW * self.look.u)))

    def look_at(self, top: int) -> None:
        """Begin with this one."""
        self.top = max(0, min(top, len(self.entries) - self.rows))
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Three changes a notch."""
        self.look_at(self.top - round(event.angleDelta().y() / 40))

    def draw(self, painter: QPainter) -> None:
        look, u, room = self.look, self.look.u, self.inside()
        if not self.entries:
            painter.setPen(look.colour("soft"))
            painter.setFont(look.font(2.0))
            put(painter, QRectF(room.x(), room.y(), room.width(), 3 * u), LEFT, "No offset was changed yet.")
        for place, entry in enumerate(self.entries[self.top : self.top + self.rows]):
            self._entry(painter, QRectF(room.x(), room.y() + place * ROW * u, room.width(), ROW * u), entry)

    def _entry(self, painter: QPainter, row: QRectF, entry: Entry) -> None:
        look, u = self.look, self.look.u
        at, which, change, why = entry
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(2.2, bold=True))
        put(painter, QRectF(row.x(), row.y(), 6 * u, 2.6 * u), LEFT, which)
        room = row.adjusted(6.4 * u, 0, 0, 0)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(change, 2.0, room.width(), bold=True))
        put(painter, QRectF(room.x(), room.y(), room.width(), 2.6 * u), LEFT, change)
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.7))
        put(painter, QRectF(room.x(), room.y() + 2.4 * u, room.width(), 2.2 * u), LEFT, f"{at}    {why}")
