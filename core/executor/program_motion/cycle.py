"""One cycle: a run of a program, block by block, with single block and feed hold on the path.

A feed hold is requested by the operator, or caused by a lost spindle, an open guard, an output in the wrong
state or an empty setpoint queue. The axes stop on their path, in a thread after its pull-out. Before the axes
resume, the cycle waits for the spindle.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from core.alarms import CATALOGUE, Code
from core.executor.job import ProgramPass, ReadAhead
from core.executor.machine_context import MachineContext
from core.executor.program_motion.controller_motion import ControllerMotion
from core.executor.program_motion.path_section import Progress
from core.executor.program_motion.setpoint_motion import SetpointMotion
from core.executor.program_motion.standstill import Next, Standstill, Wait, at_speed
from core.executor.raised_alarm import AlarmError, code_of_hold
from core.executor.snapshot import State
from core.interpreter.shared.actions import ProgramEnd, ProgramStop, SpindleLock, SpindleOrient, SpindleStop
from core.interpreter.shared.elementary_blocks import Block, Kind, needs_speed
from core.interpreter.shared.modal_state import Modal

PathMotion = SetpointMotion | ControllerMotion
"""What moves the blocks from rest to rest: our own setpoints, or a controller that plans by itself."""

_BLOCKS = 400  # blocks read in one tick at most, so that a long program does not delay key presses
_ACTIONS = 50  # actions executed in one tick at most
_BUFFER = 1.0  # fraction of the look-ahead that is read beyond the planned motion
_BEHIND_TAP = "FEED HOLD BEHIND THE TAP"
_GOING = frozenset({State.RUN, State.WAIT})
# executed whether the spindle turns or not
_SPINDLE_WORDS = (SpindleStop, SpindleLock, SpindleOrient, ProgramEnd)


class FeedHold:
    """Stops and resumes the motion of a cycle. Used on the executor's thread only."""

    def __init__(self, context: MachineContext, motion: PathMotion, still: Standstill) -> None:
        self._context = context
        self._motion = motion
        self._still = still
        self.reason = ""  # text of the alarm catalog; empty if a button was pressed
        self._since = 0.0
        self._spin_up: Wait | None = None  # wait for the spindle before the motion resumes
        self._behind: Block | None = None  # single block resumes after this block
        self._retracting = False  # the tool retracts from a thread that has lost its spindle

    @property
    def within_section(self) -> bool:
        """True if motion resumes within the present path section instead of the next one."""
        return self._motion.active and not self._motion.complete

    @property
    def retracting(self) -> bool:
        """True while the tool retracts from a thread that has lost its spindle."""
        return self._retracting

    @property
    def spins_up(self) -> bool:
        """True while the resume waits for the spindle."""
        return self._spin_up is not None

    @property
    def label(self) -> str:
        """The condition for which the resume waits, as a text, or an empty string."""
        return self._spin_up.label() if self._spin_up is not None else ""

    def begin(self, reason: str = "", by: str = "", code: Code | None = None) -> State:
        """Stop the motion and return the new state of the machine.

        ``reason`` is a text of the alarm catalog, or a detail for ``code``. It is empty if a button was
        pressed; ``by`` then names the button.
        """
        self.reason, self._since = reason, self._context.now
        self._context.show_stop(*(code_of_hold(reason, by) if code is None else (code, reason.lower())))
        if self._motion.moving:
            self._motion.hold()
            return State.HOLDING
        self._motion.let_stop()  # a plan whose queue has run out must not be continued
        return State.HOLD

    def starve(self, code: Code, detail: str) -> None:
        """Store and show that the queue was not refilled in time, so that the axes stop."""
        self.reason, self._since = CATALOGUE[code].text.upper(), self._context.now
        self._context.show_stop(code, detail)

    def retract(self, block: Block) -> None:
        """Stop along a thread that has lost its spindle, to retract X afterwards."""
        self._context.log("thread", "spindle speed lost during threading")
        self._motion.retract(block)
        self._retracting = True

    def stopped(self) -> bool:
        """Return whether the axes are at rest. Called every tick while they stop.

        Raises AlarmError("thread-lost") when the tool has left a lost thread.
        """
        self._motion.keep_up()
        if self._motion.moving:
            return False
        if self._retracting:
            self._motion.retracted()
        return not self._retracting

    def go_on(self, behind: Block | None, *, starts_spindle: bool) -> None:
        """Resume after Cycle Start, as soon as a requested spindle is at speed.

        ``behind`` is the last block that single block executed, or None.
        """
        self.reason = ""
        within = self.within_section
        self._still.done = within
        self._still.shift_for_hold(self._context.now - self._since)
        self._behind = behind
        self._spin_up = self._slow_spindle() if within or starts_spindle else None
        self._since = self._context.now
        if within and self._spin_up is None:
            self._motion.go_on(behind)

    def spin_up(self) -> State:
        """Wait for the spindle, once per tick; return the new state of the machine.

        If the spindle does not reach its speed, the result is another hold, so that the program is not lost.
        """
        if self._spin_up is None:
            return State.RUN
        try:
            over = self._spin_up.over(self._context.now)
        except AlarmError:
            self._spin_up = None
            return self.begin("SPINDLE DID NOT RETURN TO SPEED")
        if not over:
            return State.WAIT
        self._spin_up = None
        self._still.shift_for_hold(self._context.now - self._since)
        if self.within_section:
            self._motion.go_on(self._behind)
        return State.RUN

    def _slow_spindle(self) -> Wait | None:
        """Return the wait for a requested spindle that is not at speed, or None."""
        spindle = self._context.spindle
        if not spindle.asked or spindle.at_speed(self._context.now):
            return None
        return at_speed(self._context)


class Cycle:
    """One cycle, advanced by ``step`` in every tick.

    ``enter`` is called at each change of state, and ``ended`` at the end of the program. ``begins`` is the
    modal state before the first block.
    """

    def __init__(
        self,
        context: MachineContext,
        motion: PathMotion,
        source: ProgramPass,
        begins: Modal,
        enter: Callable[[State], None],
        ended: Callable[[ProgramEnd | None], None],
    ) -> None:
        self._context = context
        self._motion = motion
        self._enter = enter
        self._ended = ended
        self._needs_end = source.left is None
        self._feed = ReadAhead(source, context.machine)
        self._state = State.RUN
        self._still = Standstill(context, self._feed, lambda: self._tapping)
        self._hold = FeedHold(context, motion, self._still)
        # a pending hold that starts when the tap has left its hole
        self._later: Callable[[], State] | None = None
        self.message = ""  # message of M00 or M01 during the stop
        self.current: Block | None = None
        self.modal = begins

    @property
    def waiting_for(self) -> str:
        """The condition for which the cycle waits, as a text, or an empty string."""
        if self._state is State.HOLD:
            return self._hold.reason
        if self._later is not None:
            return _BEHIND_TAP
        if self._hold.spins_up:
            return self._hold.label
        if self._still.label is not None:
            return self._still.label
        return "FEED OVERRIDE AT 0" if self._state is State.WAIT else ""

    @property
    def next_block(self) -> Block | None:
        """The block after the one being executed, or None while a standstill is pending."""
        following = self._motion.following or self._feed.next_block
        return None if following is self.current else following

    @property
    def at_rest(self) -> bool:
        """True if no axis moves."""
        return not self._motion.moving

    # --- requests of the operator -------------------------------------------------------------------------

    def hold(
        self, reason: str = "", by: str = "", code: Code | None = None, *, at_once: bool = False
    ) -> None:
        """Hold the cycle. The parameters ``reason``, ``by`` and ``code`` are those of ``FeedHold.begin``.

        A tap first leaves its hole, because the spindle turns on. The axes stop at once if the spindle is
        stopped or ``at_once`` is True.
        """
        if self._state in {State.HOLD, State.HOLDING}:
            self._hold.reason = self._hold.reason or reason
        if self._state not in _GOING:
            return
        begin = partial(self._hold.begin, reason, by, code)
        turns = not (self._context.spindle.lost or self._context.spindle.waits)
        if self._tapping and turns and not at_once:
            self._later = self._later or begin
        else:
            self._later = None
            self._change(begin())

    @property
    def _tapping(self) -> bool:
        """True if a tap is in its hole, which it must leave while the spindle turns."""
        block = self.current
        return block is not None and (block.in_hole or (block.coupled and self._motion.moving))

    def _held_behind_tap(self) -> bool:
        """Start a pending hold when the tap has left its hole; return whether it started."""
        if self._later is None or self._tapping:
            return False
        begin, self._later = self._later, None
        self._change(begin())
        return True

    def starve(self, code: Code = "low-queue", detail: str = "") -> None:
        """Enter feed hold because the queue was not refilled in time. Cycle Start resumes the program."""
        self._motion.let_stop()
        if self._state in _GOING:
            self._hold.starve(code, detail)
            self._change(State.HOLDING)

    def wait_for(self, label: str) -> None:
        """Wait after the end of the program until another cycle replaces this one."""
        self._still.wait_for(label)

    def abandon(self) -> None:
        """Stop the motion of a canceled cycle. The caller waits for ``at_rest``."""
        if self._motion.moving:
            self._motion.brake()
        if self._state in _GOING:
            self._change(State.HOLDING)

    def why_not_on(self) -> str:
        """Return why a stopped cycle cannot resume now, or an empty string."""
        spindle = self._context.spindle
        return spindle.start_barred.lower() if spindle.waits and self._turns_next() else ""

    def go_on(self, *, starts_spindle: bool = False) -> None:
        """Resume after a hold, single block, M00 or M01. If the start turns on the spindle, wait for it."""
        stopped, self._later = self._state, None
        self.message = ""
        if stopped is State.PROGRAM_STOP:
            self._feed.pass_stop()
        self._change(State.RUN)
        behind = self.current if stopped is State.BLOCK_END else None
        self._hold.go_on(behind, starts_spindle=starts_spindle)

    # --- actions in every tick ----------------------------------------------------------------------------

    def catch_up(self) -> None:
        """Show the block at which the axes are, even if no tick has seen it while they moved."""
        self._show_later(self._motion.block)

    def step(self) -> None:
        """Refill the queue, then do the next action. Raises AlarmError, MotionError or DriverError."""
        playing = self._motion.block if self._motion.moving else None
        if playing is not None:
            self._show(playing)
            self._watch_spindle(playing)
        if self._state in _GOING and self._held_behind_tap():
            return
        if self._state is State.HOLDING:
            if self._hold.stopped():
                self.catch_up()
                self._change(State.HOLD)
        elif self._state in _GOING:
            self._read()
            self._advance()

    def _read(self) -> None:
        self._feed.pull(_BLOCKS, _BUFFER * self._context.lateness.lookahead)

    def _advance(self) -> None:
        if self._context.spindle.waits and self._turns_next():
            self.hold(self._context.spindle.waits)
        elif self._hold.spins_up:
            self._change(self._hold.spin_up())
        else:
            self._progress()

    def _turns_next(self) -> bool:
        """Return whether the present or the next block needs a turning spindle."""
        if self._hold.within_section or self._still.label is not None or self._feed.pending:
            return True
        stop = self._feed.stop
        return stop is not None and not isinstance(stop.action, _SPINDLE_WORDS)

    def _progress(self) -> None:
        match self._motion.progress(self._feed):
            case Progress.MOVING:
                self._change(State.RUN)
            case Progress.STILL:
                self._change(State.WAIT)
            case Progress.BLOCK_END:
                self._show_later(self._motion.block)
                self._change(State.BLOCK_END)
            case Progress.HELD:
                self.hold("CONTROLLER IN FEED HOLD", at_once=True)
            case Progress.DONE:
                self._show_later(self._motion.ended_with)
                self._stand()

    def _stand(self) -> None:
        """Wait, act or start the next path section at rest, within the limits of one tick."""
        for _ in range(_ACTIONS):
            match self._still.next():
                case Next.GO_ON:
                    self._change(State.RUN)
                case Next.ACTION if self._feed.stop is not None:
                    if not self._act(self._feed.stop):
                        return
                case done:
                    self._rest(done)
                    return

    def _rest(self, what: Next) -> None:
        """Finish the tick with a wait, a stop, the start of motion or the end of the program."""
        match what:
            case Next.WAIT:
                self._change(State.WAIT if self._still.label else State.RUN)
            case Next.BLOCK_END:
                self._change(State.BLOCK_END)
            case Next.MOTION:
                self._change(State.RUN)
                self._read()
                self._motion.begin(self._feed.take())
            case Next.END if self._needs_end:
                raise AlarmError("no-end")
            case Next.END:
                self._ended(None)
            case _:
                pass

    def _act(self, block: Block) -> bool:
        """Execute the block that needs the standstill; return False if the cycle stops or ends with it."""
        context, action = self._context, block.action
        if action is not None:
            self._show(block)
        if isinstance(action, ProgramEnd):
            self._feed.pass_stop()
            self._ended(action)
            return False
        if isinstance(action, ProgramStop) and (context.switches.optional_stop or not action.optional):
            self.message = action.message
            context.show_stop("optional-stop" if action.optional else "program-stop", action.message)
            self._change(State.PROGRAM_STOP)
            return False
        self._still.carry_out(block)
        return True

    def _watch_spindle(self, block: Block) -> None:
        """Hold a feed per revolution that has lost its spindle; retract from a thread at once."""
        spindle = self._context.spindle
        if not needs_speed(block) or self._hold.retracting or not spindle.lost or not self._motion.moving:
            return
        if block.kind is Kind.THREAD and not self._motion.release():
            self._hold.retract(block)
            self._change(State.HOLDING)
        elif block.kind is Kind.THREAD or (block.per_rev and not block.modal.c_locked) or spindle.fails:
            self.hold(spindle.why_slow or "SPINDLE BELOW HALF COMMANDED SPEED")

    def _show_later(self, block: Block | None) -> None:
        """Show a block at rest, because blocks without motion have been executed too."""
        if block is not None and (self.current is None or block.n > self.current.n):
            self._show(block)

    def _show(self, block: Block) -> None:
        self.current = block
        self.modal = block.modal
        self._context.line = block.line
        if block.moves:
            self._context.spindle.follow(block)

    def _change(self, state: State) -> None:
        if state is not self._state:
            self._state = state
            self._enter(state)
