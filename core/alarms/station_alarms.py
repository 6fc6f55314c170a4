"""Stops that somebody asked for, and holds by the operator station."""

from __future__ import annotations

from core.alarms.alarm_entry import Entries, asked, hold

STATION: Entries = {
    "held": hold(
        600,
        "feed hold set by TurnDesk",
        ("the text of this alarm shows the cause",),
        "Correct the cause shown, then press Cycle Start",
        tells=True,
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
        tells=True,
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
        tells=True,
    ),
    "feed-hold": asked(
        702,
        "feed hold",
        ("feed hold was pressed",),
        "Press Cycle Start to resume or Reset to cancel the program",
        tells=True,
    ),
    "reset": asked(
        703,
        "reset",
        ("Reset was pressed and the program was canceled",),
        "Check where the tool is before starting anything",
        tells=True,
    ),
    "program-stop": asked(
        704,
        "program stop",
        ("M00 in the program",),
        "Follow the program message, then press Cycle Start",
        tells=True,
    ),
    "optional-stop": asked(
        705,
        "optional stop",
        ("M01 in the program, and Optional Stop is on",),
        "Press Cycle Start to resume. Press O to switch Optional Stop off",
        tells=True,
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
        tells=True,
    ),
}
