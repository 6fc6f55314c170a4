"""Alarms of the control itself, late or failed, and of a program that cannot be run."""

from __future__ import annotations

from core.alarms.alarm_entry import Entries, hold, off, stop

CONTROL: Entries = {
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
        tells=True,
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
        "updates. Save the log, then exit and restart TurnDesk",
        tells=True,
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
        tells=True,
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
        tells=True,
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


PROGRAM: Entries = {
    "program": stop(
        401,
        "program error",
        (
            "this line cannot be run as programmed",
            "an input or a counter made the program jump to a line that had never run before",
        ),
        "Correct the line in the editor (F3) and load the program again",
        tells=True,
    ),
    "travel": stop(
        402,
        "end of travel",
        (
            "the tool offset or the part zero is wrong",
            "the axes were not at the start position for which the program was proved",
        ),
        "Check the tool offset and the start position of the axes, then press Reset",
        tells=True,
    ),
    "no-end": stop(
        403,
        "the program ends without M30 or M02",
        ("the last line is missing because the program was cut off when it was sent or copied",),
        "Compare the end of the program with the original, add M30 and load the program again",
    ),
}
