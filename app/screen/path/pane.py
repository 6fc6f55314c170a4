"""One look at one trail: what part of it is seen, its cached images, where the tool stands in it."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainter, QPolygonF

from app.desk.drawing.apart import farthest
from app.desk.drawing.features import point_at
from app.desk.drawing.trail import Bounds, Trail
from app.desk.drawing.turned import face_point
from app.screen.look import Look
from app.screen.path.aspects import Aspect, Tip
from app.screen.path.inks import Ink
from app.screen.path.layers import Layers
from app.screen.path.plot import Frame, boxed, fitted, polygon, runs, stroke_run, travelled
from app.screen.path.scenery import draw_scenery
from app.screen.path.sight import MARGIN, Place, Sight

PICK = 1.6  # units: how near a finger must come to a line to mean it
RING = 6.0  # units round a face: the circle of the part and its angles stand there
MOST_MARKED = 20_000  # points drawn thick, of a line that makes more of them


class Pane(Sight):
    """A part of the path view; places are the widget's pixels, everything drawn is the pane's own."""

    def __init__(self, look: Look, aspect: Aspect, trail: Trail, before: Trail | None = None) -> None:
        super().__init__(look)
        self.aspect = aspect
        self.trail, self.before = trail, before
        self.apart = farthest(before, trail) if before is not None else None
        self._layers: Layers | None = None
        self._block = 0
        self._place: Place | None = None  # of the tip; nobody has told it yet
        self._stood: Place | None = None
        self.marked: list[tuple[int, int]] = []  # ranges of points

    # --- what is seen --------------------------------------------------------------------------------

    def take(self, trail: Trail, before: Trail | None) -> None:
        """Another path in the same place; what is looked at stays if it was chosen by hand."""
        self.trail, self.before, self._block, self.marked = trail, before, 0, []
        self.apart = farthest(before, trail) if before is not None else None
        if self.by_hand and self.frame is not None:
            self.look_at(self.frame)
        else:
            self.fit()

    def whole(self) -> Frame:
        """Everything, the path before a change too."""
        fit = boxed if self.aspect is Aspect.SIDE else fitted
        bounds = self.trail.bounds
        if self.before is not None:
            bounds = _around(bounds, self.before.bounds)
        for z, x in self.also:
            bounds = _around(bounds, (z, z, x, x))
        margin = (RING if self.aspect is Aspect.FACE else MARGIN) * self.look.u
        return fit(bounds, int(self.room.width()), int(self.room.height()), margin)

    def wanted_near(self) -> Place | None:
        """The greatest change."""
        return (self.apart.z, self.apart.x) if self.apart is not None else None

    def restart(self) -> None:
        """The same again, in other colours."""
        if self.frame is not None:
            self.look_at(self.frame)

    def look_at(self, frame: Frame) -> None:
        """This is seen from now on, drawn anew."""
        super().look_at(frame)
        self._layers = Layers(self.look, self.trail, frame, self.before)
        self._layers.want(self._block - 1)
        self._layers.advance()

    def block_at(self, at: QPointF) -> int:
        """The block that was drawn at a place of the widget, or very near to it; 0: none was."""
        z, x = self.here(at)
        point = point_at(self.trail, z, x, PICK * self.look.u * self.pixel)
        return 0 if point is None else self.trail.block_of_point(point)

    # --- what moves ----------------------------------------------------------------------------------

    def stand(self, block: int, place: Place | None, stood: Place | None = None) -> None:
        """The tip, in the trail's own z and x; ``stood``: where the block was broken off."""
        if self._layers is not None and block != self._block:
            self._layers.want(block - 1)
        self._block, self._place = block, place
        self._stood = stood

    def end_of(self, block: int) -> Place | None:
        """Where a block ends, or the last one before it that draws anything here."""
        at = max(0, self.trail.points_done(block) - 1)
        return (float(self.trail.z[at]), float(self.trail.x[at])) if len(self.trail.z) else self._place

    def place_of(self, tip: Tip) -> Place | None:
        """Where the machine's tip is seen here; a face keeps what it showed while C turns as the spindle."""
        if self.aspect is Aspect.PATH:
            return tip.z, tip.x
        if tip.c is None:
            return self._place
        if self.aspect is Aspect.FACE:
            return face_point(tip.x, tip.c, tip.h)
        return tip.z, -tip.c * self.trail.round

    def mark(self, blocks: list[tuple[int, int]]) -> None:
        """Draw these blocks thick: ranges of numbers from 1, the last one in them."""
        first = self.trail.first
        ranges = [(int(first[a - 1]), int(first[b])) for a, b in blocks]
        self.marked = [(a, min(b, a + MOST_MARKED)) for a, b in ranges if b > a]

    def advance(self) -> bool:
        """Draw on for a few milliseconds at most; whether there is anything new."""
        return self._layers is not None and self._layers.advance()

    @property
    def complete(self) -> bool:
        """Whether everything is drawn."""
        return self._layers is not None and self._layers.complete

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: QPainter) -> None:
        """Image, scenery, the marked line, what is under way, the tip. The painter's origin is the corner."""
        frame, layers = self.frame, self._layers
        if frame is None or layers is None:
            return
        painter.drawImage(QPointF(0, 0), layers.image)
        draw_scenery(painter, self.look, self.aspect, frame, self.trail)
        self._draw_marked(painter, frame)
        if self.before is None:
            self._under_way(painter, frame)
            self._tool_tip(painter)
        elif self.apart is not None and self.apart.distance:
            painter.setPen(self.look.pen("text", 0.2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(self.spot(self.apart.z, self.apart.x), 1.4 * self.look.u, 1.4 * self.look.u)

    def _draw_marked(self, painter: QPainter, frame: Frame) -> None:
        pens = Ink.MARKED.pens(self.look)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for start, end in self.marked:
            for run in runs(self.trail, frame, start, end):
                painter.setPen(pens[run.stroke])
                stroke_run(painter, run)

    def _under_way(self, painter: QPainter, frame: Frame) -> None:
        """The part of the present block that lies behind the tip."""
        if not self._block or self._place is None:
            return
        if self._stood is not None and self.aspect is not Aspect.PATH:
            return  # on a face or a side nobody knows any more where C stood
        found = travelled(self.trail, frame, self._block, *(self._stood or self._place))
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
        if self.aspect is not Aspect.PATH:  # a mill is looked at along its axis
            painter.drawEllipse(at, 0.7 * u, 0.7 * u)
            return
        side = 1.0 if self._place[1] >= 0 else -1.0
        body = [at, at + QPointF(1.5 * u, 1.3 * side * u), at + QPointF(0.2 * u, 3.2 * side * u)]
        painter.drawPolygon(QPolygonF([*body, at + QPointF(-1.1 * u, 1.6 * side * u)]))


def _around(one: Bounds, other: Bounds) -> Bounds:
    """The box round two boxes."""
    low, high = tuple(map(min, one, other)), tuple(map(max, one, other))
    return low[0], high[1], low[2], high[3]
