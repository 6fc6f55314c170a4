"""Travel and direction of the C axis to a target from its present position, in degrees.

The rules cover a modulo axis (0 to below 360), a rotary axis without modulo (-360 to +360), and a linear axis
in mm. This module is independent of words, offsets and machines.
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
    """The target is not possible; ``number`` is the alarm, and ``str()`` is the message."""

    def __init__(self, number: int, text: str) -> None:
        super().__init__(text, str(number))
        self.number = number


def wrapped(angle: float) -> float:
    """Return the angle from 0 to below 360; an angle within rounding of 360 is 0."""
    rest = angle % TURN
    return 0.0 if TURN - rest <= ROUNDING else rest


def modulo_travel(form: Form, value: float, position: float) -> float:
    """Return the signed travel of a modulo axis to ``value``, or by ``value`` (IC), in degrees.

    ``position`` may include any number of revolutions. Raises TargetError for a target that is not from 0 to
    below 360.
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
    """Return the signed travel of an axis without modulo to ``value``, or by ``value`` (IC).

    Raises TargetError for DC, ACP and ACN, which need a modulo rotary axis.
    """
    if form in NO_ROTARY:
        raise TargetError(NO_ROTARY[form], Message("{form} needs a modulo rotary axis", form=form))
    return value if form is Form.IC else _unless_noise(value - position)


def check_reach(end: float, ends: tuple[float, float] | None = TURNS) -> None:
    """Raise TargetError if the end is outside the range of the axis in machine coordinates."""
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
