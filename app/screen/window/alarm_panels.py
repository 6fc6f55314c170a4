"""Alarms on the screen: the notice over the path view, and the log of alarms."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from app.desk.status.alarm_log import LoggedStop
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import exactly
from app.desk.translation import tr
from app.screen.look import Look, Painter, draw_sign
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import RowPanel
from core.alarms import CATALOGUE, Reaction
from core.executor.snapshot import Alarm
from core.message import Message, join_messages

WRAP = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
WORDS = int(Qt.TextFlag.TextWordWrap.value)
_RECORD = 12.0  # Units: width of the key that opens a recording.
# Units: height of an entry, width of the time column, height of the key row.
_HIGH, _WHEN, _FOOT = 7.0, 17.0, 6.8


class Notice(Panel):
    """A notice with the active alarms, the first one large, or with the message of M00 or M01."""

    message, _go_on = Shown(""), Shown("")
    _alarms: Shown[tuple[Alarm, ...]] = Shown(())

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.hide()

    def show_notice(self, message: str, go_on: str, alarms: tuple[Alarm, ...] = ()) -> None:
        """Show the alarms, or else the message. Hide the notice if there is neither."""
        self.message, self._go_on, self._alarms = message, go_on, alarms
        self.setVisible(bool(message or alarms))

    def draw(self, painter: Painter) -> None:
        if self._alarms:
            self._draw_alarm(painter, *self._alarms)
        else:
            self._draw_message(painter)

    def _head(self, painter: Painter, tone: Tone, text: str) -> QRectF:
        look, u = self.look, self.look.u
        painter.fill(self.area(), tone.value)
        painter.fill(self.area().adjusted(0.5 * u, u, -0.5 * u, -0.5 * u), "panel")
        head = QRectF(0, 0, self.width(), 5.6 * u)
        painter.fill(head, tone.value)
        draw_sign(painter, QRectF(1.6 * u, 1.5 * u, 2.6 * u, 2.6 * u), tone, look.colour("on_state"))
        painter.write(head.adjusted(5.6 * u, 0, -u, 0), text, 2.6, "on_state", margin=1.4)
        return self.area().adjusted(2 * u, 6.8 * u, -2 * u, -1.4 * u)

    def _draw_message(self, painter: Painter) -> None:
        room = self._head(painter, Tone.PAUSE, "PROGRAM STOP")
        u = self.look.u
        foot = QRectF(room.x(), room.bottom() - 3.4 * u, room.width(), 3.4 * u)
        room.setBottom(foot.top() - 0.6 * u)
        self._wrapped(painter, room, self.message, 6.0)
        painter.write(foot, self._go_on, 2.2, "accent")

    def _draw_alarm(self, painter: Painter, alarm: Alarm, *more: Alarm) -> None:
        """Draw the first alarm large and the others in one line. The first often caused the others."""
        parts = [
            Message("ALARM {number}: {alarms}", number=alarm.number, alarms=alarm.text),
            *([Message("LINE {line}", line=alarm.line)] if alarm.line else []),
        ]
        room = self._head(painter, Tone.ALARM, join_messages("  ·  ", parts))
        if more:
            room = self._draw_more(painter, room, more)
        high = room.height()
        causes = "\n".join(tr(each) for each in dict.fromkeys((alarm.cause, *alarm.causes)))
        for label, text, y, part in (
            ("CAUSES, MOST LIKELY FIRST", causes, 0.0, 0.62),
            ("WHAT TO DO", tr(alarm.remedy), 0.64, 0.36),
        ):
            box = QRectF(room.x(), room.y() + y * high, room.width(), part * high)
            self._labelled(painter, box, label, text)

    def _draw_more(self, painter: Painter, room: QRectF, more: tuple[Alarm, ...]) -> QRectF:
        """Draw the other alarms in one line at the bottom, and return the rectangle that remains."""
        u = self.look.u
        foot = QRectF(room.x(), room.bottom() - 2.6 * u, room.width(), 2.6 * u)
        text = Message(
            "OTHER ALARMS: {number}", number="  ·  ".join(f"{each.number} {tr(each.text)}" for each in more)
        )
        painter.write(foot, text, 1.9, "alarm")
        return room.adjusted(0, 0, 0, -3.0 * u)

    def _labelled(self, painter: Painter, room: QRectF, label: str, text: str) -> None:
        u = self.look.u
        painter.write(QRectF(room.x(), room.y(), room.width(), 2.0 * u), label, 1.6, "soft")
        self._wrapped(painter, room.adjusted(0, 2.1 * u, 0, 0), text, 2.3)

    def _wrapped(self, painter: Painter, room: QRectF, text: str, size: float) -> None:
        """Draw a wrapped text, not larger than ``size``, and small enough to fit."""
        painter.setPen(self.look.colour("text"))
        while True:
            painter.setFont(self.look.font(size, bold=True))
            flags = int(WRAP.value) | WORDS
            needed = painter.boundingRect(room, flags, text)
            if size <= 1.4 or (needed.height() <= room.height() and needed.width() <= room.width()):
                break
            size *= 0.9
        painter.wrap(room, flags, text)


class AlarmList(RowPanel):
    """All alarms, E-stops and stops, newest first, with time, cause and remedy.

    The selected entry stays visible while scrolling, so that a key opens an entry that the operator sees.
    """

    title = "ALARMS AND STOPS  ·  ESC: CLOSE  ·  CTRL+ARROWS: SELECT  ·  SHIFT+F10: SHOW SCOPE RECORD"
    notch, keyed = 1, False
    marked = Shown(0)

    def __init__(self, look: Look, open_record: Callable[[str], None], parent: QWidget) -> None:
        """Create the list. ``open_record`` opens the recording of an entry by its file name."""
        super().__init__(look, parent)
        self._open = open_record
        self.entries: tuple[LoggedStop, ...] = ()
        self.hide()

    def show_entries(self, entries: Sequence[LoggedStop]) -> None:
        """Show these entries, and select the newest if the list has changed."""
        if entries is not self.entries:
            self.entries = tuple(entries)
            self.top = self.marked = 0
            self.update()

    def scroll_by(self, rows: int) -> None:
        """Scroll to older entries, or to newer ones with a negative number."""
        super().scroll_by(rows)
        self.mark(max(self.top, min(self.marked, self.top + self.rows - 1)))

    def mark(self, number: int) -> None:
        """Select an entry, counted from 0 for the newest. The number is limited to the list."""
        self.marked = max(0, min(number, len(self.entries) - 1))

    @property
    def record(self) -> str:
        """The name of the selected entry's recording. Empty without a recording."""
        return self.entries[self.marked].record if self.marked < len(self.entries) else ""

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        room = self.inside()
        if not self.entries:
            room.setHeight(3 * u)
            painter.write(room, "No alarms or stops yet.", 2.0, "soft", bold=False)
            return
        foot = QRectF(room.x(), room.bottom() - _FOOT * u, room.width(), _FOOT * u)
        room.setBottom(foot.top())
        fits = self.fitting(room, _HIGH * u, len(self.entries))
        self.scrolled(painter, room, fits, len(self.entries), self.marked)
        for number, row in self.boxes(room, _HIGH * u):
            marked = number == self.marked
            if marked:
                painter.fill(QRectF(row.x(), row.y(), 0.4 * u, (_HIGH - 0.5) * u), "lit")
            self._entry(painter, QRectF(row), self.entries[number])
            self.place(row, partial(self.mark, number), kind="row", on=marked)
        self._pages(painter, foot)

    def _entry(self, painter: Painter, row: QRectF, entry: LoggedStop) -> None:
        u, alarm = self.look.u, entry.alarm
        grave = CATALOGUE[alarm.code].reaction in {Reaction.OFF, Reaction.STOP} or alarm.code == "estop"
        left, wide = row.x() + _WHEN * u, row.width() - _WHEN * u
        row.setLeft(row.left() + 0.8 * u)
        if entry.record:
            wide -= _RECORD * u
            box = QRectF(
                row.right() - (_RECORD - 0.8) * u, row.y() + 0.2 * u, (_RECORD - 0.8) * u, (_HIGH - 0.8) * u
            )
            self.key(painter, box, "SCOPE", 1.9, partial(self._open, entry.record), ink="accent")
        painter.fill(QRectF(row.x(), row.bottom() - 0.3 * u, row.width(), 0.1 * u), "frame")
        when, ink = QRectF(row.x(), row.y(), _WHEN * u, 2.4 * u), "alarm" if grave else "text"
        painter.write(when, entry.at, 1.8, "soft", bold=False, raw=True, margin=1.0)
        if alarm.line:
            place = QRectF(row.x(), row.y() + 2.3 * u, _WHEN * u, 2.1 * u)
            painter.write(place, Message("line {line}", line=alarm.line), 1.8, "soft", bold=False)
        what = Message("{number}  ·  {alarm}", number=alarm.number, alarm=alarm.text)
        painter.write(QRectF(left, row.y(), wide, 2.4 * u), what, 2.0, ink, fit=False)
        for y, ink, text in ((2.3, "text", exactly(alarm)), (4.3, "soft", alarm.remedy)):
            painter.write(QRectF(left, row.y() + y * u, wide, 2.1 * u), text, 1.8, ink, bold=False)

    def _pages(self, painter: Painter, foot: QRectF) -> None:
        """Draw two touch keys that scroll to newer and older entries, if there are any."""
        u = self.look.u
        for number, (label, by) in enumerate((("NEWER", -self.rows), ("OLDER", self.rows))):
            possible = self.top > 0 if by < 0 else self.top + self.rows < len(self.entries)
            if not possible:
                continue
            box = QRectF(foot.right() - (2 - number) * 17 * u, foot.y(), 16 * u, foot.height())
            self.key(painter, box, label, 2.0, partial(self.scroll_by, by))
