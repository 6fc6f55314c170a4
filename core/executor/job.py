"""Job: a program under fixed circumstances, its proof, and its blocks by read-ahead for a run.

A proof belongs to one job and to no other.
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
from core.interpreter.dialects import ReadProgram, line_alone
from core.interpreter.omniturn.setup.carry_over import RAPID, UNITS, inherited_settings
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.elementary_blocks import Block, Kind, SectionEnds
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.machine_requirements import Need
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.source import Source
from core.machine.machine_model import Machine
from core.message import Message

WARNING = "WARNING: "
"""What an announcement of something that a proof has warned of begins with."""


class ProgramPass(NamedTuple):
    """One pass through a program: its blocks as they come, and what the interpreter has to say so far.

    ``left`` tells what a line of MDI leaves to the next one; a program has none, it ends with M30 or M02.
    """

    blocks: Iterator[Block]
    problems: Callable[[], Sequence[Diagnostic]]
    left: Callable[[], Checkpoint] | None = None


class ReadAhead:
    """``pending`` belongs to one path section; ``stop`` waits behind it for a standstill (``SectionEnds``).

    Nothing behind ``stop`` is read before it has been carried out, so that a program that asks inputs asks
    them at their time. Each block is checked once more against the machine as it is read.
    """

    def __init__(self, source: ProgramPass, machine: Machine) -> None:
        self._source = source
        self._machine = machine
        self._reported = 0  # problems of the interpreter that were looked at
        self._ends = SectionEnds()
        self.pending: deque[Block] = deque()
        self.seconds = 0.0  # what the pending blocks take at least
        self.stop: Block | None = None
        self.trouble: AlarmError | None = None  # what ends the pass once all before it is done
        self.ended = False

    @property
    def next_block(self) -> Block | None:
        """What comes after the blocks that were taken."""
        return self.pending[0] if self.pending else self.stop

    @property
    def dry(self) -> bool:
        """Nothing more can be pulled before a standstill."""
        return self.stop is not None or self.ended or self.trouble is not None

    def pull(self, blocks: int, seconds: float) -> None:
        """Read on until so many blocks were read or so many seconds are pending, pull-outs of threads too."""
        for _ in range(blocks):
            if self.dry or (self.seconds >= seconds and not self._ends.in_thread):
                return
            block = self._next()
            if block is not None:
                self._sort(block)

    def take(self) -> list[Block]:
        """The pending blocks, for moving."""
        taken = list(self.pending)
        self.pending.clear()
        self.seconds = 0.0
        return taken

    def pass_stop(self) -> None:
        """The standstill has been used: an action is done, a cutting block may start."""
        block, self.stop = self.stop, None
        if block is not None:
            self._ends.rested(block)
            if block.moves:
                self._append(block)

    def _next(self) -> Block | None:
        try:
            block = next(self._source.blocks)
        except StopIteration:
            self._find_error()
            self.ended = True
            return None
        except ProgramError as error:
            self.trouble = AlarmError("program", error.diagnostic.message, error.diagnostic.line)
            return None
        self._find_error()
        return None if self.trouble else block

    def _find_error(self) -> None:
        """An error that the live run met and the proof could not."""
        problems = self._source.problems()
        for problem in problems[self._reported :]:
            if problem.severity is Severity.ERROR and self.trouble is None:
                self.trouble = AlarmError("program", problem.message, problem.line)
        self._reported = len(problems)

    def _sort(self, block: Block) -> None:
        try:
            check_block(block, self._machine)
        except AlarmError as trouble:
            self.trouble = trouble
            return
        if self._ends.rests_before(block):
            self.stop = block
        else:
            self._append(block)

    def _append(self, block: Block) -> None:
        self.pending.append(block)
        self.seconds += nominal_seconds(block)


def nominal_seconds(block: Block) -> float:
    """Seconds the block takes at its programmed speed: never more than it will take."""
    speed = (
        block.feed * abs(block.rpm) / 60.0 if block.per_rev and block.kind is not Kind.RAPID else block.feed
    )
    return block.length / speed if speed > 0.0 else 0.0


# --- checked again before it moves ----------------------------------------------------------------------


def check_block(block: Block, machine: Machine) -> None:
    """Raises AlarmError for a move out of the travel, one fed by the turns of a spindle that stands, and
    one of C while the spindle that is C turns.
    """
    if not block.moves:
        return
    if block.per_rev and block.kind is not Kind.RAPID and block.rpm == 0.0 and block.c == block.c0:
        raise AlarmError(
            "spindle-still", Message("line {line} uses feed per revolution", line=block.line), block.line
        )
    if block.c != block.c0 and block.modal.spindle and machine.spindle_is_c:
        raise AlarmError(
            "c-is-spindle",
            Message("line {line} moves C while the spindle is turning", line=block.line),
            block.line,
        )
    for axis, (low, high) in zip(machine.axes, block.machine_reach(), strict=True):
        least, most = axis.reach
        if low < least or high > most:
            unit = "degrees" if axis.rotary else "mm"
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
    """What is going to run: text, offsets and switches, by value. ``digest`` names exactly this job.

    ``reading`` is its text for whoever goes through it; who proves the job has read it for who runs it.
    """

    source: Source
    setup: Setup
    digest: str
    reading: ReadProgram = field(compare=False, repr=False)
    tools_set: frozenset[int] = frozenset()  # numbers of the tool offsets that somebody has entered
    carries: frozenset[str] = frozenset()  # what the program has from the job before it
    text_digest: str = ""  # of the text alone
    part_of: str = ""  # digest of the program's job, when this one begins in the middle of it


@dataclass(frozen=True, slots=True)
class Proof:
    """What proving said of the job with this digest.

    ``warned`` says in a few words each what may go wrong as far as something is assumed: it refuses no start,
    but is announced before it.
    """

    digest: str
    errors: tuple[str, ...]
    blocks: int = 0
    cycle_time: float = 0.0
    tools: tuple[int, ...] = ()  # offsets the program asks for
    measured: tuple[int, ...] = ()  # those of them that had been set, or that the program measures itself
    needs: tuple[Need, ...] = ()  # what it asks of the machine beyond straight lines
    warned: tuple[str, ...] = ()

    def unset(self, job: Job) -> list[int]:
        """Tools of the program that nobody has measured."""
        return sorted(set(self.tools) - job.tools_set - set(self.measured))


def make_job(source: Source, setup: Setup, whole: Job | None = None) -> Job:
    """The job of this program under these circumstances; of ``whole`` when it begins in the middle of that.

    The digest covers all that the elementary blocks depend on except live inputs and where the slides stand.
    """
    part_of = whole.digest if whole is not None else ""
    circumstances = (
        sorted(setup.tools.items()),
        sorted(setup.secondary.items()),
        sorted(setup.zero.items()),
        sorted(setup.r.items()),
        (
            sorted(setup.limits.m_outputs.items()),
            sorted(setup.limits.m_ignored),
            setup.limits.control,
            setup.limits.third_axis,
            setup.limits.c_linear,
        ),
        (setup.limits.max_feed, setup.limits.max_rpm, setup.limits.resolution),
        (setup.limits.unclamp_while_turning, setup.limits.start_with_collet_open),
        (setup.block_delete, setup.strict, setup.metric, setup.last_rapid),
        (setup.begin.key if setup.begin else "", part_of),
        setup.kinematics,
        [(each.name, each.text) for each in source.subprograms],
    )
    text = hashlib.sha256(f"{source.dialect}\n{source.text}".encode("utf-8", "surrogatepass"))
    alone = text.hexdigest()
    text.update(repr(circumstances).encode())
    reading = whole.reading if whole is not None else ReadProgram(source, strict=setup.strict)
    return Job(
        source,
        setup,
        text.hexdigest(),
        reading,
        frozenset(setup.tools),
        inherited_settings(source),
        alone,
        part_of,
    )


def outdated(job: Job, left: Modal) -> str:
    """Whether the job before has left another unit or rapid rate than this job was proved with; in words."""
    if job.setup.begin is not None:
        return ""
    if UNITS in job.carries and job.setup.metric != left.metric:
        return "the active unit is now mm" if left.metric else "the active unit is now inches"
    if RAPID in job.carries and not math.isclose(job.setup.last_rapid, left.rapid_rate):
        return "the rapid rate has changed"
    return ""


# --- a job interpreted ----------------------------------------------------------------------------------


def interpret(job: Job, setup: Setup) -> ProgramPass:
    """One pass; its blocks end at the first error, which ``problems`` then tells."""
    if setup.begin is not None and setup.begin.single:
        line = line_alone(job.source, setup)
        return ProgramPass(
            line.blocks(to_first_error=True), lambda: line.diagnostics, lambda: line.checkpoint
        )
    interpreter = job.reading.begin(setup)
    return ProgramPass(interpreter.blocks(to_first_error=True), lambda: interpreter.diagnostics)


def circumstances(setup: Setup, start: tuple[float, ...], inputs: Callable[[str], bool]) -> Setup:
    """The job's setup at this machine now: from where the slides stand, with its inputs live."""
    return dataclasses.replace(setup, start=start, inputs=inputs)
