"""The codes of a language as a list to choose from: the editor and MDI show it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.code_help import CodeHelp
from app.screen.look import LEFT, Look, Painter, put_raw
from app.screen.panel import Panel, Shown
from core.language.code_book import Entry

CODE_LINE = 5.2  # units: a finger's height, two lines of text
LINE = 2.7  # units: a line of an example
MOST_LINES = 9  # of an example


class CodeChoices(Panel):
    """The choices, and of the marked one lines that use it. ``take`` writes the marked code."""

    _shown: Shown[tuple[object, ...]] = Shown(())

    def __init__(self, look: Look, codes: CodeHelp, take: Callable[[], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._help, self._taken = codes, take
        self.hide()

    def refresh(self) -> None:
        """Once a frame: drawn anew when other choices are shown or another one is marked."""
        self._shown = (self._help.choices, self._help.marked)

    def _foot(self) -> float:
        """Pixels that the example of the marked choice takes."""
        chosen = self._help.chosen
        lines = chosen.example.splitlines()[:MOST_LINES] if chosen is not None else []
        return (len(lines) * LINE + 1.4) * self.look.u if lines else 0.0

    def draw(self, painter: Painter) -> None:
        u, shown = self.look.u, self._help
        self.frame(painter, shown.title)
        if shown.chosen is None:
            return
        rows = max(1, int((self.height() - self._foot() - 3.2 * u) / (CODE_LINE * u)))
        first = max(0, min(shown.marked - rows // 2, len(shown.choices) - rows))
        for place, entry in enumerate(shown.choices[first : first + rows]):
            box = QRectF(0.8 * u, (2.4 + place * CODE_LINE) * u, self.width() - 1.6 * u, CODE_LINE * u)
            self._row(painter, box, entry, first + place)
        lines = shown.chosen.example.splitlines()[:MOST_LINES]
        row = QRectF(1.6 * u, self.height() - (len(lines) * LINE + 1.4) * u, self.width() - 3.2 * u, LINE * u)
        painter.setFont(self.look.font(1.9))
        painter.setPen(self.look.colour("text"))
        for line in lines:
            put_raw(painter, row, LEFT, line)
            row.translate(0, LINE * u)

    def _row(self, painter: Painter, box: QRectF, entry: Entry, number: int) -> None:
        marked = number == self._help.marked
        if marked:
            painter.fill(box, "lit")
        room = box.adjusted(0.6 * self.look.u, 0.2 * self.look.u, -0.4 * self.look.u, 0)
        write_entry(painter, room, entry, *(("on_lit", "on_lit") if marked else ("accent", "text")))
        self.place(box, partial(self._press, number))

    def _press(self, number: int) -> None:
        """A finger marks a row; on the marked one it takes it."""
        if number == self._help.marked:
            self._taken()
        else:
            self._help.mark(number)


def write_entry(painter: Painter, box: QRectF, entry: Entry, code: str, words: str) -> None:
    """The form above, the meaning below."""
    upper = box.adjusted(0, 0, 0, -box.height() / 2)
    painter.write(upper, entry.form, 1.9, code, raw=True, fit=False)
    painter.write(
        upper.translated(0, upper.height() - 0.2 * painter.look.u),
        entry.what,
        1.7,
        words,
        bold=False,
        fit=False,
    )
