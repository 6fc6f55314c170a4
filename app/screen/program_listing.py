"""The program window: source lines, the current one marked, the generated block under it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from textwrap import wrap

from PySide6.QtCore import QRectF
from PySide6.QtGui import QWheelEvent

from app.desk.translation import tr
from app.screen.look import RIGHT, Painter
from app.screen.panel import Panel, Shown
from core.message import Message

_LETTER = 1.1  # units: one of a sentence, about
ROW, MM = 2.9, 7.0  # units from line to line, and at most so many millimetres


class Listing(Panel):
    """Paints only the lines that are seen, so its cost does not grow with the program."""

    _line = Shown(0)
    _block, _next = Shown(""), Shown("")
    _top: Shown[int | None] = Shown(None)  # first row when scrolled by hand, None while it follows the run
    _bad: Shown[Mapping[int, str]] = Shown({})
    _lines: Sequence[str] = ()
    trouble = Shown("")  # why there is nothing to be shown
    touched: Callable[[int], None] | None = None  # a finger on a line, where lines are chosen

    def show_source(self, lines: Sequence[str], bad: Mapping[int, str]) -> None:
        """Another program; ``bad`` are messages by line number."""
        if lines is not self._lines or bad != self._bad:
            self._lines, self._bad = lines, dict(bad)
            self._top = max(0, min(self._bad) - 3) if self._bad else None
            self.update()

    def show_run(self, line: int, block: str, following: str) -> None:
        """The line that is executed (0: none), the generated block, and the one after it.

        The one after is shown where it is generated too; where it is the next line, that line shows it.
        """
        if following and any(text.startswith(following) for text in self._lines[line : line + 1]):
            following = ""
        self._line, self._block, self._next = line, block, following

    @property
    def rows(self) -> int:
        """How many lines of the program fit into the window."""
        return max(1, int((self.height() - 3.2 * self.look.u) / self._high))

    @property
    def _high(self) -> float:
        """From line to line, pixels."""
        return self.look.row(ROW, MM, touch=self.touched is not None)

    @property
    def _scale(self) -> float:
        """Of the letters, by the height of a line."""
        return min(1.0, self._high / (ROW * self.look.u))  # higher for a finger alone

    @property
    def top(self) -> int:
        """Number of the first row shown, from 0."""
        if self._top is not None:
            return self._top
        at = max(0, self._line - 1 - self.rows // 3)
        return max(0, min(at, len(self._lines) + self._extra - self.rows))

    @property
    def _extra(self) -> int:
        return (1 if self._block else 0) + (1 if self._block and self._next else 0)

    @property
    def follows(self) -> bool:
        """Whether the window goes along with the run."""
        return self._top is None

    def follow(self) -> None:
        """Go along with the run again."""
        self._top = None

    def look_at(self, rows: int) -> None:
        """Look elsewhere in the program; the run goes on."""
        most = max(0, len(self._lines) + self._extra - self.rows)
        self._top = max(0, min(most, self.top + rows))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Three lines a notch."""
        self.look_at(-round(event.angleDelta().y() / 40))

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        count = len(self._lines)
        title = Message("PROGRAM  ·  {count} LINES", count=count) if count else "PROGRAM"
        self.frame(painter, title if self.follows else Message("{title}  ·  HOME: CURRENT LINE", title=title))
        row = QRectF(0.3 * u, 2.5 * u, self.width() - 0.6 * u, self._high)
        number = self.top + 1
        for _ in range(self.rows):
            if number > count:
                break
            self._source(painter, row, number)
            row.translate(0, self._high)
            if number == self._line and self._block:
                row = self._generated(painter, row)
            if row.bottom() > self.height() - 0.4 * u:
                break
            number += 1
        if not count:
            self._none(painter)

    def _none(self, painter: Painter) -> None:
        room, high = self.inside(), ROW * self.look.u
        room.setHeight(high)
        wide = max(10, int(room.width() / (_LETTER * self.look.u)))
        for row in wrap(tr(self.trouble or "No program loaded."), wide):
            painter.write(room, row, 2.0, "text" if self.trouble else "soft", bold=False, raw=True)
            room.translate(0, high)

    def _source(self, painter: Painter, row: QRectF, number: int) -> None:
        u = self.look.u
        here, bad = number == self._line, number in self._bad
        if self.touched is not None:
            self.place(QRectF(row), partial(self.touched, number))
        if here:
            painter.fill(row, "here")
            painter.fill(QRectF(row.x(), row.y(), 0.7 * u, row.height()), "lit")
        if bad:
            painter.fill(QRectF(row.x(), row.y(), 0.7 * u, row.height()), "alarm")
        scale = self._scale
        wide = max(4, len(str(len(self._lines)))) * 1.2 * u * scale
        margin = QRectF(row.x() + 1.2 * u, row.y(), wide, row.height())
        painter.write(margin, str(number), 1.7 * scale, "alarm" if bad else "soft", at=RIGHT, bold=False)
        text, room = self._lines[number - 1].expandtabs(4), row.adjusted(wide + 2.4 * u, 0, -0.8 * u, 0)
        painter.write(room, text, 2.1 * scale, "text", bold=here, raw=True, fit=False)

    def _generated(self, painter: Painter, row: QRectF) -> QRectF:
        u = self.look.u
        for text, name in ((self._block, "accent"), (self._next, "soft")):
            if not text or row.bottom() > self.height() - 0.2 * u:
                break
            if name == "accent":
                painter.fill(row, "here")
                painter.fill(QRectF(row.x(), row.y(), 0.7 * u, row.height()), "lit")
            label = "BLOCK" if name == "accent" else "NEXT"
            painter.write(
                QRectF(row.x() + 1.2 * u, row.y(), 5.6 * u, row.height()), label, 1.6 * self._scale, name
            )
            room = row.adjusted(7.6 * u, 0, -0.8 * u, 0)
            painter.write(room, text, 2.0 * self._scale, name, bold=name == "accent", raw=True, fit=False)
            row = row.translated(0, self._high)
        return row
