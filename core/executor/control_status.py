"""State of the control that persists between ticks: job, alarms, modal state and part count."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from core.executor.commands import StartClearance
from core.executor.job import Job, Proof
from core.executor.machine_context import MachineContext
from core.executor.snapshot import Alarm, InterruptedJob, LogEvent, MachineState, StartAction
from core.interpreter.omniturn.setup.inherited_state import compute_modal_after_end
from core.interpreter.shared.checkpoint import SavedPass
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.message import Message


@dataclass(slots=True)
class Counters:
    """Counts and times since the executor was started.

    Times are in seconds and exclude stops. ``spindle_load_totals`` is a pair: the integral of the spindle
    load (percent) over the cutting time, and this cutting time in seconds.
    """

    counted_part_count: int = 0
    # finished parts of the loaded program: the number set with ``PartsMade`` plus the parts made since
    program_part_count: int = 0
    program_end_count: int = 0  # programs that ran to their end, counted or not
    mdi_line_count: int = 0  # MDI lines that were started
    started_run_count: int = 0  # runs that were started: programs, repeats, restarts and MDI lines
    underrun_count: int = 0
    cycle_time_s: float = 0.0
    last_cycle_time_s: float = 0.0
    timed_cycle_count: int = 0  # number of complete cycles; ``last_cycle_time_s`` is the time of the latest
    # seconds at feed by tool number, without dry runs
    cutting_times_s: Mapping[int, float] = field(default_factory=dict)

    spindle_load_totals: tuple[float, float] = (
        0.0,
        0.0,
    )  # spindle load at feed in this part: per cent · s, and s

    def add_cutting_time(self, tool: int, seconds: float, load_percent: float | None = None) -> None:
        """Add cutting time at feed for a tool, and the spindle load in percent if it is known.

        The mapping of cutting times is replaced by a new one. Readers that hold the old mapping are not
        affected.
        """
        self.cutting_times_s = {**self.cutting_times_s, tool: self.cutting_times_s.get(tool, 0.0) + seconds}
        if load_percent is not None:
            self.spindle_load_totals = (
                self.spindle_load_totals[0] + load_percent * seconds,
                self.spindle_load_totals[1] + seconds,
            )

    def pop_mean_spindle_load(self) -> float | None:
        """Return the mean spindle load at feed for the part that ends, in percent, or None if unknown.

        The call resets the sum for the next part.
        """
        (borne, seconds), self.spindle_load_totals = self.spindle_load_totals, (0.0, 0.0)
        return borne / seconds if seconds > 0.0 else None


@dataclass(slots=True)
class ControlStatus:
    """State, program and alarms of the machine."""

    state: MachineState = MachineState.DISABLED
    job: Job | None = None
    proof: Proof | None = None
    alarms: tuple[Alarm, ...] = ()
    are_drives_switched_off: bool = False  # an alarm has switched the drives off
    start_refusal_reason: str = ""
    start_refusal_code: str = ""  # code of the refusal if the first move caused it
    start_action: StartAction = StartAction.PROGRAM
    prepared_job: Job | None = None  # the restart or the MDI line that Cycle Start begins
    prepared_proof: Proof | None = None
    requires_start_clearance: bool = False  # a cycle starts only with a clearance for its first move
    start_clearances: tuple[StartClearance, ...] = ()  # clearances for the program
    prepared_start_clearance: StartClearance | None = None  # clearance for the prepared job
    next_part_inhibit_reason: str = ""  # why no other part may start, as posted with ``BarNextPart``
    is_tool_move_pending: bool = False  # MDI has called a tool that has not moved yet
    saved_pass: SavedPass[Any] | None = None  # state that MDI lines in other languages have left in force
    interrupted_job: InterruptedJob | None = None  # a program that did not reach its end
    modal_state: ModalState = field(default_factory=ModalState)  # modal state in force between programs


# --- modal state between programs -----------------------------------------------------------------------


def make_power_up_modal_state(context: MachineContext) -> ModalState:
    """Return the modal state at power-up, with the units of the machine file.

    A SINUMERIK control powers up with DIAMON active.
    """
    machine = context.machine
    begins = ModalState(
        metric=not machine.is_inch,
        diameter=machine.mdi_language == "sinumerik",
        rapid_rate=machine.limits.manual_rapid,
    )
    return sync_modal_state_with_machine(begins, context)


def make_modal_state_after_cancel(modal: ModalState, language: str = "omniturn") -> ModalState:
    """Return the modal state after a program is canceled by Reset, an alarm or an E-stop.

    The result is the same as after M30. On a SINUMERIK control, the diameter programming mode returns to
    its power-up setting.
    """
    return compute_modal_after_end(modal, modal.rpm, resets_m_functions=True)._replace(
        diameter=language == "sinumerik"
    )


def make_modal_state_after_mdi_cancel(modal: ModalState) -> ModalState:
    """Return the modal state after an MDI line is canceled.

    Modes set by the MDI line remain active, but the C axis and the spindle are released.
    """
    return modal._replace(c_locked=False, c_rpm=None, oriented=None)


def sync_modal_state_with_machine(modal: ModalState, context: MachineContext) -> ModalState:
    """Return the modal state with its M functions updated from the current state of the machine.

    An alarm, a reset or a manual action may have switched them. A stopped spindle releases C. Nose
    compensation and coordinate transformation (plane switching) end with their program.
    """
    on = {name for name, lit in context.ports.io.get_outputs().items() if lit}
    assigned = {name for name, _ in context.machine.m_code_outputs.values()} | {
        context.machine.live_tool_output
    }
    asked = context.spindle.is_requested
    return modal._replace(
        spindle=modal.spindle if asked else 0,
        c_locked=modal.c_locked and not asked,
        oriented=context.spindle.orientation.angle_deg,
        coolant="coolant" in on,
        collet_closed="collet" in on if "collet" in context.machine.outputs else modal.collet_closed,
        outputs=frozenset(on & assigned),
        compensation_code=40,
        mill=None,
    )


def apply_offsets_to_modal_state(
    modal: ModalState, tools: Mapping[int, ToolOffset], secondary: Mapping[int, SecondaryOffset]
) -> ModalState:
    """Return the modal state with the offsets of its tool and D number from the given tables."""
    tool = tools.get(modal.tool, ToolOffset()) if modal.tool else ToolOffset()
    pair = secondary.get(modal.secondary, SecondaryOffset()) if modal.secondary else SecondaryOffset()
    return modal._replace(
        tool_offset_x=tool.x, tool_offset_z=tool.z, secondary_offset_x=pair.x, secondary_offset_z=pair.z
    )


class Workpiece:
    """The workpiece in progress.

    A start at the first line begins a new workpiece; a restart continues the current one. The numbers of
    the elementary blocks show whether a restart has skipped blocks. A workpiece is not counted as a part if
    blocks were skipped, or if the spindle or an output was off although the program had turned it on. The
    operator can add a good part to the count on page F10.
    """

    def __init__(self) -> None:
        self._begun = 0  # number of blocks started without a gap
        self._whole = True  # the present run skips no blocks
        self.is_restarted = False
        self.disturbance = ""  # what was switched off without a command of the program

    def start_run(self, job: Job, started_block_count: int) -> None:
        """Start a run of ``job``.

        ``started_block_count`` is the number of blocks that started before an interruption.
        """
        begin = job.setup.begin
        self.is_restarted = begin is not None
        self._begun = 0 if begin is None else started_block_count
        self.disturbance = "" if begin is None else self.disturbance
        self._whole = begin is None or (not begin.skips_cuts and begin.checkpoint.blocks <= self._begun)

    def count_started_blocks(self, block: int) -> int:
        """Return how many blocks have started, with none skipped, when the run has reached ``block``."""
        return max(self._begun, block) if self._whole else self._begun

    def finish_program(self) -> None:
        """Reset the state at the end of the program; the next run starts a new workpiece."""
        self._begun, self._whole, self.is_restarted, self.disturbance = 0, True, False, ""

    @property
    def not_counted_reason(self) -> str:
        """Return why the end of the program does not count as a part, or an empty string if it counts."""
        if self.disturbance:
            return Message(
                "the cycle was disturbed ({disturbed}); measure the part and, if it is good, add it "
                "to the part count on page F10",
                disturbed=self.disturbance,
            )
        return "" if self._whole else "a restart skipped part of the program"


class PartCounter:
    """Counter of parts and their cycle times, whose results are in ``counters``."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self.counters = Counters()
        self.workpiece = Workpiece()

    @property
    def not_counted_reason(self) -> str:
        """Return why the running program will not count as a part, or an empty string if it will."""
        return "NO COUNT is on" if self._context.switches.no_count else self.workpiece.not_counted_reason

    def record_program_end(self) -> None:
        """Count the part, if it is valid, and log the end of the program.

        The duration of a restart is not stored as a cycle time.
        """
        counters, seconds, why = self.counters, self.counters.cycle_time_s, self.not_counted_reason
        counters.cycle_time_s, load = 0.0, counters.pop_mean_spindle_load()
        counters.program_end_count += 1
        if not self.workpiece.is_restarted:
            counters.last_cycle_time_s, counters.timed_cycle_count = seconds, counters.timed_cycle_count + 1
        if why:
            text, line = (
                Message("{why}; {seconds} s", why=why, seconds=f"{seconds:.2f}"),
                self._context.line_number,
            )
            self._context.log_event(
                LogEvent(self._context.now, "uncounted", text, line, mean_load_percent=load)
            )
        else:
            counters.counted_part_count += 1
            counters.program_part_count += 1
            text, line = (
                Message(
                    "part {parts} completed in {seconds} s",
                    parts=counters.counted_part_count,
                    seconds=f"{seconds:.2f}",
                ),
                self._context.line_number,
            )
            self._context.log_event(
                LogEvent(
                    self._context.now,
                    "part",
                    text,
                    line,
                    part_number=counters.program_part_count,
                    mean_load_percent=load,
                )
            )
        self.workpiece.finish_program()
