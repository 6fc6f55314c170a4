"""Arcs in the plane of X and Z, mm. Seen from above: Z+ to the right, X+ down, so clockwise is G02."""

from __future__ import annotations

from math import hypot, sqrt

from core.geometry.extent import arc_sweep

Point = tuple[float, float]
"""X as a radius, Z; mm."""


def centre_from_radius(start: Point, end: Point, radius: float, *, clockwise: bool) -> Point:
    """Centre of the arc of at most 180 degrees from start to end.

    A chord longer than the diameter gives its middle. Raises ValueError for a chord of no length.
    """
    dx, dz = end[0] - start[0], end[1] - start[1]
    chord = hypot(dx, dz)
    if chord == 0.0:
        raise ValueError("an arc given by its radius needs two different ends")
    rise = sqrt(max(radius * radius - chord * chord / 4, 0.0)) / chord
    side = rise if clockwise else -rise  # the centre of a clockwise arc is to the right of the way
    return (start[0] + end[0]) / 2 + side * dz, (start[1] + end[1]) / 2 - side * dx


def arc_length(start: Point, end: Point, centre: Point, *, clockwise: bool) -> float:
    """Length of an arc; where the radii at its ends differ a little, of the spiral between them."""
    first = hypot(start[0] - centre[0], start[1] - centre[1])
    last = hypot(end[0] - centre[0], end[1] - centre[1])
    _, sweep = arc_sweep(*start, *end, *centre, clockwise)
    return (first + last) / 2 * abs(sweep)
