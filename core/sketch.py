"""The sketch of a shape: outlines and dimensions, of which each is a field. Z to the right, radius up."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Outline:
    """A polyline; ``ink``: part, cut (what this shape makes), tool or axis."""

    points: tuple[Point, ...]
    ink: str = "part"
    closed: bool = False


@dataclass(frozen=True, slots=True)
class Dim:
    """A dimension from ``a`` to ``b``, drawn ``away`` from them; with ``a`` alone its figure stands there.

    ``word`` is that of its field, ``before`` a sign before the figure.
    """

    word: str
    a: Point
    b: Point | None = None
    away: float = 0.0
    before: str = ""


@dataclass(frozen=True, slots=True)
class Sketch:
    """What is drawn, in units of its own; the axis is at radius 0. ``wide``: along Z and radius alike."""

    outlines: tuple[Outline, ...] = ()
    dims: tuple[Dim, ...] = field(default=())


def sketch(*outlines: Outline, dims: Iterable[Dim] = ()) -> Sketch:
    """With the axis drawn."""
    ends = [p[0] for each in outlines for p in each.points]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    room = 0.05 * (high - low or 1.0)
    axis = Outline(((low - room, 0.0), (high + room, 0.0)), "axis")
    return Sketch((axis, *outlines), tuple(dims))


def part(*points: Point) -> Outline:
    """The part, closed along the axis."""
    return Outline(points, "part", closed=True)


def cut(*points: Point) -> Outline:
    """What this shape cuts."""
    return Outline(points, "cut")


def tool(*points: Point) -> Outline:
    """The tool."""
    return Outline(points, "tool", closed=True)


def turned(profile: Sequence[Point], bar: float) -> tuple[Outline, ...]:
    """A profile from the face on, up to the bar behind it."""
    back = min(z for z, _ in profile)
    deep = 0.3 * max(abs(back), bar / 2.0, 0.1)
    face = profile[0][0]
    solid = [(face, 0.0), *profile, (back, bar / 2.0), (back - deep, bar / 2.0), (back - deep, 0.0)]
    return Outline(tuple(solid), "part", closed=True), Outline(tuple(profile), "cut")
