"""Interface between the editor and a panel of an optional feature that writes program lines by forms."""

from __future__ import annotations

from pathlib import Path

from app.desk.pages.table_content import FunctionKey


class PanelModel:
    """A panel that does nothing, for an editor without such a feature. A feature overrides all members.

    ``text`` is the program with the lines that the panel writes. ``text_number`` counts the texts to prove.
    ``write_count`` counts the texts that replace the editor's text; the cursor then moves to line
    ``cursor_line``.
    """

    text: str = ""
    text_number: int = 0
    write_count: int = 0
    cursor_line: int = 0

    @property
    def path_line(self) -> int:
        """The line, counted from 1, up to which the path is drawn."""
        return 0

    @property
    def is_list_shown(self) -> bool:
        """Whether the page can be left without losing input."""
        return True

    def open_file(self, file: Path) -> None:
        """Open the form that makes a program from this file."""

    def poll(self) -> None:
        """Accept the results of the workers; called once a frame."""

    def function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys."""
        return {}

    def prompt_text(self) -> str:
        """Return the text for the prompt line."""
        return ""

    def handle_key(self, key: str) -> bool:  # noqa: ARG002
        """Handle a key. Return False if the key has no meaning here."""
        return False

    def accepts_key(self, key: str) -> bool:  # noqa: ARG002
        """Return whether this character is text input for the panel."""
        return False

    def handle_escape(self) -> bool:
        """Cancel the last step. Return False if there is nothing left to cancel."""
        return False
