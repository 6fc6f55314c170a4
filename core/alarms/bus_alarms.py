"""Alarms of external connections: bus, I/O modules, driver host, controller and LinuxCNC HAL."""

from __future__ import annotations

from core.alarms.alarm_entry import AlarmCode, AlarmEntries, off, stop

# After these alarms no command reaches the machine, so a failed safe stop is only a consequence of them.
CONNECTION_LOSS_CODES: frozenset[AlarmCode] = frozenset(
    (
        *("bus", "feeder-gone", "feeder-silent", "controller-lost"),
        *("hal-bridge", "hal-silent", "hal-thread", "hal-board", "hal-setup"),
    )
)
CONNECTION_ALARMS: AlarmEntries = {
    "bus": off(
        501,
        "the drive bus has failed",
        (
            "the CAN cable is disconnected, or a terminator is missing",
            "the CAN interface was unplugged",
            "another master is on the bus",
        ),
        "PRESS E-STOP: the spindle may be turning. Check cable, terminators and interface, "
        "then press Reset to reopen the bus",
        shows_detail=True,
    ),
    "io-silent": off(
        502,
        "no response from I/O module",
        (
            "a fault in the module's bus cable or power supply",
            "the module restarted and its outputs dropped out",
        ),
        "Check the module's power and cable, then press Reset and Drives On. Its "
        "outputs were off: check clamps, brakes and valves",
        shows_detail=True,
    ),
    "output": stop(
        503,
        "an output cannot be switched",
        (
            ("the output is not defined in the machine file, or the controller does not have this output"),
            ("the output module has failed"),
        ),
        "Check the definition of the output in the machine file, then press Reset",
        shows_detail=True,
    ),
    "feeder-gone": off(
        511,
        "driver host has ended",
        (
            (
                "the driver host (the process that operates the drives) was stopped or has failed; "
                "the drives switch off by themselves"
            ),
            "the computer ran out of memory",
        ),
        "PRESS E-STOP: the spindle may be turning. Check the tool, then press Reset to start "
        "a new driver host. Home any axis shown as not homed",
    ),
    "feeder-silent": off(
        512,
        "no response from driver host",
        (
            "the computer is overloaded; the axes stop at the end of their queued motion",
            ("the driver host has failed"),
        ),
        "PRESS E-STOP: the spindle may be turning. Check where the tool is, then press Reset "
        "to end the driver host and start a new one",
    ),
    "controller-lost": off(
        521,
        "the connection to the controller is lost",
        ("the controller cable was unplugged or damaged", "the controller's power is off"),
        "PRESS E-STOP: the spindle may be turning. Check the cable and the power, then press "
        "Reset to reconnect. Home any axis shown as not homed",
    ),
    "controller-silent": off(
        522,
        "no response from controller",
        ("a cable fault, or electrical interference on the controller cable", "the controller has locked up"),
        "Check the cable, then press Reset. If the controller does not respond, switch it off and on",
    ),
    "controller-reset": off(
        523,
        "the controller was reset",
        (
            "the controller's reset button or reset input was activated",
            "the controller's power supply failed briefly",
        ),
        "The program was canceled. Check where the tool is. Press Reset, then Drives On, and home the axes",
    ),
    "controller-refuses": off(
        524,
        "controller rejected a block",
        (
            "the controller's settings do not allow the programmed travel, speed or spindle command",
            "a block was corrupted during transmission",
        ),
        "Press Reset, then Drives On. Compare the controller's settings with the machine "
        "file ('turndesk machine check')",
        shows_detail=True,
    ),
    "controller-alarm": off(
        525,
        "controller alarm",
        ("the motion controller reported an alarm, whose number this alarm shows",),
        "Look up the controller's alarm number in its manual and correct the cause. Press "
        "Reset, then Drives On. Home any axis shown as not homed",
        shows_detail=True,
    ),
    "controller-modes": off(
        526,
        "controller lost its modal state",
        (
            "another program has sent data to the controller",
            ("the controller was reset, but the reset was not detected"),
        ),
        "Close any other software that uses the controller. Press Reset, then Drives On",
        shows_detail=True,
    ),
    "controller-estop": off(
        527,
        "controller E-stop active",
        ("the controller's E-stop or reset input is active",),
        "Release the E-stop. Press Reset, then Drives On",
    ),
    "door": off(
        528,
        "the safety door is open",
        ("the door was opened during the cycle", "a fault in the door switch or its cable"),
        "The spindle and coolant are off. Close the door, then press Reset and Drives On",
        shows_detail=True,
    ),
    "hal-bridge": off(
        531,
        "HAL bridge process has ended",
        (
            (
                "the HAL bridge process was stopped or has failed; HAL finishes its queued "
                "motion, slows to a stop and removes drive power"
            ),
            "the computer ran out of memory",
        ),
        "PRESS E-STOP: the spindle may be turning. Check the tool, then press Reset to "
        "restart HAL. Home any axis shown as not homed",
        shows_detail=True,
    ),
    "hal-silent": off(
        532,
        "no response from HAL bridge",
        (
            (
                "the computer is overloaded; HAL finishes its queued motion, slows to a stop and "
                "removes drive power"
            ),
            "the HAL bridge process has been stopped",
        ),
        "PRESS E-STOP: the spindle may be turning. Check where the tool is and close other "
        "programs, then press Reset and Drives On",
        shows_detail=True,
    ),
    "hal-thread": off(
        533,
        "HAL real-time thread stopped",
        (
            (
                "LinuxCNC's real-time process (rtapi_app) has ended; only the watchdogs of the "
                "boards now stop the axes"
            ),
            "an interface board does not respond to its driver because of a cable or power fault",
        ),
        "PRESS E-STOP: the spindle may be turning. Check power and cables of the "
        "interface boards, then press Reset to restart HAL. Home any axis shown as not "
        "homed",
    ),
    "hal-board": off(
        535,
        "connection to the I/O board lost",
        (
            "the network cable between the computer and the board is unplugged or damaged",
            "the board has no power, or its watchdog has switched it off",
            "an EtherCAT slave is not operational, or the bus is still starting",
            "the 7I76E has lost the link to its field I/O",
        ),
        "PRESS E-STOP: the spindle may be turning. Check the cable and the board power, then "
        "press Reset. Home any axis shown as not homed",
    ),
    "hal-setup": off(
        534,
        "HAL does not start",
        (
            ("a pin of LinuxCNC's HAL that the machine file names does not exist or has the wrong type"),
            "a board or component does not load, or another LinuxCNC session is running",
        ),
        "In a terminal, run 'turndesk machine check' with the machine file to list every "
        "pin. Correct the fault, then press Reset",
        shows_detail=True,
    ),
}
