"""Alarms of what the control hangs on: bus, I/O modules, feeder process, controller, LinuxCNC's HAL."""

from __future__ import annotations

from core.alarms.alarm_entry import Code, Entries, off, stop

# Behind these nothing can be told to the machine any more: that it cannot be made safe follows from them.
CUT_OFF: frozenset[Code] = frozenset(
    (
        *("bus", "feeder-gone", "feeder-silent", "controller-lost"),
        *("hal-bridge", "hal-silent", "hal-thread", "hal-board", "hal-setup"),
    )
)
WIRES: Entries = {
    "bus": off(
        501,
        "the drive bus has failed",
        (
            "the CAN cable is off, or a terminator is missing",
            "the CAN interface was unplugged",
            "another master is on the bus",
        ),
        "PRESS E-STOP, the spindle may turn; check cable, terminators, interface; Reset opens the bus again",
        tells=True,
    ),
    "io-silent": off(
        502,
        "an I/O module does not answer",
        ("its bus cable or power", "it has restarted: its outputs have fallen"),
        "check the module's power and cable, Reset, Drives On; look what the outputs have let go",
        tells=True,
    ),
    "output": stop(
        503,
        "an output cannot be switched",
        ("the machine file does not name it, or the controller does not have it", "its module has failed"),
        "check the output in the machine file, Reset",
        tells=True,
    ),
    "feeder-gone": off(
        511,
        "the feeder has ended",
        (
            "the feeder process was ended or has failed: slides, spindle and outputs are off",
            "the computer ran out of memory",
        ),
        "PRESS E-STOP, the spindle may turn; look at the tool; Reset starts another. Home where asked",
    ),
    "feeder-silent": off(
        512,
        "the feeder does not answer",
        ("the computer is overloaded: the slides stop at the end of what they have", "the feeder has failed"),
        "PRESS E-STOP, the spindle may turn; look where the tool stands; Reset ends it and starts another",
    ),
    "controller-lost": off(
        521,
        "the connection to the controller is lost",
        ("the cable to the controller was pulled or damaged", "the controller's power is off"),
        "PRESS E-STOP, the spindle may turn; check cable and power, Reset connects again. Home where asked",
    ),
    "controller-silent": off(
        522,
        "the controller does not answer",
        ("its cable, or its line is disturbed", "the controller hangs"),
        "check the cable, Reset; switch the controller off and on when it does not answer",
    ),
    "controller-reset": off(
        523,
        "the controller was reset",
        ("its reset button or input", "its supply broke down for a moment"),
        "the program is given up: look where the tool stands, Reset, Drives On, home",
    ),
    "controller-refuses": off(
        524,
        "the controller refuses a block",
        (
            "its settings forbid what the program asks for: travel, speed, spindle",
            "a line was damaged on its way",
        ),
        "Reset, Drives On; compare its settings with the machine file ('turndesk machine check')",
        tells=True,
    ),
    "controller-alarm": off(
        525,
        "alarm of the controller",
        ("what the controller's number says",),
        "put right what is named, Reset, Drives On; home where asked",
        tells=True,
    ),
    "controller-modes": off(
        526,
        "the controller has lost its modes",
        ("another program has written to the controller", "it was reset unseen"),
        "end whatever else talks to the controller, Reset, Drives On",
        tells=True,
    ),
    "controller-estop": off(
        527,
        "E-stop at the controller",
        ("its E-stop or reset input is on",),
        "release the E-stop, Reset, Drives On",
    ),
    "door": off(
        528,
        "the safety door is open",
        ("the door was opened in the cycle", "the door's switch or cable"),
        "spindle and coolant are off: close the door, Reset, Drives On",
        tells=True,
    ),
    "hal-bridge": off(
        531,
        "the bridge to HAL has ended",
        (
            "its process was ended or has failed: HAL plays what it has, brakes, takes the power",
            "the computer ran out of memory",
        ),
        "PRESS E-STOP, the spindle may turn; look at the tool; Reset starts HAL anew. Home where asked",
        tells=True,
    ),
    "hal-silent": off(
        532,
        "the bridge to HAL is silent",
        (
            "the computer is overloaded: HAL plays what it has, brakes, takes the power",
            "something has stopped the bridge's process",
        ),
        "PRESS E-STOP, the spindle may turn; look where the tool is; end other programs, Reset, Drives On",
        tells=True,
    ),
    "hal-thread": off(
        533,
        "HAL's real-time thread stands",
        (
            "its process (rtapi_app) has ended: what drives the slides now is the boards' watchdogs alone",
            "a board's driver waits for a board: its cable, its power",
        ),
        "PRESS E-STOP, the spindle may turn; look at the boards; Reset starts HAL anew. Home where asked",
    ),
    "hal-board": off(
        535,
        "connection to the I/O board lost",
        (
            "the network cable between the computer and the board is out or damaged",
            "the board has no power, or its watchdog has switched it off",
            "an EtherCAT slave is not operational, or the bus is still starting",
            "the 7I76E has lost its field I/O",
        ),
        "PRESS E-STOP, the spindle may turn. Check cable and board power, then press Reset. Home where asked",
    ),
    "hal-setup": off(
        534,
        "HAL does not come up",
        (
            "a pin that the machine file names is not there, or is of another kind",
            "a board or component does not load, or another session of LinuxCNC runs",
        ),
        "run 'turndesk machine check' with the machine file: it names every pin; put it right, Reset",
        tells=True,
    ),
}
