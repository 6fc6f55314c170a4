"""Displays of position, feed, spindle, tool, parts and times.

They are large on the Automatic page, and in one row on all other pages.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from app.desk.status import formats
from app.desk.status.formats import percent
from app.desk.status.machine_status import MachineStatus, Tone
from app.desk.status.readouts import UNKNOWN, AxisFigures, FeedFigures, PositionFigures, SpindleFigures
from app.desk.translation import tr
from app.screen.look import CENTRE, LEFT, RIGHT, Look, Painter, draw_sign, put
from app.screen.panel import Panel, Shown
from app.screen.text_sizes import Role
from core.message import Message, join_messages

LATHE_ROWS = 3
ROOMY = 6.3  # Units of row height that numbers of full size need.


class PositionPanel(Panel):
    """The position display. X has a filled Ø or a hollow R, so that the operator cannot confuse them."""

    view: Shown[PositionFigures | None] = Shown(None)  # All values of one instant, in one unit.

    @property
    def readout(self) -> str:
        """The kind of value that the large numbers show."""
        return self.view.readout.value if self.view else ""

    def draw(self, painter: Painter) -> None:
        view = self.view
        if view is None:
            self.frame(painter, "POSITION")
            return
        u = self.look.u
        self.frame(painter, join_messages("  ·  ", (view.readout.value, view.unit, view.x_words)))
        self._heading(painter, view)
        room = QRectF(0, 3.0 * u, self.width(), self.height() - 3.6 * u)
        high = min(room.height() / len(view.axes), 10.5 * u)
        top = room.center().y() - high * len(view.axes) / 2
        for row, axis in enumerate(view.axes):
            self._row(painter, QRectF(0, top + row * high, room.width(), high), axis)
            if row:
                line = QRectF(1.2 * u, top + row * high, room.width() - 2.4 * u, max(1.0, 0.08 * u))
                painter.fill(line, "key")

    def _heading(self, painter: Painter, view: PositionFigures) -> None:
        u = self.look.u
        place = QRectF(0, 1.8 * u, self.width() - 1.6 * u, 2.0 * u)
        painter.write(place, view.beside.value, 1.5, "soft", at=RIGHT)

    def _row(self, painter: Painter, row: QRectF, axis: AxisFigures) -> None:
        u = self.look.u
        share = self._share(row)
        painter.write(QRectF(1.8 * u, row.y(), 5.6 * u, row.height()), axis.name, 5.6 * share, "accent")
        if axis.mark:
            box = QRectF(7.4 * u, row.center().y() - 2.6 * u, 4.8 * u, 5.2 * u)
            draw_mark(painter, box, axis.mark, 4.6, 0.4)
        large = QRectF(13.2 * u, row.y(), 38.4 * u, row.height())
        plain = axis.homed and axis.known
        painter.write(
            large, axis.value, 7.0 * share, "text" if plain else "soft", at=RIGHT, role=Role.POSITION
        )
        beside = QRectF(52.4 * u, row.y(), self.width() - 54.0 * u, row.height())
        painter.write(beside, axis.beside, 2.7 * max(share, 0.8), "soft", at=RIGHT, bold=False)
        if not plain:
            above = QRectF(beside.x(), row.y() + 0.6 * u, beside.width(), 2.0 * u)
            painter.write(above, "NOT HOMED" if axis.known else "LAST KNOWN", 1.5, "alarm", at=RIGHT)

    def _share(self, row: QRectF) -> float:
        """Return the scale of the numbers. A mill with five axes has less room per row than a lathe."""
        few = self.view is None or len(self.view.axes) <= LATHE_ROWS
        return 1.0 if few else min(1.0, row.height() / (ROOMY * self.look.u))


def draw_mark(painter: Painter, box: QRectF, mark: str, size: float, line: float) -> None:
    """Draw the mark of X: a filled Ø for a diameter, a hollow R for a radius. Sizes are in units."""
    filled = mark == "Ø"
    painter.box(box, "mark", line, "mark" if filled else "")
    painter.write(box, mark, size, "on_mark" if filled else "mark", at=CENTRE)


# --- feed, spindle, tool and times --------------------------------------------------------------------


class Gauge(Panel):
    """A panel that draws one immutable value. Setting an equal value does not redraw the panel."""

    value: Shown[object] = Shown(None)

    def __init__(self, look: Look, title: str, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.title = title

    def row(self, y: float, high: float) -> QRectF:
        """Return a row inside the frame. ``y`` and ``high`` are in units."""
        u = self.look.u
        return QRectF(1.4 * u, y * u, self.width() - 2.8 * u, high * u)

    def label(self, painter: Painter, at: QRectF, text: str, flags: Qt.AlignmentFlag = LEFT) -> None:
        """Draw a small label for a value."""
        painter.write(at, text, 1.6, "soft", at=flags)

    def figure(
        self,
        painter: Painter,
        at: QRectF,
        text: str,
        size: float,
        flags: Qt.AlignmentFlag = RIGHT,
        role: Role = Role.TABLE,
    ) -> None:
        """Draw a value in bold, smaller if its place is narrow."""
        painter.write(at, text, size, "text", at=flags, role=role)

    def bar(self, painter: Painter, at: QRectF, fraction: float, most: float) -> None:
        """Draw an override as a bar with its percentage. A value other than 100 % is highlighted."""
        u = self.look.u
        plain = abs(fraction - 1.0) < 0.005
        figure = QRectF(at.right() - 9 * u, at.y(), 9 * u, at.height())
        track = QRectF(at.x(), at.center().y() - 0.6 * u, at.width() - 9.6 * u, 1.2 * u)
        painter.fill(track, "key")
        share = max(0.0, min(1.0, fraction / most))
        filled = QRectF(track.x(), track.y(), track.width() * share, track.height())
        painter.fill(filled, "accent" if plain else "pause")
        full = track.x() + track.width() / most
        painter.fill(QRectF(full - 0.1 * u, track.y() - 0.4 * u, 0.2 * u, 2.0 * u), "text")
        painter.write(figure, formats.percent(fraction), 2.1, "text" if plain else "pause", at=RIGHT)


class FeedGauge(Gauge):
    """Programmed feed in large digits, with the measured feed and the override below."""

    def draw(self, painter: Painter) -> None:
        view = self.value
        if not isinstance(view, FeedFigures):
            return
        top = self.row(2.3, 4.8)
        unit = QRectF(top.right() - 7.6 * self.look.u, top.y(), 7.6 * self.look.u, top.height())
        self.figure(painter, top.adjusted(0, 0, -8.2 * self.look.u, 0), view.value, 4.2, role=Role.FEED)
        self.label(painter, unit.adjusted(0, 1.0 * self.look.u, 0, 1.0 * self.look.u), view.unit)
        self.label(painter, top, view.prefix)
        actual = self.row(7.4, 2.8)
        self.label(painter, actual, "ACTUAL")
        self.figure(painter, actual.adjusted(7 * self.look.u, 0, -8.2 * self.look.u, 0), view.actual, 2.5)
        self.label(painter, QRectF(unit.x(), actual.y(), unit.width(), actual.height()), view.actual_unit)
        self.bar(painter, self.row(11.2, 2.8), view.override, 1.5)


class SpindleGauge(Gauge):
    """Commanded and measured speed in rpm, surface speed, override and the spindle switch."""

    def draw(self, painter: Painter) -> None:
        view = self.value
        if not isinstance(view, SpindleFigures):
            return
        u = self.look.u
        top = self.row(2.3, 4.8)
        if not view.known:
            self._unheard(painter)
            return
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
        if view.load:
            # In the top line, next to the title.
            patch = QRectF(self.width() - 11.0 * u, 0.0, 9.8 * u, 2.0 * u)
            painter.fill(patch, "panel")
            painter.write(patch, f"{tr('LOAD')} {view.load}", 1.6, "soft", at=CENTRE)

    def _unheard(self, painter: Painter) -> None:
        """Draw a warning in place of all values, because the spindle's state is unknown."""
        for row, size, text in (
            (self.row(2.6, 4.0), 3.6, "UNKNOWN"),
            (self.row(7.0, 3.0), 2.4, "SPINDLE MAY BE TURNING"),
            (self.row(10.6, 3.0), 2.4, "PRESS E-STOP"),
        ):
            painter.fill(row, "alarm")
            painter.write(row, text, size, "on_state", at=CENTRE)

    def _switch(self, painter: Painter, box: QRectF, view: SpindleFigures) -> None:
        painter.fill(box, "key" if view.auto else "alarm")
        text = "AUTO" if view.auto else "SWITCH: OFF"
        painter.write(box, text, 1.5, "text" if view.auto else "on_state", at=CENTRE, margin=0.4)


class ToolGauge(Gauge):
    """Active tool and secondary offset."""

    def draw(self, painter: Painter) -> None:
        if not isinstance(self.value, tuple):
            return
        tool, secondary = self.value
        room = self.inside()
        half = room.width() / 2
        left = QRectF(room.x(), room.y(), half, room.height())
        for at, text in ((left, tool), (left.translated(half, 0), secondary)):
            self.figure(painter, at, text, 4.6, CENTRE)


class TimesGauge(Gauge):
    """Part count, present cycle time, remaining time and last cycle time."""

    def draw(self, painter: Painter) -> None:
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


# --- readouts in one row ------------------------------------------------------------------------------


LATHE_COLUMNS = 3  # X, Z and C. A mill has more axes.
HIGH = 9.0  # Units: a higher panel has room for large positions.


class HeadLine(Panel):
    """All readouts of one snapshot. X has a filled Ø or a hollow R.

    A low panel shows them in one row. A high panel shows large positions above the other readouts.
    """

    view: MachineStatus | None = None
    _shown: Shown[object] = Shown(None)

    def show_view(self, view: MachineStatus) -> None:
        """Show a status, and redraw if a value has changed."""
        self.view = view
        self._shown = (view.position, view.feed, view.spindle, view.tool, view.secondary)

    def draw(self, painter: Painter) -> None:
        view = self.view
        if view is None:
            return
        position = view.position
        self.frame(painter, join_messages("  ·  ", (position.readout.value, position.unit, position.x_words)))
        u = self.look.u
        room = self.area().adjusted(1.2 * u, 2.2 * u, -1.2 * u, -0.6 * u)
        columns = max(LATHE_COLUMNS, len(position.axes))
        if self.height() > HIGH * u:
            row = QRectF(room.x(), room.y() - 0.4 * u, room.width(), room.height() - 2.2 * u)
            self._axes(painter, row, position, room.width() / columns, 1.7)
            self._readings(
                painter, QRectF(room.x(), row.bottom(), room.width(), room.bottom() - row.bottom())
            )
            return
        share = (0.58 if columns == LATHE_COLUMNS else 0.7) * room.width() / columns
        self._axes(painter, room, position, share, 1.0)
        taken = columns * share
        rest = QRectF(room.x() + taken, room.y(), room.width() - taken, room.height())
        self._figures(painter, rest, view)

    def _axes(
        self, painter: Painter, room: QRectF, position: PositionFigures, share: float, scale: float
    ) -> None:
        look, gap = self.look, 1.8 * self.look.u
        texts = [axis.value if axis.known else f"{axis.value} {UNKNOWN}" for axis in position.axes]
        size = look.em(3.4 * scale, Role.POSITION, room.height())
        rooms = [share - gap - _before(axis) * scale * look.u for axis in position.axes]
        fonts = [look.fit(text, size, each, bold=True) for text, each in zip(texts, rooms, strict=True)]
        size = min(font.pixelSize() for font in fonts) / look.u  # All axes have the same size.
        for number, (axis, text) in enumerate(zip(position.axes, texts, strict=True)):
            at = QRectF(room.x() + number * share, room.y(), share - gap, room.height())
            self._name(painter, at, axis, scale)
            ink = "text" if axis.homed and axis.known else "alarm"
            painter.write(at, text, size, ink, at=RIGHT, fit=False, role=Role.POSITION)

    def _name(self, painter: Painter, at: QRectF, axis: AxisFigures, scale: float) -> None:
        u = scale * self.look.u
        painter.write(QRectF(at.x(), at.y(), 3 * u, at.height()), axis.name, 2.8 * scale, "accent")
        if axis.mark:
            box = QRectF(at.x() + 2.8 * u, at.center().y() - 1.5 * u, 3.0 * u, 3.0 * u)
            draw_mark(painter, box, axis.mark, 2.4 * scale, 0.25)

    def _cells(self, view: MachineStatus) -> tuple[tuple[str, str, float], ...]:
        """Return label, value and share of the width of feed, spindle and tool."""
        feed, spindle = view.feed, view.spindle
        return (
            (
                Message("FEED {override}", override=percent(feed.override)),
                f"{feed.prefix} {feed.actual} {tr(feed.actual_unit)}".strip(),
                0.36,
            ),
            (
                Message("SPINDLE {override}", override=percent(spindle.override)),
                f"{tr(spindle.direction)} {spindle.rpm}/{spindle.actual}",
                0.44,
            ),
            ("TOOL", f"{view.tool} {view.secondary}", 0.2),
        )

    def _figures(self, painter: Painter, room: QRectF, view: MachineStatus) -> None:
        """Draw feed, spindle and tool, each with its label above."""
        u, x = self.look.u, room.x() + 1.6 * self.look.u
        for label, figure, share in self._cells(view):
            wide = share * (room.width() - 1.6 * u)
            painter.write(QRectF(x, room.y() - 0.4 * u, wide - u, 1.9 * u), label, 1.5, "soft")
            below = QRectF(x, room.y() + 1.5 * u, wide - 1.6 * u, room.height() - 1.7 * u)
            painter.write(below, figure, 2.3, "text", role=Role.FEED)
            x += wide

    def _readings(self, painter: Painter, room: QRectF) -> None:
        """Draw feed, spindle and tool in one row, each with its label at the left."""
        if self.view is None:
            return
        u, x = self.look.u, room.x()
        for label, figure, share in self._cells(self.view):
            wide = share * room.width() - u
            named = QRectF(x, room.y(), 0.38 * wide, room.height())
            painter.write(named, label, 1.6, "soft")
            value = named.adjusted(named.width() + 0.6 * u, 0, wide - named.width(), 0)
            painter.write(value, figure, 2.5, "text", role=Role.FEED)
            x += wide + u


def _before(axis: AxisFigures) -> float:
    """Return the width of the name and the mark of an axis in units."""
    return 6.8 if axis.mark else 3.2


# --- run in one row -----------------------------------------------------------------------------------


Times = Sequence[tuple[str, str]]
COMMENT, BLOCK = 0.38, 0.24  # Fractions of the width. Parts and times use the rest.


class RunLine(Panel):
    """One row with comment, block, parts and times, at the place of the Automatic page's comment."""

    ground = "panel"
    comment, block, message = Shown(""), Shown(""), Shown("")
    times: Shown[Times] = Shown(())
    stop = Shown("")  # Number and text of the alarm or stop.
    _tone = Shown("")

    def show_run(self, view: MachineStatus, times: Times) -> None:
        """Show a status and times, and redraw if they have changed."""
        self.comment, self.message, self.times = view.comment, view.message, times
        self.block = f"L{view.line}  {view.block_text}" if view.line else ""
        self.stop, self._tone = stop_words(view), view.tone.value

    def draw(self, painter: Painter) -> None:
        u, wide, high = self.look.u, float(self.width()), float(self.height())
        if self.stop:
            self._alarm(painter)
            return
        comment = QRectF(1.4 * u, 0, COMMENT * wide - 2 * u, high)
        block = QRectF(COMMENT * wide, 0, BLOCK * wide - u, high)
        if self.message:
            self._stop(painter, comment.united(block))
        else:
            self._text(painter, comment, "accent", self.comment)
            self._text(painter, block, "text", self.block)
        self._times(painter, QRectF((COMMENT + BLOCK) * wide, 0, (1 - COMMENT - BLOCK) * wide - u, high))

    def _alarm(self, painter: Painter) -> None:
        """Draw the alarm over the whole row, large enough to read from the machine."""
        look, u = self.look, self.look.u
        painter.fill(self.area(), self._tone)
        sign = QRectF(u, 0.3 * u, 2.2 * u, 2.2 * u)
        draw_sign(painter, sign, Tone(self._tone), look.colour("on_state"))
        painter.write(self.area().adjusted(4.4 * u, 0, -u, 0), self.stop, 2.5, "on_state")

    def _text(self, painter: Painter, box: QRectF, ink: str, text: str) -> None:
        painter.write(box, text, 2.0, ink, bold=ink == "text", raw=True)

    def _stop(self, painter: Painter, box: QRectF) -> None:
        """Draw the message of M00 or M01 over comment and block, as long as the stop lasts."""
        painter.fill(box.adjusted(-1.4 * self.look.u, 0, 0, 0), "pause")
        painter.write(box, self.message, 2.4, "on_state", raw=True)

    def _times(self, painter: Painter, room: QRectF) -> None:
        """Draw the times in columns, each with its name and value side by side."""
        u, share = self.look.u, room.width() / max(1, len(self.times))
        for number, (name, figure) in enumerate(self.times):
            box = QRectF(room.x() + number * share, 0, share - 0.8 * u, room.height())
            half = 0.46 * box.width()
            painter.write(QRectF(box.x(), 0, half, box.height()), name, 1.5, "soft", at=RIGHT)
            painter.write(box.adjusted(half + u, 0, 0, 0), figure, 2.0, "text", raw=True)


def stop_words(view: MachineStatus) -> str:
    """Return the number and text of the first alarm, the E-stop, or an unrequested feed hold."""
    first = view.alarms[0] if view.alarms else view.stop
    if first is None:
        return ""
    parts = [
        Message("ALARM {number}: {alarms}", number=first.number, alarms=first.text)
        if view.alarms
        else Message("STOP {number}: {first}", number=first.number, first=first.text)
    ]
    if first.line:
        parts.append(Message("LINE {line}", line=first.line))
    if len(view.alarms) > 1:
        parts.append(Message("AND {alarms_count} MORE", alarms_count=len(view.alarms) - 1))
    return join_messages("  ·  ", parts)
