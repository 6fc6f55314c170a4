"""The stock of a program of which nobody has said it: a bar just larger than what is cut."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from core.interpreter.elementary_blocks import Kind
from core.part.stock import Stock
from core.proving.tip_moves import QUICK, LiveStep, TipMove

_MORE = 0.25  # mm of radius that a bar is larger
_BEHIND = 10.0  # mm of bar behind the last cut
_SAME = 0.01
_NEAR_FACE, _CENTRE = 1.0, 1.0  # mm; a cut from outside to the axis here is the face
_BEYOND = 6.35  # mm; what is fed further out than the outside is no bore
_LEAST = 0.5  # mm of radius
_WALL = 2.0  # mm around a bore
_BEFORE = 5.0  # mm before Z0; a lost minus is nearer, or one move of many
_MOST = 0.5  # of what is fed


def assumed_stock(
    outside: Sequence[TipMove],
    bore: Sequence[TipMove],
    face: float | None,
    drill: float,
    live: Sequence[LiveStep] = (),
) -> Stock | None:
    """The bar for the moves of outside tools; a tube where tools of a bore begin without a drill before them.

    ``face``: Z at which a bar stop has held it, mm; None: Z0. ``drill``: diameter of the largest, 0: none.
    None where nothing is cut behind the face, and where part zero is no face: then nothing says where one is.
    """
    cuts = [move for move in (*outside, *bore) if not move.quick]
    if face is None and zero_behind(cuts):
        return None
    front = _front((*outside, *bore)) if face is None else face
    milled = [step for step in live if not step.block.rapid and step.block.feed < QUICK]
    depths = [z for move in cuts for z, _ in move.points] + [b.reach()[2] + dz for b, (_, dz) in milled]
    back = min(depths, default=front)
    if back > front or not depths:
        return None
    reach = max((_live_reach(step) for step in milled), default=0.0)
    radius = max(_bar_radius(outside, bore, front) if cuts else reach, drill)
    hole = 0.0 if drill else min(_bore_radius(bore, front), radius - _SAME)
    ends = back - _BEHIND, front
    inner = tuple((z, hole) for z in ends) if hole > 0.0 else ()
    return Stock("", tuple((z, radius) for z in ends), inner)


def zero_behind(cuts: Sequence[TipMove]) -> bool:
    """Whether part zero lies behind the part, at the chuck: most is fed well before Z0."""
    before = sum(move.length for move in cuts if min(z for z, _ in move.points) > _BEFORE)
    return before > _MOST * sum(move.length for move in cuts)


def _front(moves: Sequence[TipMove]) -> float:
    """Z of the face: a little before where it is first cut, where no rapid meets it; Z0 where it is not."""
    faced = [m.points[-1][0] for m in moves if _cuts_face(m)]
    if not faced:
        return 0.0
    face = max(faced)
    free = min((z for m in moves if m.quick for z, _ in m.points if z > face + _SAME), default=face)
    return face + min(_MORE, (free - face) / 2.0)


def _cuts_face(move: TipMove) -> bool:
    """Whether it goes from outside to the axis near Z0; at a rapid, too: a G00 that was left on."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    across = abs(z1 - z0) <= _SAME and abs(r1) < _CENTRE < abs(r0) - _CENTRE
    return across and -_SAME <= z1 < _NEAR_FACE / 2.0


def _bar_radius(outside: Sequence[TipMove], bore: Sequence[TipMove], front: float) -> float:
    """The largest cylinder that is cut, and a little more, but not so much that a rapid meets it.

    Where grooves or faces alone are cut, the bar is a little smaller than where the largest of them begins.
    """
    feeds = [move for move in outside if not move.quick]
    behind = [move for move in feeds if min(z for z, _ in move.points) < front - _SAME]
    along = [_cylinder(m) for m in behind if _turns(m, front)]
    largest = max(along, default=math.inf) + _BEYOND
    widest = max((r for r in _radii(bore) if r < largest), default=0.0)
    sunk = [min(abs(r) for _, r in m.points) + _MORE for m in behind if along and _plunges(m)]
    begins = [max(abs(r) for _, r in move.points) - 2.0 * _MORE for move in behind or feeds]
    faced = _faced(feeds, front)
    cut = max([*along, *sunk, widest] if along or widest else begins, default=_LEAST)
    if faced < math.inf:
        cut = min(max(cut, faced - 3.0 * _MORE), faced)
    passed = [abs(r) for m in outside if m.quick for z, r in m.points if z < front - _SAME]
    beside = [r for r in passed if r >= cut - _SAME]
    return max(min([cut + _MORE, *beside]), widest + _WALL if widest else 0.0, _LEAST)


def _turns(move: TipMove, front: float) -> bool:
    """Whether it goes along Z in the part; what comes from behind and ends before the face is a retract."""
    z0, z1 = move.points[0][0], move.points[-1][0]
    return abs(z1 - z0) > _SAME and not z1 > max(z0, front + _NEAR_FACE)


def _plunges(move: TipMove) -> bool:
    """Whether it goes square towards the axis, to some place before it."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    return abs(z1 - z0) <= _SAME and abs(r0) > abs(r1) > _CENTRE


def _radii(moves: Iterable[TipMove]) -> Iterator[float]:
    return (abs(r) for move in moves if not move.quick for _, r in move.points)


def _live_reach(step: LiveStep) -> float:
    """A little less than where a live tool's cut begins or ends, the further out."""
    low, high, _, _ = step.block.reach()
    return (
        max(abs(low + step.place[0]), abs(high + step.place[0]), abs(step.block.x0 + step.place[0])) - _MORE
    )


def _faced(feeds: Iterable[TipMove], front: float) -> float:
    """Where the first cut begins if it is that of the face: no bar is larger. Infinite if it is another."""
    for move in feeds:
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if abs(abs(r1) - abs(r0)) > _CENTRE:
            faces = abs(z1 - z0) <= _SAME and z1 > front - _NEAR_FACE and abs(r1) < _CENTRE < abs(r0)
            return abs(r0) if faces else math.inf
        if z1 < front - _NEAR_FACE:
            return math.inf
    return math.inf


def _cylinder(move: TipMove) -> float:
    """The radius of the bar that a move along Z needs: an arc bulges, a line outwards leaves the part."""
    radii = [abs(r) for _, r in move.points]
    return max(radii) if move.kind is Kind.ARC else min(radii)


def _bore_radius(bore: Iterable[TipMove], front: float) -> float:
    """Just under the smallest cylinder that is cut in the bore, 0 where none is."""
    behind = [m for m in bore if not m.quick and min(z for z, _ in m.points) < front - _SAME]
    return max(min((max(abs(r) for _, r in m.points) for m in behind), default=0.0) - _MORE, 0.0)
