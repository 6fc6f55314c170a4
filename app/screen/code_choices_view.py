"""List of the codes of a programming language, which the editor and MDI show."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import CodeHelp
from app.screen.look import LEFT, Look, Painter, put_raw
from app.screen.panel import Shown
from app.screen.sheet_panel import RowPanel
from core.language.code_book import Entry

CODE_LINE = 5.2  # Units: a fingertip, which is two lines of text.
LINE = 2.7  # Units: one line of an example.
MOST_LINES = 9  # Maximum lines of an example.
WORD_LINE = 2.3  # Units: one word of the selected code, with its meaning.
_ONE_COLUMN = 6  # Maximum number of words in a single column.


class CodeChoices(RowPanel):
    """List of code choices, with the words and an example of the selected choice.

    ``take`` inserts the selected code in the text.
    """

    notch, centred, keyed = 1, True, False
    _shown: Shown[tuple[object, ...]] = Shown(())

    def __init__(self, look: Look, codes: CodeHelp, take: Callable[[], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._help, self._taken = codes, take
        self.hide()

    def refresh(self) -> None:
        """Redraw the list if the choices or the selection have changed; called once a frame."""
        self._shown = (self._help.choices, self._help.marked)

    def _foot(self) -> float:
        """Return the height of the words and the example in pixels."""
        return self._example() + self._rows_of_words() * WORD_LINE * self.look.u

    def _example(self) -> float:
        """Return the height of the example in pixels."""
        chosen = self._help.chosen
        lines = chosen.example.splitlines()[:MOST_LINES] if chosen is not None else []
        return (len(lines) * LINE + 1.4) * self.look.u if lines else 0.0

    def _drawn(self) -> float:
        """Return the height of a drawing in pixels. Subclasses may override this."""
        return 0.0

    def _rows_of_words(self) -> int:
        """Return the number of word rows that leave enough room for the selected code."""
        count, u = len(self._help.words), self.look.u
        wanted = count if count <= _ONE_COLUMN else -(-count // 2)
        room = self.height() - self._example() - self._drawn() - (3.2 + CODE_LINE) * u
        return max(0, min(wanted, int(room / (WORD_LINE * u))))

    def _write_words(self, painter: Painter) -> None:
        """Draw the words above the example, in two columns if there are many."""
        u, rows = self.look.u, self._rows_of_words()
        columns = 1 if len(self._help.words) <= _ONE_COLUMN else 2
        wide = (self.width() - 3.2 * u) / columns
        top = self.height() - self._example() - rows * WORD_LINE * u
        letters = min(7.0, max((1.3 * len(word) + 1.2 for word, _ in self._help.words), default=0.0)) * u
        for place, (word, what) in enumerate(self._help.words[: rows * columns]):
            column, row = divmod(place, rows)
            box = QRectF(1.6 * u + column * wide, top + row * WORD_LINE * u, wide - 0.6 * u, WORD_LINE * u)
            painter.write(box, word, 1.7, "accent", raw=True)
            painter.write(box.adjusted(letters, 0, 0, 0), what, 1.7, "text", bold=False)

    def draw(self, painter: Painter) -> None:
        u, shown = self.look.u, self._help
        self.frame(painter, shown.title)
        if shown.chosen is None:
            return
        high = CODE_LINE * u
        room = QRectF(0.8 * u, 2.4 * u, self.width() - 1.6 * u, self.height() - self._foot() - 3.2 * u)
        count = len(shown.choices)
        self.scrolled(painter, room, self.fitting(room, high, count), count, shown.marked)
        for number, box in self.boxes(room, high):
            self._row(painter, box, shown.choices[number], number)
        self._write_words(painter)
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
        self.place(box, partial(self._press, number), kind="row", on=marked)

    def scroll_by(self, rows: int) -> None:
        """Move the selection by a number of rows."""
        self._help.mark(self._help.marked + rows)

    def _press(self, number: int) -> None:
        """Select the touched row, or insert its code if the row is already selected."""
        if number == self._help.marked:
            self._taken()
        else:
            self._help.mark(number)


def write_entry(painter: Painter, box: QRectF, entry: Entry, code: str, words: str) -> None:
    """Draw the form of a code, with its meaning below."""
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
