"""State of the main window that affects starts and prompts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.late_presses import LatePressFilter


@dataclass(slots=True)
class WindowState:
    """State of the main window that affects starts and prompts.

    Without a window, the current page does not prevent a start. ``late_presses`` drops key presses that
    would start an action after a stall of the screen.
    """

    late_presses: LatePressFilter
    page_name: str = ""  # Name of the current page; empty without a window.
    is_kiosk: bool = False  # The window fills the screen and cannot be closed.
    _starts_here: bool = True
    _keyboard_away: bool = False
    _has_field: Callable[[], bool] = bool
    _is_stop_held: Callable[[], bool] = bool
    _press_age: Callable[[], float] = float
    _wake: Callable[[], None] = lambda: None

    # --- set by the window ---------------------------------------------------------------------------

    def connect_window(
        self,
        wake_window: Callable[[], None],
        is_stop_held: Callable[[], bool],
        find_press_age: Callable[[], float],
    ) -> None:
        """Connect the functions of a new window, which replace the functions of the previous window."""
        self._wake, self._is_stop_held, self._press_age = wake_window, is_stop_held, find_press_age

    def set_page_properties(
        self, *, can_start: bool, has_field: Callable[[], bool] = bool, page_name: str = ""
    ) -> None:
        """Set the name and the properties of the current page.

        ``can_start`` is True if cycles can be started from this page. ``has_field`` returns whether the
        page has a text field that accepts letters.
        """
        self.page_name, self._starts_here, self._has_field = page_name, can_start, has_field

    def set_keyboard_lost(self, is_lost: bool) -> None:
        """Set whether another window has the keyboard focus, so that TurnDesk receives no keys."""
        self._keyboard_away = is_lost

    # --- read by the model ---------------------------------------------------------------------------

    @property
    def can_start_here(self) -> bool:
        """Return whether cycles can be started from the current page."""
        return self._starts_here

    @property
    def is_keyboard_lost(self) -> bool:
        """Return whether another window has the keyboard focus."""
        return self._keyboard_away

    def has_text_field(self) -> bool:
        """Return whether a text field of the current page accepts letters."""
        return self._has_field()

    def is_stop_key_held(self) -> bool:
        """Return whether a key that stops the machine is held down."""
        return self._is_stop_held()

    def find_press_age_s(self) -> float:
        """Return the time in seconds since the key press that is being processed."""
        return self._press_age()

    def wake_window(self) -> None:
        """Make the window read a machine state that has changed while the machine was at rest.

        Any thread may call this method.
        """
        self._wake()
