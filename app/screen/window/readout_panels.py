"""Displays of position, feed, spindle, tool, parts and times.

They are large on the Automatic page, and in one row on all other pages.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont
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
    measure_text,
)
from app.screen.text_sizes import TextRole, find_narrow_size
from core.message import Message, join_messages

LATHE_ROW_COUNT = 3
_SECOND_TITLE_SHARE = 0.34  # Part of the title line for the title of the second value.
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
        title = join_messages("  ·  ", (view.main_kind.value, view.unit, view.x_label))
        self.frame(painter, title, reserved_px=_SECOND_TITLE_SHARE * self.width())
        self._heading(painter, view)
        head = self.theme.title_height * u
        room = QRectF(0, head, self.width(), self.height() - head - 0.4 * u)
        high = room.height() / len(view.axes)
        top = room.center().y() - high * len(view.axes) / 2
        for row, axis in enumerate(view.axes):
            self._row(painter, QRectF(0, top + row * high, room.width(), high), axis)
            if row:
                line = QRectF(1.2 * u, top + row * high, room.width() - 2.4 * u, max(1.0, 0.08 * u))
                painter.fill_rect(line, "key")

    def _heading(self, painter: ThemedPainter, view: PositionReadout) -> None:
        look, u, name = self.theme, self.theme.unit_px, tr(view.second_kind.value)
        high = look.title_height * u
        font = look.fit_font(
            name,
            look.find_em_height(1.5, TextRole.TABLE, high),
            _SECOND_TITLE_SHARE * self.width() - 3.2 * u,
            is_bold=True,
        )
        wide = measure_text(name, font)
        place = QRectF(self.width() - wide - 2.4 * u, 0, wide + 0.8 * u, high)
        painter.fill_rect(place.adjusted(0, 0.4 * high, 0, 0), "panel")
        painter.fill_rect(place.adjusted(0, 0, 0, -0.5 * high), "ground")
        painter.draw_text_line(place, name, 1.5, "soft", at=ALIGN_CENTER, raw=True)

    def _row(self, painter: ThemedPainter, row: QRectF, axis: AxisReadout) -> None:
        u = self.theme.unit_px
        share = self._find_row_share(row)
        painter.draw_text_line(
            QRectF(1.4 * u, row.y(), 5.2 * u, row.height()), axis.name, 5.6 * share, "accent"
        )
        if axis.diameter_mark:
            box = QRectF(6.8 * u, row.center().y() - 2.6 * u, 4.8 * u, 5.2 * u)
            draw_x_symbol(painter, box, axis.diameter_mark, 4.6, 0.4)
        large = QRectF(12.0 * u, row.y(), 39.6 * u, row.height())
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
        if not plain:
            second_box.setHeight(0.5 * row.height())
            painter.draw_text_line(
                second_box, "NOT HOMED" if axis.is_known else "LAST KNOWN", 1.5, "alarm", at=ALIGN_RIGHT
            )
            second_box.translate(0, second_box.height())
        painter.draw_text_line(
            second_box, axis.second_value, 2.7 * max(share, 0.8), "soft", at=ALIGN_RIGHT, bold=False
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

    def make_rows(self) -> tuple[QRectF, QRectF, QRectF]:
        """Return the rectangles of the large row inside the frame and of two rows below it."""
        u, top = self.theme.unit_px, self.theme.title_height * self.theme.unit_px
        room = self.height() - top - 0.4 * u
        large = max(0.4 * room, room - 2 * self.theme.find_line_height(3.6))
        low = (room - large) / 2
        row = QRectF(1.2 * u, top, self.width() - 2.4 * u, large)
        return (
            row,
            QRectF(row.x(), row.bottom(), row.width(), low),
            QRectF(row.x(), row.bottom() + low, row.width(), low),
        )

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
        top, actual, override = self.make_rows()
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
        self.draw_label(
            painter, actual.adjusted(0, 0, -(actual.width() - 7.8 * self.theme.unit_px), 0), "ACTUAL"
        )
        self.draw_value(
            painter,
            actual.adjusted(8.2 * self.theme.unit_px, 0, -8.2 * self.theme.unit_px, 0),
            view.measured_value,
            2.5,
        )
        self.draw_label(
            painter, QRectF(unit.x(), actual.y(), unit.width(), actual.height()), view.measured_unit
        )
        self.draw_override(painter, override, view.override_fraction, 1.5)


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
        top, actual, override = self.make_rows()
        if not view.is_known:
            self._draw_unknown(painter, (top, actual, override))
            return
        turning = QRectF(top.x(), top.y(), 10.6 * u, 0.5 * top.height())
        self.draw_label(painter, turning, view.direction)
        self._switch(painter, turning.translated(0, turning.height()), view)
        unit = QRectF(top.right() - 4.4 * u, top.y() + 0.2 * top.height(), 4.4 * u, 0.8 * top.height())
        self.draw_value(
            painter, top.adjusted(11 * u, 0, -4.6 * u, 0), view.commanded_rpm, 4.2, role=TextRole.FEED
        )
        self.draw_label(painter, unit, "rpm")
        half = actual.width() * 0.50
        self.draw_label(painter, QRectF(actual.x(), actual.y(), 7.8 * u, actual.height()), "ACTUAL")
        self.draw_value(
            painter,
            QRectF(actual.x() + 8.2 * u, actual.y(), half - 8.2 * u, actual.height()),
            view.measured_rpm,
            2.5,
        )
        surface = QRectF(actual.x() + half + 1.6 * u, actual.y(), half - 1.6 * u, actual.height())
        self.draw_label(
            painter, QRectF(surface.x(), surface.y(), 5 * u, surface.height()), view.surface_speed_label
        )
        self.draw_value(painter, surface.adjusted(5 * u, 0, 0, 0), view.surface_speed, 2.5)
        self.draw_override(painter, override, view.override_fraction, 1.0)
        if view.load_text:
            # In the top line, next to the title.
            patch = QRectF(self.width() - 12.4 * u, 0.0, 11.2 * u, self.theme.title_height * u)
            painter.fill_rect(patch, "panel")
            painter.draw_text_line(patch, f"{tr('LOAD')} {view.load_text}", 1.6, "soft", at=ALIGN_CENTER)

    def _draw_unknown(self, painter: ThemedPainter, rows: tuple[QRectF, QRectF, QRectF]) -> None:
        """Draw a warning in place of all values, because the spindle's state is unknown."""
        texts = ((3.6, "UNKNOWN"), (2.4, "SPINDLE MAY BE TURNING"), (2.4, "PRESS E-STOP"))
        for row, (size, text) in zip(rows, texts, strict=True):
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
        size = self.theme.find_em_height(2.6, TextRole.TABLE, 0.56 * room.height())
        font = self.theme.fit_font(longest, size, column - 0.6 * self.theme.unit_px, is_bold=True)
        for number, (name, text) in enumerate(self.value):
            at = QRectF(
                room.x() + number * column, room.y(), column - 0.6 * self.theme.unit_px, room.height()
            )
            self.draw_label(painter, at.adjusted(0, 0, 0, -room.height() * 0.56), name, ALIGN_CENTER)
            painter.setFont(font)
            painter.setPen(self.theme.get_color("text"))
            draw_text(painter, at.adjusted(0, room.height() * 0.44, 0, 0), ALIGN_CENTER, text)


# --- readouts in one row ------------------------------------------------------------------------------


LATHE_COLUMN_COUNT = 3  # X, Z and C. A mill has more axes.
_LABEL_SHARE = 0.28  # Part of a cell for its label.
_NAME_WIDTH, _MARK_WIDTH = 3.0, 3.4  # Units: width of an axis name, and of the symbol of X.


class ReadoutRow(Panel):
    """Display of all readouts of one snapshot.

    X has a filled Ø (diameter) or a hollow R (radius). On a page on which axes can move, large positions
    are above the other readouts. On all other pages, the readouts are in one row.
    """

    has_axis_motion = RedrawingAttribute(False)
    position_row_count = RedrawingAttribute(1)  # Rows of large positions.
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
        """Draw the axis positions and the other readouts."""
        view = self.status
        if view is None:
            return
        position, u = view.position, self.theme.unit_px
        self.frame(
            painter, join_messages("  ·  ", (position.main_kind.value, position.unit, position.x_label))
        )
        top = (self.theme.title_height - 0.1) * u
        room = self.find_full_area().adjusted(1.2 * u, top, -1.0 * u, -0.3 * u)
        if self.has_axis_motion:
            self._draw_large(painter, room, position)
            return
        columns = max(LATHE_COLUMN_COUNT, len(position.axes))
        wide = (0.58 if columns == LATHE_COLUMN_COUNT else 0.7) * room.width()
        area = QRectF(room.x(), room.y(), wide, room.height())
        self._draw_axes(painter, area, position.axes, 3.4, TextRole.TABLE)
        self._figures(painter, room.adjusted(wide, 0, 0, 0), view)

    def _draw_large(self, painter: ThemedPainter, room: QRectF, position: PositionReadout) -> None:
        """Draw the positions in one or more rows, and the other readouts in a row below them."""
        look, rows = self.theme, self.position_row_count
        feed = min(
            0.45 * room.height(),
            max(2.9 * look.unit_px, 0.84 * look.text_resolution.find_min_em_px(TextRole.FEED)),
        )
        high, columns = (room.height() - feed) / rows, math.ceil(len(position.axes) / rows)
        for row in range(rows):
            at = QRectF(room.x(), room.y() + row * high, room.width(), high)
            axes = position.axes[row * columns : (row + 1) * columns]
            self._draw_axes(painter, at, axes, 5.8, TextRole.POSITION)
        self._readings(painter, QRectF(room.x(), room.bottom() - feed, room.width(), feed))

    def _draw_axes(
        self,
        painter: ThemedPainter,
        area: QRectF,
        axes: Sequence[AxisReadout],
        size: float,
        role: TextRole,
    ) -> None:
        """Draw axes side by side. All axes have the same text size, and each has the width that it needs."""
        look, u = self.theme, self.theme.unit_px
        texts = [axis.value if axis.is_known else f"{axis.value} {UNKNOWN_VALUE}" for axis in axes]
        size = look.find_em_height(size, role, area.height() * (1.04 if role is TextRole.POSITION else 1.0))
        font = look.make_font(size, is_bold=True)
        widths = [measure_text(_find_widest_value(text), font) for text in texts]
        names = [(_NAME_WIDTH + (_MARK_WIDTH if axis.diameter_mark else 0.0)) * u for axis in axes]
        room = area.width() - sum(names) - 1.6 * u * len(axes)
        pixels, stretch = find_narrow_size(font.pixelSize(), min(1.0, room / sum(widths)))
        narrow = QFont(font)
        narrow.setPixelSize(pixels)
        narrow.setStretch(stretch)
        x = area.x()
        for axis, text, name, width in zip(axes, texts, names, widths, strict=True):
            share = room * width / sum(widths)
            self._name(painter, QRectF(x, area.y(), name, area.height()), axis)
            painter.setPen(look.get_color("text" if axis.is_homed and axis.is_known else "alarm"))
            painter.setFont(narrow)
            at = QRectF(x + name, area.y(), share, area.height())
            painter.draw_prepared_text(at, ALIGN_RIGHT, text, role)
            x += name + share + 1.6 * u

    def _name(self, painter: ThemedPainter, at: QRectF, axis: AxisReadout) -> None:
        u = self.theme.unit_px
        painter.draw_text_line(QRectF(at.x(), at.y(), _NAME_WIDTH * u, at.height()), axis.name, 2.8, "accent")
        if axis.diameter_mark:
            box = QRectF(at.x() + _NAME_WIDTH * u - 0.2 * u, at.center().y() - 1.6 * u, 3.2 * u, 3.2 * u)
            draw_x_symbol(painter, box, axis.diameter_mark, 2.4, 0.25)

    def _cells(self, view: MachineStatus) -> tuple[tuple[str, str, float], ...]:
        """Return a label, a value and a fraction of the width for each of feed, spindle and tool."""
        feed, spindle = view.feed, view.spindle
        return (
            (
                Message("FEED {override}", override=format_percent(feed.override_fraction)),
                f"{feed.value_prefix} {feed.measured_value} {tr(feed.measured_unit)}".strip(),
                0.38,
            ),
            (
                Message("SPINDLE {override}", override=format_percent(spindle.override_fraction)),
                f"{tr(spindle.direction)} {spindle.commanded_rpm}/{spindle.measured_rpm}",
                0.45,
            ),
            ("TOOL", f"{view.tool_text} {view.secondary_offset_text}", 0.17),
        )

    def _figures(self, painter: ThemedPainter, room: QRectF, view: MachineStatus) -> None:
        """Draw feed, spindle and tool, each with its label above it."""
        u, x, high = self.theme.unit_px, room.x() + 0.6 * self.theme.unit_px, room.height() / 2
        for label, figure, share in self._cells(view):
            wide = share * (room.width() - 0.6 * u)
            named = QRectF(x, room.y(), wide - u, high)
            painter.draw_text_line(named, label, 1.5, "soft")
            painter.draw_text_line(named.translated(0, high), figure, 2.3, "text")
            x += wide

    def _readings(self, painter: ThemedPainter, room: QRectF) -> None:
        """Draw feed, spindle and tool in one row, each with its label on its left."""
        if self.status is None:
            return
        u, x = self.theme.unit_px, room.x()
        for label, figure, share in self._cells(self.status):
            wide = share * room.width() - 0.6 * u
            named = QRectF(x, room.y(), _LABEL_SHARE * wide, room.height())
            painter.draw_text_line(named, label, 1.6, "soft", bold=False)
            value = named.adjusted(named.width() + 0.3 * u, 0, wide - named.width(), 0)
            role = TextRole.TABLE if label == "TOOL" else TextRole.FEED
            painter.draw_text_line(value, figure, 2.5, "text", role=role)
            x += wide + 0.6 * u


_MIN_VALUE_LENGTH = 7


def _find_widest_value(text: str) -> str:
    """Return a text as wide as any value with the same number of digits, so that the columns do not move."""
    value, unknown, rest = text.partition(" ")
    digits = value.lstrip("+-−")
    return "−" + "0" * (_MIN_VALUE_LENGTH - len(digits) - 1) + digits + unknown + rest


# --- run in one row -----------------------------------------------------------------------------------


TimeTexts = Sequence[tuple[str, str]]
