"""Functions shared by the drawing readers: expansion limits, and conversion of curves to arcs."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import NamedTuple, TypeVar

from core.extras.drawings.drawing import MOST_ELEMENTS, DrawingError, bulged, line
from core.geometry.lines_and_arcs import Element, Point
from core.message import Message

SAMPLES = 7  # points of a piece at which it is compared with the curve
_DEEPEST = 14  # largest number of successive halvings
STRAIGHT = 1e-6


class Place(NamedTuple):
    """A point of a curve and the tangent direction there, of any length."""

    at: Point
    way: Point


Curve = Callable[[float], Place]
"""By a parameter from 0 to 1."""


def arcs_of(curve: Curve, tolerance: float, pieces: int = 1) -> Iterator[Element]:
    """Yield tangent arcs that deviate from a curve by at most ``tolerance``.

    The curve is divided into at least ``pieces`` pieces.
    """
    ends = curve(0.0).at, curve(0.5).at, curve(1.0).at
    if not all(math.isfinite(value) for point in ends for value in point):
        # halving cannot help, so the limits check rejects this line
        yield from line(ends[0], (math.nan, math.nan))
        return
    for k in range(pieces):
        yield from _fitted(curve, k / pieces, (k + 1) / pieces, tolerance, 0)


def _fitted(curve: Curve, begin: float, end: float, tolerance: float, depth: int) -> Iterator[Element]:
    a, b = curve(begin), curve(end)
    joint = _joint(a, b)
    close = joint is not None and _off(curve, begin, end, a, joint, b) <= tolerance
    point = not close and _is_point(curve, begin, end, a.at, tolerance)
    if not close and not point and depth < _DEEPEST:
        middle = (begin + end) / 2.0
        yield from _fitted(curve, begin, middle, tolerance, depth + 1)
        yield from _fitted(curve, middle, end, tolerance, depth + 1)
    elif joint is None or point:
        yield from line(a.at, b.at)
    else:
        yield from bulged(a.at, joint, _bulge(a.at, a.way, joint))
        yield from bulged(joint, b.at, -_bulge(b.at, (-b.way[0], -b.way[1]), joint))


def _between(begin: float, end: float) -> Iterator[float]:
    """Yield the parameters at which a piece is compared with the curve."""
    return (begin + (end - begin) * (k + 1) / (SAMPLES + 1) for k in range(SAMPLES))


def _is_point(curve: Curve, begin: float, end: float, at: Point, tolerance: float) -> bool:
    """Return whether a piece remains within the tolerance of its start, so that halving is useless.

    CAD programs write splines with coincident control points, whose spans have no length and no direction.
    """
    return all(math.dist(curve(t).at, at) <= tolerance for t in (*_between(begin, end), end))


def _unit(v: Point) -> Point | None:
    size = math.hypot(*v)
    return (v[0] / size, v[1] / size) if size > 1e-12 else None


def _joint(a: Place, b: Place) -> Point | None:
    """Return the meeting point of a biarc's arcs, with equal tangent lengths at both ends; or None."""
    one, other = _unit(a.way), _unit(b.way)
    if one is None or other is None:
        return None
    v = b.at[0] - a.at[0], b.at[1] - a.at[1]
    t = one[0] + other[0], one[1] + other[1]
    vt, vv = v[0] * t[0] + v[1] * t[1], v[0] * v[0] + v[1] * v[1]
    both = 2.0 * (1.0 - (one[0] * other[0] + one[1] * other[1]))
    if vv < 1e-24:
        return None
    if both < 1e-9:
        along = v[0] * other[0] + v[1] * other[1]
        if abs(along) < 1e-12:
            return None
        far = vv / (4.0 * along)
    else:
        root = vt * vt + both * vv
        far = (-vt + math.sqrt(root)) / both
    if far <= 0.0:
        return None
    return (
        (a.at[0] + b.at[0] + far * (one[0] - other[0])) / 2.0,
        (a.at[1] + b.at[1] + far * (one[1] - other[1])) / 2.0,
    )


def _bulge(at: Point, way: Point, to: Point) -> float:
    """Return the bulge of an arc from its start, its direction there and its end."""
    dx, dy = to[0] - at[0], to[1] - at[1]
    half = math.atan2(way[0] * dy - way[1] * dx, way[0] * dx + way[1] * dy)
    return 0.0 if abs(half) < STRAIGHT else math.tan(half / 2.0)


def _off(curve: Curve, begin: float, end: float, a: Place, joint: Point, b: Place) -> float:
    """Return the largest distance of points on the curve from the nearer of the two arcs."""
    first = a.at, joint, _bulge(a.at, a.way, joint)
    last = joint, b.at, -_bulge(b.at, (-b.way[0], -b.way[1]), joint)
    if max(abs(first[2]), abs(last[2])) > 1.0:
        return math.inf
    places = [curve(t).at for t in _between(begin, end)]
    return max(min(_apart(p, *first), _apart(p, *last)) for p in places)


def _apart(p: Point, a: Point, b: Point, bulge: float) -> float:
    """Return the distance of a point from an arc or line, or from its ends if the foot is outside."""
    chord = math.dist(a, b)
    if chord < 1e-12:
        return math.dist(p, a)
    if abs(bulge) < 1e-9:
        ux, uy = (b[0] - a[0]) / chord, (b[1] - a[1]) / chord
        along = (p[0] - a[0]) * ux + (p[1] - a[1]) * uy
        if 0.0 <= along <= chord:
            return abs((p[0] - a[0]) * uy - (p[1] - a[1]) * ux)
        return min(math.dist(p, a), math.dist(p, b))
    off = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = (a[0] + b[0]) / 2.0 - (b[1] - a[1]) * off, (a[1] + b[1]) / 2.0 + (b[0] - a[0]) * off
    radius = math.dist(centre, a)
    side = (p[0] - a[0]) * (b[1] - a[1]) - (p[1] - a[1]) * (b[0] - a[0])
    if side * bulge >= 0.0 or abs(side) < chord * radius * 1e-6:
        return abs(math.dist(p, centre) - radius)
    return min(math.dist(p, a), math.dist(p, b))


Key = TypeVar("Key", bound=Hashable)


class Content(NamedTuple):
    """Content of a block or group: its own entities, and references to others with their counts."""

    own: int
    inserted: Sequence[tuple[int, Hashable]]


def check_expansion(name: str, root: Key, content: Callable[[Key], Content], spare: int = 0) -> None:
    """Reject a file whose blocks expand to more than ``MOST_ELEMENTS`` entities or contain themselves.

    ``spare`` is an additional allowance for entities in the file itself. Raises DrawingError.
    """
    if _count(name, root, content) > MOST_ELEMENTS + spare:
        raise DrawingError(
            Message(
                "The repeated groups in {name} add up to more than {most_elements} entities: "
                "save only the contour of the part.",
                name=name,
                most_elements=MOST_ELEMENTS,
            ),
            "too-many-lines",
        )


def _count(name: str, root: Key, content: Callable[[Key], Content]) -> int:
    """Count entities depth first without recursion, because a file may nest deeper than Python's stack."""
    known: dict[Hashable, int] = {}
    waiting: dict[Hashable, Content] = {}
    stack: list[Hashable] = [root]
    while stack:
        here = stack[-1]
        if here in known:
            stack.pop()
        elif here in waiting:
            own, inserted = waiting.pop(here)
            known[here] = own + sum(times * known[each] for times, each in inserted)
            stack.pop()
        else:
            waiting[here] = content(here)  # type: ignore[arg-type]
            below = [each for _, each in waiting[here].inserted if each not in known]
            if any(each in waiting for each in below):
                words = Message(
                    "A repeated group in {name} contains itself: save only the contour of the part.",
                    name=name,
                )
                raise DrawingError(words, "nested-blocks")
            stack += below
    return known[root]
