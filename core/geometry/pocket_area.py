"""Areas of pockets with islands, their insets, and the rings that clear one level.

A boundary is a list of closed loops, and each loop is a list of consecutive elements. The area is to the left
of each loop: counterclockwise around a pocket, clockwise around an island. Coordinates are X and Y in mm.

The offset is exact, because lines remain lines and arcs remain arcs. A point belongs to the inset area if no
point of the boundary is closer than the distance. Every part of an offset element that is closer to any other
element is therefore left out (``moved``, ``split_at``), even if the area falls apart or an island merges with
a wall.

The rings are offsets of the boundary that are at most one tool radius apart. This clears every point, because
a point between two rings is closer to the outer ring than their distance. A larger overlap would leave stock
in corners.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, dist, pi

import numpy as np
import numpy.typing as npt

from core.geometry.contour_offset import Boxed, moved, split_at
from core.geometry.lines_and_arcs import (
    SAME_POINT,
    Arc,
    Element,
    Line,
    Point,
    arc_between,
    clearance,
    distance,
    left_of,
    turn,
)
from core.message import Message

Loop = list[Element]
Inside = Callable[[Point], bool]

_NEARER = 0.0005  # mm by which an offset may be closer to its boundary, because programs round their corners
_JOINED = 0.005  # mm between the end of one part and the start of the next, because tangents are rounded too
_TOO_SHORT = 0.002  # mm; shorter parts of an offset are overlaps of two rounded tangents
_TAIL = 0.5  # mm; a longer dead end is an error
_ASIDE = 1e-5  # mm from a part, on either side, at which the area is tested
_HALF = pi - 1e-9
_MOST_RINGS = 2000
_LINK = 4.0  # tool radii; the tool moves to a ring farther away above the workpiece
_ROOM = 4.0  # tool radii that a ramp should be long


class AreaError(Exception):
    """Raised when contours enclose no area or cannot be offset. The message is a clause."""


def follows(elements: Sequence[Element]) -> Loop:
    """Return the elements as a closed loop, with a line from the end to the start if needed."""
    loop = list(elements)
    if loop and dist(loop[-1].end, loop[0].start) > SAME_POINT:
        loop.append(Line(loop[-1].end, loop[0].start))
    return loop


# --- inside or outside ----------------------------------------------------------------------------------


class Winding:
    """The winding number of a loop around points that are not on the loop; counterclockwise is positive."""

    def __init__(self, loop: Sequence[Element]) -> None:
        halves = [part for element in loop for part in _halves(element)]
        self._start = np.array([part.start for part in halves])
        self._end = np.array([part.end for part in halves])
        self._centre = np.array([part.centre if isinstance(part, Arc) else (0.0, 0.0) for part in halves])
        self._radius = np.array([part.radius if isinstance(part, Arc) else -1.0 for part in halves])
        self._sense = np.array([(-1.0 if part.clockwise else 1.0) if isinstance(part, Arc) else 0.0
                                for part in halves])  # fmt: skip

    def round(self, point: Point) -> int:
        """Return the winding number around ``point``.

        The method adds the angles of the chords as seen from the point, and a full turn for an arc that
        passes beyond it.
        """
        a, b = self._start - point, self._end - point
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        angle = np.arctan2(cross, (a * b).sum(axis=1))
        off = np.hypot(*(self._centre - point).T)
        # The point is inside the circle of an arc of up to 180 degrees, on the arc's side of its chord.
        beyond = (off < self._radius) & (cross * self._sense < 0.0)
        return round(float(angle.sum() + 2.0 * pi * (self._sense * beyond).sum()) / (2.0 * pi))


def _halves(element: Element) -> Iterator[Element]:
    """Yield the element, with an arc of more than half a circle divided into shorter arcs."""
    if isinstance(element, Line) or abs(element.sweep) <= _HALF:
        yield element
        return
    count = ceil(abs(element.sweep) / (pi / 2.0))
    points = [element.start, *(element.point(element.length * at / count) for at in range(1, count))]
    for start, end in pairwise((*points, element.end)):
        yield element.part(start, end)


def enclosed(loop: Sequence[Element]) -> float:
    """Return the area within a closed loop in mm²; negative for a clockwise loop."""
    total = 0.0
    for element in loop:
        (x0, y0), (x1, y1) = element.start, element.end
        total += x0 * y1 - x1 * y0
        if isinstance(element, Arc):
            sweep = -element.sweep  # counterclockwise is positive
            chord = (x0 - element.centre[0], y0 - element.centre[1])
            last = (x1 - element.centre[0], y1 - element.centre[1])
            total += element.radius**2 * sweep - (chord[0] * last[1] - chord[1] * last[0])
    return total / 2.0


def goes_round(loop: Sequence[Element]) -> bool:
    """Return whether the loop is counterclockwise or encloses no area."""
    return enclosed(loop) > -_JOINED * sum(element.length for element in loop)


# --- boundary and offset ----------------------------------------------------------------------------------


def boundary(curves: Sequence[Loop], inside: Inside) -> list[Loop]:
    """Return the boundary of the area that ``inside`` describes, with elements of the given curves.

    Raises AreaError if the boundary is not closed.
    """
    elements = [part for loop in curves for element in loop for part in _halves(element)]
    if not elements:
        return []
    every = Boxed(elements)
    parts = [part for element in elements for part in _divided(element, every)]
    kept = [side for part in parts if (side := _bounding(part, inside)) is not None]
    return _chained(_single(kept))


def _divided(element: Element, every: Boxed) -> list[Element]:
    """Return the parts of an element between all points where other elements meet it or end on it."""
    parts = split_at(element, every)
    ends = {end for other in every.near(element.box, SAME_POINT) for end in (other.start, other.end)}
    for end in ends:
        parts = [piece for part in parts for piece in _cut(part, end)]
    return parts


def _cut(part: Element, at: Point) -> list[Element]:
    if distance(part, at) > SAME_POINT or min(dist(at, part.start), dist(at, part.end)) <= 2 * SAME_POINT:
        return [part]
    return [part.part(part.start, at), part.part(at, part.end)]


def _bounding(part: Element, inside: Inside) -> Element | None:
    """Return the part with the area on its left, or None if the area is on both sides or on neither."""
    x, y = part.point(part.length / 2.0)
    dx, dy = left_of(_direction_halfway(part))
    left = inside((x + dx * _ASIDE, y + dy * _ASIDE))
    right = inside((x - dx * _ASIDE, y - dy * _ASIDE))
    if left == right:
        return None
    return part if left else part.reversed()


def _direction_halfway(part: Element) -> Point:
    middle = part.point(part.length / 2.0)
    return part.part(middle, part.end).start_direction


def inset(loops: Sequence[Loop], apart: float) -> list[Loop]:
    """Return the boundary of the points that are at least ``apart`` mm inside the loops.

    Raises AreaError if the boundary is not closed.
    """
    if apart <= 0.0 or not loops:
        return [list(loop) for loop in loops]
    contour = Boxed([element for loop in loops for element in loop])
    pieces = [piece for loop in loops for piece in _moved_inwards(loop, apart)]
    if not pieces:
        return []
    every = Boxed(pieces)
    parts = [part for piece in pieces for part in split_at(piece, every)]
    within = [Winding(loop) for loop in loops]
    long = (part for part in parts if part.length > _TOO_SHORT)
    kept = [part for part in long if _apart(part, contour, apart - _NEARER, within)]
    return _chained(_single(kept))


def _moved_inwards(loop: Loop, apart: float) -> Iterator[Element]:
    """Yield each element offset to its left, and an arc around each corner that turns right."""
    for before, after in zip(loop, [*loop[1:], loop[0]], strict=True):
        first, last = moved(before, apart), moved(after, apart)
        for each in first:
            yield from _halves(each)
        if turn(before.end_direction, after.start_direction) < 0.0 and first and last:
            start, end = first[0].end, last[0].start
            if dist(start, end) > SAME_POINT:
                yield from _halves(Arc(start, end, after.start, clockwise=True))


def _apart(part: Element, contour: Boxed, least: float, within: Sequence[Winding]) -> bool:
    x, y = middle = part.point(part.length / 2.0)
    if any(distance(element, middle) < least for element in contour.near((x, x, y, y), least)):
        return False
    return sum(each.round(middle) for each in within) > 0


def _single(parts: Sequence[Element]) -> list[Element]:
    """Return the parts, each only once where parts of the same direction coincide."""
    found: dict[tuple[int, ...], Element] = {}
    for part in parts:
        if part.length < SAME_POINT:
            continue
        places = (*part.start, *part.end, *part.point(part.length / 2.0))
        key = tuple(round(value / (4 * SAME_POINT)) for value in places)
        found.setdefault(key, part)
    return list(found.values())


def _chained(parts: Sequence[Element]) -> list[Loop]:
    """Return the parts as closed loops, the longest first. Raises AreaError if a loop is not closed."""
    parts = _without_tails(parts)
    starts = np.array([part.start for part in parts]).reshape(-1, 2)
    free = np.ones(len(parts), dtype=bool)
    order = sorted(range(len(parts)), key=lambda each: -parts[each].length)
    loops = (_loop(parts, starts, free, at) for at in order if free[at])
    return [loop for loop in loops if loop]


def _without_tails(parts: Sequence[Element]) -> list[Element]:
    """Return the parts without short dead ends, which occur after crossings at a small angle."""
    left = list(parts)
    while left:
        starts, ends = np.array([part.start for part in left]), np.array([part.end for part in left])
        away = np.hypot(*(ends[:, None, :] - starts[None, :, :]).transpose(2, 0, 1))
        dead = (away.min(axis=1) > _JOINED) | (away.min(axis=0) > _JOINED)
        kept = [part for part, ends_here in zip(left, dead, strict=True)
                if not ends_here or part.length > _TAIL]  # fmt: skip
        if len(kept) == len(left):
            break
        left = kept
    return left


def _loop(parts: Sequence[Element], starts: npt.NDArray[np.float64], free: npt.NDArray[np.bool_],
          first: int) -> Loop:  # fmt: skip
    """Return the closed loop that starts with a part, and mark its parts as used.

    A loop that is too short returns an empty list.
    """
    loop: Loop = [parts[first]]
    free[first] = False
    while dist(loop[-1].end, loop[0].start) > SAME_POINT:
        away = np.hypot(*(starts - loop[-1].end).T)
        away[~free] = np.inf
        home = dist(loop[-1].end, loop[0].start)
        nearest = float(away.min()) if away.size else np.inf
        if min(home, nearest) > _JOINED:
            if sum(part.length for part in loop) <= 2 * _JOINED:
                return []
            raise AreaError("the offset contour is not closed")
        if home <= nearest:
            break
        after = max(np.flatnonzero(away <= nearest + SAME_POINT).tolist(),
                    key=lambda at: _turned(loop[-1], parts[at]))  # fmt: skip
        free[after] = False
        loop.append(parts[after])
    return _closed(loop)


def _turned(before: Element, after: Element) -> float:
    """Return the turn between two elements.

    The sharpest left turn is selected, which separates loops that touch in a point.
    """
    angle = turn(before.end_direction, after.start_direction)
    return angle if angle < _HALF else -pi  # a reversal comes last


def _closed(loop: Loop) -> Loop:
    """Return the loop with each element starting exactly at the end of the previous one."""
    made: Loop = []
    here = loop[-1].end
    for element in loop:
        if element.start == here:
            made.append(element)
        elif isinstance(element, Arc):
            made.append(arc_between(here, element.end, element.centre, clockwise=element.clockwise))
        elif dist(here, element.end) > SAME_POINT:
            made.append(Line(here, element.end))
        else:
            continue
        here = element.end
    return made


# --- moves within an area ---------------------------------------------------------------------------------


class Within:
    """Checks whether moves remain inside an area."""

    def __init__(self, loops: Sequence[Loop]) -> None:
        self._contour = Boxed([element for loop in loops for element in loop])
        self._windings = [Winding(loop) for loop in loops]

    def holds(self, element: Element, apart: float) -> bool:
        """Return whether the whole element is inside, at least ``apart`` mm from the boundary."""
        near = self._contour.near(element.box, apart)
        if any(clearance(other, element) < apart - 2 * _NEARER for other in near):
            return False
        return sum(each.round(element.point(element.length / 2.0)) for each in self._windings) > 0


@dataclass(frozen=True, slots=True)
class Cut:
    """One ring, which starts where the tool reaches it.

    ``straight`` is True if the tool moves to the ring at its depth, and False if it comes from above.
    ``ramp`` is the ring along which the tool ramps down, usually the same ring. It is a wider one if this
    ring is too short.
    """

    loop: Loop
    straight: bool
    ramp: Loop


@dataclass(slots=True)
class _Patch:
    """A connected part of the area at one distance: its outer ring, its islands, and the parts inside."""

    outer: Loop
    holes: list[Loop] = field(default_factory=list)
    inner: list[_Patch] = field(default_factory=list)

    def holds(self, point: Point) -> bool:
        return sum(Winding(loop).round(point) for loop in (self.outer, *self.holes)) > 0


def clearing(
    area: Sequence[Loop], first: float, step: float, radius: float, *, against: bool, here: Point
) -> list[Cut]:
    """Return the rings that clear an area, the outermost ``first`` mm inside and ``step`` mm apart.

    ``against`` makes the rings clockwise (conventional milling with M3). Raises AreaError if the tool does
    not fit.
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
    """Return the connected parts of an area, each with its islands."""
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
    """Return the rings in their order, each starting where the tool reaches it."""
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
    """Yield each ring after the rings inside it, with the outer rings around it."""
    for patch in patches:
        yield from _inside_out(patch.inner, [*around, patch.outer])
        for ring in (*patch.holes, patch.outer):
            yield ring, around


def _sense(loop: Loop, *, against: bool) -> Loop:
    return [element.reversed() for element in reversed(loop)] if against else list(loop)


def begun_near(loop: Loop, point: Point) -> Loop:
    """Return the loop starting at the end or the middle of an element that is nearest to a point."""
    best, cut = min(
        (dist(place, point), (index, half))
        for index, element in enumerate(loop)
        for half, place in ((False, element.start), (True, element.point(element.length / 2.0)))
    )
    del best
    index, half = cut
    return begun_at(loop, index, loop[index].length / 2.0 if half else 0.0)


def begun_at(loop: Loop, index: int, along: float) -> Loop:
    """Return the loop starting ``along`` mm after the start of one of its elements."""
    element = loop[index]
    turned = [*loop[index + 1 :], *loop[:index]]
    if along <= SAME_POINT or along >= element.length - SAME_POINT:
        return [element, *turned] if along <= SAME_POINT else [*turned, element]
    middle = element.point(along)
    return [element.part(middle, element.end), *turned, element.part(element.start, middle)]


def walked(loop: Loop, length: float) -> tuple[list[Element], Loop]:
    """Return the first ``length`` mm around a loop, and the loop from that point on.

    A length greater than the loop repeats the loop.
    """
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
