"""Starting actions that a late press does not carry out: the one closed list of them.

A press is late when it was made before the end of a stall of the screen. Every other late press is carried
out in its order. Whether a press starts something is decided where it would do so, because one key has many
meanings: at the command that it posts, at the simulated station, and at the answer to a question.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum, auto

from app.desk.translation import tr
from core.executor import commands
from core.executor.commands import Command
from core.executor.snapshot import Snapshot, State

TOLD = 4.0  # s after the last dropped press; what is dropped later gets a message of its own


class Starting(Enum):
    """What a press may start: motion, the drives, the spindle, an output, or what a question asks about."""

    CYCLE = auto()
    DRIVES = auto()
    ACKNOWLEDGE = auto()
    JOG = auto()
    HANDWHEEL = auto()
    TOUCH_OFF = auto()
    DRIVE_TEST = auto()
    HOME = auto()
    OUTPUT = auto()
    INPUT = auto()
    SPINDLE = auto()
    OVERRIDE = auto()
    RELEASE = auto()
    LINE_1 = auto()
    YES = auto()
    FOLLOWING = auto()  # of any kind, after an answer that was dropped
    TOUCH = auto()  # on a screen that looks different now


def name_of(starting: Starting) -> str:
    """Return what the operator calls it."""
    names = {
        Starting.CYCLE: tr("CYCLE START"),
        Starting.DRIVES: tr("DRIVES ON"),
        Starting.ACKNOWLEDGE: tr("RESET"),
        Starting.JOG: tr("JOG"),
        Starting.HANDWHEEL: tr("HANDWHEEL"),
        Starting.TOUCH_OFF: tr("TOUCH-OFF"),
        Starting.DRIVE_TEST: tr("DRIVE TEST"),
        Starting.HOME: tr("HOME"),
        Starting.OUTPUT: tr("OUTPUT"),
        Starting.INPUT: tr("SIMULATED INPUT"),
        Starting.SPINDLE: tr("SPINDLE"),
        Starting.OVERRIDE: tr("FEED RATE"),
        Starting.RELEASE: tr("E-STOP RELEASE"),
        Starting.LINE_1: tr("START AT LINE 1"),
        Starting.YES: tr("YES"),
        Starting.FOLLOWING: tr("ALL KEYS AFTER YES"),
        Starting.TOUCH: tr("TOUCH"),
    }
    return names[starting]


Rule = Callable[[Command, Snapshot], bool]


def _always(_command: Command, _now: Snapshot) -> bool:
    return True


def _acknowledges(_command: Command, now: Snapshot) -> bool:
    """Return whether it clears an alarm, which may have come up during the stall; any other Reset stops."""
    return now.state is State.FAULT


def _begins_at_line_1(command: Command, _now: Snapshot) -> bool:
    return isinstance(command, commands.ConfirmStart) and bool(command.at)


def _switches(command: Command, _now: Snapshot) -> bool:
    """Return whether it is more than the key that switches the coolant off."""
    return isinstance(command, commands.ForceOutput) and (command.on or command.name != "coolant")


def _raises(command: Command, now: Snapshot) -> bool:
    """Return whether it makes the axes faster: hands that saw no effect press too often."""
    return isinstance(command, commands.FeedOverride) and command.fraction > now.feed_override


STARTS: Mapping[type[Command], tuple[Starting, Rule]] = {
    commands.CycleStart: (Starting.CYCLE, _always),
    commands.EnableDrives: (Starting.DRIVES, _always),
    commands.Reset: (Starting.ACKNOWLEDGE, _acknowledges),
    commands.Jog: (Starting.JOG, _always),
    commands.JogStep: (Starting.JOG, _always),
    commands.Wheel: (Starting.HANDWHEEL, _always),
    commands.Touch: (Starting.TOUCH_OFF, _always),
    commands.DriveTest: (Starting.DRIVE_TEST, _always),
    commands.Home: (Starting.HOME, _always),
    commands.ForceOutput: (Starting.OUTPUT, _switches),
    commands.FeedOverride: (Starting.OVERRIDE, _raises),
    commands.ConfirmStart: (Starting.LINE_1, _begins_at_line_1),
}
"""Commands that start something, and when."""

HARMLESS: frozenset[type[Command]] = frozenset(
    {
        commands.LoadJob,
        commands.GiveProof,
        commands.Renew,
        commands.LeftInterrupted,
        commands.FeedHold,
        commands.SetSwitch,
        commands.JogStop,
        commands.DriveTestOn,
        commands.WheelOff,
        commands.SpindleLimit,
        commands.UseOffsets,
        commands.SpindleStop,
        commands.PartsMade,
        commands.GiveClearance,
        commands.BarNextPart,
        commands.Prepare,
    }
)
"""All other commands. They start nothing without one of the commands that start."""


def starts(command: Command, now: Snapshot) -> Starting | None:
    """Return what a command starts, None where it starts nothing."""
    found = STARTS.get(type(command))
    return found[0] if found is not None and found[1](command, now) else None


@dataclass(slots=True)
class LatePresses:
    """Drops what a late press would start, and collects it for one message. ``clock`` is monotonic, s.

    ``report`` gets the names of all that was dropped; ``on_answer`` is called when an answer was.
    """

    snapshot: Callable[[], Snapshot]
    clock: Callable[[], float]
    report: Callable[[tuple[str, ...]], None] = lambda _names: None
    on_answer: Callable[[], None] = lambda: None
    late: bool = False  # the press that is handled now is late
    _dropped: list[Starting] = field(default_factory=list)
    _last: float = float("-inf")

    def refuses(self, starting: Starting) -> bool:
        """Return whether the press that is handled now must not start this; it is reported then."""
        if self.late:
            self.report_dropped(starting)
        return self.late

    def report_dropped(self, starting: Starting) -> None:
        """Report that a press is not carried out, with what else was dropped a moment ago."""
        now = self.clock()
        if now - self._last > TOLD:
            self._dropped.clear()
        self._last = now
        if starting not in self._dropped:
            self._dropped.append(starting)
        if starting is Starting.YES:
            self.on_answer()
        self.report(tuple(name_of(each) for each in self._dropped))

    @contextmanager
    def suspended(self) -> Iterator[None]:
        """Meanwhile nothing is done by the press: what is held is renewed once a frame."""
        late, self.late = self.late, False
        try:
            yield
        finally:
            self.late = late

    def guard(self, post: Callable[[Command], None]) -> Callable[[Command], None]:
        """Return ``post`` without the commands that a late press must not give."""

        def guarded(command: Command) -> None:
            starting = starts(command, self.snapshot()) if self.late else None
            if starting is None or not self.refuses(starting):
                post(command)

        return guarded
