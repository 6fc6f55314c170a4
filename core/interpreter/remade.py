"""Blocks that end elsewhere than they were programmed: cut at a corner, or moved aside by the nose."""

from __future__ import annotations

from dataclasses import replace

from core.geometry.arcs import Point
from core.geometry.contour import Arc, Element, Line, arc_between
from core.interpreter.actions import SpindleRun
from core.interpreter.blocks import Block, Kind
from core.interpreter.shown import move_words, with_other_words
from core.interpreter.spindle import surface_rpm_at


def element_of(block: Block) -> Element:
    """The line or arc of a move, in the program's frame with the secondary offset in it."""
    start, end = (block.x0, block.z0), (block.x, block.z)
    if block.kind is Kind.ARC:
        return arc_between(start, end, (block.cx, block.cz), clockwise=block.clockwise)
    return Line(start, end)


def follow(block: Block, element: Element, max_rpm: float) -> Block:
    """The block's own move along another element of its kind; its text says the new place."""
    if (block.x0, block.z0) == element.start and (block.x, block.z) == element.end:
        return block
    return _along(block, element, with_other_words(block, element), max_rpm)


def insert(block: Block, element: Element, max_rpm: float) -> Block:
    """A move of its own after ``block``, of the same line, feed and state, along an element."""
    return _along(block, element, move_words(block.modal, element), max_rpm)


def stand(block: Block, point: Point, max_rpm: float) -> Block:
    """A block in which nothing moves, at another point."""
    x, z = point
    rpm = _rpm(block, x, max_rpm)
    action = block.action
    if isinstance(action, SpindleRun) and action.surface_speed is not None:
        action = SpindleRun(rpm, action.surface_speed)
    return replace(block, x0=x, z0=z, x=x, z=z, rpm=rpm, action=action)


def _along(block: Block, element: Element, text: str, max_rpm: float) -> Block:
    (x0, z0), (x, z) = element.start, element.end
    rpm = _rpm(block, x, max_rpm)
    if isinstance(element, Arc):
        return replace(
            block, kind=Kind.ARC, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm,
            cx=element.centre[0], cz=element.centre[1], clockwise=element.clockwise,
        )  # fmt: skip
    kind = Kind.FEED if block.kind is Kind.ARC else block.kind
    return replace(block, kind=kind, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm)


def _rpm(block: Block, x: float, max_rpm: float) -> float:
    if block.css is None or not block.modal.spindle:
        return block.rpm
    return surface_rpm_at(block.modal, x, max_rpm)
