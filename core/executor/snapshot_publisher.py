"""Construction of snapshots from the block being executed and from measured values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypedDict

from core.executor.control_status import ControlStatus
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.program_motion.cycle import Cycle
from core.executor.snapshot import Snapshot, Starts, State
from core.interpreter.shared.actions import ProgramEnd, ProgramStop
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.modal_state import Modal
from core.ports import AxisSample

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import Swivel


class _Played(TypedDict):
    """The values of a snapshot that come from the block being executed."""

    line: int
    block: int
    block_text: str
    block_end: tuple[float, ...]
    offset: tuple[float, float]
    feed: float
    rapid: bool
    turns: bool


class Publisher:
    """Makes snapshots, and measures the velocity from two consecutive samples."""

    def __init__(self) -> None:
        self._before: AxisSample | None = None
        self._velocity = 0.0
        self._swivel: Swivel | None = None
        self._diameter: bool | None = None  # X is displayed as a diameter; None: the mode of the control
        self._shown_for = ""  # the program to which this mode belongs

    def snapshot(self, context: MachineContext, control: MachineControl) -> Snapshot:
        """Return the snapshot of this tick."""
        cycle, status, counters = control.cycle, control.status, control.counters
        block = cycle.current if cycle else None
        job, modal = status.job, control.modal
        self._swivel = self._system(block, under_way=cycle is not None or status.kept is not None)
        return Snapshot(
            **_played(block, modal, context.sample),
            next_text=_next_text(cycle),
            t=context.now,
            state=status.state,
            waiting_for=cycle.waiting_for if cycle else "",
            program=job.source.name if job else "",
            job=job.digest if job else "",
            axes=tuple(axis.name for axis in context.machine.axes),
            demand=context.sample.demand,
            actual=context.sample.actual,
            following_error=context.sample.following_error,
            homed=context.sample.homed,
            powered=context.sample.enabled,
            modal=modal,
            x_diameter=self._x_mode(block, modal, status),
            swivel=self._swivel,
            velocity=self._measured(context.sample, sum(not axis.rotary for axis in context.machine.axes)),
            rpm_command=context.spindle.command,
            rpm_actual=context.spindle.measured,
            orienting=context.spindle.orientation.on_its_way,
            oriented=context.spindle.orientation.at,
            spindle_asked=context.spindle.asked_rpm,
            feed_override=context.feed_override,
            spindle_override=context.spindle.override,
            spindle_auto=context.spindle.auto,
            spindle_limit=context.spindle.limit or 0.0,
            single_block=context.switches.single_block,
            optional_stop=context.switches.optional_stop,
            block_delete=job.setup.block_delete if job else False,
            cycle_repeat=context.switches.cycle_repeat,
            no_count=context.switches.no_count,
            counts=control.program_run.will_count,
            absent=context.machine.absent,
            outputs=frozenset(name for name, on in context.outputs.everything().items() if on),
            inputs=frozenset(name for name, on in context.inputs.items() if on),
            comment=modal.comment,
            message=cycle.message if cycle else "",
            optionally_stopped=status.state is State.PROGRAM_STOP and _optional(block),
            alarms=status.alarms,
            stop=context.stop,
            cycle_elapsed=counters.cycle,
            last_cycle=counters.last_cycle,
            timed=counters.timed,
            parts=counters.parts,
            made=counters.made,
            cutting=counters.cutting,
            next_barred=status.next_barred,
            ends=counters.ends,
            underruns=counters.underruns,
            hold_later=context.lateness.hold_later,
            max_following_error=control.supervisor.max_following_error,
            proof_wanted=job is not None and (status.proof is None or status.proof.digest != job.digest),
            starts=status.starts,
            prepared=status.prepared.digest if status.prepared else "",
            lines=counters.lines,
            interrupted=status.interrupted,
            confirmed=control.program_run.interruption.answered,
            tool_open=status.tool_open,
            kept=status.kept,
            announced=control.announcement.publish(context.now),
            start_refused=status.start_refused,
            start_code=status.start_code if status.start_refused else "",
            begun=counters.begun,
            wheel=control.wheel.axis,
            wheel_ended=control.wheel.ended,
            unknown=context.unknown,
            drive_test=control.drive_test.state,
            touching=control.touch.phase,
            touched=control.touch.touched,
            spindle_load=context.spindle_load,
        )

    def _x_mode(self, block: Block | None, modal: Modal, status: ControlStatus) -> bool:
        """Return whether X is displayed as a diameter.

        The mode of the last program or MDI line remains after its end, a reset or an E-stop, and during a
        retract from the part. The tool may still be in the part, and a displayed value that suddenly halves
        would mislead the operator. Another program selects the mode of the control. So does MDI, where typed
        values are in that mode.
        """
        name = status.job.source.name if status.job is not None else ""
        if name != self._shown_for:
            self._shown_for, self._diameter = name, None
        if status.starts is Starts.LINE:
            self._diameter = modal.diameter
        elif block is not None and not (
            status.starts is Starts.WAY_OUT or isinstance(block.action, ProgramEnd)
        ):
            self._diameter = block.modal.diameter
        return modal.diameter if self._diameter is None else self._diameter

    def _system(self, block: Block | None, *, under_way: bool) -> Swivel | None:
        """Return the working plane of the last block on a mill.

        Between programs, the working plane is neither tilted nor shifted.
        """
        if block is not None:
            return block.swivel
        last = self._swivel
        return last if last is None or under_way or last.system.level else last.levelled()

    def _measured(self, sample: AxisSample, slides: int) -> float:
        """Return the velocity of the linear axes together, in mm/s, measured by the encoders."""
        before, self._before = self._before, sample
        if before is None:
            return 0.0
        dt = sample.t - before.t
        if dt > 0.0:
            self._velocity = math.dist(sample.actual[:slides], before.actual[:slides]) / dt
        return self._velocity


def _ends(block: Block) -> bool:
    return isinstance(block.action, ProgramEnd)


def _played(block: Block | None, modal: Modal, sample: AxisSample) -> _Played:
    """Return the values of the block, or of the modal state and the setpoint without a block."""
    return _Played(
        line=block.line if block else 0,
        block=block.n if block else 0,
        block_text=block.text if block else "",
        block_end=block.machine_end if block else sample.demand,
        offset=(block.offset_x, block.offset_z) if block else (modal.offset_x, modal.offset_z),
        feed=_feed(block, modal),
        rapid=block.rapid if block else modal.rapid,
        turns=_turns(block, modal),
    )


def _optional(block: Block | None) -> bool:
    """Return whether the block is an optional stop (M01)."""
    action = block.action if block else None
    return isinstance(action, ProgramStop) and action.optional


def _next_text(cycle: Cycle | None) -> str:
    """Return the text of the block after the one being executed, or an empty string."""
    following = cycle.next_block if cycle else None
    return following.text if following else ""


def _turns(block: Block | None, modal: Modal) -> bool:
    """Return whether the programmed feed is in degrees instead of mm."""
    if block is None:
        return False
    return (block.swivels and not block.rapid) or (block.kind is Kind.ROTATE and not modal.c_locked)


def _feed(block: Block | None, modal: Modal) -> float:
    """Return the programmed feed of a moving block, or the feed in force."""
    if block is not None and block.moves and block.kind is not Kind.ROTATE:
        # A tap moves by its lead even if the feed per minute is in force.
        by_minute = block.coupled and block.per_rev and not block.modal.per_rev
        return block.feed * abs(block.rpm) / 60.0 if by_minute else block.feed
    return modal.feed or 0.0
