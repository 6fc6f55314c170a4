"""What holds the stock: the outline of chuck or collet, for what may run into it and for the picture."""

from __future__ import annotations

from dataclasses import dataclass

from core.part.stock import Point, Stock

_BEHIND = 100.0  # mm of body behind its front


@dataclass(frozen=True, slots=True)
class Clamping:
    """Chuck or collet in the part's frame, mm: its foremost face stands ``stick_out`` behind part zero.

    ``jaws`` is how far jaws, or the nose of a collet, stand before the body. ``max_rpm`` 0: not stated.
    """

    diameter: float
    stick_out: float
    jaws: float = 0.0
    jaw_diameter: float = 0.0
    max_rpm: float = 0.0

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
