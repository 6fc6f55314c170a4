"""Runs of programs and MDI lines: start, Cycle Repeat, cancel, and changed offsets such as wear.

Changed offsets take effect between two parts. The modal state that a run leaves is stored for the next run.
"""

from __future__ import annotations

from collections.abc import Callable

from core.executor import start_conditions
from core.executor.commands import UNCHECKED, Renew
from core.executor.control_status import (
    ControlStatus,
    PartCount,
    modal_as_machine,
    modal_given_up,
    modal_interrupted,
    modal_with_offsets,
)
from core.executor.interruption_watch import InterruptionWatch, Note
from core.executor.job import Job, ProgramPass, circumstances, outdated
from core.executor.machine_context import MachineContext
from core.executor.program_motion.controller_motion import ControllerMotion
from core.executor.program_motion.cycle import Cycle, PathMotion
from core.executor.program_motion.setpoint_motion import SetpointMotion
from core.executor.snapshot import GIVEN_UP, LINES, InterruptedJob, Starts, State
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.language.source import Dialect
from core.message import Message
from core.tool_edges import tool_of


class ChangedOffsets:
    """A request to continue the running program with changed offsets.

    The part in progress uses its present ones.

    The changed job must be proved before its first move. With Cycle Repeat, the next part waits for the
    proof. A program that fails the proof with the new offsets is not repeated.
    """

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._asked: Renew | None = None

    @property
    def wanted(self) -> bool:
        """True if the next part starts with changed offsets."""
        return self._asked is not None

    @property
    def pending(self) -> bool:
        """True if the proof of the changed offsets has not arrived yet."""
        return self._asked is not None and self._asked.proof is None and not self._asked.trouble

    def ask(self, asked: Renew, running: Job | None) -> str:
        """Store a request until the end of the part; return why it is refused, or an empty string."""
        job = asked.job
        if job is not None and (running is None or job.source.text != running.source.text):
            return (
                "another program is running; changed offsets apply only to the program for which "
                "they were entered"
            )
        self._asked = asked
        return ""

    def refusal(self, left: Modal) -> str:
        """Return why the program is not repeated with the changed offsets, or an empty string."""
        asked = self._asked
        if asked is None:
            return ""
        if asked.trouble or asked.job is None:
            return asked.trouble
        why = start_conditions.unproved(asked.job, asked.proof) or start_conditions.lacking(
            self._context, asked.proof
        )
        return why or outdated(asked.job, left)

    def take_up(self, status: ControlStatus) -> None:
        """Make the changed job the loaded program, between two parts or after the program.

        Without a proof, the program cannot start, because its old offsets no longer match the tables.
        """
        asked, self._asked = self._asked, None
        if asked is None:
            return
        status.proof = asked.proof
        if asked.job is not None:
            setup = asked.job.setup
            status.job = asked.job
            status.modal = modal_with_offsets(status.modal, setup.tools, setup.secondary)
            self._context.log("offsets", "the changed offsets are in effect")

    def forget(self) -> None:
        """Discard the request because another program is loaded."""
        self._asked = None


class ProgramRun:
    """The running cycle and the state between two cycles. Used by the executor's thread only."""

    def __init__(
        self,
        context: MachineContext,
        passes: Callable[[Job, Setup], ProgramPass],
        enter: Callable[[State], None],
        note: Note,
        left: InterruptedJob | None,
    ) -> None:
        self._context = context
        self._passes = passes
        self._enter = enter
        self.motion = _motion_of(context)
        self.status = ControlStatus()
        self.parts = PartCount(context)
        self.counters = self.parts.counters
        self.interruption = InterruptionWatch(context, self.status, self.parts, note, left)
        self.changed_offsets = ChangedOffsets(context)
        self.cycle: Cycle | None = None
        self._source: ProgramPass | None = None
        self._line = False  # the run is an MDI line
        self._dialect = Dialect.OMNITURN  # language of the run
        self._between = False  # a part is finished, and the next one waits for the proof of changed offsets

    def refusal(self, state: State) -> str:
        """Return why Cycle Start may not start the selected job, or an empty string."""
        why = start_conditions.start_refusal(self._context, state, self.status)
        self.status.start_code = ""
        if why:
            return why
        code, why = start_conditions.first_move_refusal(self._context, self.status, self.counters.begun)
        self.status.start_code = code
        if code == UNCHECKED:
            return self.interruption.refusal or why
        return why or self.interruption.refusal

    def begin(self) -> None:
        """Start the program, the restart or the MDI line. A prepared job is used only once."""
        status, context = self.status, self._context
        job = start_conditions.job_to_start(status)
        assert job is not None
        self.counters.cycle = 0.0
        self.counters.begun += 1
        self._line = status.starts in LINES
        self.counters.lines += self._line
        if status.starts is Starts.RESTART:
            status.starts = Starts.PROGRAM
        status.prepared = status.prepared_proof = None
        if not self._line:
            self.parts.piece.begin(job, self.interruption.begun)
            self.interruption.begin(job.setup.begin)
        self._open(job)
        self._enter(State.RUN)
        context.log("mdi" if self._line else "start", job.source.text if self._line else job.source.name)
        begin = job.setup.begin
        if begin is not None and not begin.single:
            context.log("restart", Message("the program restarts at line {line}", line=begin.line))

    @property
    def will_count(self) -> bool:
        """True if a program is running that will count as a part when it ends."""
        return self.cycle is not None and not (self._line or self._between or self.parts.why_none)

    def disturb(self, why: str) -> None:
        """Mark the part in progress as disturbed, so that it is not counted."""
        if not (self._line or self._between):
            self.parts.piece.disturbed = self.parts.piece.disturbed or why

    def cut(self, seconds: float) -> None:
        """Add ``seconds`` to the cutting time of the tool if it moves at feed. Dry runs do not count."""
        block = self.cycle.current if self.cycle is not None and not self.cycle.at_rest else None
        if block is not None and block.moves and not block.rapid and not self._context.switches.no_count:
            self.counters.cut(tool_of(block.modal.tool), seconds, self._context.spindle_load)

    def leave(self) -> bool:
        """Finish a canceled cycle as soon as the axes are at rest; return True when it is finished."""
        if self.cycle is None or not self.cycle.at_rest:
            return False
        said = "the MDI line was canceled by reset" if self._line else "program canceled by reset"
        kind = "mdi" if self._line else "end"
        self.forget(GIVEN_UP)
        self._enter(State.IDLE)
        self._context.log(kind, said)
        return True

    def forget(self, why: str) -> None:
        """Cancel the run for the reason ``why``.

        A program leaves the modal state that M30 would leave. An MDI line leaves its modes.
        """
        cycle = self.cycle
        if cycle is None:
            self.motion.forget()
            return
        if not (self._line or self._between):
            self.interruption.broke_off(cycle.current, why)
        language = self._context.machine.language
        given_up = modal_given_up(cycle.modal, language)
        self._put_away(modal_interrupted(cycle.modal) if self._line else given_up)

    def drop(self) -> None:
        """Discard the run without calling the drivers, for use after a driver failure."""
        self.cycle = self._source = None
        self._between = False
        self._context.line = 0

    def _put_away(self, left: Modal, *, tool_open: bool = False) -> None:
        """End the run with the modal state ``left`` and apply offsets that were changed during the run."""
        self._stand(left, tool_open=tool_open)
        if not self._line:
            self.status.kept = None
        self.cycle = self._source = None
        self._between = False
        self._context.line = 0
        self.motion.forget()
        self.changed_offsets.take_up(self.status)

    def _stand(self, modal: Modal, *, tool_open: bool = False) -> None:
        """Store the modal state. Units and rapid rate are taken over only from OmniTurn programs."""
        before = self.status.modal
        if self._dialect is not Dialect.OMNITURN:
            modal = modal._replace(metric=before.metric, rapid_rate=before.rapid_rate)
        self.status.modal, self.status.tool_open = modal, tool_open

    def look(self) -> None:
        """Update the state between two cycles, and start the next part of Cycle Repeat if it may start."""
        self.interruption.look(None if self._line or self._between else self.cycle)
        if self.cycle is None:
            self.status.modal = modal_as_machine(self.status.modal, self._context)
        elif self._between and self.status.state in {State.RUN, State.WAIT}:
            self._go_round(self.cycle)

    def _open(self, job: Job) -> None:
        """Start a pass through ``job`` from the present position of the axes."""
        at, _ = self._context.ports.axes.demand_at(self._context.now)
        setup = circumstances(job.setup, at, self._context.terminal)
        self.motion.forget()
        diameter = job.source.dialect is Dialect.SINUMERIK
        begins = Modal(metric=setup.metric, diameter=diameter, rapid_rate=setup.last_rapid)
        if setup.begin is not None:
            begins = setup.begin.checkpoint.modal
        self._source, self._dialect = self._passes(job, setup), job.source.dialect
        self.cycle = Cycle(self._context, self.motion, self._source, begins, self._enter, self._ended)

    def _ended(self, end: ProgramEnd | None) -> None:
        """Handle M30, M02, or the end of an MDI line."""
        if end is not None and end.reset:
            self._end_functions()
        if self._line:
            self._line_ended(end)
            return
        self.parts.ended()
        self.interruption.finished()
        self._between = end is not None and end.reset and self._context.switches.cycle_repeat
        if self.cycle is not None and self._between:
            self._go_round(self.cycle)
        else:
            self._program_ended()

    def _go_round(self, cycle: Cycle) -> None:
        """Start the next part once changed offsets are proved, or log why it does not start."""
        repeat = self._context.switches.cycle_repeat
        if repeat and self.changed_offsets.pending and not self.status.next_barred:
            cycle.wait_for("PROVING WITH THE CHANGED OFFSETS")
            return
        why = self._why_not_again(cycle.modal)
        if why or not repeat:
            self._program_ended(why)
            return
        self.changed_offsets.take_up(self.status)
        self._between = False
        self.counters.cycle = 0.0
        self.counters.begun += 1
        assert self.status.job is not None
        self.interruption.begin(None)
        self._open(self.status.job)
        self._enter(State.RUN)
        self._context.log("repeat", self.status.job.source.name)

    def _why_not_again(self, left: Modal) -> str:
        if self.status.next_barred:
            return self.status.next_barred
        if self.changed_offsets.wanted:
            return self.changed_offsets.refusal(left)
        again = start_conditions.first_move_verdict(
            self._context, self.status, self.counters.begun, repeats=True
        )
        if again is not None and again.code:
            return again.why
        old = outdated(self.status.job, left) if self.status.job is not None else ""
        return Message("{old}, but the program does not specify this setting", old=old) if old else ""

    def _program_ended(self, no_repeat: str = "") -> None:
        if no_repeat:
            self._context.log(
                "refused", Message("the cycle is not repeated: {no_repeat}", no_repeat=no_repeat)
            )
        self._context.log("end", "program end")
        self._put_away(self.modal)
        self._enter(State.IDLE)

    def _line_ended(self, end: ProgramEnd | None) -> None:
        """Store the state that an MDI line leaves for the next line.

        After M30 it is the state after a program.
        """
        source = self._source
        left = source.left() if source is not None and source.left is not None else None
        modal = self.modal if left is None else modal_as_machine(left.modal, self._context)
        self.status.kept = left.kept if left is not None and end is None else None
        self._put_away(modal, tool_open=left is not None and left.tool_line != 0)
        self._enter(State.IDLE)
        self._context.log("mdi", "done")

    @property
    def modal(self) -> Modal:
        """The modal state of the block being executed, or the state in force between two programs."""
        return self.cycle.modal if self.cycle is not None else self.status.modal

    def _end_functions(self) -> None:
        """Stop the spindle and turn off the outputs at M30, except the collet."""
        context = self._context
        context.spindle.stop()
        for name, on in context.ports.io.outputs().items():
            if on and name != "collet":
                context.ports.io.write(name, False)


def _motion_of(context: MachineContext) -> PathMotion:
    """Return the motion by setpoints, or block by block if the controller plans the motion."""
    blocks = context.ports.blocks
    return SetpointMotion(context) if blocks is None else ControllerMotion(context, blocks)
