"""Job: a program under fixed circumstances, its proof, and its blocks as it is interpreted for a run.

A proof belongs to one job and to no other.
"""

from __future__ import annotations

import dataclasses
import hashlib
import math
from collections.abc import Callable
from dataclasses import dataclass, field

from core.executor.read_ahead import ProgramPass
from core.interpreter.dialects import ReadProgram, line_alone
from core.interpreter.job_setup import Setup
from core.interpreter.machine_requirements import Need
from core.interpreter.modal_state import Modal
from core.interpreter.omniturn.carry_over import RAPID, UNITS, inherited_settings
from core.language.source import Source


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


WARNING = "WARNING: "
"""What an announcement of something that a proof has warned of begins with."""


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
