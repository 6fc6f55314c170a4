"""Real-time bytes, modes and G-code lines of grblHAL, and the texts of its alarms and errors.

Blocks are sent in mm, with X as a radius, in plane G18, with absolute positions and feed per minute.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from core.block_ports import ArcOperation, BlockOperation, LineOperation, RapidOperation, ThreadOperation
from core.message import Message
from core.ports import FaultCode

# The equivalent characters ? ~ ! would be plain text inside comments and $ lines.
STATUS, START, HOLD, TELL_MODES, JOG_CANCEL, FULL = 0x80, 0x81, 0x82, 0x83, 0x85, 0x87
RESET, STOP = 0x18, 0x19
# To 100 %, then up and down by 10 and by 1.
FEED, SPINDLE = tuple(range(0x90, 0x95)), tuple(range(0x99, 0x9E))
RAPID_OVERRIDES = {100: 0x95, 50: 0x96, 25: 0x97}
SPINDLE_PAUSE_BYTE = 0x9E  # In a feed hold only: stops or restarts the spindle.

OFF_CODES = ("M5", "M9")  # spindle and coolant
# X is always a radius, so that no reset changes its meaning. Without G97, S could be a surface speed.
REQUIRED_MODES = ("G8", "G18", "G21", "G90", "G94", "G97", "G54")
UNREPORTED_MODES = frozenset(("G97",))  # Modes that a controller without a variable spindle does not report.
# Modes that another host may have left active, as ``$G`` reports them, and the code that ends each.
MODE_RESETS = {
    "G96": "G97",
    "G51": "G50",
    "G43": "G49",
    "G92": "G92.1",
    "M50": "M48",
    "M51": "M48",
    "M53": "M53P1",
}

DOOR_OPEN_TEXT = "the controller's safety door is open"
HOMING_REQUIRED_ALARM = 11
LOCKED_ALARM = 255  # TurnDesk's own number: locked without a reported alarm number.
LOCKED_ERROR = 9  # error: locked by an alarm or a jog
POSITION_LOST_ALARMS = frozenset((1, 3))  # Alarms after which the position is unknown.
ABRUPT_STOP_ALARMS = frozenset(
    (10, 17)
)  # Alarms that stop a moving axis without a ramp and do not report it.
CRITICAL_ALARMS = frozenset((1, 2, 10, 17))  # Only a reset clears them; settings cannot be written before.
STANDSTILL_ALARMS = CRITICAL_ALARMS | {HOMING_REQUIRED_ALARM}  # Alarms after which nothing turns or moves.
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
    LOCKED_ALARM: "the controller is locked and does not report the reason",
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


_AXIS_ALARM_CODES: dict[int, FaultCode] = {
    1: "limit-switch",
    2: "drive-limits",
    3: "position-lost",
    10: "controller-estop",
    12: "limit-switch",
    17: "axis",
    19: "inverter-silent",
}
_HOMING = frozenset((6, 7, 8, 9, 15, 18))


def get_alarm_code(number: int) -> FaultCode:
    """Return the fault code in the alarm catalog for an alarm of the controller."""
    return "homing" if number in _HOMING else _AXIS_ALARM_CODES.get(number, "controller-alarm")


def describe_alarm(number: int) -> str:
    """Return a sentence that describes an alarm of the controller."""
    return Message(
        "the controller reports ALARM:{number} ({number2})",
        number=number,
        number2=_ALARMS.get(number, "see the controller manual"),
    )


def describe_line_error(number: int, line: str) -> str:
    """Return a sentence that describes an error of the controller and the rejected line."""
    return Message(
        "the controller rejects {line} with error:{number} ({number2})",
        line=f"{line!r}",
        number=number,
        number2=_ERRORS.get(number, "see the controller manual"),
    )


# --- Blocks as lines of G-code.


_MAX_LINE_NUMBER = 9_000_000
_MIN_ARC_MM = 0.002  # mm; see ``_format_arc``
_EQUAL_RAPID_RATIO = 1.01  # Rapids that differ by less than this ratio are equal.


def number(value: float) -> str:
    """Return a number as text with up to five decimals and without trailing zeros.

    In mm, the last decimal is a tenth of the finest motor step.
    """
    text = f"{value:.5f}".rstrip("0").rstrip(".")
    return "0" if text in {"-0", ""} else text


def get_ticket_line_number(ticket: int) -> int:
    """Return the line number (N word) for a ticket."""
    return (ticket - 1) % _MAX_LINE_NUMBER + 1


def format_block(
    operation: BlockOperation,
    ticket: int,
    rapid_speed: float,
    feed_override: float,
    home_position: Mapping[str, float] | None = None,
) -> str:
    """Return the G-code line of one block.

    ``rapid_speed`` is the speed of G0 on this path in mm/s. ``feed_override`` is a fraction.
    ``home_position`` is in the coordinates of the controller. A rapid that is slower than G0 is sent as a
    feed move, because the controller's rapid override has only three steps. A feed override above 1 does
    not make a rapid faster.
    """
    head = f"N{get_ticket_line_number(ticket)}"
    home = home_position or {}
    to = f"X{number(operation.x + home.get('X', 0.0))}Z{number(operation.z + home.get('Z', 0.0))}"
    match operation:
        case RapidOperation(rapid_rate=rate) if _EQUAL_RAPID_RATIO * rate >= rapid_speed:
            return f"{head}G0{to}"
        case RapidOperation(rapid_rate=rate):
            return f"{head}G1{to}{_feed(rate / max(feed_override, 1.0))}"
        case LineOperation(feed=feed):
            return f"{head}G1{to}{_feed(feed)}"
        case ThreadOperation():
            return f"{head}G33{to}K{number(_thread_pitch(operation))}"
        case ArcOperation():
            return f"{head}{_format_arc(operation)}{to}{_format_center(operation)}{_feed(operation.feed)}"


def format_jog(axis_letter: str, target: float, speed: float) -> str:
    """Return the line that jogs to an absolute position in machine coordinates."""
    return f"$J=G53G21G90{axis_letter}{number(target)}{_feed(speed)}"


def _format_arc(op: ArcOperation) -> str:
    """Return G2 or G3, or G1 for a very short arc.

    Angles count from the first axis of the plane, Z, to the second axis, X, so G3 turns from Z+ to X+. The
    controller treats an arc whose angle rounds to zero or less as a full circle, so a very short arc is
    sent as G1.
    """
    if _is_point(op):
        return "G1"
    return "G3" if op.is_clockwise else "G2"


def _is_point(op: ArcOperation) -> bool:
    """Return whether an arc is shorter than half a circle and its two ends almost coincide."""
    if math.hypot(op.x - op.start_x, op.z - op.start_z) >= _MIN_ARC_MM:
        return False
    turned = (op.start_z - op.center_z) * (op.x - op.center_x) - (op.start_x - op.center_x) * (
        op.z - op.center_z
    )  # sign as from Z+ to X+
    return turned > 0.0 if op.is_clockwise else turned < 0.0


def _format_center(op: ArcOperation) -> str:
    """Return the I and K words of an arc, relative to its start; I is a radius even in mode G7."""
    return "" if _is_point(op) else f"I{number(op.center_x - op.start_x)}K{number(op.center_z - op.start_z)}"


def _thread_pitch(op: ThreadOperation) -> float:
    """Return the K word of a thread, which the controller measures along the path.

    ``stepper.c`` of grblHAL compares the spindle angle times K with the length of the block, so K of a
    tapered thread must be larger than its lead.
    """
    along = abs(op.z - op.start_z)
    return op.lead_mm * math.hypot(op.x - op.start_x, along) / along if along else op.lead_mm


def _feed(speed: float) -> str:
    return f"F{number(60.0 * speed)}"
