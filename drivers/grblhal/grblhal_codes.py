"""Real-time bytes, modes, and what alarms and errors of the controller mean."""

from __future__ import annotations

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
    12: "a limit switch is pressed: move the slide off it",
    13: "probe protection",
    14: "spindle: it does not turn, or its index is missing",
    15: "homing failed: the second switch of an axis",
    16: "its self-test has failed: firmware and board do not fit",
    17: "motor fault",
    18: "homing failed",
    19: "Modbus: the spindle's inverter does not answer",
    20: "I/O expander",
    LOCKED: "it is locked and says not why",
}
_ERRORS = {
    2: "bad number",
    3: "it does not know this line",
    5: "this kind of homing is off in the controller: set $22 to 3, or give the axis home method 37",
    8: "only possible in Idle",
    9: "locked by an alarm or a jog",
    10: "soft limits need homing",
    11: "line too long",
    13: "its door is open",
    15: "jog target beyond the travel",
    16: "bad jog command",
    18: "its reset input is active",
    20: "unsupported command",
    22: "no feed",
    33: "the arc's target is not on its circle",
    39: "a value is out of range: no such output or input, or a thread without a lead",
    41: "the spindle does not turn",
    43: "lead times spindle speed is more than 0.9 of the Z axis' $112",
    45: "a limit switch is pressed",
    46: "it has to be homed first",
    50: "E-stop is active",
    51: "motor fault",
    52: "the value is out of this setting's range",
    53: "it has no such setting",
    79: "a critical alarm stands: Reset first",
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
    return f"controller ALARM:{number}, {_ALARMS.get(number, 'see the controller manual')}"


def error_text(number: int, line: str) -> str:
    """One sentence of an error and the line that it answers."""
    return f"the controller refuses {line!r} with error:{number}, {_ERRORS.get(number, 'see its manual')}"
