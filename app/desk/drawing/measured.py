"""What lies between two points of a picture, in the words and units of the program."""

from __future__ import annotations

import math

from app.desk import formats
from app.desk.drawing.spots import Spot
from app.desk.words import tr

Row = tuple[str, str]


def between_on_path(start: Spot, end: Spot, metric: bool) -> list[Row]:
    """Seen from above: X as diameter and as radius, Z, distance, and the angle to the axis, 0…90 degrees."""
    dz, dx = end.z - start.z, end.x - start.x
    return [
        ("ΔX Ø", formats.length(2 * dx, metric)),
        ("ΔX R", formats.length(dx, metric)),
        ("ΔZ", formats.length(dz, metric)),
        *_straight(dz, dx, metric, tr("TO Z")),
    ]


def between_on_face(start: Spot, end: Spot, metric: bool) -> list[Row]:
    """On the face of the part, in its own X and Y; Y is up."""
    dx, dy = end.z - start.z, start.x - end.x
    return [
        ("ΔX", formats.length(dx, metric)),
        ("ΔY", formats.length(dy, metric)),
        *_straight(dx, dy, metric, tr("TO X")),
    ]


def between_on_side(start: Spot, end: Spot, metric: bool, scale: float) -> list[Row]:
    """On the side unrolled; ``scale`` are mm round the part to a degree of C."""
    dz, way = end.z - start.z, start.x - end.x
    return [
        ("ΔZ", formats.length(dz, metric)),
        ("ΔC", f"{formats.angle(way / scale)}°"),
        (tr("ROUND"), formats.length(way, metric)),
        *_straight(dz, way, metric, tr("TO Z")),
    ]


def place_on_path(spot: Spot, metric: bool) -> list[Row]:
    """Where a point is: X as a diameter, Z."""
    return [("X Ø", formats.length(2 * spot.x, metric)), ("Z", formats.length(spot.z, metric))]


def place_on_face(spot: Spot, metric: bool) -> list[Row]:
    """X and Y of the part, and its distance from the axis."""
    radius = math.hypot(spot.z, spot.x)
    return [
        ("X", formats.length(spot.z, metric)),
        ("Y", formats.length(-spot.x, metric)),
        ("R", formats.length(radius, metric)),
    ]


def place_on_side(spot: Spot, metric: bool, scale: float) -> list[Row]:
    """Z, and C in degrees."""
    return [("Z", formats.length(spot.z, metric)), ("C", f"{formats.angle(-spot.x / scale)}°")]


def _straight(right: float, across: float, metric: bool, to: str) -> list[Row]:
    angle = math.degrees(math.atan2(abs(across), abs(right)))
    return [
        (tr("DISTANCE"), formats.length(math.hypot(right, across), metric)),
        (tr("ANGLE {axis}").format(axis=to), f"{formats.angle(angle)}°"),
    ]
