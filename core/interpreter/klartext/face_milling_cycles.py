"""Face milling: multipass (230), ruled surface (231), face milling by strategy (232, 233)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from core.geometry.lines_and_arcs import Point
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.cycle_moves import CycleTool
from core.interpreter.klartext.hole_cycles import SMALLEST, infeeds
from core.message import Message

_MOST_ROWS = 5_000
_OUTSIDE, _INSIDE, _LINE, _LINE_INSIDE, _SPIRAL = range(5)
_ROUGH, _FINISH = 1, 2


# --- rows of their own number


def multipass_milling(tool: CycleTool) -> Iterator[Block]:
    """230: Q240 rows there and back over Q218 by Q219 from Q225 Q226, at the height Q227."""
    (x, y, z), length, width = _start(tool), tool.length(218), tool.length(219)
    count, radius = _rows(tool), math.copysign(tool.radius, length)
    plunge, feed, aside = tool.cut(206), tool.cut(207), tool.cut(209)
    ends = x - radius, x + length + radius
    clear = z + tool.length(200)
    yield tool.to(max(clear, tool.height))
    yield tool.across((ends[0], y))
    yield tool.to(clear)
    yield tool.to(z, plunge)
    for row in range(count):
        if row:
            yield tool.across((tool.here[0], y + width * row / (count - 1)), None, aside)
        yield tool.across((ends[1 - row % 2], tool.here[1]), None, feed)
    yield tool.to(clear)


def ruled_surface(tool: CycleTool) -> Iterator[Block]:
    """231: Q240 rows from the line P1 P4 to the line P2 P3, each from above; the tip runs on the surface."""
    p1, p2, p3, p4 = (
        (tool.length(first), tool.length(first + 1), tool.length(first + 2)) for first in (225, 228, 231, 234)
    )
    count, feed = _rows(tool), tool.cut(207)
    above = max(p[2] for p in (p1, p2, p3, p4)) + max(2.0 * tool.radius, 2.0)
    yield tool.to(max(above, tool.height))
    for row in range(count):
        share = row / (count - 1)
        begin, end = _between(p1, p4, share), _between(p2, p3, share)
        yield tool.to(max(above, tool.height) if row == 0 else above)
        yield tool.across(begin[:2])
        yield tool.to(begin[2], feed)
        yield tool.across(end[:2], end[2], feed)
    yield tool.to(above)


def _between(
    a: tuple[float, float, float], b: tuple[float, float, float], share: float
) -> tuple[float, float, float]:
    x, y, z = (at + (to - at) * share for at, to in zip(a, b, strict=True))
    return x, y, z


def _start(tool: CycleTool) -> tuple[float, float, float]:
    return tool.length(225), tool.length(226), tool.length(227)


def _rows(tool: CycleTool) -> int:
    count = int(tool.plain(240))
    if not 2 <= count <= _MOST_ROWS:
        raise tool.refuse(
            Message("Q240={count} is not a valid number of cuts.", count=count),
            (Message("Enter a number from 2 to {most_rows}.", most_rows=_MOST_ROWS)),
        )
    return count


# --- faces by strategy


@dataclass(frozen=True, slots=True)
class _Face:
    """A rectangle from ``corner``: ``length`` along the rows, ``width`` across them, signed; mm.

    ``turned`` runs the rows along the second axis.
    """

    corner: Point
    length: float
    width: float
    turned: bool = False

    def at(self, along: float, across: float) -> Point:
        """The point so far from the corner, both counted into the face."""
        u, v = math.copysign(along, self.length * along), math.copysign(across, self.width * across)
        return (
            (self.corner[0] + v, self.corner[1] + u)
            if self.turned
            else (self.corner[0] + u, self.corner[1] + v)
        )


def face_milling(tool: CycleTool) -> Iterator[Block]:
    """232: Q218 by Q219 from Q225 Q226, from the height Q227 down to Q386, the last Q369 at Q385."""
    face = _Face((tool.length(225), tool.length(226)), tool.length(218), tool.length(219))
    yield from _faced(tool, face, both=True)


def face_milling_by_place(tool: CycleTool) -> Iterator[Block]:
    """233: as 232 from where the tool stands (Q367), along Q350; limits at its sides are not built."""
    if any(tool.plain(q, 0.0) for q in (347, 348, 349)):
        raise tool.refuse(
            "Cycle 233 with a limit (Q347, Q348, Q349) is not supported.",
            ("Set Q347, Q348 and Q349 to 0, or mill a pocket."),
        )
    a, b = tool.length(218), tool.length(219)
    place = int(tool.plain(367, -1.0))
    back = {-1: (0.0, 0.0), 0: (a / 2.0, b / 2.0), 1: (0.0, 0.0), 2: (a, 0.0), 3: (a, b), 4: (0.0, b)}.get(
        place
    )
    if back is None:
        raise tool.refuse("Q367 must be a whole number from -1 to 4.", "Correct Q367.")
    corner = tool.here[0] - back[0], tool.here[1] - back[1]
    turned = int(tool.plain(350, 1.0)) == 2
    face = _Face(corner, b, a, True) if turned else _Face(corner, a, b)
    scope = int(tool.plain(215, 0.0))
    yield from _faced(tool, face, both=scope == 0, finish=scope == _FINISH)


def _faced(tool: CycleTool, face: _Face, *, both: bool, finish: bool = False) -> Iterator[Block]:
    top, bottom = tool.length(227), tool.length(386)
    if bottom > top + SMALLEST:
        raise tool.refuse("End point Q386 is above start point Q227.", "Correct Q227 or Q386.")
    left, clear = tool.length(369, 0.0), top + tool.length(200)
    safe = max(clear, top + tool.length(204, 0.0))
    feed, last = tool.cut(207), tool.cut(385) if tool.plain(385, 0.0) else tool.cut(207)
    rough = max(top - bottom - left, 0.0)
    levels = [] if finish or rough < SMALLEST else [(top - z, feed) for z in _even(tool, rough)]
    if finish or (both and left > SMALLEST) or top - bottom < SMALLEST:
        levels.append((bottom, last))
    yield tool.to(max(safe, tool.height))
    for z, rate in levels:
        yield from _level(tool, face, z, clear, rate)
    yield tool.to(safe)


def _even(tool: CycleTool, whole: float) -> list[float]:
    """Depths in even infeeds of no more than Q202 (manual)."""
    step = tool.length(202)
    count = max(1, math.ceil(whole / step - SMALLEST)) if step > SMALLEST else 1
    return list(infeeds(tool, whole, whole / count))


def _level(tool: CycleTool, face: _Face, z: float, clear: float, feed: float) -> Iterator[Block]:
    """The face at one height, row by row, begun outside of it.

    Each row takes the same width, and the edge of the tool reaches just that far: nothing stays between two.
    """
    kind, radius = int(tool.plain(389, 0.0)), tool.radius
    if not _OUTSIDE <= kind <= _SPIRAL:
        raise tool.refuse(
            Message("Q389={kind} is not a valid strategy.", kind=kind), "Enter a number from 0 to 4."
        )
    if kind == _SPIRAL:
        tool.tell("the face is milled in back-and-forth passes, not in a spiral.")
    length, width = abs(face.length), abs(face.width)
    place = tool.cut(253)
    out = radius + tool.length(357, 0.0)
    over = 0.0 if kind in {_INSIDE, _LINE_INSIDE} else out
    step = _step(tool, width)
    count = round(width / step)
    yield tool.to(clear)
    for row in range(1, count + 1):
        across = row * step - radius
        begin, end = (
            (-over, length + over) if row % 2 or kind in {_LINE, _LINE_INSIDE} else (length + over, -over)
        )
        if row == 1 or kind in {_LINE, _LINE_INSIDE}:
            yield tool.across(face.at(-out, across), None, None if row == 1 else place)
            yield tool.to(z, place)
        else:
            yield tool.across(face.at(begin, across), None, feed)
        yield tool.across(face.at(end, across), None, feed)
        if kind in {_LINE, _LINE_INSIDE}:
            yield tool.to(clear)
    yield tool.to(clear)


def _step(tool: CycleTool, width: float) -> float:
    """The width of a row: even, and no more than Q370 tool radii."""
    overlap = tool.plain(370, 1.0)
    if not 0.0 < overlap < 2.0 or tool.radius <= SMALLEST or width <= SMALLEST:
        text = Message(
            "With path overlap Q370={overlap} and tool radius {radius} mm, the cycle cannot clear the area.",
            overlap=f"{overlap:g}",
            radius=f"{tool.radius:g}",
        )
        raise tool.refuse(
            text, ("Set Q370 between 0.1 and 1.9999, and enter the tool radius and the side lengths.")
        )
    count = max(1, math.ceil(width / (overlap * tool.radius) - SMALLEST))
    if count > _MOST_ROWS:
        raise tool.refuse(
            Message("Facing would need {count} passes, which is too many.", count=count), "Use a larger tool."
        )
    return width / count


FACES: dict[int, Callable[[CycleTool], Iterator[Block]]] = {
    230: multipass_milling,
    231: ruled_surface,
    232: face_milling,
    233: face_milling_by_place,
}
"""Cycles by their number."""
