"""Startup of the operator screen.

The window is shown first, then the model is built, and then a program is loaded.
"""

from __future__ import annotations

import logging
import signal
import sys
from collections.abc import Callable
from functools import partial
from types import TracebackType
from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from app.desk.desk import Desk
from app.desk.programs.first_program import load_first_program
from app.desk.screen_settings import SYSTEM_THEME
from app.desk.translation import tr
from app.screen import accessible
from app.screen.screen_theme import ScreenTheme, find_palette, load_fonts, style_application
from app.screen.window.main_window import MainWindow
from core.message import CodedError, Message

if TYPE_CHECKING:
    from app.compose.control.control_attachment import MachineAndControl
    from app.screen.opening_show import OpeningShow

_LISTENS_AFTER = 500  # ms; the first picture does not wait for what few starts need
BuildModel = Callable[[], Desk]
_log = logging.getLogger(__name__)
# These signals stop the machine and end the threads, like closing the window.
END_SIGNALS = (signal.SIGINT, signal.SIGTERM)


def run_screen(
    machine: str | None = None,
    program_file: str | None = None,
    offsets_file: str | None = None,
    theme: str = SYSTEM_THEME,
    build_model: BuildModel | None = None,
    *,
    is_kiosk: bool = False,
    opening_show: OpeningShow | None = None,
) -> int:
    """Show the screen until it is closed, and return the exit status.

    - ``machine``: a machine file.
    - ``program_file``: a program to load at the start.
    - ``offsets_file``: an offsets file that replaces the stored offsets.
    - ``theme``: the colors until the settings are read.
    - ``build_model``: function that creates the model. By default, the standard model is built. Its
      exception is raised here after the window has closed.
    - ``is_kiosk``: whether the window fills the screen and cannot be closed by hand.
    - ``opening_show``: a show with its own model, which the window presents first. The machine of the
      screen is started after the show.
    """
    if build_model is None and opening_show is None:
        build_model = _import_builder(machine, offsets_file)
    elif build_model is None:
        build_model = partial(_build_model, machine, offsets_file)
    app = _application(theme)
    # Otherwise Qt would post a quit event that remains after this event loop.
    app.setQuitOnLastWindowClosed(False)
    window = MainWindow(ScreenTheme(find_palette(theme)), app.quit)
    window.is_kiosk = is_kiosk
    window.show_on_screen(app.primaryScreen())
    start = _Startup(window, build_model, program_file, opening_show)
    before, sys.excepthook = sys.excepthook, start.handle_exception
    # Use exit and not quit, because a window may refuse to close, and a shutdown cannot wait.
    handlers = [(number, signal.signal(number, lambda *_: app.exit(0))) for number in END_SIGNALS]
    QTimer.singleShot(0, start.begin)
    status = app.exec()
    sys.excepthook = before
    for number, handler in handlers:
        signal.signal(number, handler)
    window.hide()
    window.deleteLater()
    start.close()
    return status


class _Startup:
    """The steps of the startup that run after the window has been painted for the first time."""

    def __init__(
        self,
        window: MainWindow,
        build: BuildModel,
        program: str | None,
        show: OpeningShow | None = None,
    ) -> None:
        self._window, self._build, self._program, self._show = window, build, program, show
        self._desk: Desk | None = None
        self._starts_with_estop = False  # The operator has pressed the E-stop in the opening show.
        self._trouble: Exception | None = None

    def begin(self) -> None:
        """Begin the opening show, or build the model if there is no show or the show cannot begin."""
        show = self._show
        if show is None:
            self.build_and_show_model()
            return
        try:
            desk = self._desk = show.build_model()
            self._window.show_model(desk)
            show.begin(self._window, self._end_show)
        except Exception as error:  # noqa: BLE001 - an exception in Qt's loop cannot be caught
            self._report_show_error(error, opens_desk=show.opens_desk)
            self._end_show()

    def _report_show_error(self, error: Exception, *, opens_desk: bool) -> None:
        """Log why the show cannot begin, or let ``close`` raise the error if no screen opens.

        An expected error, such as a full disk, is logged in one line without a traceback.
        """
        if not opens_desk:
            self._trouble = error
        elif isinstance(error, CodedError | OSError):
            _log.warning("the opening show cannot begin: %s", error)
        else:
            _log.error("the opening show cannot begin", exc_info=error)

    def _end_show(self) -> None:
        """Close the opening show, and then open the screen or close the window."""
        show, desk = self._show, self._desk
        self._starts_with_estop = desk is not None and desk.station_controls.is_estop_pressed
        self._close_model()
        if show is None or not show.opens_desk or self._is_program_handed_over():
            QApplication.exit(0)
        else:
            self.build_and_show_model()

    def _is_program_handed_over(self) -> bool:
        """Return whether a screen that was started during the show has accepted the program.

        A second screen in the same data folder could not save anything.
        """
        from app.screen.window.running_screen import hand_over_program

        return bool(self._program) and hand_over_program(self._program or "")

    def build_and_show_model(self) -> None:
        """Build the model, and open it.

        An error ends the event loop, and ``close`` then raises the error.
        """
        try:
            desk = self._desk = self._build()
            self._window.show_model(desk)
            warn_about_delayed_stop_keys(desk)
            if self._starts_with_estop:
                desk.station_keys.press_estop()
            load_first_program(desk, self._program)
            self._listen_later()
        except Exception as error:  # noqa: BLE001 - an exception in Qt's loop cannot be caught
            self._trouble = error
            QApplication.exit(1)

    def _listen_later(self) -> None:
        """Start ``_listen`` after the first frames have been drawn.

        The timer is deleted together with the window.
        """
        timer = QTimer(self._window)
        timer.setSingleShot(True)
        timer.timeout.connect(self._listen)
        timer.start(_LISTENS_AFTER)

    def _listen(self) -> None:
        """Start to receive programs that a second instance of TurnDesk passes to this screen."""
        from app.screen.window.file_opening import FileOpener
        from app.screen.window.running_screen import OpenProgramReceiver

        opening = FileOpener(self._window)
        OpenProgramReceiver(opening.open_file, self._window).start_listening()

    def handle_exception(
        self, kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        """Log an exception from Qt's event loop with its traceback, and show it to the operator."""
        _log.error("the screen has failed", exc_info=(kind, error, trace))
        if self._desk is not None:
            self._desk.say(
                Message("SCREEN FAULT (MACHINE OK): {name}: {error}", name=kind.__name__, error=error)
            )

    def close(self) -> None:
        """Stop the machine, end the threads, and raise the startup error if there was one."""
        self._close_model()
        if self._trouble is not None:
            raise self._trouble

    def _close_model(self) -> None:
        """Close the model of the screen, or the opening show with its model."""
        desk, self._desk = self._desk, None
        if desk is not None:
            desk.close()
        show, self._show = self._show, None
        if show is not None:
            show.close()


def _import_builder(machine: str | None, offsets: str | None) -> BuildModel:
    """Start the control in the background, and return the function that builds the model for this control."""
    from app.compose.control.control_attachment import find_or_start_control

    return partial(_build_model, machine, offsets, find_or_start_control(machine))


def _build_model(machine: str | None, offsets: str | None, begun: MachineAndControl | None = None) -> Desk:
    """Return the standard model for the control ``begun``, or for a new control if it is None."""
    from app.compose.screen_desk import build_desk
    from app.compose.stored_offsets import make_offsets_reader

    return build_desk(machine, make_offsets_reader(offsets), begun)


def warn_about_delayed_stop_keys(desk: Desk) -> None:
    """Show on a real machine that stop keys wait for the screen on Wayland.

    A message that is already visible, for example about a changed machine file, has priority.
    """
    is_real = desk.desk_control.station_panel is None
    if is_real and QApplication.platformName() == "wayland" and not desk.prompt_line.message:
        desk.say(tr("WAYLAND: STOP KEYS WAIT WHILE THE SCREEN IS FROZEN. USE X11"))


def _application(theme: str) -> QApplication:
    present = QApplication.instance()
    app = present if isinstance(present, QApplication) else QApplication(sys.argv[:1])
    app.setApplicationName("TurnDesk")
    # Desktops use this name to find the application's name and icon, also under Wayland.
    app.setDesktopFileName("turndesk")
    load_fonts()
    accessible.register_accessibility()
    style_application(find_palette(theme))
    return app
