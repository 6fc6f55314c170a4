"""View of a program's path on the Automatic page, in the editor, the program list and the offset pages.

The view from above has X+ down and Z+ to the right, with both sides of X0. Cuts with C locked are shown
next to it, on the face or the unrolled side of the part. Set the content with ``show_picture`` or
``show_comparison``, set the machine position with ``show_tool_tip``, and call ``continue_drawing`` once a
frame. This module calculates only screen positions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.path.path_aspects import PART_ASPECTS, SPATIAL_ASPECTS, ApproachLeg, PathViewKind, TipPosition
from app.path.path_pointer_view import PathPointerHandler
from app.screen.panel import OnPress, Panel, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme

if TYPE_CHECKING:
    from app.path.measuring_view import Measurement
    from app.path.part_bar_view import PartTimeline
    from app.path.part_player import PartPlayer
    from app.path.path_pane_view import PaneSet, PathPane, PlanePosition
    from app.path.path_picture import ProgramPicture
    from app.path.path_projection import Projection
    from app.path.polyline import Polyline
    from app.screen.page_base import KeyActions

TIMELINE_HEIGHT = 6.8  # units: height of the time line below the part
FOOTER_HEIGHT = 2.4  # units: height of the row with the legend and the scales below the panes
OnBlockPicked = Callable[[int], None]


class PathView(Panel):
    """View with several panes side by side, each with its own zoom.

    Keys act on the first pane, and touches act on the touched pane. ``on_picked`` is called with the number
    of the touched block, counted from 1. While measuring, the view has the keyboard focus and passes unused
    keys to the window.
    """

    accessible_name = "PATH"
    title = "PATH"
    preserves_view = False  # whether adjusted projections remain when the picture changes
    is_loading = RedrawingAttribute(False)  # A program is being read or drawn, so its path follows.
    shows_whole_approach = False  # whether the visible area includes all legs of an approach

    def __init__(
        self,
        theme: ScreenTheme,
        parent: QWidget | None = None,
        on_picked: OnBlockPicked | None = None,
        part_player: PartPlayer | None = None,
    ) -> None:
        super().__init__(theme, parent)
        self._picked = on_picked
        self.part_player = part_player  # player of the part; without a player, the part is not shown
        # opens the entry of the stock; None if it cannot be opened from this view
        self.open_stock: OnPress | None = None
        self.enlarge: OnPress | None = None  # enlarges the view; None if its size cannot be changed
        self._bar: PartTimeline | None = None  # the time line, created when the part is first shown
        self._set: PaneSet | None = None  # created with the first picture
        self._tip: TipPosition | None = None  # not drawn until the first position is set
        self.drawn_legs: tuple[ApproachLeg, ...] = ()  # legs of an approach
        self.measurement: Measurement | None = None  # None while the user does not measure
        self._pointer = PathPointerHandler(
            theme, self._find_touch_target, self._hovers, self._dragged, self._handle_touch, self.magnify
        )
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    @property
    def panes(self) -> Sequence[PathPane]:
        """Return the visible panes, from left to right."""
        return self._set.visible_panes if self._set is not None else ()

    @property
    def first_projection(self) -> Projection | None:
        """Return the projection of the first pane, or None without a pane."""
        return self.panes[0].projection if self.panes else None

    @property
    def has_several_views(self) -> bool:
        """Return whether more than one view exists."""
        return self._set is not None and self._set.has_several_views

    @property
    def is_comparing(self) -> bool:
        """Return whether two pictures are compared."""
        return self._set is not None and self._set.picture_before is not None

    @property
    def picture(self) -> ProgramPicture | None:
        """Return the displayed picture, or None if nothing is displayed."""
        return self._set.picture if self._set is not None else None

    @property
    def is_part_shown(self) -> bool:
        """Return whether a view of the part is displayed."""
        return any(pane.aspect in PART_ASPECTS for pane in self.panes)

    @property
    def _is_solid_shown(self) -> bool:
        return any(pane.aspect in SPATIAL_ASPECTS for pane in self.panes)

    @property
    def has_path(self) -> bool:
        """Return whether the picture contains any path."""
        return self.picture is not None and len(self.picture.z) > 0

    @property
    def is_metric(self) -> bool:
        """Return whether the program uses millimeters."""
        return self.picture is not None and self.picture.metric

    # --- content -------------------------------------------------------------------------------------

    def show_picture(self, picture: ProgramPicture | None) -> None:
        """Show the path of another program, or no path if ``picture`` is None."""
        self._show(picture, None)

    def show_comparison(self, before: ProgramPicture | None, after: ProgramPicture | None) -> None:
        """Show one program before and after a change, with a legend.

        The tool tip and the progress are not shown. If ``after`` is None, nothing is shown. If ``before``
        is None, only ``after`` is shown.
        """
        self._show(after, before)

    def show_approach(self, legs: Sequence[ApproachLeg] | None) -> None:
        """Show the approach over the path.

        The first leg is the current tool position.
        """
        if tuple(legs or ()) != self.drawn_legs:
            self.drawn_legs = tuple(legs or ())
            self._include_points()
            self.update()

    def show_tool_tip(self, tip: TipPosition) -> None:
        """Show the tool tip and the progress of the run."""
        if tip != self._tip:
            self._tip = tip
            self._show_tool()
            self.update()

    def mark(self, block_ranges: list[tuple[int, int]]) -> None:
        """Draw the given blocks as thick lines.

        Each range is (first block, last block), inclusive and counted from 1.
        """
        for pane in self.panes:
            pane.mark(block_ranges)
        self.update()

    def continue_drawing(self) -> None:
        """Continue drawing for a few milliseconds at most.

        This is called once a frame.
        """
        if self._set is not None and self._set.continue_drawing():
            self.update()

    def _show(self, picture: ProgramPicture | None, before: ProgramPicture | None) -> None:
        from app.path.path_pane_view import PaneSet

        if self._set is None:
            self._set = PaneSet(self.preserves_view, self._make, has_part=self.part_player is not None)
        if picture is self._set.picture and before is self._set.picture_before:
            return
        if self._tip is not None:
            self._tip = self._tip._replace(active_block_number=0)
        if self.part_player is not None:
            self.part_player.load_picture(picture if before is None else None)
        self._set.set_pictures(picture, before)
        if self.measurement is not None and self.measurement.pane in self.panes:
            self.measurement.rebuild_snap_points()  # the measured points remain
        else:
            self.switch_measuring(is_on=False)
        self._lay_out()

    def _make(self, aspect: PathViewKind, polyline: Polyline, before: Polyline | None) -> PathPane:
        if aspect in PART_ASPECTS and self.part_player is not None:
            from app.path.part_pane_view import PartPane
            from app.path.solid_pane_view import SolidPane

            made = PartPane if aspect is PathViewKind.SECTION else SolidPane
            return made(self.theme, aspect, polyline, self.part_player)
        from app.path.path_pane_view import PathPane

        return PathPane(self.theme, aspect, polyline, before)

    def _lay_out(self) -> None:
        if self._set is not None:
            self._include_points()
            from app.path.path_buttons_view import make_view_buttons
            from app.path.path_marks_view import count_button_columns, find_button_columns_width

            room = self.find_panes_area()
            columns = count_button_columns(self.theme, room, len(make_view_buttons(self)))
            self._set.set_area(room.adjusted(0, 0, -find_button_columns_width(columns, self.theme), 0))
            self._show_tool()
            self.setMouseTracking(self._is_solid_shown or self.measurement is not None)
        self.update()

    def _include_points(self) -> None:
        """Enlarge the visible area to include the whole approach if the approach is shown."""
        for pane in self.panes:
            if pane.aspect is PathViewKind.PATH and self.shows_whole_approach:
                pane.set_extra_visible_points([(leg.z, leg.x) for leg in self.drawn_legs])

    def _show_tool(self) -> None:
        if self._tip is not None:
            for pane in self.panes:
                pane.set_run_state(
                    self._tip.active_block_number,
                    self._find_tip_position(pane, self._tip),
                    self._tip.stop_position,
                )

    def _find_tip_position(self, pane: PathPane, tip: TipPosition) -> PlanePosition | None:
        """Return the position of the tip in a pane."""
        return pane.find_tip_position(tip)

    def fit_all_panes(self) -> None:
        """Zoom every pane so that it shows its whole path."""
        for pane in self.panes:
            pane.fit_view()
        self.update()

    def redraw(self) -> None:
        """Draw the same view again, in the colors of a new theme."""
        for pane in self.panes:
            pane.redraw()
        self.update()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Show the whole path after a change of size."""
        self._lay_out()

    def find_panes_area(self) -> QRectF:
        """Return the area inside the frame of the view.

        The panes use the part of this area that the buttons do not cover.
        """
        u = self.theme.unit_px
        bar = TIMELINE_HEIGHT * u if self.is_part_shown else self.theme.find_line_height(FOOTER_HEIGHT)
        top = 0.5 * self.theme.title_height + 0.2
        return self.find_full_area().adjusted(0.2 * u, top * u, -0.2 * u, -0.2 * u - bar).toRect().toRectF()

    # --- navigation ----------------------------------------------------------------------------------

    def select_next_view(self) -> None:
        """Switch to the next view if there are several."""
        if self._set is not None and self.has_several_views:
            measuring = self.measurement is not None
            self.switch_measuring(is_on=False)
            self._set.select_next_view()
            self._lay_out()
            self.switch_measuring(is_on=measuring)

    def show_part(self) -> None:
        """Switch to a view of the part if one exists."""
        for _ in range(self._set.view_count if self._set is not None else 0):
            if not self.is_part_shown:
                self.select_next_view()

    def zoom_view(self, steps: int, position: QPointF | None = None) -> None:
        """Zoom in (positive steps) or out (negative steps), around a widget position or the middle."""
        pane = self.find_pane(position)
        if pane is not None:
            pane.zoom_view(steps, position)
            self.update()

    def magnify(self, factor: float, position: QPointF) -> None:
        """Magnify the view by a factor, around a widget position."""
        pane = self.find_pane(position)
        if pane is not None:
            pane.magnify(factor, position)
            self.update()

    def pan_view(self, steps_right: int, steps_down: int) -> None:
        """Move the visible area by a number of steps to the right and down."""
        pane = self.find_pane(None)
        if pane is not None:
            pane.pan_view(steps_right, steps_down)
            self.update()

    def make_view_key_actions(self) -> KeyActions:
        """Return the actions of the zoom and pan keys, which are the same as on the Automatic page."""
        return {
            "Zoom in": partial(self.zoom_view, 1),
            "Zoom out": partial(self.zoom_view, -1),
            "Pan left": partial(self.pan_view, -1, 0),
            "Pan right": partial(self.pan_view, 1, 0),
            "Pan up": partial(self.pan_view, 0, -1),
            "Pan down": partial(self.pan_view, 0, 1),
        }

    def make_part_key_actions(self) -> KeyActions:
        """Return the actions of the keys for the timeline and for the part in space."""
        if self.part_player is None:
            return {}
        actions = self.part_player.make_key_actions()
        if not self._is_solid_shown:
            return actions
        from app.path.path_buttons_view import make_solid_key_actions

        return {**actions, **make_solid_key_actions(self.panes, self.update)}

    def find_pane(self, position: QPointF | None) -> PathPane | None:
        """Return the pane at a position.

        If there is no pane at this position, return the pane of the measurement, or the first pane.
        """
        found = self._set.at(position) if self._set is not None and position is not None else None
        if found is None:
            found = self.measurement.pane if self.measurement is not None else next(iter(self.panes), None)
        return found

    # --- measuring and picking -----------------------------------------------------------------------

    def switch_measuring(self, *, is_on: bool | None = None) -> None:
        """Start or stop measuring in the last pane.

        If the argument is None, measuring is toggled.
        """
        if is_on is None:
            is_on = self.measurement is None
        if is_on and self.has_path and self.first_projection is not None:
            self._measure_in(self.panes[-1])
            self.setFocus()
        elif not is_on and self.measurement is not None:
            self.measurement.end_measuring()
            self.measurement = None
            self.setMouseTracking(self._is_solid_shown)
            if self.hasFocus():
                self.window().setFocus()
        self.update()

    def _measure_in(self, pane: PathPane) -> Measurement:
        from app.path.measuring_view import Measurement

        ruler = self.measurement = Measurement(pane)
        self.setMouseTracking(True)
        return ruler

    def _find_touch_target(self, at: QPointF) -> PathPane | PartTimeline | None:
        """Return the timeline or pane at a position, or None if a button of the view is there."""
        if self.press_target_at(at):
            return None
        if self._bar is not None and self.is_part_shown and self._bar.handle_touch(at):
            return self._bar
        return self.find_pane(at)

    def _hovers(self, at: QPointF) -> None:
        if (pane := self.find_pane(at)) is not None and pane.point_at(at):
            self.update()
        if self.measurement is not None and self.measurement.pane.area.contains(at):
            self.measurement.move_cursor(at)
            self.update()

    def _dragged(self, held: PathPane | PartTimeline, by: QPointF) -> None:
        held.handle_drag(by)
        self.update()

    def _handle_touch(self, pane: PathPane | PartTimeline, at: QPointF) -> None:
        """Measure from the touched point, or select the block that is drawn there."""
        from app.path.path_pane_view import PathPane

        if not isinstance(pane, PathPane):
            return
        if pane.aspect in SPATIAL_ASPECTS:
            self._hovers(at)
            return
        if self.measurement is not None:
            ruler = self.measurement if self.measurement.pane is pane else self._measure_in(pane)
            ruler.move_cursor(at)
            ruler.set_measured_point()
            self.update()
        elif self._picked is not None and (block := pane.find_block(at)):
            self._picked(block)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle the keys for measuring, and pass all other keys to the window."""
        if self.measurement is not None and self.measurement.key(event):
            self.update()
        else:
            event.ignore()

    def focusNextPrevChild(self, _next: bool) -> bool:
        """Prevent Tab from moving the focus, because Tab moves the measuring cursor."""
        return False

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Stop measuring when another widget gets the focus, but not when another window gets it."""
        if event.reason() is not Qt.FocusReason.ActiveWindowFocusReason:
            self.switch_measuring(is_on=False)

    def event(self, event: QEvent) -> bool:
        """Handle touch events, and pass all other events to the base class."""
        return self._pointer.handle_touch_event(event) or super().event(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom with the wheel around the pointer."""
        self.zoom_view(1 if event.angleDelta().y() > 0 else -1, event.position())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Press a button of the view, or start a drag."""
        self._pointer.begin_press(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the picture during a drag."""
        self._pointer.handle_pointer_motion(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End a drag, or handle a touch if the pointer did not move."""
        self._pointer.end_press(event.position())

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: QPainter) -> None:
        """Draw the panes, title, buttons and legend, or a message if there is no picture."""
        from app.path import path_marks_view as marks
        from app.path.pane_drawing_view import draw_pane, draw_view_title
        from app.path.path_buttons_view import make_view_buttons

        look, panes = self.theme, self.panes
        if not panes:
            why = tr("Loading the program.") if self.is_loading else tr("Load a program to see its path.")
            marks.draw_no_path_reason(painter, look, self.inside(), why)
            return
        for pane in panes:
            draw_pane(painter, look, pane, self.drawn_legs, self.measurement, is_metric=self.is_metric)
            if pane.aspect is not PathViewKind.PATH and pane is not panes[0]:
                marks.draw_border(painter, look, pane.area)
        if (
            self.measurement is not None and self.measurement.pane.aspect not in SPATIAL_ASPECTS
        ):  # The table is drawn in another pane if there is one.
            values_pane = next(
                (pane for pane in panes if pane is not self.measurement.pane), self.measurement.pane
            )
            self.measurement.draw_values(painter, values_pane.area, self.is_metric)
        # The panes have covered the lower half of the title.
        draw_view_title(painter, look, self.width(), self.title)
        marks.draw_buttons(painter, look, self.find_panes_area(), make_view_buttons(self), self.add_target)
        if self.is_part_shown:
            self._draw_bar(painter)
            return
        legend = marks.make_comparison_legend(look) if self.is_comparing else marks.make_run_legend(look)
        room = self.find_panes_area()
        foot = QRectF(room.x(), room.bottom(), room.width(), FOOTER_HEIGHT * look.unit_px)
        marks.draw_footer(
            painter, look, foot, [(pane.area, pane.projection) for pane in panes], legend, self.is_metric
        )
        apart = panes[0].largest_distance
        if apart is not None:
            marks.draw_title(
                painter, look, panes[0].area, marks.describe_largest_difference(apart, self.is_metric)
            )

    def _draw_bar(self, painter: QPainter) -> None:
        """Draw the timeline of the part."""
        from app.path.part_bar_view import PartTimeline

        assert self.part_player is not None
        if self._bar is None:
            self._bar = PartTimeline(self.theme, self.part_player, self.open_stock)
        room, u = self.find_panes_area(), self.theme.unit_px
        self._bar.draw(
            painter, QRectF(room.x(), room.bottom(), room.width(), TIMELINE_HEIGHT * u), self.add_target
        )
