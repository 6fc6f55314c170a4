"""The blocks that lead on a lathe from where the slides stand to the line at which a program goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import copysign

from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import Begin, CTurn, FunctionStep, Leg
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.modal_state import Modal


def approach_blocks(
    begin: Begin, modal: Modal, start: Sequence[float], rpm_at: Callable[[float], float]
) -> Iterator[Block]:
    """The blocks of the way, numbered so that the first block of the line keeps its number of a full run.

    ``start`` is where the slides stand, ``rpm_at`` the speed commanded at a radius of the program's frame.
    """
    point, offsets = begin.checkpoint, (modal.offset_x, modal.offset_z, modal.offset_c)
    at = [value - offset for value, offset in zip(start, offsets, strict=False)]
    turning = 0.0
    for number, step in enumerate(begin.approach, start=point.blocks - len(begin.approach) + 1):
        x0, z0, c0 = at
        kind, feed, action = Kind.ACTION, 0.0, None
        match step:
            case Leg():
                kind, feed = Kind.RAPID if step.rapid else Kind.FEED, step.feed
                at[0] = x0 if step.x is None else step.x - modal.offset_x
                at[1] = z0 if step.z is None else step.z - modal.offset_z
            case CTurn():
                kind, feed = Kind.ROTATE, step.speed
                at[2] = step.c - modal.offset_c
            case FunctionStep():
                action = step.action
                if isinstance(action, SpindleRun | SpindleStop):
                    turning = rpm_at(at[0]) if isinstance(action, SpindleRun) else 0.0
        rpm = copysign(feed / 6.0, at[2] - c0) if kind is Kind.ROTATE else turning
        css = modal.surface_speed if modal.css and turning else None
        yield Block(
            number, begin.line, kind, step.text, x0, z0, c0, at[0], at[1], at[2],
            modal.offset_x, modal.offset_z, modal, feed, False, rpm, css, action=action,
        )  # fmt: skip
