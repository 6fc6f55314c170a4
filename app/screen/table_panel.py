"""Panels with rows (a scrolling list, and a table with notes and an entry line), and list pages."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.translation import tr
from app.screen import page_table
from app.screen.entry_panel import draw_entry_box
from app.screen.lists.searchable_list import SearchableList
from app.screen.page_base import ModelPage, PageHost, PageModel
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_LEFT, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX

SCROLL_KEY_SIZE = 5.0  # Units: size of the two scroll keys, at least a fingertip.
NARROW_WIDTH = 50.0  # Units: a narrower list uses its full width for rows.


class RowPanel(SearchableList):
    """List of rows of equal height.

    A subclass gets the rectangle for its rows from ``draw_scroll_keys``, and the box of each visible row
    from ``find_row_boxes``. When the selection or the size changes, the list scrolls to the selected row.
    Scrolling does not move the selection, except in an ``is_centered`` list.
    """

    is_list = True
    scroll_step = 3  # Rows that one notch of the wheel scrolls.
    row_margin = 0  # Rows that remain visible on both sides of the selection.
    is_centered = False  # The selection is in the middle, and ``scroll_by`` of the subclass moves it.
    has_scroll_keys = True  # Two scroll keys are drawn if not all rows fit.

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self.first_row = 0  # Index of the first visible row.
        self._count = 0
        # Selection and number of visible rows when the list last followed the selection.
        self._followed = (-1, 0)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Scroll by ``scroll_step`` rows for each notch of the wheel."""
        self.scroll_by(-round(event.angleDelta().y() * self.scroll_step / 120))

    def scroll_by(self, rows: int) -> None:
        """Scroll down by a number of rows.

        A negative number scrolls up.
        """
        self.first_row = self._limited(self.first_row + rows)
        self.update()

    def _limited(self, top: int) -> int:
        return max(0, min(top, self._count - self.rows))

    def draw_scroll_keys(
        self, painter: ThemedPainter, area: QRectF, visible_count: int, row_count: int, selected_row: int = -1
    ) -> QRectF:
        """Draw scroll keys if ``row_count`` rows do not fit, and return the rectangle for the rows.

        ``visible_count`` is the number of rows that fit. ``selected_row`` is the index of the selected row,
        or -1 if no row is selected. During a search, only the found rows count.
        """
        if (found := self.found_rows) is not None:
            row_count = bisect_left(found, row_count)  # A row can disappear before the next search.
            selected_row = found.index(selected_row) if selected_row in found else -1
        self.rows, self._count = visible_count, row_count
        if self.is_centered:
            self.first_row = selected_row - visible_count // 2
        elif (selected_row, visible_count) != self._followed and selected_row >= 0 and visible_count:
            lowest, highest = (
                selected_row - visible_count + 1 + self.row_margin,
                max(0, selected_row - self.row_margin),
            )
            self.first_row = min(max(self.first_row, lowest), highest)
        self._followed = (selected_row, visible_count)
        self.first_row = self._limited(self.first_row)
        return (
            self._with_keys(painter, area) if self.has_scroll_keys and 0 < visible_count < row_count else area
        )

    def find_row_boxes(self, area: QRectF, row_height_px: float) -> Iterator[tuple[int, QRectF]]:
        """Yield the index and box of each visible row.

        ``row_height_px`` is the height of a row in pixels.
        """
        for number in range(self.first_row, min(self._count, self.first_row + self.rows)):
            yield (
                number if self.found_rows is None else self.found_rows[number],
                QRectF(
                    area.x(),
                    area.y() + (number - self.first_row) * row_height_px,
                    area.width(),
                    row_height_px,
                ),
            )

    def count_fitting_rows(self, area: QRectF, row_height_px: float, row_count: int) -> int:
        """Return how many rows of this height fit in an area, which is at least 1.

        The scroll keys of a narrow list are below its rows and use some of the height.
        """
        fits = int(area.height() / row_height_px)
        if self.has_scroll_keys and fits < row_count and self.is_narrow(area.width()):
            fits = int((area.height() - self.scroll_key_size[1] - 0.6 * self.theme.unit_px) / row_height_px)
        return max(1, fits)

    @property
    def scroll_key_size(self) -> tuple[float, float]:
        """Return the width and minimum height of a scroll key in pixels."""
        size = max(SCROLL_KEY_SIZE * self.theme.unit_px, float(FINGERTIP_PX))
        return size, size

    def is_narrow(self, width: float) -> bool:
        """Return whether the scroll keys of a list of this width are below its rows.

        The scroll keys of wider lists are on the right.
        """
        return width < NARROW_WIDTH * self.theme.unit_px

    def _with_keys(self, painter: ThemedPainter, area: QRectF) -> QRectF:
        """Draw the scroll keys and the scroll bar, and return the rectangle that remains for the rows.

        The keys are to the right of the rows, or below the rows of a narrow list. If the list is too low
        for keys above each other, they are side by side.
        """
        gap, (wide, high) = 0.6 * self.theme.unit_px, self.scroll_key_size
        foot, search, count = self.is_narrow(area.width()), self.on_search_key, 3 if self.on_search_key else 2
        is_side_by_side = foot or area.height() < count * (high + gap) - gap
        strip_width = count * (wide + gap) - gap if is_side_by_side else wide
        strip = QRectF(area.right() - strip_width, area.y(), wide, area.height())
        if foot:
            wide = (area.width() + gap) / count - gap
            strip = QRectF(area.x(), area.bottom() - high, wide, high)
        scroll_height = strip.height() - (0.0 if search is None else high + gap)
        right, down = (wide + gap, 0.0) if is_side_by_side else (0.0, (scroll_height + gap) / 2)
        for number, sign in enumerate((-1, 1)):
            box = QRectF(strip.x(), strip.y(), wide, strip.height() if is_side_by_side else down - gap)
            self._scroll_key(painter, box.translated(number * right, number * down), sign)
        if search is not None:
            box = strip.translated(2 * right, 0)
            box.setTop(box.top() if is_side_by_side else box.bottom() - high)
            self._draw_search_key(painter, box, search)
        left = area.adjusted(0, 0, -2 * gap, -high - gap)
        if not foot:
            left = area.adjusted(0, 0, strip.x() - 2 * gap - area.right(), 0)
        self._scroll_bar(painter, QRectF(left.right() + gap, left.y(), 0.6 * gap, left.height()))
        return left

    def _scroll_key(self, painter: ThemedPainter, box: QRectF, sign: int) -> None:
        at, size = box.center(), 1.2 * self.theme.unit_px
        ends = self.first_row <= 0 if sign < 0 else self.first_row + self.rows >= self._count
        painter.fill_rect(box, "key")
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.theme.get_color("ghost" if ends else "accent"))
        tip, foot = QPointF(at.x(), at.y() + sign * size), at.y() - sign * size
        painter.drawPolygon(QPolygonF([tip, QPointF(at.x() - size, foot), QPointF(at.x() + size, foot)]))
        name = "PREVIOUS ROWS" if sign < 0 else "NEXT ROWS"
        self.add_target(box, partial(self.scroll_by, sign * self.rows), name)

    def _draw_search_key(self, painter: ThemedPainter, box: QRectF, search: Callable[[], None]) -> None:
        """Draw a magnifying glass on the key that opens the search."""
        at, size = box.center(), 1.0 * self.theme.unit_px
        painter.fill_rect(box, "key")
        painter.setPen(self.theme.make_pen("accent", 0.5))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(at - QPointF(0.4 * size, 0.4 * size), size, size)
        painter.drawLine(at + QPointF(0.3 * size, 0.3 * size), at + QPointF(1.5 * size, 1.5 * size))
        self.add_target(box, search, "SEARCH")

    def _scroll_bar(self, painter: ThemedPainter, track: QRectF) -> None:
        painter.fill_rect(track, "key")
        part = QRectF(track.x(), 0, track.width(), track.height() * self.rows / self._count)
        part.moveTop(track.y() + track.height() * self.first_row / self._count)
        painter.fill_rect(part, "accent")


ROW, HEAD, ASKED, NOTE = 4.0, 2.6, 5.4, 2.4  # Units.
TALL_ROW_HEIGHT = 6.0
LAMP_SIZE = 3.2
_ROUNDING = 1e-6


class TablePanel(RowPanel):
    """A panel that draws a table.

    A touch selects a row. The selected row remains visible.
    """

    is_searchable = True
    table = RedrawingAttribute(TableContent("", (), (), ()))

    def __init__(self, theme: ScreenTheme, select_cell: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._choose = select_cell
        self.on_entry_touched: Callable[[], None] | None = None  # Called for a touch on the entry line.

    def list_row_texts(self) -> Sequence[str]:
        """Return the cells of each row as one text, in the language of the screen."""
        raw = self.table.untranslated_columns
        return [
            "  ".join(cell if at in raw else tr(cell) for at, cell in enumerate(row.cells))
            for row in self.table.rows
        ]

    @property
    def selected_row(self) -> int:
        """Return the index of the selected row, or -1 if no row is selected."""
        return self.table.marked

    @property
    def has_typed_text(self) -> bool:
        """Return whether the entry line contains text."""
        return bool(self.table.text)

    def show_table(self, table: TableContent) -> None:
        """Show a table, and redraw it if it has changed.

        A table with another title is shown from its first row.
        """
        if table.title.split("  ·  ")[0] != self.table.title.split("  ·  ")[0]:
            self.first_row = 0
        self.table = table

    @property
    def _high(self) -> float:
        """Return the height of a row in theme units.

        A row is at least as high as a fingertip. On a large screen, a row is at most 9 mm high, or 14 mm if
        it is a tall row. If there are few rows, their height follows the size of the window.
        """
        own, mm = (TALL_ROW_HEIGHT, 14.0) if self.table.has_tall_rows else (ROW, 9.0)
        share = self._find_list_height(len(self.table.notes)) / max(1, len(self.table.rows)) - _ROUNDING
        return max(
            self.theme.find_row_height(own, mm, is_touchable=True) / self.theme.unit_px, min(own, share)
        )

    def _find_list_height(self, notes: int) -> float:
        """Return the height in theme units that remains for rows if this many note lines are shown."""
        foot = notes * NOTE + (self._entry_height if self.table.entry_prompt else 0.0)
        return self.height() / self.theme.unit_px - 4.0 - HEAD - foot

    @property
    def _entry_height(self) -> float:
        """Return the height of the entry line in theme units.

        The line is at least as high as a fingertip if it reacts to touch.
        """
        return ASKED if self.on_entry_touched is None else max(ASKED, FINGERTIP_PX / self.theme.unit_px + 0.6)

    @property
    def _text_scale(self) -> float:
        """Return the text scale in a row, which depends on the row's height."""
        return min(1.0, self._high / (TALL_ROW_HEIGHT if self.table.has_tall_rows else 4.2))

    def _count_fitting(self) -> int:
        """Return how many rows of the table fit, or 0 if the entry line needs the whole panel."""
        fits = self._fit(len(self._visible_notes))
        if fits < len(self.table.rows):
            fits = self._fit(len(self._visible_notes), self._scroll_key_height)
        return max(0 if self.table.entry_prompt else 1, fits)

    def _fit(self, notes: int, below: float = 0.0) -> int:
        return int((self._find_list_height(notes) - below) / self._high)

    @property
    def _scroll_key_height(self) -> float:
        """Return the height of a narrow table's scroll keys in theme units, or 0 for other tables.

        The scroll keys of a narrow table are below its rows.
        """
        return (
            self.scroll_key_size[1] / self.theme.unit_px + 0.6
            if self.is_narrow(self.inside().width())
            else 0.0
        )

    @property
    def _visible_notes(self) -> tuple[str, ...]:
        """Return the notes that are shown below the table.

        The list is empty if notes and entry line together would leave no space for the selected row.
        """
        notes = self.table.notes
        return () if self.table.entry_prompt and self._fit(len(notes)) < 1 else notes

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the heading, the visible rows and the foot, and register each row as a target."""
        u, sheet = self.theme.unit_px, self.table
        self.frame(painter, sheet.title)
        room, fits, high = self.inside(), self._count_fitting(), self._high
        row = QRectF(room.x(), room.y(), room.width(), HEAD * u)
        below = self._scroll_key_height if fits < len(sheet.rows) else 0.0
        body = QRectF(room.x(), row.bottom(), room.width(), (fits * high + below) * u)
        left = self.draw_scroll_keys(painter, body, fits, len(sheet.rows), sheet.marked)
        row.setWidth(left.width())
        self._head(painter, row)
        for number, box in self.find_row_boxes(left, high * u):
            self._row(painter, box, sheet.rows[number], number == sheet.marked)
            press = partial(self.press_row, number, partial(self._choose, number))
            self.add_target(box, press, kind="row", is_on=number == sheet.marked)
        self._foot(painter, room)

    def _columns(self, box: QRectF) -> Iterator[tuple[int, QRectF]]:
        u = self.theme.unit_px
        lamp = LAMP_SIZE * u if any(row.is_lamp_lit is not None for row in self.table.rows) else 0.8 * u
        x, wide = box.x() + lamp, box.width() - lamp - 0.6 * u
        for number, share in enumerate(self.table.relative_column_widths):
            yield number, QRectF(x, box.y(), share * wide - 1.0 * u, box.height())
            x += share * wide

    def _head(self, painter: ThemedPainter, box: QRectF) -> None:
        for number, at in self._columns(box):
            painter.draw_text_line(at, self.table.column_heads[number], 1.6, "soft", at=self._side(number))

    def _side(self, number: int) -> Qt.AlignmentFlag:
        return ALIGN_RIGHT if number in self.table.numeric_columns else ALIGN_LEFT

    def _row(self, painter: ThemedPainter, box: QRectF, row: TableRow, marked: bool) -> None:
        u = self.theme.unit_px
        if marked:
            painter.fill_rect(box, "here")
            painter.fill_rect(QRectF(box.x(), box.y(), 0.5 * u, box.height()), "lit")
        if row.is_lamp_lit is not None:
            side = min(1.6 * u, 0.5 * box.height())
            lamp = QRectF(box.x() + 1.0 * u, box.center().y() - side / 2, side, side)
            painter.draw_box(lamp, row.tone.value, 0.2, row.tone.value if row.is_lamp_lit else "")
        for number, at in self._columns(box):
            if row.bar_fraction is not None and number == len(row.cells) - 1:
                self._draw_filled(painter, at, row)
            side, bold, raw = (
                self._side(number),
                number == 0 or marked,
                number in self.table.untranslated_columns,
            )
            first, two, second = row.cells[number].partition("\n")
            if two:
                half = QRectF(at.x(), at.center().y(), at.width(), 0.44 * at.height())
                painter.draw_text_line(
                    half, second, 1.8 * self._text_scale, "soft", at=side, bold=False, raw=raw
                )
                at.setTop(at.y() + 0.06 * at.height())
                at.setHeight(half.height())
            painter.draw_text_line(at, first, 2.1 * self._text_scale, "text", at=side, bold=bold, raw=raw)
            if row.tool_outline is not None and number == len(row.cells) - 1:
                from app.screen.drawings import draw_tool_outline

                draw_tool_outline(
                    painter, at.adjusted(0, 0.2 * u, 0, -0.2 * u), row.tool_outline, is_small=True
                )

    def _draw_filled(self, painter: ThemedPainter, at: QRectF, row: TableRow) -> None:
        """Draw a progress bar in the last cell of a row, below its text."""
        high = 0.5 * self.theme.unit_px
        track = QRectF(at.x(), at.bottom() - 2 * high, at.width(), high)
        painter.fill_rect(track, "key")
        track.setWidth(track.width() * min(1.0, max(0.0, row.bar_fraction or 0.0)))
        painter.fill_rect(track, row.tone.value)

    def _foot(self, painter: ThemedPainter, room: QRectF) -> None:
        u, sheet = self.theme.unit_px, self.table
        notes = self._visible_notes
        y = room.bottom() - len(notes) * NOTE * u
        for number, note in enumerate(notes):
            row = QRectF(room.x(), y + number * NOTE * u, room.width(), NOTE * u)
            painter.draw_text_line(row, note, 1.8, "soft", bold=False)
        if sheet.entry_prompt:
            self._ask(
                painter,
                QRectF(room.x(), y - self._entry_height * u, room.width(), (self._entry_height - 0.6) * u),
            )

    def _ask(self, painter: ThemedPainter, row: QRectF) -> None:
        u, sheet = self.theme.unit_px, self.table
        asked = QRectF(row.x(), row.y(), 0.5 * row.width(), row.height())
        painter.draw_text_line(asked, sheet.entry_prompt, 2.2, "text", margin=1.0)
        box = QRectF(asked.right(), row.y() + 0.2 * u, row.right() - asked.right(), row.height() - 0.4 * u)
        draw_entry_box(painter, box, sheet.text, 2.6)
        if self.on_entry_touched is not None:
            self.add_target(row, self.on_entry_touched)


# --- a page with a list ------------------------------------------------------------------------------------


class ListModel(PageModel, Protocol):
    """Interface of the model of a list page.

    ``handle_escape`` returns False if there was nothing to close or cancel.
    """

    def prompt_text(self) -> str:
        """Return the text that the prompt line shows for the page."""
        ...

    def on_close(self) -> None:
        """Cancel unfinished entries and questions when the page closes."""
        ...


class ListPage(ModelPage):
    """A page with a list, which passes keys to its model.

    Esc on the list opens the Automatic page.
    """

    model: ListModel

    def __init__(self, host: PageHost, model: ListModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model

    def make_function_key_labels(
        self, page_labels: Mapping[str, str], function_keys: Mapping[str, FunctionKey]
    ) -> tuple[str, ...]:
        """Return the ten labels of the function keys.

        They combine the keys that all pages have, the page's ``page_labels`` and the model's
        ``function_keys``.
        """
        named = {"F1": "MENU", "F7": "ALARMS", **page_labels}
        named.update((name, key.label) for name, key in function_keys.items())
        return tuple(named.get(f"F{number}", "") for number in range(1, 11))

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of the model. The base class returns none."""
        return {}

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the function keys of the model that are disabled now."""
        return frozenset(name for name, key in self.make_function_keys().items() if key.barred)

    def prompt_text(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt_text()

    def try_leave_page(self) -> bool:
        """Cancel unfinished entries and questions, and allow the page to close."""
        self.desk.clear_prompt_line()
        self.model.on_close()
        return True

    def is_esc_stop_key(self) -> bool:
        """Return False, because Esc goes back one step even while the machine moves."""
        return False

    def handle_escape(self) -> bool:
        """Go back one step, or open the Automatic page if only the list is shown."""
        if not self.model.handle_escape():
            self.host.open_page(page_table.AUTOMATIC)
        return True
