"""What is shown of programs' paths, side by side: pictures, the way back into one, the tip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.screen.look import Look
from app.screen.panel import Panel
from app.screen.path.aspects import Aspect, Tip

if TYPE_CHECKING:
    from app.desk.drawing.approach import Leg
    from app.desk.picture import Picture
    from app.screen.path.pane import Pane
    from app.screen.path.panes import Panes
    from app.screen.path.plot import Frame
    from app.screen.path.sight import Place

COLUMN = 6.4  # units at the right of a view that are the buttons'


class PathBoard(Panel):
    """Panes side by side, each with its own zoom. Nothing here computes but where things stand on the screen;
    numpy comes with the first picture.
    """

    keeps = False  # whether what is looked at by hand stays when the picture changes

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.legs: tuple[Leg, ...] = ()
        self._set: Panes | None = None
        self._tip: Tip | None = None  # not drawn before somebody tells it

    def renewed(self, panes: Sequence[Pane]) -> None:
        """Other pictures are in the panes."""

    @property
    def panes(self) -> Sequence[Pane]:
        """What is side by side now."""
        return self._set.now if self._set is not None else ()

    @property
    def view(self) -> Frame | None:
        """What is looked at in the first pane."""
        return self.panes[0].frame if self.panes else None

    @property
    def several(self) -> bool:
        """Whether there is another choice of panes."""
        return self._set is not None and self._set.several

    @property
    def comparing(self) -> bool:
        """Whether two pictures are shown."""
        return self._set is not None and self._set.before is not None

    @property
    def picture(self) -> Picture | None:
        """What is shown."""
        return self._set.picture if self._set is not None else None

    @property
    def drawn(self) -> bool:
        """Whether there is anything to look at."""
        return self.picture is not None and len(self.picture.z) > 0

    @property
    def in_mm(self) -> bool:
        """The unit of the program."""
        return self.picture is not None and self.picture.metric

    # --- what is shown -------------------------------------------------------------------------------

    def show_picture(self, picture: Picture | None) -> None:
        """Another program's path, or none."""
        self._show(picture, None)

    def show_compared(self, before: Picture | None, after: Picture | None) -> None:
        """One program before and after a change, both on one view with a legend; no tip, nothing done.

        With ``after`` None there is nothing to show, with ``before`` None ``after`` is shown alone.
        """
        self._show(after, before)

    def show_approach(self, legs: Sequence[Leg] | None) -> None:
        """The way back into the program, over its path; the first leg is where the tool stands."""
        if tuple(legs or ()) != self.legs:
            self.legs = tuple(legs or ())
            self._include()
            self.update()

    def show_tip(self, tip: Tip) -> None:
        """Where the run is now."""
        if tip != self._tip:
            self._tip = tip
            self._stand()
            self.update()

    def mark(self, blocks: list[tuple[int, int]]) -> None:
        """Draw blocks thick: ranges of numbers from 1, the last one in them."""
        for pane in self.panes:
            pane.mark(blocks)
        self.update()

    def advance(self) -> None:
        """Once a frame: draw on what is not drawn yet, for a few milliseconds at most."""
        if self._set is not None and self._set.advance():
            self.update()

    def _show(self, picture: Picture | None, before: Picture | None) -> None:
        from app.screen.path.panes import Panes

        if self._set is None:
            self._set = Panes(self.look, self.keeps)
        if picture is self._set.picture and before is self._set.before:
            return
        if self._tip is not None:
            self._tip = self._tip._replace(block=0)
        self._set.show(picture, before)
        self.renewed(self._set.now)
        self._lay_out()

    def _lay_out(self) -> None:
        if self._set is not None:
            self._include()
            self._set.lay(self.room().adjusted(0, 0, -COLUMN * self.look.u, 0))
            self._stand()
        self.update()

    def _include(self) -> None:
        """The way back is seen whole."""
        for pane in self.panes:
            if pane.aspect is Aspect.PATH:
                pane.include([(leg.z, leg.x) for leg in self.legs])

    def _stand(self) -> None:
        if self._tip is not None:
            for pane in self.panes:
                pane.stand(self._tip.block, self._place_in(pane, self._tip), self._tip.stood)

    def _place_in(self, pane: Pane, tip: Tip) -> Place | None:
        """Where the tip is seen in a pane."""
        return pane.place_of(tip)

    def fit(self) -> None:
        """The whole part, in every pane."""
        for pane in self.panes:
            pane.fit()
        self.update()

    def restart(self) -> None:
        """The same again, in other colours."""
        for pane in self.panes:
            pane.restart()
        self.update()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Another size: the whole part again."""
        self._lay_out()

    def room(self) -> QRectF:
        """The view within its frame; the panes share what the column of buttons leaves of it."""
        u = self.look.u
        return self.area().adjusted(0.2 * u, 1.2 * u, -0.2 * u, -0.2 * u).toRect().toRectF()
