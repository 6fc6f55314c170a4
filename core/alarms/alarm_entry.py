"""Entries of the alarm catalog, the alarm codes, and the reactions of the machine."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from functools import partial
from typing import Literal, NamedTuple

from core.faults import FaultCode

# Codes of the control; those of drivers are in ``core.faults``.
ControlAlarmCode = Literal[
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
    "no-real-time",
    # holds not requested by the operator
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
    # stops requested by the operator or the program
    "estop",
    "feed-hold",
    "reset",
    "program-stop",
    "optional-stop",
    "single-block",
    "by-hand",
]
AlarmCode = Literal[FaultCode, ControlAlarmCode]


class AlarmReaction(Enum):
    """The reaction of the machine to an alarm. One supervisor performs the reaction for all drivers."""

    DRIVES_OFF = (
        "the axes brake and their drives lose power, the spindle is switched off, and the "
        "outputs go to their safe state; press Reset to acknowledge"
    )
    STOP = (
        "the axes brake and hold position, the spindle is switched off, and the outputs go "
        "to their safe state; press Reset to acknowledge"
    )
    HOLD = "the axes stop on the path and the spindle continues to turn; press Cycle Start to resume"
    REQUESTED = "a stop requested by a button or by the program"
    NOTICE = "a notice in the list of F7; the machine continues"


class AlarmEntry(NamedTuple):
    """An entry of the alarm catalog.

    ``causes`` are listed from most to least likely. If ``shows_detail`` is True, the operator sees the
    details of the alarm before the causes. A detail is, for example, an axis, a line or a message of a
    drive. Otherwise the details are only logged.
    """

    number: int
    text: str
    causes: tuple[str, ...]
    remedy: str
    reaction: AlarmReaction
    shows_detail: bool = False


AlarmEntries = Mapping[AlarmCode, AlarmEntry]
# Constructors of catalog entries, one for each reaction.
off, stop = (
    partial(AlarmEntry, reaction=AlarmReaction.DRIVES_OFF),
    partial(AlarmEntry, reaction=AlarmReaction.STOP),
)
hold, asked, notice = (
    partial(AlarmEntry, reaction=AlarmReaction.HOLD),
    partial(AlarmEntry, reaction=AlarmReaction.REQUESTED),
    partial(AlarmEntry, reaction=AlarmReaction.NOTICE),
)
