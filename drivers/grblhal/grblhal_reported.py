"""Time that the firmware may take to acknowledge a line, by its own settings.

``spindle_control.c`` and ``coolant_control.c`` of grblHAL: M3, M4 and M5 wait for the measured speed where
the at-speed tolerance ($340) is set, at most for the delay of $394 (on) or $539 (off), or a minute where that
is 0; then comes ALARM:14. Without a tolerance they wait for the delay. M7 and M8 wait for $673. Meanwhile the
state is Idle, status reports are answered, and no later line is read.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

TOLERANCE, SPINDLE_ON, SPINDLE_OFF, COOLANT_ON = 340, 394, 539, 673
OLD_SPINDLE_ON = 392  # which firmware from before 2025 uses in the place of $394
AT_MOST = 60.0  # s; the firmware's limit where no delay is set
_SPINDLE = {3: SPINDLE_ON, 4: SPINDLE_ON, 5: SPINDLE_OFF}
_COOLANT = frozenset((7, 8))
_FUNCTION = re.compile(r"M0*(\d+)")


def longest_wait(line: str, settings: Mapping[int, str]) -> float:
    """Return the seconds that the firmware may wait before it acknowledges ``line``; 0 for most lines."""
    return max((_wait(int(number), settings) for number in _FUNCTION.findall(line)), default=0.0)


def _wait(function: int, settings: Mapping[int, str]) -> float:
    if function in _COOLANT:
        return _value(settings, COOLANT_ON)
    if function not in _SPINDLE:
        return 0.0
    number = _SPINDLE[function]
    delay = _value(settings, number if number in settings else OLD_SPINDLE_ON)
    return delay if _value(settings, TOLERANCE) <= 0.0 or delay > 0.0 else AT_MOST


def _value(settings: Mapping[int, str], number: int) -> float:
    return float(settings.get(number, "0"))
