"""Interface of a show that the window presents before the operator screen, such as the tour."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from app.screen.window.main_window import MainWindow


class OpeningShow(Protocol):
    """Show with its own model, after which the operator screen opens in the same window.

    If ``opens_desk`` is False at the end of the show, the window closes instead.
    """

    opens_desk: bool

    def build_model(self) -> Desk:
        """Return the model that the show uses. Raises CommandError if the show cannot begin."""
        ...

    def begin(self, window: MainWindow, on_end: Callable[[], None]) -> None:
        """Begin the show after the window has shown its model. ``on_end`` is called once at the end."""
        ...

    def close(self) -> None:
        """Delete the data of the show after its model was closed."""
        ...
