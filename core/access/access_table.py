"""Table of the changes that each access level may make, used by screen, commands and ``docs/access.md``.

The table covers stored data, and two manual actions that override the setup: raising the spindle speed limit
and switching an output. Actions that bring the machine to rest need no level: E-stop, feed hold, Reset,
ending a function, and drives off. Running a proved program needs no level either.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum


class Level(IntEnum):
    """An access level. Each level includes the permissions of the lower levels."""

    OPERATOR = 1
    SETUP = 2
    SERVICE = 3


class Act(Enum):
    """A protected change, with its name on the screen."""

    WEAR = "WEAR AND SECONDARY OFFSETS"
    COUNTS = "PART COUNTS"
    INSERTS = "NEW INSERTS"
    READINGS = "PART MEASUREMENTS"
    JOBS = "JOB QUEUE"
    SCREEN = "SCREEN SETTINGS"
    INPUTS = "SIMULATED INPUTS"
    BACKUPS = "BACKUPS"
    TOOLS = "TOOL OFFSETS"
    SHAPES = "TOOL SHAPES"
    ZEROS = "ZERO OFFSETS"
    PRESETS = "PRESETS"
    PROGRAMS = "PROGRAMS"
    STOCK = "STOCK AND CHECKS"
    LIVES = "TOOL LIFE"
    FEATURES = "MEASURED FEATURES"
    TRANSFER = "TRANSFER SETTINGS"
    RECORDS = "SCOPE RECORDINGS"
    SPINDLE_LIMIT = "HIGHER SPINDLE SPEED LIMIT"
    OUTPUTS = "MANUAL OUTPUTS"
    MACHINE_FILE = "THE MACHINE FILE"
    RESTORE = "RESTORED DATA"
    SHARED_PLACE = "SHARED PROGRAM LOCATION"
    PEOPLE = "USERS AND PINS"


@dataclass(frozen=True, slots=True)
class Rule:
    """The minimum level for a change, its description, and its pages and commands."""

    level: Level
    what: str
    where: str
    command: str = ""


RULES: dict[Act, Rule] = {
    Act.WEAR: Rule(
        Level.OPERATOR,
        "tool wear values and tool remarks; secondary offsets; DL, DR and DR2 of a "
        "mill's tools; undoing changes to these values",
        "F8, F9, W",
        "offsets set, offsets clear D, offsets undo secondary",
    ),
    Act.COUNTS: Rule(
        Level.OPERATOR, "the part count, and the target count at which production stops", "F10 PARTS COUNTER"
    ),
    Act.INSERTS: Rule(
        Level.OPERATOR,
        "replacing an insert or a tool, which resets the tool life count to zero",
        "key W; on a mill also key F8",
    ),
    Act.READINGS: Rule(Level.OPERATOR, "entering and deleting the measured values of parts", "W"),
    Act.JOBS: Rule(Level.OPERATOR, "jobs in the queue, with their order, part counts and notes", "J", "jobs"),
    Act.SCREEN: Rule(Level.OPERATOR, "units, language, colors, sounds, notes, paper size", "F10"),
    Act.INPUTS: Rule(Level.OPERATOR, "the inputs of a simulated machine", "F10 INPUTS AND OUTPUTS"),
    Act.BACKUPS: Rule(
        Level.OPERATOR, "making a backup or an export", "F10", "store backup, store export, setup save"
    ),
    Act.TOOLS: Rule(
        Level.SETUP,
        "entering or touching off a tool's position, nose radius, tip quadrant and "
        "master tool; editing the tools of a mill; undoing or clearing these values",
        "F8, F5",
        "offsets set, offsets clear, offsets undo, tools import",
    ),
    Act.SHAPES: Rule(Level.SETUP, "the shape of a tool", "F8 twice", "offsets set T3 kind=…, tools import"),
    Act.ZEROS: Rule(Level.SETUP, "G54 to G59", "G", "offsets set G54"),
    Act.PRESETS: Rule(
        Level.SETUP,
        "presets of a mill, and the selection of the active preset",
        "keys F9 and F5 on a mill",
        "offsets set",
    ),
    Act.PROGRAMS: Rule(
        Level.SETUP,
        "saving, copying, renaming, deleting, importing and receiving programs; "
        "publishing a program from the command line; accepting another control's "
        "version or keeping this control's own version",
        "F3, F6, F10, X",
        "serial receive, share publish, share take, share keep, profile --out, shapes --out",
    ),
    Act.STOCK: Rule(
        Level.SETUP,
        "stock, stick-out and disabled checks of a program",
        "B",
        "prove --keep-stock, run --keep-stock",
    ),
    Act.LIVES: Rule(
        Level.SETUP, "tool life limits, and whether production stops when a limit is reached", "W"
    ),
    Act.FEATURES: Rule(
        Level.SETUP,
        "features to measure on a part, whether production waits for the measurement, and shift hours",
        "W",
    ),
    Act.TRANSFER: Rule(Level.SETUP, "serial port settings", "F10 RS-232"),
    Act.RECORDS: Rule(
        Level.SETUP, "deleting a saved scope record; every access level can save a record", "Q"
    ),
    Act.SPINDLE_LIMIT: Rule(
        Level.SETUP,
        "removing or raising the spindle speed limit; everyone can lower it",
        "F10 MAXIMUM SPINDLE SPEED",
    ),
    Act.OUTPUTS: Rule(
        Level.SETUP,
        "switching an output by its name; everyone can use the lamp test",
        "F10 INPUTS AND OUTPUTS",
    ),
    Act.MACHINE_FILE: Rule(
        Level.SERVICE, "accepting a changed machine file", "F10 MACHINE FILE", "machine accept"
    ),
    Act.RESTORE: Rule(
        Level.SERVICE,
        "replacing the stored data with a backup, an export or a setup",
        "F10 BACKUP AND RESTORE",
        "store restore, store import, setup load",
    ),
    Act.SHARED_PLACE: Rule(
        Level.SERVICE,
        "setting up the shared location for programs; giving this control the name of a "
        "control that no longer exists",
        "",
        "share begin, share publish --claim",
    ),
    Act.PEOPLE: Rule(Level.SERVICE, "users, their levels and PINs", "F10 ACCESS LEVELS", "access"),
}

NEVER = (
    "E-stop",
    "feed hold",
    "Reset",
    "ending a running program or operation",
    "drives off",
    "lowering the spindle speed limit",
    "running a program that has been proved",
)
"""What no level ever stands in the way of."""


def level_for(act: Act) -> Level:
    """Return the minimum level for a change."""
    return RULES[act].level
