"""What each level may change, in one table. Screen, commands and ``docs/access.md`` read it here alone.

It is about what is kept. What brings the machine to rest stands in no level: E-stop, feed hold, Reset, ending
what runs, drives off; nor does running a program that is proved.
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
    MACHINE_FILE = "THE MACHINE FILE"
    RESTORE = "WHAT IS RESTORED"
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
    Act.BACKUPS: Rule(Level.OPERATOR, "making a backup, an export", "F10", "store backup, store export"),
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
        "saving, copying, renaming, deleting, importing and receiving a program; taking one of another desk, "
        "or settling that what is here stands",
        "F3, F6, F10, X",
        "share take, share keep",
    ),
    Act.STOCK: Rule(Level.SETUP, "stock, stick-out and silenced checks of a program", "B"),
    Act.LIVES: Rule(Level.SETUP, "limits of tool lives, and whether parts stop at them", "W"),
    Act.FEATURES: Rule(
        Level.SETUP, "what is measured on a part, whether parts wait for it, the hours of a shift", "W"
    ),
    Act.TRANSFER: Rule(Level.SETUP, "the serial line's settings", "F10 RS-232"),
    Act.MACHINE_FILE: Rule(
        Level.SERVICE, "accepting a changed machine file", "F10 MACHINE FILE", "machine accept"
    ),
    Act.RESTORE: Rule(
        Level.SERVICE,
        "putting a backup, an export or a setup in the place of what is kept",
        "F10 BACKUP AND RESTORE",
        "store restore, store import, setup load",
    ),
    Act.PEOPLE: Rule(Level.SERVICE, "people, their levels and PINs", "F10 ACCESS LEVELS", "access"),
}

NEVER = ("E-stop", "feed hold", "Reset", "ending what runs", "drives off", "running a proved program")
"""What no level ever stands in the way of."""


def level_for(act: Act) -> Level:
    """The level from which on it may be changed."""
    return RULES[act].level
