"""Panes of the part: a section drawing with collisions in red, and the solid part."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QImage, QPainter, QPolygonF

from app.path.part_player import PartPlayer, PlayedInstant, SolidLook
from app.path.path_aspects import Aspect, Tip
from app.path.path_layers_view import polygon
from app.path.path_pane_view import MARGIN, Pane, Place
from app.path.path_picture import Picture
from app.path.path_projection import (
    Floats,
    Line,
    Metal,
    Projection,
    clamping_areas,
    fitted,
    hit_areas,
    metal_of,
    stock_outline,
)
from app.path.path_stock_view import BESIDE, Blank
from app.path.polyline import Polyline
from app.screen.look import CENTRE, RIGHT, Look, put
from core.part.solid_view import SolidView
from core.part.solid_view import fitted as fitted_solid
from core.part.stock import Stock

_X_BAND, _Z_BAND = 4.2, 2.6  # units: width of the scale of X, and height of the scale of Z
_TICK = 6.0  # minimum distance between two values of a scale, in units
_STEPS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)


class PartPane(Pane):
    """Pane that shows the part from a ``PartPlayer``, redrawn when the part, the tool or the view changes."""

    player: PartPlayer

    def __init__(self, look: Look, aspect: Aspect, polyline: Polyline, player: PartPlayer) -> None:
        self.player = player
        # the instant and projection of the cached outlines
        self._drawn: tuple[PlayedInstant, Projection] | None = None
        self._metal: list[tuple[QPolygonF, list[QPolygonF]]] = []
        self._hits: list[QPolygonF] = []
        self._stock: list[QPolygonF] = []
        self._chuck: list[QPolygonF] = []
        self._fitted = False
        super().__init__(look, aspect, polyline)

    @property
    def metric(self) -> bool:
        """Whether the program uses millimeters."""
        return isinstance(self.polyline, Picture) and self.polyline.metric

    # --- projection ----------------------------------------------------------------------------------

    def whole(self) -> Projection:
        """Return the projection that shows the stock outside the chuck, and room for the tool."""
        z0, z1, x0, x1 = self.polyline.bounds
        shown = self.player.played
        if shown is not None and (stock := shown.instant.stock) is not None:
            left = self._left_of(shown, stock)
            beside = BESIDE * (stock.front - left + 2.0 * stock.radius)
            z0, z1, x0, x1 = left, stock.front + beside, 0.0, stock.radius + 0.5 * beside
        u = self.look.u
        left_band, low_band = _X_BAND * u, _Z_BAND * u
        wide, high = self.room.width() - left_band, self.room.height() - low_band
        inner = fitted((z0, z1, x0, x1), int(wide), int(high), MARGIN * u)
        whole = replace(inner, width=int(self.room.width()), height=int(self.room.height()))
        return whole.moved(left_band / 2, -low_band / 2)

    @staticmethod
    def _left_of(shown: PlayedInstant, stock: Stock) -> float:
        """Return the Z of the left edge of the visible stock. Most of the stock in a chuck is not shown."""
        chuck = Blank(stock, stock, shown.instant.clamping).chuck_from
        return stock.back if chuck is None else max(stock.back, chuck)

    def look_at(self, projection: Projection) -> None:
        """Set the projection, and ask the player for the section only."""
        self.projection = projection
        self.player.look_at(None)

    def stand(self, block: int, place: Place | None, stood: Place | None = None) -> None:
        """Let the player follow the run while a block is active.

        ``place`` is the position of the tool, and ``stood`` is the position where an interrupted block
        stopped.
        """
        if block and place is not None and (block, place) != (self._block, self._place):
            end = self.end_of(block) or place
            at = stood or place
            self.player.follow(block, (at[0] - end[0], at[1] - end[1]))
        self._block, self._place = block, place

    def advance(self) -> bool:
        """Update the player and return whether the pane needs to be redrawn."""
        new = self.player.look()
        if self.player.played is not None and not self._fitted:
            self._fitted = True
            if not self.by_hand:
                self.fit()
        return new

    def take(self, polyline: Polyline, before: Polyline | None) -> None:
        """Show another program or another version of the program, whose stock can differ."""
        self._fitted = False
        super().take(polyline, before)

    @property
    def complete(self) -> bool:
        """Whether the player shows the requested part."""
        return not self.player.behind

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """Draw the section. The painter's origin is the corner of the pane."""
        shown, projection = self.player.played, self.projection
        if shown is None or projection is None:
            return
        self._outline(shown, projection)
        look = self.look
        painter.setBrush(Qt.BrushStyle.NoBrush)
        pen = look.pen("todo", 0.12)
        pen.setDashPattern([5, 4])
        painter.setPen(pen)
        for line in self._stock:
            painter.drawPolyline(line)
        painter.setPen(look.pen("off", 0.14))
        painter.setBrush(QBrush(look.colour("off"), Qt.BrushStyle.FDiagPattern))
        for area in self._chuck:
            painter.drawPolygon(area)
        self._fill(painter, self._hits, QBrush(look.colour("alarm")))
        areas = [area for area, _ in self._metal]
        self._fill(painter, areas, QBrush(look.colour("key")))
        self._fill(painter, areas, QBrush(look.colour("todo"), Qt.BrushStyle.BDiagPattern))
        painter.setPen(look.pen("text", 0.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for _, edges in self._metal:
            for edge in edges:
                painter.drawPolyline(edge)

    def draw_run(self, painter: QPainter) -> None:
        """Draw the tool, the scales, the travel limits and the outlines of collisions on top."""
        shown, projection = self.player.played, self.projection
        if shown is None or projection is None:
            return
        look = self.look
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(look.pen("alarm", 0.3))
        for area in self._hits:
            painter.drawPolygon(area)
        self._reach(painter, shown)
        self._tool(painter, shown, projection)
        self._scales(painter, projection)

    def _outline(self, shown: PlayedInstant, projection: Projection) -> None:
        if self._drawn is not None and self._drawn[0] is shown and self._drawn[1] == projection:
            return
        self._drawn = shown, projection
        instant = shown.instant
        metal: list[Metal] = []
        for half, far in ((instant.near, False), (instant.far, True)):
            if half is not None:
                metal += metal_of(half, projection, far=far)
        self._metal = [(_polygon(each.area), [_polygon(edge) for edge in each.edges]) for each in metal]
        self._hits = [_polygon(area) for hit in instant.hits for area in hit_areas(hit, projection)]
        stock = instant.stock
        self._stock = (
            [_polygon(line) for line in stock_outline(stock, projection)] if stock is not None else []
        )
        held = instant.clamping
        self._chuck = []
        if held is not None and stock is not None:
            self._chuck = [_polygon(area) for area in clamping_areas(held, stock, projection)]

    @staticmethod
    def _fill(painter: QPainter, areas: Iterable[QPolygonF], brush: QBrush) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(brush)
        for area in areas:
            painter.drawPolygon(area)

    def _reach(self, painter: QPainter, shown: PlayedInstant) -> None:
        """Draw the limits of travel for the tool tip."""
        if shown.instant.reach is None:
            return
        (z0, x0), (z1, x1) = shown.instant.reach
        corners = [self.spot(z, x) for z, x in ((z0, x0), (z1, x0), (z1, x1), (z0, x1), (z0, x0))]
        draw_reach(painter, self.look, corners)

    def _tool(self, painter: QPainter, shown: PlayedInstant, projection: Projection) -> None:
        tool, look = shown.instant.tool, self.look
        if tool is None:
            return
        pen = look.pen("off", 0.14)
        if tool.assumed:
            pen.setDashPattern([4, 3])
        painter.setPen(pen)
        body = look.colour("off")
        body.setAlphaF(0.12 if tool.assumed else 0.45)
        painter.setBrush(body)
        for shape in tool.body:
            painter.drawPolygon(_placed(shape, projection))
        painter.setPen(look.pen("panel", 0.1))
        painter.setBrush(look.colour("pause"))
        for shape in tool.cutting:
            painter.drawPolygon(_placed(shape, projection))
        at = self.spot(*tool.at)
        u = look.u
        painter.setPen(look.pen("tip", 0.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(at, 0.5 * u, 0.5 * u)
        painter.drawLine(at - QPointF(1.1 * u, 0), at + QPointF(1.1 * u, 0))
        painter.drawLine(at - QPointF(0, 1.1 * u), at + QPointF(0, 1.1 * u))

    # --- scales --------------------------------------------------------------------------------------

    def _scales(self, painter: QPainter, projection: Projection) -> None:
        """Draw the Z scale at the bottom and the X scale at the left, in the unit of the program."""
        look, u = self.look, self.look.u
        painter.setFont(look.font(1.4))
        unit = 1.0 if self.metric else 25.4
        step = next((s for s in _STEPS if s * unit * projection.scale >= _TICK * u), _STEPS[-1])
        bottom, width = float(projection.height), float(projection.width)
        ground, left, low = look.colour("panel"), _X_BAND * u, bottom - _Z_BAND * u
        painter.fillRect(QRectF(0, 0, left, bottom), ground)
        painter.fillRect(QRectF(0, low, width, bottom - low), ground)
        painter.setPen(look.pen("soft", 0.1))
        for value in _ticks(projection.z, width / projection.scale, step * unit):
            at = float(projection.across(value * unit * step))
            if at > left:
                painter.drawLine(QPointF(at, low), QPointF(at, low + 0.6 * u))
                words = _figure(value * step)
                put(painter, QRectF(at - 4 * u, low + 0.8 * u, 8 * u, 1.6 * u), CENTRE, words)
        for value in _ticks(projection.x, bottom / projection.scale, step * unit):
            at = float(projection.down(value * unit * step))
            if 3.2 * u < at < low - u:  # The title of the pane is above.
                painter.drawLine(QPointF(left - 0.6 * u, at), QPointF(left, at))
                put(painter, QRectF(0, at - u, left - 0.9 * u, 2 * u), RIGHT, _figure(abs(value * step)))


def draw_reach(painter: QPainter, look: Look, corners: Sequence[QPointF]) -> None:
    """Draw the travel limits of the machine as a dash-dot line."""
    pen = look.pen("alarm", 0.16)
    pen.setDashPattern([10, 4, 2, 4])
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolyline(list(corners))


def _ticks(middle: float, length: float, step: float) -> range:
    first, last = (middle - length / 2) / step, (middle + length / 2) / step
    return range(math.ceil(first), math.floor(last) + 1)


def _figure(value: float) -> str:
    """Return a value with three decimals at most and no zero before the point, as shops write it."""
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def _polygon(line: Line) -> QPolygonF:
    return polygon(line.columns, line.rows)


def _placed(shape: Floats, projection: Projection) -> QPolygonF:
    return QPolygonF(
        [QPointF(float(projection.across(z)), float(projection.down(r))) for z, r in shape.tolist()]
    )


_TURN = 0.4  # degrees per pixel
_STEP = 10.0  # degrees per key press
_STEEPEST = 85.0  # maximum rotation from the side view, in degrees
_ROUND = 1.25  # ratio to the radius of the stock


class SolidPane(PartPane):
    """Pane that shows the latest 3D image of the part in the size of the pane."""

    def __init__(self, look: Look, aspect: Aspect, polyline: Polyline, player: PartPlayer) -> None:
        self._azimuth, self._tilt, self._roll = 30.0, 35.0, 0.0
        self._view: SolidView | None = None  # the view of the last request
        super().__init__(look, aspect, polyline, player)

    # --- projection ----------------------------------------------------------------------------------

    def whole(self) -> Projection:
        """Return the projection that shows the whole stock."""
        flat, shown = super().whole(), self.player.played
        if shown is None or (stock := shown.instant.stock) is None:
            return flat
        wide, high = flat.width, max(flat.height - round(3.0 * self.look.u), 1)
        room = _ROUND * stock.radius  # leaves room for the tool
        left = self._left_of(shown, stock)
        scale, centre = fitted_solid(left, stock.front, room, wide, high, self._azimuth)
        return Projection(centre, 0.0, scale, flat.width, flat.height)

    def look_at(self, projection: Projection) -> None:
        """Set the projection and request an image for it."""
        self.projection = projection
        self._want()

    def _want(self) -> None:
        projection = self.projection
        if projection is None or projection.width < 1 or projection.height < 1:
            return
        opening = quarter(self._tilt) if self.aspect is Aspect.OPEN else None
        view = SolidView(self._azimuth, self._tilt, self._roll, projection.scale, projection.z, opening)
        self._view = view
        self.player.look_at(SolidLook(view, projection.width, projection.height))

    def place_of(self, tip: Tip) -> Place | None:
        """Return the position of the tool, and turn the part with a locked C axis."""
        if tip.c is not None and tip.c != self._roll:
            self._roll = tip.c
            self._want()
        return super().place_of(tip)

    # --- navigation ----------------------------------------------------------------------------------

    def drag(self, by: QPointF) -> None:
        """Turn the part by a drag, in pixels."""
        self._turn(by.x() * _TURN, by.y() * _TURN)

    def pan(self, across: int, down: int) -> None:
        """Turn the part by steps, for the pan keys."""
        self._turn(-across * _STEP, -down * _STEP)

    def show_spot(self, z: float, x: float) -> None:
        """Do nothing, because measuring is not possible in this pane."""

    def _turn(self, across: float, down: float) -> None:
        self._azimuth = min(max(self._azimuth - across, -_STEEPEST), _STEEPEST)
        self._tilt = (self._tilt + down + 180.0) % 360.0 - 180.0
        self._want()

    def magnify(self, factor: float, at: QPointF) -> None:
        """Magnify the view by a factor around a column. The axis remains in the middle."""
        if self.projection is not None:
            self.by_hand = True
            across = (at - self.room.topLeft()).x()
            self.look_at(self.projection.zoomed(factor, across, self.projection.height / 2))

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """Draw the latest image. The painter's origin is the corner of the pane."""
        shown = self.player.played
        if shown is not None and shown.image is not None:
            image = shown.image
            high, wide = image.shape
            painter.drawImage(
                QPointF(0, 0), QImage(image.tobytes(), wide, high, 4 * wide, QImage.Format.Format_ARGB32)
            )

    def draw_run(self, painter: QPainter) -> None:
        """Draw the travel limits of the machine in the turning plane. The image includes the tool."""
        shown, view, projection = self.player.played, self._view, self.projection
        if shown is None or shown.instant.reach is None or view is None or projection is None:
            return
        (z0, x0), (z1, x1) = shown.instant.reach
        # In the frame of the part, the operator's side is at 180 degrees minus C.
        places = [[x, z, 180.0 - view.roll] for z, x in ((z0, x0), (z1, x0), (z1, x1), (z0, x1), (z0, x0))]
        wide, high = (
            (self.projection.width, self.projection.height) if self.projection is not None else (1, 1)
        )
        corners = view.on_screen(np.array(places), wide, high)
        draw_reach(painter, self.look, [QPointF(x, y) for x, y in corners.tolist()])


def quarter(tilt: float) -> tuple[float, float]:
    """Return the start and end angle of the removed quarter, in degrees from the viewer towards the top.

    One edge is in the turning plane on the operator's side, where the tool is. The other edge is
    perpendicular to it, on the visible side.
    """
    first = -tilt if tilt >= 0.0 else -tilt - 90.0
    return first, first + 90.0
