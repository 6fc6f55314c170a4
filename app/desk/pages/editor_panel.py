"""Interface between the editor and a panel of an optional feature that writes program lines by forms."""

from __future__ import annotations

from pathlib import Path

from app.desk.pages.sheet import Key


class PanelModel:
    """A panel that does nothing, for an editor without such a feature. A feature overrides all members.

    ``text`` is the program with the lines that the panel writes. ``number`` counts the texts to prove.
    ``written`` counts the texts that replace the editor's text; the cursor then moves to line ``at``.
    """

    text: str = ""
    number: int = 0
    written: int = 0
    at: int = 0

    @property
    def line(self) -> int:
        """The line, counted from 1, up to which the path is drawn."""
        return 0

    @property
    def listing(self) -> bool:
        """Whether the page can be left without losing input."""
        return True

    def open_file(self, file: Path) -> None:
        """Open the form that makes a program from this file."""

    def look(self) -> None:
        """Accept the results of the workers; called once a frame."""

    def keys(self) -> dict[int, Key]:
        """Return the function keys."""
        return {}

    def prompt(self) -> str:
        """Return the text for the prompt line."""
        return ""

    def typed(self, key: str) -> bool:  # noqa: ARG002
        """Handle a key. Return False if the key has no meaning here."""
        return False

    def takes(self, key: str) -> bool:  # noqa: ARG002
        """Return whether this character is text input for the panel."""
        return False

    def escape(self) -> bool:
        """Cancel the last step. Return False if there is nothing left to cancel."""
        return False
