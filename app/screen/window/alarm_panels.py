"""Alarm displays: the notice over the path view, and the log of alarms."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QLineEdit, QWidget

from app.desk.status.alarm_log import LoggedStop
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import describe_cause
from app.desk.translation import tr
from app.screen.panel import FocusHolder, Panel, RedrawingAttribute
from app.screen.screen_theme import MIN_TEXT_SIZE, ScreenTheme, ThemedPainter, draw_state_symbol
from app.screen.table_panel import RowPanel
from app.screen.text_area.text_area import TextArea
from core.alarms import CATALOG, AlarmReaction
from core.executor.snapshot import Alarm
from core.message import Message, join_messages

WRAP_FLAGS = int((Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop).value) | int(
    Qt.TextFlag.TextWordWrap.value
)
_SIDE_BY_SIDE_RATIO = 2.0  # Ratio of width to height above which causes and remedy are side by side.
_RECORDING_KEY_WIDTH = 12.0  # Units: width of the key that opens a recording.
# Units: height of an entry, width of the time column, height of the key row.
_HIGH, _WHEN, _FOOT = 7.0, 17.0, 6.8


class AlarmNotice(Panel):
    """Notice that shows the active alarms, with the first one large, or the message of M00 or M01."""

    message, _go_on = RedrawingAttribute(""), RedrawingAttribute("")
    _alarms: RedrawingAttribute[tuple[Alarm, ...]] = RedrawingAttribute(())

    def __init__(self, theme: ScreenTheme, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self.hide()

    def show_notice(self, message: str, continue_hint: str, alarms: tuple[Alarm, ...] = ()) -> None:
        """Show the alarms or, if there are no alarms, the message of M00 or M01.

        Hide the notice if there is neither.
        """
        self.message, self._go_on, self._alarms = message, continue_hint, alarms
        self.setVisible(bool(message or alarms))

    @property
    def has_alarm(self) -> bool:
        """Return whether the notice shows an alarm."""
        return bool(self._alarms)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the active alarms, or the message of M00 or M01 if there are no alarms."""
        if self._alarms:
            self._draw_alarm(painter, *self._alarms)
        else:
            self._draw_message(painter)

    def _head(self, painter: ThemedPainter, tone: StatusTone, text: str) -> QRectF:
        look, u = self.theme, self.theme.unit_px
        painter.fill_rect(self.find_full_area(), tone.value)
        painter.fill_rect(self.find_full_area().adjusted(0.5 * u, u, -0.5 * u, -0.5 * u), "panel")
        head = QRectF(0, 0, self.width(), 5.6 * u)
        painter.fill_rect(head, tone.value)
        draw_state_symbol(
            painter, QRectF(1.6 * u, 1.5 * u, 2.6 * u, 2.6 * u), tone, look.get_color("on_state")
        )
        painter.draw_text_line(head.adjusted(5.6 * u, 0, -u, 0), text, 2.6, "on_state", margin=1.4)
        return self.find_full_area().adjusted(2 * u, 6.8 * u, -2 * u, -1.4 * u)

    def _draw_message(self, painter: ThemedPainter) -> None:
        room = self._head(painter, StatusTone.PAUSE, "PROGRAM STOP")
        u = self.theme.unit_px
        foot = QRectF(room.x(), room.bottom() - 3.4 * u, room.width(), 3.4 * u)
        room.setBottom(foot.top() - 0.6 * u)
        self._draw_wrapped(painter, room, self.message, 6.0)
        painter.draw_text_line(foot, self._go_on, 2.2, "accent")

    def _draw_alarm(self, painter: ThemedPainter, alarm: Alarm, *more: Alarm) -> None:
        """Draw the first alarm large and the other alarms in one line.

        The first alarm has often caused the others.
        """
        parts = [
            Message("ALARM {number}: {alarms}", number=alarm.number, alarms=alarm.text),
            *([Message("LINE {line}", line=alarm.line)] if alarm.line else []),
        ]
        room = self._head(painter, StatusTone.ALARM, join_messages("  ·  ", parts))
        if more:
            room = self._draw_more(painter, room, more)
        causes = "\n".join(tr(each) for each in dict.fromkeys((alarm.cause, *alarm.causes)))
        left, right = self._divide(room)
        self._labelled(painter, left, "CAUSES, MOST LIKELY FIRST", causes)
        self._labelled(painter, right, "WHAT TO DO", tr(alarm.remedy))

    def _divide(self, room: QRectF) -> tuple[QRectF, QRectF]:
        """Return the rectangles of causes and remedy, side by side in a low area."""
        wide, high, gap = room.width(), room.height(), self.theme.unit_px
        if wide < _SIDE_BY_SIDE_RATIO * high:
            upper = room.adjusted(0, 0, 0, -0.38 * high - gap)
            return upper, room.adjusted(0, upper.height() + gap, 0, 0)
        left = room.adjusted(0, 0, -0.5 * wide - gap, 0)
        return left, room.adjusted(left.width() + 2 * gap, 0, 0, 0)

    def _draw_more(self, painter: ThemedPainter, area: QRectF, more: tuple[Alarm, ...]) -> QRectF:
        """Draw the other alarms in one line at the bottom, and return the rectangle that remains."""
        u = self.theme.unit_px
        foot = QRectF(area.x(), area.bottom() - 2.6 * u, area.width(), 2.6 * u)
        text = Message(
            "OTHER ALARMS: {number}", number="  ·  ".join(f"{each.number} {tr(each.text)}" for each in more)
        )
        painter.draw_text_line(foot, text, 1.9, "alarm")
        return area.adjusted(0, 0, 0, -3.0 * u)

    def _labelled(self, painter: ThemedPainter, room: QRectF, label: str, text: str) -> None:
        high = self.theme.find_line_height(2.0)
        painter.draw_text_line(QRectF(room.x(), room.y(), room.width(), high), label, 1.6, "soft")
        below = room.adjusted(0, high + 0.3 * self.theme.unit_px, 0, 0)
        self._draw_wrapped(painter, below, text, self.theme.find_table_size(2.3), f"…  {tr('?: MORE')}")

    def _draw_wrapped(
        self, painter: ThemedPainter, area: QRectF, text: str, size: float, ending: str = "…"
    ) -> None:
        """Draw a wrapped text, at most ``size`` theme units high, or smaller so that it fits.

        A text that does not fit with the smallest letters ends with ``ending``.
        """
        painter.setPen(self.theme.get_color("text"))
        painter.setFont(self.theme.make_font(size, is_bold=True))
        while not _fits(painter, area, text) and size > MIN_TEXT_SIZE:
            size = max(MIN_TEXT_SIZE, 0.9 * size)
            painter.setFont(self.theme.make_font(size, is_bold=True))
        painter.draw_wrapped_text(area, WRAP_FLAGS, _shorten(painter, area, text, ending))


def _fits(painter: ThemedPainter, area: QRectF, text: str) -> bool:
    """Return whether a wrapped text fits in an area with the font of the painter."""
    needed = painter.boundingRect(area, WRAP_FLAGS, text)
    return needed.height() <= area.height() and needed.width() <= area.width()


def _shorten(painter: ThemedPainter, area: QRectF, text: str, ending: str) -> str:
    """Return the text, or its longest start that fits in the area together with the ending."""
    if _fits(painter, area, text):
        return text
    ends = [match.start() for match in re.finditer(r"\s+", text)]
    count = bisect_left(ends, True, key=lambda end: not _fits(painter, area, f"{text[:end]} {ending}"))
    return f"{text[: ends[count - 1]]} {ending}" if count else ending


class AlarmList(RowPanel):
    """Log of all alarms, E-stops and stops, newest first, with time, cause and remedy.

    The selected entry remains visible while scrolling, so that a key always opens an entry that the
    operator sees.
    """

    title = "ALARMS AND STOPS  ·  ESC: CLOSE  ·  CTRL+ARROWS: SELECT  ·  SHIFT+F10: SHOW SCOPE RECORD"
    scroll_step, has_scroll_keys, is_searchable = 1, False, True
    marked = RedrawingAttribute(0)

    def __init__(self, theme: ScreenTheme, open_recording: Callable[[str], None], parent: QWidget) -> None:
        """Create the list.

        ``open_recording`` opens the recording of an entry by its file name.
        """
        super().__init__(theme, parent)
        self._open = open_recording
        self.on_select = self.mark
        self.logged_stops: tuple[LoggedStop, ...] = ()
        self._focus = FocusHolder(self)
        self.hide()

    def open_list(self) -> None:
        """Show the list over the page, and take the keyboard focus from an input field."""
        self._focus.hold_focus()
        self.show()
        self.raise_()

    @property
    def covers_focus_field(self) -> bool:
        """Return whether a standard text field had the keyboard focus when the list opened."""
        return self.isVisible() and isinstance(self._focus.covered_field, QLineEdit | TextArea)

    def close_list(self) -> None:
        """Hide the list, and return the keyboard focus to the input field that had it."""
        if self.isHidden():
            return
        self.hide()
        self._focus.return_focus()

    def show_entries(self, logged_stops: Sequence[LoggedStop]) -> None:
        """Show the given log entries, and select the newest entry if the list has changed."""
        if logged_stops is not self.logged_stops:
            self.logged_stops = tuple(logged_stops)
            self.first_row = self.marked = 0
            self.update()

    def scroll_by(self, rows: int) -> None:
        """Scroll to older entries, or to newer entries if the number is negative."""
        super().scroll_by(rows)
        shown = self.shown_rows[self.first_row : self.first_row + self.rows]
        if shown:
            self.mark(max(shown[0], min(self.marked, shown[-1])))

    def mark(self, index: int) -> None:
        """Select an entry by its index, where index 0 is the newest entry.

        An index outside the list is limited to the nearest valid index.
        """
        self.marked = max(0, min(index, len(self.logged_stops) - 1))

    def list_row_texts(self) -> Sequence[str]:
        """Return the number, text, cause, remedy and time of each entry."""
        return [
            f"{each.alarm.number} {tr(each.alarm.text)} {tr(describe_cause(each.alarm))}"
            f" {tr(each.alarm.remedy)} {each.local_time}"
            for each in self.logged_stops
        ]

    @property
    def selected_row(self) -> int:
        """Return the index of the selected entry."""
        return self.marked

    def make_key_actions(self) -> Mapping[str, Callable[[], object]]:
        """Return the actions of the keys that select an entry and open its recording."""
        return {
            "Pan up": partial(self.move_selection, "Up"),
            "Pan down": partial(self.move_selection, "Down"),
            "Scope": lambda: self._open(self.recording_name),
        }

    @property
    def recording_name(self) -> str:
        """Return the name of the selected entry's recording, or an empty string if there is no recording."""
        return self.logged_stops[self.marked].recording_name if self.marked < len(self.logged_stops) else ""

    def find_explained_alarm(self, active_alarms: Sequence[Alarm]) -> Alarm | None:
        """Return the alarm that the help explains, or None without an alarm.

        It is the selected alarm while the log is open, and the first active alarm while the log is closed.
        """
        shown = (
            [stop.alarm for stop in self.logged_stops[self.marked :]] if self.isVisible() else active_alarms
        )
        return shown[0] if shown else None

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the logged alarms and stops, or a message if the log is empty."""
        u = self.theme.unit_px
        room = self.inside()
        if not self.logged_stops:
            room.setHeight(3 * u)
            painter.draw_text_line(room, "No alarms or stops yet.", 2.0, "soft", bold=False)
            return
        foot = QRectF(room.x(), room.bottom() - _FOOT * u, room.width(), _FOOT * u)
        if len(self.logged_stops) * _HIGH * u > room.height():
            room.setBottom(foot.top())
        fits = self.count_fitting_rows(room, _HIGH * u, len(self.logged_stops))
        self.draw_scroll_keys(painter, room, fits, len(self.logged_stops), self.marked)
        for number, row in self.find_row_boxes(room, _HIGH * u):
            marked = number == self.marked
            if marked:
                painter.fill_rect(QRectF(row.x(), row.y(), 0.4 * u, (_HIGH - 0.5) * u), "lit")
            self._entry(painter, QRectF(row), self.logged_stops[number])
            self.add_target(row, partial(self.mark, number), kind="row", is_on=marked)
        self._draw_pages(painter, foot)

    def _entry(self, painter: ThemedPainter, row: QRectF, entry: LoggedStop) -> None:
        u, alarm = self.theme.unit_px, entry.alarm
        grave = (
            CATALOG[alarm.code].reaction in {AlarmReaction.DRIVES_OFF, AlarmReaction.STOP}
            or alarm.code == "estop"
        )
        left, wide = row.x() + _WHEN * u, row.width() - _WHEN * u
        row.setLeft(row.left() + 0.8 * u)
        if entry.recording_name:
            wide -= _RECORDING_KEY_WIDTH * u
            box = QRectF(
                row.right() - (_RECORDING_KEY_WIDTH - 0.8) * u,
                row.y() + 0.2 * u,
                (_RECORDING_KEY_WIDTH - 0.8) * u,
                (_HIGH - 0.8) * u,
            )
            self.key(painter, box, "SCOPE", 1.9, partial(self._open, entry.recording_name), color="accent")
        painter.fill_rect(QRectF(row.x(), row.bottom() - 0.3 * u, row.width(), 0.1 * u), "frame")
        when, ink = QRectF(row.x(), row.y(), _WHEN * u, 2.4 * u), "alarm" if grave else "text"
        painter.draw_text_line(when, entry.local_time, 1.8, "soft", bold=False, raw=True, margin=1.0)
        if alarm.line:
            place = QRectF(row.x(), row.y() + 2.3 * u, _WHEN * u, 2.1 * u)
            painter.draw_text_line(place, Message("line {line}", line=alarm.line), 1.8, "soft", bold=False)
        what = Message("{number}  ·  {alarm}", number=alarm.number, alarm=alarm.text)
        painter.draw_text_line(QRectF(left, row.y(), wide, 2.4 * u), what, 2.0, ink, fit=False)
        for y, ink, text in ((2.3, "text", describe_cause(alarm)), (4.3, "soft", alarm.remedy)):
            painter.draw_text_line(QRectF(left, row.y() + y * u, wide, 2.1 * u), text, 1.8, ink, bold=False)

    def _draw_pages(self, painter: ThemedPainter, foot: QRectF) -> None:
        """Draw touch keys that search, and that scroll to newer and to older entries, with their number.

        Each key is drawn only if there are entries in its direction.
        """
        u, older = self.theme.unit_px, len(self.shown_rows) - self.first_row - self.rows
        if self.on_search_key is not None and (self.first_row > 0 or older > 0):
            box = QRectF(foot.right() - 51 * u, foot.y(), 16 * u, foot.height())
            self.key(painter, box, "SEARCH", 2.0, self.on_search_key, margin=1.0)
        for number, (label, by, count) in enumerate(
            (("NEWER", -self.rows, self.first_row), ("OLDER", self.rows, older))
        ):
            if count <= 0:
                continue
            box = QRectF(foot.right() - (2 - number) * 17 * u, foot.y(), 16 * u, foot.height())
            self.key(
                painter,
                box,
                f"{tr(label)}: {count}",
                2.0,
                partial(self.scroll_by, by),
                is_raw=True,
                margin=1.0,
            )
