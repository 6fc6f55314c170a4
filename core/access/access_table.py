"""Table of the changes that each access level may make.

The screen, the commands and ``docs/access.md`` use this table. It covers stored data, a higher spindle
speed limit, and manual switching of outputs. Two kinds of action never need a level: running a proved
program, and bringing the machine to rest (E-stop, feed hold, Reset, ending a function, drives off).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum


class AccessLevel(IntEnum):
    """An access level. Each level includes the permissions of the lower levels."""

    OPERATOR = 1
    SETUP = 2
    SERVICE = 3


class ProtectedChange(Enum):
    """Change that requires an access level, with its name on the screen."""

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
class AccessRule:
    """Rule for a protected change: its minimum level, its description, and its pages and commands."""

    minimum_level: AccessLevel
    description: str
    pages_text: str
    commands_text: str = ""


ACCESS_RULES: dict[ProtectedChange, AccessRule] = {
    ProtectedChange.WEAR: AccessRule(
        AccessLevel.OPERATOR,
        "tool wear values and tool remarks; secondary offsets; DL, DR and DR2 of a "
        "mill's tools; undoing changes to these values",
        "F8, F9, W",
        "offsets set, offsets clear D, offsets undo secondary",
    ),
    ProtectedChange.COUNTS: AccessRule(
        AccessLevel.OPERATOR,
        "the part count, and the target count at which production stops",
        "F10 PARTS COUNTER",
    ),
    ProtectedChange.INSERTS: AccessRule(
        AccessLevel.OPERATOR,
        "replacing an insert or a tool, which resets the tool life count to zero",
        "key W; on a mill also key F8",
    ),
    ProtectedChange.READINGS: AccessRule(
        AccessLevel.OPERATOR, "entering and deleting the measured values of parts", "W"
    ),
    ProtectedChange.JOBS: AccessRule(
        AccessLevel.OPERATOR, "jobs in the queue, with their order, part counts and notes", "J", "jobs"
    ),
    ProtectedChange.SCREEN: AccessRule(
        AccessLevel.OPERATOR, "units, language, colors, sounds, notes, paper size", "F10"
    ),
    ProtectedChange.INPUTS: AccessRule(
        AccessLevel.OPERATOR, "the inputs of a simulated machine", "F10 INPUTS AND OUTPUTS"
    ),
    ProtectedChange.BACKUPS: AccessRule(
        AccessLevel.OPERATOR, "making a backup or an export", "F10", "store backup, store export, setup save"
    ),
    ProtectedChange.TOOLS: AccessRule(
        AccessLevel.SETUP,
        "entering or touching off a tool's position, nose radius, tip quadrant and "
        "master tool; editing the tools of a mill; undoing or clearing these values",
        "F8, F5",
        "offsets set, offsets clear, offsets undo, tools import",
    ),
    ProtectedChange.SHAPES: AccessRule(
        AccessLevel.SETUP, "the shape of a tool", "F8 twice", "offsets set T3 kind=…, tools import"
    ),
    ProtectedChange.ZEROS: AccessRule(AccessLevel.SETUP, "G54 to G59", "G", "offsets set G54"),
    ProtectedChange.PRESETS: AccessRule(
        AccessLevel.SETUP,
        "presets of a mill, and the selection of the active preset",
        "keys F9 and F5 on a mill",
        "offsets set",
    ),
    ProtectedChange.PROGRAMS: AccessRule(
        AccessLevel.SETUP,
        "saving, copying, renaming, deleting, importing and receiving programs; "
        "publishing a program from the command line; accepting another control's "
        "version or keeping this control's own version",
        "F3, F6, F10, X",
        "serial receive, share publish, share take, share keep, profile --out, shapes --out",
    ),
    ProtectedChange.STOCK: AccessRule(
        AccessLevel.SETUP,
        "stock, stick-out and disabled checks of a program",
        "B",
        "prove --keep-stock, run --keep-stock",
    ),
    ProtectedChange.LIVES: AccessRule(
        AccessLevel.SETUP, "tool life limits, and whether production stops when a limit is reached", "W"
    ),
    ProtectedChange.FEATURES: AccessRule(
        AccessLevel.SETUP,
        "features to measure on a part, whether production waits for the measurement, and shift hours",
        "W",
    ),
    ProtectedChange.TRANSFER: AccessRule(AccessLevel.SETUP, "serial port settings", "F10 RS-232"),
    ProtectedChange.RECORDS: AccessRule(
        AccessLevel.SETUP, "deleting a saved scope record; every access level can save a record", "Q"
    ),
    ProtectedChange.SPINDLE_LIMIT: AccessRule(
        AccessLevel.SETUP,
        "removing or raising the spindle speed limit; everyone can lower it",
        "F10 MAXIMUM SPINDLE SPEED",
    ),
    ProtectedChange.OUTPUTS: AccessRule(
        AccessLevel.SETUP,
        "switching an output by its name; everyone can use the lamp test",
        "F10 INPUTS AND OUTPUTS",
    ),
    ProtectedChange.MACHINE_FILE: AccessRule(
        AccessLevel.SERVICE, "accepting a changed machine file", "F10 MACHINE FILE", "machine accept"
    ),
    ProtectedChange.RESTORE: AccessRule(
        AccessLevel.SERVICE,
        "replacing the stored data with a backup, an export or a setup",
        "F10 BACKUP AND RESTORE",
        "store restore, store import, setup load",
    ),
    ProtectedChange.SHARED_PLACE: AccessRule(
        AccessLevel.SERVICE,
        "setting up the shared location for programs; giving this control the name of a "
        "control that no longer exists",
        "",
        "share begin, share publish --claim",
    ),
    ProtectedChange.PEOPLE: AccessRule(
        AccessLevel.SERVICE, "users, their levels and PINs", "F10 ACCESS LEVELS", "access"
    ),
}

NEVER_PERMITTED = (
    "E-stop",
    "feed hold",
    "Reset",
    "ending a running program or operation",
    "drives off",
    "lowering the spindle speed limit",
    "running a program that has been proved",
)
"""Actions that no access level can block."""


def get_required_level(change: ProtectedChange) -> AccessLevel:
    """Return the minimum access level that a change requires."""
    return ACCESS_RULES[change].minimum_level
