"""Opening of files that are dropped on the window or passed on by a second instance of TurnDesk."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QMimeData, QObject, Qt
from PySide6.QtGui import QDropEvent

from app.desk.translation import tr
from app.screen.page_table import AUTOMATIC
from core.message import Message

if TYPE_CHECKING:
    from app.screen.window.main_window import MainWindow

_DRAGS = frozenset({QEvent.Type.DragEnter, QEvent.Type.DragMove, QEvent.Type.Drop})


class FileOpener(QObject):
    """Event filter that loads a dropped file as the program, on the Automatic page.

    The rules are the same as for a program that is selected in the program list. A file is not loaded while
    a program runs. If it would replace an interrupted job, the operator must first confirm. A page with
    unsaved changes stays open.
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
            self.open_files(files)
        return True

    def open_files(self, files: list[Path]) -> None:
        """Open the file if ``files`` contains exactly one, and otherwise show why nothing is opened."""
        frame = self._window.frame
        if frame is None or not files:
            return
        if len(files) > 1:
            frame.desk.say(tr("DROP ONE PROGRAM AT A TIME"))
        elif not files[0].is_file():
            frame.desk.say(tr(Message("{name} IS A FOLDER. DROP A PROGRAM", name=files[0].name)))
        elif frame.desk.program_choice.can_choose_program() and frame.open_page(AUTOMATIC):
            frame.desk.program_choice.load_path(files[0])
        self._window.refresh()

    def open_file(self, path: Path) -> None:
        """Open a program that a second instance of TurnDesk passes on, and raise the window to the front."""
        window = self._window
        window.setWindowState(window.windowState() & ~Qt.WindowState.WindowMinimized)
        window.raise_()
        window.activateWindow()
        self.open_files([path])


def list_dropped_paths(data: QMimeData) -> list[Path]:
    """Return the local files and folders that were dropped."""
    return [Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile()]
