"""Standstill between path sections: execution of M functions and dwells, and the resulting waits.

Each wait has a text for the screen, an end condition, and a time limit. If the limit is exceeded, an alarm
is raised.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto

from core.alarms import AlarmCode
from core.executor import start_conditions
from core.executor.job import ReadAheadQueue
from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import AlarmError
from core.executor.spindle_control import SpindleRequest
from core.interpreter.shared.actions import (
    ColletSwitch,
    CoolantSwitch,
    CycleRepeatCancel,
    Dwell,
    InputWait,
    OutputSwitch,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind, needs_spindle_at_speed
from core.message import Message

# --- waits and actions ----------------------------------------------------------------------------------


_IN_POSITION_TIMEOUT_S = 1.0  # s that an axis may take to get in position
_COLLET_TIMEOUT_S = 2.0  # s beyond the closing or opening time
_CHANGEOVER_TIMEOUT_S = 25.0  # s for the change to C-axis mode, including the search for the index
_ORIENTATION_TURNS = 3.0  # revolutions at orienting speed: to the index, to the angle, and one in reserve


@dataclass(slots=True)
class StandstillWait:
    """A wait for a condition, such as the spindle at speed.

    The label is empty for short waits. Time in feed hold does not count toward the time limit.
    """

    make_label: Callable[[], str]
    is_condition_met: Callable[[float], bool]
    start_time_s: float
    timeout_s: float = float("inf")
    timeout_alarm_code: AlarmCode = "internal"

    def is_over(self, now: float) -> bool:
        """Return whether the wait is over.

        Raises AlarmError if the time limit has passed. Checking the condition can operate the collet or a
        drive, which may raise DriverError or AlarmError.
        """
        if self.is_condition_met(now - self.start_time_s):
            return True
        if now - self.start_time_s > self.timeout_s:
            raise AlarmError(self.timeout_alarm_code)
        return False

    def extend_for_hold(self, hold_duration_s: float) -> None:
        """Extend the wait by the duration of a feed hold, in seconds."""
        self.start_time_s += hold_duration_s


def make_position_wait(context: MachineContext) -> StandstillWait:
    """Return a ``StandstillWait`` that ends when all axes are in position."""
    return StandstillWait(
        lambda: "", lambda _: context.is_in_position(), context.now, _IN_POSITION_TIMEOUT_S, "in-position"
    )


def make_spindle_speed_wait(context: MachineContext, *, is_for_thread: bool = False) -> StandstillWait:
    """Return a ``StandstillWait`` for the spindle to reach its speed.

    Before a thread, the wait also includes the encoder. It has no time limit while the operator prevents
    the spindle from turning.
    """
    spindle = context.spindle
    wait = StandstillWait(
        lambda: spindle.spindle_stopped_reason or "AT SPEED",
        lambda _: spindle.is_at_speed(context.now),
        context.now,
        context.machine.spindle.timeout_s,
        "at-speed",
    )

    def is_spindle_ready(_: float) -> bool:
        if spindle.spindle_stopped_reason:
            wait.start_time_s = context.now
        read = spindle.angle.can_predict_angle or context.ports.spindle.read_angle() is None
        turns = spindle.is_at_speed(context.now)
        wait.timeout_alarm_code = "late" if turns else "at-speed"  # the encoder is not read often enough
        return turns and (read or not is_for_thread)

    wait.is_condition_met = is_spindle_ready
    return wait


def execute_block_action(block: Block, context: MachineContext) -> StandstillWait | None:
    """Execute the action of a block; return the wait that it requires, or None if it requires none.

    The cycle itself handles stops and the end of the program. Offsets, shifts and presets are already
    included in the blocks. Raises AlarmError or DriverError if the action fails.
    """
    match block.action:
        case SpindleRun():
            _start_spindle(block, context)
        case SpindleStop() | SpindleLock() | SpindlePositioning() as stopping:
            return _stop_spindle(stopping, context)
        case CoolantSwitch(on=on):
            context.ports.io.write("coolant", on)
        case OutputSwitch(name=name, on=on):
            context.ports.io.write(name, on)
        case ColletSwitch(closed=closed):
            return _move_collet(closed, context)
        case CycleRepeatCancel():
            context.switches.cycle_repeat = False
            context.log_text("switch", "Cycle Repeat switched off by M31")
        case Dwell(seconds=seconds):
            return StandstillWait(lambda: "DWELL", lambda passed: passed >= seconds - 1e-9, context.now)
        case InputWait(terminal=terminal, closed=closed):
            return StandstillWait(
                lambda: terminal, lambda _: context.is_input_on(terminal) == closed, context.now
            )
        case _:
            pass
    return None


def _stop_spindle(
    action: SpindleStop | SpindleLock | SpindlePositioning, context: MachineContext
) -> StandstillWait | None:
    """Stop or orient the spindle, or switch it to C-axis mode."""
    match action:
        case SpindleLock(orient=orient):
            return _lock_spindle(context, orient=orient)
        case SpindlePositioning(angle=angle, sense=sense):
            return _orient_spindle(context, angle, sense)
        case SpindleStop(waits_for_standstill=waits_for_standstill):
            context.spindle.stop()
            return _make_spindle_stop_wait(context) if waits_for_standstill else None


def _start_spindle(block: Block, context: MachineContext) -> None:
    if start_conditions.find_collet_inhibit_reason(context):
        raise AlarmError("collet-open", line=block.line)
    context.spindle.request_speed(SpindleRequest.from_block(block))


def _make_spindle_stop_wait(context: MachineContext) -> StandstillWait:
    """Return a ``StandstillWait`` that ends when the spindle is stopped.

    A tool or the operator must approach the spindle only when it is stopped.
    """
    spindle, limit = context.spindle, context.machine.spindle.timeout_s
    return StandstillWait(
        lambda: "SPINDLE STOP", lambda _: spindle.is_stopped, context.now, limit, "ignores-stop"
    )


def _lock_spindle(context: MachineContext, *, orient: bool) -> StandstillWait:
    """Return a ``StandstillWait`` that ends when the spindle is stopped and engaged as the C axis.

    If the spindle is already engaged, it is not stopped again.
    """
    spindle, change = context.spindle, 0.0
    if context.ports.lock is None or not spindle.is_c_axis_ready:
        spindle.stop()
        change = 0.0 if context.ports.lock is None else _CHANGEOVER_TIMEOUT_S
    limit = context.machine.spindle.timeout_s + change
    return StandstillWait(
        lambda: "C AXIS" if spindle.is_stopped else "SPINDLE STOP",
        lambda _: spindle.is_stopped and spindle.engage_c_axis(should_orient=orient),
        context.now,
        limit,
        "ignores-stop",
    )


def _orient_spindle(context: MachineContext, angle: float, direction: int) -> StandstillWait:
    """Return a ``StandstillWait`` that ends when the drive holds the stopped spindle at ``angle``."""
    spindle, model = context.spindle, context.machine.spindle
    if spindle.orientation.angle_deg != angle and start_conditions.find_collet_inhibit_reason(context):
        raise AlarmError(
            "collet-open",
            Message(
                "SPOS or M19 cannot turn the spindle to {angle} degrees while the collet is open",
                angle=f"{angle:g}",
            ),
        )
    if spindle.is_requested or not spindle.is_stopped:
        spindle.stop()

    def make_wait_label() -> str:
        return spindle.start_inhibit_reason or (
            "SPINDLE ORIENT" if spindle.is_stopped_or_orienting else "SPINDLE STOP"
        )

    def is_spindle_oriented(_: float) -> bool:
        if spindle.start_inhibit_reason:
            wait.start_time_s = context.now
        wait.timeout_alarm_code = "spindle-orient" if spindle.is_stopped_or_orienting else "ignores-stop"
        return spindle.is_stopped_or_orienting and spindle.orient_spindle(angle, direction)

    wait = StandstillWait(
        make_wait_label,
        is_spindle_oriented,
        context.now,
        model.timeout_s + _ORIENTATION_TURNS * 60.0 / model.orient_rpm,
        "spindle-orient",
    )
    return wait


def _move_collet(closed: bool, context: MachineContext) -> StandstillWait:
    """Open or close the collet and return the ``StandstillWait`` for its motion.

    If the machine file forbids opening the collet while the spindle turns, opening waits until the spindle
    has stopped.
    """
    waits = not closed and not context.machine.interlocks.unclamp_while_turning
    if waits and context.spindle.is_requested:
        raise AlarmError(
            "unclamp",
            Message("the spindle turns at {measured} rpm", measured=f"{context.spindle.measured_rpm:.0f}"),
        )
    collet = context.machine.collet
    time = collet.close_time_s if closed else collet.open_time_s
    moved_at: list[float] = []

    def has_collet_moved(passed: float) -> bool:
        if not moved_at:
            if waits and not context.spindle.is_stopped:
                return False
            context.ports.io.write("collet", closed)
            moved_at.append(passed)
            return False
        switch = context.inputs.get("collet_closed")
        return passed - moved_at[0] >= time if switch is None else switch == closed

    limit = time + _COLLET_TIMEOUT_S + (context.machine.spindle.timeout_s if waits else 0.0)
    return StandstillWait(
        lambda: "COLLET" if moved_at else "SPINDLE STOP", has_collet_moved, context.now, limit, "collet"
    )


class NextAction(Enum):
    """Action that a cycle at rest performs next."""

    WAIT = auto()  # nothing, because a wait is active
    DETERMINE_AGAIN = auto()  # ask again, because a wait has started or ended
    BLOCK_END = auto()  # =
    MOTION = auto()  # start the pending blocks
    ACTION = auto()  # execute the block that needs the standstill
    END = auto()  # end the cycle, because no blocks remain
    NOTHING = auto()  # nothing in this tick


class StandstillSequencer:
    """Sequencer that determines the next action of a cycle at rest.

    ``has_executed_block`` is True if a block was executed since the last stop. ``in_hole`` returns whether
    a tap is in its hole, in which case single block does not stop.
    """

    def __init__(self, context: MachineContext, feed: ReadAheadQueue, in_hole: Callable[[], bool]) -> None:
        self._context, self._feed, self._in_hole = context, feed, in_hole
        self._wait: StandstillWait | None = None
        self._settled = True  # the axes are in position after the last motion
        self.has_executed_block = False

    @property
    def wait_label(self) -> str | None:
        """Return the screen text of the current wait, or None if the cycle is not waiting.

        The text of a short wait is an empty string.
        """
        return self._wait.make_label() if self._wait is not None else None

    def determine_next_action(self) -> NextAction:
        """Return the next action of the cycle.

        Raises AlarmError if a wait takes too long or a block is invalid. Raises DriverError if a driver
        rejects an action of the wait, such as moving the collet or engaging the C axis.
        """
        feed = self._feed
        if self._wait is not None:
            return self._look(self._wait)
        if not self._settled:
            self._wait = make_position_wait(self._context)
            return NextAction.DETERMINE_AGAIN
        if self.has_executed_block and self._context.switches.single_block and not self._in_hole():
            return NextAction.BLOCK_END
        if feed.pending_blocks:
            self._settled, self.has_executed_block = False, True
            return NextAction.MOTION
        if feed.stop is not None:
            return NextAction.ACTION
        if feed.read_error is not None:
            raise feed.read_error
        return NextAction.END if feed.is_at_end else NextAction.NOTHING

    def execute_action(self, block: Block) -> None:
        """Execute the action of a block, or wait for the spindle speed that the block needs.

        Raises AlarmError or DriverError if the action fails.
        """
        if block.action is not None:
            self._wait = execute_block_action(block, self._context)
        elif needs_spindle_at_speed(block):
            self._wait = make_spindle_speed_wait(self._context, is_for_thread=block.kind is BlockKind.THREAD)
        if self._wait is None:
            self._waited()

    def wait_for_next_cycle(self, label: str) -> None:
        """Wait until another cycle replaces the current cycle."""
        if self._wait is None:
            self._wait = StandstillWait(lambda: label, lambda _: False, self._context.now)

    def extend_wait_for_hold(self, hold_duration_s: float) -> None:
        """Extend the current wait by the duration of a feed hold, in seconds."""
        if self._wait is not None:
            self._wait.extend_for_hold(hold_duration_s)

    def _look(self, wait: StandstillWait) -> NextAction:
        if not wait.is_over(self._context.now):
            return NextAction.WAIT
        self._wait = None
        self._waited()
        return NextAction.DETERMINE_AGAIN

    def _waited(self) -> None:
        if not self._settled:
            self._settled = True
        elif self._feed.stop is not None:
            self.has_executed_block = self._feed.stop.action is not None
            self._feed.release_stop()
