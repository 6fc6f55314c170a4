"""Runs of programs and MDI lines: start, Cycle Repeat, cancellation, and changed offsets.

Changed offsets, such as wear, take effect between two parts. The modal state at the end of a run is stored
for the next run.
"""

from __future__ import annotations

from collections.abc import Callable

from core.executor import start_conditions
from core.executor.commands import START_UNCHECKED, ChangeOffsets
from core.executor.control_status import (
    ControlStatus,
    PartCounter,
    apply_offsets_to_modal_state,
    make_modal_state_after_cancel,
    make_modal_state_after_mdi_cancel,
    sync_modal_state_with_machine,
)
from core.executor.interruption_watch import InterruptionRecorder, StoreFunction
from core.executor.job import Job, ProgramPass, find_outdated_setting, make_start_setup
from core.executor.machine_context import MachineContext
from core.executor.program_motion.controller_motion import ControllerMotion
from core.executor.program_motion.cycle import Cycle, PathMotion
from core.executor.program_motion.setpoint_motion import SetpointMotion
from core.executor.snapshot import MDI_ACTIONS, RESET_REASON, InterruptedJob, MachineState, StartAction
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.language.source import Dialect
from core.message import Message
from core.tool_edges import get_tool_number


class OffsetChangeRequest:
    """A request to continue the running program with changed offsets.

    The part in progress uses its current offsets. The job with the changed offsets must be proved before
    its first move. With Cycle Repeat, the next part waits for this proof. If the proof fails, the program
    is not repeated.
    """

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._asked: ChangeOffsets | None = None

    @property
    def is_requested(self) -> bool:
        """Return whether the next part starts with changed offsets."""
        return self._asked is not None

    @property
    def is_proof_pending(self) -> bool:
        """Return whether the proof of the changed offsets has not arrived yet."""
        return self._asked is not None and self._asked.proof is None and not self._asked.failure_reason

    def store_request(self, command: ChangeOffsets, running_job: Job | None) -> str:
        """Store a request until the end of the part; return why it is refused, or an empty string."""
        job = command.job
        if job is not None and (running_job is None or job.source.text != running_job.source.text):
            return (
                "another program is running; changed offsets apply only to the program for which "
                "they were entered"
            )
        self._asked = command
        return ""

    def find_repeat_refusal_reason(self, present_modal: ModalState) -> str:
        """Return why the program cannot repeat with the changed offsets, or an empty string if it can."""
        asked = self._asked
        if asked is None:
            return ""
        if asked.failure_reason or asked.job is None:
            return asked.failure_reason
        why = start_conditions.find_proof_refusal_reason(
            asked.job, asked.proof
        ) or start_conditions.describe_missing_function(self._context, asked.proof)
        return why or find_outdated_setting(asked.job, present_modal)

    def apply_changes(self, status: ControlStatus) -> None:
        """Load the job with the changed offsets, between two parts or after the program.

        Without a proof, the program cannot start, because its old offsets no longer match the tables.
        """
        asked, self._asked = self._asked, None
        if asked is None:
            return
        status.proof = asked.proof
        if asked.job is not None:
            setup = asked.job.setup
            status.job = asked.job
            status.modal_state = apply_offsets_to_modal_state(
                status.modal_state, setup.tools, setup.secondary
            )
            self._context.log_text("offsets", "the changed offsets are in effect")

    def discard_request(self) -> None:
        """Discard the request because another program is loaded."""
        self._asked = None


class ProgramRun:
    """The running cycle, and the state that persists between two cycles.

    Only the executor's thread uses it.
    """

    def __init__(
        self,
        context: MachineContext,
        start_pass: Callable[[Job, InterpreterSetup], ProgramPass],
        change_state: Callable[[MachineState], None],
        store_interruption: StoreFunction,
        interrupted_job: InterruptedJob | None,
    ) -> None:
        self._context = context
        self._passes = start_pass
        self._enter = change_state
        self.motion = _make_motion(context)
        self.status = ControlStatus()
        self.part_count = PartCounter(context)
        self.counters = self.part_count.counters
        self.interruption_watch = InterruptionRecorder(
            context, self.status, self.part_count, store_interruption, interrupted_job
        )
        self.changed_offsets = OffsetChangeRequest(context)
        self.cycle: Cycle | None = None
        self._source: ProgramPass | None = None
        self._line = False  # the run is an MDI line
        self._dialect = Dialect.OMNITURN  # language of the run
        self._between = False  # a part is finished, and the next one waits for the proof of changed offsets

    def find_start_refusal_reason(self, state: MachineState) -> str:
        """Return why Cycle Start may not start the selected job, or an empty string if it may."""
        why = start_conditions.find_start_refusal_reason(self._context, state, self.status)
        self.status.start_refusal_code = ""
        if why:
            return why
        code, why = start_conditions.find_first_move_refusal(
            self._context, self.status, self.counters.started_run_count
        )
        self.status.start_refusal_code = code
        if code == START_UNCHECKED:
            return self.interruption_watch.start_refusal_reason or why
        return why or self.interruption_watch.start_refusal_reason

    def start_run(self) -> None:
        """Start the selected program, restart or MDI line.

        A prepared restart or MDI line is used only once.
        """
        status, context = self.status, self._context
        job = start_conditions.get_selected_job(status)
        assert job is not None
        self.counters.cycle_time_s = 0.0
        self.counters.started_run_count += 1
        self._line = status.start_action in MDI_ACTIONS
        self.counters.mdi_line_count += self._line
        if status.start_action is StartAction.RESTART:
            status.start_action = StartAction.PROGRAM
        status.prepared_job = status.prepared_proof = None
        if not self._line:
            self.part_count.workpiece.start_run(job, self.interruption_watch.started_block_count)
            self.interruption_watch.record_start(job.setup.begin)
        self._open_pass(job)
        self._enter(MachineState.RUN)
        context.log_text("mdi" if self._line else "start", job.source.text if self._line else job.source.name)
        begin = job.setup.begin
        if begin is not None and not begin.is_mdi_line:
            context.log_text(
                "restart", Message("the program restarts at line {line}", line=begin.line_number)
            )

    @property
    def will_count_part(self) -> bool:
        """Return whether a program is running that will count as a part when it ends."""
        return self.cycle is not None and not (
            self._line or self._between or self.part_count.not_counted_reason
        )

    def exclude_part_from_count(self, reason: str) -> None:
        """Mark the part in progress as disturbed for the given reason, so that it does not count."""
        if not (self._line or self._between):
            self.part_count.workpiece.disturbance = self.part_count.workpiece.disturbance or reason

    def add_cutting_time(self, seconds: float) -> None:
        """Add ``seconds`` to the cutting time of the active tool if the tool moves at feed.

        Dry runs do not count.
        """
        block = self.cycle.current_block if self.cycle is not None and not self.cycle.is_at_rest else None
        if block is not None and block.moves and not block.rapid and not self._context.switches.no_count:
            self.counters.add_cutting_time(
                get_tool_number(block.modal.tool), seconds, self._context.spindle_load
            )

    def finish_canceled_cycle(self) -> bool:
        """Finish a canceled cycle as soon as the axes are at rest; return whether the cycle is finished."""
        if self.cycle is None or not self.cycle.is_at_rest:
            return False
        said = "the MDI line was canceled by reset" if self._line else "program canceled by reset"
        kind = "mdi" if self._line else "end"
        self.cancel_run(RESET_REASON)
        self._enter(MachineState.IDLE)
        self._context.log_text(kind, said)
        return True

    def cancel_run(self, reason: str) -> None:
        """Cancel the run for the given reason.

        After a program, the modal state is the same as after M30. Modes set by an MDI line remain.
        """
        cycle = self.cycle
        if cycle is None:
            self.motion.clear_path_section()
            return
        if not (self._line or self._between):
            self.interruption_watch.record_interruption(cycle.current_block, reason)
        language = self._context.machine.mdi_language
        given_up = make_modal_state_after_cancel(cycle.modal, language)
        self._finish_run(make_modal_state_after_mdi_cancel(cycle.modal) if self._line else given_up)

    def discard_run(self) -> None:
        """Discard the run after a driver failure, without calling the drivers."""
        self.cycle = self._source = None
        self._between = False
        self._context.line_number = 0

    def _finish_run(self, final_modal: ModalState, *, tool_open: bool = False) -> None:
        """End the run, store its final modal state, and apply offsets that were changed during the run."""
        self._store_modal(final_modal, tool_open=tool_open)
        if not self._line:
            self.status.saved_pass = None
        self.cycle = self._source = None
        self._between = False
        self._context.line_number = 0
        self.motion.clear_path_section()
        self.changed_offsets.apply_changes(self.status)

    def _store_modal(self, modal: ModalState, *, tool_open: bool = False) -> None:
        """Store the modal state for the next run.

        Only OmniTurn programs change the stored units and rapid rate.
        """
        before = self.status.modal_state
        if self._dialect is not Dialect.OMNITURN:
            modal = modal._replace(metric=before.metric, rapid_rate=before.rapid_rate)
        self.status.modal_state, self.status.is_tool_move_pending = modal, tool_open

    def update_between_cycles(self) -> None:
        """Update the state after a cycle has ended and before the next one starts.

        With Cycle Repeat, the next part is started if this is permitted.
        """
        self.interruption_watch.record_progress(None if self._line or self._between else self.cycle)
        if self.cycle is None:
            self.status.modal_state = sync_modal_state_with_machine(self.status.modal_state, self._context)
        elif self._between and self.status.state in {MachineState.RUN, MachineState.WAIT}:
            self._repeat_program(self.cycle)

    def _open_pass(self, job: Job) -> None:
        """Start a pass through ``job`` from the current position of the axes."""
        at, _ = self._context.ports.axes.demand_at(self._context.now)
        setup = make_start_setup(job.setup, at, self._context.is_input_on)
        self.motion.clear_path_section()
        diameter = job.source.dialect is Dialect.SINUMERIK
        begins = ModalState(metric=setup.metric, diameter=diameter, rapid_rate=setup.last_rapid)
        if setup.begin is not None:
            begins = setup.begin.checkpoint.modal
        self._source, self._dialect = self._passes(job, setup), job.source.dialect
        self.cycle = Cycle(self._context, self.motion, self._source, begins, self._enter, self._handle_end)

    def _handle_end(self, end: ProgramEnd | None) -> None:
        """Handle M30, M02, or the end of an MDI line."""
        if end is not None and end.reset:
            self._end_functions()
        if self._line:
            self._end_mdi_line(end)
            return
        self.part_count.record_program_end()
        self.interruption_watch.clear_record()
        self._between = end is not None and end.reset and self._context.switches.cycle_repeat
        if self.cycle is not None and self._between:
            self._repeat_program(self.cycle)
        else:
            self._program_ended()

    def _repeat_program(self, cycle: Cycle) -> None:
        """Start the next part once the changed offsets are proved, or log why it does not start."""
        repeat = self._context.switches.cycle_repeat
        if repeat and self.changed_offsets.is_proof_pending and not self.status.next_part_inhibit_reason:
            cycle.wait_for_next_cycle("PROVING WITH THE CHANGED OFFSETS")
            return
        why = self._why_not_again(cycle.modal)
        if why or not repeat:
            self._program_ended(why)
            return
        self.changed_offsets.apply_changes(self.status)
        self._between = False
        self.counters.cycle_time_s = 0.0
        self.counters.started_run_count += 1
        assert self.status.job is not None
        self.interruption_watch.record_start(None)
        self._open_pass(self.status.job)
        self._enter(MachineState.RUN)
        self._context.log_text("repeat", self.status.job.source.name)

    def _why_not_again(self, left: ModalState) -> str:
        if self.status.next_part_inhibit_reason:
            return self.status.next_part_inhibit_reason
        if self.changed_offsets.is_requested:
            return self.changed_offsets.find_repeat_refusal_reason(left)
        again = start_conditions.find_first_move_clearance(
            self._context, self.status, self.counters.started_run_count, for_repeat=True
        )
        if again is not None and again.code:
            return again.why
        old = find_outdated_setting(self.status.job, left) if self.status.job is not None else ""
        return Message("{old}, but the program does not specify this setting", old=old) if old else ""

    def _program_ended(self, no_repeat: str = "") -> None:
        if no_repeat:
            self._context.log_text(
                "refused", Message("the cycle is not repeated: {no_repeat}", no_repeat=no_repeat)
            )
        self._context.log_text("end", "program end")
        self._finish_run(self.modal_state)
        self._enter(MachineState.IDLE)

    def _end_mdi_line(self, end: ProgramEnd | None) -> None:
        """Store the state that an MDI line passes to the next MDI line.

        If the line contains M30, this is the same state as after a program.
        """
        source = self._source
        left = source.make_checkpoint() if source is not None and source.make_checkpoint is not None else None
        modal = self.modal_state if left is None else sync_modal_state_with_machine(left.modal, self._context)
        self.status.saved_pass = left.kept if left is not None and end is None else None
        self._finish_run(modal, tool_open=left is not None and left.tool_line != 0)
        self._enter(MachineState.IDLE)
        self._context.log_text("mdi", "done")

    @property
    def modal_state(self) -> ModalState:
        """Return the modal state of the executing block, or the stored state if no program runs."""
        return self.cycle.modal if self.cycle is not None else self.status.modal_state

    def _end_functions(self) -> None:
        """Stop the spindle and turn off all outputs except the collet, as M30 requires."""
        context = self._context
        context.spindle.stop()
        for name, on in context.ports.io.get_outputs().items():
            if on and name != "collet":
                context.ports.io.write(name, False)


def _make_motion(context: MachineContext) -> PathMotion:
    """Return a motion by setpoints, or a motion by blocks if the controller has its own planner."""
    blocks = context.ports.blocks
    return SetpointMotion(context) if blocks is None else ControllerMotion(context, blocks)
