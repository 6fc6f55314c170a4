"""An entry of the alarm catalogue, the codes that there are, and what each makes of the machine."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from functools import partial
from typing import Literal, NamedTuple

from core.faults import FaultCode

# What the control itself finds; drivers have theirs in ``core.faults``.
OwnCode = Literal[
    # axes, spindle, thread
    "in-position",
    "standstill",
    "encoder-still",
    "moved-unasked",
    "at-speed",
    "spindle-still",
    "c-is-spindle",
    "spindle-orient",
    "thread-lost",
    # chuck
    "collet-open",
    "unclamp",
    "collet",
    "collet-lost",
    # program
    "program",
    "travel",
    "no-end",
    # the control
    "internal",
    "not-safe",
    "control-silent",
    "feeder-tripped",
    "switched-off",
    # holds that nobody pressed
    "station-silent",
    "pot-jumps",
    "pendant",
    "guard-open",
    "low-queue",
    "spindle-slow",
    "spindle-stopped",
    "spindle-switch",
    "spindle-pot",
    "controller-holds",
    "held",
    "spindle-has-stopped",
    "spindle-late",
    # stops that somebody asked for
    "estop",
    "feed-hold",
    "reset",
    "program-stop",
    "optional-stop",
    "single-block",
    "by-hand",
]
Code = Literal[FaultCode, OwnCode]


class Reaction(Enum):
    """What an alarm makes of the machine; one supervisor carries it out for all drivers."""

    OFF = (
        "the axes brake and their drives lose power, the spindle is switched off, and the "
        "outputs go to their safe state; press Reset to acknowledge"
    )
    STOP = (
        "the axes brake and hold position, the spindle is switched off, and the outputs go "
        "to their safe state; press Reset to acknowledge"
    )
    HOLD = "the axes stop on the path and the spindle continues to turn; press Cycle Start to resume"
    ASKED = "a stop requested by a button or by the program"


class Entry(NamedTuple):
    """``text`` is what happened, ``causes`` why, the likeliest first, ``remedy`` what to do now.

    ``tells``: what comes with the alarm (an axis, a line, a drive's own word) is for the operator too, and
    stands before the causes. Without it that goes to the log alone.
    """

    number: int
    text: str
    causes: tuple[str, ...]
    remedy: str
    reaction: Reaction
    tells: bool = False


Entries = Mapping[Code, Entry]
# An entry of the catalogue begins with what it makes of the machine.
off, stop = partial(Entry, reaction=Reaction.OFF), partial(Entry, reaction=Reaction.STOP)
hold, asked = partial(Entry, reaction=Reaction.HOLD), partial(Entry, reaction=Reaction.ASKED)
