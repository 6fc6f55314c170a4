"""What part of a plane is seen: the whole, or nearer and moved by hand; and where points of it are then."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF

from app.desk.drawing.trail import Bounds
from app.screen.look import Look
from app.screen.path.plot import Frame

ZOOM_STEP = 1.25
PAN_STEP = 0.1  # of the width
MARGIN = 2.8  # units round what is fitted

Place = tuple[float, float]


class Sight:
    """Places are the widget's pixels; z and x are those of the plane."""

    def __init__(self, look: Look) -> None:
        self.look = look
        self.room = QRectF()
        self.also: tuple[Place, ...] = ()  # points that are to be seen with the whole
        self.by_hand = False  # somebody has zoomed or panned
        self.frame: Frame | None = None

    def whole(self) -> Frame:
        """What is seen when nobody looks at a part of it."""
        raise NotImplementedError

    def wanted_near(self) -> Place | None:
        """What one wants to see nearer; None: the middle."""
        return None

    def look_at(self, frame: Frame) -> None:
        """This is seen from now on."""
        self.frame = frame

    # --- looking around ------------------------------------------------------------------------------

    def lay(self, room: QRectF) -> None:
        """Fill this room; another size shows the whole part again."""
        if room != self.room:
            self.room = room
            self.fit()

    def fit(self) -> None:
        """Everything."""
        self.by_hand = False
        self.look_at(self.whole())

    def include(self, places: Sequence[Place]) -> None:
        """Points of the plane that are to be seen with the whole part."""
        if tuple(places) != self.also:
            self.also = tuple(places)
            if not self.by_hand and self.frame is not None:
                self.fit()

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Nearer (positive) or farther, about a point of the widget, what is wanted near or the middle."""
        self.magnify(ZOOM_STEP**steps, at if at is not None else self._middle())

    def _middle(self) -> QPointF:
        wanted = self.wanted_near()
        if wanted is not None and self.frame is not None:
            at = self.room.topLeft() + self.spot(*wanted)
            if self.room.contains(at):
                return at
        return self.room.center()

    def magnify(self, factor: float, at: QPointF) -> None:
        """Nearer by a factor; what is at the point stays there."""
        if self.frame is not None:
            self.by_hand = True
            at = at - self.room.topLeft()
            self.look_at(self.frame.zoomed(factor, at.x(), at.y()))

    def pan(self, across: int, down: int) -> None:
        """Look further right and down by so many steps."""
        step = PAN_STEP * self.room.width()
        self.drag(QPointF(-across * step, -down * step))

    def drag(self, by: QPointF) -> None:
        """The picture goes along with the finger."""
        if self.frame is not None:
            self.by_hand = True
            self.look_at(self.frame.moved(by.x(), by.y()))

    # --- places --------------------------------------------------------------------------------------

    @property
    def pixel(self) -> float:
        """How many mm one is."""
        return 1.0 / self.frame.scale if self.frame is not None else 1.0

    def spot(self, z: float, x: float) -> QPointF:
        """Where a point of the plane is in the pane; pixels from its corner."""
        assert self.frame is not None
        return QPointF(float(self.frame.across(z)), float(self.frame.down(x)))

    def here(self, at: QPointF) -> Place:
        """The plane's z and x at a place of the widget."""
        frame, room = self.frame, self.room
        assert frame is not None
        z = frame.z + (at.x() - room.x() - frame.width / 2) / frame.scale
        return z, frame.x + (at.y() - room.y() - frame.height / 2) / frame.scale

    def sight(self) -> Bounds:
        """What part of the plane is seen: least and greatest z, least and greatest x."""
        (z0, x0), (z1, x1) = self.here(self.room.topLeft()), self.here(self.room.bottomRight())
        return z0, z1, x0, x1

    def show_spot(self, z: float, x: float) -> None:
        """Look aside as far as is needed to see a point."""
        at, room = self.spot(z, x), self.room
        edge = MARGIN * self.look.u
        over = QPointF(
            min(0.0, at.x() - edge) + max(0.0, at.x() - room.width() + edge),
            min(0.0, at.y() - edge) + max(0.0, at.y() - room.height() + edge),
        )
        if not over.isNull():
            self.drag(-over)
