"""The program listing, with the current line highlighted and the generated block below it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from textwrap import wrap

from PySide6.QtCore import QRectF

from app.desk.translation import tr
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_RIGHT, ThemedPainter
from app.screen.table_panel import RowPanel
from core.message import Message

_LETTER_WIDTH = 1.1  # Units: average width of a letter.
ROW, MM = 2.9, 7.0  # Line spacing in units, and its maximum in millimeters.


class ProgramListing(RowPanel):
    """List of the program's source lines.

    Only visible lines are painted, so a long program takes no extra time.
    """

    has_scroll_keys = False
    follows_run = RedrawingAttribute(
        True
    )  # The listing follows the run. False after the operator has scrolled.
    _line = RedrawingAttribute(0)
    _block, _next = RedrawingAttribute(""), RedrawingAttribute("")
    _bad: RedrawingAttribute[Mapping[int, str]] = RedrawingAttribute({})
    _lines: Sequence[str] = ()
    error_text = RedrawingAttribute("")  # Why no program is shown.
    # Called with the number of a touched line, if lines can be chosen.
    on_line_touched: Callable[[int], None] | None = None

    def show_source(self, lines: Sequence[str], line_errors: Mapping[int, str]) -> None:
        """Show another program.

        ``line_errors`` contains the error messages by line number.
        """
        if lines is not self._lines or line_errors != self._bad:
            self._lines, self._bad = lines, dict(line_errors)
            self.follows_run = not self._bad
            self.first_row = max(0, min(self._bad, default=0) - 3)
            self.update()

    @property
    def active_line(self) -> int:
        """Return the number of the highlighted line, or 0 while no line is executed or selected."""
        return self._line

    def show_run_position(self, active_line: int, block_text: str, next_block_text: str) -> None:
        """Show the executed line, the generated block and the next block.

        ``active_line`` is 0 while no line is executed. The next block is hidden if it equals the next
        source line.
        """
        if next_block_text and any(
            text.startswith(next_block_text) for text in self._lines[active_line : active_line + 1]
        ):
            next_block_text = ""
        self._line, self._block, self._next = active_line, block_text, next_block_text

    @property
    def _high(self) -> float:
        """Return the line spacing in pixels."""
        high = self.theme.find_row_height(ROW, MM, is_touchable=self.on_line_touched is not None)
        return max(high, self.theme.find_line_height(0.0))

    @property
    def _text_scale(self) -> float:
        """Return the text scale, which depends on the line spacing."""
        # Rows for touch are higher, but their letters are not larger.
        return min(1.0, self._high / (ROW * self.theme.unit_px))

    @property
    def _generated_blocks(self) -> tuple[str, ...]:
        """Return the generated block and the next block, which are shown below the executed line."""
        return tuple(filter(None, (self._block, self._next))) if self._block else ()

    def follow_run(self) -> None:
        """Make the listing scroll with the running program again."""
        self.follows_run = True

    def scroll_by(self, rows: int) -> None:
        """Scroll by a number of rows.

        The listing then no longer follows the running program.
        """
        self.follows_run = False
        super().scroll_by(rows)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the visible program lines.

        If the listing follows the running program, first scroll to the current line.
        """
        u = self.theme.unit_px
        count = len(self._lines)
        title = Message("PROGRAM  ·  {count} LINES", count=count) if count else "PROGRAM"
        self.frame(
            painter, title if self.follows_run else Message("{title}  ·  HOME: CURRENT LINE", title=title)
        )
        top = (self.theme.title_height + 0.2) * u
        room = QRectF(0.3 * u, top, self.width() - 0.6 * u, self.height() - top - 0.3 * u)
        fits = self.count_fitting_rows(room, self._high, count)
        if self.follows_run:
            self.first_row = max(0, self._line - 1 - fits // 3)
        self.draw_scroll_keys(painter, room, fits, count + len(self._generated_blocks))
        for (_number, row), draw in zip(
            self.find_row_boxes(room, self._high), self._list_row_drawers(painter), strict=False
        ):
            draw(row)
        if not count:
            self._none(painter)

    def _none(self, painter: ThemedPainter) -> None:
        room, high = self.inside(), ROW * self.theme.unit_px
        room.setHeight(high)
        wide = max(10, int(room.width() / (_LETTER_WIDTH * self.theme.unit_px)))
        for row in wrap(tr(self.error_text or "No program loaded."), wide):
            painter.draw_text_line(
                room, row, 2.0, "text" if self.error_text else "soft", bold=False, raw=True
            )
            room.translate(0, high)

    def _list_row_drawers(self, painter: ThemedPainter) -> Iterator[Callable[[QRectF], None]]:
        """Yield a drawing function for each row, starting with the first visible row."""
        for number in range(self.first_row + 1, len(self._lines) + 1):
            yield partial(self._source, painter, number)
            if number == self._line:
                for label, text in zip(("BLOCK", "NEXT"), self._generated_blocks, strict=False):
                    yield partial(self._block_row, painter, label, text)

    def _source(self, painter: ThemedPainter, number: int, row: QRectF) -> None:
        u = self.theme.unit_px
        here, bad = number == self._line, number in self._bad
        if self.on_line_touched is not None:
            self.add_target(row, partial(self.on_line_touched, number), kind="row", is_on=here)
        if here:
            self._mark(painter, row)
        if bad:
            painter.fill_rect(QRectF(row.x(), row.y(), 0.7 * u, row.height()), "alarm")
        scale = self._text_scale
        wide = max(3, len(str(len(self._lines)))) * 0.64 * self.theme.find_table_size(1.9 * scale) * u
        margin = QRectF(row.x() + 1.2 * u, row.y(), wide, row.height())
        painter.draw_text_line(
            margin, str(number), 1.7 * scale, "alarm" if bad else "soft", at=ALIGN_RIGHT, bold=False
        )
        text, room = self._lines[number - 1].expandtabs(4), row.adjusted(wide + 2.0 * u, 0, -0.4 * u, 0)
        painter.draw_text_line(room, text, 2.1 * scale, "text", bold=here, raw=True)

    def _block_row(self, painter: ThemedPainter, label: str, text: str, row: QRectF) -> None:
        u, runs = self.theme.unit_px, label == "BLOCK"
        ink = "accent" if runs else "soft"
        if runs:
            self._mark(painter, row)
        head = QRectF(row.x() + 1.2 * u, row.y(), 6.4 * u, row.height())
        painter.draw_text_line(head, label, 1.6 * self._text_scale, ink)
        room = row.adjusted(8.2 * u, 0, -0.4 * u, 0)
        painter.draw_text_line(room, text, 2.0 * self._text_scale, ink, bold=runs, raw=True)

    def _mark(self, painter: ThemedPainter, row: QRectF) -> None:
        painter.fill_rect(row, "here")
        painter.fill_rect(QRectF(row.x(), row.y(), 0.7 * self.theme.unit_px, row.height()), "lit")
