"""The panes of the part: its section as a drawing, red where something is hit; and the part in space."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QImage, QPainter, QPolygonF

from app.path.part_player import PartPlayer, PlayedInstant, SolidLook
from app.path.path_aspects import Aspect, Tip
from app.path.path_layers_view import polygon
from app.path.path_pane_view import Pane, Place
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
from app.path.polyline import Polyline
from app.screen.look import CENTRE, LEFT, Look, put
from core.part.solid_view import SolidView
from core.part.solid_view import fitted as fitted_solid

_BESIDE = 0.1  # of length and diameter of the stock: room for the tool
_MARGIN = 3.0  # units round the part: for the scales
_TICK = 6.0  # units from one figure of a scale to the next, at least
_STEPS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)


class PartPane(Pane):
    """Shows what the player shows. Everything is drawn anew when the part, the tool or the view changes."""

    player: PartPlayer

    def __init__(self, look: Look, aspect: Aspect, polyline: Polyline, player: PartPlayer) -> None:
        self.player = player
        self._drawn: tuple[PlayedInstant, Projection] | None = None  # what the outlines are of
        self._metal: list[tuple[QPolygonF, list[QPolygonF]]] = []
        self._hits: list[QPolygonF] = []
        self._stock: list[QPolygonF] = []
        self._chuck: list[QPolygonF] = []
        self._fitted = False
        super().__init__(look, aspect, polyline)

    @property
    def metric(self) -> bool:
        """The unit of the program."""
        return isinstance(self.polyline, Picture) and self.polyline.metric

    # --- what is seen --------------------------------------------------------------------------------

    def whole(self) -> Projection:
        """The stock, and what is cut beside it."""
        z0, z1, x0, x1 = self.polyline.bounds
        shown = self.player.played
        if shown is not None and (stock := shown.instant.stock) is not None:
            beside = _BESIDE * (stock.front - stock.back + 2.0 * stock.radius)
            z0, z1, x0, x1 = stock.back, stock.front + beside, 0.0, stock.radius + 0.5 * beside
        room, margin = self.room, _MARGIN * self.look.u
        return fitted((z0, z1, x0, x1), int(room.width()), int(room.height()), margin)

    def look_at(self, projection: Projection) -> None:
        """This is seen from now on."""
        self.projection = projection
        self.player.look_at(None)

    def stand(self, block: int, place: Place | None, stood: Place | None = None) -> None:
        """The run is in a block, its tool at a place of the path; no block: nothing runs."""
        if block and place is not None and (block, place) != (self._block, self._place):
            end = self.end_of(block) or place
            at = stood or place
            self.player.follow(block, (at[0] - end[0], at[1] - end[1]))
        self._block, self._place = block, place

    def advance(self) -> bool:
        """Take up what the worker has made; whether there is anything new."""
        new = self.player.look()
        if self.player.played is not None and not self._fitted:
            self._fitted = True
            if not self.by_hand:
                self.fit()
        return new

    def take(self, polyline: Polyline, before: Polyline | None) -> None:
        """Another program, or the same with another text; its stock may be another one."""
        self._fitted = False
        super().take(polyline, before)

    @property
    def complete(self) -> bool:
        """Whether what is wanted is shown."""
        return not self.player.behind

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """The section; the painter's origin is the corner of the pane."""
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
        """The tool, and the outline of what was hit over all else."""
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
        """How far the machine lets the tip go, where that is in sight."""
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
        """Z along the lower edge, diameters or radii of X at the left, in the unit of the program."""
        look, u = self.look, self.look.u
        painter.setFont(look.font(1.4))
        unit = 1.0 if self.metric else 25.4
        step = next((s for s in _STEPS if s * unit * projection.scale >= _TICK * u), _STEPS[-1])
        bottom, width = float(projection.height), float(projection.width)
        painter.setPen(look.pen("soft", 0.1))
        for value in _ticks(projection.z, width / projection.scale, step * unit):
            at = float(projection.across(value * unit * step))
            painter.drawLine(QPointF(at, bottom), QPointF(at, bottom - 0.6 * u))
            words = _figure(value * step)
            put(painter, QRectF(at - 4 * u, bottom - 2.2 * u, 8 * u, 1.4 * u), CENTRE, words)
        for value in _ticks(projection.x, bottom / projection.scale, step * unit):
            at = float(projection.down(value * unit * step))
            if 1.5 * u < at < bottom - 3.5 * u:
                painter.drawLine(QPointF(0, at), QPointF(0.6 * u, at))
                put(painter, QRectF(0.9 * u, at - u, 8 * u, 2 * u), LEFT, _figure(abs(value * step)))


def draw_reach(painter: QPainter, look: Look, corners: Sequence[QPointF]) -> None:
    """The limits of the machine, as a line of long and short strokes."""
    pen = look.pen("alarm", 0.16)
    pen.setDashPattern([10, 4, 2, 4])
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolyline(list(corners))


def _ticks(middle: float, length: float, step: float) -> range:
    first, last = (middle - length / 2) / step, (middle + length / 2) / step
    return range(math.ceil(first), math.floor(last) + 1)


def _figure(value: float) -> str:
    """As shops write it: no nought before the point."""
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def _polygon(line: Line) -> QPolygonF:
    return polygon(line.columns, line.rows)


def _placed(shape: Floats, projection: Projection) -> QPolygonF:
    return QPolygonF(
        [QPointF(float(projection.across(z)), float(projection.down(r))) for z, r in shape.tolist()]
    )


_TURN = 0.4  # degrees a pixel
_STEP = 10.0  # degrees a key
_STEEPEST = 85.0  # degrees from the side
_ROUND = 1.25  # of the radius


class SolidPane(PartPane):
    """Asks the player for a picture of its own size, and shows the latest that it has."""

    def __init__(self, look: Look, aspect: Aspect, polyline: Polyline, player: PartPlayer) -> None:
        self._azimuth, self._tilt, self._roll = 30.0, 35.0, 0.0
        self._view: SolidView | None = None  # that was asked for last
        super().__init__(look, aspect, polyline, player)

    # --- what is seen --------------------------------------------------------------------------------

    def whole(self) -> Projection:
        """All of the stock."""
        flat, shown = super().whole(), self.player.played
        if shown is None or (stock := shown.instant.stock) is None:
            return flat
        wide, high = flat.width, max(flat.height - round(3.0 * self.look.u), 1)
        room = _ROUND * stock.radius  # for the tool
        scale, centre = fitted_solid(stock.back, stock.front, room, wide, high, self._azimuth)
        return Projection(centre, 0.0, scale, flat.width, flat.height)

    def look_at(self, projection: Projection) -> None:
        """This is seen from now on."""
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
        """The tool's place; C turns the part while it is held."""
        if tip.c is not None and tip.c != self._roll:
            self._roll = tip.c
            self._want()
        return super().place_of(tip)

    # --- looking around ------------------------------------------------------------------------------

    def drag(self, by: QPointF) -> None:
        """The part turns with the finger."""
        self._turn(by.x() * _TURN, by.y() * _TURN)

    def pan(self, across: int, down: int) -> None:
        """The keys that pan turn it by steps."""
        self._turn(-across * _STEP, -down * _STEP)

    def show_spot(self, z: float, x: float) -> None:
        """Nothing is measured here."""

    def _turn(self, across: float, down: float) -> None:
        self._azimuth = min(max(self._azimuth - across, -_STEEPEST), _STEEPEST)
        self._tilt = (self._tilt + down + 180.0) % 360.0 - 180.0
        self._want()

    def magnify(self, factor: float, at: QPointF) -> None:
        """Nearer by a factor; the axis stays in the middle."""
        if self.projection is not None:
            self.by_hand = True
            across = (at - self.room.topLeft()).x()
            self.look_at(self.projection.zoomed(factor, across, self.projection.height / 2))

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """The latest picture; the painter's origin is the corner of the pane."""
        shown = self.player.played
        if shown is not None and shown.image is not None:
            image = shown.image
            high, wide = image.shape
            painter.drawImage(
                QPointF(0, 0), QImage(image.tobytes(), wide, high, 4 * wide, QImage.Format.Format_ARGB32)
            )

    def draw_run(self, painter: QPainter) -> None:
        """The limits of the machine in the plane of turning; the tool is in the picture."""
        shown, view, projection = self.player.played, self._view, self.projection
        if shown is None or shown.instant.reach is None or view is None or projection is None:
            return
        (z0, x0), (z1, x1) = shown.instant.reach
        # (In the part's frame the operator's side lies at 180 degrees less C.)
        places = [[x, z, 180.0 - view.roll] for z, x in ((z0, x0), (z1, x0), (z1, x1), (z0, x1), (z0, x0))]
        wide, high = (
            (self.projection.width, self.projection.height) if self.projection is not None else (1, 1)
        )
        corners = view.on_screen(np.array(places), wide, high)
        draw_reach(painter, self.look, [QPointF(x, y) for x, y in corners.tolist()])


def quarter(tilt: float) -> tuple[float, float]:
    """What is taken out, from and to which angle from the viewer towards the top, degrees.

    One edge lies in the plane of turning on the operator's side, where the tool is; the other stands upright
    on it, on the side that is looked at.
    """
    first = -tilt if tilt >= 0.0 else -tilt - 90.0
    return first, first + 90.0
