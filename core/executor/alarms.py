"""Every alarm the control can raise: its number, what it says, why, what to do, and what is stopped."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from core.executor.snapshot import Alarm


class Reaction(Enum):
    """What an alarm makes of the machine; one supervisor carries it out for all drivers."""

    STOP = "the slides brake and hold, spindle off, outputs safe"
    OFF = "the slides brake and lose power, spindle off, outputs safe"


class _Entry(NamedTuple):
    number: int
    reaction: Reaction
    text: str
    cause: str
    remedy: str


_STOP, _OFF = Reaction.STOP, Reaction.OFF
_CATALOGUE = {
    "axis": _Entry(101, _OFF, "axis drive fault", "a drive has tripped", "clear the cause, Reset, drives on"),
    "following": _Entry(
        102, _OFF, "following error", "a slide does not follow its setpoints", "free the slide, Reset"
    ),
    "in-position": _Entry(
        103, _STOP, "slide does not arrive", "not in position in time", "look for a blocked slide, Reset"
    ),
    "driver": _Entry(
        104,
        _OFF,
        "driver refuses",
        "a driver could not do what it was asked",
        "Reset, drives on, start again",
    ),
    "spindle": _Entry(
        201, _STOP, "spindle drive fault", "the spindle drive has tripped", "clear the drive's fault, Reset"
    ),
    "at-speed": _Entry(
        202, _STOP, "spindle not at speed", "speed not reached in time", "check spindle drive and load, Reset"
    ),
    "ignores-stop": _Entry(
        203,
        _STOP,
        "spindle ignores the command",
        "it turns faster than it was told",
        "PRESS E-STOP, then find out why",
    ),
    "spindle-still": _Entry(
        204, _STOP, "feed per revolution with a still spindle", "no M03 or M04", "start the spindle first"
    ),
    "c-is-spindle": _Entry(
        206,
        _STOP,
        "C moves while the spindle turns",
        "on this machine the spindle is C",
        "stop it with M05 first",
    ),
    "thread-lost": _Entry(
        205, _STOP, "spindle lost in a thread", "speed fell during a pass; X was drawn back", "check the part"
    ),
    "collet-open": _Entry(
        301, _STOP, "spindle start with the collet open", "the collet is not closed", "close it with M12"
    ),
    "unclamp": _Entry(
        302, _STOP, "unclamping refused", "the spindle still turns", "stop the spindle before M13"
    ),
    "collet": _Entry(
        303, _STOP, "collet does not answer", "its switch did not follow", "check air and switch, Reset"
    ),
    "collet-lost": _Entry(
        304, _STOP, "collet has opened", "the switch fell while the spindle turned", "check collet and bar"
    ),
    "program": _Entry(
        401, _STOP, "program error", "this line cannot be run", "correct the program and load it again"
    ),
    "travel": _Entry(
        402, _STOP, "end of travel", "a block leaves the soft limits", "check offsets and start position"
    ),
    "internal": _Entry(
        901, _OFF, "the control has failed", "a mistake in the control", "save the log, restart the control"
    ),
}


class TroubleError(Exception):
    """Something that must stop the machine: an alarm's code, and what exactly, where."""

    def __init__(self, code: str, detail: str = "", line: int = 0) -> None:
        super().__init__(detail or _CATALOGUE[code].text)
        self.code = code
        self.detail = detail
        self.line = line


def alarm_of(trouble: TroubleError, line: int, now: float) -> tuple[Alarm, Reaction]:
    """The alarm to show, and what it makes of the machine."""
    entry = _CATALOGUE[trouble.code]
    alarm = Alarm(
        number=entry.number,
        code=trouble.code,
        text=entry.text.upper(),
        cause=trouble.detail or entry.cause,
        remedy=entry.remedy,
        line=trouble.line or line,
        time=now,
    )
    return alarm, entry.reaction
