"""The state of the control between two ticks: job, alarms, modal state and part count."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from core.executor.commands import Clearance
from core.executor.job import Job, Proof
from core.executor.machine_context import MachineContext
from core.executor.snapshot import Alarm, Event, InterruptedJob, Starts, State
from core.interpreter.omniturn.setup.carry_over import after_end
from core.interpreter.shared.checkpoint import KeptPass
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.interpreter.shared.modal_state import Modal
from core.message import Message


@dataclass(slots=True)
class Counters:
    """Counts and times since the start of the executor. Times are in seconds and exclude stops."""

    parts: int = 0
    # finished parts of the loaded program: the number set with ``PartsMade`` plus the parts made since
    made: int = 0
    ends: int = 0  # programs that ran to their end, counted or not
    lines: int = 0  # MDI lines that were started
    begun: int = 0  # runs that were started: programs, repeats, restarts and MDI lines
    underruns: int = 0
    cycle: float = 0.0
    last_cycle: float = 0.0
    timed: int = 0  # number of complete cycles; ``last_cycle`` is the time of the latest
    # seconds at feed by tool number, without dry runs
    cutting: Mapping[int, float] = field(default_factory=dict)

    borne: tuple[float, float] = (0.0, 0.0)  # spindle load at feed in this part: per cent · s, and s

    def cut(self, tool: int, seconds: float, load: float | None = None) -> None:
        """Add cutting time at feed for a tool, and the spindle load in per cent if it is known.

        The mapping of cutting times is replaced, so that earlier copies do not change.
        """
        self.cutting = {**self.cutting, tool: self.cutting.get(tool, 0.0) + seconds}
        if load is not None:
            self.borne = self.borne[0] + load * seconds, self.borne[1] + seconds

    def take_load(self) -> float | None:
        """Return the mean spindle load at feed in the part that ends, in per cent, or None if it is unknown.

        The call resets the sum for the next part.
        """
        (borne, seconds), self.borne = self.borne, (0.0, 0.0)
        return borne / seconds if seconds > 0.0 else None


@dataclass(slots=True)
class ControlStatus:
    """State, program and alarms of the machine."""

    state: State = State.DISABLED
    job: Job | None = None
    proof: Proof | None = None
    alarms: tuple[Alarm, ...] = ()
    power_off: bool = False  # an alarm has switched the drives off
    start_refused: str = ""
    start_code: str = ""  # code of the refusal if the first move caused it
    starts: Starts = Starts.PROGRAM
    prepared: Job | None = None  # the restart or the MDI line that Cycle Start begins
    prepared_proof: Proof | None = None
    checks_starts: bool = False  # a cycle starts only with a clearance for its first move
    clearances: tuple[Clearance, ...] = ()  # clearances for the program
    prepared_clearance: Clearance | None = None  # clearance for the prepared job
    next_barred: str = ""  # why no other part may start, as posted with ``BarNextPart``
    tool_open: bool = False  # MDI has called a tool that has not moved yet
    kept: KeptPass[Any] | None = None  # state that MDI lines in other languages have left in force
    interrupted: InterruptedJob | None = None  # a program that did not reach its end
    modal: Modal = field(default_factory=Modal)  # modal state in force between programs


# --- modal state between programs -----------------------------------------------------------------------


def modal_at_power_up(context: MachineContext) -> Modal:
    """Return the modal state at power-up, with the units of the machine file.

    A SINUMERIK control powers up with DIAMON.
    """
    machine = context.machine
    begins = Modal(
        metric=not machine.inch,
        diameter=machine.language == "sinumerik",
        rapid_rate=machine.limits.manual_rapid,
    )
    return modal_as_machine(begins, context)


def modal_given_up(modal: Modal, language: str = "omniturn") -> Modal:
    """Return the modal state after a program was canceled by Reset, an alarm or an E-stop.

    The result equals the state after M30. On a SINUMERIK control, the power-up mode of diameter words applies
    again.
    """
    return after_end(modal, modal.rpm, reset=True)._replace(diameter=language == "sinumerik")


def modal_interrupted(modal: Modal) -> Modal:
    """Return the modal state after an MDI line was canceled.

    Its modes remain, but C and the spindle are released.
    """
    return modal._replace(c_locked=False, c_rpm=None, oriented=None)


def modal_as_machine(modal: Modal, context: MachineContext) -> Modal:
    """Return the modal state with the M functions as they are at the machine now.

    An alarm, a reset or a manual action may have switched them. A stopped spindle releases C. Nose
    compensation and plane switching end with their program.
    """
    on = {name for name, lit in context.ports.io.outputs().items() if lit}
    assigned = {name for name, _ in context.machine.m_codes.values()} | {context.machine.live_output}
    asked = context.spindle.asked
    return modal._replace(
        spindle=modal.spindle if asked else 0,
        c_locked=modal.c_locked and not asked,
        oriented=context.spindle.orientation.at,
        coolant="coolant" in on,
        collet_closed="collet" in on if "collet" in context.machine.outputs else modal.collet_closed,
        outputs=frozenset(on & assigned),
        nose_comp=40,
        mill=None,
    )


def modal_with_offsets(
    modal: Modal, tools: Mapping[int, ToolOffset], secondary: Mapping[int, SecondaryOffset]
) -> Modal:
    """Return the modal state with the offsets of its tool and its D number read from the given tables."""
    tool = tools.get(modal.tool, ToolOffset()) if modal.tool else ToolOffset()
    pair = secondary.get(modal.secondary, SecondaryOffset()) if modal.secondary else SecondaryOffset()
    return modal._replace(tool_x=tool.x, tool_z=tool.z, secondary_x=pair.x, secondary_z=pair.z)


class Workpiece:
    """The workpiece in progress. A program from its first line starts a new one; a restart continues it.

    Elementary blocks have the same numbers in a run and in its restart, so the numbers show whether a restart
    skipped blocks. A workpiece is not counted as a part if blocks were skipped, or if the spindle or an
    output was off although the program had turned it on. The operator can add a good part to the count on
    page F10.
    """

    def __init__(self) -> None:
        self._begun = 0  # number of blocks started without a gap
        self._whole = True  # the present run skips no blocks
        self.restarted = False
        self.disturbed = ""  # what was switched off without a command of the program

    def begin(self, job: Job, begun: int) -> None:
        """Start a run of ``job``. ``begun`` is the number of blocks that started before an interruption."""
        begin = job.setup.begin
        self.restarted = begin is not None
        self._begun = 0 if begin is None else begun
        self.disturbed = "" if begin is None else self.disturbed
        self._whole = begin is None or (not begin.skips_cuts and begin.checkpoint.blocks <= self._begun)

    def begun_to(self, block: int) -> int:
        """Return the number of blocks started without a gap when the run has reached ``block``."""
        return max(self._begun, block) if self._whole else self._begun

    def end(self) -> None:
        """Reset the state at the end of the program; the next run starts a new workpiece."""
        self._begun, self._whole, self.restarted, self.disturbed = 0, True, False, ""

    @property
    def why_none(self) -> str:
        """The reason why the end of the program does not count as a part; empty if it counts."""
        if self.disturbed:
            return Message(
                "the cycle was disturbed ({disturbed}); measure the part and, if it is good, add it "
                "to the part count on page F10",
                disturbed=self.disturbed,
            )
        return "" if self._whole else "a restart skipped part of the program"


class PartCount:
    """Counts parts and measures cycle times. Other modules read ``counters``."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self.counters = Counters()
        self.piece = Workpiece()

    @property
    def why_none(self) -> str:
        """The reason why the running program will not count as a part; empty if it will."""
        return "NO COUNT is on" if self._context.switches.no_count else self.piece.why_none

    def ended(self) -> None:
        """Count and log the end of the program. The time of a restart is not used as a cycle time."""
        counters, seconds, why = self.counters, self.counters.cycle, self.why_none
        counters.cycle, load = 0.0, counters.take_load()
        counters.ends += 1
        if not self.piece.restarted:
            counters.last_cycle, counters.timed = seconds, counters.timed + 1
        if why:
            text, line = Message("{why}; {seconds} s", why=why, seconds=f"{seconds:.2f}"), self._context.line
            self._context.log_event(Event(self._context.now, "uncounted", text, line, load=load))
        else:
            counters.parts += 1
            counters.made += 1
            text, line = (
                Message(
                    "part {parts} completed in {seconds} s", parts=counters.parts, seconds=f"{seconds:.2f}"
                ),
                self._context.line,
            )
            self._context.log_event(
                Event(self._context.now, "part", text, line, part=counters.made, load=load)
            )
        self.piece.end()
