"""Alarms of the axes: drives, following error, homing and limits."""

from __future__ import annotations

from core.alarms.alarm_entry import AlarmEntries, off, stop

AXIS_ALARMS: AlarmEntries = {
    "axis": off(
        101,
        "axis drive fault",
        (
            "a drive has tripped; its display shows the reason",
            "a fault in a motor or encoder cable",
            ("the axis is blocked"),
        ),
        "Read the drive's display and correct the cause. Press Reset, then Drives On",
        shows_detail=True,
    ),
    "following": off(
        102,
        "following error",
        (
            "the axis is blocked, or the tool has hit something",
            "the cut is too heavy",
            "the drive has no power, or its motor cable is disconnected",
        ),
        "Check where the tool is and free the axis. Press Reset, then Drives On. Home any "
        "axis shown as not homed",
        shows_detail=True,
    ),
    "in-position": stop(
        103,
        "axis did not reach position",
        (
            "the axis is blocked or moves stiffly",
            "a lack of lubrication",
            "the in-position window in the machine file is too narrow",
        ),
        "Find what prevents the axis from reaching its position, then press Reset",
        shows_detail=True,
    ),
    "driver": off(
        104,
        "drive rejected command",
        (
            "the drives received a command that they cannot execute in their present state",
            "a drive lost its ready signal",
        ),
        "Press Reset, then Drives On, and start again. If the alarm returns, find the "
        "rejected command in the log",
    ),
    "power-lost": off(
        105,
        "drives lost power",
        (
            "the safety circuit was opened by a door, a guard or another E-stop on the machine",
            "a fuse or the drive power supply has failed",
        ),
        "Close the safety circuit. Press Reset, then Drives On. Home any axis shown as not homed",
        shows_detail=True,
    ),
    "no-power": off(
        106,
        "drives do not switch on",
        (
            "E-stop is pressed or the safety circuit is open",
            "the drives' main power is off",
            "a drive shows a fault",
        ),
        "Release the E-stop and switch on the drives' power. Press Reset, then Drives On",
        shows_detail=True,
    ),
    "drive-silent": off(
        107,
        "no response from axis drive",
        (
            "the drive's bus cable is disconnected or damaged",
            "the power supply is off",
            "the drive has failed",
        ),
        "Check the drive's power and bus cable. Press Reset, then Drives On, and home again",
        shows_detail=True,
    ),
    "drive-restarted": off(
        108,
        "drive restarted",
        (
            "the drive's control power failed briefly",
            "someone reset the drive, or the drive is being operated with its own software",
        ),
        "Check the drive's power supply. Press Reset, then Drives On, and home again",
        shows_detail=True,
    ),
    "drive-setup": off(
        109,
        "drive rejected its settings",
        (
            "the drive or its firmware differs from the one specified in the machine file",
            "a bus node number is wrong",
            "a fault in the bus cable or in the drive's power supply",
        ),
        "In a terminal, run 'turndesk machine check' with the machine file to find the "
        "rejected setting. Correct the setting, then press Reset and Drives On",
        shows_detail=True,
    ),
    "drive-keeps-fault": off(
        110,
        "drive fault does not clear",
        (
            "the cause is still present: the drive is too hot, or the motor or encoder is missing",
            ("the drive must be switched off and on again"),
        ),
        "Read the drive's display. If the fault does not clear, switch the machine off and on",
        shows_detail=True,
    ),
    "limit-switch": off(
        111,
        "axis hit its limit switch",
        (
            "the axis was moved before it was homed",
            "the axis travel in the machine file is too long",
            "a fault in the switch or its cable",
        ),
        "If the axis is still on its limit switch, first turn the axis by hand until it is "
        "off the switch. Press Reset, then Drives On, and home the axis",
        shows_detail=True,
    ),
    "homing": off(
        112,
        "homing failed",
        (
            (
                "the home switch was not found because its cable is faulty or the axis moved in the "
                "wrong direction"
            ),
            ("the axis is blocked"),
        ),
        "Check the home switch and the homing direction. Press Reset, then Drives On, and home again",
        shows_detail=True,
    ),
    "position-lost": off(
        113,
        "position lost",
        ("the controller was stopped while the axes were moving", "an axis limit was hit"),
        "Press Reset, then Drives On. Home all axes before starting anything",
        shows_detail=True,
    ),
    "drive-limits": off(
        114,
        "move exceeds drive limits",
        (
            "the speed or the travel in the machine file differs from the drive settings",
            "the spindle was too fast for the thread's lead",
        ),
        "Press Reset, then Drives On. Compare the machine file with the drive settings "
        "before running the program again",
        shows_detail=True,
    ),
    "queue-dry": off(
        115,
        "drives ran out of setpoints",
        ("the computer was busy with another task for too long", "interference on the bus"),
        "Press Reset, then Drives On. Close other programs on this computer, then restart "
        "the program at the interrupted line",
    ),
    "standstill": off(
        116,
        "axis out of position",
        (
            "the axis is jammed, or something is pushing against it",
            "a fault in the encoder or its cable",
            "the drive is tuned too soft to hold the axis, or its motor cable is disconnected",
        ),
        "Keep clear of the axis: the axis may jump when freed. Find what is holding "
        "the axis, then press Reset and Drives On",
        shows_detail=True,
    ),
    "encoder-still": off(
        117,
        "encoder not counting during a move",
        (
            (
                "a fault in the encoder, its cable or its coupling; the axis may have moved although "
                "the encoder did not count"
            ),
            "the axis is jammed, or the tool has hit something",
            "the motor cable is disconnected",
        ),
        "Check the actual position of the axis. Check the encoder and its coupling. "
        "Press Reset, then Drives On. Home any axis shown as not homed",
        shows_detail=True,
    ),
    "moved-unasked": off(
        118,
        "axis moved without a command",
        (
            "the axis was moved by hand with the drives off",
            "the axis sinks under its own weight because it has no brake or the brake slips",
            "the drive is being moved by its own software or by a pendant",
        ),
        "Check where the axis is and that nothing is in its path. Press Reset, then Drives On",
        shows_detail=True,
    ),
}
