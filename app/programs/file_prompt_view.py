"""The prompt ``FILE TO BE PROCESSED``, in which a program name is typed or selected from a list."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from app.desk.programs.program_folder import ListedProgram, ProgramFolders
from app.desk.status.prompt_line import CHOOSE_FILE_TEXT, FILE_NOT_FOUND_TEXT, FILE_QUESTION
from app.desk.translation import tr
from app.screen.entry_panel import style_line_edit
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ScreenTheme, ThemedPainter, draw_text
from app.screen.table_panel import RowPanel
from core.message import Message

ROW_HEIGHT = 6.6  # units: a fingertip


class FilePrompt(RowPanel):
    """Prompt for the name of a program.

    Typing filters the list. Enter opens the program with exactly this name, or the selected row.
    """

    title = FILE_QUESTION
    scroll_step, is_centered = 1, True

    def __init__(
        self,
        theme: ScreenTheme,
        program_folders: ProgramFolders,
        select_cell: Callable[[str], bool],
        on_closed: Callable[[], None],
        parent: QWidget,
    ) -> None:
        super().__init__(theme, parent)
        self._shelf, self._choose, self._closed = program_folders, select_cell, on_closed
        self._entries: tuple[ListedProgram, ...] = ()
        self._row = 0
        self._moved = False  # The user selected a row, which has priority over the typed name.
        self.is_not_found = False
        self.name_edit = QLineEdit(self)
        self.name_edit.setMaxLength(250)
        self.name_edit.setAcceptDrops(False)  # The window opens a dropped file.
        self.name_edit.textEdited.connect(self._typed)
        self.name_edit.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)
        self.name_edit.installEventFilter(self)
        self.apply_theme()
        self.hide()

    @property
    def message_text(self) -> str:
        """Return the message about the name, or an empty string."""
        return FILE_NOT_FOUND_TEXT if self.is_not_found else ""

    @property
    def requested_name(self) -> str:
        """Return the name or path of the program on which F3 acts.

        This is the row that the user selected, or otherwise the typed name, which may be an empty string.
        """
        if self._moved and self._entries:
            return str(self._entries[self._row].path)
        return self.name_edit.text().strip()

    def prompt_text(self) -> str:
        """Return the text for the prompt line.

        The text does not mention Cycle Start, because its keys enter characters while the prompt is open.
        """
        return FILE_NOT_FOUND_TEXT if self.is_not_found else CHOOSE_FILE_TEXT

    def show_prompt(self) -> None:
        """Show the empty prompt with the keyboard focus."""
        self.is_not_found = False
        self.name_edit.clear()
        self._narrow("")
        self.show()
        self.raise_()
        self.name_edit.setFocus()

    def close_prompt(self) -> None:
        """Close the prompt.

        The loaded program does not change.
        """
        if self.isVisible():
            self.hide()
            self._closed()

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Handle the keys that select a row, and Enter and Esc.

        All other keys enter text.
        """
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._key(event)
        return False

    def _key(self, event: QKeyEvent) -> bool:
        if self.is_not_found:
            self.is_not_found = False
            self.name_edit.selectAll()
            self.update()
            return True
        actions: dict[int, Callable[[], None]] = {
            Qt.Key.Key_Escape: self.close_prompt,
            Qt.Key.Key_Return: self._take,
            Qt.Key.Key_Enter: self._take,
            Qt.Key.Key_Down: lambda: self._mark(self._row + 1),
            Qt.Key.Key_Up: lambda: self._mark(self._row - 1),
            Qt.Key.Key_PageDown: lambda: self._mark(self._row + self.rows),
            Qt.Key.Key_PageUp: lambda: self._mark(self._row - self.rows),
            Qt.Key.Key_Home: lambda: self._mark(0),
            Qt.Key.Key_End: lambda: self._mark(len(self._entries) - 1),
        }
        action = actions.get(event.key())
        if action is None:
            return False
        action()
        return True

    def _typed(self, text: str) -> None:
        self._moved = False
        self._narrow(text)

    def _narrow(self, text: str) -> None:
        self._entries = self._shelf.find_matching_programs(text)
        self._row = 0
        self.update()

    def _mark(self, row: int) -> None:
        if self._entries:
            self._row = max(0, min(len(self._entries) - 1, row))
            self._moved = True
            self.update()

    def _take(self) -> None:
        typed = self.name_edit.text()
        if not self._moved and typed.strip() and self._shelf.find_path(typed) is not None:
            self._try(typed)
        elif self._entries:
            self._try(str(self._entries[self._row].path))
        else:
            self._try(typed)

    def _try(self, name: str) -> None:
        if self._choose(name):
            self.close_prompt()
        else:
            self.is_not_found = True
            self.update()

    # --- drawing -------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Place the entry line below the title."""
        u = self.theme.unit_px
        self.name_edit.setGeometry(
            round(1.6 * u), round(2.8 * u), round(self.width() - 3.2 * u), round(4.8 * u)
        )
        self.apply_theme()

    def apply_theme(self) -> None:
        """Apply font and colors to the entry line."""
        self.name_edit.setAccessibleName(tr(FILE_QUESTION))
        style_line_edit(self.name_edit, self.theme, 2.6, 1.0)

    def scroll_by(self, rows: int) -> None:
        """Move the selection by a number of rows."""
        self._mark(self._row + rows)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the prompt with the matching programs, or a message if the program was not found.

        The last row shows the keys and the number of matching programs.
        """
        u = self.theme.unit_px
        self.frame(painter, self.title, "accent", 0.3)
        foot = QRectF(1.6 * u, self.height() - 3.2 * u, self.width() - 3.2 * u, 2.6 * u)
        if self.is_not_found:
            self._not_found(painter)
        else:
            self._list(painter)
        keys = "ENTER: load the selected program   ESC: keep the current program   F2: show the list"
        painter.draw_text_line(foot, keys, 1.6, "soft", bold=False, fit=False)
        count = len(self._entries)
        draw_text(
            painter,
            foot,
            ALIGN_RIGHT,
            tr("1 program") if count == 1 else Message("{count} programs", count=count),
        )

    def _list(self, painter: ThemedPainter) -> None:
        u = self.theme.unit_px
        fits = max(1, int((self.height() - 10.5 * u) / (ROW_HEIGHT * u)))
        room = QRectF(1.6 * u, 8.0 * u, self.width() - 3.2 * u, fits * ROW_HEIGHT * u)
        room = self.draw_scroll_keys(painter, room, fits, len(self._entries), self._row)
        for number, box in self.find_row_boxes(room, ROW_HEIGHT * u):
            entry, marked = self._entries[number], number == self._row
            if marked:
                painter.fill_rect(box, "lit")
            ink, soft = ("on_lit", "on_lit") if marked else ("text", "soft")
            name = box.adjusted(1.2 * u, 0, -30 * u, 0)
            painter.draw_text_line(name, entry.name, 2.3, ink, bold=marked, raw=True, fit=False)
            folder, text = box.adjusted(box.width() - 30 * u, 0, -1.2 * u, 0), entry.path.parent.name
            painter.draw_text_line(folder, text, 1.6, soft, at=ALIGN_RIGHT, bold=False, raw=True, fit=False)
            self.add_target(box, partial(self._try, str(entry.path)), kind="row", is_on=marked)

    def _not_found(self, painter: ThemedPainter) -> None:
        u = self.theme.unit_px
        box = QRectF(1.6 * u, 10 * u, self.width() - 3.2 * u, 7 * u)
        painter.fill_rect(box, "alarm")
        painter.draw_text_line(box, FILE_NOT_FOUND_TEXT, 2.8, "on_state", at=ALIGN_CENTER, margin=2)
