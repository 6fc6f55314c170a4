"""Filter for late key presses and touches, which must not start certain actions.

A press is late if it was made before the end of a stall of the screen. All other effects of late presses
are executed in order. One key has many meanings, so each press is checked at the point where it would start
an action: when a command is posted, at the simulated station, and when a question is answered.
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


class BlockedLateAction(Enum):
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


def get_starting_action_name(action: BlockedLateAction) -> str:
    """Return the name of a starting action, translated for the operator."""
    names = {
        BlockedLateAction.CYCLE: tr("CYCLE START"),
        BlockedLateAction.DRIVES: tr("DRIVES ON"),
        BlockedLateAction.ACKNOWLEDGE: tr("RESET"),
        BlockedLateAction.JOG: tr("JOG"),
        BlockedLateAction.HANDWHEEL: tr("HANDWHEEL"),
        BlockedLateAction.TOUCH_OFF: tr("TOUCH-OFF"),
        BlockedLateAction.DRIVE_TEST: tr("DRIVE TEST"),
        BlockedLateAction.HOME: tr("HOME"),
        BlockedLateAction.OUTPUT: tr("OUTPUT"),
        BlockedLateAction.INPUT: tr("SIMULATED INPUT"),
        BlockedLateAction.SPINDLE: tr("SPINDLE"),
        BlockedLateAction.OVERRIDE: tr("FEED RATE"),
        BlockedLateAction.RELEASE_ESTOP: tr("E-STOP RELEASE"),
        BlockedLateAction.START_AT_LINE_1: tr("START AT LINE 1"),
        BlockedLateAction.YES: tr("YES"),
        BlockedLateAction.FOLLOWING_KEY: tr("ALL KEYS AFTER YES"),
        BlockedLateAction.TOUCH: tr("TOUCH"),
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


STARTING_COMMANDS: Mapping[type[Command], tuple[BlockedLateAction, StartRule]] = {
    commands.CycleStart: (BlockedLateAction.CYCLE, _always),
    commands.EnableDrives: (BlockedLateAction.DRIVES, _always),
    commands.Reset: (BlockedLateAction.ACKNOWLEDGE, _is_acknowledge),
    commands.Jog: (BlockedLateAction.JOG, _always),
    commands.JogByStep: (BlockedLateAction.JOG, _always),
    commands.SelectHandwheel: (BlockedLateAction.HANDWHEEL, _always),
    commands.TouchOffTool: (BlockedLateAction.TOUCH_OFF, _always),
    commands.RunDriveTest: (BlockedLateAction.DRIVE_TEST, _always),
    commands.HomeAxes: (BlockedLateAction.HOME, _always),
    commands.ForceOutput: (BlockedLateAction.OUTPUT, _is_drive_switch),
    commands.SetFeedOverride: (BlockedLateAction.OVERRIDE, _is_override_increase),
    commands.ConfirmStart: (BlockedLateAction.START_AT_LINE_1, _begins_at_line_1),
}
"""Commands that can start an action, each with the action and the rule that decides whether it starts."""

HARMLESS_COMMANDS: frozenset[type[Command]] = frozenset(
    {
        commands.LoadJob,
        commands.SupplyJobProof,
        commands.ChangeOffsets,
        commands.ReportInterruptedJob,
        commands.FeedHold,
        commands.SetSwitch,
        commands.StopJog,
        commands.RenewDriveTest,
        commands.DeselectHandwheel,
        commands.SetSpindleLimit,
        commands.UseOffsetTables,
        commands.StopSpindle,
        commands.SetPartCount,
        commands.ReplaceStartClearances,
        commands.PreventNextPart,
        commands.PrepareCycleStart,
    }
)
"""All other commands. They start an action only together with a command from STARTING_COMMANDS."""


def find_starting_action(command: Command, snapshot: Snapshot) -> BlockedLateAction | None:
    """Return the action that a command starts, or None if the command does not start an action."""
    found = STARTING_COMMANDS.get(type(command))
    return found[0] if found is not None and found[1](command, snapshot) else None


@dataclass(slots=True)
class LatePressFilter:
    """Filter that drops actions of a late press, and collects their names for one message.

    ``read_time_s`` returns monotonic time in seconds. ``report_dropped_names`` receives the names of all
    dropped actions. ``on_answer_dropped`` is called when the reply to a question is dropped.
    """

    read_snapshot: Callable[[], Snapshot]
    read_time_s: Callable[[], float]
    report_dropped_names: Callable[[tuple[str, ...]], None] = lambda _names: None
    on_answer_dropped: Callable[[], None] = lambda: None
    is_press_late: bool = False  # The press that is being handled is late.
    _dropped: list[BlockedLateAction] = field(default_factory=list)
    _last: float = float("-inf")

    def refuse_late_press(self, action: BlockedLateAction) -> bool:
        """Return whether the current press is too late to start this action. A dropped action is reported."""
        if self.is_press_late:
            self.report_dropped_action(action)
        return self.is_press_late

    def report_dropped_action(self, action: BlockedLateAction) -> None:
        """Report a dropped action together with the actions that were dropped shortly before."""
        now = self.read_time_s()
        if now - self._last > REPORT_INTERVAL_S:
            self._dropped.clear()
        self._last = now
        if action not in self._dropped:
            self._dropped.append(action)
        if action is BlockedLateAction.YES:
            self.on_answer_dropped()
        self.report_dropped_names(tuple(get_starting_action_name(each) for each in self._dropped))

    @contextmanager
    def suspend_check(self) -> Iterator[None]:
        """Return a context in which actions are not attributed to the current key press.

        The window uses this context once per frame while it processes keys that are held down.
        """
        late, self.is_press_late = self.is_press_late, False
        try:
            yield
        finally:
            self.is_press_late = late

    def guard_post_command(self, post_command: Callable[[Command], None]) -> Callable[[Command], None]:
        """Return a version of ``post_command`` that drops the commands that a late press must not send."""

        def post_unless_late(command: Command) -> None:
            starting = find_starting_action(command, self.read_snapshot()) if self.is_press_late else None
            if starting is None or not self.refuse_late_press(starting):
                post_command(command)

        return post_unless_late
