"""Where a word sends the axis C, and which way round: signed travel from the actual position. Degrees.

The table is that of the modulo axis 0..<360 and of the axis that does not wrap, -360..+360 or a slide between
its ends in mm; nothing here knows of words,
offsets or machines, so that it can be tried with any numbers.
"""

from __future__ import annotations

from math import inf

from core.language.sinumerik.sinumerik_words import Form
from core.message import CodedError, Message

TURN = 360.0
TURNS = (-TURN, TURN)
"""Ends of a C that does not wrap."""

ROUNDING = 1e-9
"""Degrees that are noise of sums in binary: a target as near as this is reached."""

WRONG_MODULO = 16830
WRONG_RANGE = 10720
NO_ROTARY = {Form.DC: 16800, Form.ACP: 16810, Form.ACN: 16820}
"""Alarms of the forms that only a modulo rotary axis takes."""


class TargetError(CodedError):
    """No such target; ``number`` of the alarm, ``str()`` says why."""

    def __init__(self, number: int, text: str) -> None:
        super().__init__(text, str(number))
        self.number = number


def wrapped(angle: float) -> float:
    """The angle as a modulo axis shows it, 0..<360; what is a turn but for noise is 0."""
    rest = angle % TURN
    return 0.0 if TURN - rest <= ROUNDING else rest


def modulo_travel(form: Form, value: float, position: float) -> float:
    """Signed travel of a modulo axis from ``position`` (any number of turns) to ``value``, or by it (IC).

    Raises TargetError for a target outside 0..<360.
    """
    if form is Form.IC:
        return value
    if not 0.0 <= value < TURN:
        raise TargetError(
            WRONG_MODULO,
            Message(
                "{value} is not a valid position of a modulo axis; valid positions are from 0 "
                "to less than 360",
                value=f"{value:.9g}",
            ),
        )
    at = wrapped(position)
    if form is Form.AC:
        return _unless_noise(value - at)
    travel = wrapped(value - at)
    if travel <= ROUNDING:
        return 0.0
    if form is Form.ACP:
        return travel
    if form is Form.ACN:
        return travel - TURN
    return travel if travel <= TURN / 2 + ROUNDING else travel - TURN


def linear_travel(form: Form, value: float, position: float) -> float:
    """Signed travel of an axis that does not wrap, from ``position`` to ``value``, or by it (IC).

    Raises TargetError for DC, ACP and ACN, which only a modulo rotary axis has.
    """
    if form in NO_ROTARY:
        raise TargetError(NO_ROTARY[form], Message("{form} needs a modulo rotary axis", form=form))
    return value if form is Form.IC else _unless_noise(value - position)


def check_reach(end: float, ends: tuple[float, float] | None = TURNS) -> None:
    """Raises TargetError where an axis would stand beyond its ends in the machine's own count."""
    low, high = ends or (-inf, inf)
    if not low - ROUNDING <= end <= high + ROUNDING:
        text = Message(
            "the end point {end} is outside the machine range of {low} to {high}",
            end=f"{end:g}",
            low=f"{low:g}",
            high=f"{high:+g}",
        )
        raise TargetError(WRONG_RANGE, text)


def _unless_noise(travel: float) -> float:
    return 0.0 if abs(travel) <= ROUNDING else travel
