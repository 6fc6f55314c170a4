"""Pane that shows the part as a section with collisions in red."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QPainter, QPolygonF

from app.path.part_player import PartPlayer, PlaybackResult
from app.path.path_aspects import PathViewKind
from app.path.path_layers_view import make_polygon
from app.path.path_pane_view import FIT_MARGIN, PathPane, PlanePosition
from app.path.path_picture import ProgramPicture
from app.path.path_projection import (
    FloatArray,
    PixelLine,
    Projection,
    SectionArea,
    fit_mirrored_projection,
    project_clamping,
    project_collision,
    project_section,
    project_stock_outline,
)
from app.path.path_stock_view import SIDE_MARGIN_RATIO, StockAndClamping
from app.path.polyline import Polyline
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ScreenTheme, draw_text
from core.part.stock import Stock

_X_BAND, _Z_BAND = 4.2, 2.6  # units: width of the scale of X, and height of the scale of Z
_MIN_TICK_DISTANCE = 6.0  # minimum distance between two values of a scale, in units
_TICK_STEPS_MM = (
    0.001,
    0.002,
    0.005,
    0.01,
    0.02,
    0.05,
    0.1,
    0.2,
    0.5,
    1.0,
    2.0,
    5.0,
    10.0,
    20.0,
    50.0,
    100.0,
)


class PartPane(PathPane):
    """Pane that shows the part from a ``PartPlayer``.

    The pane is redrawn when the part, the tool or the view changes.
    """

    part_player: PartPlayer

    def __init__(
        self, theme: ScreenTheme, aspect: PathViewKind, polyline: Polyline, player: PartPlayer
    ) -> None:
        self.part_player = player
        # the instant and projection of the cached outlines
        self._drawn: tuple[PlaybackResult, Projection] | None = None
        self._metal: list[tuple[QPolygonF, list[QPolygonF]]] = []
        self._hits: list[QPolygonF] = []
        self._stock: list[QPolygonF] = []
        self._chuck: list[QPolygonF] = []
        self._fitted = False
        super().__init__(theme, aspect, polyline)

    @property
    def is_metric(self) -> bool:
        """Return whether the program uses millimeters."""
        return isinstance(self.polyline, ProgramPicture) and self.polyline.metric

    # --- projection ----------------------------------------------------------------------------------

    def make_full_projection(self) -> Projection:
        """Return the projection that shows the stock outside the chuck, with room for the tool."""
        z0, z1, x0, x1 = self.polyline.bounds
        shown = self.part_player.latest_result
        if shown is not None and (stock := shown.part_instant.stock) is not None:
            left = self.find_left_z_mm(shown, stock)
            margin_mm = SIDE_MARGIN_RATIO * (stock.front_z_mm - left + 2.0 * stock.max_radius_mm)
            z0, z1, x0, x1 = left, stock.front_z_mm + margin_mm, 0.0, stock.max_radius_mm + 0.5 * margin_mm
        u = self.theme.unit_px
        left_band, low_band = _X_BAND * u, _Z_BAND * u
        wide, high = self.area.width() - left_band, self.area.height() - low_band
        inner = fit_mirrored_projection((z0, z1, x0, x1), int(wide), int(high), FIT_MARGIN * u)
        whole = replace(inner, width_px=int(self.area.width()), height_px=int(self.area.height()))
        return whole.shift(left_band / 2, -low_band / 2)

    @staticmethod
    def find_left_z_mm(shown: PlaybackResult, stock: Stock) -> float:
        """Return the Z at the left edge of the visible stock.

        Most of the stock inside a chuck is not shown.
        """
        chuck = StockAndClamping(stock, stock, shown.part_instant.clamping).chuck_left_z_mm
        return stock.back_z_mm if chuck is None else max(stock.back_z_mm, chuck)

    def set_projection(self, projection: Projection) -> None:
        """Set the projection, and turn off 3D rendering, because this pane shows a section."""
        self.projection = projection
        self.part_player.set_image_request(None)

    def set_run_state(
        self,
        active_block: int,
        tip_position: PlanePosition | None,
        stop_position: PlanePosition | None = None,
    ) -> None:
        """Make the player follow the running program while a block is active.

        ``tip_position`` is the position of the tool. ``stop_position`` is the position where an interrupted
        block stopped.
        """
        if (
            active_block
            and tip_position is not None
            and (active_block, tip_position) != (self._block, self._place)
        ):
            end = self.find_block_end(active_block) or tip_position
            at = stop_position or tip_position
            self.part_player.follow_run(active_block, (at[0] - end[0], at[1] - end[1]))
        self._block, self._place = active_block, tip_position

    def continue_drawing(self) -> bool:
        """Update the player, and return whether the pane needs to be redrawn."""
        new = self.part_player.update()
        if self.part_player.latest_result is not None and not self._fitted:
            self._fitted = True
            if not self.is_adjusted:
                self.fit_view()
        return new

    def show_polyline(self, polyline: Polyline, before: Polyline | None) -> None:
        """Show another program or version of the program. Its stock may differ."""
        self._fitted = False
        super().show_polyline(polyline, before)

    @property
    def is_complete(self) -> bool:
        """Return whether the player shows the requested part."""
        return not self.part_player.is_outdated

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """Draw the section.

        The origin of the painter is the corner of the pane.
        """
        shown, projection = self.part_player.latest_result, self.projection
        if shown is None or projection is None:
            return
        self._outline(shown, projection)
        look = self.theme
        painter.setBrush(Qt.BrushStyle.NoBrush)
        pen = look.make_pen("todo", 0.12)
        pen.setDashPattern([5, 4])
        painter.setPen(pen)
        for line in self._stock:
            painter.drawPolyline(line)
        painter.setPen(look.make_pen("off", 0.14))
        painter.setBrush(QBrush(look.get_color("off"), Qt.BrushStyle.FDiagPattern))
        for area in self._chuck:
            painter.drawPolygon(area)
        self._fill(painter, self._hits, QBrush(look.get_color("alarm")))
        areas = [area for area, _ in self._metal]
        self._fill(painter, areas, QBrush(look.get_color("key")))
        self._fill(painter, areas, QBrush(look.get_color("todo"), Qt.BrushStyle.BDiagPattern))
        painter.setPen(look.make_pen("text", 0.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for _, edges in self._metal:
            for edge in edges:
                painter.drawPolyline(edge)

    def draw_run_state(self, painter: QPainter) -> None:
        """Draw the tool, the scales, the travel limits and the outlines of collisions over the section."""
        shown, projection = self.part_player.latest_result, self.projection
        if shown is None or projection is None:
            return
        look = self.theme
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(look.make_pen("alarm", 0.3))
        for area in self._hits:
            painter.drawPolygon(area)
        self._draw_reach(painter, shown)
        self._tool(painter, shown, projection)
        self._draw_scales(painter, projection)

    def _outline(self, shown: PlaybackResult, projection: Projection) -> None:
        if self._drawn is not None and self._drawn[0] is shown and self._drawn[1] == projection:
            return
        self._drawn = shown, projection
        instant = shown.part_instant
        metal: list[SectionArea] = []
        for half, far in ((instant.x_plus_half, False), (instant.x_minus_half, True)):
            if half is not None:
                metal += project_section(half, projection, is_upper=far)
        self._metal = [
            (_polygon(each.outline), [_polygon(edge) for edge in each.edge_lines]) for each in metal
        ]
        self._hits = [
            _polygon(area) for hit in instant.material_hits for area in project_collision(hit, projection)
        ]
        stock = instant.stock
        self._stock = (
            [_polygon(line) for line in project_stock_outline(stock, projection)] if stock is not None else []
        )
        held = instant.clamping
        self._chuck = []
        if held is not None and stock is not None:
            self._chuck = [_polygon(area) for area in project_clamping(held, stock, projection)]

    @staticmethod
    def _fill(painter: QPainter, areas: Iterable[QPolygonF], brush: QBrush) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(brush)
        for area in areas:
            painter.drawPolygon(area)

    def _draw_reach(self, painter: QPainter, shown: PlaybackResult) -> None:
        """Draw the range that the tool tip can reach within the travel limits."""
        if shown.part_instant.tip_range is None:
            return
        (z0, x0), (z1, x1) = shown.part_instant.tip_range
        corners = [self.map_to_pane(z, x) for z, x in ((z0, x0), (z1, x0), (z1, x1), (z0, x1), (z0, x0))]
        draw_travel_limits(painter, self.theme, corners)

    def _tool(self, painter: QPainter, shown: PlaybackResult, projection: Projection) -> None:
        tool, look = shown.part_instant.tool, self.theme
        if tool is None:
            return
        pen = look.make_pen("off", 0.14)
        if tool.is_assumed:
            pen.setDashPattern([4, 3])
        painter.setPen(pen)
        body = look.get_color("off")
        body.setAlphaF(0.12 if tool.is_assumed else 0.45)
        painter.setBrush(body)
        for shape in tool.body_outlines:
            painter.drawPolygon(_placed(shape, projection))
        painter.setPen(look.make_pen("panel", 0.1))
        painter.setBrush(look.get_color("pause"))
        for shape in tool.cutting_outlines:
            painter.drawPolygon(_placed(shape, projection))
        at = self.map_to_pane(*tool.control_point)
        u = look.unit_px
        painter.setPen(look.make_pen("tip", 0.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(at, 0.5 * u, 0.5 * u)
        painter.drawLine(at - QPointF(1.1 * u, 0), at + QPointF(1.1 * u, 0))
        painter.drawLine(at - QPointF(0, 1.1 * u), at + QPointF(0, 1.1 * u))

    # --- scales --------------------------------------------------------------------------------------

    def _draw_scales(self, painter: QPainter, projection: Projection) -> None:
        """Draw the Z scale at the bottom and the X scale at the left, in the unit of the program."""
        look, u = self.theme, self.theme.unit_px
        painter.setFont(look.make_font(look.find_table_size(1.4)))
        unit = 1.0 if self.is_metric else 25.4
        step = next(
            (s for s in _TICK_STEPS_MM if s * unit * projection.pixels_per_mm >= _MIN_TICK_DISTANCE * u),
            _TICK_STEPS_MM[-1],
        )
        bottom, width = float(projection.height_px), float(projection.width_px)
        ground, left, low = look.get_color("panel"), _X_BAND * u, bottom - _Z_BAND * u
        painter.fillRect(QRectF(0, 0, left, bottom), ground)
        painter.fillRect(QRectF(0, low, width, bottom - low), ground)
        painter.setPen(look.make_pen("soft", 0.1))
        for value in _ticks(projection.center_z, width / projection.pixels_per_mm, step * unit):
            at = float(projection.find_pixel_column(value * unit * step))
            if at > left:
                painter.drawLine(QPointF(at, low), QPointF(at, low + 0.6 * u))
                words = _format_tick(value * step)
                draw_text(painter, QRectF(at - 4 * u, low + 0.8 * u, 8 * u, 1.6 * u), ALIGN_CENTER, words)
        for value in _ticks(projection.center_x, bottom / projection.pixels_per_mm, step * unit):
            at = float(projection.find_pixel_row(value * unit * step))
            if 3.2 * u < at < low - u:  # The title of the pane is above.
                painter.drawLine(QPointF(left - 0.6 * u, at), QPointF(left, at))
                draw_text(
                    painter,
                    QRectF(0, at - u, left - 0.9 * u, 2 * u),
                    ALIGN_RIGHT,
                    _format_tick(abs(value * step)),
                )


def draw_travel_limits(painter: QPainter, theme: ScreenTheme, limits: Sequence[QPointF]) -> None:
    """Draw the travel limits of the machine as a dash-dot line."""
    pen = theme.make_pen("alarm", 0.16)
    pen.setDashPattern([10, 4, 2, 4])
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolyline(list(limits))


def _ticks(middle: float, length: float, step: float) -> range:
    first, last = (middle - length / 2) / step, (middle + length / 2) / step
    return range(math.ceil(first), math.floor(last) + 1)


def _format_tick(value: float) -> str:
    """Return a value as text, with three decimals at most and no zero before the decimal point."""
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def _polygon(line: PixelLine) -> QPolygonF:
    return make_polygon(line.columns, line.rows)


def _placed(shape: FloatArray, projection: Projection) -> QPolygonF:
    return QPolygonF(
        [
            QPointF(float(projection.find_pixel_column(z)), float(projection.find_pixel_row(r)))
            for z, r in shape.tolist()
        ]
    )
