"""The page of the 32 secondary offsets (F9), in two columns.

The first touch enlarges eight of the offsets.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.formats import format_length
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.offsets.offset_values import UNKNOWN_VALUE, UnitMode, format_signed_length
from app.offsets.offsets_view import OffsetPage
from app.offsets.secondary_offsets import SecondaryOffsetEntry
from app.screen import page_table
from app.screen.page_base import PageHost
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot
from core.message import join_messages
from core.store.store_rows import SecondaryOffsetRow

ROWS_PER_COLUMN = 16
ENLARGED_HEIGHT = 6  # Fingertips: height of the enlarged view with its frame.
ENLARGED_ROWS = 8  # Number of offsets in the enlarged view, half a column.
TOUCH_HEIGHT = 6.8  # Units: height of a fingertip.
# Fractions of the column width at which the number, X and Z end.
_NUMBER, _X, _Z = 0.09, 0.42, 0.73


class SecondaryOffsetTable(RowPanel):
    """Table of the secondary offsets, with a filled row for the offset that is being edited.

    A bar marks the last changed row. A row of the full table is only a third as high as a fingertip. The
    first touch therefore enlarges eight offsets, and the second touch selects one of them. If the rows would
    be too low to read, both columns scroll together.
    """

    is_list = False
    scroll_step = 1

    offsets: RedrawingAttribute[Mapping[int, SecondaryOffsetRow]] = RedrawingAttribute({})
    first_enlarged_number = RedrawingAttribute(
        0
    )  # First number of the enlarged offsets; 0: all offsets are shown.
    _number = RedrawingAttribute(0)
    _marked: RedrawingAttribute[frozenset[int]] = RedrawingAttribute(frozenset())
    _mode = RedrawingAttribute(UnitMode())
    is_unreadable = RedrawingAttribute(False)  # True if offsets cannot be read.

    def __init__(self, theme: ScreenTheme, select_cell: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._choose = select_cell

    def show_offsets(
        self,
        offsets: Mapping[int, SecondaryOffsetRow],
        number: int,
        changed_numbers: Collection[int],
        value_mode: UnitMode,
    ) -> None:
        """Show the offsets in the given unit, and mark the edited and the last changed rows.

        ``number`` is the offset that is being edited, or 0 if no offset is being edited.
        """
        if number:
            self.enlarge_rows(0)
        self.offsets, self._number, self._marked, self._mode = (
            offsets,
            number,
            frozenset(changed_numbers),
            value_mode,
        )

    def draw(self, painter: ThemedPainter) -> None:
        """Draw eight enlarged offsets if they are selected, or otherwise all secondary offsets.

        Values are in mm or inches, and X is stored as a radius.
        """
        unit = tr("MM") if self._mode.is_metric else tr("INCH")
        self.frame(painter, join_messages("  ·  ", (tr("SECONDARY OFFSETS  ·  X STORED AS A RADIUS"), unit)))
        room = self.inside().adjusted(
            -0.6 * self.theme.unit_px, 0, 0.6 * self.theme.unit_px, 0.4 * self.theme.unit_px
        )
        if self.first_enlarged_number:
            self._draw_near(painter, room)
        else:
            self._draw_all(painter, room)

    def enlarge_rows(self, first: int) -> None:
        """Enlarge the eight offsets that start at this number, or show all offsets if it is 0."""
        self.first_enlarged_number = first

    def _draw_all(self, painter: ThemedPainter, room: QRectF) -> None:
        gap, fits = 2.0 * self.theme.unit_px, int(room.height() / self.theme.find_line_height(0.0))
        fits = max(1, min(ROWS_PER_COLUMN, fits))
        edited = (self._number - 1) % ROWS_PER_COLUMN if self._number else -1
        room = self.draw_scroll_keys(painter, room, fits, ROWS_PER_COLUMN, edited)
        for at, box in enumerate(_make_boxes(room, fits, gap)):
            column, row = divmod(at, fits)
            number = column * ROWS_PER_COLUMN + self.first_row + row + 1
            self._draw_row(painter, box, number, 1.0)
        self._add_zones(_make_boxes(room, 1, gap), fits)

    def _add_zones(self, columns: list[QRectF], fits: int) -> None:
        """Register the eight visible offsets of each half column as a touch target."""
        for column, box in enumerate(columns):
            high = box.height() / fits
            for first in range(0, ROWS_PER_COLUMN, ENLARGED_ROWS):
                top = max(first, self.first_row) - self.first_row
                bottom = min(first + ENLARGED_ROWS, self.first_row + fits) - self.first_row
                zone = QRectF(box.x(), box.y() + top * high, box.width(), (bottom - top) * high)
                if zone.height() >= FINGERTIP_PX:
                    number = column * ROWS_PER_COLUMN + first + 1
                    self.add_target(zone, partial(self.enlarge_rows, number))

    def _draw_near(self, painter: ThemedPainter, room: QRectF) -> None:
        u = self.theme.unit_px
        bar = QRectF(room.x(), room.bottom() - TOUCH_HEIGHT * u, room.width(), TOUCH_HEIGHT * u)
        rows = room.adjusted(0, 0, 0, -(TOUCH_HEIGHT + 0.6) * u)
        for number, box in enumerate(
            _make_boxes(rows, ENLARGED_ROWS // 2, 0.8 * u), start=self.first_enlarged_number
        ):
            spot = box.adjusted(0, 0, 0, -0.3 * u)
            painter.fill_rect(spot, "key")
            self._draw_row(painter, spot, number, 1.25)
            self.add_target(spot, partial(self._choose_near, number))
        self.key(painter, bar, tr("ALL 32 OFFSETS"), 2.2, partial(self.enlarge_rows, 0), color="accent")

    def _choose_near(self, number: int) -> None:
        self.enlarge_rows(0)
        self._choose(number)

    def _draw_row(self, painter: ThemedPainter, box: QRectF, number: int, size: float) -> None:
        """Draw one row.

        ``size`` is the scale of the text, which is 1 in the full table.
        """
        u = self.theme.unit_px
        here = number == self._number
        if here:
            painter.fill_rect(box, "here")
        if number in self._marked:
            painter.fill_rect(QRectF(box.x(), box.y(), 0.5 * u, box.height()), "lit")
        offset = self.offsets.get(number)
        margin = QRectF(box.x(), box.y(), _NUMBER * box.width() - u, box.height())
        painter.draw_text_line(margin, str(number), 1.9 * size, "accent", at=ALIGN_RIGHT)
        self._figures(painter, box, offset or SecondaryOffsetRow(), size, bold=here or offset is not None)

    def _figures(
        self, painter: ThemedPainter, box: QRectF, offset: SecondaryOffsetRow, size: float, bold: bool
    ) -> None:
        x, z, r = offset
        metric, wide = self._mode.is_metric, box.width()
        cells = (
            ("X:", format_signed_length(x, metric), _NUMBER, _X),
            ("Z:", format_signed_length(z, metric), _X, _Z),
            ("R:", format_length(r, metric), _Z, 1.0),
        )
        u = self.theme.unit_px
        for letter, value, left, right in cells:
            figure = UNKNOWN_VALUE if self.is_unreadable else value
            at = QRectF(box.x() + left * wide, box.y(), (right - left) * wide - 1.2 * u, box.height())
            self._cell(painter, at, letter, figure, size, bold)

    def _cell(
        self, painter: ThemedPainter, at: QRectF, letter: str, figure: str, size: float, bold: bool
    ) -> None:
        u = self.theme.unit_px
        painter.draw_text_line(
            QRectF(at.x(), at.y(), 2.4 * size * u, at.height()), letter, 1.8 * size, "soft"
        )
        room = at.adjusted(2.4 * size * u, 0, 0, 0)
        painter.draw_text_line(
            room, figure, 2.0 * size, "text" if bold else "soft", at=ALIGN_RIGHT, bold=bold
        )


def _make_boxes(area: QRectF, rows: int, gap: float) -> list[QRectF]:
    """Return the boxes of two columns with ``rows`` rows each, column by column."""
    high, wide = area.height() / rows, (area.width() - gap) / 2
    return [
        QRectF(area.x() + column * (wide + gap), area.y() + row * high, wide, high)
        for column in range(2)
        for row in range(rows)
    ]


class SecondaryOffsetsPage(OffsetPage):
    """The page of the secondary offsets (F9)."""

    NAME = page_table.SECCMP
    LABELS = ("MENU", "", "", "UNDO", "HISTORY", "EFFECT", "ALARMS", "TOOLS", "", "ZERO")
    model: SecondaryOffsetEntry
    content_panel: SecondaryOffsetTable

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent, SecondaryOffsetEntry(host.desk))
        self.content_panel = SecondaryOffsetTable(self.theme, self.model.select_offset, self)
        self._is_enlarged = False  # Last layout.

    def handle_escape(self) -> bool:
        """Leave the enlarged view of eight offsets, or otherwise go back one step of the entry."""
        if self.content_panel.first_enlarged_number:
            self.content_panel.enlarge_rows(0)
            return True
        return super().handle_escape()

    def find_list(self) -> RowPanel | None:
        """Return the history or the table, unless a value is being entered."""
        return None if self.model.offset_number and not self.history_list.isVisible() else super().find_list()

    def _lay_out(self) -> None:
        """Arrange the parts. In a low window, enlarged offsets also cover the entry line."""
        super()._lay_out()
        panel = self.content_panel
        is_low = panel.height() < ENLARGED_HEIGHT * FINGERTIP_PX
        is_covered = is_low and bool(panel.first_enlarged_number)
        if is_covered:
            panel.setGeometry(0, 0, panel.width(), self.height())
        self.entry_panel.setVisible(not is_covered and not self.is_searching)

    def try_leave_page(self) -> bool:
        """Leave the enlarged view, discard unfinished entries, and allow the page to close."""
        self.content_panel.enlarge_rows(0)
        return super().try_leave_page()

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the displayed table with the offsets of the model."""
        super().refresh(snapshot, status, loaded)
        if bool(self.content_panel.first_enlarged_number) is not self._is_enlarged:
            self._is_enlarged = not self._is_enlarged
            self._lay_out()
        model = self.model
        marked = {change.number for change in model.offset_history.last_changes}
        self.content_panel.is_unreadable = model.offset_book.has_read_failed
        self.content_panel.show_offsets(
            model.offset_book.secondary_offsets, model.offset_number, marked, model.unit_mode
        )
