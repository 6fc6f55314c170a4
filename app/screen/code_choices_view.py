"""List of NC codes that can be inserted, for the editor and MDI."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import CodeHelp
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_LEFT, ScreenTheme, ThemedPainter, draw_raw_text
from app.screen.table_panel import RowPanel
from core.language.code_book import CodeBookEntry

CODE_ROW_HEIGHT = 5.2  # Units: a fingertip, which is two lines of text.
EXAMPLE_LINE_HEIGHT = 2.7  # Units: one line of an example.
MAX_EXAMPLE_LINES = 9  # Maximum lines of an example.
WORD_ROW_HEIGHT = 2.3  # Units: one word of the selected code, with its meaning.
_MAX_ONE_COLUMN = 6  # Maximum number of words in a single column.


class CodeChoiceList(RowPanel):
    """List of code choices, with the address words and an example of the selected choice.

    ``on_choose`` inserts the selected code in the text.
    """

    scroll_step, is_centered, has_scroll_keys = 1, True, False
    _shown: RedrawingAttribute[tuple[object, ...]] = RedrawingAttribute(())

    def __init__(
        self, theme: ScreenTheme, code_help: CodeHelp, on_choose: Callable[[], None], parent: QWidget
    ) -> None:
        super().__init__(theme, parent)
        self._help, self._taken = code_help, on_choose
        self.hide()

    def refresh(self) -> None:
        """Redraw the list if the choices or the selection have changed.

        This is called once a frame.
        """
        self._shown = (self._help.choices, self._help.marked)

    def _find_foot_height(self) -> float:
        """Return the height in pixels of the foot, which contains the address words and the example."""
        return self._find_example_height() + self._count_word_rows() * WORD_ROW_HEIGHT * self.theme.unit_px

    def _find_example_height(self) -> float:
        """Return the height of the example in pixels."""
        chosen = self._help.selected_entry
        lines = chosen.example.splitlines()[:MAX_EXAMPLE_LINES] if chosen is not None else []
        return (len(lines) * EXAMPLE_LINE_HEIGHT + 1.4) * self.theme.unit_px if lines else 0.0

    def _find_sketch_height(self) -> float:
        """Return the height of a sketch of the code in pixels, or 0 without a sketch.

        The base class has no sketch. Subclasses may override this.
        """
        return 0.0

    def _count_word_rows(self) -> int:
        """Return how many rows of address words fit without hiding the selected code."""
        count, u = len(self._help.words), self.theme.unit_px
        wanted = count if count <= _MAX_ONE_COLUMN else -(-count // 2)
        room = (
            self.height()
            - self._find_example_height()
            - self._find_sketch_height()
            - (3.2 + CODE_ROW_HEIGHT) * u
        )
        return max(0, min(wanted, int(room / (WORD_ROW_HEIGHT * u))))

    def _write_words(self, painter: ThemedPainter) -> None:
        """Draw the address words above the example, in two columns if there are many."""
        u, rows = self.theme.unit_px, self._count_word_rows()
        columns = 1 if len(self._help.words) <= _MAX_ONE_COLUMN else 2
        wide = (self.width() - 3.2 * u) / columns
        top = self.height() - self._find_example_height() - rows * WORD_ROW_HEIGHT * u
        letters = min(7.0, max((1.3 * len(word) + 1.2 for word, _ in self._help.words), default=0.0)) * u
        for place, (word, what) in enumerate(self._help.words[: rows * columns]):
            column, row = divmod(place, rows)
            box = QRectF(
                1.6 * u + column * wide, top + row * WORD_ROW_HEIGHT * u, wide - 0.6 * u, WORD_ROW_HEIGHT * u
            )
            painter.draw_text_line(box, word, 1.7, "accent", raw=True)
            painter.draw_text_line(box.adjusted(letters, 0, 0, 0), what, 1.7, "text", bold=False)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the code choices, with the address words and an example of the selected choice."""
        u, shown = self.theme.unit_px, self._help
        self.frame(painter, shown.title)
        if shown.selected_entry is None:
            return
        high = CODE_ROW_HEIGHT * u
        room = QRectF(
            0.8 * u, 2.4 * u, self.width() - 1.6 * u, self.height() - self._find_foot_height() - 3.2 * u
        )
        count = len(shown.choices)
        self.draw_scroll_keys(painter, room, self.count_fitting_rows(room, high, count), count, shown.marked)
        for number, box in self.find_row_boxes(room, high):
            self._row(painter, box, shown.choices[number], number)
        self._write_words(painter)
        lines = shown.selected_entry.example.splitlines()[:MAX_EXAMPLE_LINES]
        row = QRectF(
            1.6 * u,
            self.height() - (len(lines) * EXAMPLE_LINE_HEIGHT + 1.4) * u,
            self.width() - 3.2 * u,
            EXAMPLE_LINE_HEIGHT * u,
        )
        painter.setFont(self.theme.make_font(1.9))
        painter.setPen(self.theme.get_color("text"))
        for line in lines:
            draw_raw_text(painter, row, ALIGN_LEFT, line)
            row.translate(0, EXAMPLE_LINE_HEIGHT * u)

    def _row(self, painter: ThemedPainter, box: QRectF, entry: CodeBookEntry, number: int) -> None:
        marked = number == self._help.marked
        if marked:
            painter.fill_rect(box, "lit")
        room = box.adjusted(0.6 * self.theme.unit_px, 0.2 * self.theme.unit_px, -0.4 * self.theme.unit_px, 0)
        draw_code_entry(painter, room, entry, *(("on_lit", "on_lit") if marked else ("accent", "text")))
        self.add_target(box, partial(self._press_choice, number), kind="row", is_on=marked)

    def scroll_by(self, rows: int) -> None:
        """Move the selection by a number of rows."""
        self._help.mark(self._help.marked + rows)

    def _press_choice(self, number: int) -> None:
        """Select the touched row, or insert its code if the row is already selected."""
        if number == self._help.marked:
            self._taken()
        else:
            self._help.mark(number)


def draw_code_entry(
    painter: ThemedPainter, box: QRectF, entry: CodeBookEntry, code_color: str, text_color: str
) -> None:
    """Draw the syntax of a code, with its meaning below it."""
    upper = box.adjusted(0, 0, 0, -box.height() / 2)
    painter.draw_text_line(upper, entry.form, 1.9, code_color, raw=True, fit=False)
    painter.draw_text_line(
        upper.translated(0, upper.height() - 0.2 * painter.theme.unit_px),
        entry.what,
        1.7,
        text_color,
        bold=False,
        fit=False,
    )
