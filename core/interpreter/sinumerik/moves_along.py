"""A block's own move on other elements than it names: cut at a corner, or beside the contour by the nose."""

from __future__ import annotations

from dataclasses import replace

from core.geometry.lines_and_arcs import Element, Line
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.linear_moves import AxisTravel
from core.interpreter.sinumerik.sinumerik_state import State


def along(state: State, block: Block, element: Element) -> Block:
    """The block's own move along an element; a rapid takes the time of its slowest axis."""
    (x0, z0), (x, z) = element.start, element.end
    travel = AxisTravel(x0, z0, block.c0, x, z, block.c, block.modal, block.offset_x, block.offset_z)
    rapid = block.kind is Kind.RAPID
    feed = travel.rapid_rate(state.setup.limits.speeds) if rapid else block.feed
    made = replace(block, x0=x0, z0=z0, x=x, z=z, feed=feed, rpm=_rpm(state, block, x))
    if isinstance(element, Line):
        return made
    cx, cz = element.centre
    return replace(made, kind=Kind.ARC, cx=cx, cz=cz, clockwise=element.clockwise)


def inserted(state: State, block: Block, element: Element) -> Block:
    """What is put in behind a block: a move of X and Z alone; C has ended with the block."""
    bent = isinstance(element, Line) and block.kind is Kind.ARC
    straight = replace(block, kind=Kind.FEED) if bent else block
    return replace(along(state, straight, element), c0=block.c, text=f"{block.text} ›")


def _rpm(state: State, block: Block, x: float) -> float:
    if block.css is None or not block.modal.spindle:
        return block.rpm
    return state.rpm_at(x)
