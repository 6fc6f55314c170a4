"""Prompt ``FILE TO BE PROCESSED``: a name is typed, or selected in the list by keys or touch."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from app.desk.programs.program_folder import ListedProgram, ProgramFolders
from app.desk.status.prompt_line import ASK_FILE, CHOOSE_FILE, NOT_FOUND
from app.desk.translation import tr
from app.screen.entry_panel import dress_line
from app.screen.look import CENTRE, RIGHT, Look, Painter, put
from app.screen.sheet_panel import RowPanel
from core.message import Message

ROW = 6.6  # units: a fingertip


class FilePrompt(RowPanel):
    """Prompt for a program.

    Typing filters the list, and Enter uses the exact name or the selected row.
    """

    title = ASK_FILE
    notch, centred = 1, True

    def __init__(
        self,
        look: Look,
        program_folders: ProgramFolders,
        choose: Callable[[str], bool],
        closed: Callable[[], None],
        parent: QWidget,
    ) -> None:
        super().__init__(look, parent)
        self._shelf, self._choose, self._closed = program_folders, choose, closed
        self._entries: tuple[ListedProgram, ...] = ()
        self._row = 0
        self._moved = False  # The user selected a row, which has priority over the typed name.
        self.not_found = False
        self.edit = QLineEdit(self)
        self.edit.setMaxLength(250)
        self.edit.textEdited.connect(self._typed)
        self.edit.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)
        self.edit.installEventFilter(self)
        self.dress()
        self.hide()

    @property
    def message(self) -> str:
        """Message about the name, or an empty string."""
        return NOT_FOUND if self.not_found else ""

    @property
    def wanted(self) -> str:
        """Program for F3: the row that the user selected, or the typed name, or an empty string."""
        if self._moved and self._entries:
            return str(self._entries[self._row].path)
        return self.edit.text().strip()

    def prompt(self) -> str:
        """Return the prompt. Cycle Start is not mentioned, because its keys are text here."""
        return NOT_FOUND if self.not_found else CHOOSE_FILE

    def ask(self) -> None:
        """Show the empty prompt with the keyboard focus."""
        self.not_found = False
        self.edit.clear()
        self._narrow("")
        self.show()
        self.raise_()
        self.edit.setFocus()

    def dismiss(self) -> None:
        """Close the prompt. The loaded program remains."""
        if self.isVisible():
            self.hide()
            self._closed()

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Handle keys of the list, Enter and Esc. All other keys are text."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._key(event)
        return False

    def _key(self, event: QKeyEvent) -> bool:
        if self.not_found:
            self.not_found = False
            self.edit.selectAll()
            self.update()
            return True
        actions: dict[int, Callable[[], None]] = {
            Qt.Key.Key_Escape: self.dismiss,
            Qt.Key.Key_Return: self._take,
            Qt.Key.Key_Enter: self._take,
            Qt.Key.Key_Down: lambda: self._mark(self._row + 1),
            Qt.Key.Key_Up: lambda: self._mark(self._row - 1),
            Qt.Key.Key_PageDown: lambda: self._mark(self._row + self.rows),
            Qt.Key.Key_PageUp: lambda: self._mark(self._row - self.rows),
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
        self._entries = self._shelf.matching(text)
        self._row = 0
        self.update()

    def _mark(self, row: int) -> None:
        if self._entries:
            self._row = max(0, min(len(self._entries) - 1, row))
            self._moved = True
            self.update()

    def _take(self) -> None:
        typed = self.edit.text()
        if not self._moved and typed.strip() and self._shelf.find(typed) is not None:
            self._try(typed)
        elif self._entries:
            self._try(str(self._entries[self._row].path))
        else:
            self._try(typed)

    def _try(self, name: str) -> None:
        if self._choose(name):
            self.dismiss()
        else:
            self.not_found = True
            self.update()

    # --- drawing -------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Place the entry line below the title."""
        u = self.look.u
        self.edit.setGeometry(round(1.6 * u), round(2.8 * u), round(self.width() - 3.2 * u), round(4.8 * u))
        self.dress()

    def dress(self) -> None:
        """Apply font and colors to the entry line."""
        self.edit.setAccessibleName(tr(ASK_FILE))
        dress_line(self.edit, self.look, 2.6, 1.0)

    def scroll_by(self, rows: int) -> None:
        """Move the selection."""
        self._mark(self._row + rows)

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        self.frame(painter, self.title, "accent", 0.3)
        foot = QRectF(1.6 * u, self.height() - 3.2 * u, self.width() - 3.2 * u, 2.6 * u)
        if self.not_found:
            self._not_found(painter)
        else:
            self._list(painter)
        keys = "ENTER: load the selected program   ESC: keep the current program   F2: show the list"
        painter.write(foot, keys, 1.6, "soft", bold=False, fit=False)
        count = len(self._entries)
        put(painter, foot, RIGHT, tr("1 program") if count == 1 else Message("{count} programs", count=count))

    def _list(self, painter: Painter) -> None:
        u = self.look.u
        fits = max(1, int((self.height() - 10.5 * u) / (ROW * u)))
        room = QRectF(1.6 * u, 8.0 * u, self.width() - 3.2 * u, fits * ROW * u)
        room = self.scrolled(painter, room, fits, len(self._entries), self._row)
        for number, box in self.boxes(room, ROW * u):
            entry, marked = self._entries[number], number == self._row
            if marked:
                painter.fill(box, "lit")
            ink, soft = ("on_lit", "on_lit") if marked else ("text", "soft")
            name = box.adjusted(1.2 * u, 0, -30 * u, 0)
            painter.write(name, entry.name, 2.3, ink, bold=marked, raw=True, fit=False)
            folder, text = box.adjusted(box.width() - 30 * u, 0, -1.2 * u, 0), entry.path.parent.name
            painter.write(folder, text, 1.6, soft, at=RIGHT, bold=False, raw=True, fit=False)
            self.place(box, partial(self._try, str(entry.path)), kind="row", on=marked)

    def _not_found(self, painter: Painter) -> None:
        u = self.look.u
        box = QRectF(1.6 * u, 10 * u, self.width() - 3.2 * u, 7 * u)
        painter.fill(box, "alarm")
        painter.write(box, NOT_FOUND, 2.8, "on_state", at=CENTRE, margin=2)
