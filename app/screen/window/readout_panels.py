"""Displays of position, feed, spindle, tool, parts and times.

They are large on the Automatic page, and in one row on all other pages.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from app.desk.status import formats
from app.desk.status.formats import format_percent
from app.desk.status.machine_status import MachineStatus
from app.desk.status.readouts import UNKNOWN_VALUE, AxisReadout, FeedReadout, PositionReadout, SpindleReadout
from app.desk.translation import tr
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import (
    ALIGN_CENTER,
    ALIGN_LEFT,
    ALIGN_RIGHT,
    ScreenTheme,
    ThemedPainter,
    draw_text,
)
from app.screen.text_sizes import TextRole
from core.message import Message, join_messages

LATHE_ROW_COUNT = 3
FULL_SIZE_ROW_HEIGHT = 6.3  # Units of row height that numbers of full size need.


class PositionPanel(Panel):
    """Position display.

    X has a filled Ø (diameter) or a hollow R (radius), so that the operator cannot confuse the two.
    """

    position_readout: RedrawingAttribute[PositionReadout | None] = RedrawingAttribute(
        None
    )  # All values of one instant, in one unit.

    @property
    def readout_kind(self) -> str:
        """Return the kind of value that the large numbers show."""
        return self.position_readout.main_kind.value if self.position_readout else ""

    def draw(self, painter: ThemedPainter) -> None:
        """Draw one row per axis.

        The title contains the kind of readout, the unit and the symbol of X (Ø or R).
        """
        view = self.position_readout
        if view is None:
            self.frame(painter, "POSITION")
            return
        u = self.theme.unit_px
        self.frame(painter, join_messages("  ·  ", (view.main_kind.value, view.unit, view.x_label)))
        self._heading(painter, view)
        room = QRectF(0, 3.0 * u, self.width(), self.height() - 3.6 * u)
        high = min(room.height() / len(view.axes), 10.5 * u)
        top = room.center().y() - high * len(view.axes) / 2
        for row, axis in enumerate(view.axes):
            self._row(painter, QRectF(0, top + row * high, room.width(), high), axis)
            if row:
                line = QRectF(1.2 * u, top + row * high, room.width() - 2.4 * u, max(1.0, 0.08 * u))
                painter.fill_rect(line, "key")

    def _heading(self, painter: ThemedPainter, view: PositionReadout) -> None:
        u = self.theme.unit_px
        place = QRectF(0, 1.8 * u, self.width() - 1.6 * u, 2.0 * u)
        painter.draw_text_line(place, view.second_kind.value, 1.5, "soft", at=ALIGN_RIGHT)

    def _row(self, painter: ThemedPainter, row: QRectF, axis: AxisReadout) -> None:
        u = self.theme.unit_px
        share = self._find_row_share(row)
        painter.draw_text_line(
            QRectF(1.8 * u, row.y(), 5.6 * u, row.height()), axis.name, 5.6 * share, "accent"
        )
        if axis.diameter_mark:
            box = QRectF(7.4 * u, row.center().y() - 2.6 * u, 4.8 * u, 5.2 * u)
            draw_x_symbol(painter, box, axis.diameter_mark, 4.6, 0.4)
        large = QRectF(13.2 * u, row.y(), 38.4 * u, row.height())
        plain = axis.is_homed and axis.is_known
        painter.draw_text_line(
            large,
            axis.value,
            7.0 * share,
            "text" if plain else "soft",
            at=ALIGN_RIGHT,
            role=TextRole.POSITION,
        )
        second_box = QRectF(52.4 * u, row.y(), self.width() - 54.0 * u, row.height())
        painter.draw_text_line(
            second_box, axis.second_value, 2.7 * max(share, 0.8), "soft", at=ALIGN_RIGHT, bold=False
        )
        if not plain:
            above = QRectF(second_box.x(), row.y() + 0.6 * u, second_box.width(), 2.0 * u)
            painter.draw_text_line(
                above, "NOT HOMED" if axis.is_known else "LAST KNOWN", 1.5, "alarm", at=ALIGN_RIGHT
            )

    def _find_row_share(self, row: QRectF) -> float:
        """Return the text scale of the position values, which depends on the space per row.

        A mill with five axes has less space per row than a lathe.
        """
        few = self.position_readout is None or len(self.position_readout.axes) <= LATHE_ROW_COUNT
        return 1.0 if few else min(1.0, row.height() / (FULL_SIZE_ROW_HEIGHT * self.theme.unit_px))


def draw_x_symbol(painter: ThemedPainter, box: QRectF, symbol: str, size: float, line_width: float) -> None:
    """Draw the symbol of X, which is a filled Ø for a diameter or a hollow R for a radius.

    Sizes are in theme units.
    """
    filled = symbol == "Ø"
    painter.draw_box(box, "mark", line_width, "mark" if filled else "")
    painter.draw_text_line(box, symbol, size, "on_mark" if filled else "mark", at=ALIGN_CENTER)


# --- feed, spindle, tool and times --------------------------------------------------------------------


class ReadoutPanel(Panel):
    """Panel that draws the values of one immutable object.

    If an equal object is set, the panel is not redrawn.
    """

    value: RedrawingAttribute[object] = RedrawingAttribute(None)

    def __init__(self, theme: ScreenTheme, title: str, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self.title = title

    def make_row_area(self, y: float, height: float) -> QRectF:
        """Return the rectangle of a row inside the frame.

        ``y`` and ``height`` are in theme units.
        """
        u = self.theme.unit_px
        return QRectF(1.4 * u, y * u, self.width() - 2.8 * u, height * u)

    def draw_label(
        self, painter: ThemedPainter, rect: QRectF, text: str, flags: Qt.AlignmentFlag = ALIGN_LEFT
    ) -> None:
        """Draw a small label for a value."""
        painter.draw_text_line(rect, text, 1.6, "soft", at=flags)

    def draw_value(
        self,
        painter: ThemedPainter,
        rect: QRectF,
        text: str,
        size: float,
        flags: Qt.AlignmentFlag = ALIGN_RIGHT,
        role: TextRole = TextRole.TABLE,
    ) -> None:
        """Draw a value in bold, and make it smaller if its area is narrow."""
        painter.draw_text_line(rect, text, size, "text", at=flags, role=role)

    def draw_override(self, painter: ThemedPainter, rect: QRectF, fraction: float, maximum: float) -> None:
        """Draw an override as a bar with its percentage, highlighted if it is not 100 %."""
        u = self.theme.unit_px
        plain = abs(fraction - 1.0) < 0.005
        figure = QRectF(rect.right() - 9 * u, rect.y(), 9 * u, rect.height())
        track = QRectF(rect.x(), rect.center().y() - 0.6 * u, rect.width() - 9.6 * u, 1.2 * u)
        painter.fill_rect(track, "key")
        share = max(0.0, min(1.0, fraction / maximum))
        filled = QRectF(track.x(), track.y(), track.width() * share, track.height())
        painter.fill_rect(filled, "accent" if plain else "pause")
        full = track.x() + track.width() / maximum
        painter.fill_rect(QRectF(full - 0.1 * u, track.y() - 0.4 * u, 0.2 * u, 2.0 * u), "text")
        painter.draw_text_line(
            figure, formats.format_percent(fraction), 2.1, "text" if plain else "pause", at=ALIGN_RIGHT
        )


class FeedPanel(ReadoutPanel):
    """Display of the programmed feed in large digits, with the measured feed and the override below it."""

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the programmed feed with its unit, and the measured feed and the override below it."""
        view = self.value
        if not isinstance(view, FeedReadout):
            return
        top = self.make_row_area(2.3, 4.8)
        unit = QRectF(top.right() - 7.6 * self.theme.unit_px, top.y(), 7.6 * self.theme.unit_px, top.height())
        self.draw_value(
            painter,
            top.adjusted(0, 0, -8.2 * self.theme.unit_px, 0),
            view.programmed_value,
            4.2,
            role=TextRole.FEED,
        )
        self.draw_label(
            painter,
            unit.adjusted(0, 1.0 * self.theme.unit_px, 0, 1.0 * self.theme.unit_px),
            view.programmed_unit,
        )
        self.draw_label(painter, top, view.value_prefix)
        actual = self.make_row_area(7.4, 2.8)
        self.draw_label(painter, actual, "ACTUAL")
        self.draw_value(
            painter,
            actual.adjusted(7 * self.theme.unit_px, 0, -8.2 * self.theme.unit_px, 0),
            view.measured_value,
            2.5,
        )
        self.draw_label(
            painter, QRectF(unit.x(), actual.y(), unit.width(), actual.height()), view.measured_unit
        )
        self.draw_override(painter, self.make_row_area(11.2, 2.8), view.override_fraction, 1.5)


class SpindlePanel(ReadoutPanel):
    """Display of commanded and measured speed in rpm, surface speed, override and the spindle switch."""

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the spindle speeds, direction, surface speed, override and spindle switch.

        The spindle speeds are in rpm. If the spindle state is unknown, draw a warning instead.
        """
        view = self.value
        if not isinstance(view, SpindleReadout):
            return
        u = self.theme.unit_px
        top = self.make_row_area(2.3, 4.8)
        if not view.is_known:
            self._draw_unknown(painter)
            return
        self.draw_label(painter, QRectF(top.x(), top.y() - u, 11.6 * u, top.height()), view.direction)
        self._switch(painter, QRectF(top.x(), top.y() + 2.8 * u, 9.2 * u, 2.0 * u), view)
        unit = QRectF(top.right() - 5.0 * u, top.y() + u, 5.0 * u, top.height())
        self.draw_value(painter, top.adjusted(12 * u, 0, -5.6 * u, 0), view.commanded_rpm, 4.2)
        self.draw_label(painter, unit, "rpm")
        actual = self.make_row_area(7.4, 2.8)
        half = actual.width() * 0.50
        self.draw_label(painter, actual, "ACTUAL")
        self.draw_value(
            painter,
            QRectF(actual.x() + 7 * u, actual.y(), half - 7 * u, actual.height()),
            view.measured_rpm,
            2.5,
        )
        surface = QRectF(actual.x() + half + 1.6 * u, actual.y(), half - 1.6 * u, actual.height())
        self.draw_label(painter, surface, view.surface_speed_label)
        self.draw_value(painter, surface.adjusted(5 * u, 0, 0, 0), view.surface_speed, 2.5)
        self.draw_override(painter, self.make_row_area(11.2, 2.8), view.override_fraction, 1.0)
        if view.load_text:
            # In the top line, next to the title.
            patch = QRectF(self.width() - 11.0 * u, 0.0, 9.8 * u, 2.0 * u)
            painter.fill_rect(patch, "panel")
            painter.draw_text_line(patch, f"{tr('LOAD')} {view.load_text}", 1.6, "soft", at=ALIGN_CENTER)

    def _draw_unknown(self, painter: ThemedPainter) -> None:
        """Draw a warning in place of all values, because the spindle's state is unknown."""
        for row, size, text in (
            (self.make_row_area(2.6, 4.0), 3.6, "UNKNOWN"),
            (self.make_row_area(7.0, 3.0), 2.4, "SPINDLE MAY BE TURNING"),
            (self.make_row_area(10.6, 3.0), 2.4, "PRESS E-STOP"),
        ):
            painter.fill_rect(row, "alarm")
            painter.draw_text_line(row, text, size, "on_state", at=ALIGN_CENTER)

    def _switch(self, painter: ThemedPainter, box: QRectF, view: SpindleReadout) -> None:
        painter.fill_rect(box, "key" if view.is_auto else "alarm")
        text = "AUTO" if view.is_auto else "SWITCH: OFF"
        painter.draw_text_line(
            box, text, 1.5, "text" if view.is_auto else "on_state", at=ALIGN_CENTER, margin=0.4
        )


class ToolPanel(ReadoutPanel):
    """Display of the active tool and secondary offset."""

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the active tool in the left half and the secondary offset in the right half."""
        if not isinstance(self.value, tuple):
            return
        tool, secondary = self.value
        room = self.inside()
        half = room.width() / 2
        left = QRectF(room.x(), room.y(), half, room.height())
        for at, text in ((left, tool), (left.translated(half, 0), secondary)):
            self.draw_value(painter, at, text, 4.6, ALIGN_CENTER)


class TimesPanel(ReadoutPanel):
    """Display of part count, current cycle time, remaining time and last cycle time."""

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the part count and the cycle times in columns, each with its label above the value."""
        if not isinstance(self.value, tuple):
            return
        room = self.inside()
        column = room.width() / len(self.value)
        longest = max((text for _name, text in self.value), key=len)
        font = self.theme.fit_font(longest, 2.6, column - 0.6 * self.theme.unit_px, is_bold=True)
        for number, (name, text) in enumerate(self.value):
            at = QRectF(
                room.x() + number * column, room.y(), column - 0.6 * self.theme.unit_px, room.height()
            )
            self.draw_label(painter, at.adjusted(0, 0, 0, -room.height() * 0.62), name, ALIGN_CENTER)
            painter.setFont(font)
            painter.setPen(self.theme.get_color("text"))
            draw_text(painter, at.adjusted(0, room.height() * 0.36, 0, 0), ALIGN_CENTER, text)


# --- readouts in one row ------------------------------------------------------------------------------


LATHE_COLUMN_COUNT = 3  # X, Z and C. A mill has more axes.
HIGH_PANEL_HEIGHT = 9.0  # Units: a higher panel has room for large positions.


class ReadoutRow(Panel):
    """Display of all readouts of one snapshot.

    X has a filled Ø (diameter) or a hollow R (radius). A low panel shows the readouts in one row. A high
    panel shows large positions above the other readouts.
    """

    status: MachineStatus | None = None
    _shown: RedrawingAttribute[object] = RedrawingAttribute(None)

    def show_status(self, status: MachineStatus) -> None:
        """Show a status, and redraw the panel if a value has changed."""
        self.status = status
        self._shown = (
            status.position,
            status.feed,
            status.spindle,
            status.tool_text,
            status.secondary_offset_text,
        )

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the axis positions and the other readouts in one row, or in two rows in a high panel."""
        view = self.status
        if view is None:
            return
        position = view.position
        self.frame(
            painter, join_messages("  ·  ", (position.main_kind.value, position.unit, position.x_label))
        )
        u = self.theme.unit_px
        room = self.find_full_area().adjusted(1.2 * u, 2.2 * u, -1.2 * u, -0.6 * u)
        columns = max(LATHE_COLUMN_COUNT, len(position.axes))
        if self.height() > HIGH_PANEL_HEIGHT * u:
            row = QRectF(room.x(), room.y() - 0.4 * u, room.width(), room.height() - 2.2 * u)
            self._axes(painter, row, position, room.width() / columns, 1.7)
            self._readings(
                painter, QRectF(room.x(), row.bottom(), room.width(), room.bottom() - row.bottom())
            )
            return
        share = (0.58 if columns == LATHE_COLUMN_COUNT else 0.7) * room.width() / columns
        self._axes(painter, room, position, share, 1.0)
        taken = columns * share
        rest = QRectF(room.x() + taken, room.y(), room.width() - taken, room.height())
        self._figures(painter, rest, view)

    def _axes(
        self, painter: ThemedPainter, room: QRectF, position: PositionReadout, share: float, scale: float
    ) -> None:
        look, gap = self.theme, 1.8 * self.theme.unit_px
        texts = [axis.value if axis.is_known else f"{axis.value} {UNKNOWN_VALUE}" for axis in position.axes]
        size = look.find_em_height(3.4 * scale, TextRole.POSITION, room.height())
        rooms = [share - gap - _before(axis) * scale * look.unit_px for axis in position.axes]
        fonts = [
            look.fit_font(text, size, each, is_bold=True) for text, each in zip(texts, rooms, strict=True)
        ]
        size = min(font.pixelSize() for font in fonts) / look.unit_px  # All axes have the same size.
        for number, (axis, text) in enumerate(zip(position.axes, texts, strict=True)):
            at = QRectF(room.x() + number * share, room.y(), share - gap, room.height())
            self._name(painter, at, axis, scale)
            ink = "text" if axis.is_homed and axis.is_known else "alarm"
            painter.draw_text_line(at, text, size, ink, at=ALIGN_RIGHT, fit=False, role=TextRole.POSITION)

    def _name(self, painter: ThemedPainter, at: QRectF, axis: AxisReadout, scale: float) -> None:
        u = scale * self.theme.unit_px
        painter.draw_text_line(QRectF(at.x(), at.y(), 3 * u, at.height()), axis.name, 2.8 * scale, "accent")
        if axis.diameter_mark:
            box = QRectF(at.x() + 2.8 * u, at.center().y() - 1.5 * u, 3.0 * u, 3.0 * u)
            draw_x_symbol(painter, box, axis.diameter_mark, 2.4 * scale, 0.25)

    def _cells(self, view: MachineStatus) -> tuple[tuple[str, str, float], ...]:
        """Return a label, a value and a fraction of the width for each of feed, spindle and tool."""
        feed, spindle = view.feed, view.spindle
        return (
            (
                Message("FEED {override}", override=format_percent(feed.override_fraction)),
                f"{feed.value_prefix} {feed.measured_value} {tr(feed.measured_unit)}".strip(),
                0.36,
            ),
            (
                Message("SPINDLE {override}", override=format_percent(spindle.override_fraction)),
                f"{tr(spindle.direction)} {spindle.commanded_rpm}/{spindle.measured_rpm}",
                0.44,
            ),
            ("TOOL", f"{view.tool_text} {view.secondary_offset_text}", 0.2),
        )

    def _figures(self, painter: ThemedPainter, room: QRectF, view: MachineStatus) -> None:
        """Draw feed, spindle and tool, each with its label above it."""
        u, x = self.theme.unit_px, room.x() + 1.6 * self.theme.unit_px
        for label, figure, share in self._cells(view):
            wide = share * (room.width() - 1.6 * u)
            painter.draw_text_line(QRectF(x, room.y() - 0.4 * u, wide - u, 1.9 * u), label, 1.5, "soft")
            below = QRectF(x, room.y() + 1.5 * u, wide - 1.6 * u, room.height() - 1.7 * u)
            painter.draw_text_line(below, figure, 2.3, "text", role=TextRole.FEED)
            x += wide

    def _readings(self, painter: ThemedPainter, room: QRectF) -> None:
        """Draw feed, spindle and tool in one row, each with its label on its left."""
        if self.status is None:
            return
        u, x = self.theme.unit_px, room.x()
        for label, figure, share in self._cells(self.status):
            wide = share * room.width() - u
            named = QRectF(x, room.y(), 0.38 * wide, room.height())
            painter.draw_text_line(named, label, 1.6, "soft")
            value = named.adjusted(named.width() + 0.6 * u, 0, wide - named.width(), 0)
            painter.draw_text_line(value, figure, 2.5, "text", role=TextRole.FEED)
            x += wide + u


def _before(axis: AxisReadout) -> float:
    """Return the width in theme units of an axis name with its symbol, to the left of the value."""
    return 6.8 if axis.diameter_mark else 3.2


# --- run in one row -----------------------------------------------------------------------------------


TimeTexts = Sequence[tuple[str, str]]
