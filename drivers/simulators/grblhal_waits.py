"""The waits of the simulated firmware inside M3, M4, M5, M7 and M8.

As ``spindle_set_state_wait`` and ``coolant_set_state`` of grblHAL do: no line is acknowledged or read in a
wait, reports are answered, and a feed hold stops its clock.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from drivers.simulators.grblhal_settings import Registers
from drivers.simulators.spindle_motor import TurnedSpindle

TOLERANCE, SPINDLE_ON, SPINDLE_OFF, COOLANT_ON = 340, 394, 539, 673
_AT_MOST = 60.0  # s without a delay
_LOOK = 0.2  # s between two looks at the speed
_STANDS = 1.0  # rpm


class Waiting(Protocol):
    """What a wait reads of the controller."""

    registers: Registers
    spindle: TurnedSpindle
    k: float
    hold: bool

    @property
    def commanded(self) -> float: ...


@dataclass(slots=True)
class Wait:
    """One wait: ``left`` seconds, ended earlier by the speed where ``tolerance`` (percent) is above 0."""

    left: float
    tolerance: float
    since: float
    look_in: float = _LOOK
    failed: bool = False  # the speed was not reached: ALARM:14

    def is_over(self, m: Waiting) -> bool:
        """Let time pass up to the controller's; whether the wait has ended."""
        passed, self.since = m.k - self.since, m.k
        if m.hold:
            return False
        self.left, self.look_in = self.left - passed, self.look_in - passed
        if self.tolerance <= 0.0:
            return self.left <= 0.0
        if self.look_in > 1e-9:
            return False
        self.look_in += _LOOK
        slack = abs(m.commanded) * self.tolerance / 100.0 + _STANDS
        self.failed = self.left < -1e-9
        return self.failed or abs(m.spindle.speed - m.commanded) <= slack


def spindle_wait(m: Waiting, *, on: bool) -> Wait | None:
    """The wait of M3, M4 or M5; None where its settings are 0."""
    delay, tolerance = m.registers[SPINDLE_ON if on else SPINDLE_OFF], m.registers[TOLERANCE]
    if not delay and not tolerance:
        return None
    return Wait(delay or _AT_MOST, tolerance, m.k)


def coolant_wait(m: Waiting) -> Wait | None:
    """The wait of M7 or M8; None where its setting is 0."""
    delay = m.registers[COOLANT_ON]
    return Wait(delay, 0.0, m.k) if delay else None
