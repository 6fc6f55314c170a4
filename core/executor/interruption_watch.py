"""Storage of the job that a power loss would interrupt, and of programs that were canceled."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from core.executor.control_status import ControlStatus, PartCount
from core.executor.job import Job
from core.executor.machine_context import MachineContext
from core.executor.program_motion.cycle import Cycle
from core.executor.snapshot import CONTROL_LOST, STOPPED, InterruptedJob, Starts, State, utc_now
from core.interpreter.shared.checkpoint import Begin
from core.interpreter.shared.elementary_blocks import Block
from core.language.source import Dialect
from core.message import Message
from core.tool_edges import edge_name

Note = Callable[[InterruptedJob | None], None]
"""Takes what is to be kept of the program under way, None: nothing. It must only put it into a queue."""

_EVERY = 1.0  # s between two notes while the program runs
_MOVED = 0.01  # mm or degrees; smaller changes count as the same position
_STANDS = 0.2  # s at rest after which the tool position is final
_ANSWERED = 60.0  # s for which a confirmation of the operator is valid


class InterruptionWatch:
    """Stores the interrupted job in advance, because a power loss leaves no time to write.

    The state is noted before a cycle starts, at each part and tool, at each stop, and otherwise once per
    second at most. Used on the executor's thread only.
    """

    def __init__(
        self,
        context: MachineContext,
        status: ControlStatus,
        parts: PartCount,
        note: Note,
        left: InterruptedJob | None,
    ) -> None:
        """Initialize the watch. ``left`` is the interrupted job found at the start of the control."""
        self._context, self._status, self._parts, self._keep = context, status, parts, note
        self._begun = False  # this control has started a program
        self._begin: Begin | None = None
        self._before: InterruptedJob | None = None  # the interrupted job that the present restart continues
        self._noted: InterruptedJob | None = None
        self._next = 0.0  # s, monotonic time of the next permitted note
        self._stopped = False
        self._rests_since: float | None = None
        self._settled = True
        self._answered: float | None = None
        status.interrupted = left

    def found(self, left: InterruptedJob, *, logged: bool = False) -> None:
        """Set the job that the previous control left interrupted, unless a program has started since."""
        if not self._begun and self._status.interrupted != left:
            self._status.interrupted = left
            if not logged:
                self._context.log("interrupted", left.words)

    # --- running program ----------------------------------------------------------------------------------

    @property
    def begun(self) -> int:
        """The number of elementary blocks of the present workpiece that have started."""
        status = self._status
        job, before = status.job, status.interrupted
        return before.begun if job is not None and before is not None and _of(before, job) else 0

    def begin(self, begin: Begin | None) -> None:
        """Note the start of a program or a restart, which a power loss would now interrupt."""
        status, before = self._status, self._status.interrupted
        assert status.job is not None
        self._begun = True
        self._begin, self._before, self._answered = begin, None, None
        if before is not None and begin is not None and _of(before, status.job):
            self._before = before
        elif before is not None:
            self._over(Message("{before}; the program restarts from the beginning", before=before.words))
        status.interrupted = None
        self._note(self._now(status.job, None))

    def look(self, cycle: Cycle | None) -> None:
        """Note changes, once per tick. ``cycle`` is the cycle of a program, or None if no program runs."""
        if self._status.state is not State.IDLE:
            self._answered = None
        block = cycle.current if cycle is not None else None
        if cycle is None:
            self._settle()
        elif self._status.job is not None and block is not None:
            stopped = self._status.state in STOPPED and cycle.at_rest
            if self._worth_a_note(block, just_stopped=stopped and not self._stopped):
                self._note(self._now(self._status.job, block))
            self._stopped = stopped

    def _worth_a_note(self, block: Block, *, just_stopped: bool) -> bool:
        log_stop, at = self._noted, self._context.sample.actual
        if log_stop is None or log_stop.tool != block.modal.tool or log_stop.block == 0 or just_stopped:
            return True
        moved = log_stop.block != block.n or math.dist(log_stop.where, at) > _MOVED
        return moved and self._context.now >= self._next

    def finished(self) -> None:
        """Clear the note because the program has reached its end."""
        self._noted = self._before = None
        self._keep(None)

    def broke_off(self, block: Block | None, why: str) -> None:
        """Store the program as interrupted at ``block`` for the reason ``why``.

        If ``block`` is None, no block has started, and the program is not interrupted unless it was a
        restart.
        """
        job = self._status.job
        if job is None or (block is None and self._before is None):
            self.finished()
            return
        found = replace(self._now(job, block), why=why)
        self._noted = self._before = None
        self._settled, self._rests_since = False, None
        self._status.interrupted = found
        self._keep(found)
        self._context.log("interrupted", found.words)

    def _settle(self) -> None:
        """Update the tool position until the axes have been at rest for 0.2 s after an E-stop."""
        found, now = self._status.interrupted, self._context.now
        if self._settled or found is None:
            return
        if self._context.sample.moving or self._rests_since is None:
            self._rests_since = now
        self._settled = now - self._rests_since >= _STANDS
        self._status.interrupted = replace(found, where=self._context.sample.actual)
        if self._settled:
            self._keep(self._status.interrupted)

    # --- between programs ---------------------------------------------------------------------------------

    def loaded(self, job: Job) -> None:
        """Clear the interrupted job if another program is loaded, but not if the same program is reloaded."""
        before = self._status.interrupted
        self._answered = None
        if before is not None and not _of(before, job):
            self._over(
                Message("{before}; {source} was loaded instead", before=before.words, source=job.source.name)
            )

    def answer(self, at: str) -> str:
        """Accept the operator's confirmation of a start at the first line.

        Returns the reason if the confirmation is refused, or an empty string.
        """
        self._answered = None
        found = self._status.interrupted
        if not at:
            return ""  # the confirmation is withdrawn
        if found is None or found.at != at or self._status.state is not State.IDLE:
            return "no interrupted program is waiting for confirmation"
        self._answered = self._context.now
        return ""

    def withdraw(self) -> None:
        """Withdraw the confirmation because the next start begins something else."""
        self._answered = None

    @property
    def answered(self) -> bool:
        """True if the operator has confirmed the start within the last 60 s."""
        return self._answered is not None and self._context.now - self._answered <= _ANSWERED

    @property
    def refusal(self) -> str:
        """The reason why a start at the first line needs a confirmation; empty if it does not."""
        found = self._status.interrupted
        if found is None or self._status.starts is not Starts.PROGRAM or self.answered:
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
        return Message(template, line=found.line, program=found.program, tool=edge_name(found.tool))

    def _over(self, words: str) -> None:
        self._status.interrupted = None
        self._settled = True
        self._keep(None)
        self._context.log("cleared", words)

    # --- noted state --------------------------------------------------------------------------------------

    def _note(self, what: InterruptedJob) -> None:
        self._noted, self._next = what, self._context.now + _EVERY
        self._keep(what)

    def _now(self, job: Job, block: Block | None) -> InterruptedJob:
        """Return the job that a power loss at this moment would leave interrupted.

        During the approach of a restart, this is the earlier interrupted job.
        """
        begin, before = self._begin, self._before
        if before is not None and (
            block is None or (begin is not None and block.n <= begin.checkpoint.blocks)
        ):
            return replace(before, where=self._context.sample.actual, why=CONTROL_LOST, at=utc_now())
        done = block.n if block is not None else 0
        return InterruptedJob(
            program=job.source.name,
            job=job.digest,
            text=job.text_digest,
            line=block.line if block is not None else begin.line if begin is not None else 1,
            block=done,
            begun=self._parts.piece.begun_to(done),
            tool=block.modal.tool if block is not None else self._status.modal.tool,
            part=self._parts.counters.made + 1,
            axes=tuple(axis.name for axis in self._context.machine.axes),
            where=self._context.sample.actual,
            why=CONTROL_LOST,
            at=utc_now(),
        )


def _of(found: InterruptedJob, job: Job) -> bool:
    """Return whether the interrupted job belongs to this program.

    The text or the offsets of the program may have changed since the interruption.
    """
    return found.program == job.source.name
