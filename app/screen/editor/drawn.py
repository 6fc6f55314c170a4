"""The path of the text under hand, done up to the line of the cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.screen.pathview import PathView, Tip

if TYPE_CHECKING:
    from PySide6.QtCore import QPointF

    from app.desk.picture import Picture


class EditedPath(PathView):
    """Keeps what is looked at while the text is typed, unless nobody has zoomed or panned."""

    title = "PATH TO THE CURSOR"
    _by_hand = False

    @property
    def tip(self) -> Tip:
        """Where the line of the cursor ends."""
        return self._tip

    def show_picture(self, picture: Picture | None) -> None:
        """The path as it is after the last key."""
        if picture is self._picture:
            return
        self._picture = picture
        if self._by_hand and picture is not None and self._frame is not None:
            self._tip = Tip()
            self._show_frame(self._frame)
        else:
            self.fit()

    def follow(self, line: int, metric: bool) -> None:
        """The tip to the end of a source line, or of the nearest one before it that moves."""
        picture = self._picture
        if picture is None or not len(picture.z):
            return
        block = picture.block_of_line(line)
        at = max(0, picture.points_done(block) - 1)
        self.show_tip(Tip(block, float(picture.z[at]), float(picture.x[at]), metric))

    def fit(self) -> None:
        """The whole part, and from now on whatever it becomes."""
        self._by_hand = False
        super().fit()

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Nearer or farther; this is kept."""
        self._by_hand = True
        super().zoom(steps, at)

    def pan(self, across: int, down: int) -> None:
        """Look elsewhere; this is kept."""
        self._by_hand = True
        super().pan(across, down)
