"""The program window: source lines, the current line highlighted, and the generated block below it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from textwrap import wrap

from PySide6.QtCore import QRectF

from app.desk.translation import tr
from app.screen.look import RIGHT, Painter
from app.screen.panel import Shown
from app.screen.sheet_panel import RowPanel
from core.message import Message

_LETTER = 1.1  # Units: average width of a letter.
ROW, MM = 2.9, 7.0  # Line spacing in units, and its maximum in millimeters.


class Listing(RowPanel):
    """The list of source lines. Only visible lines are painted, so a long program takes no extra time."""

    keyed = False
    follows = Shown(True)  # The listing follows the run. False after the operator has scrolled.
    _line = Shown(0)
    _block, _next = Shown(""), Shown("")
    _bad: Shown[Mapping[int, str]] = Shown({})
    _lines: Sequence[str] = ()
    trouble = Shown("")  # Why no program is shown.
    # Called with the number of a touched line, if lines can be chosen.
    touched: Callable[[int], None] | None = None

    def show_source(self, lines: Sequence[str], bad: Mapping[int, str]) -> None:
        """Show another program. ``bad`` contains error messages by line number."""
        if lines is not self._lines or bad != self._bad:
            self._lines, self._bad = lines, dict(bad)
            self.follows = not self._bad
            self.top = max(0, min(self._bad, default=0) - 3)
            self.update()

    def show_run(self, line: int, block: str, following: str) -> None:
        """Show the executed line (0 for none), the generated block and the next block.

        The next block is hidden if it equals the next source line.
        """
        if following and any(text.startswith(following) for text in self._lines[line : line + 1]):
            following = ""
        self._line, self._block, self._next = line, block, following

    @property
    def _high(self) -> float:
        """The line spacing in pixels."""
        return self.look.row(ROW, MM, touch=self.touched is not None)

    @property
    def _scale(self) -> float:
        """The scale of the letters, which depends on the line spacing."""
        # Rows for touch are higher, but their letters are not larger.
        return min(1.0, self._high / (ROW * self.look.u))

    @property
    def _generated(self) -> tuple[str, ...]:
        """The generated block and the next one, which are below the executed line."""
        return tuple(filter(None, (self._block, self._next))) if self._block else ()

    def follow(self) -> None:
        """Follow the run again."""
        self.follows = True

    def scroll_by(self, rows: int) -> None:
        """Scroll to another part of the program. The listing no longer follows the run."""
        self.follows = False
        super().scroll_by(rows)

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        count = len(self._lines)
        title = Message("PROGRAM  ·  {count} LINES", count=count) if count else "PROGRAM"
        self.frame(painter, title if self.follows else Message("{title}  ·  HOME: CURRENT LINE", title=title))
        room = QRectF(0.3 * u, 2.5 * u, self.width() - 0.6 * u, self.height() - 3.2 * u)
        fits = self.fitting(room, self._high, count)
        if self.follows:
            self.top = max(0, self._line - 1 - fits // 3)
        self.scrolled(painter, room, fits, count + len(self._generated))
        for (_number, row), draw in zip(self.boxes(room, self._high), self._drawn(painter), strict=False):
            draw(row)
        if not count:
            self._none(painter)

    def _none(self, painter: Painter) -> None:
        room, high = self.inside(), ROW * self.look.u
        room.setHeight(high)
        wide = max(10, int(room.width() / (_LETTER * self.look.u)))
        for row in wrap(tr(self.trouble or "No program loaded."), wide):
            painter.write(room, row, 2.0, "text" if self.trouble else "soft", bold=False, raw=True)
            room.translate(0, high)

    def _drawn(self, painter: Painter) -> Iterator[Callable[[QRectF], None]]:
        """Yield the drawing functions of the rows, from the first visible row on."""
        for number in range(self.top + 1, len(self._lines) + 1):
            yield partial(self._source, painter, number)
            if number == self._line:
                for label, text in zip(("BLOCK", "NEXT"), self._generated, strict=False):
                    yield partial(self._block_row, painter, label, text)

    def _source(self, painter: Painter, number: int, row: QRectF) -> None:
        u = self.look.u
        here, bad = number == self._line, number in self._bad
        if self.touched is not None:
            self.place(row, partial(self.touched, number), kind="row", on=here)
        if here:
            self._mark(painter, row)
        if bad:
            painter.fill(QRectF(row.x(), row.y(), 0.7 * u, row.height()), "alarm")
        scale = self._scale
        wide = max(4, len(str(len(self._lines)))) * 1.2 * u * scale
        margin = QRectF(row.x() + 1.2 * u, row.y(), wide, row.height())
        painter.write(margin, str(number), 1.7 * scale, "alarm" if bad else "soft", at=RIGHT, bold=False)
        text, room = self._lines[number - 1].expandtabs(4), row.adjusted(wide + 2.4 * u, 0, -0.8 * u, 0)
        painter.write(room, text, 2.1 * scale, "text", bold=here, raw=True, fit=False)

    def _block_row(self, painter: Painter, label: str, text: str, row: QRectF) -> None:
        u, runs = self.look.u, label == "BLOCK"
        ink = "accent" if runs else "soft"
        if runs:
            self._mark(painter, row)
        head = QRectF(row.x() + 1.2 * u, row.y(), 5.6 * u, row.height())
        painter.write(head, label, 1.6 * self._scale, ink)
        room = row.adjusted(7.6 * u, 0, -0.8 * u, 0)
        painter.write(room, text, 2.0 * self._scale, ink, bold=runs, raw=True, fit=False)

    def _mark(self, painter: Painter, row: QRectF) -> None:
        painter.fill(row, "here")
        painter.fill(QRectF(row.x(), row.y(), 0.7 * self.look.u, row.height()), "lit")
