"""Settings of the grblHAL simulator, its adjustable behavior, and its waits for the spindle and coolant.

The waits are those of ``spindle_set_state_wait`` and ``coolant_set_state`` in grblHAL. During a wait, no
line is read or acknowledged, reports are sent, and a feed hold stops the timer of the wait.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Protocol

from drivers.simulators.spindle_motor import SimulatedSpindle

# --- Behavior of the controller that can be switched.


@dataclass(slots=True)
class SimulatorBehavior:
    """Behavior of the simulator that tests can change.

    By default, the simulator behaves like the simulator that is supplied with grblHAL. In addition, it has
    an encoder, auxiliary ports and the settings of a machine file.
    """

    encoder: bool = True
    diameter: bool = False  # Starts in G7, as with $N0=G7.
    index_missing: bool = False
    outputs: int = 16
    inputs: int = 8
    build: str = "VNML+"  # Letters of $I: V variable spindle, M mist.
    # Control inputs of the board; the firmware's simulator has only D (door).
    signals: str | None = "RHSDLTEF"
    lathe: bool = True
    built_for_lathes: bool = False  # Always in lathe mode; $32 does not exist.
    homing: int | bool = 0  # Value of $22. True: 3 (single axes, homing not required).
    mute: bool = True  # Reads nothing while a thread waits for its index, as the firmware's simulator does.
    drip: float = 0.0  # Seconds between two bytes that are read, as on a busy computer.
    sends_nothing: bool = False  # Sends nothing.
    garbled_replies: list[bytes] = field(default_factory=list)  # Sent instead of the next ``ok``s.
    hold_broken: bool = False  # 0x82 does nothing
    stubborn: bool = False  # Ignores override commands.
    toggle_broken: bool = False  # 0x9E does nothing
    # Values that differ from those of the machine file.
    settings: dict[int, float] = field(default_factory=dict)


_NUMBER = re.compile(r"-?(\d+\.?\d*|\.\d+)")
_MODE, _LATHE = 32, 2
_DECIMALS = {11: 3, 12: 3, 24: 1, 25: 1, 27: 3, 30: 3, 31: 3, **dict.fromkeys((340, 394, 539, 673), 1)}
_AXES = {100: 5, 110: 3, 120: 3, 130: 3}  # first number of three, decimals
# Travel, rates and accelerations are those of the machine file, so that programs take the forecast time.
_DEFAULT_VALUES = {
    **{10: 511.0, 11: 0.01, 12: 0.002, 13: 0.0, 20: 0.0, 22: 0.0, 24: 25.0, 25: 500.0, 27: 1.0},
    **{30: 3500.0, 31: 0.0, 32: 2.0, 40: 0.0, 60: 0.0, 63: 3.0},
    **dict.fromkeys((340, 394, 539, 673), 0.0),  # waits for the spindle and for coolant
    **{100 + i: 800.0 for i in range(3)},
    **{110 + i: 7620.0 for i in range(3)},
    **{120 + i: 3000.0 for i in range(3)},
    **{130 + i: 200.0 for i in range(3)},
}


class SettingRegisters:
    """Values of the controller settings, with the setting numbers as keys."""

    def __init__(self, behavior: SimulatorBehavior) -> None:
        self._values = {
            **_DEFAULT_VALUES,
            22: 3.0 if behavior.homing is True else float(behavior.homing),
            **behavior.settings,
        }
        self._values[_MODE] = float(_LATHE) if behavior.lathe else 0.0
        if behavior.built_for_lathes:
            del self._values[_MODE]

    def __getitem__(self, number: int) -> float:
        return self._values[number]

    @property
    def is_in_lathe_mode(self) -> bool:
        """Return whether the controller is in lathe mode."""
        return self._values.get(_MODE, _LATHE) == _LATHE

    def format_settings(self) -> list[str]:
        """Return all settings as lines of the reply to ``$$``."""
        return [f"${n}={self._text(n)}" for n in sorted(self._values)]

    def store_setting(self, number: int, text: str) -> int:
        """Store a setting, and return the error code, or 0 if the setting is valid."""
        if number not in self._values:
            return 53
        begin = _NUMBER.match(text)  # Text after the number is ignored: 1e3 is 1.
        if begin is None:
            return 2
        value = float(begin[0])
        if number in {20, 40} and value and not int(self._values[22]) & 1:
            return 10
        self._values[number] = float(f"{value:.{self._decimals(number)}f}")
        return 0

    def _text(self, number: int) -> str:
        decimals = self._decimals(number)
        return f"{self._values[number]:.{decimals}f}"

    def _decimals(self, number: int) -> int:
        return _DECIMALS.get(number, _AXES.get(number // 10 * 10, 0) if number >= 100 else 0)


# --- Waits inside M3, M4, M5, M7 and M8.


TOLERANCE, SPINDLE_ON, SPINDLE_OFF, COOLANT_ON = 340, 394, 539, 673
_MAX_WAIT_S = 60.0  # Longest wait in s if no delay is set.
_CHECK_PERIOD_S = 0.2  # Seconds between two checks of the speed.
_STANDSTILL_RPM = 1.0  # rpm


class WaitContext(Protocol):
    """Values of the controller that a spindle or coolant wait reads."""

    registers: SettingRegisters
    spindle: SimulatedSpindle
    time_s: float
    is_in_hold: bool

    @property
    def commanded_rpm(self) -> float:
        """Return the commanded spindle speed in rpm, signed, with the override and the limits applied."""
        ...


@dataclass(slots=True)
class SpindleOrCoolantWait:
    """Wait of an M function; it ends after ``remaining_s`` seconds or when the spindle is at speed.

    The wait ends at speed only if ``tolerance_percent`` is greater than 0.
    """

    remaining_s: float
    tolerance_percent: float
    last_update_s: float
    time_to_check_s: float = _CHECK_PERIOD_S
    has_failed: bool = False  # The speed was not reached (ALARM:14).

    def update_and_check_end(self, context: WaitContext) -> bool:
        """Update the wait to the controller's current time, and return whether the wait has ended."""
        passed, self.last_update_s = context.time_s - self.last_update_s, context.time_s
        if context.is_in_hold:
            return False
        self.remaining_s, self.time_to_check_s = self.remaining_s - passed, self.time_to_check_s - passed
        if self.tolerance_percent <= 0.0:
            return self.remaining_s <= 0.0
        if self.time_to_check_s > 1e-9:
            return False
        self.time_to_check_s += _CHECK_PERIOD_S
        slack = abs(context.commanded_rpm) * self.tolerance_percent / 100.0 + _STANDSTILL_RPM
        self.has_failed = self.remaining_s < -1e-9
        return self.has_failed or abs(context.spindle.speed - context.commanded_rpm) <= slack


def create_spindle_wait(context: WaitContext, *, is_spindle_on: bool) -> SpindleOrCoolantWait | None:
    """Create the wait of M3, M4 or M5, or return None if the settings for the wait are 0."""
    delay, tolerance = (
        context.registers[SPINDLE_ON if is_spindle_on else SPINDLE_OFF],
        context.registers[TOLERANCE],
    )
    if not delay and not tolerance:
        return None
    return SpindleOrCoolantWait(delay or _MAX_WAIT_S, tolerance, context.time_s)


def make_coolant_delay(context: WaitContext) -> SpindleOrCoolantWait | None:
    """Create the wait of M7 or M8, or return None if the setting for the wait is 0."""
    delay = context.registers[COOLANT_ON]
    return SpindleOrCoolantWait(delay, 0.0, context.time_s) if delay else None
