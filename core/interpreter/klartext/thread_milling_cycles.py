"""Thread milling (262 to 265 inside, 267 outside): helices of a thread's pitch at its nominal diameter.

A right-hand thread is a helix that climbs counter-clockwise, so the sense of milling says which way the tool
works: climb milling inside runs counter-clockwise, outside clockwise. The feed Q207 is that of the cutting
edge: the tool's centre is slower inside and faster outside (manual).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from core.geometry.lines_and_arcs import Arc, Point
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.cycle_moves import CycleTool
from core.interpreter.klartext.hole_cycles import SMALLEST, heights, infeeds, out
from core.message import Message

_MOST_TURNS = 10_000


class _Thread:
    """What the parameters say of a thread; ``outside`` is that of a stud."""

    def __init__(self, tool: CycleTool, *, outside: bool = False) -> None:
        self.tool, self.middle, self.outside = tool, tool.here, outside
        self.surface, self.clear, self.bottom = heights(tool)
        self.pitch = tool.length(239)
        nominal = tool.length(335) / 2.0
        self.ring = nominal + tool.radius if outside else nominal - tool.radius
        if self.pitch == 0.0:
            raise tool.refuse("Pitch Q239 must not be 0.", "Enter the thread pitch.")
        if self.ring < SMALLEST or tool.radius <= SMALLEST:
            text = Message(
                "A tool with R {radius} mm cannot mill a thread of diameter {nominal} mm.",
                radius=f"{tool.radius:.10g}",
                nominal=f"{2 * nominal:.10g}",
            )
            raise tool.refuse(text, "Use another tool, or correct Q335.")
        self.feed = tool.cut(207) * self.ring / nominal
        self.place = tool.cut(253)

    @property
    def counter_clockwise(self) -> bool:
        """Sense by Q351: climb milling has the material on its right with M3."""
        climbs = self.tool.plain(351, 1.0) >= 0.0
        return (climbs == (self.tool.rpm > 0.0)) != self.outside

    def paths(self, per_step: int, *, upwards: bool) -> list[tuple[float, int]]:
        """Begin and whole turns of each helix: Q355 0 one turn, 1 over the whole depth, n every n pitches."""
        rise, depth = abs(self.pitch), self.surface - self.bottom
        if per_step == 0:
            return [(self.bottom if upwards else self.bottom + rise, 1)]
        turns = math.ceil(depth / (rise * per_step) - SMALLEST)
        if turns > _MOST_TURNS:
            raise self.tool.refuse(
                Message(
                    ("The thread would need {revolutions} helical turns, which is too many."),
                    revolutions=turns,
                ),
                ("Correct the pitch and the depth."),
            )
        if per_step == 1:
            return [(self.bottom if upwards else self.bottom + turns * rise, turns)]
        begins = [self.bottom + at * per_step * rise for at in range(turns)]
        return [(z, 1) for z in begins] if upwards else [(z + rise, 1) for z in reversed(begins)]


def thread_milling(tool: CycleTool) -> Iterator[Block]:
    """262: in a hole that is there."""
    thread = _Thread(tool)
    yield tool.to(thread.clear)
    if thread.surface - thread.bottom >= SMALLEST:
        yield from _milled(thread, int(tool.plain(355, 0.0)))
    yield from out(tool, thread.surface, thread.clear, None)


def thread_milling_with_countersink(tool: CycleTool) -> Iterator[Block]:
    """263: the hole's edge is sunk to Q356 and at the front, then one turn of thread."""
    thread = _Thread(tool)
    yield tool.to(thread.clear)
    if tool.length(356, 0.0) < -SMALLEST:
        depth = thread.surface + tool.length(356)
        yield tool.to(min(depth + tool.length(200), thread.clear), thread.place)
        yield tool.to(depth, thread.tool.cut(254))
    yield from _sunk_at_front(thread)
    if thread.surface - thread.bottom >= SMALLEST:
        yield from _milled(thread, 0)
    yield from out(tool, thread.surface, thread.clear, None)


def thread_drilling(tool: CycleTool) -> Iterator[Block]:
    """264: drilled to Q356 from the solid, sunk at the front, one turn of thread."""
    thread = _Thread(tool)
    feed, depth = thread.tool.cut(206), -tool.length(356)
    if depth < SMALLEST:
        raise tool.refuse(
            "Hole depth Q356 must be negative (downward).", ("Enter the depth with a minus sign.")
        )
    breaking, back = tool.length(257, 0.0), tool.length(256, 0.2)
    yield tool.to(thread.clear)
    broken = 0.0
    for done in infeeds(tool, depth, tool.length(202)):
        while 0.0 < breaking < done - broken - SMALLEST:
            broken += breaking
            yield tool.to(thread.surface - broken, feed)
            yield tool.to(thread.surface - broken + back)
        broken = done
        yield tool.to(thread.surface - done, feed)
        if done < depth - SMALLEST:
            yield tool.to(thread.clear)
            yield tool.to(min(thread.clear, thread.surface - done + tool.length(258, 0.2)))
    yield tool.to(thread.clear)
    yield from _sunk_at_front(thread)
    if thread.surface - thread.bottom >= SMALLEST:
        yield from _milled(thread, 0)
    yield from out(tool, thread.surface, thread.clear, None)


def helical_thread_drilling(tool: CycleTool) -> Iterator[Block]:
    """265: a helix down from above the surface to the depth; sunk at the front before or after (Q360)."""
    thread = _Thread(tool)
    after = bool(tool.plain(360, 0.0))
    yield tool.to(thread.clear)
    if not after:
        yield from _sunk_at_front(thread)
    if thread.surface - thread.bottom >= SMALLEST:
        path = thread.paths(1, upwards=False)[0]
        yield from _one(thread, *path, ccw=thread.pitch < 0.0, upwards=False)
    if after:
        yield tool.to(thread.clear)
        yield from _sunk_at_front(thread)
    yield from out(tool, thread.surface, thread.clear, None)


def outside_thread(tool: CycleTool) -> Iterator[Block]:
    """267: on a stud, its edge sunk at the front before."""
    thread = _Thread(tool, outside=True)
    yield tool.to(max(thread.clear, tool.height))
    if tool.length(359, 0.0) > SMALLEST and tool.length(358, 0.0) != 0.0:
        yield from _sunk_round_stud(thread)
    if thread.surface - thread.bottom >= SMALLEST:
        yield from _milled(thread, int(tool.plain(355, 0.0)))
    yield tool.to(max(thread.clear, thread.surface + tool.length(204, 0.0)))
    yield tool.across(thread.middle)


# --- helices ----------------------------------------------------------------------------------------------


def _milled(thread: _Thread, per_step: int) -> Iterator[Block]:
    if per_step < 0:
        raise thread.tool.refuse(
            Message("Q355={per_step} is not a valid number of threads.", per_step=per_step),
            ("Enter 0, 1 or a larger number."),
        )
    ccw = thread.counter_clockwise
    upwards = (thread.pitch > 0.0) == ccw
    for begin, turns in thread.paths(per_step, upwards=upwards):
        yield from _one(thread, begin, turns, ccw=ccw, upwards=upwards)


def _one(thread: _Thread, begin: float, turns: int, *, ccw: bool, upwards: bool) -> Iterator[Block]:
    """One helix from its beginning on the first axis, led to and off on arcs that rise as the thread does."""
    tool, rise = thread.tool, abs(thread.pitch) if upwards else -abs(thread.pitch)
    (x, y), ring = thread.middle, thread.ring
    on = x + ring, y
    to_it, off_it, turned = _leads(thread, ccw=ccw)
    if thread.outside:
        yield tool.to(thread.clear)
        yield tool.across(to_it.start)
        yield tool.to(begin - rise * turned, thread.place)
    else:
        yield tool.to(begin - rise * turned, thread.place)
    yield tool.round(to_it, begin, thread.feed)
    circle = Arc(on, on, thread.middle, not ccw)
    for turn in range(1, turns + 1):
        yield tool.round(circle, begin + turn * rise, thread.feed)
    yield tool.round(off_it, begin + (turns + turned) * rise, thread.feed)
    if thread.outside:
        yield tool.to(thread.clear)


def _leads(thread: _Thread, *, ccw: bool) -> tuple[Arc, Arc, float]:
    """The arcs to the helix and off it, and the part of a turn round the thread's middle that each takes.

    Inside half a circle between middle and ring; outside a quarter of the tool's radius.
    """
    (x, y), ring, sense = thread.middle, thread.ring, 1.0 if ccw else -1.0
    on = x + ring, y
    if not thread.outside:
        about = x + ring / 2.0, y
        return Arc(thread.middle, on, about, not ccw), Arc(on, thread.middle, about, not ccw), 0.25
    size = thread.tool.radius
    about = x + ring + size, y
    before, behind = (about[0], y - sense * size), (about[0], y + sense * size)
    turned = math.atan2(size, ring + size) / (2.0 * math.pi)
    return Arc(before, on, about, ccw), Arc(on, behind, about, ccw), turned


# --- countersinks -----------------------------------------------------------------------------------------


def _sunk_at_front(thread: _Thread) -> Iterator[Block]:
    """Q358 deep, the tool's middle Q359 off that of the hole: once round, by half circles from the middle."""
    tool, depth, off = thread.tool, thread.tool.length(358, 0.0), thread.tool.length(359, 0.0)
    if depth == 0.0:
        return
    if depth > 0.0:
        raise tool.refuse(
            "The depth at the front, Q358, is positive (upward).", ("Enter the depth with a minus sign.")
        )
    feed = thread.tool.cut(254)
    yield tool.to(thread.clear)
    yield tool.to(thread.surface + depth, thread.place if off > SMALLEST else feed)
    if off > SMALLEST:
        yield from _once_round(thread, off, feed)
    yield tool.to(thread.clear)


def _once_round(thread: _Thread, off: float, feed: float) -> Iterator[Block]:
    tool, (x, y) = thread.tool, thread.middle
    on: Point = (x + off, y)
    half = (x + off / 2.0, y)
    z = tool.height
    yield tool.round(Arc(thread.middle, on, half, False), z, feed)
    yield tool.round(Arc(on, on, thread.middle, False), z, feed)
    yield tool.round(Arc(on, thread.middle, half, False), z, feed)


def _sunk_round_stud(thread: _Thread) -> Iterator[Block]:
    """The edge of a stud: Q358 deep, the tool's middle Q359 off the stud's, once round."""
    tool, (x, y) = thread.tool, thread.middle
    depth, off = tool.length(358), tool.length(359)
    if depth > 0.0:
        raise tool.refuse(
            "The depth at the front, Q358, is positive (upward).", ("Enter the depth with a minus sign.")
        )
    feed, size = thread.tool.cut(254), tool.radius
    on, begin, end = (x + off, y), (x + off + size, y + size), (x + off + size, y - size)
    about = x + off + size, y
    yield tool.to(thread.clear)
    yield tool.across(begin)
    yield tool.to(thread.surface + depth, thread.place)
    z = tool.height
    yield tool.round(Arc(begin, on, about, False), z, feed)
    yield tool.round(Arc(on, on, thread.middle, True), z, feed)
    yield tool.round(Arc(on, end, about, False), z, feed)
    yield tool.to(thread.clear)


THREADS: dict[int, Callable[[CycleTool], Iterator[Block]]] = {
    262: thread_milling,
    263: thread_milling_with_countersink,
    264: thread_drilling,
    265: helical_thread_drilling,
    267: outside_thread,
}
"""Cycles by their number."""
