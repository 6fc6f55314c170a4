"""The path of the text under hand, done up to the line of the cursor, with what that line draws marked."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.editor import messages
from app.editor.editor_keys_view import Mode
from app.path.measuring import measuring_words
from app.path.path_aspects import Tip
from app.path.path_view import PathView
from app.screen.look import Look
from app.screen.page_base import Doings

if TYPE_CHECKING:
    from app.editor.editor_view import EditorPage
    from app.path.path_pane_view import Pane, Place
    from app.path.path_picture import Picture


class EditedPath(PathView):
    """Keeps what is looked at while the text is typed, unless nobody has zoomed or panned.

    ``go_to`` is told the source line of what is touched.
    """

    title = "PATH TO THE CURSOR"
    keeps = True

    def __init__(self, look: Look, go_to: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent, self._picked_block)
        self._go_to = go_to
        self._followed: tuple[Picture | None, int] = (None, 0)

    @property
    def tip(self) -> Tip:
        """Where the line of the cursor ends."""
        return self._tip or Tip()

    def follow(self, line: int) -> None:
        """The tip to the end of a source line, or of the nearest one before it that moves."""
        picture = self.picture
        if picture is None or not len(picture.z) or (picture, line) == self._followed:
            return
        self._followed = (picture, line)
        block = picture.block_of_line(line)
        at = max(0, picture.points_done(block) - 1)
        self.show_tip(Tip(block, float(picture.z[at]), float(picture.x[at])))
        self.mark(picture.blocks_of_line(line))

    def line_here(self) -> str:
        """To the source line of what the cross stands on; answers a sentence where it stands on none."""
        block = self.ruler.block() if self.ruler is not None else 0
        if not block:
            return tr("THE CROSS STANDS ON NO LINE OF THE PATH: AN ARROW TAKES IT TO ONE")
        self._picked_block(block)
        return ""

    def _picked_block(self, block: int) -> None:
        line = self.picture.line_of_block(block) if self.picture is not None else 0
        if line:
            self._go_to(line)

    def _place_in(self, pane: Pane, tip: Tip) -> Place | None:
        return pane.end_of(tip.block)


# --- The keyboard in the path beside the text: to measure there, and to find the line of what is drawn.


class Looking:
    """What the page does while the keyboard is in its path."""

    def __init__(self, page: EditorPage) -> None:
        self._page = page

    def begin(self) -> None:
        """The keyboard to the path, if there is any."""
        if self._page.path.drawn:
            self._page.enter(Mode.LOOK)
        else:
            self._page.editor.notice = messages.NO_PATH

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
