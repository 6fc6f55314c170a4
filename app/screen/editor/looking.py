"""The keyboard in the path beside the text: to measure there, and to find the line of what is drawn."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from app.desk.drawing.spots import measuring_words
from app.desk.editing import words
from app.screen.editor.doings import Mode
from app.screen.pages import Doings

if TYPE_CHECKING:
    from app.screen.editor.page import EditorPage


class Looking:
    """What the page does while the keyboard is in its path."""

    def __init__(self, page: EditorPage) -> None:
        self._page = page

    def begin(self) -> None:
        """The keyboard to the path, if there is any."""
        if self._page.path.drawn:
            self._page.enter(Mode.LOOK)
        else:
            self._page.editor.notice = words.NO_PATH

    def hold(self) -> None:
        """Measure from where the cross stands."""
        ruler = self._page.path.ruler
        if ruler is not None:
            ruler.hold()
            self._page.path.update()

    def to_line(self) -> None:
        """The cursor to the line whose path the cross stands on."""
        self._page.editor.notice = self._page.path.line_here()

    def doings(self) -> Doings:
        """Keys of the Automatic page that mean the same here."""
        path = self._page.path
        return {
            "Zoom in": partial(path.zoom, 1),
            "Zoom out": partial(path.zoom, -1),
            "Measure": self._page.back,
            "View": path.next_view,
        }

    def prompt(self) -> str:
        """What the keys do."""
        return measuring_words()

    def refresh(self) -> None:
        """Once a frame: measuring that has ended gives the keyboard back to the text."""
        if self._page.mode is Mode.LOOK and self._page.path.ruler is None:
            self._page.back()
