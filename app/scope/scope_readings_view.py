"""Values next to the scope's curves: color, name, and the current value or both cursor values."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status import formats
from app.scope.scope_curves import ScopePicture
from app.scope.scope_model import ScopeModel
from app.scope.signals import ScopeSignal
from app.screen.color_palettes import CURVE_COLORS
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel
from app.screen.window_layout import FINGERTIP_PX
from core.message import Message

_ROW_HEIGHT = 5.6  # units: maximum height of a row
_UPDATE_INTERVAL_S = 0.1  # seconds between two updates of a live value


class ScopeReadings(RowPanel):
    """List of the values of the curves, with one row per curve.

    While the cursors are shown, a row contains the values at both cursors and their difference. Otherwise
    it contains the latest value. A touch selects a row.
    """

    title = "VALUES"
    scroll_step = 1
    mark: RedrawingAttribute[object] = RedrawingAttribute(None)

    def __init__(
        self, theme: ScreenTheme, scope_model: ScopeModel, select_cell: Callable[[int], None], parent: QWidget
    ) -> None:
        super().__init__(theme, parent)
        self.scope_model, self._choose = scope_model, select_cell
        self.picture = ScopePicture()
        self._known: object = None
        self.value_texts: tuple[tuple[str, ...], ...] = ()

    def show_picture(self, picture: ScopePicture) -> None:
        """Show the values of a picture.

        Live values change at most ten times per second.
        """
        scope = self.scope_model
        latest = {each.signal.key: each.latest_value for each in picture.curves}
        value_texts = tuple(self._words(each, latest, picture) for each in scope.shown)
        times = scope.cursors.times_s if scope.cursors.shown else None
        known = (
            scope.marked,
            times,
            tuple(each.key for each in scope.shown),
            self.theme.palette,
            picture.is_metric,
        )
        if (
            picture.is_live
            and known == self._known
            and abs(picture.zero_time_s - self.picture.zero_time_s) < _UPDATE_INTERVAL_S
        ):
            return
        self.picture, self._known = picture, known
        self.mark = (value_texts, known)
        self.value_texts = value_texts

    def _words(self, signal: ScopeSignal, latest: dict[str, float], sight: ScopePicture) -> tuple[str, ...]:
        places = signal.quantity.places(sight.is_metric)
        unit = signal.quantity.unit(sight.is_metric)
        if signal.key in sight.cursor_values:
            a, b = sight.cursor_values[signal.key]
            return tuple(formats.format_fixed(value, places) for value in (a, b, b - a))
        value = latest.get(signal.key, math.nan)
        return (f"{formats.format_fixed(value, places)} {unit}" if math.isfinite(value) else "",)

    def scroll_by(self, rows: int) -> None:
        """Move the selection down by a number of rows, or up if the number is negative."""
        self._choose(self.scope_model.marked + rows)

    @property
    def row_height_px(self) -> float:
        """Return the row height in pixels, which is at least the height of a fingertip."""
        return max(float(FINGERTIP_PX), _ROW_HEIGHT * self.theme.unit_px)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw one row per curve, or a message if no curve is selected.

        If the cursors are shown, the time between them is drawn above the rows.
        """
        room, shown = self.inside(), self.scope_model.shown
        u = self.theme.unit_px
        if self.scope_model.cursors.shown:
            room = self._draw_between(painter, room)
        if not shown:
            row = QRectF(room.x(), room.y(), room.width(), 3 * u)
            painter.draw_text_line(row, "Press F4 to select curves.", 1.8, "soft", bold=False)
            return
        fits = self.count_fitting_rows(room, self.row_height_px, len(shown))
        marked = min(self.scope_model.marked, len(shown) - 1)
        room = self.draw_scroll_keys(painter, room, fits, len(shown), marked)
        for number, row in self.find_row_boxes(room, self.row_height_px):
            box = row.adjusted(0, 0, 0, -0.4 * u)
            self._row(painter, box, number, shown[number], here=number == marked)
            self.add_target(box, partial(self._choose, number), kind="row", is_on=number == marked)

    def _draw_between(self, painter: ThemedPainter, area: QRectF) -> QRectF:
        """Draw the time between the two cursors, and return the area below it."""
        u, apart = self.theme.unit_px, self.scope_model.cursors.time_difference_s
        hertz = Message("{item} Hz", item=f"{1.0 / abs(apart):.4g}") if apart else formats.NO_VALUE
        row = QRectF(area.x(), area.y(), area.width(), 2.6 * u)
        painter.draw_text_line(
            row,
            Message("B − A   {apart} ms", apart=formats.format_fixed(1000.0 * apart, 2)),
            1.8,
            "accent",
            raw=True,
        )
        row.translate(0.0, 2.6 * u)
        painter.draw_text_line(row, f"1 / (B − A)   {hertz}", 1.8, "soft", raw=True)
        return area.adjusted(0, 5.8 * u, 0, 0)

    def _row(
        self, painter: ThemedPainter, box: QRectF, number: int, signal: ScopeSignal, *, here: bool
    ) -> None:
        u = self.theme.unit_px
        colours = CURVE_COLORS[self.theme.palette.name]
        painter.fill_rect(box, "here" if here else "key")
        patch = QRectF(box.x(), box.y(), 2.4 * u, box.height())
        painter.fillRect(patch, colours[number % len(colours)])
        painter.draw_text_line(patch, str(number + 1), 1.6, "panel", at=ALIGN_CENTER)
        text = box.adjusted(3.0 * u, 0.06 * box.height(), -0.4 * u, -0.06 * box.height())
        upper = QRectF(text.x(), text.y(), text.width(), 0.48 * text.height())
        painter.draw_text_line(upper, signal.title, 1.7, "text", raw=True)
        lower = upper.translated(0, upper.height())
        ink = "text" if here else "soft"
        words = self.value_texts[number] if number < len(self.value_texts) else ("",)
        if len(words) == 3:
            for place, (name, word) in enumerate(zip(("A", "B", "Δ"), words, strict=True)):
                cell = QRectF(
                    lower.x() + place * lower.width() / 3,
                    lower.y(),
                    lower.width() / 3 - 0.3 * u,
                    lower.height(),
                )
                painter.draw_text_line(cell, f"{name} {word}", 1.6, ink, raw=True, bold=False)
            return
        painter.draw_text_line(lower, words[0], 1.9, "text", at=ALIGN_RIGHT, raw=True)
        if signal.note:
            painter.draw_text_line(lower, signal.note, 1.5, "soft", raw=True, bold=False)
