"""Drawings as inline SVG: a window of the Z-X plane in mm, laid out in pixels as a lathe drawing stands.

Z runs to the right, X upwards. What is drawn is figures alone; texts are escaped.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape

Point = tuple[float, float]
"""Z and r, mm."""


@dataclass(slots=True)
class Drawing:
    """A window (z0, r0) to (z1, r1), mm, drawn ``width`` pixels wide or narrower."""

    low: Point
    high: Point
    width: float
    highest: float
    _parts: list[str] = field(default_factory=list)

    @property
    def scale(self) -> float:
        """Pixels a millimetre."""
        wide, high = self.high[0] - self.low[0], self.high[1] - self.low[1]
        return min(self.width / wide, self.highest / high)

    def polygon(self, points: Iterable[Point], look: str) -> None:
        """A closed outline; ``look`` is a class of the page's style."""
        self._parts.append(f'<polygon class="{look}" points="{self._placed(points)}"/>')

    def polyline(self, points: Iterable[Point], look: str) -> None:
        """An open one."""
        self._parts.append(f'<polyline class="{look}" points="{self._placed(points)}"/>')

    def dot(self, point: Point, look: str) -> None:
        """A place."""
        x, y = self._place(point)
        self._parts.append(f'<circle class="{look}" cx="{x}" cy="{y}" r="3.5"/>')

    def axis(self) -> None:
        """The centre line."""
        self.polyline([(self.low[0], 0.0), (self.high[0], 0.0)], "axis")

    def svg(self, title: str) -> str:
        """The drawing; ``title`` is for who cannot see it."""
        scale = self.scale
        wide, high = (self.high[0] - self.low[0]) * scale, (self.high[1] - self.low[1]) * scale
        return (
            f'<svg role="img" width="{wide:.0f}" height="{high:.0f}" viewBox="0 0 {wide:.1f} {high:.1f}">'
            f"<title>{escape(title)}</title>{''.join(self._parts)}</svg>"
        )

    def _placed(self, points: Iterable[Point]) -> str:
        placed: list[tuple[float, float]] = []
        for point in points:
            place = self._place(point)
            if not placed or placed[-1] != place:
                placed.append(place)
        return " ".join(f"{x:g},{y:g}" for x, y in placed)

    def _place(self, point: Point) -> tuple[float, float]:
        scale = self.scale
        return round((point[0] - self.low[0]) * scale, 1), round((self.high[1] - point[1]) * scale, 1)


def window(points: Sequence[Point], margin: float, least: float = 1.0) -> tuple[Point, Point]:
    """The window around points with a margin, mm, at least so wide and high."""
    zs, rs = [z for z, _ in points], [r for _, r in points]
    low, high = (min(zs) - margin, min(rs) - margin), (max(zs) + margin, max(rs) + margin)
    more = [max(least - (b - a), 0.0) / 2 for a, b in zip(low, high, strict=True)]
    return (low[0] - more[0], low[1] - more[1]), (high[0] + more[0], high[1] + more[1])
