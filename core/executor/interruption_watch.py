"""Keeps what a power cut would leave as interrupted job, and declares a program that broke off to be one."""

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

_EVERY = 1.0  # s between two notes while the program goes on
_MOVED = 0.01  # mm or degrees: less is no other place
_STANDS = 0.2  # s at rest after which a tool stands where it stands
_ANSWERED = 60.0  # s for which the answer of an operator counts


class InterruptionWatch:
    """A power cut gives no time to write, so what would be true after it is noted before anything moves.

    At the start of the cycle, at each part and tool, whenever the cycle stops, and once a second at most
    while it goes on. On the executor's thread alone.
    """

    def __init__(
        self,
        context: MachineContext,
        status: ControlStatus,
        parts: PartCount,
        note: Note,
        left: InterruptedJob | None,
    ) -> None:
        """``left`` is what the control found at its start."""
        self._context, self._status, self._parts, self._keep = context, status, parts, note
        self._begun = False  # whether this control has begun any program
        self._begin: Begin | None = None
        self._before: InterruptedJob | None = None  # what a restart under way goes on with
        self._noted: InterruptedJob | None = None
        self._next = 0.0  # s, monotonic: no note before
        self._stopped = False
        self._rests_since: float | None = None
        self._settled = True
        self._answered: float | None = None
        status.interrupted = left

    def found(self, left: InterruptedJob, *, logged: bool = False) -> None:
        """What the control before has left, known only now. A program begun since has settled it."""
        if not self._begun and self._status.interrupted != left:
            self._status.interrupted = left
            if not logged:
                self._context.log("interrupted", left.words)

    # --- the program under way ----------------------------------------------------------------------------

    @property
    def begun(self) -> int:
        """Elementary blocks of the piece in the collet that are begun already."""
        status = self._status
        job, before = status.job, status.interrupted
        return before.begun if job is not None and before is not None and _of(before, job) else 0

    def begin(self, begin: Begin | None) -> None:
        """The program begins, or a restart in it: from here on a power cut leaves an interrupted job."""
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
        """Every tick: keep what has changed. ``cycle`` is that of a program, None: none is under way."""
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
        """The program has come to its end."""
        self._noted = self._before = None
        self._keep(None)

    def broke_off(self, block: Block | None, why: str) -> None:
        """The program under way is over before its end at this block: an interrupted job from now on.

        Without a block nothing of it has begun.
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
        """The slides still brake when an E-stop is seen: the tool stands where it has come to rest."""
        found, now = self._status.interrupted, self._context.now
        if self._settled or found is None:
            return
        if self._context.sample.moving or self._rests_since is None:
            self._rests_since = now
        self._settled = now - self._rests_since >= _STANDS
        self._status.interrupted = replace(found, where=self._context.sample.actual)
        if self._settled:
            self._keep(self._status.interrupted)

    # --- between two programs -----------------------------------------------------------------------------

    def loaded(self, job: Job) -> None:
        """Another program takes its place; the same one read again does not."""
        before = self._status.interrupted
        self._answered = None
        if before is not None and not _of(before, job):
            self._over(
                Message("{before}; {source} was loaded instead", before=before.words, source=job.source.name)
            )

    def answer(self, at: str) -> str:
        """The operator has read what a start at the first line does; why that does not count, or nothing."""
        self._answered = None
        found = self._status.interrupted
        if not at:
            return ""  # taken back
        if found is None or found.at != at or self._status.state is not State.IDLE:
            return "no interrupted program is waiting for confirmation"
        self._answered = self._context.now
        return ""

    def withdraw(self) -> None:
        """The next start is to begin something else."""
        self._answered = None

    @property
    def answered(self) -> bool:
        """Whether that was said, and not too long ago."""
        return self._answered is not None and self._context.now - self._answered <= _ANSWERED

    @property
    def refusal(self) -> str:
        """Why a start at the first line has to be confirmed; empty when it has not."""
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

    # --- what is noted ------------------------------------------------------------------------------------

    def _note(self, what: InterruptedJob) -> None:
        self._noted, self._next = what, self._context.now + _EVERY
        self._keep(what)

    def _now(self, job: Job, block: Block | None) -> InterruptedJob:
        """What would be true if the power went now.

        On the way of a restart it is still what that goes on with.
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
    """Whether it is this program that was interrupted; its text or its offsets may have changed since."""
    return found.program == job.source.name
