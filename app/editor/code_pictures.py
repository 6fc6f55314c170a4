"""Pictures of the code help: the way of an arc, passes of G33 and G75, the sides of G41, tip quadrants."""

from __future__ import annotations

import math

from core.shapes.sketch import Dim, Outline, Sketch, cut, part, sketch
from core.tool_edges import TIP_DIRECTIONS

Point = tuple[float, float]


def picture_of(head: str) -> Sketch | None:
    """The picture of a code of OmniTurn, Z to the right and r up; None where words say it all."""
    return _PICTURES.get(head)


def _arc(centre: Point, radius: float, begin: float, end: float) -> tuple[Point, ...]:
    angles = [math.radians(begin + (end - begin) * k / 12) for k in range(13)]
    return tuple((centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles)


def _with_arc(*, convex: bool) -> Sketch:
    """From the face to the chuck: G02 rounds a shoulder, G03 fills its corner."""
    corner = _arc((-4, 4), 4, 0, 90) if convex else _arc((0, 8), 4, 270, 180)
    solid = part((0, 0), *corner, (-16, 8), (-16, 0))
    name = "G02" if convex else "G03"
    return sketch(solid, cut(*corner), _arrow(corner[5], corner[7]), dims=(Dim(f"{name} R", (2, 10)),))


def _arrow(a: Point, b: Point) -> Outline:
    """Which way the tool goes."""
    angle = math.atan2(b[1] - a[1], b[0] - a[0])
    ends = [(b[0] - 1.4 * math.cos(angle + s), b[1] - 1.4 * math.sin(angle + s)) for s in (0.5, -0.5)]
    return Outline((ends[0], b, ends[1]), "tool")


def _roughing() -> Sketch:
    profile = ((0, 3), (-6, 3), (-9, 6), (-14, 6), (-14, 9))
    passes = [
        cut((1, r), (z, r)) for r, z in ((8.0, -13.7), (7.0, -13.7), (6.3, -9.0), (5.0, -7.7), (4.0, -6.7))
    ]
    solid = part((0, 0), *profile, (-20, 9), (-20, 0))
    dims = (
        Dim("I", (1.5, 7.5)),
        Dim("U", (-11, 6.2)),
        Dim("S", (2, 10)),
        Dim("A", (0, 3)),
        Dim("B", (-14, 9)),
    )
    return sketch(solid, *passes, dims=dims)


def _threading() -> Sketch:
    teeth = [(-float(k), 7.0 if k % 2 else 5.6) for k in range(13)]
    depths = [cut((3, 7.0 - 0.7 * math.sqrt(k)), (-12, 7.0 - 0.7 * math.sqrt(k))) for k in (1, 2, 3, 4)]
    solid = part((0, 0), *teeth, (-20, 7), (-20, 0))
    return sketch(
        solid, *depths, dims=(Dim("K", (-4, 8.4)), Dim("I", (4, 6.5)), Dim("X", (-14, 5)), Dim("Z", (-12, 9)))
    )


def _beside(*, left: bool) -> Sketch:
    """The nose beside the contour, on the way to the chuck."""
    solid = part((0, 0), (0, 5), (-8, 5), (-12, 8), (-18, 8), (-18, 0))
    off = 1.2 if left else -1.2
    path = cut((2, 5 + off), (-8, 5 + off), (-12, 8 + off), (-18, 8 + off))
    nose = Outline(_arc((-4, 5 + off), 1.2, 0, 360), "tool", closed=True)
    return sketch(
        solid, path, nose, _arrow((-14, 8 + off), (-16, 8 + off)), dims=(Dim("D R", (-4, 5 + 2 * off)),)
    )


def _quadrants() -> Sketch:
    """Where the tip lies from the nose's centre; r points to the operator, here up."""
    nose = Outline(_arc((0, 0), 3, 0, 360), "tool", closed=True)
    tips = tuple(Dim(str(n), (6.0 * z, 6.0 * x)) for n, (z, x) in TIP_DIRECTIONS.items() if n)
    cross = (Outline(((-4, 0), (4, 0)), "part"), Outline(((0, -4), (0, 4)), "part"))
    return Sketch((nose, *cross), tips)


_PICTURES: dict[str, Sketch] = {
    "G02": _with_arc(convex=True),
    "G03": _with_arc(convex=False),
    "G33": _threading(),
    "G75": _roughing(),
    "G78": _roughing(),
    "G41": _beside(left=True),
    "G42": _beside(left=False),
    "T": _quadrants(),
}
