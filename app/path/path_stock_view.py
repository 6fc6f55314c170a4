"""Drawing of the stock and clamping below the path, and the visible area that they need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QBrush, QPainter

from app.path.path_layers_view import make_polygon
from app.path.path_picture import ProgramPicture
from app.path.path_projection import (
    PixelLine,
    Projection,
    project_clamping,
    project_stock_outline,
    project_stock_section,
)
from app.path.polyline import Bounds
from app.screen.screen_theme import ScreenTheme
from core.interpreter.shared.units import MM_PER_INCH
from core.part.stock import Clamping, Stock, make_bar_stock
from core.part.stock_spec import StockError, StockSpec

SIDE_MARGIN_RATIO = 0.12  # ratio to the length and diameter of the part: visible room for the tool
_CHUCK_SHOWN = 0.6  # ratio to the diameter of the part: visible length of the chuck
_FILLED = 0.28  # opacity of the stock


@dataclass(frozen=True, slots=True)
class StockAndClamping:
    """The specified stock and the clamping of a program, in millimeters.

    ``clamped_stock`` is the material in the chuck. It is the specified stock, or a bar that is large enough
    for the cuts.
    """

    stock: Stock | None
    clamped_stock: Stock
    clamping: Clamping | None

    def find_visible_area(self, cuts: Bounds) -> Bounds:
        """Return the visible area, which contains the stock outside the chuck and all cuts near the stock.

        Without a specified stock, this is the area of the cuts.
        """
        if self.stock is None:
            return cuts
        z0, _, x0, x1 = cuts
        face = max(
            self.stock.back_z_mm, self._face if self._face is not None else min(z0, self.stock.front_z_mm)
        )
        margin_mm = SIDE_MARGIN_RATIO * (self.stock.front_z_mm - face + 2.0 * self.stock.max_radius_mm)
        right, radius = self.stock.front_z_mm + margin_mm, self.stock.max_radius_mm
        reach = max(radius, min(max(abs(x0), abs(x1)), radius + margin_mm))
        return min(face, max(z0, face - margin_mm)), right, min(0.0, x0), reach

    @property
    def chuck_left_z_mm(self) -> float | None:
        """Return the Z of the left edge of the visible part of the chuck, or None without a chuck."""
        face = self._face
        return None if face is None else face - _CHUCK_SHOWN * 2.0 * self.clamped_stock.max_radius_mm

    @property
    def _face(self) -> float | None:
        held = self.clamping
        return -held.stick_out if held is not None and held.chuck_diameter else None


def find_stock_and_clamping(picture: ProgramPicture) -> StockAndClamping | None:
    """Return the specified stock and clamping of a program, or None if neither is specified."""
    if picture.part is None:
        return None
    setting = picture.part.part_settings
    stock, (z0, _, x0, x1) = setting.stock, picture.bounds
    if isinstance(stock, StockSpec):
        try:
            stock = stock.stock(z0, 1.0 if picture.metric else MM_PER_INCH)
        except StockError:  # The proof reports the error.
            stock = None
    if stock is None and (setting.clamping is None or not setting.clamping.chuck_diameter):
        return None
    needed = stock or make_bar_stock(2.0 * max(abs(x0), abs(x1)), 0.0, z0)
    return StockAndClamping(stock, needed, setting.clamping)


def draw_stock_and_clamping(
    painter: QPainter, theme: ScreenTheme, blank: StockAndClamping, projection: Projection
) -> None:
    """Draw the stock as a filled section, and the chuck or collet and the tailstock as hatched areas."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    if blank.stock is not None:
        ground = theme.get_color("frame")
        ground.setAlphaF(_FILLED)
        _fill(painter, project_stock_section(blank.stock, projection), QBrush(ground))
        pen = theme.make_pen("ghost", 0.12)
        pen.setDashPattern([5, 4])
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for line in project_stock_outline(blank.stock, projection):
            painter.drawPolyline(make_polygon(line.columns, line.rows))
    if blank.clamping is not None:
        chuck = project_clamping(blank.clamping, blank.clamped_stock, projection)
        _fill(painter, chuck, QBrush(theme.get_color("key")))
        painter.setPen(theme.make_pen("off", 0.14))
        painter.setBrush(QBrush(theme.get_color("off"), Qt.BrushStyle.FDiagPattern))
        for area in chuck:
            painter.drawPolygon(make_polygon(area.columns, area.rows))


def _fill(painter: QPainter, areas: list[PixelLine], brush: QBrush) -> None:
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(brush)
    for area in areas:
        painter.drawPolygon(make_polygon(np.asarray(area.columns), np.asarray(area.rows)))
