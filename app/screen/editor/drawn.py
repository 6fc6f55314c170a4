"""The path of the text under hand, done up to the line of the cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.screen.path.aspects import Tip
from app.screen.pathview import PathView

if TYPE_CHECKING:
    from app.screen.path.pane import Pane, Place


class EditedPath(PathView):
    """Keeps what is looked at while the text is typed, unless nobody has zoomed or panned."""

    title = "PATH TO THE CURSOR"
    keeps = True

    @property
    def tip(self) -> Tip:
        """Where the line of the cursor ends."""
        return self._tip

    def follow(self, line: int) -> None:
        """The tip to the end of a source line, or of the nearest one before it that moves."""
        picture = self.picture
        if picture is None or not len(picture.z):
            return
        block = picture.block_of_line(line)
        at = max(0, picture.points_done(block) - 1)
        self.show_tip(Tip(block, float(picture.z[at]), float(picture.x[at])))

    def _place_in(self, pane: Pane) -> Place:
        return pane.end_of(self._tip.block)
