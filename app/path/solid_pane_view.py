"""The pane of the part in space, whole or a quarter open: turned by a finger, keys and C."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage, QPainter

from app.path.part_pane_view import PartPane, draw_reach
from app.path.part_player import PartPlayer, SolidLook
from app.path.path_aspects import Aspect, Tip
from app.path.path_pane_view import Place
from app.path.path_projection import Projection
from app.path.polyline import Polyline
from app.screen.look import Look
from core.part.solid_view import SolidView, fitted

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
        scale, centre = fitted(stock.back, stock.front, room, wide, high, self._azimuth)
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
