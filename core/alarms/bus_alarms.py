"""Alarms of what the control hangs on: bus, I/O modules, feeder process, controller."""

from __future__ import annotations

from core.alarms.alarm_entry import OFF, STOP, Code, Entries, Entry

# Behind these nothing can be told to the machine any more: that it cannot be made safe follows from them.
CUT_OFF: frozenset[Code] = frozenset(("bus", "feeder-gone", "feeder-silent", "controller-lost"))
WIRES: Entries = {
    "bus": Entry(
        501,
        OFF,
        "the drive bus has failed",
        (
            "the CAN cable is off, or a terminator is missing",
            "the CAN interface was unplugged",
            "another master is on the bus",
        ),
        "PRESS E-STOP; check cable, terminators and interface, then start the control again",
        tells=True,
    ),
    "io-silent": Entry(
        502,
        OFF,
        "an I/O module does not answer",
        ("its bus cable or power", "it has restarted: its outputs have fallen"),
        "check the module's power and cable, Reset, Drives On; look what the outputs have let go",
        tells=True,
    ),
    "output": Entry(
        503,
        STOP,
        "an output cannot be switched",
        ("the machine file does not name it, or the controller does not have it", "its module has failed"),
        "check the output in the machine file, Reset",
        tells=True,
    ),
    "feeder-gone": Entry(
        511,
        OFF,
        "the feeder has ended",
        (
            "the feeder process was ended or has failed: slides, spindle and outputs are off",
            "the computer ran out of memory",
        ),
        "PRESS E-STOP; look where the tool stands, end TurnDesk and start it again, home where asked",
    ),
    "feeder-silent": Entry(
        512,
        OFF,
        "the feeder does not answer",
        ("the computer is overloaded: the slides stop at the end of what they have", "the feeder has failed"),
        "PRESS E-STOP; look where the tool stands, end TurnDesk and start it again",
    ),
    "controller-lost": Entry(
        521,
        OFF,
        "the connection to the controller is lost",
        ("the cable to the controller was pulled or damaged", "the controller's power is off"),
        "PRESS E-STOP; it moves what it has and then rests. Check cable and power, start the control again",
    ),
    "controller-silent": Entry(
        522,
        OFF,
        "the controller does not answer",
        ("its cable, or its line is disturbed", "the controller hangs"),
        "check the cable, Reset; switch the controller off and on when it does not answer",
    ),
    "controller-reset": Entry(
        523,
        OFF,
        "the controller was reset",
        ("its reset button or input", "its supply broke down for a moment"),
        "the program is given up: look where the tool stands, Reset, Drives On, home",
    ),
    "controller-refuses": Entry(
        524,
        OFF,
        "the controller refuses a block",
        (
            "its settings forbid what the program asks for: travel, speed, spindle",
            "a line was damaged on its way",
        ),
        "Reset, Drives On; compare its settings with the machine file ('turndesk machine check')",
        tells=True,
    ),
    "controller-alarm": Entry(
        525,
        OFF,
        "alarm of the controller",
        ("what the controller's number says",),
        "put right what is named, Reset, Drives On; home where asked",
        tells=True,
    ),
    "controller-modes": Entry(
        526,
        OFF,
        "the controller has lost its modes",
        ("another program has written to the controller", "it was reset unseen"),
        "end whatever else talks to the controller, Reset, Drives On",
        tells=True,
    ),
    "controller-estop": Entry(
        527,
        OFF,
        "E-stop at the controller",
        ("its E-stop or reset input is on",),
        "release the E-stop, Reset, Drives On",
    ),
    "door": Entry(
        528,
        OFF,
        "the safety door is open",
        ("the door was opened in the cycle", "the door's switch or cable"),
        "spindle and coolant are off: close the door, Reset, Drives On",
        tells=True,
    ),
}
