"""The cross of a jog pad: one target a direction, to be held by a finger, and the middle between them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF
from PySide6.QtWidgets import QWidget

from app.jog.held_jog import HeldJog
from app.jog.jog_speeds import JogDirection
from app.screen.look import CENTRE, Look, Painter, put
from app.screen.panel import Control, FingerPanel

_LOW = 9.0  # units
Finger = Callable[[str, str, int], None]  # what it is, axis, sign


def draw_arrow(painter: Painter, box: QRectF, to: tuple[int, int], colour: str) -> None:
    """At the side of its target to which it points."""
    size = 0.16 * min(box.width(), box.height())
    centre = box.center() + QPointF(to[0] * 0.30 * box.width(), to[1] * 0.28 * box.height())
    forward, side = QPointF(to[0] * size, to[1] * size), QPointF(to[1] * size, to[0] * size)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.look.colour(colour))
    painter.drawPolygon(QPolygonF([centre + forward, centre - forward + side, centre - forward - side]))


def draw_middle(painter: Painter, box: QRectF, words: tuple[str, str, str]) -> None:
    """What an arrow does now: its kind, the figure, the unit."""
    kind, figure, unit = words
    high, edge = 2.2 * painter.look.u, 0.1 * box.height()
    painter.write(QRectF(box.x(), box.y() + edge, box.width(), high), kind, 1.6, "soft", at=CENTRE)
    put(painter, QRectF(box.x(), box.bottom() - edge - high, box.width(), high), CENTRE, unit)
    painter.write(box, figure, 3.2, "text", at=CENTRE, margin=1.0)


class JogCross(FingerPanel):
    """A slide moves while a finger is on one of its targets."""

    def __init__(
        self,
        look: Look,
        hold: HeldJog,
        directions: Sequence[JogDirection],
        finger: Finger,
        parent: QWidget,
    ) -> None:
        super().__init__(look, parent)
        self._hold, self._directions, self._finger_on = hold, directions, finger
        self.mark = ""  # behind X Y Z where they are those of a tilted plane

    def cross(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the targets into this room; where their middle is."""
        u = self.look.u
        columns = 1 + max(2, *(each.column for each in self._directions))
        wide, high = room.width() / columns, room.height() / 3
        for each in self._directions:
            x, y = room.x() + each.column * wide, room.y() + each.row * high
            self._target(painter, QRectF(x, y, wide - 0.8 * u, high - 0.6 * u), each)
        return QRectF(room.x() + wide, room.y() + high, wide - 0.8 * u, high - 0.6 * u)

    def _target(self, painter: Painter, box: QRectF, way: JogDirection) -> None:
        u, held = self.look.u, self._hold.held
        axis, sign, arrow = way.axis, way.sign, way.arrow
        moving = held is not None and held.axis == axis and held.velocity * sign > 0
        painter.box(
            box.adjusted(0.1 * u, 0.1 * u, -0.1 * u, -0.1 * u),
            "run" if moving else "accent",
            0.24,
            "run" if moving else "key",
        )
        low = (
            box.height() < _LOW * u and arrow[0] == 0
        )  # too low for an arrow over its name: it stands beside
        at = box.adjusted(0.12 * box.width(), 0, -0.62 * box.width(), 0) if low else box
        if arrow != (0, 0):
            draw_arrow(painter, at, arrow, "on_state" if moving else "accent")
        up = 0.0 if low else 0.16
        aside = box.translated(-arrow[0] * 0.16 * box.width(), -arrow[1] * up * box.height())
        mark = self.mark if axis in "XYZ" else ""
        name = f"{way.shown or axis}{mark}{'+' if sign > 0 else '−'}"
        painter.write(aside, name, 3.4, "on_state" if moving else "text", at=CENTRE)
        corner = box.adjusted(0.8 * u, 0.3 * u, 0, 2.4 * u - box.height())
        painter.write(corner, way.label, 1.5, "on_state" if moving else "soft")
        self.controls.append(self._holder(box, axis, sign))

    def _holder(self, box: QRectF, axis: str, sign: int) -> Control:
        """Held from the touch until the finger comes up, or leaves the target."""
        hold = self._hold
        source = f"finger {axis}{sign}"

        def along(at: QPointF) -> None:
            if not box.contains(at):
                hold.release(source)

        return Control(
            box, lambda _at: self._finger_on(source, axis, sign), along, lambda: hold.release(source)
        )
