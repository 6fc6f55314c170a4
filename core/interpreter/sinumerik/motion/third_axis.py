"""Calculation of the travel of the third axis from its current position to a target.

The rules cover a modulo axis (0 to less than 360 degrees), a rotary axis without modulo (-360 to +360
degrees), and a linear axis in mm. This module does not depend on words, offsets and machines.
"""

from __future__ import annotations

from math import inf

from core.language.sinumerik.sinumerik_words import PositionMode
from core.message import CodedError, Message

FULL_REVOLUTION_DEG = 360.0
NON_MODULO_RANGE = (-FULL_REVOLUTION_DEG, FULL_REVOLUTION_DEG)
"""Travel limits in degrees of a C axis that is not a modulo axis."""

ROUNDING_TOLERANCE = 1e-9
"""Tolerance in degrees for rounding in binary sums. A target within it is treated as reached."""

WRONG_MODULO_POSITION = 16830
WRONG_AXIS_RANGE = 10720
MODULO_ONLY_ALARMS = {PositionMode.DC: 16800, PositionMode.ACP: 16810, PositionMode.ACN: 16820}
"""Alarm numbers for position forms that require a modulo rotary axis, by form."""


class AxisTargetError(CodedError):
    """Error for a target position of the third axis that is not allowed.

    ``alarm_number`` is the number of the alarm, and ``str()`` returns the message.
    """

    def __init__(self, number: int, text: str) -> None:
        super().__init__(text, str(number))
        self.alarm_number = number


def wrap_angle(angle: float) -> float:
    """Return the angle in the range from 0 to less than 360 degrees.

    An angle that differs from 360 only by rounding becomes 0.
    """
    rest = angle % FULL_REVOLUTION_DEG
    return 0.0 if FULL_REVOLUTION_DEG - rest <= ROUNDING_TOLERANCE else rest


def compute_modulo_travel(form: PositionMode, value: float, position: float) -> float:
    """Return the signed travel of a modulo axis in degrees, to ``value`` or, for IC, by ``value``.

    ``position`` is the current position and may include any number of revolutions. Raises AxisTargetError
    for a target outside the range from 0 to less than 360.
    """
    if form is PositionMode.IC:
        return value
    if not 0.0 <= value < FULL_REVOLUTION_DEG:
        raise AxisTargetError(
            WRONG_MODULO_POSITION,
            Message(
                "{value} is not a valid position of a modulo axis; valid positions are from 0 "
                "to less than 360",
                value=f"{value:.9g}",
            ),
        )
    at = wrap_angle(position)
    if form is PositionMode.AC:
        return _unless_noise(value - at)
    travel = wrap_angle(value - at)
    if travel <= ROUNDING_TOLERANCE:
        return 0.0
    if form is PositionMode.ACP:
        return travel
    if form is PositionMode.ACN:
        return travel - FULL_REVOLUTION_DEG
    return travel if travel <= FULL_REVOLUTION_DEG / 2 + ROUNDING_TOLERANCE else travel - FULL_REVOLUTION_DEG


def compute_linear_travel(form: PositionMode, value: float, position: float) -> float:
    """Return the signed travel of an axis without modulo, to ``value`` or, with IC, by ``value``.

    Raises AxisTargetError for DC, ACP and ACN, which require a modulo rotary axis.
    """
    if form in MODULO_ONLY_ALARMS:
        raise AxisTargetError(
            MODULO_ONLY_ALARMS[form], Message("{form} needs a modulo rotary axis", form=form)
        )
    return value if form is PositionMode.IC else _unless_noise(value - position)


def check_axis_range(end_position: float, axis_range: tuple[float, float] | None = NON_MODULO_RANGE) -> None:
    """Raise AxisTargetError if the end position is outside the range of the axis in machine coordinates."""
    low, high = axis_range or (-inf, inf)
    if not low - ROUNDING_TOLERANCE <= end_position <= high + ROUNDING_TOLERANCE:
        text = Message(
            "the end point {end} is outside the machine range of {low} to {high}",
            end=f"{end_position:g}",
            low=f"{low:g}",
            high=f"{high:+g}",
        )
        raise AxisTargetError(WRONG_AXIS_RANGE, text)


def _unless_noise(travel: float) -> float:
    return 0.0 if abs(travel) <= ROUNDING_TOLERANCE else travel
