"""Commands that other threads post to the executor's queue, and the clearance for a start.

The executor does not compute geometry. A worker thread of the screen checks the first move of a job from
one axis position, and posts the result as a clearance. The executor ignores a clearance for any other
position.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from core.executor.hand_motion.drive_test import DriveTestMotion
from core.executor.hand_motion.jog_line import Direction
from core.executor.job import Job, Proof
from core.executor.snapshot import InterruptedJob, StartAction
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.plain_value import ValueObject

POSITION_TOLERANCE_MM: Final = (
    0.01  # mm, largest distance between the checked position and the start position
)

START_UNCHECKED: Final = "start-unchecked"
TOOL_IN_PART: Final = "tool-in-part"
FIRST_MOVE_CROSSES: Final = "first-move-crosses"


@dataclass(frozen=True, slots=True)
class StartClearance:
    """The result of checking the first move of a job from one position of the axes.

    - ``job``: digest of the job; ``at``: position in machine coordinates in mm
    - ``begun``: number of runs started before the check, because each run may change the part
    - ``code``: ``TOOL_IN_PART`` or ``FIRST_MOVE_CROSSES`` if the start is refused, otherwise empty
    - ``why``: reason of the refusal for the operator, otherwise empty
    - ``warned``: warning to show before the start if the part's shape is unknown or assumed
    - ``is_for_repeat``: whether the move starts at the program's end position, for Cycle Repeat
    """

    job: str
    at: tuple[float, ...]
    begun: int
    code: str = ""
    why: str = ""
    warned: str = ""
    is_for_repeat: bool = False

    def applies_to(self, job_digest: str, position: Sequence[float], run_count: int) -> bool:
        """Return whether this clearance is valid for starting this job from ``position``.

        ``run_count`` is the number of runs that have started.
        """
        if self.job != job_digest or (self.begun != run_count and not self.is_for_repeat):
            return False
        return all(abs(a - b) <= POSITION_TOLERANCE_MM for a, b in zip(self.at, position, strict=False))


def find_start_clearance(
    clearances: Iterable[StartClearance],
    job_digest: str,
    position: Sequence[float],
    run_count: int,
    *,
    for_repeat: bool = False,
) -> StartClearance | None:
    """Return the clearance to start this job from ``position``, or None if it is not computed yet.

    If ``for_repeat`` is True, only clearances for Cycle Repeat are searched.
    """
    found = (
        each
        for each in clearances
        if each.is_for_repeat is for_repeat and each.applies_to(job_digest, position, run_count)
    )
    return next(found, None)


class Command(ValueObject):
    """Base class of all commands that can be posted to the executor.

    Some commands must be copied with a different job. These are dataclasses.
    """

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class LoadJob(Command):
    """A command that loads the job that Cycle Start runs.

    Cycle Start is refused until a proof of this job is available.
    """

    job: Job
    proof: Proof | None = None


class SupplyJobProof(Command):
    """A command that supplies the proof of the loaded job if proving finished only after loading."""

    __slots__ = __match_args__ = ("proof",)

    def __init__(self, proof: Proof) -> None:
        self.proof: Final = proof


@dataclass(frozen=True, slots=True)
class ChangeOffsets(Command):
    """A command to use changed offsets for the loaded program, starting with the next part.

    The command may arrive while the program runs. The part in progress then uses its current offsets to the
    end. A command without a proof only announces the change. No part starts until a second command supplies
    either the job with its proof, or ``failure_reason``, the reason why the job cannot be proved.
    """

    job: Job | None = None
    proof: Proof | None = None
    failure_reason: str = ""  # why the job cannot be proved


class ReportInterruptedJob(Command):
    """A command that reports the job that was interrupted when the previous control process ended.

    ``logged`` is True if the interruption is already in the event log.
    """

    __slots__ = __match_args__ = ("left", "logged")

    def __init__(self, left: InterruptedJob, logged: bool = False) -> None:
        self.left: Final = left
        self.logged: Final = logged


class CycleStart(Command):
    """A command that starts a cycle, or resumes it after a feed hold, single block, M00 or M01.

    The two-hand relay of the operator station has the same effect.
    """

    __slots__ = ()


class FeedHold(Command):
    """A command that stops the axes on the path.

    The axes stop within the commit time, in which queued setpoints can no longer be changed, plus the
    braking time v/a. ``by`` is the source of the request, for the log. ``press`` is the number of the key
    press, or 0 if unknown. A press that arrives twice causes only one feed hold.
    """

    __slots__ = __match_args__ = ("by", "press")

    def __init__(self, by: str = "", press: int = 0) -> None:
        self.by: Final = by
        self.press: Final = press

    def __eq__(self, other: object) -> bool:
        """Return whether the other command is also a feed hold; its source does not matter."""
        return isinstance(other, FeedHold)

    def __hash__(self) -> int:
        return hash(FeedHold)


class Reset(Command):
    """A command that stops the axes, cancels the program and returns to its first line.

    The command also acknowledges an alarm.
    """

    __slots__ = ()


class EnableDrives(Command):
    """A command that switches the drives on after an E-stop or at power-up."""

    __slots__ = ()


class SetSwitch(Command):
    """A command that turns one of the operator's switches on or off.

    The switches are ``single_block``, ``optional_stop``, ``cycle_repeat`` and ``no_count``. They take
    effect at once.
    """

    __slots__ = __match_args__ = ("name", "on")

    def __init__(self, name: str, on: bool) -> None:
        self.name: Final = name
        self.on: Final = on


class SetFeedOverride(Command):
    """A command that sets the feed override as a fraction of the programmed feed, from 0 to 1.5."""

    __slots__ = __match_args__ = ("fraction",)

    def __init__(self, fraction: float) -> None:
        self.fraction: Final = fraction


class Jog(Command):
    """A command that moves one axis at a signed velocity (mm/s or degrees/s) until its lease expires.

    The sender must renew the lease (in seconds) before it expires, or the axis stops. In a tilted plane
    (3D-ROT), ``along`` is the direction vector of this axis in the machine's X, Y and Z.
    """

    __slots__ = __match_args__ = ("axis", "velocity", "lease", "while_on", "along")

    def __init__(
        self, axis: str, velocity: float, lease: float, while_on: str = "", along: Direction | None = None
    ) -> None:
        self.axis: Final = axis
        self.velocity: Final = velocity
        self.lease: Final = lease
        self.while_on: Final = while_on  # an input that must stay on, such as a jog button next to the axes
        self.along: Final = along


class TouchOffTool(Command):
    """A command that touches the tool setter along ``axis`` in the direction ``sign`` (+1 or -1).

    The touch-off lasts only as long as the lease, which is in seconds and must be renewed by the sender.
    ``press`` is the number of the key press. A touch-off that has ended does not start again until the key
    is pressed again.
    """

    __slots__ = __match_args__ = ("axis", "sign", "lease", "press", "while_on")

    def __init__(self, axis: str, sign: int, lease: float, press: int, while_on: str = "") -> None:
        self.axis: Final = axis
        self.sign: Final = sign
        self.lease: Final = lease
        self.press: Final = press
        self.while_on: Final = while_on


class JogByStep(Command):
    """A command that moves one axis by exactly ``distance`` at ``speed``.

    The units are mm and mm/s, or degrees and degrees/s. The step is refused while an axis moves, or if the
    full step would exceed the travel limits. ``along`` is described in ``Jog``.
    """

    __slots__ = __match_args__ = ("axis", "distance", "speed", "along")

    def __init__(self, axis: str, distance: float, speed: float, along: Direction | None = None) -> None:
        self.axis: Final = axis
        self.distance: Final = distance
        self.speed: Final = speed
        self.along: Final = along


class StopJog(Command):
    """A command that ends a jog or a step immediately, without waiting for the lease to expire."""

    __slots__ = ()


class RunDriveTest(Command):
    """A command that runs a drive test from rest until its lease (in seconds) expires.

    ``StopJog`` ends the test. The test is refused while an axis moves or the spindle turns, or if its full
    travel would exceed the travel limits.
    """

    __slots__ = __match_args__ = ("path", "lease")

    def __init__(self, path: DriveTestMotion, lease: float) -> None:
        self.path: Final = path
        self.lease: Final = lease


class RenewDriveTest(Command):
    """A command that renews the lease (in seconds) of the active drive test. It never starts a test."""

    __slots__ = __match_args__ = ("lease",)

    def __init__(self, lease: float) -> None:
        self.lease: Final = lease


class SelectHandwheel(Command):
    """A command that lets the handwheel move ``axis`` by ``step`` (mm or degrees) per click.

    The sender must renew the lease (in seconds), or the handwheel becomes inactive. Clicks before the
    command are ignored, and so are clicks that the axis is too slow to follow. If the control ends the
    motion, the handwheel stays disabled until ``DeselectHandwheel``.
    """

    __slots__ = __match_args__ = ("axis", "step", "lease")

    def __init__(self, axis: str, step: float, lease: float) -> None:
        self.axis: Final = axis
        self.step: Final = step
        self.lease: Final = lease


class DeselectHandwheel(Command):
    """A command that deselects the handwheel and stops the axis that it moves."""

    __slots__ = ()


class SetSpindleLimit(Command):
    """A command that sets the operator's spindle speed limit (rpm) from page F10.

    None selects the machine's maximum. The limit applies until TurnDesk is restarted.
    """

    __slots__ = __match_args__ = ("rpm",)

    def __init__(self, rpm: float | None) -> None:
        self.rpm: Final = rpm


class HomeAxes(Command):
    """A command that homes ``axis``, or all unhomed axes if ``axis`` is empty."""

    __slots__ = __match_args__ = ("axis",)

    def __init__(self, axis: str = "") -> None:
        self.axis: Final = axis


class UseOffsetTables(Command):
    """A command that makes the position display and MDI use changed offset tables.

    The command is refused while a program runs, because the program uses the offsets with which it was
    proved.
    """

    __slots__ = __match_args__ = ("tools", "secondary")

    def __init__(self, tools: Mapping[int, ToolOffset], secondary: Mapping[int, SecondaryOffset]) -> None:
        self.tools: Final = tools
        self.secondary: Final = secondary


class StopSpindle(Command):
    """A command that stops a spindle left running by MDI or M02. It is refused while a program runs."""

    __slots__ = ()


class ForceOutput(Command):
    """A command that switches one output manually from the test page.

    It is refused unless the machine is at rest.
    """

    __slots__ = __match_args__ = ("name", "on")

    def __init__(self, name: str, on: bool) -> None:
        self.name: Final = name
        self.on: Final = on


class ConfirmStart(Command):
    """A command that confirms a start at the first line after a job was interrupted.

    ``at`` is the time of the interruption that the operator has confirmed. The confirmation is valid for
    one start, for 60 s at most, and only while the machine remains idle. If ``at`` is empty, the command
    withdraws the confirmation.
    """

    __slots__ = __match_args__ = ("at",)

    def __init__(self, at: str) -> None:
        self.at: Final = at


class SetPartCount(Command):
    """A command that sets the number of finished parts of the loaded program."""

    __slots__ = __match_args__ = ("parts",)

    def __init__(self, parts: int) -> None:
        self.parts: Final = parts


class ReplaceStartClearances(Command):
    """A command that replaces all clearances for the first move of the next start."""

    __slots__ = __match_args__ = ("clearances",)

    def __init__(self, clearances: tuple[StartClearance, ...]) -> None:
        self.clearances: Final = clearances


class PreventNextPart(Command):
    """A command that prevents the start of the next part, for the reason ``why``.

    An empty ``why`` permits the start again. Restarts and MDI remain possible.
    """

    __slots__ = __match_args__ = ("why",)

    def __init__(self, why: str) -> None:
        self.why: Final = why


@dataclass(frozen=True, slots=True)
class PrepareCycleStart(Command):
    """A command that selects what the next Cycle Start runs: the program, a restart or an MDI line.

    An MDI line needs a job with its proof. ``StartAction.MDI_LINE`` without a job means that MDI is open
    but no line is ready, so Cycle Start does nothing. ``clearance`` is the check of the first move of a
    restart or an MDI line. The command is refused while a cycle runs.
    """

    starts: StartAction = StartAction.PROGRAM
    job: Job | None = None
    proof: Proof | None = None
    clearance: StartClearance | None = None


MOTION_COMMAND_TYPES = (
    CycleStart,
    RunDriveTest,
    EnableDrives,
    HomeAxes,
    Jog,
    JogByStep,
    TouchOffTool,
    SelectHandwheel,
)
BLOCKING_COMMANDS = (
    EnableDrives,
    HomeAxes,
    Reset,
)  # a driver returns from these only when its drives have obeyed
