"""Functions shared by the drawing readers: limits for block expansion, and arc fits to curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import NamedTuple, TypeVar

from core.extras.drawings.drawing import MAX_ELEMENTS, DrawingError, make_bulged_segment, make_line
from core.geometry.lines_and_arcs import Element, Point
from core.message import Message

CURVE_SAMPLES = 7  # points of a piece at which it is compared with the curve
_DEEPEST = 14  # largest number of successive halvings
STRAIGHT_TOLERANCE = 1e-6


class CurvePoint(NamedTuple):
    """A point of a curve with the direction of its tangent, which may have any length."""

    point: Point
    tangent: Point


CurveFunction = Callable[[float], CurvePoint]
"""Function that returns the curve point for a parameter from 0 to 1."""


def fit_arcs(curve: CurveFunction, tolerance: float, min_pieces: int = 1) -> Iterator[Element]:
    """Yield arcs, joined tangentially, that deviate from a curve by at most ``tolerance``.

    The curve is divided into at least ``min_pieces`` pieces.
    """
    ends = curve(0.0).point, curve(0.5).point, curve(1.0).point
    if not all(math.isfinite(value) for point in ends for value in point):
        # halving cannot help, so the limits check rejects this line
        yield from make_line(ends[0], (math.nan, math.nan))
        return
    for k in range(min_pieces):
        yield from _fitted(curve, k / min_pieces, (k + 1) / min_pieces, tolerance, 0)


def _fitted(
    curve: CurveFunction, begin: float, end: float, tolerance: float, depth: int
) -> Iterator[Element]:
    a, b = curve(begin), curve(end)
    joint = _joint(a, b)
    close = joint is not None and _find_max_deviation(curve, begin, end, a, joint, b) <= tolerance
    point = not close and _is_point(curve, begin, end, a.point, tolerance)
    if not close and not point and depth < _DEEPEST:
        middle = (begin + end) / 2.0
        yield from _fitted(curve, begin, middle, tolerance, depth + 1)
        yield from _fitted(curve, middle, end, tolerance, depth + 1)
    elif joint is None or point:
        yield from make_line(a.point, b.point)
    else:
        yield from make_bulged_segment(a.point, joint, _bulge(a.point, a.tangent, joint))
        yield from make_bulged_segment(
            joint, b.point, -_bulge(b.point, (-b.tangent[0], -b.tangent[1]), joint)
        )


def _between(begin: float, end: float) -> Iterator[float]:
    """Yield the parameters at which a piece is compared with the curve."""
    return (begin + (end - begin) * (k + 1) / (CURVE_SAMPLES + 1) for k in range(CURVE_SAMPLES))


def _is_point(curve: CurveFunction, begin: float, end: float, at: Point, tolerance: float) -> bool:
    """Return whether a piece of a curve is so short that it is only a point within the tolerance.

    CAD programs write splines with coincident control points, whose spans have neither length nor
    direction.
    """
    return all(math.dist(curve(t).point, at) <= tolerance for t in (*_between(begin, end), end))


def _unit(v: Point) -> Point | None:
    size = math.hypot(*v)
    return (v[0] / size, v[1] / size) if size > 1e-12 else None


def _joint(a: CurvePoint, b: CurvePoint) -> Point | None:
    """Return the point where the two arcs of a biarc meet, or None if no such point exists.

    The tangent lengths at both ends are equal.
    """
    one, other = _unit(a.tangent), _unit(b.tangent)
    if one is None or other is None:
        return None
    v = b.point[0] - a.point[0], b.point[1] - a.point[1]
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
        (a.point[0] + b.point[0] + far * (one[0] - other[0])) / 2.0,
        (a.point[1] + b.point[1] + far * (one[1] - other[1])) / 2.0,
    )


def _bulge(at: Point, tangent: Point, to: Point) -> float:
    """Return the bulge of an arc, given its start point, start direction and end point."""
    dx, dy = to[0] - at[0], to[1] - at[1]
    half = math.atan2(tangent[0] * dy - tangent[1] * dx, tangent[0] * dx + tangent[1] * dy)
    return 0.0 if abs(half) < STRAIGHT_TOLERANCE else math.tan(half / 2.0)


def _find_max_deviation(
    curve: CurveFunction, begin: float, end: float, a: CurvePoint, joint: Point, b: CurvePoint
) -> float:
    """Return the largest distance of the curve from the nearer of the two arcs that replace it."""
    first = a.point, joint, _bulge(a.point, a.tangent, joint)
    last = joint, b.point, -_bulge(b.point, (-b.tangent[0], -b.tangent[1]), joint)
    if max(abs(first[2]), abs(last[2])) > 1.0:
        return math.inf
    places = [curve(t).point for t in _between(begin, end)]
    return max(min(_apart(p, *first), _apart(p, *last)) for p in places)


def _apart(p: Point, a: Point, b: Point, bulge: float) -> float:
    """Return the distance of a point from an arc or line.

    If the foot of the perpendicular is outside the arc or line, the distance from the nearer end is
    returned.
    """
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


BlockKey = TypeVar("BlockKey", bound=Hashable)


class BlockContent(NamedTuple):
    """Content of a block or group of a drawing.

    ``entity_count`` is the number of entities directly in the block. ``block_references`` contains the
    other blocks that it uses, with the number of uses.
    """

    entity_count: int
    block_references: Sequence[tuple[int, Hashable]]


def check_block_expansion(
    name: str, root: BlockKey, content: Callable[[BlockKey], BlockContent], remaining_count: int = 0
) -> None:
    """Raise DrawingError if the blocks of a file contain themselves or expand to too many entities.

    The limit is ``MAX_ELEMENTS``. ``remaining_count`` more entities are permitted for the file itself.
    """
    if _count(name, root, content) > MAX_ELEMENTS + remaining_count:
        raise DrawingError(
            Message(
                "The repeated groups in {name} add up to more than {most_elements} entities: "
                "save only the contour of the part.",
                name=name,
                most_elements=MAX_ELEMENTS,
            ),
            "too-many-lines",
        )


def _count(name: str, root: BlockKey, content: Callable[[BlockKey], BlockContent]) -> int:
    """Count the entities of nested blocks depth first.

    The count is not recursive, because blocks may be nested deeply.
    """
    known: dict[Hashable, int] = {}
    waiting: dict[Hashable, BlockContent] = {}
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
            below = [each for _, each in waiting[here].block_references if each not in known]
            if any(each in waiting for each in below):
                words = Message(
                    "A repeated group in {name} contains itself: save only the contour of the part.",
                    name=name,
                )
                raise DrawingError(words, "nested-blocks")
            stack += below
    return known[root]
