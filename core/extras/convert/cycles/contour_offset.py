"""Contours of the LinuxCNC cycles G70 to G72, and their offset by the allowance of the cycle.

A point is a complex number in mm. In the coordinate system of a cycle, the contour runs toward smaller real
parts, and the tool approaches it toward smaller imaginary parts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt

_SAME = 1e-6  # mm
_WIDEST_GAP = 0.01  # program units; wider gaps between offset segments are closed with an arc
_SHORTEST = 0.001  # program units


class OffsetError(Exception):
    """An error raised if a segment disappears when the contour is offset."""


@dataclass(slots=True)
class Segment:
    """A line, or an arc about ``center``."""

    start: complex
    end: complex
    center: complex | None = None
    is_ccw: bool = False

    @property
    def size(self) -> float:
        """Return the length of a line. For an arc, return its chord or its radius, whichever is smaller."""
        chord = abs(self.end - self.start)
        return chord if self.center is None else min(chord, abs(self.start - self.center))

    def copy(self) -> Segment:
        """Return a copy of the segment."""
        return Segment(self.start, self.end, self.center, self.is_ccw)

    def shift(self, distance: float) -> None:
        """Move the segment sideways. Raises OffsetError if an arc becomes too small."""
        if self.center is None:
            side = 1j * distance * (self.start - self.end) / abs(self.start - self.end)
            self.start, self.end = self.start + side, self.end + side
            return
        radius = abs(self.start - self.center)
        factor = (radius + (distance if self.is_ccw else -distance)) / radius
        if factor <= 0.0:
            raise OffsetError
        self.start = self.center + factor * (self.start - self.center)
        self.end = self.center + factor * (self.end - self.center)


def offset_contour(contour: Sequence[Segment], distance: float, unit: float) -> list[Segment]:
    """Return the contour offset by ``distance`` mm.

    An outer corner becomes an arc. At an inner corner, the segments end at their intersection. As in
    LinuxCNC, the contour is offset in steps of at most half of the smallest segment. The size of these
    steps decides whether a narrow gap becomes an arc. ``unit`` is the length unit of the program in mm.
    Raises OffsetError if a segment disappears.
    """
    found = [each.copy() for each in contour]
    done = 0.0
    sign = 1.0 if distance > 0.0 else -1.0
    while abs(distance - done) > _SAME * _SAME:
        step = sign * min(*(each.size / 2.0 for each in found), abs(distance - done))
        _offset_once(found, step, unit)
        done += step
    for one, other in pairwise(found):
        one.end = other.start = (one.end + other.start) / 2.0
    return found


def _offset_once(found: list[Segment], step: float, unit: float) -> None:
    corners = [each.end for each in found]
    for each in found:
        each.shift(step)
    for index in range(len(found) - 1, 0, -1):
        gap = (found[index - 1].end - found[index].start).real
        if gap > _WIDEST_GAP * unit:
            arc = Segment(found[index - 1].end, found[index].start, corners[index - 1], step > 0.0)
            found.insert(index, arc)
    for one, other in pairwise(found):
        _join(one, other)
    for each in found:
        if each.size < _SHORTEST * unit or (each.end - each.start).real > _SHORTEST * unit:
            raise OffsetError


def _join(one: Segment, other: Segment) -> None:
    """Move the end of one segment and the start of the next segment to their nearest intersection."""
    if abs(one.end - other.start) < _SAME:
        return
    points = _intersect(one, other)
    if not points:
        raise OffsetError
    one.end = other.start = min(points, key=lambda each: abs(each - other.start))


def _intersect(one: Segment, other: Segment) -> list[complex]:
    if one.center is None and other.center is None:
        along, across = one.end - one.start, other.end - other.start
        turn = (along.conjugate() * across).imag
        if abs(turn) < _SAME * _SAME:
            return []
        share = ((other.start - one.start).conjugate() * across).imag / turn
        return [one.start + share * along]
    if one.center is None or other.center is None:
        line, arc = (one, other) if one.center is None else (other, one)
        return _intersect_line(line, arc)
    distance = abs(other.center - one.center)
    first, second = abs(one.start - one.center), abs(other.start - other.center)
    if distance < _SAME:
        return []
    foot = (distance * distance + first * first - second * second) / (2.0 * distance)
    half = sqrt(max(first * first - foot * foot, 0.0))
    axis = (other.center - one.center) / distance
    return [one.center + axis * complex(foot, side) for side in (half, -half)]


def _intersect_line(line: Segment, arc: Segment) -> list[complex]:
    """Return the intersections of a line with the circle of an arc.

    If the line does not reach the circle, its point nearest to the center is returned twice.
    """
    assert arc.center is not None
    axis = (line.end - line.start) / abs(line.end - line.start)
    local = (arc.center - line.start) / axis
    half = sqrt(max(abs(arc.start - arc.center) ** 2 - local.imag * local.imag, 0.0))
    return [line.start + axis * (local.real + side) for side in (half, -half)]
