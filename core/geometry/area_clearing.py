"""How a level of a pocket is cleared: rings from the inside out, and where the tool has to go down again.

The rings are offsets of the boundary no farther apart than the tool's radius. That clears every point: one
that lies between two rings is nearer to the outer one than their distance, in corners, too, where the ways
of an overlap over the radius would leave peaks standing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import dist

from core.geometry.lines_and_arcs import SAME_POINT, Element, Line, Point
from core.geometry.pocket_area import AreaError, Loop, Winding, Within, goes_round, inset
from core.message import Message

_MOST_RINGS = 2000
_LINK = 4.0  # tool radii: a farther ring is gone to above the workpiece
_ROOM = 4.0  # tool radii of way that a ramp should have


@dataclass(frozen=True, slots=True)
class Cut:
    """One ring, begun where the tool comes to it: ``straight`` at its depth, else from above.

    ``ramp`` is the ring to go down along, where this one is too short; itself mostly.
    """

    loop: Loop
    straight: bool
    ramp: Loop


@dataclass(slots=True)
class _Patch:
    """A part of the area at one distance: its outer ring, those round islands, and what lies inside."""

    outer: Loop
    holes: list[Loop] = field(default_factory=list)
    inner: list[_Patch] = field(default_factory=list)

    def holds(self, point: Point) -> bool:
        return sum(Winding(loop).round(point) for loop in (self.outer, *self.holes)) > 0


def clearing(
    area: Sequence[Loop], first: float, step: float, radius: float, *, against: bool, here: Point
) -> list[Cut]:
    """The rings that clear an area, the outermost ``first`` mm inside of it, ``step`` mm apart.

    ``against`` runs them clockwise (up-cut milling with M3). Raises AreaError where the tool finds no place.
    """
    outmost = _patches(inset(area, first))
    if not outmost:
        raise AreaError("the tool does not fit anywhere inside the contour")
    layer, apart = outmost, first
    for _ in range(_MOST_RINGS):
        apart += step
        within = _patches(inset(area, apart))
        for patch in within:
            home = next((each for each in layer if each.holds(patch.outer[0].start)), None)
            (home.inner if home is not None else outmost).append(patch)
        layer = within
        if not layer:
            break
    else:
        raise AreaError(
            Message("clearing needs more than {most_rings} concentric passes", most_rings=_MOST_RINGS)
        )
    return _cuts(outmost, Within(area), first, radius, against=against, here=here)


def _patches(loops: Sequence[Loop]) -> list[_Patch]:
    """The parts of an area, each with the islands in it."""
    outers = sorted((loop for loop in loops if goes_round(loop)), key=_size)
    found = [_Patch(loop) for loop in outers]
    for hole in loops:
        if goes_round(hole):
            continue
        home = next((each for each in found if Winding(each.outer).round(hole[0].start) > 0), None)
        if home is None:
            raise AreaError("an island touches the edge of its pocket")
        home.holes.append(hole)
    return found


def _size(loop: Loop) -> float:
    return sum(element.length for element in loop)


def _cuts(
    outmost: Sequence[_Patch], room: Within, apart: float, radius: float, *, against: bool, here: Point
) -> list[Cut]:
    """The rings in their order, each from where the tool comes to it."""
    made: list[Cut] = []
    for index, (ring, around) in enumerate(_inside_out(outmost, [])):
        loop = begun_near(_sense(ring, against=against), here)
        way = Line(here, loop[0].start) if dist(here, loop[0].start) > SAME_POINT else None
        straight = index > 0 and (way is None or (way.length <= _LINK * radius and room.holds(way, apart)))
        ramp = loop
        if not straight and _size(loop) < _ROOM * radius:
            wider = next((each for each in reversed(around) if _size(each) >= _ROOM * radius), None)
            if wider is not None:
                wider = begun_near(_sense(wider, against=against), loop[0].start)
                gap = dist(wider[0].start, loop[0].start) > SAME_POINT
                if not gap or room.holds(Line(wider[0].start, loop[0].start), apart):
                    ramp = wider
        made.append(Cut(loop, straight, ramp))
        here = loop[0].start
    return made


def _inside_out(patches: Sequence[_Patch], around: list[Loop]) -> Iterator[tuple[Loop, list[Loop]]]:
    """Each ring behind those inside of it, with the outer rings that it lies in."""
    for patch in patches:
        yield from _inside_out(patch.inner, [*around, patch.outer])
        for ring in (*patch.holes, patch.outer):
            yield ring, around


def _sense(loop: Loop, *, against: bool) -> Loop:
    return [element.reversed() for element in reversed(loop)] if against else list(loop)


def begun_near(loop: Loop, point: Point) -> Loop:
    """The loop begun at that end or middle of an element that is nearest to a point."""
    best, cut = min(
        (dist(place, point), (index, half))
        for index, element in enumerate(loop)
        for half, place in ((False, element.start), (True, element.point(element.length / 2.0)))
    )
    del best
    index, half = cut
    return begun_at(loop, index, loop[index].length / 2.0 if half else 0.0)


def begun_at(loop: Loop, index: int, along: float) -> Loop:
    """The loop begun ``along`` mm behind the start of one of its elements."""
    element = loop[index]
    turned = [*loop[index + 1 :], *loop[:index]]
    if along <= SAME_POINT or along >= element.length - SAME_POINT:
        return [element, *turned] if along <= SAME_POINT else [*turned, element]
    middle = element.point(along)
    return [element.part(middle, element.end), *turned, element.part(element.start, middle)]


def walked(loop: Loop, length: float) -> tuple[list[Element], Loop]:
    """The first ``length`` mm of a way round a loop, as often as it takes, and the loop from its end on."""
    way: list[Element] = []
    left, at = length, 0
    while left > SAME_POINT:
        element = loop[at % len(loop)]
        if element.length > left + SAME_POINT:
            way.append(element.part(element.start, element.point(left)))
            return way, begun_at(loop, at % len(loop), left)
        way.append(element)
        left -= element.length
        at += 1
    return way, begun_at(loop, at % len(loop), 0.0)
