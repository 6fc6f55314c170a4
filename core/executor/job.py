"""Jobs, their proofs, and the reader that reads blocks ahead of the motion.

A proof is valid only for the job whose digest it contains.
"""

from __future__ import annotations

import dataclasses
import hashlib
import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from core.executor.raised_alarm import AlarmError
from core.interpreter.dialects import SharedProgram, interpret_mdi_line
from core.interpreter.omniturn.setup.inherited_state import RAPID, UNITS, find_inherited_settings
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.elementary_blocks import Block, BlockKind, SectionEndDetector
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.machine_requirements import MachineRequirement
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.message import Message

WARNING_PREFIX = "WARNING: "
"""Start of an announcement about a warning from a proof."""


class ProgramPass(NamedTuple):
    """One pass through a program: an iterator of its blocks, and the diagnostics found so far.

    ``make_checkpoint`` returns the state that an MDI line passes to the next MDI line. It is None for a
    program, which ends with M30 or M02.
    """

    block_iterator: Iterator[Block]
    get_diagnostics: Callable[[], Sequence[Diagnostic]]
    make_checkpoint: Callable[[], Checkpoint] | None = None


class ReadAheadQueue:
    """Reader that reads the blocks of a program pass ahead of the motion.

    - ``pending_blocks`` are the blocks of one path section.
    - ``stop`` is the next block that needs a standstill (``SectionEndDetector``). Later blocks are read
      only after it has been executed, so that the program reads inputs at the correct time.
    - Each block is checked against the machine again when it is read.
    """

    def __init__(self, source: ProgramPass, machine: Machine) -> None:
        self._source = source
        self._machine = machine
        self._reported = 0  # number of interpreter diagnostics already checked
        self._ends = SectionEndDetector()
        self.pending_blocks: deque[Block] = deque()
        self.pending_motion_s = 0.0  # shortest possible time of the pending blocks
        self.stop: Block | None = None
        # the error that ends the pass after the earlier blocks are done
        self.read_error: AlarmError | None = None
        self.is_at_end = False

    @property
    def next_block(self) -> Block | None:
        """Return the next block that is still in the queue, or None if the queue is empty."""
        return self.pending_blocks[0] if self.pending_blocks else self.stop

    @property
    def is_exhausted(self) -> bool:
        """Return whether no more blocks can be read before a standstill."""
        return self.stop is not None or self.is_at_end or self.read_error is not None

    def read_blocks(self, max_block_count: int, max_motion_s: float) -> None:
        """Read up to ``max_block_count`` blocks, until ``max_motion_s`` seconds of motion are pending.

        A thread is always read to the end of its pull-out, even if the pending motion is then longer.
        """
        for _ in range(max_block_count):
            if self.is_exhausted or (
                self.pending_motion_s >= max_motion_s and not self._ends.is_in_thread_pass
            ):
                return
            block = self._next()
            if block is not None:
                self._sort(block)

    def pop_pending_blocks(self) -> list[Block]:
        """Remove the pending blocks from the reader and return them, so that they can be executed."""
        taken = list(self.pending_blocks)
        self.pending_blocks.clear()
        self.pending_motion_s = 0.0
        return taken

    def release_stop(self) -> None:
        """Continue after the standstill, when its action is complete or its cutting block may start."""
        block, self.stop = self.stop, None
        if block is not None:
            self._ends.record_standstill(block)
            if block.moves:
                self._append(block)

    def _next(self) -> Block | None:
        try:
            block = next(self._source.block_iterator)
        except StopIteration:
            self._find_error()
            self.is_at_end = True
            return None
        except ProgramError as error:
            self.read_error = AlarmError("program", error.diagnostic.message, error.diagnostic.line)
            return None
        self._find_error()
        return None if self.read_error else block

    def _find_error(self) -> None:
        """Store the first new error of the interpreter.

        Only a real run, not the proof, can cause such an error.
        """
        problems = self._source.get_diagnostics()
        for problem in problems[self._reported :]:
            if problem.severity is Severity.ERROR and self.read_error is None:
                self.read_error = AlarmError("program", problem.message, problem.line)
        self._reported = len(problems)

    def _sort(self, block: Block) -> None:
        try:
            check_block(block, self._machine)
        except AlarmError as error:
            self.read_error = error
            return
        if self._ends.needs_standstill_before(block):
            self.stop = block
        else:
            self._append(block)

    def _append(self, block: Block) -> None:
        self.pending_blocks.append(block)
        self.pending_motion_s += compute_nominal_duration_s(block)


def compute_nominal_duration_s(block: Block) -> float:
    """Return the duration of a block at its programmed speed, in seconds.

    The actual duration is never shorter.
    """
    speed = (
        block.feed * abs(block.rpm) / 60.0
        if block.per_rev and block.kind is not BlockKind.RAPID
        else block.feed
    )
    return block.length / speed if speed > 0.0 else 0.0


# --- checks before a move -------------------------------------------------------------------------------


def check_block(block: Block, machine: Machine) -> None:
    """Check a block again before it moves an axis.

    Raises AlarmError in three cases: The block exceeds the travel limits. It moves C while the spindle
    turns, and the spindle is the C axis. It is not a rapid, uses feed per revolution with a stopped
    spindle, and does not move C.
    """
    if not block.moves:
        return
    if block.per_rev and block.kind is not BlockKind.RAPID and block.rpm == 0.0 and block.c == block.c0:
        raise AlarmError(
            "spindle-still", Message("line {line} uses feed per revolution", line=block.line), block.line
        )
    if block.c != block.c0 and block.modal.spindle and machine.is_spindle_c_axis:
        raise AlarmError(
            "c-is-spindle",
            Message("line {line} moves C while the spindle is turning", line=block.line),
            block.line,
        )
    for axis, (low, high) in zip(machine.axes, block.compute_machine_bounds(), strict=True):
        least, most = axis.travel_with_margin
        if low < least or high > most:
            unit = "degrees" if axis.is_rotary else "mm"
            far = low if low < least else high
            raise AlarmError(
                "travel",
                Message(
                    "line {line} moves {axis} beyond its travel, to {distance} {unit} from home",
                    line=block.line,
                    axis=axis.name,
                    distance=f"{far:.3f}",
                    unit=unit,
                ),
                block.line,
            )


@dataclass(frozen=True, slots=True)
class Job:
    """A program with its offsets, units and switches, as immutable values.

    ``digest`` identifies exactly this job. ``shared_program`` is the parsed text, which the proof and the
    run share.
    """

    source: ProgramSource
    setup: InterpreterSetup
    digest: str
    shared_program: SharedProgram = field(compare=False, repr=False)
    entered_tool_numbers: frozenset[int] = frozenset()  # numbers of the tool offsets that have been entered
    retained_settings: frozenset[str] = (
        frozenset()
    )  # settings that the program inherits from the previous job
    text_digest: str = ""  # digest of the text alone
    parent_digest: str = ""  # digest of the whole program's job if this job starts in its middle


@dataclass(frozen=True, slots=True)
class Proof:
    """The result of proving the job that has the same digest.

    ``warnings`` contains short warnings about assumed values, which are shown before the start but do not
    prevent it.
    """

    digest: str
    errors: tuple[str, ...]
    block_count: int = 0
    cycle_time_s: float = 0.0
    tool_numbers: tuple[int, ...] = ()  # tool offsets that the program uses
    measured_tools: tuple[int, ...] = ()  # those that are set or that the program measures itself
    required_functions: tuple[
        MachineRequirement, ...
    ] = ()  # machine functions that the program needs beyond straight lines
    warnings: tuple[str, ...] = ()

    def unset(self, job: Job) -> list[int]:
        """Return the numbers of the tools without an offset that the program does not measure either."""
        return sorted(set(self.tool_numbers) - job.entered_tool_numbers - set(self.measured_tools))


def make_job(source: ProgramSource, setup: InterpreterSetup, whole_job: Job | None = None) -> Job:
    """Return the job of a program with its setup.

    If the job starts in the middle of a program, ``whole_job`` is the job of the whole program. The digest
    covers everything that affects the elementary blocks, except live inputs and the axis positions.
    """
    part_of = whole_job.digest if whole_job is not None else ""
    circumstances = (
        sorted(setup.tools.items()),
        sorted(setup.secondary.items()),
        sorted(setup.zero.items()),
        sorted(setup.r.items()),
        (
            sorted(setup.limits.m_code_outputs.items()),
            sorted(setup.limits.ignored_m_codes),
            setup.limits.control_model,
            setup.limits.third_axis_name,
            setup.limits.is_c_linear,
        ),
        (setup.limits.max_feed_mm_s, setup.limits.max_rpm, setup.limits.resolution_mm),
        (setup.limits.can_unclamp_while_turning, setup.limits.can_start_with_collet_open),
        (setup.block_delete, setup.strict, setup.metric, setup.last_rapid),
        (setup.begin.key if setup.begin else "", part_of),
        setup.kinematics,
        [(each.name, each.text) for each in source.subprograms],
    )
    text = hashlib.sha256(f"{source.dialect}\n{source.text}".encode("utf-8", "surrogatepass"))
    alone = text.hexdigest()
    text.update(repr(circumstances).encode())
    reading = (
        whole_job.shared_program if whole_job is not None else SharedProgram(source, strict=setup.strict)
    )
    return Job(
        source,
        setup,
        text.hexdigest(),
        reading,
        frozenset(setup.tools),
        find_inherited_settings(source),
        alone,
        part_of,
    )


def find_outdated_setting(job: Job, present_modal: ModalState) -> str:
    """Return how the current units or rapid rate differ from the proof, or an empty string if equal.

    The previous job may have changed the units or the rapid rate.
    """
    if job.setup.begin is not None:
        return ""
    if UNITS in job.retained_settings and job.setup.metric != present_modal.metric:
        return "the active unit is now mm" if present_modal.metric else "the active unit is now inches"
    if RAPID in job.retained_settings and not math.isclose(job.setup.last_rapid, present_modal.rapid_rate):
        return "the rapid rate has changed"
    return ""


# --- interpretation of a job ----------------------------------------------------------------------------


def start_program_pass(job: Job, setup: InterpreterSetup) -> ProgramPass:
    """Start one pass through a job.

    The blocks end at the first error; ``get_diagnostics`` then returns this error.
    """
    if setup.begin is not None and setup.begin.is_mdi_line:
        line = interpret_mdi_line(job.source, setup)
        return ProgramPass(
            line.generate_blocks(stops_at_first_error=True), lambda: line.diagnostics, lambda: line.checkpoint
        )
    interpreter = job.shared_program.start_pass(setup)
    return ProgramPass(
        interpreter.generate_blocks(stops_at_first_error=True), lambda: interpreter.diagnostics
    )


def make_start_setup(
    setup: InterpreterSetup, start: tuple[float, ...], is_input_on: Callable[[str], bool]
) -> InterpreterSetup:
    """Return the setup of a job with the start position of the axes and the live inputs."""
    return dataclasses.replace(setup, start=start, inputs=is_input_on)
