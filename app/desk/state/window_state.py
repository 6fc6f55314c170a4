"""The part of the window's state on which starts and prompts depend."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.late_presses import LatePresses


@dataclass(slots=True)
class WindowState:
    """State of the window in front of the desk. Without a window, cycles can be started from anywhere.

    ``late`` drops presses that would start something after a stall of the screen.
    """

    late: LatePresses
    _starts_here: bool = True
    _keyboard_away: bool = False
    _has_field: Callable[[], bool] = bool
    _is_stop_held: Callable[[], bool] = bool
    _press_age: Callable[[], float] = float
    _wake: Callable[[], None] = lambda: None

    # --- set by the window ---------------------------------------------------------------------------

    def connect(
        self, wake: Callable[[], None], is_stop_held: Callable[[], bool], press_age: Callable[[], float]
    ) -> None:
        """Use this window; it replaces an earlier one."""
        self._wake, self._is_stop_held, self._press_age = wake, is_stop_held, press_age

    def show_page(self, *, starts: bool, has_field: Callable[[], bool] = bool) -> None:
        """Note which page is in front: whether cycles start there, and whether a field takes the letters."""
        self._starts_here, self._has_field = starts, has_field

    def set_keyboard_away(self, away: bool) -> None:
        """Note whether another window has the keyboard, so that no key reaches this one."""
        self._keyboard_away = away

    # --- read by the desk ----------------------------------------------------------------------------

    @property
    def starts_here(self) -> bool:
        """Whether cycles are started from the page in front."""
        return self._starts_here

    @property
    def keyboard_away(self) -> bool:
        """Whether another window has the keyboard."""
        return self._keyboard_away

    def has_field(self) -> bool:
        """Return whether a field of the page in front takes the letters."""
        return self._has_field()

    def is_stop_held(self) -> bool:
        """Return whether a key that stops the machine is held down."""
        return self._is_stop_held()

    def press_age(self) -> float:
        """Return the time in seconds since the press that is handled now."""
        return self._press_age()

    def wake(self) -> None:
        """Have the window poll a machine at rest that has changed. Any thread may call this."""
        self._wake()
