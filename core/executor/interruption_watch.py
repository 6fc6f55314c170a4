"""Storage of interrupted jobs: canceled programs, and the job that a power loss would interrupt."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from core.executor.control_status import ControlStatus, PartCounter
from core.executor.job import Job
from core.executor.machine_context import MachineContext
from core.executor.program_motion.cycle import Cycle
from core.executor.snapshot import (
    POWER_LOST_REASON,
    STOPPED_STATES,
    InterruptedJob,
    MachineState,
    StartAction,
    make_utc_timestamp,
)
from core.interpreter.shared.checkpoint import PassStart
from core.interpreter.shared.elementary_blocks import Block
from core.language.source import Dialect
from core.message import Message
from core.tool_edges import format_edge_name

StoreFunction = Callable[[InterruptedJob | None], None]
"""Function that receives the state to store for the running program, or None for an empty state.

It must only put the state into a queue.
"""

_RECORD_INTERVAL_S = 1.0  # s between two notes while the program runs
_MOVED_DISTANCE_MM = 0.01  # mm or degrees; smaller changes count as the same position
_SETTLED_S = 0.2  # s at rest after which the tool position is final
_CONFIRMATION_VALID_S = 60.0  # s for which a confirmation of the operator is valid


class InterruptionRecorder:
    """Recorder that stores, in advance, the job that a power loss would interrupt.

    After a power loss it is too late to write. The state is therefore stored before a cycle starts, at each
    part, tool and stop, and otherwise at most once per second. Only the executor's thread uses this class.
    """

    def __init__(
        self,
        context: MachineContext,
        status: ControlStatus,
        parts: PartCounter,
        store_interruption: StoreFunction,
        interrupted_job: InterruptedJob | None,
    ) -> None:
        """Create the recorder; ``interrupted_job`` is the interrupted job found when the control starts."""
        self._context, self._status, self._parts, self._keep = context, status, parts, store_interruption
        self._begun = False  # this control has started a program
        self._begin: PassStart | None = None
        self._before: InterruptedJob | None = None  # the interrupted job that the present restart continues
        self._noted: InterruptedJob | None = None
        self._next = 0.0  # s, monotonic time of the next permitted note
        self._stopped = False
        self._rests_since: float | None = None
        self._settled = True
        self._answered: float | None = None
        status.interrupted_job = interrupted_job

    def set_previous_interruption(self, interrupted_job: InterruptedJob, *, is_logged: bool = False) -> None:
        """Set the job that was interrupted when the previous control process ended.

        The call has no effect if a program has started since.
        """
        if not self._begun and self._status.interrupted_job != interrupted_job:
            self._status.interrupted_job = interrupted_job
            if not is_logged:
                self._context.log_text("interrupted", interrupted_job.words)

    # --- running program ----------------------------------------------------------------------------------

    @property
    def started_block_count(self) -> int:
        """Return the number of elementary blocks of the current workpiece that have started."""
        status = self._status
        job, before = status.job, status.interrupted_job
        return before.begun if job is not None and before is not None and _belongs_to(before, job) else 0

    def record_start(self, begin: PassStart | None) -> None:
        """Record that a program or a restart has started, so that a power loss would interrupt it."""
        status, before = self._status, self._status.interrupted_job
        assert status.job is not None
        self._begun = True
        self._begin, self._before, self._answered = begin, None, None
        if before is not None and begin is not None and _belongs_to(before, status.job):
            self._before = before
        elif before is not None:
            self._over(Message("{before}; the program restarts from the beginning", before=before.words))
        status.interrupted_job = None
        self._note(self._interrupted_job(status.job, None))

    def record_progress(self, cycle: Cycle | None) -> None:
        """Record the progress of the program, once per tick.

        ``cycle`` is the running cycle of a program, or None if no program runs.
        """
        if self._status.state is not MachineState.IDLE:
            self._answered = None
        block = cycle.current_block if cycle is not None else None
        if cycle is None:
            self._settle()
        elif self._status.job is not None and block is not None:
            stopped = self._status.state in STOPPED_STATES and cycle.is_at_rest
            if self._worth_a_note(block, just_stopped=stopped and not self._stopped):
                self._note(self._interrupted_job(self._status.job, block))
            self._stopped = stopped

    def _worth_a_note(self, block: Block, *, just_stopped: bool) -> bool:
        log_stop, at = self._noted, self._context.axis_sample.actual
        if log_stop is None or log_stop.tool != block.modal.tool or log_stop.block == 0 or just_stopped:
            return True
        moved = log_stop.block != block.n or math.dist(log_stop.where, at) > _MOVED_DISTANCE_MM
        return moved and self._context.now >= self._next

    def clear_record(self) -> None:
        """Clear the stored job because the program has reached its end."""
        self._noted = self._before = None
        self._keep(None)

    def record_interruption(self, block: Block | None, reason: str) -> None:
        """Store the program as interrupted at ``block`` for the given reason.

        If ``block`` is None, no block has started, and the program is not interrupted unless it was a
        restart.
        """
        job = self._status.job
        if job is None or (block is None and self._before is None):
            self.clear_record()
            return
        found = replace(self._interrupted_job(job, block), why=reason)
        self._noted = self._before = None
        self._settled, self._rests_since = False, None
        self._status.interrupted_job = found
        self._keep(found)
        self._context.log_text("interrupted", found.words)

    def _settle(self) -> None:
        """After an E-stop, update the stored tool position until the axes are at rest for 0.2 s."""
        found, now = self._status.interrupted_job, self._context.now
        if self._settled or found is None:
            return
        if self._context.axis_sample.moving or self._rests_since is None:
            self._rests_since = now
        self._settled = now - self._rests_since >= _SETTLED_S
        self._status.interrupted_job = replace(found, where=self._context.axis_sample.actual)
        if self._settled:
            self._keep(self._status.interrupted_job)

    # --- between programs ---------------------------------------------------------------------------------

    def handle_loaded_job(self, job: Job) -> None:
        """Clear the interrupted job if a different program is loaded.

        Reloading the same program does not clear it.
        """
        before = self._status.interrupted_job
        self._answered = None
        if before is not None and not _belongs_to(before, job):
            self._over(
                Message("{before}; {source} was loaded instead", before=before.words, source=job.source.name)
            )

    def confirm_start(self, interruption_time: str) -> str:
        """Accept the operator's confirmation of a start at the first line.

        Return the reason if the confirmation is refused, otherwise an empty string.
        """
        self._answered = None
        found = self._status.interrupted_job
        if not interruption_time:
            return ""  # the confirmation is withdrawn
        if found is None or found.at != interruption_time or self._status.state is not MachineState.IDLE:
            return "no interrupted program is waiting for confirmation"
        self._answered = self._context.now
        return ""

    def withdraw_confirmation(self) -> None:
        """Withdraw the confirmation because Cycle Start now has a different action."""
        self._answered = None

    @property
    def is_start_confirmed(self) -> bool:
        """Return whether the operator has confirmed a start at the first line within the last 60 s."""
        return self._answered is not None and self._context.now - self._answered <= _CONFIRMATION_VALID_S

    @property
    def start_refusal_reason(self) -> str:
        """Return why a start at the first line needs a confirmation, or an empty string if it does not."""
        found = self._status.interrupted_job
        if found is None or self._status.start_action is not StartAction.PROGRAM or self.is_start_confirmed:
            return ""
        job = self._status.job
        there = job is None or job.source.dialect is Dialect.OMNITURN
        template = (
            "line {line} of {program} was interrupted, and {tool} may still be in the part: resume at the "
            "interrupted line with SEARCHTO (F6), or press Y and then start at the first line"
            if there
            else "line {line} of {program} was interrupted, and {tool} may still be in the part: jog the "
            "tool clear of the part, press Y, and then start at the first line"
        )
        return Message(template, line=found.line, program=found.program, tool=format_edge_name(found.tool))

    def _over(self, words: str) -> None:
        self._status.interrupted_job = None
        self._settled = True
        self._keep(None)
        self._context.log_text("cleared", words)

    # --- noted state --------------------------------------------------------------------------------------

    def _note(self, what: InterruptedJob) -> None:
        self._noted, self._next = what, self._context.now + _RECORD_INTERVAL_S
        self._keep(what)

    def _interrupted_job(self, job: Job, block: Block | None) -> InterruptedJob:
        """Return the job that a power loss at this moment would leave interrupted.

        During the approach of a restart, the job that was interrupted earlier is returned.
        """
        begin, before = self._begin, self._before
        if before is not None and (
            block is None or (begin is not None and block.n <= begin.checkpoint.blocks)
        ):
            return replace(
                before, where=self._context.axis_sample.actual, why=POWER_LOST_REASON, at=make_utc_timestamp()
            )
        done = block.n if block is not None else 0
        return InterruptedJob(
            program=job.source.name,
            job=job.digest,
            text=job.text_digest,
            line=block.line if block is not None else begin.line_number if begin is not None else 1,
            block=done,
            begun=self._parts.workpiece.count_started_blocks(done),
            tool=block.modal.tool if block is not None else self._status.modal_state.tool,
            part=self._parts.counters.program_part_count + 1,
            axes=tuple(axis.name for axis in self._context.machine.axes),
            where=self._context.axis_sample.actual,
            why=POWER_LOST_REASON,
            at=make_utc_timestamp(),
        )


def _belongs_to(found: InterruptedJob, job: Job) -> bool:
    """Return whether the interrupted job belongs to the program of this job.

    The text or the offsets of the program may have changed since the interruption.
    """
    return found.program == job.source.name
