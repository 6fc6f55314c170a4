"""Moves that end elsewhere than programmed, cut at a corner or beside it by the nose; for every language."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace

from core.geometry.lines_and_arcs import Arc, Element, Line, Point, arc_between
from core.interpreter.actions import SpindleRun
from core.interpreter.elementary_blocks import Block, Kind


def element_of(block: Block) -> Element:
    """The line or arc of a move, in the program's frame with the secondary offset in it."""
    start, end = (block.x0, block.z0), (block.x, block.z)
    if block.kind is Kind.ARC:
        return arc_between(start, end, (block.cx, block.cz), clockwise=block.clockwise)
    return Line(start, end)


class AdjustedMoves(ABC):
    """How a language writes the blocks of such moves."""

    @property
    @abstractmethod
    def highest_rpm(self) -> float:
        """The speed limit of the spindle."""

    @abstractmethod
    def along(self, block: Block, element: Element) -> Block:
        """The block's own move along another element of its kind."""

    @abstractmethod
    def inserted(self, block: Block, element: Element) -> Block:
        """A move of its own after ``block``, of the same line, feed and state, along an element."""

    def standing(self, block: Block, point: Point) -> Block:
        """A block in which nothing moves, at another point."""
        x, z = point
        rpm = self._rpm(block, x)
        action = block.action
        if isinstance(action, SpindleRun) and action.surface_speed is not None:
            action = SpindleRun(rpm, action.surface_speed)
        return replace(block, x0=x, z0=z, x=x, z=z, rpm=rpm, action=action)

    def _placed(self, block: Block, element: Element, text: str) -> Block:
        (x0, z0), (x, z) = element.start, element.end
        rpm = self._rpm(block, x)
        if isinstance(element, Arc):
            return replace(
                block, kind=Kind.ARC, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm,
                cx=element.centre[0], cz=element.centre[1], clockwise=element.clockwise,
            )  # fmt: skip
        kind = Kind.FEED if block.kind is Kind.ARC else block.kind
        return replace(block, kind=kind, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm)

    def _rpm(self, block: Block, x: float) -> float:
        if block.css is None or not block.modal.spindle:
            return block.rpm
        return block.modal.surface_rpm_at(x, self.highest_rpm)
