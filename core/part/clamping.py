"""What holds the stock: chuck or collet, and tailstock; their outlines, for checks and pictures."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.part.stock import Point, Stock

_BEHIND = 100.0  # mm of body behind its front
_QUILL = 60.0  # mm of quill behind the cone of its centre


@dataclass(frozen=True, slots=True)
class Clamping:
    """Chuck or collet in the part's frame, mm: its foremost face stands ``stick_out`` behind part zero.

    ``jaws`` is how far jaws, or the nose of a collet, stand before the body. ``max_rpm`` 0: not stated.
    ``quill`` is the diameter of a tailstock's quill, 0: there is none; the tip of its centre, ``point``
    degrees, stands at Z ``centre``.
    """

    diameter: float
    stick_out: float
    jaws: float = 0.0
    jaw_diameter: float = 0.0
    max_rpm: float = 0.0
    quill: float = 0.0
    point: float = 60.0
    centre: float = 0.0

    @property
    def outline(self) -> tuple[Point, ...]:
        """Z and r of its outside, Z rising."""
        face, body = -self.stick_out, -self.stick_out - self.jaws
        front = ((body, self.jaw_diameter / 2), (face, self.jaw_diameter / 2)) if self.jaws else ()
        return ((body - _BEHIND, self.diameter / 2), (body, self.diameter / 2), *front)

    def around(self, stock: Stock) -> Stock:
        """Its metal around the stock that it holds."""
        inside = min(stock.radius, self.diameter / 2, (self.jaw_diameter or self.diameter) / 2)
        back, front = self.outline[0][0], self.outline[-1][0]
        return Stock("", self.outline, ((back, inside), (front, inside)))

    @property
    def tailstock(self) -> Stock | None:
        """Centre and quill, None where there is none."""
        if not self.quill:
            return None
        radius = self.quill / 2.0
        cone = self.centre + radius / math.tan(math.radians(self.point / 2.0))
        return Stock("", ((self.centre, 0.0), (cone, radius), (cone + _QUILL, radius)))
