"""Panes of the path view: the visible area of a path, with zoom, pan and the tool position."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPolygonF

from app.path.measuring import find_largest_distance, find_nearest_chord
from app.path.path_aspects import (
    PART_ASPECTS,
    AspectView,
    PathViewKind,
    TipPosition,
    list_available_views,
    select_polyline,
)
from app.path.path_layers_view import LineStyle, PathLayers, draw_stroke_run, make_polygon
from app.path.path_picture import ProgramPicture, map_to_face
from app.path.path_projection import (
    Projection,
    fit_mirrored_projection,
    fit_projection,
    project_block_progress,
    project_strokes,
)
from app.path.path_stock_view import StockAndClamping, draw_stock_and_clamping, find_stock_and_clamping
from app.path.polyline import Bounds, Polyline
from app.screen.screen_theme import ScreenTheme

if TYPE_CHECKING:
    from app.path.part_player import PartPlayer

ZOOM_STEP = 1.25
PAN_STEP_FRACTION = 0.1  # ratio to the width of the pane
FIT_MARGIN = 1.4  # units around the fitted path

PlanePosition = tuple[float, float]
PICK_DISTANCE = 1.6  # units: maximum distance from a line at which a touch selects the line
RING_MARGIN = 6.0  # units around a face: room for the circle of the part and its angles
MAX_MARKED_POINTS = 20_000  # maximum number of points of a line that are drawn thick


class PathPane:
    """One pane of the path view.

    Positions are in widget pixels, and drawings are relative to the pane. z and x are the coordinates of
    the viewed plane. ``part_player`` is the player of a pane that shows the part.
    """

    part_player: PartPlayer | None = None

    def __init__(
        self, theme: ScreenTheme, aspect: PathViewKind, polyline: Polyline, before: Polyline | None = None
    ) -> None:
        self.theme, self.aspect = theme, aspect
        self.area = QRectF()
        self.extra_points: tuple[
            PlanePosition, ...
        ] = ()  # points that must be visible together with the whole path
        self.is_adjusted = False  # set when the user zooms or pans
        self.projection: Projection | None = None
        self.polyline, self.polyline_before = polyline, before
        self._blank = self._blank_below()
        self.largest_distance = find_largest_distance(before, polyline) if before is not None else None
        self._layers: PathLayers | None = None
        self._block = 0
        self._place: PlanePosition | None = None  # position of the tip; None until the first position is set
        self._stood: PlanePosition | None = None
        self.marked_point_ranges: list[tuple[int, int]] = []  # ranges of points

    # --- projection and path -------------------------------------------------------------------------

    def show_polyline(self, polyline: Polyline, before: Polyline | None) -> None:
        """Show another path.

        The projection is retained if the user has adjusted it.
        """
        self.polyline, self.polyline_before, self._block, self.marked_point_ranges = polyline, before, 0, []
        self._blank = self._blank_below()
        self.largest_distance = find_largest_distance(before, polyline) if before is not None else None
        if self.is_adjusted and self.projection is not None:
            self.set_projection(self.projection)
        else:
            self.fit_view()

    def _blank_below(self) -> StockAndClamping | None:
        """Return the stock and clamping to draw below the path, or None to draw neither.

        They are drawn only in the view of the path from above, and not in a comparison.
        """
        picture = self.polyline
        wanted = self.aspect is PathViewKind.PATH and self.polyline_before is None
        return find_stock_and_clamping(picture) if wanted and isinstance(picture, ProgramPicture) else None

    def make_full_projection(self) -> Projection:
        """Return the projection that shows the part and all cuts near it.

        In a comparison, the path before the change is also visible. The chuck is shown as far as the
        remaining width allows.
        """
        fit = fit_projection if self.aspect is PathViewKind.SIDE else fit_mirrored_projection
        bounds, blank = self.polyline.bounds, self._blank
        if blank is not None:
            bounds = blank.find_visible_area(bounds)
        if self.polyline_before is not None:
            bounds = _unite_bounds(bounds, self.polyline_before.bounds)
        for z, x in self.extra_points:
            bounds = _unite_bounds(bounds, (z, z, x, x))
        margin = (RING_MARGIN if self.aspect is PathViewKind.FACE else FIT_MARGIN) * self.theme.unit_px
        whole = fit(bounds, int(self.area.width()), int(self.area.height()), margin)
        if blank is None or blank.chuck_left_z_mm is None:
            return whole
        free = self.area.width() - 2 * margin - (bounds[1] - bounds[0]) * whole.pixels_per_mm
        wanted = max(0.0, bounds[0] - blank.chuck_left_z_mm) * whole.pixels_per_mm
        return whole.shift(max(0.0, min(free, wanted)) / 2, 0.0)

    def redraw(self) -> None:
        """Draw the same view again, in the colors of a new theme."""
        if self.projection is not None:
            self.set_projection(self.projection)

    def set_projection(self, projection: Projection) -> None:
        """Set the projection and redraw the pane."""
        self.projection = projection
        blank = self._blank
        ground = None
        if blank is not None:
            ground = partial(draw_stock_and_clamping, theme=self.theme, blank=blank, projection=projection)
        self._layers = PathLayers(self.theme, self.polyline, projection, self.polyline_before, ground)
        self._layers.request_finished_blocks(self._block - 1)
        self._layers.continue_drawing()

    def find_block(self, position: QPointF) -> int:
        """Return the number of the block drawn at or near a widget position, or 0 if there is no block."""
        z, x = self.map_to_plane(position)
        point = find_nearest_chord(
            self.polyline, z, x, PICK_DISTANCE * self.theme.unit_px * self.pixel_size_mm
        )
        return 0 if point is None else self.polyline.find_block(point)

    # --- navigation ----------------------------------------------------------------------------------

    def set_area(self, area: QRectF) -> None:
        """Set the area of the pane, and show the whole path again if its size has changed."""
        if area != self.area:
            self.area = area
            self.fit_view()

    def fit_view(self) -> None:
        """Show the whole path."""
        self.is_adjusted = False
        self.set_projection(self.make_full_projection())

    def set_extra_visible_points(self, points: Sequence[PlanePosition]) -> None:
        """Set the points that must be visible together with the whole path."""
        if tuple(points) != self.extra_points:
            self.extra_points = tuple(points)
            if not self.is_adjusted and self.projection is not None:
                self.fit_view()

    def zoom_view(self, steps: int, position: QPointF | None = None) -> None:
        """Zoom in (positive steps) or out (negative steps).

        The center of the zoom is a widget position, the largest difference, or the middle of the pane.
        """
        self.magnify(ZOOM_STEP**steps, position if position is not None else self._middle())

    def _middle(self) -> QPointF:
        if self.largest_distance is not None and self.projection is not None:
            at = self.area.topLeft() + self.map_to_pane(self.largest_distance.z, self.largest_distance.x)
            if self.area.contains(at):
                return at
        return self.area.center()

    def magnify(self, factor: float, position: QPointF) -> None:
        """Magnify the view by a factor.

        The path under ``position`` does not move.
        """
        if self.projection is not None:
            self.is_adjusted = True
            position = position - self.area.topLeft()
            self.set_projection(self.projection.magnify(factor, position.x(), position.y()))

    def pan_view(self, steps_right: int, steps_down: int) -> None:
        """Move the visible area by a number of steps to the right and down."""
        step = PAN_STEP_FRACTION * self.area.width()
        self.handle_drag(QPointF(-steps_right * step, -steps_down * step))

    def handle_drag(self, pixels: QPointF) -> None:
        """Pan the view by a drag in pixels."""
        if self.projection is not None:
            self.is_adjusted = True
            self.set_projection(self.projection.shift(pixels.x(), pixels.y()))

    def point_at(self, _position: QPointF) -> bool:
        """Return whether the pane must be redrawn because the pointer moved to a position."""
        return False

    # --- coordinates ---------------------------------------------------------------------------------

    @property
    def pixel_size_mm(self) -> float:
        """Return the size of one pixel in millimeters."""
        return 1.0 / self.projection.pixels_per_mm if self.projection is not None else 1.0

    def map_to_pane(self, z: float, x: float) -> QPointF:
        """Return the position of a point of the plane in pixels from the corner of the pane."""
        assert self.projection is not None
        return QPointF(float(self.projection.find_pixel_column(z)), float(self.projection.find_pixel_row(x)))

    def map_to_plane(self, position: QPointF) -> PlanePosition:
        """Return the coordinates z and x of the plane at a widget position."""
        projection, room = self.projection, self.area
        assert projection is not None
        z = (
            projection.center_z
            + (position.x() - room.x() - projection.width_px / 2) / projection.pixels_per_mm
        )
        return z, projection.center_x + (
            position.y() - room.y() - projection.height_px / 2
        ) / projection.pixels_per_mm

    def find_visible_area(self) -> Bounds:
        """Return the visible area as minimum z, maximum z, minimum x and maximum x."""
        (z0, x0), (z1, x1) = (
            self.map_to_plane(self.area.topLeft()),
            self.map_to_plane(self.area.bottomRight()),
        )
        return z0, z1, x0, x1

    def pan_to_point(self, z: float, x: float) -> None:
        """Pan only as far as necessary to make a point visible."""
        at, room = self.map_to_pane(z, x), self.area
        edge = FIT_MARGIN * self.theme.unit_px
        over = QPointF(
            min(0.0, at.x() - edge) + max(0.0, at.x() - room.width() + edge),
            min(0.0, at.y() - edge) + max(0.0, at.y() - room.height() + edge),
        )
        if not over.isNull():
            self.handle_drag(-over)

    # --- moving parts --------------------------------------------------------------------------------

    def set_run_state(
        self,
        active_block: int,
        tip_position: PlanePosition | None,
        stop_position: PlanePosition | None = None,
    ) -> None:
        """Set the active block and the tip position as (z, x) in the coordinates of the polyline.

        ``stop_position`` is the position where an interrupted block stopped.
        """
        if self._layers is not None and active_block != self._block:
            self._layers.request_finished_blocks(active_block - 1)
        self._block, self._place = active_block, tip_position
        self._stood = stop_position

    def find_block_end(self, block_number: int) -> PlanePosition | None:
        """Return the end of a block, or the end of the last earlier block that is drawn in this pane."""
        at = max(0, self.polyline.count_finished_points(block_number) - 1)
        return (
            (float(self.polyline.z[at]), float(self.polyline.x[at])) if len(self.polyline.z) else self._place
        )

    def find_tip_position(self, tip: TipPosition) -> PlanePosition | None:
        """Return the position of the tool tip in the plane of this pane.

        While C turns as the spindle, a face view returns the last position before that.
        """
        if self.aspect is PathViewKind.PATH or self.aspect in PART_ASPECTS:
            return tip.z, tip.x
        if tip.c is None:
            return self._place
        if self.aspect is PathViewKind.FACE:
            return map_to_face(tip.x, tip.c, tip.center_height_mm)
        return tip.z, -tip.c * self.polyline.mm_per_degree

    def mark(self, block_ranges: list[tuple[int, int]]) -> None:
        """Draw the given blocks as thick lines.

        Each range is (first block, last block), inclusive and counted from 1.
        """
        first = self.polyline.first
        ranges = [(int(first[a - 1]), int(first[b])) for a, b in block_ranges]
        self.marked_point_ranges = [(a, min(b, a + MAX_MARKED_POINTS)) for a, b in ranges if b > a]

    def continue_drawing(self) -> bool:
        """Draw for a few milliseconds at most, and return whether anything changed."""
        return self._layers is not None and self._layers.continue_drawing()

    @property
    def is_complete(self) -> bool:
        """Return whether everything that was requested is drawn."""
        return self._layers is not None and self._layers.is_complete

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """Draw the cached image of the path.

        The origin of the painter is the corner of the pane.
        """
        if self._layers is not None:
            painter.drawImage(QPointF(0, 0), self._layers.image)

    def draw_run_state(self, painter: QPainter) -> None:
        """Draw the thick lines of the marked blocks, the active block and the tool tip.

        In a comparison, draw the largest difference between the two pictures instead.
        """
        if self.projection is None:
            return
        self._draw_marked(painter, self.projection)
        if self.polyline_before is None:
            self._draw_active_block(painter, self.projection)
            self._tool_tip(painter)
        elif self.largest_distance is not None and self.largest_distance.distance_mm:
            painter.setPen(self.theme.make_pen("text", 0.2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(
                self.map_to_pane(self.largest_distance.z, self.largest_distance.x),
                1.4 * self.theme.unit_px,
                1.4 * self.theme.unit_px,
            )

    def _draw_marked(self, painter: QPainter, projection: Projection) -> None:
        pens = LineStyle.MARKED.make_pens(self.theme)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for start, end in self.marked_point_ranges:
            for run in project_strokes(self.polyline, projection, start, end):
                painter.setPen(pens[run.stroke_kind])
                draw_stroke_run(painter, run)

    def _draw_active_block(self, painter: QPainter, projection: Projection) -> None:
        """Draw the finished part of the active block."""
        if not self._block or self._place is None:
            return
        if self._stood is not None and self.aspect is not PathViewKind.PATH:
            return  # On a face or a side, the C position of the interruption is not known.
        found = project_block_progress(self.polyline, projection, self._block, *(self._stood or self._place))
        if found is not None:
            painter.setPen(LineStyle.FINISHED.make_pens(self.theme)[found.stroke_kind])
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawPolyline(make_polygon(found.columns, found.rows))

    def _tool_tip(self, painter: QPainter) -> None:
        if self._place is None:
            return
        look, u = self.theme, self.theme.unit_px
        at = self.map_to_pane(*self._place)
        painter.setPen(look.make_pen("panel", 0.2))
        painter.setBrush(look.get_color("tip"))
        if self.aspect is not PathViewKind.PATH:  # A mill is viewed along its axis.
            painter.drawEllipse(at, 0.7 * u, 0.7 * u)
            return
        side = 1.0 if self._place[1] >= 0 else -1.0
        body = [at, at + QPointF(1.5 * u, 1.3 * side * u), at + QPointF(0.2 * u, 3.2 * side * u)]
        painter.drawPolygon(QPolygonF([*body, at + QPointF(-1.1 * u, 1.6 * side * u)]))


def _unite_bounds(one: Bounds, other: Bounds) -> Bounds:
    """Return the smallest box that contains two boxes."""
    low, high = tuple(map(min, one, other)), tuple(map(max, one, other))
    return low[0], high[1], low[2], high[3]


MakePane = Callable[[PathViewKind, Polyline, Polyline | None], PathPane]
MIN_LAYOUT_WIDTH_PX = 40  # pixels: minimum width of a layout


class PaneSet:
    """Panes of the displayed picture and, in a comparison, of the picture before the change.

    If ``keeps_view`` is True, a new picture is shown with the user's zoom and pan. ``make_pane`` creates a
    pane.
    """

    def __init__(self, keeps_view: bool, make_pane: MakePane, *, has_part: bool = False) -> None:
        self._keeps, self._make, self._with_part = keeps_view, make_pane, has_part
        self.picture: ProgramPicture | None = None
        self.picture_before: ProgramPicture | None = None
        self.visible_panes: list[PathPane] = []
        self._views: list[AspectView] = []
        self._view = 0
        self._room = QRectF()

    def set_pictures(self, picture: ProgramPicture | None, before: ProgramPicture | None) -> None:
        """Set the pictures to display.

        The selected view remains selected if the available views do not change. Otherwise, the first view
        is selected.
        """
        self.picture, self.picture_before = picture, before
        with_part = self._with_part and before is None
        views = list_available_views(picture, has_part=with_part) if picture is not None else []
        if views != self._views:
            self._views, self._view = views, 0
        self._fill()

    @property
    def has_several_views(self) -> bool:
        """Return whether more than one view exists."""
        return len(self._views) > 1

    @property
    def view_count(self) -> int:
        """Return the number of views."""
        return len(self._views)

    def select_next_view(self) -> None:
        """Switch to the next view."""
        self._view = (self._view + 1) % max(1, len(self._views))
        self._fill()

    def set_area(self, area: QRectF) -> None:
        """Divide the area among the panes."""
        self._room = area
        if area.width() <= MIN_LAYOUT_WIDTH_PX or not self.visible_panes:
            return
        wide = area.width() / len(self.visible_panes)
        for number, pane in enumerate(self.visible_panes):
            box = QRectF(area.x() + number * wide, area.y(), wide, area.height())
            pane.set_area(box.toRect().toRectF())

    def at(self, position: QPointF) -> PathPane | None:
        """Return the pane at a widget position, or None if there is no pane."""
        return next((pane for pane in self.visible_panes if pane.area.contains(position)), None)

    def continue_drawing(self) -> bool:
        """Draw for a few milliseconds at most, and return whether anything changed."""
        drawn = [pane.continue_drawing() for pane in self.visible_panes]
        return any(drawn)

    def _fill(self) -> None:
        aspects = self._views[self._view] if self._views else ()
        kept = {pane.aspect: pane for pane in self.visible_panes} if self._keeps else {}
        panes = []
        for aspect in aspects:
            polyline, before = (
                select_polyline(self.picture, aspect),
                select_polyline(self.picture_before, aspect),
            )
            assert polyline is not None
            pane = kept.get(aspect)
            if pane is None:
                pane = self._make(aspect, polyline, before)
            else:
                pane.show_polyline(polyline, before)
            panes.append(pane)
        self.visible_panes = panes
        self.set_area(self._room)
