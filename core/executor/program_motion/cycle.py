"""One cycle: a run of a program, block by block, with single block and feed hold on the path.

A feed hold is requested by the operator, or is caused by a lost spindle, an open guard, an output in the
wrong state or an empty setpoint queue. The axes stop on their path, but in a thread only after its
pull-out. Before the axes resume, the cycle waits for the spindle.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from core.alarms import CATALOG, AlarmCode
from core.executor.job import ProgramPass, ReadAheadQueue
from core.executor.machine_context import MachineContext
from core.executor.program_motion.controller_motion import ControllerMotion
from core.executor.program_motion.path_section import SectionProgress
from core.executor.program_motion.setpoint_motion import SetpointMotion
from core.executor.program_motion.standstill import (
    NextAction,
    StandstillSequencer,
    StandstillWait,
    make_spindle_speed_wait,
)
from core.executor.raised_alarm import AlarmError, find_hold_code
from core.executor.snapshot import MachineState
from core.interpreter.shared.actions import (
    ProgramEnd,
    ProgramStop,
    SpindleLock,
    SpindlePositioning,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind, needs_spindle_at_speed
from core.interpreter.shared.modal_state import ModalState

PathMotion = SetpointMotion | ControllerMotion
"""Source of motion for blocks from rest to rest.

It is either TurnDesk's setpoints or a controller that plans the motion.
"""

_READ_AHEAD_BLOCKS = 400  # blocks read in one tick at most, so that a long program does not delay key presses
_MAX_ACTIONS_PER_TICK = 50  # actions executed in one tick at most
_READ_AHEAD_FRACTION = 1.0  # fraction of the look-ahead that is read beyond the planned motion
_TAP_EXIT_LABEL = "FEED HOLD BEHIND THE TAP"
_MOVING_STATES = frozenset({MachineState.RUN, MachineState.WAIT})
# executed whether the spindle turns or not
_SPINDLE_WORDS = (SpindleStop, SpindleLock, SpindlePositioning, ProgramEnd)


class HoldController:
    """Control of feed hold and resume in a cycle. It is used on the executor's thread only."""

    def __init__(self, context: MachineContext, motion: PathMotion, standstill: StandstillSequencer) -> None:
        self._context = context
        self._motion = motion
        self._still = standstill
        self.hold_reason = ""  # text of the alarm catalog; empty if a button was pressed
        self._since = 0.0
        self._spin_up: StandstillWait | None = None  # wait for the spindle before the motion resumes
        self._behind: Block | None = None  # single block resumes after this block
        self._retracting = False  # the tool retracts from a thread that has lost its spindle

    @property
    def will_resume_in_section(self) -> bool:
        """Return whether motion will resume within the current path section rather than in the next one."""
        return self._motion.has_path_section and not self._motion.is_complete

    @property
    def is_retracting(self) -> bool:
        """Return whether the tool is retracting from a thread that has lost spindle synchronization."""
        return self._retracting

    @property
    def is_waiting_for_spindle(self) -> bool:
        """Return whether the cycle is waiting for the spindle before it resumes."""
        return self._spin_up is not None

    @property
    def wait_label(self) -> str:
        """Return the screen text for the condition that delays the resume, or an empty string."""
        return self._spin_up.make_label() if self._spin_up is not None else ""

    def stop_motion(self, reason: str = "", source: str = "", code: AlarmCode | None = None) -> MachineState:
        """Stop the motion and return the new state of the machine.

        ``reason`` is a text of the alarm catalog, or a detail of the alarm ``code``. If a button was
        pressed, ``reason`` is empty and ``source`` names the button.
        """
        self.hold_reason, self._since = reason, self._context.now
        self._context.show_stop(*(find_hold_code(reason, source) if code is None else (code, reason.lower())))
        if self._motion.is_moving:
            self._motion.stop_on_path()
            return MachineState.STOPPING
        self._motion.discard_remaining_plan()  # a plan whose queue has run out must not be continued
        return MachineState.HOLD

    def hold_for_underrun(self, code: AlarmCode, detail: str) -> None:
        """Store and show that the axes stop because the queue was not refilled in time."""
        self.hold_reason, self._since = CATALOG[code].text.upper(), self._context.now
        self._context.show_stop(code, detail)

    def start_retract(self, block: Block) -> None:
        """Stop in a thread that has lost spindle synchronization, and prepare the retract of X."""
        self._context.log_text("thread", "spindle speed lost during threading")
        self._motion.start_retract(block)
        self._retracting = True

    def is_at_rest(self) -> bool:
        """Return whether the axes are at rest.

        The function is called every tick while the axes stop. Raises AlarmError("thread-lost") when the
        tool has left a thread that lost synchronization. Raises AlarmError, MotionError or DriverError if
        the queue or the retract fails.
        """
        self._motion.extend_queue()
        if self._motion.is_moving:
            return False
        if self._retracting:
            self._motion.continue_retract()
        return not self._retracting

    def resume(self, last_executed_block: Block | None, *, starts_spindle: bool) -> None:
        """Resume after Cycle Start, but first wait until the spindle is at speed if it should turn.

        Between two path sections, this wait is omitted if ``starts_spindle`` is False. In single block,
        ``last_executed_block`` is the block after which the motion resumes. Otherwise it is None.
        """
        self.hold_reason = ""
        within = self.will_resume_in_section
        self._still.has_executed_block = within
        self._still.extend_wait_for_hold(self._context.now - self._since)
        self._behind = last_executed_block
        self._spin_up = self._make_spindle_wait() if within or starts_spindle else None
        self._since = self._context.now
        if within and self._spin_up is None:
            self._motion.resume(last_executed_block)

    def wait_for_spindle(self) -> MachineState:
        """Check once per tick whether the spindle is at speed; return the new state of the machine.

        If the spindle does not reach its speed, the cycle enters feed hold again, so that the program is
        not lost.
        """
        if self._spin_up is None:
            return MachineState.RUN
        try:
            over = self._spin_up.is_over(self._context.now)
        except AlarmError:
            self._spin_up = None
            return self.stop_motion("SPINDLE DID NOT RETURN TO SPEED")
        if not over:
            return MachineState.WAIT
        self._spin_up = None
        self._still.extend_wait_for_hold(self._context.now - self._since)
        if self.will_resume_in_section:
            self._motion.resume(self._behind)
        return MachineState.RUN

    def _make_spindle_wait(self) -> StandstillWait | None:
        """Return a ``StandstillWait`` for a requested spindle that is not at speed, otherwise None."""
        spindle = self._context.spindle
        if not spindle.is_requested or spindle.is_at_speed(self._context.now):
            return None
        return make_spindle_speed_wait(self._context)


class Cycle:
    """One cycle of a program, advanced by ``advance_one_tick`` in every tick.

    ``change_state`` is called at each change of state, and ``handle_end`` at the end of the program.
    ``initial_modal`` is the modal state before the first block.
    """

    def __init__(
        self,
        context: MachineContext,
        motion: PathMotion,
        source: ProgramPass,
        initial_modal: ModalState,
        change_state: Callable[[MachineState], None],
        handle_end: Callable[[ProgramEnd | None], None],
    ) -> None:
        self._context = context
        self._motion = motion
        self._enter = change_state
        self._ended = handle_end
        self._needs_end = source.make_checkpoint is None
        self._feed = ReadAheadQueue(source, context.machine)
        self._state = MachineState.RUN
        self._still = StandstillSequencer(context, self._feed, lambda: self._is_tapping)
        self._hold = HoldController(context, motion, self._still)
        # a pending hold that starts when the tap has left its hole
        self._later: Callable[[], MachineState] | None = None
        self.message = ""  # message of M00 or M01 during the stop
        self.current_block: Block | None = None
        self.modal = initial_modal

    @property
    def wait_label(self) -> str:
        """Return the screen text for the condition that the cycle waits for, or an empty string."""
        if self._state is MachineState.HOLD:
            return self._hold.hold_reason
        if self._later is not None:
            return _TAP_EXIT_LABEL
        if self._hold.is_waiting_for_spindle:
            return self._hold.wait_label
        if self._still.wait_label is not None:
            return self._still.wait_label
        return "FEED OVERRIDE AT 0" if self._state is MachineState.WAIT else ""

    @property
    def next_block(self) -> Block | None:
        """Return the block after the one being executed, or None while a standstill is pending."""
        following = self._motion.following_block or self._feed.next_block
        return None if following is self.current_block else following

    @property
    def is_at_rest(self) -> bool:
        """Return whether no axis moves."""
        return not self._motion.is_moving

    # --- requests of the operator -------------------------------------------------------------------------

    def start_feed_hold(
        self,
        reason: str = "",
        source: str = "",
        code: AlarmCode | None = None,
        *,
        stops_at_once: bool = False,
    ) -> None:
        """Start a feed hold.

        The parameters ``reason``, ``source`` and ``code`` are described in ``HoldController.stop_motion``.
        In a tapping cycle, the tap first leaves its hole with the spindle turning. The axes stop at once if
        the spindle is stopped or ``stops_at_once`` is True.
        """
        if self._state in {MachineState.HOLD, MachineState.STOPPING}:
            self._hold.hold_reason = self._hold.hold_reason or reason
        if self._state not in _MOVING_STATES:
            return
        begin = partial(self._hold.stop_motion, reason, source, code)
        turns = not (self._context.spindle.is_speed_lost or self._context.spindle.waiting_reason)
        if self._is_tapping and turns and not stops_at_once:
            self._later = self._later or begin
        else:
            self._later = None
            self._change(begin())

    @property
    def _is_tapping(self) -> bool:
        """Return whether a tap is in its hole. It can leave the hole only while the spindle turns."""
        block = self.current_block
        return block is not None and (block.in_hole or (block.follows_spindle and self._motion.is_moving))

    def _start_pending_hold(self) -> bool:
        """Start a pending feed hold once the tap has left its hole; return whether it has started."""
        if self._later is None or self._is_tapping:
            return False
        begin, self._later = self._later, None
        self._change(begin())
        return True

    def hold_for_underrun(self, code: AlarmCode = "low-queue", detail: str = "") -> None:
        """Enter feed hold because the queue was not refilled in time. Cycle Start resumes the program."""
        self._motion.discard_remaining_plan()
        if self._state in _MOVING_STATES:
            self._hold.hold_for_underrun(code, detail)
            self._change(MachineState.STOPPING)

    def wait_for_next_cycle(self, label: str) -> None:
        """Show ``label`` and wait, after the end of the program, until the next cycle replaces this one."""
        self._still.wait_for_next_cycle(label)

    def stop_canceled_cycle(self) -> None:
        """Stop the motion of a canceled cycle. The caller waits for ``is_at_rest``."""
        if self._motion.is_moving:
            self._motion.stop_immediately()
        if self._state in _MOVING_STATES:
            self._change(MachineState.STOPPING)

    def find_resume_refusal_reason(self) -> str:
        """Return why a stopped cycle cannot resume now, or an empty string if it can."""
        spindle = self._context.spindle
        return (
            spindle.start_inhibit_reason.lower() if spindle.waiting_reason and self._needs_spindle() else ""
        )

    def resume(self, *, starts_spindle: bool = False) -> None:
        """Resume after a feed hold, single block, M00 or M01.

        If Cycle Start turns the spindle on, the cycle first waits until the spindle is at speed.
        """
        stopped, self._later = self._state, None
        self.message = ""
        if stopped is MachineState.PROGRAM_STOP:
            self._feed.release_stop()
        self._change(MachineState.RUN)
        finished_block = self.current_block if stopped is MachineState.SINGLE_BLOCK_STOP else None
        self._hold.resume(finished_block, starts_spindle=starts_spindle)

    # --- actions in every tick ----------------------------------------------------------------------------

    def update_current_block(self) -> None:
        """Show the block at the current position, even if axes passed other blocks between two ticks."""
        self._show_block_at_rest(self._motion.current_block)

    def advance_one_tick(self) -> None:
        """Refill the queue and advance the cycle by one tick.

        Raises AlarmError, MotionError or DriverError on failure.
        """
        playing = self._motion.current_block if self._motion.is_moving else None
        if playing is not None:
            self._show(playing)
            self._check_spindle(playing)
        if self._state in _MOVING_STATES and self._start_pending_hold():
            return
        if self._state is MachineState.STOPPING:
            if self._hold.is_at_rest():
                self.update_current_block()
                self._change(MachineState.HOLD)
        elif self._state in _MOVING_STATES:
            self._read()
            self._advance()

    def _read(self) -> None:
        self._feed.read_blocks(
            _READ_AHEAD_BLOCKS, _READ_AHEAD_FRACTION * self._context.tick_lateness.lookahead_s
        )

    def _advance(self) -> None:
        if self._context.spindle.waiting_reason and self._needs_spindle():
            self.start_feed_hold(self._context.spindle.waiting_reason)
        elif self._hold.is_waiting_for_spindle:
            self._change(self._hold.wait_for_spindle())
        else:
            self._progress()

    def _needs_spindle(self) -> bool:
        """Return whether the current or the next block needs a turning spindle."""
        if (
            self._hold.will_resume_in_section
            or self._still.wait_label is not None
            or self._feed.pending_blocks
        ):
            return True
        stop = self._feed.stop
        return stop is not None and not isinstance(stop.action, _SPINDLE_WORDS)

    def _progress(self) -> None:
        match self._motion.update_progress(self._feed):
            case SectionProgress.MOVING:
                self._change(MachineState.RUN)
            case SectionProgress.AT_REST:
                self._change(MachineState.WAIT)
            case SectionProgress.BLOCK_END:
                self._show_block_at_rest(self._motion.current_block)
                self._change(MachineState.SINGLE_BLOCK_STOP)
            case SectionProgress.IN_FEED_HOLD:
                self.start_feed_hold("CONTROLLER IN FEED HOLD", stops_at_once=True)
            case SectionProgress.DONE:
                self._show_block_at_rest(self._motion.last_block)
                self._advance_at_rest()

    def _advance_at_rest(self) -> None:
        """Wait, perform an action or start the next path section from rest.

        The number of actions per tick is limited.
        """
        for _ in range(_MAX_ACTIONS_PER_TICK):
            match self._still.determine_next_action():
                case NextAction.DETERMINE_AGAIN:
                    self._change(MachineState.RUN)
                case NextAction.ACTION if self._feed.stop is not None:
                    if not self._execute_block(self._feed.stop):
                        return
                case done:
                    self._finish_tick(done)
                    return

    def _finish_tick(self, next_action: NextAction) -> None:
        """Finish the tick: start a wait, a stop or a motion, or end the program."""
        match next_action:
            case NextAction.WAIT:
                self._change(MachineState.WAIT if self._still.wait_label else MachineState.RUN)
            case NextAction.BLOCK_END:
                self._change(MachineState.SINGLE_BLOCK_STOP)
            case NextAction.MOTION:
                self._change(MachineState.RUN)
                self._read()
                self._motion.start_path_section(self._feed.pop_pending_blocks())
            case NextAction.END if self._needs_end:
                raise AlarmError("no-end")
            case NextAction.END:
                self._ended(None)
            case _:
                pass

    def _execute_block(self, block: Block) -> bool:
        """Execute the block that needs the standstill; return whether the cycle continues after it."""
        context, action = self._context, block.action
        if action is not None:
            self._show(block)
        if isinstance(action, ProgramEnd):
            self._feed.release_stop()
            self._ended(action)
            return False
        if isinstance(action, ProgramStop) and (context.switches.optional_stop or not action.optional):
            self.message = action.message
            context.show_stop("optional-stop" if action.optional else "program-stop", action.message)
            self._change(MachineState.PROGRAM_STOP)
            return False
        self._still.execute_action(block)
        return True

    def _check_spindle(self, block: Block) -> None:
        """Check the spindle in a block that moves at feed rate.

        If the spindle loses its speed, the reaction depends on the block:

        - Thread pass that has started: it is retracted immediately.
        - Thread pass that is still waiting: the cycle is put in feed hold.
        - Block with feed per revolution while C is not locked: the cycle is put in feed hold.
        - Other block: the cycle is put in feed hold only if the spindle is requested.
        """
        spindle = self._context.spindle
        if (
            not needs_spindle_at_speed(block)
            or self._hold.is_retracting
            or not spindle.is_speed_lost
            or not self._motion.is_moving
        ):
            return
        if block.kind is BlockKind.THREAD and not self._motion.cancel_waiting_thread_pass():
            self._hold.start_retract(block)
            self._change(MachineState.STOPPING)
        elif (
            block.kind is BlockKind.THREAD
            or (block.per_rev and not block.modal.c_locked)
            or spindle.is_too_slow
        ):
            self.start_feed_hold(spindle.spindle_stopped_reason or "SPINDLE BELOW HALF COMMANDED SPEED")

    def _show_block_at_rest(self, block: Block | None) -> None:
        """Show the block at which the axes are at rest, which may be an executed block without motion."""
        if block is not None and (self.current_block is None or block.n > self.current_block.n):
            self._show(block)

    def _show(self, block: Block) -> None:
        self.current_block = block
        self.modal = block.modal
        self._context.line_number = block.line
        if block.moves:
            self._context.spindle.adopt_block_speed(block)

    def _change(self, state: MachineState) -> None:
        if state is not self._state:
            self._state = state
            self._enter(state)
