"""Real-time bytes, modes, and what alarms and errors of the controller mean."""

from __future__ import annotations

# The range from 0x80 on: its older twins ? ~ ! are plain text inside comments and $ lines.
STATUS, START, HOLD, JOG_CANCEL, FULL = 0x80, 0x81, 0x82, 0x85, 0x87
RESET, STOP = 0x18, 0x19
FEED_100, FEED_UP_10, FEED_DOWN_10, FEED_UP_1, FEED_DOWN_1 = range(0x90, 0x95)
RAPID_100, RAPID_50, RAPID_25 = 0x95, 0x96, 0x97
SPINDLE_100, SPINDLE_UP_10, SPINDLE_DOWN_10, SPINDLE_UP_1, SPINDLE_DOWN_1 = range(0x99, 0x9E)

MODES = ("G8", "G18", "G21", "G90", "G94", "G54")  # radius for ever; no reset may change what X means

ESTOP, HOMING_REQUIRED = 10, 11
LOST = frozenset((1, 3))  # alarms behind which nobody knows where the slides are
_ALARMS = {
    1: "hard limit: a slide has hit its switch",
    2: "soft limit: a block leaves the controller's travel",
    3: "reset while moving: the position is lost",
    4: "probe failed",
    5: "probe failed",
    6: "homing failed: reset",
    7: "homing failed: door opened",
    8: "homing failed: the switch did not open",
    9: "homing failed: no switch found",
    10: "E-stop",
    11: "homing required",
    14: "spindle: it does not turn, or its index is missing",
    16: "power supply",
    17: "motor fault",
    19: "Modbus: the spindle's inverter does not answer",
    20: "I/O expander",
}
_ERRORS = {
    2: "bad number",
    5: "this setting is disabled: homing is off in the controller ($22)",
    8: "only possible in Idle",
    9: "locked by an alarm or a jog",
    11: "line too long",
    15: "jog target beyond the travel",
    16: "bad jog command",
    20: "unsupported command",
    22: "no feed",
    33: "the arc's target is not on its circle",
    39: "the controller has no such output",
    41: "the spindle does not turn",
    79: "E-stop is active",
}


def alarm_text(number: int) -> str:
    """One sentence of an alarm."""
    return f"controller ALARM:{number}, {_ALARMS.get(number, 'see the controller manual')}"


def error_text(number: int, line: str) -> str:
    """One sentence of an error and the line that it answers."""
    return f"the controller refuses {line!r} with error:{number}, {_ERRORS.get(number, 'see its manual')}"
