"""Interface between the editor and an optional panel that writes program lines with forms."""

from __future__ import annotations

from pathlib import Path

from app.desk.pages.table_content import FunctionKey


class EditorPanelModel:
    """Interface of the editor's optional panel. The default members have no effect.

    The feature that provides a panel overrides all members.

    - ``text`` is the program with the lines that the panel writes.
    - ``text_number`` increases with each new text that must be proved.
    - ``write_count`` increases with each text that replaces the editor's text.
    - ``cursor_line`` is the line to which the cursor moves after each replacement.
    """

    text: str = ""
    text_number: int = 0
    write_count: int = 0
    cursor_line: int = 0

    @property
    def path_end_line(self) -> int:
        """Return the program line, counted from 1, up to which the tool path is drawn."""
        return 0

    @property
    def is_list_shown(self) -> bool:
        """Return whether the panel shows a list instead of a form.

        Leaving the page loses no input while the list is shown.
        """
        return True

    def open_file(self, file: Path) -> None:
        """Open the form that makes a program from this file."""

    def process_results(self) -> None:
        """Process the results of the panel's background work. The editor calls this method once per frame."""

    def make_function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys of the panel by number."""
        return {}

    def prompt_text(self) -> str:
        """Return the text for the prompt line."""
        return ""

    def handle_key(self, key: str) -> bool:  # noqa: ARG002
        """Handle a key, and return False if the panel does not use the key."""
        return False

    def accepts_key(self, key: str) -> bool:  # noqa: ARG002
        """Return whether the panel accepts this character as text input."""
        return False

    def handle_escape(self) -> bool:
        """Cancel the last step, and return False if no step can be canceled."""
        return False
