"""What a panel of an optional feature says to the editor, in which it writes lines by forms."""

from __future__ import annotations

from pathlib import Path

from app.desk.pages.sheet import Key


class PanelModel:
    """Nothing, as the editor has it without such a feature; a feature overrides all of it.

    ``text`` is the program with what the panel writes. ``number`` counts the texts that are worth proving.
    ``written`` counts those that are to stand in the field; the cursor then goes to line ``at``.
    """

    text: str = ""
    number: int = 0
    written: int = 0
    at: int = 0

    @property
    def line(self) -> int:
        """The line, from 1, up to which the path is shown."""
        return 0

    @property
    def listing(self) -> bool:
        """Whether nothing is lost when the page is left."""
        return True

    def open_file(self, file: Path) -> None:
        """Open the form that makes a program of this file."""

    def look(self) -> None:
        """Take up what the workers have found; called once a frame."""

    def keys(self) -> dict[int, Key]:
        """Return the function keys."""
        return {}

    def prompt(self) -> str:
        """Return what the prompt line says."""
        return ""

    def typed(self, key: str) -> bool:  # noqa: ARG002
        """Take a key; False when it means nothing here."""
        return False

    def takes(self, key: str) -> bool:  # noqa: ARG002
        """Return whether a character is text here."""
        return False

    def escape(self) -> bool:
        """Take something back; False when nothing is left to take back."""
        return False
