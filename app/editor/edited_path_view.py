"""The path of the text under hand, done up to the line of the cursor, with what that line draws marked."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key
from app.desk.translation import tr
from app.path.path_aspects import Tip
from app.path.path_view import PathView
from app.screen.look import Look

if TYPE_CHECKING:
    from app.path.part_player import PartPlayer
    from app.path.path_pane_view import Pane, Place
    from app.path.path_picture import Picture


class EditedPath(PathView):
    """Keeps what is looked at while the text is typed, unless nobody has zoomed or panned.

    ``go_to`` is told the source line of what is touched.
    """

    title = "PATH TO THE CURSOR"
    keeps = True

    def __init__(
        self, look: Look, go_to: Callable[[int], None], parent: QWidget, player: PartPlayer | None = None
    ) -> None:
        super().__init__(look, parent, self._picked_block, player)
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
        if not block and self.player is not None:
            self.player.want(0.0)  # before the first move
        at = max(0, picture.points_done(block) - 1)
        self.show_tip(Tip(block, float(picture.z[at]), float(picture.x[at])))
        self.mark(picture.blocks_of_line(line))

    def line_here(self) -> str:
        """To the source line of what the cross stands on; answers a sentence where it stands on none."""
        block = self.ruler.block() if self.ruler is not None else 0
        if not block:
            return tr("CROSSHAIR NOT ON THE PATH. PRESS AN ARROW KEY TO MOVE IT")
        self._picked_block(block)
        return ""

    def keys(self) -> dict[int, Key]:
        """The function keys while the keyboard is in the path."""
        return {
            2: Key("FEED HOLD", self._hold),
            4: Key("VIEW", self.next_view),
            5: Key("FIT", self.fit),
            6: Key("ZOOM IN", partial(self.zoom, 1)),
            7: Key("ZOOM OUT", partial(self.zoom, -1)),
        }

    def _hold(self) -> None:
        """Measure from where the cross stands."""
        if self.ruler is not None:
            self.ruler.hold()
            self.update()

    def _picked_block(self, block: int) -> None:
        line = self.picture.line_of_block(block) if self.picture is not None else 0
        if line:
            self._go_to(line)

    def _place_in(self, pane: Pane, tip: Tip) -> Place | None:
        return pane.end_of(tip.block)
