"""What may be asked of the executor, posted to its queue and never awaited; what a start carries.

The executor computes no geometry. A worker of the screen computes the verdict for one job at one position of
the axes and posts it; the executor only compares. A verdict for another position is no verdict.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from core.executor.hand_motion.drive_test import DriveTestPath
from core.executor.hand_motion.jog_line import Direction
from core.executor.job import Job, Proof
from core.executor.snapshot import InterruptedJob, Starts
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset

SAME: Final = 0.01  # mm: a verdict for a position farther away than this does not count

UNCHECKED: Final = "start-unchecked"
INSIDE: Final = "tool-in-part"
CROSSES: Final = "first-move-crosses"


@dataclass(frozen=True, slots=True)
class Clearance:
    """The verdict on a start of the job with this digest, with the axes at ``at`` (machine mm).

    ``begun`` is the number of runs that had begun by then: a run may change the part. ``code`` is ``INSIDE``
    or ``CROSSES`` where the start is refused, with the sentence ``why``; both are empty where it is clear.
    ``warned`` is announced before the start: the part is not known, or is assumed. ``repeats`` marks the
    position at which the program ends, from which Cycle Repeat begins.
    """

    job: str
    at: tuple[float, ...]
    begun: int
    code: str = ""
    why: str = ""
    warned: str = ""
    repeats: bool = False

    def applies_to(self, job: str, at: Sequence[float], begun: int) -> bool:
        """Return whether this is the verdict on a start of this job here and now."""
        if self.job != job or (self.begun != begun and not self.repeats):
            return False
        return all(abs(a - b) <= SAME for a, b in zip(self.at, at, strict=False))


def verdict(
    known: Iterable[Clearance], job: str, at: Sequence[float], begun: int, *, repeats: bool = False
) -> Clearance | None:
    """Return the verdict on this start, None: it has not been computed yet."""
    found = (each for each in known if each.repeats is repeats and each.applies_to(job, at, begun))
    return next(found, None)


class Command:
    """Whatever may be posted; all of them are below."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class LoadJob(Command):
    """Make this the program that Cycle Start runs; without a proof of this very job start is refused."""

    job: Job
    proof: Proof | None = None


@dataclass(frozen=True, slots=True)
class GiveProof(Command):
    """The proof of the loaded job, when proving took longer than loading."""

    proof: Proof


@dataclass(frozen=True, slots=True)
class Renew(Command):
    """The offsets of the loaded program have changed: from the next part on it is this job.

    It may come while the program is under way, which keeps its offsets to the end of the part. Without a
    proof it is an announcement: nothing is begun before the job with its proof, or ``trouble``, follows.
    """

    job: Job | None = None
    proof: Proof | None = None
    trouble: str = ""  # why there will be none


@dataclass(frozen=True, slots=True)
class LeftInterrupted(Command):
    """What the control before has left interrupted; ``logged``: the log has it already."""

    left: InterruptedJob
    logged: bool = False


@dataclass(frozen=True, slots=True)
class CycleStart(Command):
    """Start, or go on after hold, single block, M00, M01. The station's two-hand relay means the same."""


@dataclass(frozen=True, slots=True)
class FeedHold(Command):
    """Come to rest on the path within commit + v/a. ``by`` tells the log who or what asked for it.

    ``press`` numbers the press of the key, where it is known. One press that arrives twice holds once.
    """

    by: str = field(default="", compare=False)
    press: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Reset(Command):
    """Stop, give the program up, back to its first line; also acknowledges an alarm."""


@dataclass(frozen=True, slots=True)
class EnableDrives(Command):
    """After E-stop or power-up: switch the drives on."""


@dataclass(frozen=True, slots=True)
class SetSwitch(Command):
    """``single_block``, ``optional_stop``, ``cycle_repeat``, ``no_count``: lit words that act at once."""

    name: str
    on: bool


@dataclass(frozen=True, slots=True)
class FeedOverride(Command):
    """Fraction 0…1.5 of the programmed feed."""

    fraction: float


@dataclass(frozen=True, slots=True)
class Jog(Command):
    """Move one axis while the lease lasts; mm/s or degrees/s, signed. Renewed before it ends, or it ends.

    ``along``: the axis of this name of a tilted plane (3D-ROT), as its direction in the machine's X Y Z.
    """

    axis: str
    velocity: float
    lease: float
    while_on: str = ""  # an input that has to stay on: a button beside the slides
    along: Direction | None = None


@dataclass(frozen=True, slots=True)
class Touch(Command):
    """Touch the tool setter off along ``axis``, towards + or − as ``sign``, while the lease lasts. Renewed.

    ``press`` numbers the press of the key that is held: what has ended is not begun again by that one.
    """

    axis: str
    sign: int
    lease: float
    press: int
    while_on: str = ""


@dataclass(frozen=True, slots=True)
class JogStep(Command):
    """Move one axis by exactly ``distance``, mm or degrees, at ``speed``, mm/s or degrees/s, and rest there.

    Refused while anything moves, and where the whole of it would leave the travel. ``along`` as of ``Jog``.
    """

    axis: str
    distance: float
    speed: float
    along: Direction | None = None


@dataclass(frozen=True, slots=True)
class JogStop(Command):
    """Give the jog lease back at once; a step that is under way ends short."""


@dataclass(frozen=True, slots=True)
class DriveTest(Command):
    """Play a drive test from rest while the lease lasts; ``JogStop`` ends it.

    Refused while anything moves or the spindle turns, and where the whole of it would leave the travel.
    """

    path: DriveTestPath
    lease: float


@dataclass(frozen=True, slots=True)
class DriveTestOn(Command):
    """Renew the lease of the drive test that is under way; it never begins one."""

    lease: float


@dataclass(frozen=True, slots=True)
class Wheel(Command):
    """The handwheel moves ``axis`` by ``step`` a click, mm or degrees, while the lease lasts. Renewed.

    What the wheel has counted before moves nothing, nor what it counts faster than the axis goes. An end that
    the control had to make lasts until ``WheelOff``.
    """

    axis: str
    step: float
    lease: float


@dataclass(frozen=True, slots=True)
class WheelOff(Command):
    """The handwheel moves nothing any more; what it moves stops."""


@dataclass(frozen=True, slots=True)
class SpindleLimit(Command):
    """F10: maximum spindle speed until restart, rpm; None: the machine's own."""

    rpm: float | None


@dataclass(frozen=True, slots=True)
class Home(Command):
    """Look for the home of one axis, or of all that do not know their position when ``axis`` is empty."""

    axis: str = ""


@dataclass(frozen=True, slots=True)
class UseOffsets(Command):
    """The tables of offsets have changed: position display and MDI go by them from now on.

    Refused while a program is under way, which keeps the offsets that it was proved with.
    """

    tools: Mapping[int, ToolOffset]
    secondary: Mapping[int, SecondaryOffset]


@dataclass(frozen=True, slots=True)
class SpindleStop(Command):
    """Stop the spindle that MDI or an M02 has left turning; refused while a program is under way."""


@dataclass(frozen=True, slots=True)
class ForceOutput(Command):
    """Switch one output by hand, for the test page; only while nothing is under way."""

    name: str
    on: bool


@dataclass(frozen=True, slots=True)
class ConfirmStart(Command):
    """The operator has read which job was interrupted (its ``at``), and means to start at the first line.

    It counts for the next start, for a minute, and until the machine does anything else; an empty ``at``
    takes it back.
    """

    at: str


@dataclass(frozen=True, slots=True)
class PartsMade(Command):
    """So many parts of the loaded program are made; for the number of the part that is under way."""

    parts: int


@dataclass(frozen=True, slots=True)
class GiveClearance(Command):
    """The verdicts on the first move of the next start; they take the place of all earlier ones."""

    clearances: tuple[Clearance, ...]


@dataclass(frozen=True, slots=True)
class BarNextPart(Command):
    """No other part begins after the one under way, and why; empty: another may. Restarts and MDI may."""

    why: str


@dataclass(frozen=True, slots=True)
class Prepare(Command):
    """What the next Cycle Start begins: the program, a restart in it, or a line of MDI with its proof.

    ``clearance`` is the verdict on the first move of a restart or a line.
    ``Starts.LINE`` without a job: MDI is open and no line is ready, so that nothing starts. Refused while
    something is under way.
    """

    starts: Starts = Starts.PROGRAM
    job: Job | None = None
    proof: Proof | None = None
    clearance: Clearance | None = None
