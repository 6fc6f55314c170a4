"""Opening of files that are dropped on the window or passed on by a second instance of TurnDesk."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QMimeData, QObject, Qt
from PySide6.QtGui import QDropEvent

from app.desk.desk import Desk
from app.desk.translation import tr
from app.editor.editor_model import EditorModel
from app.screen.page_table import AUTOMATIC, EDITOR
from core.message import Message

if TYPE_CHECKING:
    from app.screen.window.main_window import MainWindow
    from app.screen.window.window_frame import WindowFrame

_CONVERTIBLE_EXTENSIONS = frozenset({".ngc", ".eia"})  # Programs of other controls.
_DRAGS = frozenset({QEvent.Type.DragEnter, QEvent.Type.DragMove, QEvent.Type.Drop})


class FileOpener(QObject):
    """Event filter that opens a dropped file: a program on the Automatic page, a drawing in the editor.

    The rules are the same as for a file that is selected in the program list. A program is not loaded while
    another one runs. If it would replace an interrupted job, the operator must first confirm. The editor
    first saves its text. A file that no page opens is rejected by name.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        window.setAcceptDrops(True)
        window.installEventFilter(self)

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Handle the drag events of the window, and pass on all other events."""
        if event.type() not in _DRAGS or not isinstance(event, QDropEvent):
            return False
        files = list_dropped_paths(event.mimeData())
        if not files or not event.possibleActions() & Qt.DropAction.CopyAction:
            event.ignore()  # after a move, the file manager would delete the file
            return True
        event.setDropAction(Qt.DropAction.CopyAction)
        event.accept()
        if event.type() is QEvent.Type.Drop:
            self._open_dropped_files(files)
        return True

    def _open_dropped_files(self, files: list[Path]) -> None:
        """Open a dropped file, or show that no page opens files with its extension."""
        frame, name = self._window.frame, files[0].name
        if frame is None:
            return
        if len(files) == 1 and files[0].is_file() and not _can_open(frame.desk, name):
            words = "{name} NOT OPENED. NO PAGE OPENS {extension} FILES"
            extension = Path(name).suffix.lower()
            frame.desk.say(tr(Message(words, name=name, extension=extension)))
            self._window.refresh()
        else:
            self.open_files(files)

    def open_files(self, files: list[Path]) -> None:
        """Open the file if ``files`` contains exactly one, and otherwise show why nothing is opened."""
        frame = self._window.frame
        if frame is None or not files:
            return
        if len(files) > 1:
            frame.desk.say(tr("DROP ONE PROGRAM AT A TIME"))
        elif not files[0].is_file():
            frame.desk.say(tr(Message("{name} IS A FOLDER. DROP A PROGRAM", name=files[0].name)))
        elif frame.desk.program_choice.program_folders.is_drawing_name(files[0].name):
            if self._leave_page(frame, files[0]):
                self._open_drawing(frame, files[0])
        elif frame.desk.program_choice.can_choose_program() and self._leave_page(frame, files[0]):
            frame.desk.program_choice.load_path(files[0])
        self._window.refresh()

    @staticmethod
    def _leave_page(frame: WindowFrame, file: Path) -> bool:
        """Open the Automatic page without anything that covers it.

        Return False after a message if the current page cannot close yet.
        """
        if frame.open_page(AUTOMATIC):
            frame.uncover_page()
            return True
        if not frame.desk.prompt_notice:
            words = "{name} NOT OPENED. DROP IT AGAIN WHEN THIS PAGE IS CLOSED"
            frame.desk.say(tr(Message(words, name=file.name)))
        return False

    @staticmethod
    def _open_drawing(frame: WindowFrame, drawing: Path) -> None:
        """Open the editor with the form that makes a program from a drawing."""
        editor = frame.desk.page_registry.find_model(EditorModel)
        if editor is not None:
            editor.choose_drawing(drawing)
            if not frame.open_page(EDITOR):
                editor.source_drawing, editor.pending_name = None, ""

    def open_file(self, path: Path) -> None:
        """Open a program that a second instance of TurnDesk passes on, and raise the window to the front."""
        window = self._window
        window.setWindowState(window.windowState() & ~Qt.WindowState.WindowMinimized)
        window.raise_()
        window.activateWindow()
        self.open_files([path])


def _can_open(desk: Desk, name: str) -> bool:
    """Return whether a page opens files with the extension of this name."""
    folders = desk.program_choice.program_folders
    return folders.accepts_file_name(name) or Path(name).suffix.lower() in _CONVERTIBLE_EXTENSIONS


def list_dropped_paths(data: QMimeData) -> list[Path]:
    """Return the local files and folders that were dropped."""
    return [Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile()]
