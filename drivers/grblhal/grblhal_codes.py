"""Real-time bytes, modes, and what alarms and errors of the controller mean."""

from __future__ import annotations

from core.message import Message
from core.ports import FaultCode

# The range from 0x80 on: its older twins ? ~ ! are plain text inside comments and $ lines.
STATUS, START, HOLD, TELL_MODES, JOG_CANCEL, FULL = 0x80, 0x81, 0x82, 0x83, 0x85, 0x87
RESET, STOP = 0x18, 0x19
FEED, SPINDLE = tuple(range(0x90, 0x95)), tuple(range(0x99, 0x9E))  # to 100 %, up and down by 10, by 1
RAPIDS = {100: 0x95, 50: 0x96, 25: 0x97}
SPINDLE_PAUSE = 0x9E  # in a feed hold only: stops the spindle, and starts it when it comes again

OFF = ("M5", "M9")  # spindle and coolant
# Radius for ever: no reset may change what X means. G97, or S would be a surface speed.
MODES = ("G8", "G18", "G21", "G90", "G94", "G97", "G54")
SILENT = frozenset(("G97",))  # modes that a controller without a variable spindle does not tell
# What another host may have left behind, by how ``$G`` tells it, and the line that ends it.
CURES = {"G96": "G97", "G51": "G50", "G43": "G49", "G92": "G92.1", "M50": "M48", "M51": "M48", "M53": "M53P1"}

DOOR = "the controller's safety door is open"
HOMING_REQUIRED = 11
LOCKED = 255  # ours: it is locked and tells no number
ERROR_LOCKED = 9  # error: locked by an alarm or a jog
LOST = frozenset((1, 3))  # alarms behind which nobody knows where the slides are
TORN = frozenset((10, 17))  # and those that end the steps of a moving slide at once, and do not say so
CRITICAL = frozenset((1, 2, 10, 17))  # only a reset ends them; settings cannot be written before
ENDED = CRITICAL | {HOMING_REQUIRED}  # alarms behind which nothing turns or runs any more
_ALARMS = {
    1: "hard limit: an axis has reached its limit switch",
    2: "soft limit: a block goes beyond the controller's travel limits",
    3: "reset during motion: the position is lost",
    4: "probe failed",
    5: "probe failed",
    6: "homing failed: the controller was reset",
    7: "homing failed: the door was opened",
    8: "homing failed: the homing switch did not release",
    9: "homing failed: no homing switch was found",
    10: "E-stop",
    11: "homing required",
    12: "a limit switch is pressed: move the axis off the switch",
    13: "probe protection",
    14: "the spindle does not turn, or its index signal is missing",
    15: "homing failed at the second homing switch of an axis",
    16: "the controller's self-test failed: the firmware does not match the board",
    17: "motor fault",
    18: "homing failed",
    19: "Modbus: no response from the spindle inverter",
    20: "I/O expander",
    LOCKED: "the controller is locked and does not report the reason",
}
_ERRORS = {
    2: "bad number",
    3: "the controller does not recognize this line",
    5: (
        "this type of homing is disabled in the controller: set $22 to 3, or set home method 37 for the axis"
    ),
    8: "this command is allowed only in the Idle state",
    9: "the controller is locked by an alarm or a jog",
    10: "soft limits require homing",
    11: "the line is too long",
    13: "the safety door is open",
    15: "the jog target is outside the travel limits",
    16: "invalid jog command",
    18: "the controller's reset input is active",
    20: "unsupported command",
    22: "no feed",
    33: "the end point is not on the arc's circle",
    39: "a value is out of range: the output or input does not exist, or a thread has no lead",
    41: "the spindle does not turn",
    43: "lead × spindle speed is more than 0.9 × the maximum speed of the Z axis ($112)",
    45: "a limit switch is pressed",
    46: "the controller must be homed first",
    50: "E-stop is active",
    51: "motor fault",
    52: "the value is outside the range of this setting",
    53: "the controller does not have this setting",
    79: "a critical alarm is active: press Reset first",
}


_OF_AXES: dict[int, FaultCode] = {
    1: "limit-switch",
    2: "drive-limits",
    3: "position-lost",
    10: "controller-estop",
    12: "limit-switch",
    17: "axis",
    19: "inverter-silent",
}
_HOMING = frozenset((6, 7, 8, 9, 15, 18))


def alarm_code(number: int) -> FaultCode:
    """What of the catalogue an alarm of the controller is."""
    return "homing" if number in _HOMING else _OF_AXES.get(number, "controller-alarm")


def alarm_text(number: int) -> str:
    """One sentence of an alarm."""
    return Message(
        "the controller reports ALARM:{number} ({number2})",
        number=number,
        number2=_ALARMS.get(number, "see the controller manual"),
    )


def error_text(number: int, line: str) -> str:
    """One sentence of an error and the line that it answers."""
    return Message(
        "the controller rejects {line} with error:{number} ({number2})",
        line=f"{line!r}",
        number=number,
        number2=_ERRORS.get(number, "see the controller manual"),
    )
