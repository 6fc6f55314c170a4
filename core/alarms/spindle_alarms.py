"""Alarms of the spindle: drive, inverter, speed, encoder, C axis, threads; and of the chuck."""

from __future__ import annotations

from core.alarms.alarm_entry import Entries, hold, off, stop

SPINDLE: Entries = {
    "spindle": stop(
        201,
        "spindle drive fault",
        (
            "the spindle drive has tripped: its display says why",
            "too heavy a cut",
            "its supply or motor cable",
        ),
        "read the drive's display, put the cause right, Reset",
        tells=True,
    ),
    "at-speed": stop(
        202,
        "spindle not at speed",
        (
            "the spindle does not turn: belt, brake, or its drive is not enabled",
            "the speed is more than it reaches with this chuck and part",
            "it was stopped from outside",
        ),
        "look at the spindle, Reset; try the speed in MDI before the program is run again",
        tells=True,
    ),
    "ignores-stop": stop(
        203,
        "spindle ignores the command",
        (
            "the spindle drive does not follow its command: cable, settings, local mode at its keypad",
            "it was started at the drive itself",
        ),
        "PRESS E-STOP; then find out why before it is started again",
        tells=True,
    ),
    "spindle-still": stop(
        204,
        "feed per revolution with a still spindle",
        ("no M03 or M04 before the cut",),
        "start the spindle in the program before this line",
        tells=True,
    ),
    "thread-lost": stop(
        205,
        "spindle lost in a thread",
        (
            "the cut stalled the spindle",
            "the belt slips",
            "the spindle was switched off during the pass",
        ),
        "X was drawn back: look at part and insert; the thread is not finished",
        tells=True,
    ),
    "c-is-spindle": stop(
        206,
        "C moves while the spindle turns",
        ("on this machine the spindle is C, and M05 is missing before this line",),
        "put M05 before the line, load the program again",
        tells=True,
    ),
    "spindle-off": stop(
        207,
        "the spindle may not start",
        ("E-stop is pressed", "a fault of its drive stands", "it is held as C"),
        "put right what is named, Reset, start again",
        tells=True,
    ),
    "inverter-silent": stop(
        208,
        "the inverter does not answer",
        ("its cable is off, or disturbed by the motor cable", "its power is off", "baud rate or address"),
        "IF THE SPINDLE TURNS PRESS E-STOP; then check the inverter's cable and power, Reset",
        tells=True,
    ),
    "spindle-disagrees": stop(
        209,
        "encoder and spindle drive disagree",
        ("the belt slips or is off", "the encoder's coupling is loose", "counts a turn in the machine file"),
        "PRESS E-STOP; look at belt and encoder before the spindle is started again",
        tells=True,
    ),
    "spindle-encoder": stop(
        210,
        "spindle encoder lost",
        ("its cable", "its power", "it has restarted or reports a fault"),
        "check encoder and cable, Reset; without it no thread is cut",
        tells=True,
    ),
    "c-coupling": off(
        211,
        "the spindle does not become C",
        ("its index was not found", "the drive did not change over in time", "power was lost meanwhile"),
        "Reset, Drives On; try M19 in MDI",
        tells=True,
    ),
    "thread-no-encoder": stop(
        212,
        "a thread needs a turning spindle",
        ("no M03 or M04 before the thread", "this machine has no encoder on the spindle"),
        "start the spindle before the thread; without an encoder use a die or tap",
        tells=True,
    ),
    "spindle-orient": stop(
        213,
        "the spindle is not at its angle",
        (
            "its drive has not told in time that it has arrived",
            "something keeps it from turning to its angle, or has turned it away from there",
            "its index was not found",
        ),
        "a bar may stand in its hole: look before any slide is moved; Reset, then try it in MDI",
        tells=True,
    ),
    "spindle-slow": hold(
        221,
        "spindle below half its speed",
        ("the cut is too heavy", "the belt slips", "the spindle pot was turned down"),
        "let it come to speed, then Cycle Start",
    ),
    "spindle-stopped": hold(
        222,
        "spindle stopped",
        ("the spindle was stopped while the program fed by the revolution",),
        "start the spindle, then Cycle Start; else Reset",
    ),
    "spindle-switch": hold(
        223,
        "spindle switch off",
        ("the spindle switch stands at OFF",),
        "switch it to AUTO; Cycle Start starts the spindle, as it says, and goes on;"
        " with the collet open: Reset, close it, start again",
    ),
    "spindle-has-stopped": hold(
        225,
        "spindle has stopped",
        (
            "something between control and spindle has switched it off: safety circuit, guard, its drive",
            "the feeder had no word of the control for a moment and made the machine safe",
        ),
        "look at spindle and tool; Cycle Start starts it again, as it says, and goes on",
    ),
    "spindle-late": hold(
        226,
        "spindle not at its speed",
        ("the spindle did not come back to its speed: load, belt, drive", "its pot was turned down"),
        "look at spindle and tool; Cycle Start tries again, Reset gives the program up",
    ),
    "spindle-pot": hold(
        224,
        "spindle override at 0",
        ("the spindle pot stands at 0",),
        "turn the spindle pot up; Cycle Start starts the spindle, as it says, and goes on",
    ),
}

CHUCK: Entries = {
    "collet-open": stop(
        301,
        "spindle start with the collet open",
        ("the program starts the spindle before M12", "the collet's switch does not answer"),
        "close the collet with M12, Reset, start again",
        tells=True,
    ),
    "unclamp": stop(
        302,
        "unclamping refused",
        ("the spindle still turns where the program opens the collet",),
        "put M05 before M13, load the program again",
        tells=True,
    ),
    "collet": stop(
        303,
        "collet does not answer",
        ("no air", "its switch or cable", "bar or part keeps it from moving"),
        "check air and switch, Reset",
        tells=True,
    ),
    "collet-lost": stop(
        304,
        "collet has opened",
        ("air was lost while the spindle turned", "the switch or its cable"),
        "WAIT UNTIL THE SPINDLE STANDS; check air, collet and bar, Reset",
        tells=True,
    ),
}
