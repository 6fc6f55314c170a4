"""The way to a compensated contour and off it again: far enough from the part, and clear of it."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from typing import NamedTuple

from core.geometry.arcs import Point
from core.geometry.contour import Element, Line
from core.geometry.extent import SAME_POINT
from core.geometry.meet import clearance, distance
from core.geometry.offset import NEARER
from core.interpreter import units
from core.interpreter.blocks import Block
from core.interpreter.log import Log, refusal
from core.language.diagnostics import ProgramError

# An approach of one nose radius along the first move itself passes its start at .71 of the radius.
_BESIDE = 0.5


class Lead(NamedTuple):
    """An approach or a departure. ``contour``: the moves that it leads to or from, the nearest first."""

    block: Block
    departs: bool
    code: int  # 41 or 42
    radius: float  # of the nose, mm
    contour: Sequence[Element]

    @property
    def name(self) -> str:
        """What messages call it."""
        return "departure" if self.departs else "approach"

    def refused(self, why: str, text: str, hint: str) -> ProgramError:
        """An error of this way."""
        return ProgramError(refusal(self.block.line, 0, f"comp-{self.name}{why}", text, hint))


def check_distance(lead: Lead, free: Point, corner: Point, log: Log) -> None:
    """The end off the part, as programmed, must be R or more from it, and better 2R: else a warning.

    ``corner`` is where the contour begins or ends. Raises ProgramError.
    """
    metric, radius = lead.block.modal.metric, lead.radius
    nose = units.length(radius, metric=metric)
    if dist(free, corner) < radius - SAME_POINT:
        length = units.length(dist(free, corner), metric=metric)
        text = f"The {lead.name} is {length} long, less than the nose radius {nose}."
        raise lead.refused("-short", text, "Move farther off the part.")
    off = min(distance(element, free) for element in lead.contour)
    shown = units.length(off, metric=metric)
    text = f"The {lead.name} {'ends' if lead.departs else 'starts'} {shown} off the part"
    hint = "Keep twice the nose radius off the part."
    if off < radius - SAME_POINT:
        raise lead.refused("-near", f"{text}, less than the nose radius {nose}.", hint)
    if off < 2 * radius - SAME_POINT:
        text = f"{text}, less than twice the nose radius {nose}."
        log.warn(lead.block.line, 0, f"comp-{lead.name}-near", text, hint)


def check_clear(lead: Lead, way: Line) -> None:
    """The nose on its way must not cut the part. Raises ProgramError.

    Next to the contour's end it always comes nearer than R where it does not come square; there _BESIDE of R
    is asked.
    """
    if way.length < SAME_POINT:
        return
    far = 0.0
    for element in lead.contour:
        least = lead.radius * _BESIDE if far < 2 * lead.radius else lead.radius - NEARER
        far += element.length
        if clearance(way, element) < least - SAME_POINT:
            text = f"On the {lead.name} the nose of G{lead.code} cuts into the part."
            hint = f"Choose another way for the {lead.name}, or the other side."
            raise ProgramError(refusal(lead.block.line, 0, "comp-gouge", text, hint))
