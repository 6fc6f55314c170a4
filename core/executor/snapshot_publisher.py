"""Factory of snapshots, which combines data of the executing block with measured values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypedDict

from core.executor.control_status import ControlStatus
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.program_motion.cycle import Cycle
from core.executor.snapshot import MachineState, Snapshot, StartAction
from core.interpreter.shared.actions import ProgramEnd, ProgramStop
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.ports import AxisSample

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import PlanePosition


class _BlockValues(TypedDict):
    """The values of a snapshot that come from the block being executed."""

    line: int
    block: int
    block_text: str
    block_end: tuple[float, ...]
    offset: tuple[float, float]
    feed: float
    rapid: bool
    turns: bool


class SnapshotPublisher:
    """Factory of the snapshots that the executor publishes.

    It also calculates the velocity from two consecutive samples.
    """

    def __init__(self) -> None:
        self._before: AxisSample | None = None
        self._velocity = 0.0
        self._swivel: PlanePosition | None = None
        self._diameter: bool | None = None  # X is displayed as a diameter; None: the mode of the control
        self._shown_for = ""  # the program to which this mode belongs

    def make_snapshot(self, context: MachineContext, control: MachineControl) -> Snapshot:
        """Return the snapshot of this tick."""
        cycle, status, counters = control.cycle, control.status, control.counters
        block = cycle.current_block if cycle else None
        job, modal = status.job, control.modal_state
        self._swivel = self._working_plane(
            block, is_running=cycle is not None or status.saved_pass is not None
        )
        return Snapshot(
            **_block_values(block, modal, context.axis_sample),
            next_block_text=_next_text(cycle),
            t=context.now,
            state=status.state,
            waiting_for=cycle.wait_label if cycle else "",
            program=job.source.name if job else "",
            job=job.digest if job else "",
            axes=tuple(axis.name for axis in context.machine.axes),
            demand=context.axis_sample.demand,
            actual=context.axis_sample.actual,
            following_error=context.axis_sample.following_error,
            homed=context.axis_sample.homed,
            powered=context.axis_sample.enabled,
            modal=modal,
            x_diameter=self._is_x_diameter(block, modal, status),
            swivel=self._swivel,
            velocity=self._measure_velocity(
                context.axis_sample, sum(not axis.is_rotary for axis in context.machine.axes)
            ),
            rpm_command=context.spindle.commanded_rpm,
            rpm_actual=context.spindle.measured_rpm,
            is_orienting=context.spindle.orientation.is_moving,
            oriented=context.spindle.orientation.angle_deg,
            requested_rpm=context.spindle.requested_rpm,
            feed_override=context.feed_override,
            spindle_override=context.spindle.override,
            spindle_auto=context.spindle.is_auto,
            spindle_limit_rpm=context.spindle.operator_limit_rpm or 0.0,
            single_block=context.switches.single_block,
            optional_stop=context.switches.optional_stop,
            block_delete=job.setup.block_delete if job else False,
            cycle_repeat=context.switches.cycle_repeat,
            no_count=context.switches.no_count,
            counts=control.program_run.will_count_part,
            absent=context.machine.missing_outputs,
            outputs=frozenset(name for name, on in context.commanded_outputs.get_all_outputs().items() if on),
            inputs=frozenset(name for name, on in context.inputs.items() if on),
            comment=modal.comment,
            message=cycle.message if cycle else "",
            is_optional_stop=status.state is MachineState.PROGRAM_STOP and _is_optional_stop(block),
            alarms=status.alarms,
            stop=context.stop,
            cycle_elapsed=counters.cycle_time_s,
            last_cycle=counters.last_cycle_time_s,
            timed_cycle_count=counters.timed_cycle_count,
            parts=counters.counted_part_count,
            made=counters.program_part_count,
            cutting=counters.cutting_times_s,
            next_barred=status.next_part_inhibit_reason,
            ends=counters.program_end_count,
            underruns=counters.underrun_count,
            hold_delay_s=context.tick_lateness.hold_delay_s,
            max_following_error=control.supervisor.max_following_error,
            needs_proof=job is not None and (status.proof is None or status.proof.digest != job.digest),
            starts=status.start_action,
            prepared_job_digest=status.prepared_job.digest if status.prepared_job else "",
            lines=counters.mdi_line_count,
            interrupted=status.interrupted_job,
            confirmed=control.program_run.interruption_watch.is_start_confirmed,
            is_tool_move_pending=status.is_tool_move_pending,
            kept=status.saved_pass,
            announced=control.announcement.update_texts(context.now),
            start_refusal_reason=status.start_refusal_reason,
            start_code=status.start_refusal_code if status.start_refusal_reason else "",
            begun=counters.started_run_count,
            wheel=control.handwheel.axis,
            wheel_ended=control.handwheel.end_reason,
            unknown=context.unknown_parts,
            drive_test=control.drive_tester.state,
            touch_phase=control.touch_off.phase,
            touched=control.touch_off.last_result,
            spindle_load=context.spindle_load,
        )

    def _is_x_diameter(self, block: Block | None, modal: ModalState, status: ControlStatus) -> bool:
        """Return whether X is displayed as a diameter.

        The mode of the last program or MDI line remains after its end, a Reset or an E-stop, and while the
        tool is retracted. The tool may still be in the part, and a displayed X that suddenly halves would
        mislead the operator. If another program is loaded or MDI is opened, the control's own mode is used.
        """
        name = status.job.source.name if status.job is not None else ""
        if name != self._shown_for:
            self._shown_for, self._diameter = name, None
        if status.start_action is StartAction.MDI_LINE:
            self._diameter = modal.diameter
        elif block is not None and not (
            status.start_action is StartAction.RETRACT or isinstance(block.action, ProgramEnd)
        ):
            self._diameter = block.modal.diameter
        return modal.diameter if self._diameter is None else self._diameter

    def _working_plane(self, block: Block | None, *, is_running: bool) -> PlanePosition | None:
        """Return the working plane of the last block on a mill.

        Between programs, the working plane is neither tilted nor shifted.
        """
        if block is not None:
            return block.swivel
        last = self._swivel
        return (
            last
            if last is None or is_running or last.system.is_workpiece_system
            else last.convert_to_workpiece_system()
        )

    def _measure_velocity(self, sample: AxisSample, linear_axis_count: int) -> float:
        """Return the resultant velocity of the linear axes in mm/s, from their encoder positions."""
        before, self._before = self._before, sample
        if before is None:
            return 0.0
        dt = sample.t - before.t
        if dt > 0.0:
            self._velocity = (
                math.dist(sample.actual[:linear_axis_count], before.actual[:linear_axis_count]) / dt
            )
        return self._velocity


def _ends(block: Block) -> bool:
    return isinstance(block.action, ProgramEnd)


def _block_values(block: Block | None, modal: ModalState, sample: AxisSample) -> _BlockValues:
    """Return the snapshot values of a block, or of the modal state and setpoint if ``block`` is None."""
    return _BlockValues(
        line=block.line if block else 0,
        block=block.n if block else 0,
        block_text=block.text if block else "",
        block_end=block.machine_end if block else sample.demand,
        offset=(block.offset_x, block.offset_z) if block else (modal.offset_x, modal.offset_z),
        feed=_feed_in_force(block, modal),
        rapid=block.rapid if block else modal.rapid,
        turns=_is_rotary_feed(block, modal),
    )


def _is_optional_stop(block: Block | None) -> bool:
    """Return whether the block is an optional stop (M01)."""
    action = block.action if block else None
    return isinstance(action, ProgramStop) and action.optional


def _next_text(cycle: Cycle | None) -> str:
    """Return the text of the block after the executing block, or an empty string if none follows."""
    following = cycle.next_block if cycle else None
    return following.text if following else ""


def _is_rotary_feed(block: Block | None, modal: ModalState) -> bool:
    """Return whether the programmed feed is in degrees instead of mm."""
    if block is None:
        return False
    return (block.has_angular_feed and not block.rapid) or (
        block.kind is BlockKind.ROTATE and not modal.c_locked
    )


def _feed_in_force(block: Block | None, modal: ModalState) -> float:
    """Return the programmed feed of a block that moves, or the modal feed for any other block."""
    if block is not None and block.moves and block.kind is not BlockKind.ROTATE:
        # A tap moves by its lead even if the feed per minute is in force.
        by_minute = block.follows_spindle and block.per_rev and not block.modal.per_rev
        return block.feed * abs(block.rpm) / 60.0 if by_minute else block.feed
    return modal.feed or 0.0
