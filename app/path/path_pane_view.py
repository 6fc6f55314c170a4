"""Panes of the path view: the visible area of a path, with zoom, pan and the tool position."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPolygonF

from app.path.measuring import farthest, point_at
from app.path.path_aspects import OF_PART, Aspect, Tip, View, polyline_of, views_of
from app.path.path_layers_view import Ink, Layers, polygon, stroke_run
from app.path.path_picture import Picture, face_point
from app.path.path_projection import Projection, boxed, fitted, runs, travelled
from app.path.path_stock_view import Blank, blank_of, draw_blank
from app.path.polyline import Bounds, Polyline
from app.screen.look import Look

if TYPE_CHECKING:
    from app.path.part_player import PartPlayer

ZOOM_STEP = 1.25
PAN_STEP = 0.1  # ratio to the width of the pane
MARGIN = 1.4  # units around the fitted path

Place = tuple[float, float]
PICK = 1.6  # units: maximum distance from a line at which a touch selects the line
RING = 6.0  # units around a face: room for the circle of the part and its angles
MOST_MARKED = 20_000  # maximum number of points of a line that are drawn thick


class Pane:
    """One pane of the path view. Positions are widget pixels, and drawings are relative to the pane.

    z and x are the coordinates of the viewed plane. ``player`` is the player of the part, where the part is
    shown.
    """

    player: PartPlayer | None = None

    def __init__(
        self, look: Look, aspect: Aspect, polyline: Polyline, before: Polyline | None = None
    ) -> None:
        self.look, self.aspect = look, aspect
        self.room = QRectF()
        self.also: tuple[Place, ...] = ()  # points that must be visible together with the whole path
        self.by_hand = False  # set when the user zooms or pans
        self.projection: Projection | None = None
        self.polyline, self.before = polyline, before
        self._blank = self._blank_below()
        self.apart = farthest(before, polyline) if before is not None else None
        self._layers: Layers | None = None
        self._block = 0
        self._place: Place | None = None  # position of the tip; None until the first position is set
        self._stood: Place | None = None
        self.marked: list[tuple[int, int]] = []  # ranges of points

    # --- projection and path -------------------------------------------------------------------------

    def take(self, polyline: Polyline, before: Polyline | None) -> None:
        """Show another path. The projection remains if the user adjusted it."""
        self.polyline, self.before, self._block, self.marked = polyline, before, 0, []
        self._blank = self._blank_below()
        self.apart = farthest(before, polyline) if before is not None else None
        if self.by_hand and self.projection is not None:
            self.look_at(self.projection)
        else:
            self.fit()

    def _blank_below(self) -> Blank | None:
        """Return the stock and clamping that are drawn below the path, or None."""
        picture = self.polyline
        wanted = self.aspect is Aspect.PATH and self.before is None
        return blank_of(picture) if wanted and isinstance(picture, Picture) else None

    def whole(self) -> Projection:
        """Return the projection that shows the part, all cuts near it, and the path before a change.

        The chuck uses the width that remains.
        """
        fit = boxed if self.aspect is Aspect.SIDE else fitted
        bounds, blank = self.polyline.bounds, self._blank
        if blank is not None:
            bounds = blank.cuts_seen(bounds)
        if self.before is not None:
            bounds = _around(bounds, self.before.bounds)
        for z, x in self.also:
            bounds = _around(bounds, (z, z, x, x))
        margin = (RING if self.aspect is Aspect.FACE else MARGIN) * self.look.u
        whole = fit(bounds, int(self.room.width()), int(self.room.height()), margin)
        if blank is None or blank.chuck_from is None:
            return whole
        free = self.room.width() - 2 * margin - (bounds[1] - bounds[0]) * whole.scale
        wanted = max(0.0, bounds[0] - blank.chuck_from) * whole.scale
        return whole.moved(max(0.0, min(free, wanted)) / 2, 0.0)

    def restart(self) -> None:
        """Draw the same view again, with new colors."""
        if self.projection is not None:
            self.look_at(self.projection)

    def look_at(self, projection: Projection) -> None:
        """Set the projection and redraw the pane."""
        self.projection = projection
        blank = self._blank
        ground = None
        if blank is not None:
            ground = partial(draw_blank, look=self.look, blank=blank, projection=projection)
        self._layers = Layers(self.look, self.polyline, projection, self.before, ground)
        self._layers.want(self._block - 1)
        self._layers.advance()

    def block_at(self, at: QPointF) -> int:
        """Return the block that is drawn at or near a widget position, or 0 without a block."""
        z, x = self.here(at)
        point = point_at(self.polyline, z, x, PICK * self.look.u * self.pixel)
        return 0 if point is None else self.polyline.block_of_point(point)

    # --- navigation ----------------------------------------------------------------------------------

    def lay(self, room: QRectF) -> None:
        """Set the room of the pane. A changed size shows the whole path again."""
        if room != self.room:
            self.room = room
            self.fit()

    def fit(self) -> None:
        """Show the whole path."""
        self.by_hand = False
        self.look_at(self.whole())

    def include(self, places: Sequence[Place]) -> None:
        """Set the points that must be visible together with the whole path."""
        if tuple(places) != self.also:
            self.also = tuple(places)
            if not self.by_hand and self.projection is not None:
                self.fit()

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Zoom in (positive steps) or out, around a widget position, the largest difference or the middle."""
        self.magnify(ZOOM_STEP**steps, at if at is not None else self._middle())

    def _middle(self) -> QPointF:
        if self.apart is not None and self.projection is not None:
            at = self.room.topLeft() + self.spot(self.apart.z, self.apart.x)
            if self.room.contains(at):
                return at
        return self.room.center()

    def magnify(self, factor: float, at: QPointF) -> None:
        """Magnify by a factor. The path under the position ``at`` stays in place."""
        if self.projection is not None:
            self.by_hand = True
            at = at - self.room.topLeft()
            self.look_at(self.projection.zoomed(factor, at.x(), at.y()))

    def pan(self, across: int, down: int) -> None:
        """Move the visible area to the right and down by a number of steps."""
        step = PAN_STEP * self.room.width()
        self.drag(QPointF(-across * step, -down * step))

    def drag(self, by: QPointF) -> None:
        """Move the picture by a drag, in pixels."""
        if self.projection is not None:
            self.by_hand = True
            self.look_at(self.projection.moved(by.x(), by.y()))

    # --- coordinates ---------------------------------------------------------------------------------

    @property
    def pixel(self) -> float:
        """Size of one pixel in millimeters."""
        return 1.0 / self.projection.scale if self.projection is not None else 1.0

    def spot(self, z: float, x: float) -> QPointF:
        """Return the pane position of a point of the plane, in pixels from the corner of the pane."""
        assert self.projection is not None
        return QPointF(float(self.projection.across(z)), float(self.projection.down(x)))

    def here(self, at: QPointF) -> Place:
        """Return the z and x of the plane at a widget position."""
        projection, room = self.projection, self.room
        assert projection is not None
        z = projection.z + (at.x() - room.x() - projection.width / 2) / projection.scale
        return z, projection.x + (at.y() - room.y() - projection.height / 2) / projection.scale

    def sight(self) -> Bounds:
        """Return the visible area: minimum z, maximum z, minimum x, maximum x."""
        (z0, x0), (z1, x1) = self.here(self.room.topLeft()), self.here(self.room.bottomRight())
        return z0, z1, x0, x1

    def show_spot(self, z: float, x: float) -> None:
        """Pan as far as necessary to make a point visible."""
        at, room = self.spot(z, x), self.room
        edge = MARGIN * self.look.u
        over = QPointF(
            min(0.0, at.x() - edge) + max(0.0, at.x() - room.width() + edge),
            min(0.0, at.y() - edge) + max(0.0, at.y() - room.height() + edge),
        )
        if not over.isNull():
            self.drag(-over)

    # --- moving parts --------------------------------------------------------------------------------

    def stand(self, block: int, place: Place | None, stood: Place | None = None) -> None:
        """Set the active block and the tip position, in the z and x of the polyline.

        ``stood`` is the position where an interrupted block stopped.
        """
        if self._layers is not None and block != self._block:
            self._layers.want(block - 1)
        self._block, self._place = block, place
        self._stood = stood

    def end_of(self, block: int) -> Place | None:
        """Return the end of a block, or the end of the last earlier block that is drawn in this pane."""
        at = max(0, self.polyline.points_done(block) - 1)
        return (
            (float(self.polyline.z[at]), float(self.polyline.x[at])) if len(self.polyline.z) else self._place
        )

    def place_of(self, tip: Tip) -> Place | None:
        """Return the position of the machine's tip in this pane.

        A face retains its last position while C turns as the spindle.
        """
        if self.aspect is Aspect.PATH or self.aspect in OF_PART:
            return tip.z, tip.x
        if tip.c is None:
            return self._place
        if self.aspect is Aspect.FACE:
            return face_point(tip.x, tip.c, tip.h)
        return tip.z, -tip.c * self.polyline.round

    def mark(self, blocks: list[tuple[int, int]]) -> None:
        """Draw blocks as thick lines. Each range is (first, last), inclusive, counted from 1."""
        first = self.polyline.first
        ranges = [(int(first[a - 1]), int(first[b])) for a, b in blocks]
        self.marked = [(a, min(b, a + MOST_MARKED)) for a, b in ranges if b > a]

    def advance(self) -> bool:
        """Draw for a few milliseconds at most, and return whether anything changed."""
        return self._layers is not None and self._layers.advance()

    @property
    def complete(self) -> bool:
        """Whether everything requested is drawn."""
        return self._layers is not None and self._layers.complete

    # --- drawing -------------------------------------------------------------------------------------

    def draw_path(self, painter: QPainter) -> None:
        """Draw the cached image of the path. The painter's origin is the corner of the pane."""
        if self._layers is not None:
            painter.drawImage(QPointF(0, 0), self._layers.image)

    def draw_run(self, painter: QPainter) -> None:
        """Draw the marked line, the active block and the tip, or the largest difference of two pictures."""
        if self.projection is None:
            return
        self._draw_marked(painter, self.projection)
        if self.before is None:
            self._under_way(painter, self.projection)
            self._tool_tip(painter)
        elif self.apart is not None and self.apart.distance:
            painter.setPen(self.look.pen("text", 0.2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(self.spot(self.apart.z, self.apart.x), 1.4 * self.look.u, 1.4 * self.look.u)

    def _draw_marked(self, painter: QPainter, projection: Projection) -> None:
        pens = Ink.MARKED.pens(self.look)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for start, end in self.marked:
            for run in runs(self.polyline, projection, start, end):
                painter.setPen(pens[run.stroke])
                stroke_run(painter, run)

    def _under_way(self, painter: QPainter, projection: Projection) -> None:
        """Draw the finished part of the active block."""
        if not self._block or self._place is None:
            return
        if self._stood is not None and self.aspect is not Aspect.PATH:
            return  # On a face or a side, the C position of the interruption is not known.
        found = travelled(self.polyline, projection, self._block, *(self._stood or self._place))
        if found is not None:
            painter.setPen(Ink.DONE.pens(self.look)[found.stroke])
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawPolyline(polygon(found.columns, found.rows))

    def _tool_tip(self, painter: QPainter) -> None:
        if self._place is None:
            return
        look, u = self.look, self.look.u
        at = self.spot(*self._place)
        painter.setPen(look.pen("panel", 0.2))
        painter.setBrush(look.colour("tip"))
        if self.aspect is not Aspect.PATH:  # A mill is viewed along its axis.
            painter.drawEllipse(at, 0.7 * u, 0.7 * u)
            return
        side = 1.0 if self._place[1] >= 0 else -1.0
        body = [at, at + QPointF(1.5 * u, 1.3 * side * u), at + QPointF(0.2 * u, 3.2 * side * u)]
        painter.drawPolygon(QPolygonF([*body, at + QPointF(-1.1 * u, 1.6 * side * u)]))


def _around(one: Bounds, other: Bounds) -> Bounds:
    """Return the bounding box of two boxes."""
    low, high = tuple(map(min, one, other)), tuple(map(max, one, other))
    return low[0], high[1], low[2], high[3]


Make = Callable[[Aspect, Polyline, Polyline | None], Pane]
LEAST = 40  # pixels: minimum width of a layout


class Panes:
    """Panes of ``picture`` and, for a comparison, of the picture ``before`` the change.

    ``keeps`` retains adjusted projections when the picture changes. ``make`` creates a pane.
    """

    def __init__(self, keeps: bool, make: Make, *, with_part: bool = False) -> None:
        self._keeps, self._make, self._with_part = keeps, make, with_part
        self.picture: Picture | None = None
        self.before: Picture | None = None
        self.now: list[Pane] = []
        self._views: list[View] = []
        self._view = 0
        self._room = QRectF()

    def show(self, picture: Picture | None, before: Picture | None) -> None:
        """Set the pictures. The present view remains if it still exists."""
        self.picture, self.before = picture, before
        with_part = self._with_part and before is None
        views = views_of(picture, part=with_part) if picture is not None else []
        if views != self._views:
            self._views, self._view = views, 0
        self._fill()

    @property
    def several(self) -> bool:
        """Whether more than one view exists."""
        return len(self._views) > 1

    @property
    def choices(self) -> int:
        """Number of views."""
        return len(self._views)

    def next_view(self) -> None:
        """Switch to the next view."""
        self._view = (self._view + 1) % max(1, len(self._views))
        self._fill()

    def lay(self, room: QRectF) -> None:
        """Divide the room among the panes."""
        self._room = room
        if room.width() <= LEAST or not self.now:
            return
        wide = room.width() / len(self.now)
        for number, pane in enumerate(self.now):
            box = QRectF(room.x() + number * wide, room.y(), wide, room.height())
            pane.lay(box.toRect().toRectF())

    def at(self, place: QPointF) -> Pane | None:
        """Return the pane at a widget position, or None."""
        return next((pane for pane in self.now if pane.room.contains(place)), None)

    def advance(self) -> bool:
        """Draw for a few milliseconds at most, and return whether anything changed."""
        drawn = [pane.advance() for pane in self.now]
        return any(drawn)

    def _fill(self) -> None:
        aspects = self._views[self._view] if self._views else ()
        kept = {pane.aspect: pane for pane in self.now} if self._keeps else {}
        panes = []
        for aspect in aspects:
            polyline, before = polyline_of(self.picture, aspect), polyline_of(self.before, aspect)
            assert polyline is not None
            pane = kept.get(aspect)
            if pane is None:
                pane = self._make(aspect, polyline, before)
            else:
                pane.take(polyline, before)
            panes.append(pane)
        self.now = panes
        self.lay(self._room)
