"""Standstill between path sections: M functions and dwell carried out, and what is waited for.

Each wait has words for the screen, an end, and a time limit behind which it is an alarm.
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


_IN_POSITION = 1.0  # s for a slide that is at rest to arrive
_COLLET_LATE = 2.0  # s beyond its time
_CHANGE_OVER = 25.0  # s in which a spindle's drive has become C, its index found
_TURNS = 3.0  # at the speed of orienting: to its index, to the angle, and one to spare


@dataclass(slots=True)
class Wait:
    """One wait. ``label`` is empty for waits that are too short to show; time held does not count."""

    label: Callable[[], str]
    done: Callable[[float], bool]
    since: float
    timeout: float = float("inf")
    alarm: Code = "internal"

    def over(self, now: float) -> bool:
        """Whether it is over; raises AlarmError when it took too long."""
        if self.done(now - self.since):
            return True
        if now - self.since > self.timeout:
            raise AlarmError(self.alarm)
        return False

    def shift(self, held: float) -> None:
        """Feed hold has lasted so long, s: it does not count."""
        self.since += held


def in_position(context: MachineContext) -> Wait:
    """Until the slides are where they were sent."""
    return Wait(lambda: "", lambda _: context.in_position(), context.now, _IN_POSITION, "in-position")


def at_speed(context: MachineContext, *, thread: bool = False) -> Wait:
    """Until the spindle turns as commanded, and for a thread until its encoder is read again after a stall.

    While the operator keeps it still there is no time limit.
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
        wait.alarm = "late" if turns else "at-speed"  # its encoder is not read often enough
        return turns and (read or not thread)

    wait.done = done
    return wait


def carry_out(block: Block, context: MachineContext) -> Wait | None:
    """Do what an action block says; returns what has to be waited for. Raises AlarmError, DriverError.

    Stops and ends of the program are the cycle's own business and do nothing here; offsets, shifts and
    presets are in the blocks already.
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
    """To rest, to an axis, or to an angle."""
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
    """An edge is not freed, and no hand goes near it, before."""
    spindle, limit = context.spindle, context.machine.spindle.timeout
    return Wait(lambda: "SPINDLE STOP", lambda _: spindle.stopped, context.now, limit, "ignores-stop")


def _lock_spindle(context: MachineContext, *, orient: bool) -> Wait:
    """C may move once the spindle stands and its drive positions; held already it is only kept."""
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
    """The drive brings it to its angle once it stands; nothing goes on before it is held there."""
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
    """Where the machine file forbids unclamping at speed, opening waits until the spindle has run down."""
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
    """What the cycle has to do now."""

    WAIT = auto()  # nothing: something is waited for
    GO_ON = auto()  # ask again: a wait is over, or has been begun
    BLOCK_END = auto()  # stop for single block
    MOTION = auto()  # begin the blocks that are pending
    ACTION = auto()  # carry out the block that needed the standstill
    END = auto()  # nothing comes any more
    NOTHING = auto()  # not in this tick


class Standstill:
    """What comes next while all is at rest. ``done``: a block was executed since the last stop.

    ``in_hole`` tells whether a tap is in its hole, where single block does not stop.
    """

    def __init__(self, context: MachineContext, feed: ReadAhead, in_hole: Callable[[], bool]) -> None:
        self._context, self._feed, self._in_hole = context, feed, in_hole
        self._wait: Wait | None = None
        self._settled = True  # in position since the last motion
        self.done = False

    @property
    def label(self) -> str | None:
        """In words, what is waited for; empty for what is too short to show, None without a wait."""
        return self._wait.label() if self._wait is not None else None

    def next(self) -> Next:
        """What the cycle has to do now, one thing at a time.

        Raises AlarmError for a wait that takes too long and for bad blocks.
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
        """Carry out an action, or wait for the speed that a block needs. Raises AlarmError, DriverError."""
        if block.action is not None:
            self._wait = carry_out(block, self._context)
        elif needs_speed(block):
            self._wait = at_speed(self._context, thread=block.kind is Kind.THREAD)
        if self._wait is None:
            self._waited()

    def wait_for(self, label: str) -> None:
        """Stand until another cycle takes the place of this one."""
        if self._wait is None:
            self._wait = Wait(lambda: label, lambda _: False, self._context.now)

    def shift_for_hold(self, seconds: float) -> None:
        """Feed hold has lasted so long, s: it does not count."""
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
