"""M128 and FUNCTION TCPM: the tip keeps to its path while rotary axes move."""

from __future__ import annotations

import math

from core.geometry.rotary_axes import PivotMove
from core.geometry.rotation_frames import Vector, applied, plus
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.klartext.klartext_state import SAME_POINT, SLIDES, State
from core.interpreter.klartext.path_elements import PathElement


def switch(state: State, *, on: bool) -> None:
    """From now on the tip is led with the rotary axes, or no longer."""
    state.m128 = on
    state.derive()


def swivelled(state: State, element: PathElement) -> Block:
    """A straight way of the tip on the workpiece while rotary axes turn in proportion.

    The feed counts mm of the tip's way; where the tip stands, degrees.
    """
    first, last = (_parallel(state, state.figure.plane(at)) for at in (element.start, element.end))
    start = state.rotary
    end = start | dict(element.rotary)
    way = math.dist(first, last)
    turn = math.hypot(*(end[name] - at for name, at in start.items()))
    moves = way > SAME_POINT
    led = PivotMove(
        state.kinematics,
        start,
        end,
        first,
        0.0,
        state.tool_length,
        way if moves else turn,
        last if moves else None,
    )
    goals = led.goals()
    rate = None if element.feed is None else (state.path_feed(element.feed) if moves else element.feed / 60.0)
    kind = Kind.RAPID if rate is None else Kind.FEED
    if turn <= SAME_POINT:
        return state.move(kind, {name: goals[name] for name in SLIDES}, rate)
    return state.move(kind, goals, rate, led)


def _parallel(state: State, point: Vector) -> Vector:
    """A point of the working plane in the machine-parallel system at the workpiece's zero, mm."""
    frame = state.plane.frame if state.plane is not None else state.kinematics.basic
    return plus(applied(state.kinematics.basic, state.origin), applied(frame, point))
