"""Window part of the tour, which presses keys for the director and ends the tour at the operator's input."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from functools import partial
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QInputEvent, QKeyEvent
from PySide6.QtWidgets import QApplication

from app.desk.command_errors import convert_to_command_error
from app.desk.desk import Desk
from app.extras.tour.tour_director import TourDirector
from app.extras.tour.tour_setup import build_tour_desk, save_tour_shown, use_tour_folder
from app.path.path_aspects import PathViewKind
from app.programs.atomic_files import FileOperationError
from app.screen.window.key_table import find_key_code
from app.screen.window.main_window import MainWindow
from core.extras.tour.tour_script import PALMS_DOWN, PALMS_UP, SOLID_VIEW
from core.store.store_errors import StoreError

ADVANCE_INTERVAL_MS = 50  # Milliseconds between two calls of the director.
INPUT_DELAY_MS = 300  # Milliseconds after which input acts on the next screen, which has then been drawn.
_NO_MODIFIER = Qt.KeyboardModifier.NoModifier
_NAMED_KEYS: Mapping[str, tuple[Qt.Key, str]] = {
    **{f"F{number}": (Qt.Key(Qt.Key.Key_F1 + number - 1), "") for number in range(1, 13)},
    "Enter": (Qt.Key.Key_Return, "\r"),
    "Esc": (Qt.Key.Key_Escape, "\x1b"),
}
_PALM_KEYS = ("F11", "F12")
_PRESS_EVENTS = frozenset(
    {QEvent.Type.KeyPress, QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick}
    | {QEvent.Type.TouchBegin, QEvent.Type.TabletPress}
)
# Events that follow a press and would be handled without it.
_FOLLOWING_EVENTS = frozenset(
    {QEvent.Type.ShortcutOverride, QEvent.Type.Shortcut, QEvent.Type.Wheel}
    | {QEvent.Type.TouchUpdate, QEvent.Type.TouchEnd, QEvent.Type.ContextMenu}
)
_RESET_KEY = Qt.Key.Key_R
_SOLID_VIEWS_TRIED = 8


class WindowKeyboard:
    """Keyboard of the simulated operator, which sends key events to the main window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.is_pressing = False  # A key of the tour is being sent, not a key of the operator.

    def press_key(self, key: str) -> None:
        """Press and release a key of the tour. Palm buttons remain pressed until ``PALMS_UP``."""
        if key in {PALMS_DOWN, PALMS_UP}:
            kind = QEvent.Type.KeyPress if key == PALMS_DOWN else QEvent.Type.KeyRelease
            for name in _PALM_KEYS:
                self._send(kind, name)
        elif key == SOLID_VIEW:
            self._select_solid_view()
        else:
            self._send(QEvent.Type.KeyPress, key)
            self._send(QEvent.Type.KeyRelease, key)

    def _send(self, kind: QEvent.Type, name: str) -> None:
        key, text = _NAMED_KEYS.get(name) or (Qt.Key(ord(name.upper())), name.lower())
        self.is_pressing = True
        try:
            QCoreApplication.sendEvent(self._window, QKeyEvent(kind, key, _NO_MODIFIER, text))
        finally:
            self.is_pressing = False

    def _select_solid_view(self) -> None:
        frame = self._window.frame
        for _ in range(_SOLID_VIEWS_TRIED if frame is not None else 0):
            assert frame is not None
            if any(pane.aspect is PathViewKind.SOLID for pane in frame.automatic_page.path_view.panes):
                return
            self._window.press_key("View")


class TourInputFilter(QObject):
    """Application event filter that ends the tour at the first key press, click or touch.

    Stop keys and stop controls are passed on, so that they stop the machine as always. All other input has
    no effect until the tour has ended and the next screen has been drawn.
    """

    def __init__(self, window: MainWindow, keyboard: WindowKeyboard, stop: Callable[[], None]) -> None:
        super().__init__(window)
        self._window, self._keyboard, self._stop = window, keyboard, stop
        self.was_closed = False  # The operator has closed the window.
        self.has_tour_ended = False  # The window can then be closed.

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Return whether the event must not be passed on."""
        if self._keyboard.is_pressing:
            return False
        kind = event.type()
        if kind == QEvent.Type.Close and watched is self._window:
            if self.has_tour_ended:
                return False
            event.ignore()
            self.was_closed = True
            self._stop()
            return True
        if kind not in _PRESS_EVENTS:
            return kind in _FOLLOWING_EVENTS
        is_stop = isinstance(event, QInputEvent) and self._stops_machine(event)
        event.setAccepted(True)  # Otherwise Qt sends a touch again as a mouse event.
        self._stop()
        return not is_stop

    def _stops_machine(self, event: QInputEvent) -> bool:
        """Return whether a press is one of the keys or controls that stop the machine."""
        if not isinstance(event, QKeyEvent):
            return self._window.is_stop_control_at(event)
        keyboard = self._window.keyboard_filter
        return keyboard.is_stop_key(event) or find_key_code(event) == _RESET_KEY


class Tour:
    """Tour in the main window, with its own machine, store and programs.

    ``opens_desk`` is whether the operator screen opens at the end of the tour.
    """

    def __init__(self, own_folder: Path, *, opens_desk: bool) -> None:
        self.opens_desk = opens_desk
        self._own_folder = own_folder
        self._cleanup = ExitStack()

    def build_model(self) -> Desk:
        """Return the model of the tour. Raises CommandError if its folder cannot be written."""
        with convert_to_command_error(OSError, StoreError, FileOperationError):
            self._cleanup.enter_context(use_tour_folder())
        return build_tour_desk()

    def begin(self, window: MainWindow, on_end: Callable[[], None]) -> None:
        """Begin the first step. ``on_end`` is called from the event loop after the tour has ended.

        Raises CommandError if the program of the tour cannot be read.
        """
        application = QApplication.instance()
        assert window.frame is not None
        assert application is not None
        keyboard, timer = WindowKeyboard(window), QTimer(window)

        def end() -> None:
            timer.stop()
            input_filter.has_tour_ended = True
            self.opens_desk = self.opens_desk and not input_filter.was_closed
            QTimer.singleShot(0, window, open_next_screen)

        def open_next_screen() -> None:
            on_end()
            remove_filter = partial(application.removeEventFilter, input_filter)
            QTimer.singleShot(INPUT_DELAY_MS, window, remove_filter)

        with convert_to_command_error(OSError):
            director = TourDirector(window.frame.desk, keyboard, end)
        input_filter = TourInputFilter(window, keyboard, director.stop)
        window.frame.desk.page_registry.set_guidance_card(director)
        application.installEventFilter(input_filter)
        timer.timeout.connect(director.advance)
        timer.start(ADVANCE_INTERVAL_MS)
        self._cleanup.callback(save_tour_shown, self._own_folder)

    def close(self) -> None:
        """Save in the operator's data folder that the tour was shown, and delete the data of the tour."""
        self._cleanup.close()
