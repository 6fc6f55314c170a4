"""The path of the text under hand, done up to the line of the cursor, with what that line draws marked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.look import Look
from app.screen.path.aspects import Tip
from app.screen.pathview import PathView

if TYPE_CHECKING:
    from app.desk.picture import Picture
    from app.screen.path.pane import Pane
    from app.screen.path.sight import Place


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
