"""Pane that shows the part in space."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QImage, QPainter

from app.path.part_pane_view import PartPane, draw_travel_limits
from app.path.part_player import PartPlayer, SolidImageRequest
from app.path.path_aspects import PathViewKind, TipPosition
from app.path.path_pane_view import PlanePosition
from app.path.path_projection import Projection
from app.path.polyline import Polyline
from app.path.solid_marks_view import draw_collisions, draw_dimension, find_dimension
from app.screen.screen_theme import ScreenTheme
from core.part.picture.clamping_bodies import find_clamping_back_z
from core.part.picture.solid_view import SolidView
from core.part.picture.solid_view import fit_view as fitted_solid
from core.part.stock import Point

_DEGREES_PER_PIXEL = 0.4  # degrees per pixel
_DEGREES_PER_KEY = 10.0  # degrees per key press
_SECTION_STEP_DEG = 15.0
_MAX_TILT_DEG = 85.0  # maximum rotation from the side view, in degrees
_VIEW_RADIUS_RATIO = 1.25  # ratio to the radius of the stock


class SolidPane(PartPane):
    """Pane that shows the latest 3D image of the part, rendered at the size of the pane."""

    def __init__(
        self, theme: ScreenTheme, aspect: PathViewKind, polyline: Polyline, player: PartPlayer
    ) -> None:
        self._azimuth, self._tilt, self._roll = 30.0, 35.0, 0.0
        self._view: SolidView | None = None  # the view of the last request
        self.section_angle_deg: float | None = None  # from the turning plane; None without a section
        self._pointer: QPointF | None = None  # from the corner of the pane; None until it is there
        self.is_stock_shown = False  # whether the uncut stock is shown around the part
        super().__init__(theme, aspect, polyline, player)

    # --- projection ----------------------------------------------------------------------------------

    def make_full_projection(self) -> Projection:
        """Return the projection that shows the whole stock."""
        flat, shown = super().make_full_projection(), self.part_player.latest_result
        if shown is None or (stock := shown.part_instant.stock) is None:
            return flat
        wide, high = flat.width_px, max(flat.height_px - round(3.0 * self.theme.unit_px), 1)
        room = _VIEW_RADIUS_RATIO * stock.max_radius_mm  # leaves room for the tool
        left = find_clamping_back_z(shown.part_instant.clamping, stock)
        scale, centre = fitted_solid(left, stock.front_z_mm, room, wide, high, self._azimuth)
        return Projection(centre, 0.0, scale, flat.width_px, flat.height_px)

    def set_projection(self, projection: Projection) -> None:
        """Set the projection, and request an image for it."""
        self.projection = projection
        self._want()

    def _want(self) -> None:
        projection = self.projection
        if projection is None or projection.width_px < 1 or projection.height_px < 1:
            return
        opening = find_removed_quarter(self._tilt) if self.aspect is PathViewKind.OPEN_SOLID else None
        if self.section_angle_deg is not None:
            opening = find_removed_half(self._tilt, self.section_angle_deg)
        view = SolidView(
            self._azimuth, self._tilt, self._roll, projection.pixels_per_mm, projection.center_z, opening
        )
        self._view = view
        self.part_player.set_image_request(
            SolidImageRequest(
                view, projection.width_px, projection.height_px, is_stock_shown=self.is_stock_shown
            )
        )

    def find_tip_position(self, tip: TipPosition) -> PlanePosition | None:
        """Return the position of the tool tip in the picture.

        If the C axis is locked, the picture is first rotated to its position.
        """
        if tip.c is not None and tip.c != self._roll:
            self._roll = tip.c
            self._want()
        return super().find_tip_position(tip)

    # --- section and stock ---------------------------------------------------------------------------

    def toggle_section(self) -> None:
        """Cut the part in the turning plane, or show it as before."""
        self.section_angle_deg = 0.0 if self.section_angle_deg is None else None
        self._want()

    def rotate_section(self) -> None:
        """Rotate the section plane by one step about the part axis; start with the turning plane."""
        angle = self.section_angle_deg
        self.section_angle_deg = 0.0 if angle is None else (angle + _SECTION_STEP_DEG) % 180.0
        self._want()

    def toggle_stock(self) -> None:
        """Show or hide the transparent stock around the part."""
        self.is_stock_shown = not self.is_stock_shown
        self._want()

    # --- navigation ----------------------------------------------------------------------------------

    def handle_drag(self, pixels: QPointF) -> None:
        """Rotate the 3D picture by a drag in pixels."""
        self._turn(pixels.x() * _DEGREES_PER_PIXEL, pixels.y() * _DEGREES_PER_PIXEL)

    def pan_view(self, steps_right: int, steps_down: int) -> None:
        """Rotate the 3D picture by a number of steps of the pan keys."""
        self._turn(-steps_right * _DEGREES_PER_KEY, -steps_down * _DEGREES_PER_KEY)

    def pan_to_point(self, z: float, x: float) -> None:
        """Do nothing, because measuring is not possible in this pane."""

    def _turn(self, across: float, down: float) -> None:
        self._azimuth = min(max(self._azimuth - across, -_MAX_TILT_DEG), _MAX_TILT_DEG)
        self._tilt = (self._tilt + down + 180.0) % 360.0 - 180.0
        self._want()

    def magnify(self, factor: float, position: QPointF) -> None:
        """Magnify the view by a factor.

        The part axis remains in place, and so does the pixel column at ``position``.
        """
        if self.projection is not None:
            self.is_adjusted = True
            across = (position - self.area.topLeft()).x()
            self.set_projection(self.projection.magnify(factor, across, self.projection.height_px / 2))

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """Draw the latest image.

        The origin of the painter is the corner of the pane.
        """
        shown = self.part_player.latest_result
        if shown is not None and shown.picture is not None:
            high, wide = shown.picture.image.shape
            size = shown.pixel_size
            drawn = QImage(
                shown.picture.image.tobytes(), wide, high, 4 * wide, QImage.Format.Format_ARGB32_Premultiplied
            )
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, size > 1)
            painter.drawImage(QRectF(0.0, 0.0, wide * size, high * size), drawn)

    def point_at(self, position: QPointF) -> bool:
        """Show the dimension at a widget position, and return True, so that the pane is redrawn."""
        self._pointer = position - self.area.topLeft()
        return True

    def draw_run_state(self, painter: QPainter) -> None:
        """Draw the travel limits, the places of collisions, and the dimension at the pointer.

        The tool is part of the image.
        """
        shown, projection = self.part_player.latest_result, self.projection
        if shown is None or projection is None or self._view is None:
            return
        view = shown.view if shown.view is not None else self._view
        room = QRectF(0.0, 0.0, projection.width_px, projection.height_px)
        if shown.part_instant.tip_range is not None:
            self._draw_limits(painter, shown.part_instant.tip_range, view)
        draw_collisions(painter, self.theme, shown.part_instant, view, room)
        place = find_dimension(shown, self._pointer) if self._pointer is not None else None
        if place is not None and self._pointer is not None:
            draw_dimension(painter, self.theme, place, self._pointer, room, is_metric=self.is_metric)

    def _draw_limits(self, painter: QPainter, tip_range: tuple[Point, Point], view: SolidView) -> None:
        """Draw the travel limits of the machine in the turning plane."""
        projection = self.projection
        assert projection is not None
        (z0, x0), (z1, x1) = tip_range
        # In the frame of the part, the operator's side is at 180 degrees minus C.
        places = [
            [x, z, 180.0 - view.roll_deg] for z, x in ((z0, x0), (z1, x0), (z1, x1), (z0, x1), (z0, x0))
        ]
        corners = view.project_to_screen(np.array(places), projection.width_px, projection.height_px)
        draw_travel_limits(painter, self.theme, [QPointF(x, y) for x, y in corners.tolist()])


def find_removed_half(tilt_deg: float, section_angle_deg: float) -> tuple[float, float]:
    """Return the start and end angles of the half that is cut away from the displayed solid.

    The angles are in degrees, measured from the direction of the viewer towards the top. The section plane
    contains the part axis. Its angle is measured from the turning plane on the operator's side. The half
    that is closer to the viewer is removed.
    """
    first = (section_angle_deg - tilt_deg) % 180.0 - 180.0
    return first, first + 180.0


def find_removed_quarter(tilt_deg: float) -> tuple[float, float]:
    """Return the start and end angles of the quarter that is cut away from the displayed solid.

    The angles are in degrees, measured from the direction of the viewer towards the top. One edge is in the
    turning plane on the operator's side, where the tool is. The other edge is perpendicular to it, on the
    visible side.
    """
    first = -tilt_deg if tilt_deg >= 0.0 else -tilt_deg - 90.0
    return first, first + 90.0
