"""Path of a program as shown on the run, editor, list and offset pages.

The view from above has X+ down and Z+ to the right, with both sides of X0. Cuts with C locked are shown next
to it, on the face or the unrolled side of the part. Set the content with ``show_picture`` or
``show_compared``, set the machine position with ``show_tip``, and call ``advance`` once per frame. This
module calculates only screen positions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.path.path_aspects import IN_SPACE, OF_PART, Aspect, DrawnLeg, Tip
from app.path.path_pointer_view import Pointer
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel, Press

if TYPE_CHECKING:
    from app.path import path_marks_view as marks
    from app.path.measuring_view import Measure
    from app.path.part_bar_view import PartBar
    from app.path.part_player import PartPlayer
    from app.path.path_pane_view import Pane, Panes, Place
    from app.path.path_picture import Picture
    from app.path.path_projection import Projection
    from app.path.polyline import Polyline
    from app.screen.page_base import KeyActions

BAR = 6.8  # units: height of the time line below the part
FOOT = 2.4  # units: height of the row with the legend and the scales below the panes
Picked = Callable[[int], None]


class PathView(Panel):
    """Panes side by side, each with its own zoom. Keys act on the first pane, touches on the touched pane.

    ``picked`` is called with the number of the touched block, counted from 1. While measuring, the view has
    the keyboard focus and passes unused keys to the window.
    """

    part_name = "PATH"
    title = "PATH"
    keeps = False  # whether adjusted projections remain when the picture changes
    shows_whole_approach = False  # whether the visible area includes all legs of an approach

    def __init__(
        self,
        look: Look,
        parent: QWidget | None = None,
        picked: Picked | None = None,
        player: PartPlayer | None = None,
    ) -> None:
        super().__init__(look, parent)
        self._picked = picked
        self.player = player  # player of the part; without a player, the part is not shown
        # opens the entry of the stock; None if it cannot be opened from this view
        self.stock: Press | None = None
        self._bar: PartBar | None = None  # the time line, created when the part is first shown
        self._set: Panes | None = None  # created with the first picture
        self._tip: Tip | None = None  # not drawn until the first position is set
        self.legs: tuple[DrawnLeg, ...] = ()  # legs of an approach
        self.ruler: Measure | None = None  # None while the user does not measure
        self._pointer = Pointer(look, self._pressed, self._hovers, self._dragged, self._touched, self.magnify)
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    @property
    def panes(self) -> Sequence[Pane]:
        """Visible panes, from left to right."""
        return self._set.now if self._set is not None else ()

    @property
    def view(self) -> Projection | None:
        """Projection of the first pane, or None without a pane."""
        return self.panes[0].projection if self.panes else None

    @property
    def several(self) -> bool:
        """Whether more than one view exists."""
        return self._set is not None and self._set.several

    @property
    def comparing(self) -> bool:
        """Whether two pictures are compared."""
        return self._set is not None and self._set.before is not None

    @property
    def picture(self) -> Picture | None:
        """Displayed picture, or None if nothing is displayed."""
        return self._set.picture if self._set is not None else None

    @property
    def shows_part(self) -> bool:
        """Whether a view of the part is displayed."""
        return any(pane.aspect in OF_PART for pane in self.panes)

    @property
    def drawn(self) -> bool:
        """Whether the picture contains any path."""
        return self.picture is not None and len(self.picture.z) > 0

    @property
    def in_mm(self) -> bool:
        """Whether the program uses millimeters."""
        return self.picture is not None and self.picture.metric

    # --- content -------------------------------------------------------------------------------------

    def show_picture(self, picture: Picture | None) -> None:
        """Show the path of another program, or no path."""
        self._show(picture, None)

    def show_compared(self, before: Picture | None, after: Picture | None) -> None:
        """Show one program before and after a change in one view with a legend, without tip and progress.

        If ``after`` is None, nothing is shown. If ``before`` is None, only ``after`` is shown.
        """
        self._show(after, before)

    def show_approach(self, legs: Sequence[DrawnLeg] | None) -> None:
        """Show the approach over the path. The first leg is the present tool position."""
        if tuple(legs or ()) != self.legs:
            self.legs = tuple(legs or ())
            self._include()
            self.update()

    def show_tip(self, tip: Tip) -> None:
        """Show the tool tip and the progress of the run."""
        if tip != self._tip:
            self._tip = tip
            self._show_tool()
            self.update()

    def mark(self, blocks: list[tuple[int, int]]) -> None:
        """Draw blocks as thick lines. Each range is (first, last), inclusive, counted from 1."""
        for pane in self.panes:
            pane.mark(blocks)
        self.update()

    def advance(self) -> None:
        """Draw the missing parts for a few milliseconds at most; called once per frame."""
        if self._set is not None and self._set.advance():
            self.update()

    def _show(self, picture: Picture | None, before: Picture | None) -> None:
        from app.path.path_pane_view import Panes

        if self._set is None:
            self._set = Panes(self.keeps, self._make, with_part=self.player is not None)
        if picture is self._set.picture and before is self._set.before:
            return
        if self._tip is not None:
            self._tip = self._tip._replace(block=0)
        if self.player is not None:
            self.player.show(picture if before is None else None)
        self._set.show(picture, before)
        if self.ruler is not None and self.ruler.pane in self.panes:
            self.ruler.renew()  # the measured points remain
        else:
            self.measure(on=False)
        self._lay_out()

    def _make(self, aspect: Aspect, polyline: Polyline, before: Polyline | None) -> Pane:
        if aspect in OF_PART and self.player is not None:
            from app.path.part_pane_view import PartPane, SolidPane

            made = PartPane if aspect is Aspect.SECTION else SolidPane
            return made(self.look, aspect, polyline, self.player)
        from app.path.path_pane_view import Pane

        return Pane(self.look, aspect, polyline, before)

    def _lay_out(self) -> None:
        if self._set is not None:
            self._include()
            from app.path.path_marks_view import button_columns, columns_wide

            room = self.room()
            columns = button_columns(self.look, room, len(self._buttons()))
            self._set.lay(room.adjusted(0, 0, -columns_wide(columns, self.look), 0))
            self._show_tool()
        self.update()

    def _include(self) -> None:
        """Include the whole approach in the visible area, if the view shows it."""
        for pane in self.panes:
            if pane.aspect is Aspect.PATH and self.shows_whole_approach:
                pane.include([(leg.z, leg.x) for leg in self.legs])

    def _show_tool(self) -> None:
        if self._tip is not None:
            for pane in self.panes:
                pane.stand(self._tip.block, self._place_in(pane, self._tip), self._tip.stood)

    def _place_in(self, pane: Pane, tip: Tip) -> Place | None:
        """Return the position of the tip in a pane."""
        return pane.place_of(tip)

    def fit(self) -> None:
        """Show the whole path in every pane."""
        for pane in self.panes:
            pane.fit()
        self.update()

    def restart(self) -> None:
        """Draw the same view again, with new colors."""
        for pane in self.panes:
            pane.restart()
        self.update()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Show the whole path after a change of size."""
        self._lay_out()

    def room(self) -> QRectF:
        """Return the area inside the frame. The panes use the area that the buttons leave free."""
        u = self.look.u
        bar = BAR if self.shows_part else FOOT
        return self.area().adjusted(0.2 * u, 1.2 * u, -0.2 * u, -(0.2 + bar) * u).toRect().toRectF()

    # --- navigation ----------------------------------------------------------------------------------

    def next_view(self) -> None:
        """Switch to the next view if there are several."""
        if self._set is not None and self.several:
            measuring = self.ruler is not None
            self.measure(on=False)
            self._set.next_view()
            self._lay_out()
            self.measure(on=measuring)

    def show_part(self) -> None:
        """Switch to a view of the part if one exists."""
        for _ in range(self._set.choices if self._set is not None else 0):
            if not self.shows_part:
                self.next_view()

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Zoom in (positive steps) or out, around a widget position or the middle."""
        pane = self.pane_at(at)
        if pane is not None:
            pane.zoom(steps, at)
            self.update()

    def magnify(self, factor: float, at: QPointF) -> None:
        """Magnify by a factor around a widget position."""
        pane = self.pane_at(at)
        if pane is not None:
            pane.magnify(factor, at)
            self.update()

    def pan(self, across: int, down: int) -> None:
        """Move the visible area to the right and down by a number of steps."""
        pane = self.pane_at(None)
        if pane is not None:
            pane.pan(across, down)
            self.update()

    def look_keys(self) -> KeyActions:
        """Return the actions of the zoom and pan keys, as on the Automatic page."""
        return {
            "Zoom in": partial(self.zoom, 1),
            "Zoom out": partial(self.zoom, -1),
            "Pan left": partial(self.pan, -1, 0),
            "Pan right": partial(self.pan, 1, 0),
            "Pan up": partial(self.pan, 0, -1),
            "Pan down": partial(self.pan, 0, 1),
        }

    def play_keys(self) -> KeyActions:
        """Return the actions of the time line keys; empty without a player."""
        player = self.player
        if player is None:
            return {}
        return {
            "Play": player.play_or_pause,
            "Play fast": player.faster,
            "Step back": partial(player.step, -1),
            "Step forward": partial(player.step, 1),
        }

    def pane_at(self, at: QPointF | None) -> Pane | None:
        """Return the pane at a position, or else the pane of the measurement, or the first pane."""
        found = self._set.at(at) if self._set is not None and at is not None else None
        if found is None:
            found = self.ruler.pane if self.ruler is not None else next(iter(self.panes), None)
        return found

    # --- measuring and picking -----------------------------------------------------------------------

    def measure(self, *, on: bool | None = None) -> None:
        """Start or stop measuring in the last pane. None toggles."""
        if on is None:
            on = self.ruler is None
        if on and self.drawn and self.view is not None:
            self._measure_in(self.panes[-1])
            self.setFocus()
        elif not on and self.ruler is not None:
            self.ruler.end()
            self.ruler = None
            self.setMouseTracking(False)
            if self.hasFocus():
                self.window().setFocus()
        self.update()

    def _measure_in(self, pane: Pane) -> Measure:
        from app.path.measuring_view import Measure

        ruler = self.ruler = Measure(pane)
        self.setMouseTracking(True)
        return ruler

    def _pressed(self, at: QPointF) -> Pane | PartBar | None:
        """Return the time line or pane at a position, or None if the press was on a button."""
        if self.touch(at):
            return None
        if self._bar is not None and self.shows_part and self._bar.takes(at):
            return self._bar
        return self.pane_at(at)

    def _hovers(self, at: QPointF) -> None:
        if self.ruler is not None and self.ruler.pane.room.contains(at):
            self.ruler.point(at)
            self.update()

    def _dragged(self, held: Pane | PartBar, by: QPointF) -> None:
        held.drag(by)
        self.update()

    def _touched(self, pane: Pane | PartBar, at: QPointF) -> None:
        """Measure from the touched point, or select the block that is drawn there."""
        from app.path.path_pane_view import Pane

        if not isinstance(pane, Pane):
            return
        if pane.aspect in IN_SPACE:
            return
        if self.ruler is not None:
            ruler = self.ruler if self.ruler.pane is pane else self._measure_in(pane)
            ruler.point(at)
            ruler.hold()
            self.update()
        elif self._picked is not None and (block := pane.block_at(at)):
            self._picked(block)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle the keys of measuring, and pass all other keys to the window."""
        if self.ruler is not None and self.ruler.key(event):
            self.update()
        else:
            event.ignore()

    def focusNextPrevChild(self, _next: bool) -> bool:
        """Disable focus changes with Tab, because Tab is a key of measuring."""
        return False

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Stop measuring when another widget gets the focus, but not when another window does."""
        if event.reason() is not Qt.FocusReason.ActiveWindowFocusReason:
            self.measure(on=False)

    def event(self, event: QEvent) -> bool:
        """Handle touch events, and pass all other events to the base class."""
        return self._pointer.takes(event) or super().event(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom around the pointer with the wheel."""
        self.zoom(1 if event.angleDelta().y() > 0 else -1, event.position())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Press a button of the view, or start a drag."""
        self._pointer.press(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the picture during a drag."""
        self._pointer.move(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End a drag, or handle a touch if the pointer did not move."""
        self._pointer.release(event.position())

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: QPainter) -> None:
        """Draw panes, title, buttons and legend, or a sentence without a picture."""
        from app.path import path_marks_view as marks

        look, panes = self.look, self.panes
        if not panes:
            why = tr("Load a program to see its path.")
            marks.draw_nothing(painter, look, self.inside(), why)
            return
        for pane in panes:
            self._draw_pane(painter, pane)
        if (
            self.ruler is not None and self.ruler.pane.aspect not in IN_SPACE
        ):  # The table is drawn in another pane if there is one.
            beside = next((pane for pane in panes if pane is not self.ruler.pane), self.ruler.pane)
            self.ruler.draw_figures(painter, beside.room, self.in_mm)
        self._draw_title(painter)
        marks.draw_buttons(painter, look, self.room(), self._buttons(), self.place)
        if self.shows_part:
            self._draw_bar(painter)
            return
        legend = marks.compared_legend(look) if self.comparing else marks.run_legend(look)
        room = self.room()
        foot = QRectF(room.x(), room.bottom(), room.width(), FOOT * look.u)
        marks.draw_foot(
            painter, look, foot, [(pane.room, pane.projection) for pane in panes], legend, self.in_mm
        )
        apart = panes[0].apart
        if apart is not None:
            marks.draw_words(painter, look, panes[0].room, marks.apart_words(apart, self.in_mm))

    def _draw_bar(self, painter: QPainter) -> None:
        """Draw the time line of the part."""
        from app.path.part_bar_view import PartBar

        assert self.player is not None
        if self._bar is None:
            self._bar = PartBar(self.look, self.player, self.stock)
        room, u = self.room(), self.look.u
        self._bar.draw(painter, QRectF(room.x(), room.bottom(), room.width(), BAR * u), self.place)

    def _draw_pane(self, painter: QPainter, pane: Pane) -> None:
        from app.path import path_marks_view as marks

        look = self.look
        painter.save()
        painter.setClipRect(pane.room)
        painter.translate(pane.room.topLeft())
        if pane.projection is not None:
            pane.draw_path(painter)
            marks.draw_centre_lines(painter, look, pane.aspect, pane.projection, pane.polyline)
            pane.draw_run(painter)
        if self.legs and pane.aspect is Aspect.PATH:
            marks.draw_approach(painter, look, pane, self.legs)
        if self.ruler is not None and self.ruler.pane is pane and pane.aspect not in IN_SPACE:
            self.ruler.draw(painter)
        painter.restore()
        if pane.aspect is not Aspect.PATH:
            ink = "alarm" if pane.aspect in OF_PART and marks.errors_of(pane) else "soft"
            marks.draw_words(painter, look, pane.room, marks.pane_words(pane, self.in_mm), ink)
            if pane is not self.panes[0]:
                marks.draw_border(painter, look, pane.room)

    def _buttons(self) -> list[marks.Button]:
        from app.path.path_marks_view import Button

        found = [
            Button("+", lambda: self.zoom(1)),
            Button("−", lambda: self.zoom(-1)),
            Button(tr("FIT"), self.fit),
            Button(tr("MEAS"), self.measure, self.ruler is not None),
        ]
        if self.several:
            # A low pane does not have room for all buttons.
            found.insert(2, Button(tr("VIEW"), self.next_view))
        return found

    def _draw_title(self, painter: QPainter) -> None:
        """Draw the title again, because the panes have covered its lower half."""
        look, u = self.look, self.look.u
        wide = self.width() - 4 * u
        painter.setFont(look.fit(self.title, 1.7, wide, bold=True))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(2.2 * u, 0, wide, 2.0 * u), LEFT, self.title)
