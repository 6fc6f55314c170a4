"""Sketch of a shape: outlines and dimensions, with Z to the right and the radius upward."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Outline:
    """A polyline; ``ink`` is part, cut (the result of the shape), tool or axis."""

    points: tuple[Point, ...]
    ink: str = "part"
    closed: bool = False


@dataclass(frozen=True, slots=True)
class Dim:
    """A dimension from ``a`` to ``b``, drawn at the distance ``away``; without ``b``, a number at ``a``.

    ``word`` is the label of its field. ``before`` is a sign in front of the number.
    """

    word: str
    a: Point
    b: Point | None = None
    away: float = 0.0
    before: str = ""


@dataclass(frozen=True, slots=True)
class Sketch:
    """Outlines and dimensions in any unit; the spindle axis is at radius 0."""

    outlines: tuple[Outline, ...] = ()
    dims: tuple[Dim, ...] = field(default=())


def sketch(*outlines: Outline, dims: Iterable[Dim] = ()) -> Sketch:
    """Return a sketch of these outlines and dimensions, with the spindle axis added."""
    ends = [p[0] for each in outlines for p in each.points]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    room = 0.05 * (high - low or 1.0)
    axis = Outline(((low - room, 0.0), (high + room, 0.0)), "axis")
    return Sketch((axis, *outlines), tuple(dims))


def part(*points: Point) -> Outline:
    """Return the outline of the part, closed along the axis."""
    return Outline(points, "part", closed=True)


def cut(*points: Point) -> Outline:
    """Return the outline that the shape cuts."""
    return Outline(points, "cut")


def tool(*points: Point) -> Outline:
    """Return the closed outline of the tool."""
    return Outline(points, "tool", closed=True)


def turned(profile: Sequence[Point], bar: float) -> tuple[Outline, ...]:
    """Return the outlines of a turned profile: the part including the bar after the profile, and the cut."""
    back = min(z for z, _ in profile)
    deep = 0.3 * max(abs(back), bar / 2.0, 0.1)
    face = profile[0][0]
    solid = [(face, 0.0), *profile, (back, bar / 2.0), (back - deep, bar / 2.0), (back - deep, 0.0)]
    return Outline(tuple(solid), "part", closed=True), Outline(tuple(profile), "cut")
