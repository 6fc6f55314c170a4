"""Conditions of a cycle start, in the order in which an operator has to satisfy them.

They concern the machine, the job to start (program, restart or MDI line) and its proof. Anything else that a
start would turn on must be announced first.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from core.executor.commands import UNCHECKED, Clearance, verdict
from core.executor.control_status import ControlStatus, modal_as_machine
from core.executor.job import Job, Proof, outdated
from core.executor.machine_context import MachineContext
from core.executor.snapshot import Starts, State
from core.interpreter.shared.checkpoint import Begin
from core.interpreter.shared.machine_requirements import ORIENT, THREAD
from core.interpreter.shared.modal_state import Modal
from core.message import Message
from core.tool_edges import edge_name

INHIBIT = "start_inhibit"  # the input that prevents every cycle from starting or resuming
_BUSY = {
    State.ESTOP: "E-stop is pressed: release it",
    State.FAULT: "an alarm is active: clear its cause and press Reset",
    State.DISABLED: "the drives are off: switch them on",
    State.JOG: "the machine is being jogged",
    State.HOME: "the machine is homing",
}


def guard_open(context: MachineContext) -> bool:
    """Return whether the guard is open at a machine whose guard stops the cycle. An off input means open."""
    return context.machine.interlocks.guard_stops and not context.inputs.get("guard", False)


def station_stop(context: MachineContext) -> str:
    """Return which condition of the operator station prevents a cycle, or an empty string."""
    if context.signals.hold:
        return "feed hold is pressed"
    if guard_open(context):
        return "the guard is open: close it"
    if context.inputs.get(INHIBIT, False):
        return "the start inhibit switch is on"
    return context.signals.trouble.lower() or context.signals.lost


def unclamped(context: MachineContext) -> str:
    """Return why the collet prevents a spindle start, or an empty string."""
    if context.machine.interlocks.spindle_with_collet_open or context.inputs.get("collet_closed", True):
        return ""
    return "the spindle does not start with the collet open: close the collet first"


def unclamped_by_program(context: MachineContext) -> str:
    """Return why the collet prevents a spindle start within a stopped cycle, or an empty string.

    If the program has opened the collet, the operator must press Reset before closing it.
    """
    why = unclamped(context)
    if why and not context.outputs.outputs().get("collet", True):
        return (
            "the program has opened the collet, so the spindle does not start: press Reset, "
            "close the collet and start again"
        )
    return why


def hindrance(context: MachineContext, state: State) -> str:
    """Return which state of the machine prevents any cycle start, or an empty string."""
    if state in _BUSY:
        return _BUSY[state]
    if station_stop(context):
        return station_stop(context)
    if context.ports.blocks is not None and context.ports.blocks.state().hindrance:
        return context.ports.blocks.state().hindrance
    name = context.machine.shown
    away = [
        name(a.name) for a, homed in zip(context.machine.axes, context.sample.homed, strict=True) if not homed
    ]
    if away:
        return Message("{away} must be homed first", away=", ".join(away))
    return ""


def job_refusal(context: MachineContext, state: State, job: Job | None, proof: Proof | None) -> str:
    """Return why this job may not be started now, or an empty string if it may."""
    return hindrance(context, state) or unproved(job, proof) or lacking(context, proof)


def lacking(context: MachineContext, proof: Proof | None) -> str:
    """Return which function the program needs but the machine does not have, or an empty string."""
    blocks = context.ports.blocks
    absent = {Message("output {name}", name=name) for name in context.machine.absent}
    for need in proof.needs if proof is not None else ():
        if need.builders_m:
            return Message(
                "line {line}: this machine does not define {need}",
                line=need.line,
                need=need.words,
            )
        if need.what in absent:
            return Message("line {line}: this machine has no {need}", line=need.line, need=need.words)
        if blocks is not None and need.what not in blocks.caps:
            return Message(
                "line {line}: this controller does not support {need}", line=need.line, need=need.words
            )
        if blocks is None and need.what == ORIENT and context.ports.orientation is None:
            return Message(
                "line {line}: the spindle driver of this machine cannot orient the spindle to an angle",
                line=need.line,
            )
        if blocks is None and need.what == THREAD and context.ports.spindle.angle() is None:
            return Message(
                "line {line}: a thread needs a spindle encoder, but this machine does not have one",
                line=need.line,
            )
    return ""


def unproved(job: Job | None, proof: Proof | None) -> str:
    """Return why the proof does not permit a start of this job, or an empty string."""
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
            number=", ".join(edge_name(number) for number in missing),
        )
    return ""


# --- job that Cycle Start begins ------------------------------------------------------------------------


_NOTHING = {
    Starts.LINE: "no MDI line is ready to start",
    Starts.RESTART: "the restart is not ready: search for a line and confirm it",
}
_SAME = 0.01  # mm or degrees, tolerance between the axes and the planned start position


def job_to_start(status: ControlStatus) -> Job | None:
    """Return the job that Cycle Start would run, or None."""
    return status.job if status.starts is Starts.PROGRAM else status.prepared


def start_refusal(context: MachineContext, state: State, status: ControlStatus) -> str:
    """Return why Cycle Start is refused now, or an empty string if it may start."""
    job, proof = job_to_start(status), status.proof
    if status.starts is not Starts.PROGRAM:
        proof = status.prepared_proof
    if job is None and status.starts in _NOTHING:
        return hindrance(context, state) or _NOTHING[status.starts]
    why = job_refusal(context, state, job, proof) or (_moved(context, job) or _changed(context, status, job))
    return why or (status.next_barred if status.starts is Starts.PROGRAM else "")


def first_move_refusal(context: MachineContext, status: ControlStatus, begun: int) -> tuple[str, str]:
    """Return the code and the sentence if the first move is refused; both are empty if it is permitted."""
    job = job_to_start(status)
    if not status.checks_starts or job is None:
        return "", ""
    found = first_move_verdict(context, status, begun)
    if found is None:
        return UNCHECKED, "the first move is being checked against the part: start again in a moment"
    return found.code, found.why


def first_move_verdict(
    context: MachineContext, status: ControlStatus, begun: int, *, repeats: bool = False
) -> Clearance | None:
    """Return the clearance of the first move after Cycle Start, or after Cycle Repeat if ``repeats``.

    The result is None if the clearance has not been computed yet.
    """
    job, known = job_to_start(status), status.clearances
    if repeats:
        job = status.job
    elif status.starts is not Starts.PROGRAM:
        known = tuple(filter(None, (status.prepared_clearance,)))
    if job is None:
        return None
    at, _ = context.ports.axes.demand_at(context.now)
    return verdict(known, job.digest, at, begun, repeats=repeats)


def _moved(context: MachineContext, job: Job | None) -> str:
    if job is None or job.setup.begin is None:
        return ""
    at, _ = context.ports.axes.demand_at(context.now)
    away = max(abs(a - b) for a, b in zip(at, job.setup.start, strict=False))
    if away <= _SAME:
        return ""
    return Message("the axes have moved since the program was proved; {begin}", begin=_again(job.setup.begin))


def _changed(context: MachineContext, status: ControlStatus, job: Job | None) -> str:
    """Return what has changed since the program, the line or the restart was proved, or an empty string."""
    if job is None:
        return ""
    begin = job.setup.begin
    if begin is None:
        old = outdated(job, status.modal)
        return (
            Message("{old}, but the program does not specify this setting; load the program again", old=old)
            if old
            else ""
        )
    now = modal_as_machine(status.modal, context)
    if not begin.single:
        return _changed_for_restart(status, job, begin, now)
    same = now == begin.checkpoint.modal
    return (
        ""
        if same
        else Message("the machine state has changed since the line was proved; {begin}", begin=_again(begin))
    )


def _again(begin: Begin) -> str:
    """Return how the operator can have the job proved again."""
    if begin.single:
        return "request the retract path again" if begin.approach else "enter or select the line again"
    return "search for the line again"


def _changed_for_restart(status: ControlStatus, job: Job, begin: Begin, now: Modal) -> str:
    """Return why a restart is outdated: another program is loaded, or the collet is in another state."""
    if status.job is None or status.job.digest != job.part_of:
        return "the program was loaded again: search for the line again"
    wanted = begin.checkpoint.modal.collet_closed
    if now.collet_closed != wanted:
        template = (
            "the collet is closed, but must be open at line {line}: open the collet in MDI"
            if now.collet_closed
            else "the collet is open, but must be closed at line {line}: close the collet in MDI"
        )
        return Message(template, line=begin.line)
    return unproved(status.job, status.proof)


# --- announcements of a start ---------------------------------------------------------------------------


SPINDLE = "spindle"
TIME_TO_READ = 0.3  # s for which an announcement must have been displayed before a start
_FIGURE_CHANGED = 0.1  # relative change of a value that makes a new announcement


class Starting(NamedTuple):
    """A function that the next start would turn on.

    ``what`` identifies the function, and the operator reads ``text``. ``figure`` is its value, such as the
    rpm of a spindle. A large change of the value makes a new announcement. ``begin`` turns the function on
    after the announced start.
    """

    what: str
    text: str
    begin: Callable[[], None]
    figure: float = 0.0


class Announcement:
    """The functions that a start would turn on, read from ``sources`` in every tick.

    Used on the executor's thread only.
    """

    def __init__(self) -> None:
        self.sources: list[Callable[[], Iterable[Starting]]] = []
        self._since: dict[str, tuple[float, float]] = {}  # by key: time of the first display, and the value

    def publish(self, now: float) -> tuple[str, ...]:
        """Return the texts for the snapshot of this tick and record when each first appeared."""
        items, before = self._items(), self._since
        self._since = {item.what: self._counted(item, before, now) for item in items}
        return tuple(item.text for item in items)

    def refusal(self, now: float, what: str = "") -> str:
        """Return why a start is refused because the operator had no time to read an announcement.

        ``what`` limits the check to one function. The result is empty if the start is permitted.
        """
        for item in self._items(what):
            since, figure = self._since.get(item.what, (math.inf, 0.0))
            if now - since < TIME_TO_READ - 1e-9 or _differ(item.figure, figure):
                return Message("read this message first: {item}; then start again", item=item.text)
        return ""

    def begin(self, what: str = "") -> None:
        """Turn on the function ``what``, or all functions, after a permitted start."""
        for item in self._items(what):
            item.begin()

    def _items(self, what: str = "") -> list[Starting]:
        return [item for source in self.sources for item in source() if what in {"", item.what}]

    def _counted(
        self, item: Starting, before: dict[str, tuple[float, float]], now: float
    ) -> tuple[float, float]:
        known = before.get(item.what)
        return (now, item.figure) if known is None or _differ(item.figure, known[1]) else known


def _differ(new: float, old: float) -> bool:
    return abs(new - old) > _FIGURE_CHANGED * abs(old)
