"""Elements of the contour of a roughing cycle, and the sections that a pass must cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, hypot, pi, sin, sqrt

_SAME = 1e-6  # mm
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class ContourPiece:
    """A line or arc of the contour of a roughing cycle.

    The first coordinate of a point is in the direction of depth, and the second is along the passes.
    """

    start: Point
    end: Point
    center: Point | None = None
    is_clockwise: bool = False

    def get_point(self, fraction: float) -> Point:
        """Return the point at a fraction of the length of the piece, from 0 to 1."""
        if self.center is None:
            return (
                self.start[0] + (self.end[0] - self.start[0]) * fraction,
                self.start[1] + (self.end[1] - self.start[1]) * fraction,
            )
        angle = self._angle(self.start) + self._sweep(self.end) * self._sense * fraction
        radius = hypot(self.start[0] - self.center[0], self.start[1] - self.center[1])
        return self.center[0] + radius * sin(angle), self.center[1] + radius * cos(angle)

    def find_crossing_fractions(self, level: float, axis: int = 0) -> list[float]:
        """Return the fractions of the length at which the piece crosses a coordinate.

        ``level`` is a depth if ``axis`` is 0, or a coordinate along the passes if ``axis`` is 1.
        """
        if self.center is None:
            step = self.end[axis] - self.start[axis]
            share = (level - self.start[axis]) / step if abs(step) > _SAME else -1.0
            return [share] if 0.0 < share < 1.0 else []
        radius = hypot(self.start[0] - self.center[0], self.start[1] - self.center[1])
        off = level - self.center[axis]
        if abs(off) > radius:
            return []
        half = sqrt(radius * radius - off * off)
        other = [self.center[1 - axis] + sign * half for sign in (1.0, -1.0)]
        points = [(level, each) if axis == 0 else (each, level) for each in other]
        whole = self._sweep(self.end)
        found = [self._sweep(each) / whole for each in points] if whole else []
        return sorted(share for share in found if 0.0 < share < 1.0)

    def find_extremes(self, axis: int) -> list[float]:
        """Return the largest and smallest coordinates of an arc that are not at its ends.

        The coordinates are depths if ``axis`` is 0, or coordinates along the passes if ``axis`` is 1.
        """
        if self.center is None:
            return []
        radius = hypot(self.start[0] - self.center[0], self.start[1] - self.center[1])
        tops = [self.center[axis] + sign * radius * (1.0 - 1e-12) for sign in (1.0, -1.0)]
        return [each for each in tops if self.find_crossing_fractions(each, axis)]

    @property
    def _sense(self) -> float:
        return 1.0 if self.is_clockwise else -1.0

    def _angle(self, point: Point) -> float:
        assert self.center is not None
        return atan2(point[0] - self.center[0], point[1] - self.center[1])

    def _sweep(self, point: Point) -> float:
        """Return the angle from the start of an arc to a point, along the arc, from 0 to 2 pi."""
        return (self._sense * (self._angle(point) - self._angle(self.start))) % (2 * pi)


def find_deeper_sections(
    pieces: Sequence[ContourPiece], level: float, depth_sign: float
) -> list[tuple[float | None, float]]:
    """Return the start and end of each section of the contour that is deeper than ``level``.

    They are coordinates along the passes. The start is None if the contour already begins deeper than
    ``level``; the pass then begins at the start point of the cycle.
    """
    found: list[tuple[float | None, float]] = []
    inside = False
    for number, piece in enumerate(pieces):
        for low, high in pairwise([0.0, *piece.find_crossing_fractions(level), 1.0]):
            if depth_sign * (piece.get_point((low + high) / 2)[0] - level) <= _SAME:
                inside = False
                continue
            end = piece.get_point(high)[1]
            if inside:
                found[-1] = found[-1][0], end
            else:
                found.append((None if number == 0 and low == 0.0 else piece.get_point(low)[1], end))
            inside = True
    return found


def has_reversal(pieces: Sequence[ContourPiece], travel_sign: float) -> bool:
    """Return whether the contour turns back toward the start of the passes, as in an undercut."""
    farthest = travel_sign * pieces[0].start[1]
    for piece in pieces:
        for each in (*piece.find_extremes(1), piece.end[1]):
            if travel_sign * each < farthest - 0.001:
                return True
            farthest = max(farthest, travel_sign * each)
    return False
