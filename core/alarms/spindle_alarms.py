"""Alarms of the spindle (drive, inverter, speed, encoder, C axis, threads) and of the collet."""

from __future__ import annotations

from core.alarms.alarm_entry import AlarmEntries, hold, off, stop

SPINDLE_ALARMS: AlarmEntries = {
    "spindle": stop(
        201,
        "spindle drive fault",
        (
            "the spindle drive has tripped; its display shows the reason",
            "the cut is too heavy",
            "a fault in the drive's power supply or motor cable",
        ),
        "Read the drive's display, correct the cause, then press Reset",
        shows_detail=True,
    ),
    "at-speed": stop(
        202,
        "spindle not at speed",
        (
            (
                "the spindle does not turn because of a belt or brake fault, or because its drive is "
                "not enabled"
            ),
            "the spindle cannot reach this speed with this chuck and part",
            "the spindle was stopped externally",
        ),
        "Check the spindle, then press Reset. Test the speed in MDI before running the program again",
        shows_detail=True,
    ),
    "ignores-stop": stop(
        203,
        "spindle ignores the command",
        (
            (
                "the spindle drive does not follow its command because of a cable fault, wrong "
                "settings or local mode at its keypad"
            ),
            "the spindle was started locally at its drive",
        ),
        "PRESS E-STOP. Find the cause before starting the spindle again",
        shows_detail=True,
    ),
    "spindle-still": stop(
        204,
        "feed per revolution with spindle stopped",
        ("M03 or M04 is missing before the cut",),
        "Start the spindle in the program before this line",
        shows_detail=True,
    ),
    "thread-lost": stop(
        205,
        "spindle speed lost during threading",
        (
            "the cut stalled the spindle",
            "the belt slips",
            "the spindle was switched off during the threading pass",
        ),
        "X has retracted and the thread is not finished. Check the part and the insert",
        shows_detail=True,
    ),
    "c-is-spindle": stop(
        206,
        "C axis move with spindle turning",
        ("the spindle is the C axis on this machine, and M05 is missing before this line",),
        "Add M05 before this line and load the program again",
        shows_detail=True,
    ),
    "spindle-off": stop(
        207,
        "spindle start not permitted",
        (
            "E-stop is pressed",
            "the spindle drive has an active fault",
            "the spindle is engaged as the C axis",
        ),
        "Correct the cause shown, press Reset and start again",
        shows_detail=True,
    ),
    "inverter-silent": stop(
        208,
        "no response from inverter",
        (
            "the inverter cable is disconnected, or picks up interference from the motor cable",
            "the power supply is off",
            ("wrong baud rate or address"),
        ),
        "IF THE SPINDLE IS TURNING, PRESS E-STOP. Check the inverter's cable and power, then press Reset",
        shows_detail=True,
    ),
    "spindle-disagrees": stop(
        209,
        "encoder and spindle drive disagree",
        (
            "the belt slips or has come off",
            "the encoder's coupling is loose",
            ("wrong encoder counts per revolution in the machine file"),
        ),
        "PRESS E-STOP. Check the belt and the encoder before starting the spindle again",
        shows_detail=True,
    ),
    "spindle-encoder": stop(
        210,
        "spindle encoder signal lost",
        (
            "a fault in the encoder cable",
            "a fault in the encoder power supply",
            "the encoder has restarted or reports a fault",
        ),
        "Check the encoder and its cable, then press Reset. Threads cannot be cut without the encoder",
        shows_detail=True,
    ),
    "c-coupling": off(
        211,
        "spindle did not switch to C-axis mode",
        (
            "the index pulse of the spindle encoder was not found",
            "the spindle drive did not switch to C-axis mode in time",
            ("power was lost during the switch to C-axis mode"),
        ),
        "Press Reset, then Drives On. Test M19 in MDI",
        shows_detail=True,
    ),
    "thread-no-encoder": stop(
        212,
        "threading requires a running spindle",
        ("M03 or M04 is missing before the thread", "the spindle of this machine does not have an encoder"),
        "Start the spindle before the thread. Without an encoder, use a die or a tap",
        shows_detail=True,
    ),
    "spindle-orient": stop(
        213,
        "spindle not at commanded angle",
        (
            "the spindle drive did not report in time that the spindle had reached its angle",
            (
                "something prevents the spindle from reaching the commanded angle, or has turned the "
                "spindle away from that angle"
            ),
            "the index pulse of the spindle encoder was not found",
        ),
        "Before moving any axis, check whether a boring bar is still in its hole. Press "
        "Reset, then test the spindle orientation in MDI",
        shows_detail=True,
    ),
    "spindle-slow": hold(
        221,
        "spindle below half commanded speed",
        ("the cut is too heavy", "the belt slips", "the spindle override was turned down"),
        "Wait until the spindle is at speed, then press Cycle Start",
    ),
    "spindle-stopped": hold(
        222,
        "spindle stopped",
        ("the spindle was stopped during a move with feed per revolution",),
        "Start the spindle and press Cycle Start; otherwise press Reset",
    ),
    "spindle-switch": hold(
        223,
        "spindle switch off",
        ("the spindle switch is at OFF",),
        "Set the spindle switch to AUTO, then press Cycle Start: the spindle starts as shown, "
        "and the program resumes. If the collet is open, press Reset and start again",
    ),
    "spindle-has-stopped": hold(
        225,
        "spindle stopped unexpectedly",
        (
            "the safety circuit, the guard or the spindle drive has switched the spindle off",
            ("the driver host received no data from the control for a short time and made the machine safe"),
        ),
        "Check the spindle and the tool. Press Cycle Start to restart the spindle as shown "
        "on the screen and resume",
    ),
    "spindle-late": hold(
        226,
        "spindle did not return to speed",
        (
            "the load, the belt or the drive prevents the spindle from recovering its speed",
            ("the spindle override was turned down"),
        ),
        "Check the spindle and the tool. Press Cycle Start to try again or Reset to cancel the program",
    ),
    "spindle-pot": hold(
        224,
        "spindle override at 0",
        ("the spindle override is at 0",),
        "Turn up the spindle override. Press Cycle Start to start the spindle as shown on "
        "the screen and resume",
    ),
}

COLLET_ALARMS: AlarmEntries = {
    "collet-open": stop(
        301,
        "spindle start with the collet open",
        (
            "the program starts the spindle before the collet is closed (M12)",
            "the collet switch does not respond",
        ),
        "Close the collet with M12, press Reset and start again",
        shows_detail=True,
    ),
    "unclamp": stop(
        302,
        "collet unclamp not permitted",
        ("the spindle is still turning when the program opens the collet",),
        "Add M05 before M13 and load the program again",
        shows_detail=True,
    ),
    "collet": stop(
        303,
        "collet did not respond",
        (
            "no air pressure",
            "a fault in the collet switch or its cable",
            "the bar or the part prevents the collet from moving",
        ),
        "Check the air pressure and the collet switch, then press Reset",
        shows_detail=True,
    ),
    "collet-lost": stop(
        304,
        "collet has opened",
        ("air pressure was lost while the spindle was turning", "a fault in the switch or its cable"),
        "WAIT UNTIL THE SPINDLE STOPS. Check air, collet and bar, then press Reset",
        shows_detail=True,
    ),
}
