"""What each level may change, in one table. Screen, commands and ``docs/access.md`` read it here alone.

It is about what is kept, and about two things that undo by hand what setting up has laid down: a spindle
limit that is raised, an output that is switched. What brings the machine to rest stands in no level: E-stop,
feed hold, Reset, ending what runs, drives off; nor does running a program that is proved.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum


class Level(IntEnum):
    """A level may all that those before it may."""

    OPERATOR = 1
    SETUP = 2
    SERVICE = 3


class Act(Enum):
    """What is changed, as the screen names it."""

    WEAR = "WEAR AND CORRECTIONS"
    COUNTS = "PART COUNTS"
    INSERTS = "FRESH INSERTS"
    READINGS = "READINGS OF PARTS"
    JOBS = "THE QUEUE OF JOBS"
    SCREEN = "THE SCREEN'S SETTINGS"
    INPUTS = "SIMULATED INPUTS"
    BACKUPS = "BACKUPS"
    TOOLS = "TOOL OFFSETS"
    SHAPES = "TOOL SHAPES"
    ZEROS = "ZERO OFFSETS"
    PRESETS = "PRESETS"
    PROGRAMS = "PROGRAMS"
    STOCK = "STOCK AND CHECKS"
    LIVES = "TOOL LIVES"
    FEATURES = "MEASURED FEATURES"
    TRANSFER = "TRANSFER SETTINGS"
    RECORDS = "RECORDS OF THE SCOPE"
    SPINDLE_LIMIT = "A HIGHER SPINDLE LIMIT"
    OUTPUTS = "OUTPUTS BY HAND"
    MACHINE_FILE = "THE MACHINE FILE"
    RESTORE = "WHAT IS RESTORED"
    SHARED_PLACE = "THE PLACE OF SHARED PROGRAMS"
    PEOPLE = "PEOPLE AND THEIR PINS"


@dataclass(frozen=True, slots=True)
class Rule:
    """The level from which on something may be changed; what that is, and by which pages and commands."""

    level: Level
    what: str
    where: str
    command: str = ""


RULES: dict[Act, Rule] = {
    Act.WEAR: Rule(
        Level.OPERATOR,
        "wear and remark of a tool, secondary offsets, DL, DR and DR2 of a mill's tool; taking these back",
        "F8, F9, W",
        "offsets set, clear D, undo secondary",
    ),
    Act.COUNTS: Rule(
        Level.OPERATOR, "the part count and the number at which parts stop", "F10 PARTS COUNTER"
    ),
    Act.INSERTS: Rule(Level.OPERATOR, "a fresh insert or tool: its life begins at nought", "W, F8 of a mill"),
    Act.READINGS: Rule(Level.OPERATOR, "readings of parts, and taking one out", "W"),
    Act.JOBS: Rule(Level.OPERATOR, "jobs, their order, counts and notes", "J", "jobs"),
    Act.SCREEN: Rule(Level.OPERATOR, "units, language, colours, sounds, notes, paper", "F10"),
    Act.INPUTS: Rule(Level.OPERATOR, "the inputs of a simulated machine", "F10 INPUTS AND OUTPUTS"),
    Act.BACKUPS: Rule(
        Level.OPERATOR, "making a backup, an export", "F10", "store backup, store export, setup save"
    ),
    Act.TOOLS: Rule(
        Level.SETUP,
        "position, nose radius, tip and master of a tool, typed or touched off; a mill's tools; "
        "undo and clearing",
        "F8, F5",
        "offsets set, clear, undo",
    ),
    Act.SHAPES: Rule(Level.SETUP, "the shape of a tool", "F8 twice", "offsets set T3 kind=…"),
    Act.ZEROS: Rule(Level.SETUP, "G54 to G59", "G", "offsets set G54"),
    Act.PRESETS: Rule(
        Level.SETUP, "presets of a mill, and which is in force", "F9, F5 of a mill", "offsets set"
    ),
    Act.PROGRAMS: Rule(
        Level.SETUP,
        "saving, copying, renaming, deleting, importing and receiving a program; publishing it by a command, "
        "taking that of another desk or keeping one's own against it",
        "F3, F6, F10, X",
        "serial receive, share publish, share take, share keep, profile --out, shapes --out",
    ),
    Act.STOCK: Rule(
        Level.SETUP,
        "stock, stick-out and silenced checks of a program",
        "B",
        "prove --keep-stock, run --keep-stock",
    ),
    Act.LIVES: Rule(Level.SETUP, "limits of tool lives, and whether parts stop at them", "W"),
    Act.FEATURES: Rule(
        Level.SETUP, "what is measured on a part, whether parts wait for it, the hours of a shift", "W"
    ),
    Act.TRANSFER: Rule(Level.SETUP, "the serial line's settings", "F10 RS-232"),
    Act.RECORDS: Rule(Level.SETUP, "deleting a record of the scope; keeping one is everybody's", "Q"),
    Act.SPINDLE_LIMIT: Rule(
        Level.SETUP,
        "lifting or raising the spindle's speed limit; a lower one is everybody's",
        "F10 MAXIMUM SPINDLE SPEED",
    ),
    Act.OUTPUTS: Rule(
        Level.SETUP,
        "switching an output by its name; the lamp test is everybody's",
        "F10 INPUTS AND OUTPUTS",
    ),
    Act.MACHINE_FILE: Rule(
        Level.SERVICE, "accepting a changed machine file", "F10 MACHINE FILE", "machine accept"
    ),
    Act.RESTORE: Rule(
        Level.SERVICE,
        "putting a backup, an export or a setup in the place of what is kept",
        "F10 BACKUP AND RESTORE",
        "store restore, store import, setup load",
    ),
    Act.SHARED_PLACE: Rule(
        Level.SERVICE,
        "laying out the place of shared programs, going on as a desk that is gone",
        "",
        "share begin, share publish --claim",
    ),
    Act.PEOPLE: Rule(Level.SERVICE, "people, their levels and PINs", "F10 ACCESS LEVELS", "access"),
}

NEVER = (
    "E-stop",
    "feed hold",
    "Reset",
    "ending what runs",
    "drives off",
    "a lower spindle limit",
    "running a proved program",
)
"""What no level ever stands in the way of."""


def level_for(act: Act) -> Level:
    """The level from which on it may be changed."""
    return RULES[act].level
