"""Stops that somebody asked for, and holds by the operator station."""

from __future__ import annotations

from core.alarms.alarm_entry import Entries, asked, hold

STATION: Entries = {
    "held": hold(
        600,
        "held by the control",
        ("what is told here",),
        "put right what is named, then Cycle Start",
        tells=True,
    ),
    "station-silent": hold(
        601,
        "operator station silent",
        ("the station's cable is off or damaged", "its power is off"),
        "check cable and power of the station; its buttons do nothing now. Then Cycle Start",
    ),
    "pot-jumps": hold(
        602,
        "override pot jumps",
        ("the feed or spindle pot has a worn track", "its cable is loose"),
        "turn the pot slowly through its range; if it still jumps change it. Then Cycle Start",
    ),
    "guard-open": hold(
        604,
        "guard open",
        ("the guard was opened in the cycle", "the guard's switch or cable"),
        "close the guard; Cycle Start says what it starts again",
    ),
    "pendant": hold(
        605,
        "pendant lost",
        ("the pendant was unplugged", "its cable or its hub"),
        "plug it in again, then Cycle Start. Who works without it takes [pendant] and what is at it out of"
        " the machine file",
        tells=True,
    ),
    "controller-holds": hold(
        603,
        "the controller holds",
        ("its own feed hold or safety door input is on",),
        "look at the controller's hold and door inputs, then Cycle Start",
    ),
    "estop": asked(
        701,
        "E-stop",
        ("an E-stop button was pressed", "the safety circuit has opened"),
        "make the machine safe, release the button, then Drives On",
        tells=True,
    ),
    "feed-hold": asked(
        702,
        "feed hold",
        ("feed hold was pressed",),
        "Cycle Start goes on; Reset gives the program up",
        tells=True,
    ),
    "reset": asked(
        703,
        "reset",
        ("Reset was pressed: the program was given up",),
        "look where the tool stands before anything is started",
        tells=True,
    ),
    "program-stop": asked(
        704,
        "program stop",
        ("M00 in the program",),
        "do what the message says, then Cycle Start",
        tells=True,
    ),
    "optional-stop": asked(
        705,
        "optional stop",
        ("M01 in the program, and Optional Stop is on",),
        "Cycle Start goes on; O switches Optional Stop off",
        tells=True,
    ),
    "single-block": asked(
        706,
        "single block",
        ("Single Block is on: each block waits for Cycle Start",),
        "Cycle Start runs the next block; S switches Single Block off",
    ),
    "by-hand": asked(
        707,
        "stopped by hand",
        ("the spindle was stopped by hand",),
        "nothing: it was asked for",
        tells=True,
    ),
}
