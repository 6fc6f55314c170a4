"""Texts and lines that describe a restart: required and present state, functions that start, and path.

If the tool is in the part, the plan contains the retract path, or the instruction for a manual retract.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.status import formats
from app.desk.status.modal_rows import NONE, ModalRow, rows_of
from app.desk.translation import tr
from app.path.path_aspects import DrawnLeg as Drawn
from core.executor.job import Job
from core.executor.snapshot import CONTROL_LOST, Snapshot
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_approach import (
    Choices,
    MachineNow,
    begin_at,
    begin_on_mill,
    goal_of,
    retract_from_work,
    starting,
    way_out,
    why_no_way,
)
from core.interpreter.restart.restart_point import Called, Interruption, LoopPass, RestartPoint
from core.interpreter.restart.restart_retract import Retract, ToolPlace
from core.interpreter.shared.actions import Coolant, Output, SpindleLock, SpindleOrient, SpindleRun
from core.interpreter.shared.checkpoint import ApproachStep, AxesLeg, Begin, Checkpoint, FunctionStep, Leg
from core.message import Message

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics

# --- retract from the part ----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class WayOut:
    """A retract without a restart: its legs and its feed. ``trouble`` is why it is not possible, or empty."""

    begin: Begin
    legs: tuple[Drawn, ...]
    feed: str
    trouble: str = ""


def way_out_of(cut: CutRecord, snapshot: Snapshot, job: Job, choices: Choices) -> WayOut:
    """Return the retract path from the present position of the tool."""
    now = now_of(snapshot, job)
    found, tool = retract_from_work(cut, now)
    steps = way_out(cut, now, choices) if found.known else ()
    begin = Begin(Checkpoint(snapshot.modal), single=True, approach=steps)
    metric = snapshot.modal.metric
    feed = Message(
        "{modest} {metric}",
        modest=formats.feed(choices.modest, metric, False),
        metric=formats.feed_unit(metric, False),
    )
    trouble = jog_words(found, tool)
    if not trouble and not steps:
        trouble = tr(Message("T{tool} IS ALREADY CLEAR OF THE PART", tool=tool))
    return WayOut(begin, drawn(steps, snapshot, cut.offsets.get(tool, (0.0, 0.0))), feed, trouble)


def now_of(snapshot: Snapshot, job: Job) -> MachineNow:
    """Return the present machine state, with the interruption of the loaded program if there is one.

    If the text has changed since the interruption, the interrupted block is unknown.
    """
    found = snapshot.interrupted
    broken = None
    same = found is not None and found.program == job.source.name and found.text == job.text_digest
    if found is not None and same and found.block:
        stale = found.why == CONTROL_LOST
        broken = Interruption(found.block, found.tool, found.where, found.begun, stale)
    return MachineNow(snapshot.demand, snapshot.modal, broken)


def drawn(
    steps: tuple[ApproachStep, ...], snapshot: Snapshot, offset: tuple[float, float]
) -> tuple[Drawn, ...]:
    """Return the legs of a path in the frame of one tool. The first leg is the present tip position."""
    x, z = snapshot.demand[0], snapshot.demand[1]
    legs = [Drawn(z - offset[1], x - offset[0])]
    for step in steps:
        if isinstance(step, Leg):
            x, z = x if step.x is None else step.x, z if step.z is None else step.z
            legs.append(Drawn(z - offset[1], x - offset[0], step.rapid, f"{len(legs)} {step.text}"))
    return tuple(legs)


def jog_words(found: Retract, tool: int) -> str:
    """Return the instruction for a manual retract if no retract path is certain. Empty if one is."""
    if found.known:
        return ""
    if found.tool_place is ToolPlace.TAP:
        words = tr(
            "TAP T{tool} IS STILL IN THE THREAD: TURN THE SPINDLE BY HAND TO BACK IT OUT, AND LET Z FOLLOW"
        )
    elif found.tool_place is ToolPlace.THREAD:
        words = tr("T{tool} IS IN A THREAD: JOG X FIRST, NOT Z, UNTIL IT IS CLEAR")
    elif found.tool_place is ToolPlace.TURNED:
        words = tr(
            "C AXIS HAS TURNED SINCE T{tool} ENTERED THE PART: TURN THE SPINDLE BY HAND UNTIL "
            "THE TOOL IS FREE, THEN JOG T{tool} OUT"
        )
    else:
        words = _towards(*found.away)
    return tr(Message(words, tool=tool, x="X+" if found.away[0] > 0 else "X-"))


def _towards(x: int, z: int) -> str:
    if x and z:
        return tr("T{tool} IS IN THE PART: JOG IT BACK OUT ALONG ITS ENTRY PATH, {x} AND Z+ TOGETHER")
    if x:
        return tr("T{tool} IN THE PART: JOG {x} FIRST, NOT Z, UNTIL IT IS CLEAR")
    if z:
        return tr("T{tool} IN THE PART: JOG Z+ FIRST, NOT X, UNTIL IT IS CLEAR")
    return tr("TURNDESK DOES NOT KNOW HOW T{tool} ENTERED THE PART. JOG THE TOOL OUT ALONG ITS ENTRY PATH")


TURNED = 0.01  # Degrees.


@dataclass(frozen=True, slots=True)
class StateRow:
    """One row of the state: the required value at the line and the present value."""

    label: str
    wanted: str
    now: str

    @property
    def differs(self) -> bool:
        """Whether the restart must change this value."""
        return self.wanted != self.now


@dataclass(frozen=True, slots=True)
class Plan:
    """A restart plan that the operator confirms."""

    found: RestartPoint
    begin: Begin
    rows: tuple[StateRow, ...]
    starts: tuple[str, ...]  # Functions that will start, such as spindle and coolant.
    legs: tuple[Drawn, ...]
    trouble: str = ""  # Why the restart cannot start in the present machine state.
    warning: str = ""  # What the restart omits.
    way: tuple[str, ...] = ()  # On a mill, the legs of the approach as text.
    # On a mill, the axis positions at the beginning of the line, from home.
    axes: Mapping[str, float] = field(default_factory=dict)


def plan_of(found: RestartPoint, snapshot: Snapshot, job: Job, choices: Choices) -> Plan:
    """Return the restart plan from the present machine state."""
    if job.setup.kinematics is not None:
        return _on_mill(found, snapshot, job, choices, job.setup.kinematics)
    now = now_of(snapshot, job)
    begin = begin_at(found, now, choices)
    modal = begin.checkpoint.modal
    out = jog_words(*retract_from_work(found.cut, now)) if found.cut is not None else ""
    return Plan(
        found=found,
        begin=begin,
        rows=(*_passes(found), *_rows(begin.checkpoint, snapshot, job.source.dialect)),
        starts=tuple(
            _words(step, found.checkpoint, job.source.dialect) for step in starting(found, now, choices)
        ),
        legs=() if out else drawn(begin.approach, snapshot, (modal.base_x, modal.base_z)),
        warning=_left_out(found),
        trouble=_collet(found.checkpoint, snapshot) or out,
    )


def _on_mill(
    found: RestartPoint, snapshot: Snapshot, job: Job, choices: Choices, machine: Kinematics
) -> Plan:
    now = now_of(snapshot, job)
    begin = begin_on_mill(found, now, choices, machine)
    goal = goal_of(found, now, machine)
    places = tuple(
        StateRow(tr(Message("MACHINE {axis}", axis=name)), _place(name, goal[name]), _place(name, at))
        for name, at in zip(machine.names, now.at, strict=True)
    )
    no_way = tr("NO SAFE PATH: AXES HAVE NO LIMITS. START FROM THE FIRST LINE")
    return Plan(
        found=found,
        begin=begin,
        rows=(*places, *_state_rows(begin.checkpoint, snapshot, job.source.dialect)),
        starts=tuple(
            _words(step, found.checkpoint, job.source.dialect) for step in starting(found, now, choices)
        ),
        legs=(),
        way=tuple(step.text for step in begin.approach if isinstance(step, AxesLeg | FunctionStep)),
        axes=goal,
        warning=_left_out(found) or _turned(found, now, machine),
        trouble=no_way if why_no_way(machine) else "",
    )


def _turned(found: RestartPoint, now: MachineNow, machine: Kinematics) -> str:
    """Return a warning about a rotary axis that is not at zero and that no earlier line positions."""
    names = {axis.name for axis in machine.rotaries}
    for name, wanted, at in zip(machine.names, found.axes, now.at, strict=True):
        if name in names and wanted is None and abs(at) > TURNED:
            return tr(
                Message(
                    "CHECK {axis}: NO EARLIER LINE POSITIONS THIS AXIS. IT STAYS AT {position}",
                    axis=name,
                    position=formats.angle(at),
                )
            )
    return ""


def _place(axis: str, at: float) -> str:
    return formats.angle(at) if axis in "ABC" else formats.length(at, True)


def _passes(found: RestartPoint) -> tuple[StateRow, ...]:
    """Return the rows of the loops and calls that contain the line, with the interrupted ones."""
    was = found.was.within if found.was is not None else ()
    return tuple(
        _pass(each, was[number] if number < len(was) else None)
        for number, each in enumerate(found.visit.within)
    )


def _pass(wanted: LoopPass | Called, was: LoopPass | Called | None) -> StateRow:
    if isinstance(wanted, Called):
        label = tr("CALLED FROM LINE")
        now = str(was.line) if isinstance(was, Called) else NONE
        return StateRow(label, str(wanted.line), now)
    label = tr(Message("REPETITION OF LINES {first}-{last}", first=wanted.first, last=wanted.last))
    same = isinstance(was, LoopPass) and was.first == wanted.first
    return StateRow(label, _of(wanted), _of(was) if same and isinstance(was, LoopPass) else NONE)


def _of(loop: LoopPass) -> str:
    return tr(Message("{number} OF {count}", number=loop.number, count=loop.of))


def _left_out(found: RestartPoint) -> str:
    first, last = found.left_out
    if not first:
        return ""
    if first == last:
        return tr(Message("LINE {line} SKIPPED. MATERIAL REMAINS", line=first))
    return tr(Message("LINES {first} TO {last} SKIPPED. MATERIAL REMAINS", first=first, last=last))


def _rows(point: Checkpoint, snapshot: Snapshot, language: str) -> tuple[StateRow, ...]:
    wanted, now = _places(point, *point.machine), _places(point, *snapshot.demand[:2])
    both = zip(wanted, now, strict=True)
    places = (StateRow(w.label, w.value, n.value) for w, n in both)
    return (*places, *_state_rows(point, snapshot, language))


def _state_rows(point: Checkpoint, snapshot: Snapshot, language: str) -> tuple[StateRow, ...]:
    """Return the rows of the state at the line and the present state, in the program's language."""
    both = zip(rows_of(point, language), rows_of(_now(snapshot), language), strict=True)
    return tuple(StateRow(w.label, w.value, n.value) for w, n in both if w.key != "comment" or w.value)


def _now(snapshot: Snapshot) -> Checkpoint:
    return Checkpoint(snapshot.modal, c=snapshot.demand[2] - snapshot.modal.offset_c, kept=snapshot.kept)


def _places(point: Checkpoint, x: float, z: float) -> tuple[ModalRow, ...]:
    """Return the rows of a machine position as the line would read it, with its tool, unit and Ø or R."""
    modal = point.modal
    mark, factor = ("Ø", 2.0) if modal.diameter else ("R", 1.0)
    return (
        ModalRow("x", f"X {mark}", formats.length(factor * (x - modal.offset_x), modal.metric)),
        ModalRow("z", "Z", formats.length(z - modal.offset_z, modal.metric)),
    )


def _words(step: ApproachStep, point: Checkpoint, language: str) -> str:
    action = getattr(step, "action", None)
    modal = point.modal
    match action:
        case SpindleRun():
            way = tr("SPINDLE FORWARD") if modal.spindle > 0 else tr("SPINDLE REVERSE")
            speed = next(row.value for row in rows_of(point, language) if row.key == "speed")
            return Message("{details} {speed}", details=way, speed=speed)
        case SpindleLock():
            return tr("SPINDLE LOCKED AS C AXIS AND TURNED INTO POSITION")
        case SpindleOrient(angle=angle):
            return tr(Message("SPINDLE ORIENTED AT {angle}", angle=formats.angle(angle)))
        case Coolant():
            return tr("COOLANT")
        case Output(name=name):
            return tr(Message("{name} ON", name=name.upper()))
        case _:
            return ""


def _collet(point: Checkpoint, snapshot: Snapshot) -> str:
    wanted, now = point.modal.collet_closed, snapshot.modal.collet_closed
    if wanted == now:
        return ""
    if wanted:
        return tr("COLLET OPEN BUT MUST BE CLOSED AT THIS LINE: RUN M12 IN MDI")
    return tr("COLLET CLOSED BUT MUST BE OPEN AT THIS LINE: RUN M13 IN MDI")
