"""Blocks for the tests of the time law, made the way the interpreter makes them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.motion.axis_limits import MotionLimits

Point = tuple[float, float]

V, A, T = 127.0, 3048.0, 0.001  # mm/s, mm/s², s: the shipped lathe
LIMITS = MotionLimits(vmax=(V, V, 1200.0), amax=(A, A, 12000.0), interval=T)


def line(
    start: Point, end: Point, feed: float = 50.0, *, n: int = 1, kind: BlockKind = BlockKind.FEED
) -> Block:
    """A straight move from (x, z) to (x, z), mm and mm/s."""
    return Block(
        n=n,
        line=n,
        kind=kind,
        text="",
        x0=start[0],
        z0=start[1],
        c0=0.0,
        x=end[0],
        z=end[1],
        c=0.0,
        offset_x=0.0,
        offset_z=0.0,
        modal=ModalState(),
        feed=feed,
    )


def arc(
    start: Point, end: Point, centre: Point, feed: float = 50.0, *, n: int = 1, clockwise: bool = True
) -> Block:
    """A circular move from (x, z) to (x, z) round the centre (x, z)."""
    block = line(start, end, feed, n=n, kind=BlockKind.ARC)
    return replace(block, cx=centre[0], cz=centre[1], clockwise=clockwise)


def polyline(points: Sequence[Point], feed: float = 50.0) -> list[Block]:
    """Straight moves through the points, numbered from 1."""
    return [line(a, b, feed, n=i) for i, (a, b) in enumerate(pairwise(points), start=1)]


def chords(radius: float, angle: float, count: int, feed: float) -> list[Block]:
    """``count`` chords of a circle round the origin, starting at z = radius, clockwise."""
    steps = [angle * i / count for i in range(count + 1)]
    return polyline([(radius * math.sin(t), radius * math.cos(t)) for t in steps], feed)


def rounded_chords(count: int, feed: float, grid: float) -> list[Block]:
    """Chords of 0.02 mm of a circle of R 50 mm whose ends lie on a grid, as words of a program do."""
    turns = [0.0004 * i for i in range(count + 1)]
    ends = [(50.0 * math.sin(t), 50.0 * math.cos(t)) for t in turns]
    return polyline([(round(x / grid) * grid, round(z / grid) * grid) for x, z in ends], feed)


def backwards(blocks: Sequence[Block]) -> list[Block]:
    """The same path from its end to its start."""
    return [
        replace(b, n=i, x0=b.x, z0=b.z, c0=b.c, x=b.x0, z=b.z0, c=b.c0, clockwise=not b.clockwise)
        for i, b in enumerate(reversed(blocks), start=1)
    ]


def _bulged(start: Point, end: Point, half: float) -> Point:
    """Centre of the clockwise arc from start to end that turns through 2·half."""
    dx, dz = end[0] - start[0], end[1] - start[1]
    reach = 0.5 / math.tan(half)
    return 0.5 * (start[0] + end[0]) + reach * -dz, 0.5 * (start[1] + end[1]) + reach * dx


_step = st.tuples(
    st.sampled_from([0.02, 0.3, 5.0, 60.0]),  # length, mm
    st.integers(0, 23),  # direction, 15 degrees each
    st.sampled_from([0.4, 8.0, 60.0, 126.0, 200.0]),  # mm/s
    st.sampled_from([None, None, 0.3, 1.2, 2.8]),  # half the angle of an arc
    st.booleans(),
)


@st.composite
def programs(draw: st.DrawFn, most: int = 12) -> list[Block]:
    """Random lines and arcs of very different lengths and feeds, corners and reversals among them."""
    at, blocks = (0.0, 0.0), []
    for i, (size, way, feed, half, rapid) in enumerate(draw(st.lists(_step, min_size=1, max_size=most)), 1):
        to = (at[0] + size * math.sin(way * math.pi / 12), at[1] + size * math.cos(way * math.pi / 12))
        if half is None:
            blocks.append(line(at, to, feed, n=i, kind=BlockKind.RAPID if rapid else BlockKind.FEED))
        elif rapid:
            blocks.append(arc(at, to, _bulged(at, to, half), feed, n=i))
        else:
            blocks.append(arc(at, to, _bulged(at, to, math.pi - half), feed, n=i, clockwise=False))
        at = to
    return blocks
