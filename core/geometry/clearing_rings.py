"""Closed tool paths (rings) that clear one level of a pocket, in machining order.

The rings are insets of the pocket boundary, at most one tool radius apart. A point between two rings is
then less than one tool radius from the outer ring, so every point is cleared. A larger distance would leave
stock in corners.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import dist

from core.geometry.lines_and_arcs import SAME_POINT_TOLERANCE_MM, Line, Point
from core.geometry.pocket_area import (
    AreaChecker,
    ElementLoop,
    PocketAreaError,
    WindingCalculator,
    is_counterclockwise,
    make_inset_loops,
    move_loop_start_near,
)
from core.message import Message

_MAX_RINGS = 2000
_LINK_RADII = 4.0  # tool radii; the tool moves to a ring farther away above the workpiece
_RAMP_RADII = 4.0  # tool radii that a ramp should be long


@dataclass(frozen=True, slots=True)
class ClearingRing:
    """A closed tool path of a pocket. It starts at the point where the tool enters it.

    If ``moves_at_depth`` is True, the tool moves to the ring at cutting depth, otherwise from above.
    ``ramp_loop`` is the ring along which the tool ramps down: this ring or, if it is too short, a wider
    ring.
    """

    loop: ElementLoop
    moves_at_depth: bool
    ramp_loop: ElementLoop


@dataclass(slots=True)
class _AreaPatch:
    """A connected part of the pocket area at one inset from the pocket boundary.

    The patch has an outer ring, its islands, and the patches inside it.
    """

    outer_loop: ElementLoop
    hole_loops: list[ElementLoop] = field(default_factory=list)
    inner_patches: list[_AreaPatch] = field(default_factory=list)

    def contains_point(self, point: Point) -> bool:
        return (
            sum(
                WindingCalculator(loop).compute_winding_number(point)
                for loop in (self.outer_loop, *self.hole_loops)
            )
            > 0
        )


def make_clearing_rings(
    area: Sequence[ElementLoop],
    first_inset: float,
    ring_distance: float,
    radius: float,
    *,
    is_conventional: bool,
    position: Point,
) -> list[ClearingRing]:
    """Return the rings that clear an area.

    The outermost ring is ``first_inset`` mm inside the area, and the rings are ``ring_distance`` mm apart.
    ``radius`` is the tool radius in mm. If ``is_conventional`` is True, the rings are clockwise
    (conventional milling with M3). Raises PocketAreaError if the tool does not fit, if an inset is not
    closed, if an island touches the edge of its pocket, or if more than 2000 rings are needed.
    """
    outmost = _find_patches(make_inset_loops(area, first_inset))
    if not outmost:
        raise PocketAreaError("the tool does not fit anywhere inside the contour")
    layer, apart = outmost, first_inset
    for _ in range(_MAX_RINGS):
        apart += ring_distance
        within = _find_patches(make_inset_loops(area, apart))
        for patch in within:
            home = next((each for each in layer if each.contains_point(patch.outer_loop[0].start)), None)
            (home.inner_patches if home is not None else outmost).append(patch)
        layer = within
        if not layer:
            break
    else:
        raise PocketAreaError(
            Message("clearing needs more than {most_rings} concentric passes", most_rings=_MAX_RINGS)
        )
    return _order_rings(
        outmost, AreaChecker(area), first_inset, radius, conventional=is_conventional, position=position
    )


def _find_patches(loops: Sequence[ElementLoop]) -> list[_AreaPatch]:
    """Return the connected parts of an area, each with its islands."""
    outers = sorted((loop for loop in loops if is_counterclockwise(loop)), key=_size)
    found = [_AreaPatch(loop) for loop in outers]
    for hole in loops:
        if is_counterclockwise(hole):
            continue
        home = next(
            (
                each
                for each in found
                if WindingCalculator(each.outer_loop).compute_winding_number(hole[0].start) > 0
            ),
            None,
        )
        if home is None:
            raise PocketAreaError("an island touches the edge of its pocket")
        home.hole_loops.append(hole)
    return found


def _size(loop: ElementLoop) -> float:
    return sum(element.length for element in loop)


def _order_rings(
    outmost: Sequence[_AreaPatch],
    room: AreaChecker,
    distance: float,
    radius: float,
    *,
    conventional: bool,
    position: Point,
) -> list[ClearingRing]:
    """Return the rings in machining order, each starting at the point where the tool enters it."""
    made: list[ClearingRing] = []
    for index, (ring, around) in enumerate(_iter_inner_first(outmost, [])):
        loop = move_loop_start_near(_sense(ring, against=conventional), position)
        link = (
            Line(position, loop[0].start) if dist(position, loop[0].start) > SAME_POINT_TOLERANCE_MM else None
        )
        straight = index > 0 and (
            link is None or (link.length <= _LINK_RADII * radius and room.contains_element(link, distance))
        )
        ramp = loop
        if not straight and _size(loop) < _RAMP_RADII * radius:
            wider = next((each for each in reversed(around) if _size(each) >= _RAMP_RADII * radius), None)
            if wider is not None:
                wider = move_loop_start_near(_sense(wider, against=conventional), loop[0].start)
                gap = dist(wider[0].start, loop[0].start) > SAME_POINT_TOLERANCE_MM
                if not gap or room.contains_element(Line(wider[0].start, loop[0].start), distance):
                    ramp = wider
        made.append(ClearingRing(loop, straight, ramp))
        position = loop[0].start
    return made


def _iter_inner_first(
    patches: Sequence[_AreaPatch], outer_rings: list[ElementLoop]
) -> Iterator[tuple[ElementLoop, list[ElementLoop]]]:
    """Yield each ring after the rings inside it, together with the outer rings around it."""
    for patch in patches:
        yield from _iter_inner_first(patch.inner_patches, [*outer_rings, patch.outer_loop])
        for ring in (*patch.hole_loops, patch.outer_loop):
            yield ring, outer_rings


def _sense(loop: ElementLoop, *, against: bool) -> ElementLoop:
    return [element.make_reversed() for element in reversed(loop)] if against else list(loop)
