"""Conditions for a cycle start, in the order in which an operator has to satisfy them.

They concern the machine, the job to start (program, restart or MDI line) and its proof. If a start would
also turn on a function that is not part of the job, this must be announced first.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from core.executor.commands import START_UNCHECKED, StartClearance, find_start_clearance
from core.executor.control_status import ControlStatus, sync_modal_state_with_machine
from core.executor.job import Job, Proof, find_outdated_setting
from core.executor.machine_context import MachineContext
from core.executor.snapshot import MachineState, StartAction
from core.interpreter.shared.checkpoint import PassStart
from core.interpreter.shared.machine_requirements import SPINDLE_ORIENTATION, THREADING
from core.interpreter.shared.modal_state import ModalState
from core.message import Message
from core.tool_edges import format_edge_name

START_INHIBIT_INPUT = "start_inhibit"  # the input that prevents every cycle from starting or resuming
_BUSY_STATES = {
    MachineState.ESTOP: "E-stop is pressed: release it",
    MachineState.FAULT: "an alarm is active: clear its cause and press Reset",
    MachineState.DISABLED: "the drives are off: switch them on",
    MachineState.JOG: "the machine is being jogged",
    MachineState.HOMING: "the machine is homing",
}


def is_guard_open(context: MachineContext) -> bool:
    """Return whether the guard is open on a machine whose guard stops the cycle.

    An input that is off means that the guard is open.
    """
    return context.machine.interlocks.guard_stops and not context.inputs.get("guard", False)


def find_station_inhibit_reason(context: MachineContext) -> str:
    """Return why the operator station prevents a cycle, or an empty string if it does not."""
    if context.station_signals.is_hold_requested:
        return "feed hold is pressed"
    if is_guard_open(context):
        return "the guard is open: close it"
    if context.inputs.get(START_INHIBIT_INPUT, False):
        return "the start inhibit switch is on"
    return context.station_signals.station_fault.lower() or context.station_signals.connection_lost_reason


def find_collet_inhibit_reason(context: MachineContext) -> str:
    """Return why the collet prevents a spindle start, or an empty string if it does not."""
    if context.machine.interlocks.spindle_with_collet_open or context.inputs.get("collet_closed", True):
        return ""
    return "the spindle does not start with the collet open: close the collet first"


def find_collet_resume_inhibit(context: MachineContext) -> str:
    """Return why the collet prevents a spindle start within a stopped cycle, or an empty string.

    The string is empty if the collet does not prevent it. If the program has opened the collet, the
    operator must press Reset before closing the collet.
    """
    why = find_collet_inhibit_reason(context)
    if why and not context.commanded_outputs.get_outputs().get("collet", True):
        return (
            "the program has opened the collet, so the spindle does not start: press Reset, "
            "close the collet and start again"
        )
    return why


def find_state_inhibit_reason(context: MachineContext, state: MachineState) -> str:
    """Return why the current machine state prevents a start, or an empty string if it does not."""
    if state in _BUSY_STATES:
        return _BUSY_STATES[state]
    if find_station_inhibit_reason(context):
        return find_station_inhibit_reason(context)
    if context.ports.blocks is not None and context.ports.blocks.state().start_refusal_reason:
        return context.ports.blocks.state().start_refusal_reason
    name = context.machine.get_displayed_axis_name
    away = [
        name(a.name)
        for a, homed in zip(context.machine.axes, context.axis_sample.homed, strict=True)
        if not homed
    ]
    if away:
        return Message("{away} must be homed first", away=", ".join(away))
    return ""


def find_job_refusal_reason(
    context: MachineContext, state: MachineState, job: Job | None, proof: Proof | None
) -> str:
    """Return why this job may not be started now, or an empty string if it may."""
    return (
        find_state_inhibit_reason(context, state)
        or find_proof_refusal_reason(job, proof)
        or describe_missing_function(context, proof)
    )


def describe_missing_function(context: MachineContext, proof: Proof | None) -> str:
    """Return the message that the machine lacks a function that the program needs.

    The result is an empty string if the machine has all these functions.
    """
    blocks = context.ports.blocks
    absent = {Message("output {name}", name=name) for name in context.machine.missing_outputs}
    for need in proof.required_functions if proof is not None else ():
        if need.missing_m_code:
            return Message(
                "line {line}: this machine does not define {need}",
                line=need.first_line,
                need=need.description,
            )
        if need.required_function in absent:
            return Message(
                "line {line}: this machine has no {need}", line=need.first_line, need=need.description
            )
        if blocks is not None and need.required_function not in blocks.capabilities:
            return Message(
                "line {line}: this controller does not support {need}",
                line=need.first_line,
                need=need.description,
            )
        if (
            blocks is None
            and need.required_function == SPINDLE_ORIENTATION
            and context.ports.orientation is None
        ):
            return Message(
                "line {line}: the spindle driver of this machine cannot orient the spindle to an angle",
                line=need.first_line,
            )
        if (
            blocks is None
            and need.required_function == THREADING
            and context.ports.spindle.read_angle() is None
        ):
            return Message(
                "line {line}: a thread needs a spindle encoder, but this machine does not have one",
                line=need.first_line,
            )
    return ""


def find_proof_refusal_reason(job: Job | None, proof: Proof | None) -> str:
    """Return why the proof does not permit a start of this job, or an empty string if it does."""
    if job is None:
        return "no program is loaded"
    if proof is None:
        return "the program is not proved yet"
    if proof.digest != job.digest:
        return "the proof was made for another program or with other offsets: load the program again"
    if proof.errors:
        return Message("the program has errors: {errors}", errors=proof.errors[0])
    if missing := proof.unset(job):
        return Message(
            "tool offset {number} has never been set",
            number=", ".join(format_edge_name(number) for number in missing),
        )
    return ""


# --- job that Cycle Start begins ------------------------------------------------------------------------


_NOTHING = {
    StartAction.MDI_LINE: "no MDI line is ready to start",
    StartAction.RESTART: "the restart is not ready: search for a line and confirm it",
}
_POSITION_TOLERANCE = 0.01  # mm or degrees, tolerance between the axes and the planned start position


def get_selected_job(status: ControlStatus) -> Job | None:
    """Return the job that Cycle Start would run, or None if no job is ready."""
    return status.job if status.start_action is StartAction.PROGRAM else status.prepared_job


def find_start_refusal_reason(context: MachineContext, state: MachineState, status: ControlStatus) -> str:
    """Return why Cycle Start is refused now, or an empty string if it may start."""
    job, proof = get_selected_job(status), status.proof
    if status.start_action is not StartAction.PROGRAM:
        proof = status.prepared_proof
    if job is None and status.start_action in _NOTHING:
        return find_state_inhibit_reason(context, state) or _NOTHING[status.start_action]
    why = find_job_refusal_reason(context, state, job, proof) or (
        _moved(context, job) or _find_change(context, status, job)
    )
    return why or (status.next_part_inhibit_reason if status.start_action is StartAction.PROGRAM else "")


def find_first_move_refusal(
    context: MachineContext, status: ControlStatus, run_count: int
) -> tuple[str, str]:
    """Return the code and the text of the reason why the first move is refused.

    Both are empty strings if the first move is permitted.
    """
    job = get_selected_job(status)
    if not status.requires_start_clearance or job is None:
        return "", ""
    found = find_first_move_clearance(context, status, run_count)
    if found is None:
        return START_UNCHECKED, "the first move is being checked against the part: start again in a moment"
    return found.code, found.why


def find_first_move_clearance(
    context: MachineContext, status: ControlStatus, run_count: int, *, for_repeat: bool = False
) -> StartClearance | None:
    """Return the clearance of the first move after Cycle Start, or None if it has not been computed yet.

    If ``for_repeat`` is True, the clearance is for the first move after Cycle Repeat.
    """
    job, known = get_selected_job(status), status.start_clearances
    if for_repeat:
        job = status.job
    elif status.start_action is not StartAction.PROGRAM:
        known = tuple(filter(None, (status.prepared_start_clearance,)))
    if job is None:
        return None
    at, _ = context.ports.axes.demand_at(context.now)
    return find_start_clearance(known, job.digest, at, run_count, for_repeat=for_repeat)


def _moved(context: MachineContext, job: Job | None) -> str:
    if job is None or job.setup.begin is None:
        return ""
    at, _ = context.ports.axes.demand_at(context.now)
    away = max(abs(a - b) for a, b in zip(at, job.setup.start, strict=False))
    if away <= _POSITION_TOLERANCE:
        return ""
    return Message(
        "the axes have moved since the program was proved; {begin}", begin=_proof_instruction(job.setup.begin)
    )


def _find_change(context: MachineContext, status: ControlStatus, job: Job | None) -> str:
    """Return what has changed since the job was proved, or an empty string if it is unchanged."""
    if job is None:
        return ""
    begin = job.setup.begin
    if begin is None:
        old = find_outdated_setting(job, status.modal_state)
        return (
            Message("{old}, but the program does not specify this setting; load the program again", old=old)
            if old
            else ""
        )
    now = sync_modal_state_with_machine(status.modal_state, context)
    if not begin.is_mdi_line:
        return _find_restart_change(status, job, begin, now)
    same = now == begin.checkpoint.modal
    return (
        ""
        if same
        else Message(
            "the machine state has changed since the line was proved; {begin}",
            begin=_proof_instruction(begin),
        )
    )


def _proof_instruction(begin: PassStart) -> str:
    """Return the instruction that explains to the operator how to prove the job again."""
    if begin.is_mdi_line:
        return "request the retract path again" if begin.approach_steps else "enter or select the line again"
    return "search for the line again"


def _find_restart_change(status: ControlStatus, job: Job, begin: PassStart, now: ModalState) -> str:
    """Return why a restart is outdated, or an empty string if it is not.

    A restart is outdated if another program has been loaded or the state of the collet has changed.
    """
    if status.job is None or status.job.digest != job.parent_digest:
        return "the program was loaded again: search for the line again"
    wanted = begin.checkpoint.modal.collet_closed
    if now.collet_closed != wanted:
        template = (
            "the collet is closed, but must be open at line {line}: open the collet in MDI"
            if now.collet_closed
            else "the collet is open, but must be closed at line {line}: close the collet in MDI"
        )
        return Message(template, line=begin.line_number)
    return find_proof_refusal_reason(status.job, status.proof)


# --- announcements of a start ---------------------------------------------------------------------------


SPINDLE_FUNCTION = "spindle"
MIN_READING_TIME_S = 0.3  # s for which an announcement must have been displayed before a start
_VALUE_CHANGE_FRACTION = 0.1  # relative change of a value that makes a new announcement


class AnnouncedFunction(NamedTuple):
    """A function that the next start would turn on, and that must be announced first.

    ``function_name`` identifies the function, and ``text`` is shown to the operator. ``displayed_value`` is
    a value in the text, such as the rpm of a spindle. A large change of this value creates a new
    announcement. ``turn_on_function`` turns the function on after the announced start.
    """

    function_name: str
    text: str
    turn_on_function: Callable[[], None]
    displayed_value: float = 0.0


class StartAnnouncement:
    """Announcements of the functions that a start would turn on.

    They are read from ``sources`` in every tick. Only the executor's thread uses this object.
    """

    def __init__(self) -> None:
        self.sources: list[Callable[[], Iterable[AnnouncedFunction]]] = []
        self._since: dict[str, tuple[float, float]] = {}  # by key: time of the first display, and the value

    def update_texts(self, now: float) -> tuple[str, ...]:
        """Return the texts for the snapshot of this tick, and record when each text first appeared."""
        items, before = self._items(), self._since
        self._since = {item.function_name: self._counted(item, before, now) for item in items}
        return tuple(item.text for item in items)

    def find_refusal_reason(self, now: float, function_name: str = "") -> str:
        """Return the message that refuses a start because an announcement was not shown long enough.

        The result is an empty string if the start is permitted. A start is also refused if the value in an
        announcement has changed considerably. ``function_name`` limits the check to one function.
        """
        for item in self._items(function_name):
            since, figure = self._since.get(item.function_name, (math.inf, 0.0))
            if now - since < MIN_READING_TIME_S - 1e-9 or _differ(item.displayed_value, figure):
                return Message("read this message first: {item}; then start again", item=item.text)
        return ""

    def start_functions(self, function_name: str = "") -> None:
        """Turn on the named function, or all announced functions, after a permitted start."""
        for item in self._items(function_name):
            item.turn_on_function()

    def _items(self, what: str = "") -> list[AnnouncedFunction]:
        return [item for source in self.sources for item in source() if what in {"", item.function_name}]

    def _counted(
        self, item: AnnouncedFunction, before: dict[str, tuple[float, float]], now: float
    ) -> tuple[float, float]:
        known = before.get(item.function_name)
        return (
            (now, item.displayed_value) if known is None or _differ(item.displayed_value, known[1]) else known
        )


def _differ(new: float, old: float) -> bool:
    return abs(new - old) > _VALUE_CHANGE_FRACTION * abs(old)
