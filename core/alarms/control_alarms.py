"""Alarms of the control itself, late or failed, and of a program that cannot be run."""

from __future__ import annotations

from core.alarms.alarm_entry import Entries, hold, off, stop

CONTROL: Entries = {
    "internal": off(
        901,
        "the control has failed",
        ("a mistake in TurnDesk; the log has it",),
        "look where the tool stands; save the log (F10), end TurnDesk and start it again",
    ),
    "broken-path": off(
        902,
        "the planned path does not fit together",
        ("a mistake in TurnDesk; nothing of the wrong piece was moved",),
        "Reset, Drives On; save program and log (F10), and restart at another line",
    ),
    "not-safe": off(
        905,
        "the machine could not be made safe",
        (
            "a driver does not do what a stop asks of it: a wire is off, or it has failed",
            "a mistake in TurnDesk; the log has it",
        ),
        "PRESS E-STOP, switch the machine off; save the log (F10), end TurnDesk and start it again",
        tells=True,
    ),
    "control-silent": off(
        908,
        "the control does not respond",
        (
            "the computer is overloaded: another program, a backup or an update uses the processor",
            "a driver does not respond: its cable, its adapter, the computer's disk or network",
            "a fault in TurnDesk; see the log",
        ),
        "PRESS E-STOP: the display is out of date; close other programs and stop backups and updates, "
        "save the log, end TurnDesk and start it again",
        tells=True,
    ),
    "feeder-tripped": hold(
        906,
        "the feeder has switched off",
        (
            "another program, a backup or an update keeps this computer busy",
            "the computer is too slow or too hot, or its disk hangs",
            "the screen was locked or the computer asleep",
        ),
        "look at the tool; read what starts again, then Cycle Start; measure the part: it is not counted",
        tells=True,
    ),
    "switched-off": hold(
        907,
        "an output is not as commanded",
        (
            "a fuse, a relay or a terminal has switched it",
            "somebody else switches it: a pendant, the drive's own software",
        ),
        "look why; read what is switched again, then Cycle Start; measure the part, it is not counted",
        tells=True,
    ),
    "late": hold(
        903,
        "the computer was too late",
        (
            "another program, a backup or an update keeps this computer busy",
            "the computer is too slow or too hot, or its disk hangs",
            "the screen was locked or the computer asleep",
        ),
        "the slides have stopped on the path; end other programs, then Cycle Start",
    ),
    "low-queue": hold(
        904,
        "setpoints ran low",
        (
            "another program, a backup or an update keeps this computer busy",
            "the computer is too slow or too hot, or its disk hangs",
        ),
        "the slides have stopped on the path; end other programs, then Cycle Start",
    ),
}

# --- program --------------------------------------------------------------------------------------------


PROGRAM: Entries = {
    "program": stop(
        401,
        "program error",
        (
            "this line cannot be run as it stands",
            "an input or a counter led to a line that was never run before",
        ),
        "correct the line in the editor (F3), load the program again",
        tells=True,
    ),
    "travel": stop(
        402,
        "end of travel",
        (
            "the offset of the tool, or the zero of the part, is wrong",
            "the program was started at another place than it was proved from",
        ),
        "check the tool's offset and where the slides stood at the start; Reset",
        tells=True,
    ),
    "no-end": stop(
        403,
        "the program ends without M30 or M02",
        ("the last line is missing: cut off when it was sent or copied",),
        "compare the end of the program with the original, add M30, load it again",
    ),
}
