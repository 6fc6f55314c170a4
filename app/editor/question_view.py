"""Question line of the editor for find and replace, a line number or a file name."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QObject, QRectF, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from app.desk.pages.table_content import FunctionKey
from app.desk.translation import tr
from app.editor.editor_modes import EditorMode
from app.editor.text_search import LONG_TEXT_LENGTH, TextSearch, find_preceding_position, following
from app.editor.text_view import ProgramTextField
from app.screen.entry_panel import style_line_edit
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_RIGHT, ScreenTheme, ThemedPainter
from core.message import Message

SEARCH_PAUSE_MS = 250  # pause in typing after which a long text is searched
LABEL_WIDTH = 15.0  # units: width of a label
MESSAGE_WIDTH = 34.0  # units: width of the message


class QuestionLine(Panel):
    """Question line with one or two labeled fields, and a message about the entry on the right."""

    background_color = "panel"
    message_text = RedrawingAttribute("")  # message about the entry

    def __init__(self, theme: ScreenTheme, toggle_keyboard: QObject, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self.first_field, self.second_field = QLineEdit(self), QLineEdit(self)
        self._labels: tuple[str, ...] = ("",)
        for edit in (self.first_field, self.second_field):
            edit.setMaxLength(250)
            edit.setAcceptDrops(False)  # The window opens a dropped file.
            edit.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)
            edit.installEventFilter(toggle_keyboard)
        self.hide()

    def show_question(self, *labels: str, initial_text: str | None = None) -> None:
        """Show the question line and move the keyboard focus to it.

        The previous entry is selected, so that typing replaces it.
        """
        self._labels = labels
        self.message_text = ""
        if initial_text is not None:
            self.first_field.setText(initial_text)
        for edit, label in zip((self.first_field, self.second_field), labels, strict=False):
            edit.setAccessibleName(tr(label))
        self.second_field.setVisible(len(labels) > 1)
        self.show()
        self._place()
        self.first_field.setFocus()
        self.first_field.selectAll()
        self.update()

    def focus_other_field(self) -> None:
        """Move the keyboard focus to the other field."""
        if len(self._labels) > 1:
            (self.second_field if self.first_field.hasFocus() else self.first_field).setFocus()

    def apply_theme(self) -> None:
        """Apply the font and the colors of the theme to the fields."""
        for edit in (self.first_field, self.second_field):
            style_line_edit(edit, self.theme, 2.3, 0.6)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Place the fields next to their labels."""
        self._place()
        self.apply_theme()

    def _place(self) -> None:
        u = self.theme.unit_px
        for edit, box in zip((self.first_field, self.second_field), self._boxes(), strict=False):
            edit.setGeometry(box.adjusted(LABEL_WIDTH * u, 0.8 * u, 0, -0.8 * u).toRect())

    def _boxes(self) -> list[QRectF]:
        u, count = self.theme.unit_px, len(self._labels)
        wide = (self.width() - (MESSAGE_WIDTH + 2) * u) / count
        return [QRectF(n * wide + u, 0, wide - u, self.height()) for n in range(count)]

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the labels of the fields, and the message about the entry on the right."""
        u = self.theme.unit_px
        for label, box in zip(self._labels, self._boxes(), strict=True):
            painter.draw_text_line(
                QRectF(box.x(), 0, (LABEL_WIDTH - 1) * u, box.height()), label, 1.8, "soft"
            )
        room = QRectF(self.width() - (MESSAGE_WIDTH + 1) * u, 0, MESSAGE_WIDTH * u, self.height())
        painter.draw_text_line(room, self.message_text, 1.9, "text", at=ALIGN_RIGHT)


class TextFinder:
    """Search and replacement of the text in the question line, with the cursor at the selected match."""

    def __init__(self, text_field: ProgramTextField, question_line: QuestionLine) -> None:
        self._field, self._ask = text_field, question_line
        self.matches_whole_words = True
        # search and revision of the text to which the stored results belong
        self._searched: tuple[TextSearch, int] | None = None
        self._matches: tuple[int, ...] = ()
        self._count_text = ""
        self._pause = QTimer(question_line)
        self._pause.setSingleShot(True)
        self._pause.timeout.connect(self.count_matches)
        question_line.first_field.textEdited.connect(lambda _text: self._handle_typing())

    def find_initial_text(self) -> str:
        """Return the selected text if it is within one line, and otherwise the previous search text."""
        marked = self._field.selected_text
        return marked if marked and "\n" not in marked else self._ask.first_field.text()

    @property
    def _search(self) -> TextSearch:
        return TextSearch(self._ask.first_field.text(), self.matches_whole_words)

    def _handle_typing(self) -> None:
        """Count the matches at once, or in a long text after a pause in typing."""
        if self._field.buffer.length > LONG_TEXT_LENGTH:
            self._pause.start(SEARCH_PAUSE_MS)
        else:
            self.count_matches()

    def count_matches(self) -> None:
        """Count the matches and select the first match at or after the cursor."""
        if self._ask.isVisible():
            self._show(following(self._places(), self._field.selection.start))

    def select_match(self, direction: int) -> None:
        """Select the next match if ``direction`` is 1, or the previous match if it is -1."""
        selection, places = self._field.selection, self._places()
        if direction > 0:
            self._show(following(places, selection.end))
        else:
            self._show(find_preceding_position(places, selection.start))

    def replace_match(self) -> None:
        """Replace the selected match and select the next one."""
        (start, end), places = sorted(self._field.selection), self._places()
        length = len(self._search.search_text)
        if end - start == length and following(places, start) == start:
            by = self._ask.second_field.text()
            self._field.replace_text_ranges((start,), length, by)
            self._show(following(self._places(), start + len(by)))
        else:
            self.select_match(1)

    def replace_all_matches(self) -> None:
        """Replace all matches as one step of the undo history."""
        places = self._places()
        if places:
            self._field.replace_text_ranges(
                places, len(self._search.search_text), self._ask.second_field.text()
            )
        self._ask.message_text = (
            Message("{places_count} REPLACED", places_count=len(places)) if places else "NOT FOUND"
        )

    def toggle_whole_words(self) -> None:
        """Toggle whether the search matches only whole words or also parts of words."""
        self.matches_whole_words = not self.matches_whole_words
        self.count_matches()

    def make_function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys that apply during a search."""
        return {
            2: FunctionKey("NEXT", partial(self.select_match, 1)),
            3: FunctionKey("PREVIOUS", partial(self.select_match, -1)),
            4: FunctionKey("REPLACE", self.replace_match),
            5: FunctionKey("ALL", self.replace_all_matches),
            6: FunctionKey("PARTIAL" if self.matches_whole_words else "WHOLE", self.toggle_whole_words),
        }

    def _places(self) -> tuple[int, ...]:
        """Return the positions of the matches. The text is searched once after each change."""
        search, buffer = self._search, self._field.buffer
        if self._searched != (search, buffer.revision):
            self._matches, count_with_parts = search.find_and_count_matches(buffer.text)
            found = search.describe_count(len(self._matches), count_with_parts)
            self._count_text = found if search.search_text else ""
            self._searched = search, buffer.revision
        return self._matches

    def _show(self, place: int | None) -> None:
        self._places()
        self._ask.message_text = self._count_text
        if place is not None:
            self._field.select_range(place, len(self._search.search_text))


def show_mode_question(
    question_line: QuestionLine, text_finder: TextFinder, mode: EditorMode, cursor_line: int, file_name: str
) -> None:
    """Show the question of an editor mode, or hide the question line if the mode has no question."""
    if mode is EditorMode.FIND:
        question_line.show_question("FIND", "REPLACE WITH", initial_text=text_finder.find_initial_text())
        text_finder.count_matches()
    elif mode is EditorMode.LINE_NUMBER:
        question_line.show_question("GO TO LINE", initial_text=str(cursor_line))
    elif mode is EditorMode.NAME:
        question_line.show_question("SAVE AS", initial_text=file_name)
    else:
        question_line.hide()
