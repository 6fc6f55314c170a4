"""Alarms of the slides: drives, following error, homing, limits."""

from __future__ import annotations

from core.alarms.alarm_entry import Entries, off, stop

AXES: Entries = {
    "axis": off(
        101,
        "axis drive fault",
        ("a drive has tripped: its display says why", "a motor or encoder cable", "the slide is blocked"),
        "read the drive's display, put the cause right, Reset, Drives On",
        tells=True,
    ),
    "following": off(
        102,
        "following error",
        (
            "the slide is blocked, or the tool has run into something",
            "the cut is too heavy",
            "the drive has no power or its motor cable is off",
        ),
        "look where the tool stands, free the slide, Reset, Drives On; home where the axis asks for it",
        tells=True,
    ),
    "in-position": stop(
        103,
        "slide does not arrive",
        (
            "the slide is blocked or runs stiff",
            "lubrication",
            "the window for in position is too narrow in the machine file",
        ),
        "look for what keeps the slide from its place, Reset",
        tells=True,
    ),
    "driver": off(
        104,
        "the drives refuse",
        (
            "something was asked of the drives that they cannot do now",
            "a drive was not ready any more",
        ),
        "Reset, Drives On, start again; if it comes again, the log says what was refused",
    ),
    "power-lost": off(
        105,
        "the drives have lost power",
        (
            "the safety circuit has opened: door, guard, E-stop elsewhere on the machine",
            "a fuse or the drives' supply",
        ),
        "close the safety circuit, Reset, Drives On; home where the axis asks for it",
        tells=True,
    ),
    "no-power": off(
        106,
        "the drives do not come on",
        (
            "E-stop is pressed or the safety circuit is open",
            "the drives' main power is off",
            "a drive shows a fault",
        ),
        "release the E-stop, switch the drives' power on, Reset, Drives On",
        tells=True,
    ),
    "drive-silent": off(
        107,
        "an axis drive does not answer",
        ("its bus cable is off or damaged", "its power is off", "it has failed"),
        "check the drive's power and bus cable, Reset, Drives On; home again",
        tells=True,
    ),
    "drive-restarted": off(
        108,
        "a drive has restarted",
        (
            "its control power broke down for a moment",
            "somebody has reset it or works on it by its own software",
        ),
        "check its supply, Reset, Drives On; home again",
        tells=True,
    ),
    "drive-setup": off(
        109,
        "a drive does not take its settings",
        (
            "it is another drive than the machine file says, or has other firmware",
            "a node number is wrong",
            "bus cable or power",
        ),
        "run 'turndesk machine check' with the machine file: it names the setting",
        tells=True,
    ),
    "drive-keeps-fault": off(
        110,
        "a drive keeps its fault",
        ("the cause still stands: too hot, no motor, no encoder", "it has to be switched off and on"),
        "read the drive's display; switch the machine off and on when it does not clear",
        tells=True,
    ),
    "limit-switch": off(
        111,
        "a slide has hit its limit switch",
        (
            "it was moved before it was homed",
            "the travel in the machine file is too long",
            "the switch or its cable",
        ),
        "Reset, Drives On, home; if it stands on the switch move it off by hand first",
        tells=True,
    ),
    "homing": off(
        112,
        "homing has failed",
        ("the switch was not found: its cable, or the slide went the wrong way", "the slide is blocked"),
        "look at switch and direction, Reset, Drives On, home again",
        tells=True,
    ),
    "position-lost": off(
        113,
        "the position is lost",
        ("the controller was stopped while the slides moved", "its limit was hit"),
        "Reset, Drives On, home all axes before anything is started",
        tells=True,
    ),
    "drive-limits": off(
        114,
        "a move beyond what the drives allow",
        (
            "speed or travel in the machine file differ from the drives' own",
            "the spindle was too fast for the thread's lead",
        ),
        "Reset, Drives On; compare the machine file with the drives before the program is run again",
        tells=True,
    ),
    "queue-dry": off(
        115,
        "the drives ran out of setpoints",
        ("the computer was busy with something else for too long", "the bus was disturbed"),
        "Reset, Drives On; end other programs on this computer, and restart at the line",
    ),
    "standstill": off(
        116,
        "an axis is not where it ought to stand",
        (
            "the slide is jammed, or something pushes against it",
            "its encoder or the encoder's cable",
            "the drive holds it too softly, or its motor cable is off",
        ),
        "keep clear of the slide, it may jump when it comes free; look what holds it, Reset, Drives On",
        tells=True,
    ),
    "encoder-still": off(
        117,
        "axis sent, its encoder does not count",
        (
            "the encoder, its cable or its coupling: the slide may have moved all the same",
            "the slide is jammed, or the tool has run into something",
            "the motor cable is off",
        ),
        "look where the slide really stands; check encoder and coupling, Reset, Drives On, home the axis",
        tells=True,
    ),
    "moved-unasked": off(
        118,
        "an axis has moved unasked",
        (
            "it was moved by hand while the drives are off",
            "it sinks: no brake, or the brake slips",
            "somebody else moves the drive: its own software, a pendant",
        ),
        "look where the slide stands and that nothing is in its way, Reset, Drives On",
        tells=True,
    ),
}
