"""The program window: source lines, the current one marked, the generated block under it."""

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

_LETTER = 1.1  # units: one of a sentence, about
ROW, MM = 2.9, 7.0  # units from line to line, and at most so many millimetres


class Listing(RowPanel):
    """Paints only the lines that are seen, so its cost does not grow with the program."""

    keyed = False
    follows = Shown(True)  # it goes along with the run; False: it is scrolled by hand
    _line = Shown(0)
    _block, _next = Shown(""), Shown("")
    _bad: Shown[Mapping[int, str]] = Shown({})
    _lines: Sequence[str] = ()
    trouble = Shown("")  # why there is nothing to be shown
    touched: Callable[[int], None] | None = None  # a finger on a line, where lines are chosen

    def show_source(self, lines: Sequence[str], bad: Mapping[int, str]) -> None:
        """Another program; ``bad`` are messages by line number."""
        if lines is not self._lines or bad != self._bad:
            self._lines, self._bad = lines, dict(bad)
            self.follows = not self._bad
            self.top = max(0, min(self._bad, default=0) - 3)
            self.update()

    def show_run(self, line: int, block: str, following: str) -> None:
        """The line that is executed (0: none), the generated block, and the one after it.

        The one after is shown where it is generated too; where it is the next line, that line shows it.
        """
        if following and any(text.startswith(following) for text in self._lines[line : line + 1]):
            following = ""
        self._line, self._block, self._next = line, block, following

    @property
    def _high(self) -> float:
        """From line to line, pixels."""
        return self.look.row(ROW, MM, touch=self.touched is not None)

    @property
    def _scale(self) -> float:
        """Of the letters, by the height of a line."""
        return min(1.0, self._high / (ROW * self.look.u))  # higher for a finger alone

    @property
    def _generated(self) -> tuple[str, ...]:
        """The block and the one after it, which stand under the line that is executed."""
        return tuple(filter(None, (self._block, self._next))) if self._block else ()

    def follow(self) -> None:
        """Go along with the run again."""
        self.follows = True

    def scroll_by(self, rows: int) -> None:
        """Look elsewhere in the program; the run goes on."""
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
        """Yield what draws each row from the first that is shown."""
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
