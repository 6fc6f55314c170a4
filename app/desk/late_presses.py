"""Actions that a late key press or touch must not start.

A press is late if it was made before the end of a stall of the screen. All other effects of late presses
are executed in order. One key has many meanings, so each press is checked at the point where it would start
an action. These points are the posting of a command, the simulated station, and the reply to a question.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum, auto

from app.desk.translation import tr
from core.executor import commands
from core.executor.commands import Command
from core.executor.snapshot import MachineState, Snapshot

REPORT_INTERVAL_S = 4.0  # Seconds after the last dropped press. A press dropped later gets a new message.


class StartingAction(Enum):
    """Action that a late press must not start, such as a motion, the drives or an output."""

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
    RELEASE_ESTOP = auto()
    START_AT_LINE_1 = auto()
    YES = auto()
    FOLLOWING_KEY = auto()  # Any key after a dropped answer.
    TOUCH = auto()  # A touch on a screen that has changed since.


def name_starting_action(action: StartingAction) -> str:
    """Return the name of a starting action, translated for the operator."""
    names = {
        StartingAction.CYCLE: tr("CYCLE START"),
        StartingAction.DRIVES: tr("DRIVES ON"),
        StartingAction.ACKNOWLEDGE: tr("RESET"),
        StartingAction.JOG: tr("JOG"),
        StartingAction.HANDWHEEL: tr("HANDWHEEL"),
        StartingAction.TOUCH_OFF: tr("TOUCH-OFF"),
        StartingAction.DRIVE_TEST: tr("DRIVE TEST"),
        StartingAction.HOME: tr("HOME"),
        StartingAction.OUTPUT: tr("OUTPUT"),
        StartingAction.INPUT: tr("SIMULATED INPUT"),
        StartingAction.SPINDLE: tr("SPINDLE"),
        StartingAction.OVERRIDE: tr("FEED RATE"),
        StartingAction.RELEASE_ESTOP: tr("E-STOP RELEASE"),
        StartingAction.START_AT_LINE_1: tr("START AT LINE 1"),
        StartingAction.YES: tr("YES"),
        StartingAction.FOLLOWING_KEY: tr("ALL KEYS AFTER YES"),
        StartingAction.TOUCH: tr("TOUCH"),
    }
    return names[action]


StartRule = Callable[[Command, Snapshot], bool]


def _always(_command: Command, _now: Snapshot) -> bool:
    return True


def _is_acknowledge(_command: Command, now: Snapshot) -> bool:
    """Return whether a reset would acknowledge an alarm that the operator may not have seen yet.

    A reset in any other state stops the program.
    """
    return now.state is MachineState.FAULT


def _begins_at_line_1(command: Command, _now: Snapshot) -> bool:
    return isinstance(command, commands.ConfirmStart) and bool(command.at)


def _is_drive_switch(command: Command, _now: Snapshot) -> bool:
    """Return whether a forced output can start a motion or a device.

    Switching the coolant off, for example, cannot start one.
    """
    return isinstance(command, commands.ForceOutput) and (command.on or command.name != "coolant")


def _is_override_increase(command: Command, now: Snapshot) -> bool:
    """Return whether a command raises the feed override.

    While the screen is stalled, an operator sees no effect and therefore may press the key too often.
    """
    return isinstance(command, commands.SetFeedOverride) and command.fraction > now.feed_override


STARTING_COMMANDS: Mapping[type[Command], tuple[StartingAction, StartRule]] = {
    commands.CycleStart: (StartingAction.CYCLE, _always),
    commands.EnableDrives: (StartingAction.DRIVES, _always),
    commands.Reset: (StartingAction.ACKNOWLEDGE, _is_acknowledge),
    commands.Jog: (StartingAction.JOG, _always),
    commands.JogByStep: (StartingAction.JOG, _always),
    commands.SelectHandwheel: (StartingAction.HANDWHEEL, _always),
    commands.TouchOffTool: (StartingAction.TOUCH_OFF, _always),
    commands.RunDriveTest: (StartingAction.DRIVE_TEST, _always),
    commands.HomeAxes: (StartingAction.HOME, _always),
    commands.ForceOutput: (StartingAction.OUTPUT, _is_drive_switch),
    commands.SetFeedOverride: (StartingAction.OVERRIDE, _is_override_increase),
    commands.ConfirmStart: (StartingAction.START_AT_LINE_1, _begins_at_line_1),
}
"""Commands that can start an action, each with the action and the rule that decides whether it starts."""

HARMLESS_COMMANDS: frozenset[type[Command]] = frozenset(
    {
        commands.LoadJob,
        commands.SupplyProof,
        commands.ChangeOffsets,
        commands.ReportInterruptedJob,
        commands.FeedHold,
        commands.SetSwitch,
        commands.StopJog,
        commands.RenewDriveTest,
        commands.DeselectHandwheel,
        commands.SetSpindleLimit,
        commands.UseOffsets,
        commands.StopSpindle,
        commands.SetPartCount,
        commands.ReplaceClearances,
        commands.BlockNextPart,
        commands.PrepareStart,
    }
)
"""All other commands. They start an action only together with a command from STARTING_COMMANDS."""


def find_starting_action(command: Command, snapshot: Snapshot) -> StartingAction | None:
    """Return the action that a command starts, or None if the command does not start an action."""
    found = STARTING_COMMANDS.get(type(command))
    return found[0] if found is not None and found[1](command, snapshot) else None


@dataclass(slots=True)
class LatePressFilter:
    """Filter that drops actions of a late press, and collects their names for one message.

    ``read_time_s`` returns monotonic time in seconds. ``report_names`` receives the names of all dropped
    actions. ``on_answer_dropped`` is called when the reply to a question is dropped.
    """

    read_snapshot: Callable[[], Snapshot]
    read_time_s: Callable[[], float]
    report_names: Callable[[tuple[str, ...]], None] = lambda _names: None
    on_answer_dropped: Callable[[], None] = lambda: None
    is_late: bool = False  # The press that is being handled is late.
    _dropped: list[StartingAction] = field(default_factory=list)
    _last: float = float("-inf")

    def refuse_late_press(self, action: StartingAction) -> bool:
        """Return whether the current press is too late to start this action. A dropped action is reported."""
        if self.is_late:
            self.report_dropped(action)
        return self.is_late

    def report_dropped(self, action: StartingAction) -> None:
        """Report a dropped action together with the actions that were dropped shortly before."""
        now = self.read_time_s()
        if now - self._last > REPORT_INTERVAL_S:
            self._dropped.clear()
        self._last = now
        if action not in self._dropped:
            self._dropped.append(action)
        if action is StartingAction.YES:
            self.on_answer_dropped()
        self.report_names(tuple(name_starting_action(each) for each in self._dropped))

    @contextmanager
    def suspend_check(self) -> Iterator[None]:
        """Return a context in which actions are not attributed to the current press.

        Once per frame, the screen uses this context to renew keys that are held down.
        """
        late, self.is_late = self.is_late, False
        try:
            yield
        finally:
            self.is_late = late

    def guard_post(self, post_command: Callable[[Command], None]) -> Callable[[Command], None]:
        """Return a version of ``post_command`` that drops the commands that a late press must not send."""

        def guarded(command: Command) -> None:
            starting = find_starting_action(command, self.read_snapshot()) if self.is_late else None
            if starting is None or not self.refuse_late_press(starting):
                post_command(command)

        return guarded
