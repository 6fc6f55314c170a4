"""The panel of an optional feature in the place of the editor's text; without a feature it is never shown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from PySide6.QtWidgets import QWidget

from app.desk.pages.editor_panel import PanelModel
from app.screen.page_base import Host, Page


class HeadKey(NamedTuple):
    """A place over the text that opens the panel: its text, and the name of the key that does the same."""

    label: str
    name: str


class EditorPanel(QWidget):
    """Nothing; a feature registers its subclass as ``Extra.editor_panel``.

    ``KEYS`` are the names of the keys that open it, from ``app.screen.keys``.
    """

    KEYS: Sequence[str] = ()
    model: PanelModel

    def __init__(self, host: Host, page: Page) -> None:  # noqa: ARG002
        super().__init__(page)
        self.model = PanelModel()
        self.hide()

    def head_keys(self, name: str) -> Sequence[HeadKey]:  # noqa: ARG002
        """Return the places over the text of a program of this name, from the right to the left."""
        return ()

    def open_at(self, key: str, name: str, text: str, line: int) -> str:  # noqa: ARG002
        """Open the panel for this text; the cursor stands on ``line``, from 1. Return why not, else nothing.

        ``key`` is the name of the key that was pressed; empty: a program is to be made of a file.
        """
        return ""

    def refresh(self) -> None:
        """Show what the model says now; called once a frame."""
