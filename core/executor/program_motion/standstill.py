"""Standstill between path sections: execution of M functions and dwells, and their waits.

Each wait has a text for the screen, an end condition, and a time limit after which it is an alarm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto

from core.alarms import Code
from core.executor import start_conditions
from core.executor.job import ReadAhead
from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import AlarmError
from core.executor.spindle_control import SpindleDemand
from core.interpreter.shared.actions import (
    Collet,
    Coolant,
    Dwell,
    Output,
    RepeatOff,
    SpindleLock,
    SpindleOrient,
    SpindleRun,
    SpindleStop,
    WaitInput,
)
from core.interpreter.shared.elementary_blocks import Block, Kind, needs_speed
from core.message import Message

# --- waits and actions ----------------------------------------------------------------------------------


_IN_POSITION = 1.0  # s that an axis may take to get in position
_COLLET_LATE = 2.0  # s beyond the closing or opening time
_CHANGE_OVER = 25.0  # s for the change to C-axis mode, including the search for the index
_TURNS = 3.0  # revolutions at orienting speed: to the index, to the angle, and one in reserve


@dataclass(slots=True)
class Wait:
    """A wait for a condition. ``label`` is empty for short waits. Time in feed hold does not count."""

    label: Callable[[], str]
    done: Callable[[float], bool]
    since: float
    timeout: float = float("inf")
    alarm: Code = "internal"

    def over(self, now: float) -> bool:
        """Return whether the wait is over. Raises AlarmError if its time limit has passed."""
        if self.done(now - self.since):
            return True
        if now - self.since > self.timeout:
            raise AlarmError(self.alarm)
        return False

    def shift(self, held: float) -> None:
        """Exclude the duration of a feed hold, in seconds, from the wait."""
        self.since += held


def in_position(context: MachineContext) -> Wait:
    """Return a wait until all axes are in position."""
    return Wait(lambda: "", lambda _: context.in_position(), context.now, _IN_POSITION, "in-position")


def at_speed(context: MachineContext, *, thread: bool = False) -> Wait:
    """Return a wait until the spindle is at speed, and for a thread until its encoder can be read.

    The wait has no time limit while the operator prevents the spindle from turning.
    """
    spindle = context.spindle
    wait = Wait(
        lambda: spindle.why_slow or "AT SPEED",
        lambda _: spindle.at_speed(context.now),
        context.now,
        context.machine.spindle.timeout,
        "at-speed",
    )

    def done(_: float) -> bool:
        if spindle.why_slow:
            wait.since = context.now
        read = spindle.angle.known or context.ports.spindle.angle() is None
        turns = spindle.at_speed(context.now)
        wait.alarm = "late" if turns else "at-speed"  # the encoder is not read often enough
        return turns and (read or not thread)

    wait.done = done
    return wait


def carry_out(block: Block, context: MachineContext) -> Wait | None:
    """Execute the action of a block and return its wait, or None. Raises AlarmError or DriverError.

    The cycle handles stops and ends of the program. Offsets, shifts and presets are already in the blocks.
    """
    match block.action:
        case SpindleRun():
            _start_spindle(block, context)
        case SpindleStop() | SpindleLock() | SpindleOrient() as stopping:
            return _stop_spindle(stopping, context)
        case Coolant(on=on):
            context.ports.io.write("coolant", on)
        case Output(name=name, on=on):
            context.ports.io.write(name, on)
        case Collet(closed=closed):
            return _move_collet(closed, context)
        case RepeatOff():
            context.switches.cycle_repeat = False
            context.log("switch", "Cycle Repeat switched off by M31")
        case Dwell(seconds=seconds):
            return Wait(lambda: "DWELL", lambda passed: passed >= seconds - 1e-9, context.now)
        case WaitInput(terminal=terminal, closed=closed):
            return Wait(lambda: terminal, lambda _: context.terminal(terminal) == closed, context.now)
        case _:
            pass
    return None


def _stop_spindle(action: SpindleStop | SpindleLock | SpindleOrient, context: MachineContext) -> Wait | None:
    """Stop the spindle, switch it to C-axis mode, or orient it."""
    match action:
        case SpindleLock(orient=orient):
            return _lock_spindle(context, orient=orient)
        case SpindleOrient(angle=angle, sense=sense):
            return _orient_spindle(context, angle, sense)
        case SpindleStop(stands=stands):
            context.spindle.stop()
            return _until_it_stands(context) if stands else None


def _start_spindle(block: Block, context: MachineContext) -> None:
    if start_conditions.unclamped(context):
        raise AlarmError("collet-open", line=block.line)
    context.spindle.ask(SpindleDemand.of(block))


def _until_it_stands(context: MachineContext) -> Wait:
    """Return a wait until the spindle is stopped, before the tool or the operator approaches."""
    spindle, limit = context.spindle, context.machine.spindle.timeout
    return Wait(lambda: "SPINDLE STOP", lambda _: spindle.stopped, context.now, limit, "ignores-stop")


def _lock_spindle(context: MachineContext, *, orient: bool) -> Wait:
    """Return a wait until the spindle is stopped and engaged as the C axis.

    A spindle that is already engaged is not stopped again.
    """
    spindle, change = context.spindle, 0.0
    if context.ports.lock is None or not spindle.held:
        spindle.stop()
        change = 0.0 if context.ports.lock is None else _CHANGE_OVER
    limit = context.machine.spindle.timeout + change
    return Wait(
        lambda: "C AXIS" if spindle.stopped else "SPINDLE STOP",
        lambda _: spindle.stopped and spindle.hold(orient=orient),
        context.now,
        limit,
        "ignores-stop",
    )


def _orient_spindle(context: MachineContext, angle: float, sense: int) -> Wait:
    """Return a wait until the spindle is stopped and its drive holds it at the angle."""
    spindle, model = context.spindle, context.machine.spindle
    if spindle.orientation.at != angle and start_conditions.unclamped(context):
        raise AlarmError(
            "collet-open",
            Message(
                "SPOS or M19 cannot turn the spindle to {angle} degrees while the collet is open",
                angle=f"{angle:g}",
            ),
        )
    if spindle.asked or not spindle.stopped:
        spindle.stop()

    def label() -> str:
        return spindle.start_barred or ("SPINDLE ORIENT" if spindle.stands_or_orients else "SPINDLE STOP")

    def done(_: float) -> bool:
        if spindle.start_barred:
            wait.since = context.now
        wait.alarm = "spindle-orient" if spindle.stands_or_orients else "ignores-stop"
        return spindle.stands_or_orients and spindle.orient(angle, sense)

    wait = Wait(
        label,
        done,
        context.now,
        model.timeout + _TURNS * 60.0 / model.orient_rpm,
        "spindle-orient",
    )
    return wait


def _move_collet(closed: bool, context: MachineContext) -> Wait:
    """Switch the collet and return its wait.

    If the machine file forbids unclamping at speed, opening waits until the spindle has stopped.
    """
    waits = not closed and not context.machine.interlocks.unclamp_while_turning
    if waits and context.spindle.asked:
        raise AlarmError(
            "unclamp",
            Message("the spindle turns at {measured} rpm", measured=f"{context.spindle.measured:.0f}"),
        )
    collet = context.machine.collet
    time = collet.close_time if closed else collet.open_time
    moved_at: list[float] = []

    def done(passed: float) -> bool:
        if not moved_at:
            if waits and not context.spindle.stopped:
                return False
            context.ports.io.write("collet", closed)
            moved_at.append(passed)
            return False
        switch = context.inputs.get("collet_closed")
        return passed - moved_at[0] >= time if switch is None else switch == closed

    limit = time + _COLLET_LATE + (context.machine.spindle.timeout if waits else 0.0)
    return Wait(lambda: "COLLET" if moved_at else "SPINDLE STOP", done, context.now, limit, "collet")


class Next(Enum):
    """The next action of the cycle at rest."""

    WAIT = auto()  # nothing, because a wait is active
    GO_ON = auto()  # ask again, because a wait has started or ended
    BLOCK_END = auto()  # =
    MOTION = auto()  # start the pending blocks
    ACTION = auto()  # execute the block that needs the standstill
    END = auto()  # end the cycle, because no blocks remain
    NOTHING = auto()  # nothing in this tick


class Standstill:
    """Determines the next action at rest. ``done`` is True if a block was executed since the last stop.

    ``in_hole`` returns whether a tap is in its hole, where single block does not stop.
    """

    def __init__(self, context: MachineContext, feed: ReadAhead, in_hole: Callable[[], bool]) -> None:
        self._context, self._feed, self._in_hole = context, feed, in_hole
        self._wait: Wait | None = None
        self._settled = True  # the axes are in position after the last motion
        self.done = False

    @property
    def label(self) -> str | None:
        """The text of the present wait, empty for a short wait, or None without a wait."""
        return self._wait.label() if self._wait is not None else None

    def next(self) -> Next:
        """Return the next single action of the cycle.

        Raises AlarmError if a wait takes too long or a block is invalid.
        """
        feed = self._feed
        if self._wait is not None:
            return self._look(self._wait)
        if not self._settled:
            self._wait = in_position(self._context)
            return Next.GO_ON
        if self.done and self._context.switches.single_block and not self._in_hole():
            return Next.BLOCK_END
        if feed.pending:
            self._settled, self.done = False, True
            return Next.MOTION
        if feed.stop is not None:
            return Next.ACTION
        if feed.trouble is not None:
            raise feed.trouble
        return Next.END if feed.ended else Next.NOTHING

    def carry_out(self, block: Block) -> None:
        """Execute an action, or wait for the speed that a block needs. Raises AlarmError or DriverError."""
        if block.action is not None:
            self._wait = carry_out(block, self._context)
        elif needs_speed(block):
            self._wait = at_speed(self._context, thread=block.kind is Kind.THREAD)
        if self._wait is None:
            self._waited()

    def wait_for(self, label: str) -> None:
        """Wait until another cycle replaces this one."""
        if self._wait is None:
            self._wait = Wait(lambda: label, lambda _: False, self._context.now)

    def shift_for_hold(self, seconds: float) -> None:
        """Exclude the duration of a feed hold, in seconds, from the present wait."""
        if self._wait is not None:
            self._wait.shift(seconds)

    def _look(self, wait: Wait) -> Next:
        if not wait.over(self._context.now):
            return Next.WAIT
        self._wait = None
        self._waited()
        return Next.GO_ON

    def _waited(self) -> None:
        if not self._settled:
            self._settled = True
        elif self._feed.stop is not None:
            self.done = self._feed.stop.action is not None
            self._feed.pass_stop()
