"""What the control knows between two ticks: state, job, alarms, modal state, and the part count."""

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
    """What is counted from the start of the executor; times in seconds, stops not counted."""

    parts: int = 0
    made: int = 0  # of the loaded program, as whoever keeps the count has told and what was made since
    ends: int = 0  # programs that came to their end, counted or not
    lines: int = 0  # of MDI that were begun
    begun: int = 0  # runs: programs, repeats, restarts and lines of MDI
    underruns: int = 0
    cycle: float = 0.0
    last_cycle: float = 0.0
    timed: int = 0  # whole cycles, of which ``last_cycle`` is the time of the newest
    cutting: Mapping[int, float] = field(default_factory=dict)  # by tool: at feed, dry runs not counted

    borne: tuple[float, float] = (0.0, 0.0)  # by the spindle at feed, in this part: per cent · s, and s

    def cut(self, tool: int, seconds: float, load: float | None = None) -> None:
        """So long at feed with this tool; whoever has the figures of before keeps them as they were."""
        self.cutting = {**self.cutting, tool: self.cutting.get(tool, 0.0) + seconds}
        if load is not None:
            self.borne = self.borne[0] + load * seconds, self.borne[1] + seconds

    def take_load(self) -> float | None:
        """The mean load of the spindle at feed in the part that ends, per cent; None where nobody tells."""
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
    start_code: str = ""  # of that refusal, where the first move was its reason
    starts: Starts = Starts.PROGRAM
    prepared: Job | None = None  # the restart or the line of MDI that Cycle Start begins
    prepared_proof: Proof | None = None
    checks_starts: bool = False  # no cycle starts without a verdict on its first move
    clearances: tuple[Clearance, ...] = ()  # the verdicts on the program
    prepared_clearance: Clearance | None = None  # the verdict on what is prepared
    next_barred: str = ""  # why no other part begins, as whoever keeps tool lives has told
    tool_open: bool = False  # MDI has called a tool, and its first move is still to come
    kept: KeptPass[Any] | None = None  # what lines of MDI in other languages have left in force
    interrupted: InterruptedJob | None = None  # a program that did not come to its end
    modal: Modal = field(default_factory=Modal)  # in force while no program is under way


# --- the modal state between two programs ---------------------------------------------------------------


def modal_at_power_up(context: MachineContext) -> Modal:
    """The state that the control is switched on with: it counts in what the machine's builder counts in.

    SINUMERIK is switched on with DIAMON.
    """
    machine = context.machine
    begins = Modal(
        metric=not machine.inch,
        diameter=machine.language == "sinumerik",
        rapid_rate=machine.limits.manual_rapid,
    )
    return modal_as_machine(begins, context)


def modal_given_up(modal: Modal, language: str = "omniturn") -> Modal:
    """A program that was reset, or ended by an alarm or the E-stop, leaves what M30 would have left.

    SINUMERIK leaves the diameter words that it is switched on with.
    """
    return after_end(modal, modal.rpm, reset=True)._replace(diameter=language == "sinumerik")


def modal_interrupted(modal: Modal) -> Modal:
    """A line of MDI that was reset, or ended by an alarm, leaves its modes; nothing holds C any more."""
    return modal._replace(c_locked=False, c_rpm=None, oriented=None)


def modal_as_machine(modal: Modal, context: MachineContext) -> Modal:
    """M functions as they are at the machine: an alarm, a reset or a hand may have switched them since.

    A stopped spindle releases C; nose compensation and plane switching never outlive their program.
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
    """The same state with the offsets of the loaded tool and of the D in force read from these tables."""
    tool = tools.get(modal.tool, ToolOffset()) if modal.tool else ToolOffset()
    pair = secondary.get(modal.secondary, SecondaryOffset()) if modal.secondary else SecondaryOffset()
    return modal._replace(tool_x=tool.x, tool_z=tool.z, secondary_x=pair.x, secondary_z=pair.z)


class Workpiece:
    """A program from its first line is a new piece; a restart goes on with the one that was given up.

    Elementary blocks are numbered through a whole run and a restart keeps their numbers, so they tell what a
    restart leaves out. A piece of which something was left out makes no part, nor one in whose cycle spindle
    or outputs were off that the program had on: who finds it good adds it to the count on F10.
    """

    def __init__(self) -> None:
        self._begun = 0  # blocks of it without a gap
        self._whole = True  # nothing is left out by what runs now
        self.restarted = False
        self.disturbed = ""  # what was switched off behind the program's back

    def begin(self, job: Job, begun: int) -> None:
        """What is going to run; ``begun`` blocks of the piece were begun before it was interrupted."""
        begin = job.setup.begin
        self.restarted = begin is not None
        self._begun = 0 if begin is None else begun
        self.disturbed = "" if begin is None else self.disturbed
        self._whole = begin is None or (not begin.skips_cuts and begin.checkpoint.blocks <= self._begun)

    def begun_to(self, block: int) -> int:
        """How many blocks are begun without a gap when what runs has come to this one."""
        return max(self._begun, block) if self._whole else self._begun

    def end(self) -> None:
        """The program has come to its end: what follows is another piece."""
        self._begun, self._whole, self.restarted, self.disturbed = 0, True, False, ""

    @property
    def why_none(self) -> str:
        """Why its end makes no part; empty when it makes one."""
        if self.disturbed:
            return Message(
                "the cycle was disturbed ({disturbed}); measure the part and, if it is good, add it "
                "to the part count on page F10",
                disturbed=self.disturbed,
            )
        return "" if self._whole else "a restart skipped part of the program"


class PartCount:
    """Counts parts and keeps cycle times; ``counters`` is what everybody reads."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self.counters = Counters()
        self.piece = Workpiece()

    @property
    def why_none(self) -> str:
        """Why the program under way will make no part; empty when it will make one."""
        return "NO COUNT is on" if self._context.switches.no_count else self.piece.why_none

    def ended(self) -> None:
        """The program has come to its end. The time of a restart is not that of a cycle."""
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
