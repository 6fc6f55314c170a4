"""The operator screen as a program: the window first, then the machine behind it, then a program."""

from __future__ import annotations

import logging
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from app.desk.desk import Desk
from app.desk.translation import tr
from app.screen import accessible
from app.screen.look import PALETTES, Look, dress, load_fonts
from app.screen.window.main_window import MainWindow
from core.message import Message


def begin_with(desk: Desk, named: str | None) -> None:
    """At the start: the program that was interrupted, or else the one that is ``named``."""
    found = desk.snapshot().interrupted
    path = str(Path(named).absolute()) if named is not None else ""
    if found is None:
        if named is not None and not desk.choose(path):
            desk.say(Message("FILE NOT FOUND: {named}", named=named))
    elif named is not None and Path(named).name == found.program and desk.choose(path):
        return
    elif not desk.choose(found.program):
        desk.say(
            tr(
                Message(
                    "INTERRUPTED PROGRAM {name} NOT FOUND. F2: CHOOSE A PROGRAM",
                    name=found.program,
                )
            )
        )
    elif named is not None:
        desk.say(
            tr(Message("{name} NOT LOADED: THE INTERRUPTED JOB WAS LOADED INSTEAD", name=Path(named).name))
        )


BuildDesk = Callable[[], Desk]
_log = logging.getLogger(__name__)
ENDING = (signal.SIGINT, signal.SIGTERM)  # the machine is stopped and the threads are ended, as by closing


def run_screen(
    machine: str | None = None,
    program: str | None = None,
    offsets: str | None = None,
    theme: str = "dark",
    build: BuildDesk | None = None,
    *,
    kiosk: bool = False,
) -> int:
    """Show the screen until it is closed; the exit status.

    ``machine`` is a machine file, ``program`` a file to load at the start, ``offsets`` an offsets file that
    takes the place of the store's offsets, ``build`` makes the desk (default:
    the composed one); a ``kiosk`` fills the screen and is not closed by hand.
    What building raises is raised here, after the window is gone.
    """
    app = _application(theme)
    app.setQuitOnLastWindowClosed(False)  # it posts a quit that would outlive this loop
    window = MainWindow(Look(PALETTES[theme]), app.quit)
    window.kiosk = kiosk
    window.open_on(app.primaryScreen())
    start = _Start(window, build or (lambda: _composed(machine, offsets)), program)
    before, sys.excepthook = sys.excepthook, start.mistake
    # Not quit: a window may refuse to close while a program is under way, a computer going down cannot wait.
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
    """What comes after the first picture of the window."""

    def __init__(self, window: MainWindow, build: BuildDesk, program: str | None) -> None:
        self._window, self._build, self._program = window, build, program
        self._desk: Desk | None = None
        self._trouble: Exception | None = None

    def run(self) -> None:
        """Build the desk and open it; what goes wrong ends the program and is raised by ``close``."""
        try:
            desk = self._desk = self._build()
            self._window.open_desk(desk)
            begin_with(desk, self._program)
        except Exception as error:  # noqa: BLE001 - raised into Qt's loop nobody could catch it
            self._trouble = error
            QApplication.exit(1)

    def mistake(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        """A mistake of the screen, raised into Qt's loop: to the log whole, to the operator in a sentence."""
        _log.error("the screen has failed", exc_info=(kind, error, trace))
        if self._desk is not None:
            self._desk.say(
                Message("SCREEN FAULT (MACHINE OK): {name}: {error}", name=kind.__name__, error=error)
            )

    def close(self) -> None:
        """Stop the machine, end the threads, tell what went wrong."""
        if self._desk is not None:
            self._desk.close()
        if self._trouble is not None:
            raise self._trouble


def _composed(machine: str | None, offsets: str | None) -> Desk:
    from app.compose.screen_desk import build_desk
    from app.compose.stored_offsets import chosen_offsets

    return build_desk(machine, chosen_offsets(offsets))


def _application(theme: str) -> QApplication:
    present = QApplication.instance()
    app = present if isinstance(present, QApplication) else QApplication(sys.argv[:1])
    app.setApplicationName("TurnDesk")
    app.setDesktopFileName("turndesk")  # by it a desktop finds name and icon, also under Wayland
    load_fonts()
    accessible.install()
    dress(PALETTES[theme])
    return app
