"""The complete list of actions that a late key press or touch must not start.

A press is late if it was made before the end of a stall of the screen. All other late presses are executed in
order. One key has many meanings, so each press is checked where it would start something: at the command that
it posts, at the simulated station and at the answer to a question.
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

TOLD = 4.0  # Seconds after the last dropped press. A press dropped later gets a new message.


class Starting(Enum):
    """An action that a press may start, for example motion, drives or an output."""

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
    FOLLOWING = auto()  # Any key after a dropped answer.
    TOUCH = auto()  # A touch on a screen that has changed since.


def name_of(starting: Starting) -> str:
    """Return the operator's name of a starting action, translated."""
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
    """Return whether a reset acknowledges an alarm, which may be new. Any other reset stops the program."""
    return now.state is State.FAULT


def _begins_at_line_1(command: Command, _now: Snapshot) -> bool:
    return isinstance(command, commands.ConfirmStart) and bool(command.at)


def _switches(command: Command, _now: Snapshot) -> bool:
    """Return whether a forced output can start something. Only switching the coolant off cannot."""
    return isinstance(command, commands.ForceOutput) and (command.on or command.name != "coolant")


def _raises(command: Command, now: Snapshot) -> bool:
    """Return whether a command raises the feed override.

    An operator who sees no effect on a stalled screen tends to press the key too often.
    """
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
    """Return the action that a command starts, or None if the command starts nothing."""
    found = STARTS.get(type(command))
    return found[0] if found is not None and found[1](command, now) else None


@dataclass(slots=True)
class LatePresses:
    """Drops actions that a late press would start, and collects their names for one message.

    ``clock`` returns monotonic time in seconds. ``report`` gets the names of all dropped actions.
    ``on_answer`` is called when the answer to a question was dropped.
    """

    snapshot: Callable[[], Snapshot]
    clock: Callable[[], float]
    report: Callable[[tuple[str, ...]], None] = lambda _names: None
    on_answer: Callable[[], None] = lambda: None
    late: bool = False  # The press that is being handled is late.
    _dropped: list[Starting] = field(default_factory=list)
    _last: float = float("-inf")

    def refuses(self, starting: Starting) -> bool:
        """Return whether the present press is too late to start this action. A dropped action is reported."""
        if self.late:
            self.report_dropped(starting)
        return self.late

    def report_dropped(self, starting: Starting) -> None:
        """Report a dropped action together with the actions that were dropped shortly before."""
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
        """Return a context in which actions do not count as caused by the press.

        It is used when a key that is held down is renewed, once a frame.
        """
        late, self.late = self.late, False
        try:
            yield
        finally:
            self.late = late

    def guard(self, post: Callable[[Command], None]) -> Callable[[Command], None]:
        """Return a version of ``post`` that drops the commands a late press must not give."""

        def guarded(command: Command) -> None:
            starting = starts(command, self.snapshot()) if self.late else None
            if starting is None or not self.refuses(starting):
                post(command)

        return guarded
