"""Alarms of the control and of programs, and stops and holds that were requested."""

from __future__ import annotations

from core.alarms.alarm_entry import AlarmEntries, asked, hold, notice, off, stop

CONTROL_ALARMS: AlarmEntries = {
    "internal": off(
        901,
        "the control has failed",
        ("an internal error in TurnDesk; see the log",),
        "Check where the tool is. Save the log (F10), then exit and restart TurnDesk",
    ),
    "broken-path": off(
        902,
        "planned path is not continuous",
        ("an internal error in TurnDesk; the axes did not move along the faulty part of the path",),
        "Press Reset, then Drives On. Save the program and the log (F10), then restart the "
        "program after the faulty line (F6)",
    ),
    "not-safe": off(
        905,
        "the machine could not be made safe",
        (
            (
                "a driver does not carry out the stop command because a wire is disconnected or the "
                "driver has failed"
            ),
            "an internal error in TurnDesk; see the log",
        ),
        "PRESS E-STOP and switch the machine off. Save the log (F10), then exit and restart TurnDesk",
        shows_detail=True,
    ),
    "control-silent": off(
        908,
        "control not responding",
        (
            (
                "the computer is overloaded because another program, a backup or an update is using "
                "the processor"
            ),
            (
                "a driver does not respond because of a fault in its cable, its adapter, or the "
                "computer's disk or network"
            ),
            "an internal error in TurnDesk; see the log",
        ),
        "PRESS E-STOP: the display is out of date. Close other programs and stop backups and "
        "updates. Press R to restart the control, or exit and restart TurnDesk",
        shows_detail=True,
    ),
    "no-real-time": notice(
        909,
        "no real-time priority",
        ("this account is not permitted to run the control ahead of other programs",),
        "Add the line '@machine - rtprio 60' to /etc/security/limits.d/turndesk.conf and log in again",
    ),
    "feeder-tripped": hold(
        906,
        "driver host stopped spindle/outputs",
        (
            "another program, a backup or an update is slowing this computer down",
            "the computer is too slow or too hot, or its disk does not respond",
            "the screen was locked or the computer was in sleep mode",
        ),
        "Check the tool. Read what will restart, then press Cycle Start. Measure this part, "
        "and count it by hand if it is good (F10, 2, F2)",
        shows_detail=True,
    ),
    "switched-off": hold(
        907,
        "output not in commanded state",
        (
            "a faulty fuse, relay or terminal has changed the state of the output",
            "a pendant or the drive's own software is also switching the output",
        ),
        "Find the cause. Read the list of outputs that will be restored, then press Cycle "
        "Start. Measure this part, because it is not counted",
        shows_detail=True,
    ),
    "late": hold(
        903,
        "computer responded too late",
        (
            "another program, a backup or an update is slowing this computer down",
            "the computer is too slow or too hot, or its disk does not respond",
            "the screen was locked or the computer was in sleep mode",
        ),
        "The axes have stopped on the path. Close other programs, then press Cycle Start",
    ),
    "low-queue": hold(
        904,
        "feed hold: computer busy",
        (
            "another program, a backup or an update is slowing this computer down",
            "the computer is too slow or too hot, or its disk does not respond",
        ),
        "The axes have stopped on the path. Close other programs, then press Cycle Start",
    ),
}

# --- program --------------------------------------------------------------------------------------------


PROGRAM_ALARMS: AlarmEntries = {
    "program": stop(
        401,
        "program error",
        (
            "this line cannot be run as programmed",
            "an input or a counter made the program jump to a line that had never run before",
        ),
        "Correct the line in the editor (F3) and load the program again",
        shows_detail=True,
    ),
    "travel": stop(
        402,
        "end of travel",
        (
            "the tool offset or the part zero is wrong",
            "the axes were not at the start position for which the program was proved",
        ),
        "Check the tool offset and the start position of the axes, then press Reset",
        shows_detail=True,
    ),
    "no-end": stop(
        403,
        "the program ends without M30 or M02",
        ("the last line is missing because the program was cut off when it was sent or copied",),
        "Compare the end of the program with the original, add M30 and load the program again",
    ),
}


STOP_AND_HOLD_ALARMS: AlarmEntries = {
    "held": hold(
        600,
        "feed hold set by TurnDesk",
        ("the text of this alarm shows the cause",),
        "Correct the cause shown, then press Cycle Start",
        shows_detail=True,
    ),
    "station-silent": hold(
        601,
        "no response from operator station",
        ("the operator station's cable is disconnected or damaged", "the power supply is off"),
        "The buttons of the operator station do not work. Check the station's cable "
        "and power, then press Cycle Start",
    ),
    "pot-jumps": hold(
        602,
        "override signal unstable",
        ("the track of the feed or spindle override pot is worn", "the override pot's cable is loose"),
        "Turn the pot slowly through its range, and replace the pot if its signal is still "
        "unstable. Then press Cycle Start",
    ),
    "guard-open": hold(
        604,
        "guard open",
        ("the guard was opened during the cycle", "a fault in the guard switch or its cable"),
        "Close the guard, read the list of functions that will restart, then press Cycle Start",
    ),
    "pendant": hold(
        605,
        "pendant disconnected",
        ("the pendant was unplugged", "a fault in the pendant's cable or hub"),
        "Plug the pendant in again, then press Cycle Start. To work without the "
        "pendant, remove [pendant] and all pendant entries from the machine file",
        shows_detail=True,
    ),
    "controller-holds": hold(
        603,
        "controller in feed hold",
        ("the controller's own feed hold or safety door input is active",),
        "Check the controller's feed hold and door inputs, then press Cycle Start",
    ),
    "estop": asked(
        701,
        "E-stop",
        ("an E-stop button was pressed", "the safety circuit has opened"),
        "Make the machine safe, release the E-stop button, then press Drives On",
        shows_detail=True,
    ),
    "feed-hold": asked(
        702,
        "feed hold",
        ("feed hold was pressed",),
        "Press Cycle Start to resume or Reset to cancel the program",
        shows_detail=True,
    ),
    "reset": asked(
        703,
        "reset",
        ("Reset was pressed and the program was canceled",),
        "Check where the tool is before starting anything",
        shows_detail=True,
    ),
    "program-stop": asked(
        704,
        "program stop",
        ("M00 in the program",),
        "Follow the program message, then press Cycle Start",
        shows_detail=True,
    ),
    "optional-stop": asked(
        705,
        "optional stop",
        ("M01 in the program, and Optional Stop is on",),
        "Press Cycle Start to resume. Press O to switch Optional Stop off",
        shows_detail=True,
    ),
    "single-block": asked(
        706,
        "single block",
        ("Single Block is on: each block waits for Cycle Start",),
        "Press Cycle Start to run the next block. Press S to switch Single Block off",
    ),
    "by-hand": asked(
        707,
        "spindle stopped manually",
        ("the spindle was stopped manually",),
        "No action needed: the stop was requested",
        shows_detail=True,
    ),
}
