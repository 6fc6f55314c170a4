"""Sketch of a shape: outlines and dimensions, with Z to the right and the radius upward."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Outline:
    """A polyline with a role: ``part``, ``cut`` (the surface to be cut), ``tool`` or ``axis``."""

    points: tuple[Point, ...]
    role: str = "part"
    is_closed: bool = False


@dataclass(frozen=True, slots=True)
class Dimension:
    """A dimension from ``start`` to ``end``, drawn at ``line_distance`` from these points.

    If ``end`` is None, only the number is drawn, at ``start``. ``field_label`` is the label of the input
    field with the value. ``prefix`` is a symbol in front of the number.
    """

    field_label: str
    start: Point
    end: Point | None = None
    line_distance: float = 0.0
    prefix: str = ""


@dataclass(frozen=True, slots=True)
class Sketch:
    """Outlines and dimensions in any unit; the spindle axis is at radius 0."""

    outlines: tuple[Outline, ...] = ()
    dimensions: tuple[Dimension, ...] = field(default=())


def make_sketch(*outlines: Outline, dimensions: Iterable[Dimension] = ()) -> Sketch:
    """Return a sketch with these outlines, their dimensions and the spindle axis."""
    ends = [p[0] for each in outlines for p in each.points]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    room = 0.05 * (high - low or 1.0)
    axis = Outline(((low - room, 0.0), (high + room, 0.0)), "axis")
    return Sketch((axis, *outlines), tuple(dimensions))


def make_part_outline(*points: Point) -> Outline:
    """Return the outline of the part as a closed polyline."""
    return Outline(points, "part", is_closed=True)


def make_cut_outline(*points: Point) -> Outline:
    """Return the outline of the surface that the shape cuts."""
    return Outline(points, "cut")


def make_tool_outline(*points: Point) -> Outline:
    """Return the outline of the tool as a closed polyline."""
    return Outline(points, "tool", is_closed=True)


def make_turned_outlines(profile: Sequence[Point], bar_diameter: float) -> tuple[Outline, ...]:
    """Return the outlines of a turned profile: the part with the remaining bar, and the cut.

    ``bar_diameter`` is the diameter of the bar.
    """
    back = min(z for z, _ in profile)
    deep = 0.3 * max(abs(back), bar_diameter / 2.0, 0.1)
    face = profile[0][0]
    solid = [
        (face, 0.0),
        *profile,
        (back, bar_diameter / 2.0),
        (back - deep, bar_diameter / 2.0),
        (back - deep, 0.0),
    ]
    return Outline(tuple(solid), "part", is_closed=True), Outline(tuple(profile), "cut")
