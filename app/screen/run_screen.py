"""Start of the operator screen: show the window first, then build the model, then load a program."""

from __future__ import annotations

import logging
import signal
import sys
from collections.abc import Callable
from types import TracebackType

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from app.desk.desk import Desk
from app.desk.programs.first_program import begin_with
from app.screen import accessible
from app.screen.look import PALETTES, Look, dress, load_fonts
from app.screen.window.main_window import MainWindow
from core.message import Message

_LISTENS_AFTER = 500  # ms; the first picture does not wait for what few starts need
BuildDesk = Callable[[], Desk]
_log = logging.getLogger(__name__)
# These signals stop the machine and end the threads, like closing the window.
ENDING = (signal.SIGINT, signal.SIGTERM)


def run_screen(
    machine: str | None = None,
    program: str | None = None,
    offsets: str | None = None,
    theme: str = "dark",
    build: BuildDesk | None = None,
    *,
    kiosk: bool = False,
) -> int:
    """Show the screen until it is closed, and return the exit status.

    ``machine`` is a machine file. ``program`` is a file to load at the start. ``offsets`` is an offsets file
    that replaces the stored offsets. ``build`` creates the model; the default is the composed model. A
    ``kiosk`` fills the screen and cannot be closed by hand. An exception of ``build`` is raised here after
    the window has closed.
    """
    build = build or _composed(machine, offsets)
    app = _application(theme)
    # Otherwise Qt would post a quit event that remains after this event loop.
    app.setQuitOnLastWindowClosed(False)
    window = MainWindow(Look(PALETTES[theme]), app.quit)
    window.kiosk = kiosk
    window.open_on(app.primaryScreen())
    start = _Start(window, build, program)
    before, sys.excepthook = sys.excepthook, start.mistake
    # Use exit and not quit, because a window may refuse to close, and a shutdown cannot wait.
    handlers = [(number, signal.signal(number, lambda *_: app.exit(0))) for number in ENDING]
    QTimer.singleShot(0, start.run)
    status = app.exec()
    sys.excepthook = before
    for number, handler in handlers:
        signal.signal(number, handler)
    window.hide()
    window.deleteLater()
    start.close()
    return status


class _Start:
    """The steps that follow the first painting of the window."""

    def __init__(self, window: MainWindow, build: BuildDesk, program: str | None) -> None:
        self._window, self._build, self._program = window, build, program
        self._desk: Desk | None = None
        self._trouble: Exception | None = None

    def run(self) -> None:
        """Build the model and open it. An error ends the event loop, and ``close`` raises it."""
        try:
            desk = self._desk = self._build()
            self._window.open_desk(desk)
            begin_with(desk, self._program)
            self._listen_later()
        except Exception as error:  # noqa: BLE001 - raised into Qt's loop nobody could catch it
            self._trouble = error
            QApplication.exit(1)

    def _listen_later(self) -> None:
        """Start ``_listen`` after the first pictures; the timer ends with the window."""
        timer = QTimer(self._window)
        timer.setSingleShot(True)
        timer.timeout.connect(self._listen)
        timer.start(_LISTENS_AFTER)

    def _listen(self) -> None:
        """Receive the programs that later starts of TurnDesk hand over."""
        from app.screen.window.file_opening import FileOpening
        from app.screen.window.running_screen import RunningScreen

        opening = FileOpening(self._window)
        RunningScreen(opening.open_file, self._window).listen()

    def mistake(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        """Log an exception from Qt's event loop with its traceback, and show it to the operator."""
        _log.error("the screen has failed", exc_info=(kind, error, trace))
        if self._desk is not None:
            self._desk.say(
                Message("SCREEN FAULT (MACHINE OK): {name}: {error}", name=kind.__name__, error=error)
            )

    def close(self) -> None:
        """Stop the machine, end the threads and raise the error of the start, if any."""
        if self._desk is not None:
            self._desk.close()
        if self._trouble is not None:
            raise self._trouble


def _composed(machine: str | None, offsets: str | None) -> BuildDesk:
    """Start the control in the background, and return the function that builds the model on it."""
    from app.compose.control.control_begin import begin_control

    begun = begin_control(machine)

    def build() -> Desk:
        from app.compose.screen_desk import build_desk
        from app.compose.stored_offsets import chosen_offsets

        return build_desk(machine, chosen_offsets(offsets), begun)

    return build


def _application(theme: str) -> QApplication:
    present = QApplication.instance()
    app = present if isinstance(present, QApplication) else QApplication(sys.argv[:1])
    app.setApplicationName("TurnDesk")
    # Desktops use this name to find the application's name and icon, also under Wayland.
    app.setDesktopFileName("turndesk")
    load_fonts()
    accessible.install()
    dress(PALETTES[theme])
    return app
