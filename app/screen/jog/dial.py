"""A handwheel that is drawn: a finger goes round it, or the mouse's wheel turns it."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainter

from app.screen.fingers import Control
from app.screen.look import CENTRE, Look, put

CLICK = 3.6  # degrees: a hundred clicks a turn
_NOTCH = 120  # of the mouse's wheel, as Qt has it
_SPOKES = 24


class Dial:
    """``turned`` hears of whole clicks, clockwise positive."""

    def __init__(self, turned: Callable[[int], None]) -> None:
        self._turned = turned
        self._angle = 0.0  # as it is drawn, degrees
        self._at = 0.0  # of the finger
        self._rest = 0.0  # degrees that are no click yet

    def control(self, box: QRectF) -> Control:
        """What a finger does on it."""

        def bearing(at: QPointF) -> float:
            away = at - box.center()
            return math.degrees(math.atan2(away.y(), away.x()))

        def down(at: QPointF) -> None:
            self._at, self._rest = bearing(at), 0.0

        def along(at: QPointF) -> None:
            here = bearing(at)
            self._turn((here - self._at + 180.0) % 360.0 - 180.0)
            self._at = here

        return Control(box, down, along)

    def notches(self, delta: int) -> None:
        """The mouse's wheel, by Qt's figure; away from the hand is clockwise."""
        self._turn(CLICK * delta / _NOTCH)

    def draw(self, painter: QPainter, look: Look, box: QRectF, click: str) -> None:
        """The rim with its marks where it stands, and how far a click goes."""
        size = 0.5 * min(box.width(), box.height()) - 0.4 * look.u
        painter.setPen(look.pen("accent", 0.24))
        painter.drawEllipse(box.center(), size, size)
        for spoke in range(_SPOKES):
            angle = math.radians(self._angle + 360.0 * spoke / _SPOKES)
            out = QPointF(math.cos(angle), math.sin(angle))
            inner = 0.72 if spoke == 0 else 0.88
            painter.drawLine(box.center() + out * (inner * size), box.center() + out * size)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(click, 2.4, 1.2 * size, bold=True))
        put(painter, box, CENTRE, click)

    def _turn(self, degrees: float) -> None:
        self._rest += degrees
        clicks = int(self._rest / CLICK)  # towards 0
        if clicks:
            self._rest -= clicks * CLICK
            self._angle += clicks * CLICK
            self._turned(clicks)
