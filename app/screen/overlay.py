"""What lies over the path view: the message of a stop, an alarm, or the log of alarms."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.alarms import Entry
from app.desk.view import Tone
from app.desk.words import tr
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel
from app.screen.shapes import draw_sign
from core.executor.snapshot import Alarm

WRAP = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
WORDS = int(Qt.TextFlag.TextWordWrap.value)


class Notice(Panel):
    """An alarm with cause, remedy and line; or the message of M00/M01, as large as it fits."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.message = ""
        self._go_on = ""
        self._alarm: Alarm | None = None
        self.hide()

    def show_notice(self, message: str, go_on: str, alarm: Alarm | None) -> None:
        """An alarm goes before a message; with neither the notice is gone."""
        if (message, go_on, alarm) == (self.message, self._go_on, self._alarm):
            return
        self.message, self._go_on, self._alarm = message, go_on, alarm
        self.setVisible(bool(message or alarm))
        self.update()

    def draw(self, painter: QPainter) -> None:
        if self._alarm is not None:
            self._draw_alarm(painter, self._alarm)
        else:
            self._draw_message(painter)

    def _head(self, painter: QPainter, tone: Tone, text: str) -> QRectF:
        look, u = self.look, self.look.u
        painter.fillRect(self.area(), look.colour(tone.value))
        painter.fillRect(self.area().adjusted(0.5 * u, u, -0.5 * u, -0.5 * u), look.colour("panel"))
        head = QRectF(0, 0, self.width(), 5.6 * u)
        painter.fillRect(head, look.colour(tone.value))
        ink = look.colour("on_state")
        draw_sign(painter, QRectF(1.6 * u, 1.5 * u, 2.6 * u, 2.6 * u), tone, ink)
        painter.setPen(ink)
        painter.setFont(look.fit(text, 2.6, self.width() - 8 * u, bold=True))
        put(painter, head.adjusted(5.6 * u, 0, -u, 0), LEFT, text)
        return self.area().adjusted(2 * u, 6.8 * u, -2 * u, -1.4 * u)

    def _draw_message(self, painter: QPainter) -> None:
        room = self._head(painter, Tone.PAUSE, "PROGRAM STOP")
        u = self.look.u
        foot = QRectF(room.x(), room.bottom() - 3.4 * u, room.width(), 3.4 * u)
        room.setBottom(foot.top() - 0.6 * u)
        self._wrapped(painter, room, self.message, 6.0, "text")
        painter.setPen(self.look.colour("accent"))
        painter.setFont(self.look.fit(self._go_on, 2.2, foot.width(), bold=True))
        put(painter, foot, LEFT, self._go_on)

    def _draw_alarm(self, painter: QPainter, alarm: Alarm) -> None:
        where = f"  ·  LINE {alarm.line}" if alarm.line else ""
        room = self._head(painter, Tone.ALARM, f"ALARM {alarm.number}{where}")
        high = room.height()
        what = QRectF(room.x(), room.y(), room.width(), 0.36 * high)
        self._wrapped(painter, what, tr(alarm.text), 3.4, "text")
        for number, (label, text) in enumerate((("CAUSE", alarm.cause), ("WHAT TO DO", alarm.remedy))):
            y = room.y() + (0.38 + 0.31 * number) * high
            self._labelled(painter, QRectF(room.x(), y, room.width(), 0.30 * high), label, text)

    def _labelled(self, painter: QPainter, room: QRectF, label: str, text: str) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.6, bold=True))
        put(painter, QRectF(room.x(), room.y(), room.width(), 2.2 * u), LEFT, label)
        self._wrapped(painter, room.adjusted(0, 2.3 * u, 0, 0), tr(text), 2.3, "text")

    def _wrapped(self, painter: QPainter, room: QRectF, text: str, size: float, colour: str) -> None:
        """Text in words, from ``size`` down as far as needed so that all of it is there."""
        painter.setPen(self.look.colour(colour))
        while True:
            painter.setFont(self.look.font(size, bold=True))
            flags = int(WRAP.value) | WORDS
            needed = painter.boundingRect(room, flags, text)
            if size <= 1.4 or (needed.height() <= room.height() and needed.width() <= room.width()):
                break
            size *= 0.9
        painter.drawText(room, flags, text)


class AlarmList(Panel):
    """The log of alarms, newest on top."""

    title = "ALARM LOG  ·  ESC CLOSES"

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.entries: tuple[Entry, ...] = ()
        self.hide()

    def show_entries(self, entries: Sequence[Entry]) -> None:
        """The log as it stands."""
        if tuple(entries) != self.entries:
            self.entries = tuple(entries)
            self.update()

    def draw(self, painter: QPainter) -> None:
        look, u = self.look, self.look.u
        room = self.inside()
        if not self.entries:
            painter.setPen(look.colour("soft"))
            painter.setFont(look.font(2.0))
            put(painter, QRectF(room.x(), room.y(), room.width(), 3 * u), LEFT, "No alarm since the start.")
        y = room.y()
        for entry in self.entries:
            if y + 5.0 * u > room.bottom():
                break
            self._entry(painter, QRectF(room.x(), y, room.width(), 5.0 * u), entry)
            y += 5.4 * u

    def _entry(self, painter: QPainter, row: QRectF, entry: Entry) -> None:
        look, u = self.look, self.look.u
        alarm = entry.alarm
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.8))
        put(painter, QRectF(row.x(), row.y(), 11 * u, 2.5 * u), LEFT, entry.at)
        line = f"line {alarm.line}" if alarm.line else ""
        put(painter, QRectF(row.x(), row.y() + 2.5 * u, 11 * u, 2.3 * u), LEFT, line)
        painter.setPen(look.colour("text"))
        painter.setFont(look.font(2.0, bold=True))
        put(painter, QRectF(row.x() + 12 * u, row.y(), row.width() - 12 * u, 2.5 * u), LEFT, alarm.text)
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.8))
        put(
            painter,
            QRectF(row.x() + 12 * u, row.y() + 2.5 * u, row.width() - 12 * u, 2.3 * u),
            LEFT,
            alarm.remedy,
        )
