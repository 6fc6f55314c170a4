"""Texts and table rows that describe a restart: required and current state, functions, and path.

If the tool is in the part, the plan contains the retract path, or the instruction for a manual retract.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.status import formats
from app.desk.status.modal_rows import NO_CODE, ModalRow, make_modal_rows
from app.desk.translation import tr
from app.path.path_aspects import ApproachLeg as Drawn
from core.executor.job import Job
from core.executor.snapshot import POWER_LOST_REASON, Snapshot
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_approach import (
    CurrentMachineState,
    OperatorChoices,
    explain_missing_path,
    find_start_position,
    list_starting_functions,
    make_lathe_pass_start,
    make_mill_pass_start,
    plan_exit_moves,
    plan_retract_from_part,
)
from core.interpreter.restart.restart_point import ActiveCall, Interruption, LoopPass, RestartPoint
from core.interpreter.restart.tool_retract import Retract, ToolSituation
from core.interpreter.shared.actions import (
    CoolantSwitch,
    OutputSwitch,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
)
from core.interpreter.shared.checkpoint import (
    ApproachStep,
    Checkpoint,
    FunctionStep,
    MultiAxisLeg,
    PassStart,
    StraightLeg,
)
from core.message import Message

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics

# --- retract from the part ----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class RetractPlan:
    """Plan of a retract without a restart, with its moves and its feed.

    ``error_text`` is the reason why the retract is not possible, or an empty string.
    """

    start_state: PassStart
    drawn_legs: tuple[Drawn, ...]
    feed_text: str
    error_text: str = ""


def plan_retract(cut_state: CutRecord, snapshot: Snapshot, job: Job, choices: OperatorChoices) -> RetractPlan:
    """Return the plan of a retract from the current position of the tool."""
    now = read_machine_state(snapshot, job)
    found, tool = plan_retract_from_part(cut_state, now)
    steps = plan_exit_moves(cut_state, now, choices) if found.is_known else ()
    begin = PassStart(Checkpoint(snapshot.modal), is_mdi_line=True, approach_steps=steps)
    metric = snapshot.modal.metric
    feed = Message(
        "{modest} {metric}",
        modest=formats.format_feed(choices.inside_speed_mm_s, metric, False),
        metric=formats.find_feed_unit(metric, False),
    )
    problem = describe_manual_retract(found, tool)
    if not problem and not steps:
        problem = tr(Message("T{tool} IS ALREADY CLEAR OF THE PART", tool=tool))
    return RetractPlan(
        begin,
        make_approach_legs(steps, snapshot, cut_state.tool_offsets.get(tool, (0.0, 0.0))),
        feed,
        problem,
    )


def read_machine_state(snapshot: Snapshot, job: Job) -> CurrentMachineState:
    """Return the current machine state, with the interruption of the loaded program if there is one.

    If the text has changed since the interruption, the interrupted block is unknown.
    """
    found = snapshot.interrupted
    broken = None
    same = found is not None and found.program == job.source.name and found.text == job.text_digest
    if found is not None and same and found.block:
        stale = found.why == POWER_LOST_REASON
        broken = Interruption(found.block, found.tool, found.where, found.begun, stale)
    return CurrentMachineState(snapshot.demand, snapshot.modal, broken)


def make_approach_legs(
    steps: tuple[ApproachStep, ...], snapshot: Snapshot, offset: tuple[float, float]
) -> tuple[Drawn, ...]:
    """Return the moves of an approach in part coordinates, for the offset of one tool.

    The first entry is the current tip position.
    """
    x, z = snapshot.demand[0], snapshot.demand[1]
    legs = [Drawn(z - offset[1], x - offset[0])]
    for step in steps:
        if isinstance(step, StraightLeg):
            x, z = x if step.x is None else step.x, z if step.z is None else step.z
            legs.append(Drawn(z - offset[1], x - offset[0], step.is_rapid, f"{len(legs)} {step.text}"))
    return tuple(legs)


def describe_manual_retract(retract: Retract, tool: int) -> str:
    """Return the instruction for a manual retract, or an empty string if a retract path is known."""
    if retract.is_known:
        return ""
    if retract.tool_situation is ToolSituation.IN_TAPPED_HOLE:
        words = tr(
            "TAP T{tool} IS STILL IN THE THREAD: TURN THE SPINDLE BY HAND TO BACK IT OUT, AND LET Z FOLLOW"
        )
    elif retract.tool_situation is ToolSituation.IN_THREAD:
        words = tr("T{tool} IS IN A THREAD: JOG X FIRST, NOT Z, UNTIL IT IS CLEAR")
    elif retract.tool_situation is ToolSituation.PART_TURNED:
        words = tr(
            "C AXIS HAS TURNED SINCE T{tool} ENTERED THE PART: TURN THE SPINDLE BY HAND UNTIL "
            "THE TOOL IS FREE, THEN JOG T{tool} OUT"
        )
    else:
        words = _towards(*retract.direction)
    return tr(Message(words, tool=tool, x="X+" if retract.direction[0] > 0 else "X-"))


def _towards(x: int, z: int) -> str:
    if x and z:
        return tr("T{tool} IS IN THE PART: JOG IT BACK OUT ALONG ITS ENTRY PATH, {x} AND Z+ TOGETHER")
    if x:
        return tr("T{tool} IN THE PART: JOG {x} FIRST, NOT Z, UNTIL IT IS CLEAR")
    if z:
        return tr("T{tool} IN THE PART: JOG Z+ FIRST, NOT X, UNTIL IT IS CLEAR")
    return tr("TURNDESK DOES NOT KNOW HOW T{tool} ENTERED THE PART. JOG THE TOOL OUT ALONG ITS ENTRY PATH")


ROTATION_TOLERANCE_DEG = 0.01  # Degrees.


@dataclass(frozen=True, slots=True)
class StateRow:
    """One row of the state table, with the value required at the restart line and the current value."""

    label: str
    required_value: str
    current_value: str

    @property
    def must_change(self) -> bool:
        """Return whether the restart must change this value."""
        return self.required_value != self.current_value


@dataclass(frozen=True, slots=True)
class RestartPlan:
    """Plan of a restart, which the operator confirms."""

    restart_point: RestartPoint
    start_state: PassStart
    state_rows: tuple[StateRow, ...]
    functions_to_start: tuple[str, ...]  # Functions that will start, such as spindle and coolant.
    drawn_legs: tuple[Drawn, ...]
    error_text: str = ""  # Why the restart cannot start in the present machine state.
    warning_text: str = ""  # What the restart omits.
    approach_texts: tuple[str, ...] = ()  # On a mill, the legs of the approach as text.
    # On a mill, the axis positions at the beginning of the line, from home.
    axis_positions: Mapping[str, float] = field(default_factory=dict)


def make_restart_plan(
    restart_point: RestartPoint, snapshot: Snapshot, job: Job, choices: OperatorChoices
) -> RestartPlan:
    """Return the plan of a restart from the current machine state."""
    if job.setup.kinematics is not None:
        return _on_mill(restart_point, snapshot, job, choices, job.setup.kinematics)
    now = read_machine_state(snapshot, job)
    begin = make_lathe_pass_start(restart_point, now, choices)
    modal = begin.checkpoint.modal
    out = (
        describe_manual_retract(*plan_retract_from_part(restart_point.cut_record, now))
        if restart_point.cut_record is not None
        else ""
    )
    return RestartPlan(
        restart_point=restart_point,
        start_state=begin,
        state_rows=(*_make_pass_rows(restart_point), *_rows(begin.checkpoint, snapshot, job.source.dialect)),
        functions_to_start=tuple(
            _words(step, restart_point.checkpoint, job.source.dialect)
            for step in list_starting_functions(restart_point, now, choices)
        ),
        drawn_legs=()
        if out
        else make_approach_legs(begin.approach_steps, snapshot, (modal.drawing_zero_x, modal.drawing_zero_z)),
        warning_text=_left_out(restart_point),
        error_text=_collet(restart_point.checkpoint, snapshot) or out,
    )


def _on_mill(
    found: RestartPoint, snapshot: Snapshot, job: Job, choices: OperatorChoices, machine: Kinematics
) -> RestartPlan:
    now = read_machine_state(snapshot, job)
    begin = make_mill_pass_start(found, now, choices, machine)
    goal = find_start_position(found, now, machine)
    places = tuple(
        StateRow(tr(Message("MACHINE {axis}", axis=name)), _place(name, goal[name]), _place(name, at))
        for name, at in zip(machine.axis_names, now.axis_positions, strict=True)
    )
    no_way = tr("NO SAFE PATH: AXES HAVE NO LIMITS. START FROM THE FIRST LINE")
    return RestartPlan(
        restart_point=found,
        start_state=begin,
        state_rows=(*places, *_make_state_rows(begin.checkpoint, snapshot, job.source.dialect)),
        functions_to_start=tuple(
            _words(step, found.checkpoint, job.source.dialect)
            for step in list_starting_functions(found, now, choices)
        ),
        drawn_legs=(),
        approach_texts=tuple(
            step.text for step in begin.approach_steps if isinstance(step, MultiAxisLeg | FunctionStep)
        ),
        axis_positions=goal,
        warning_text=_left_out(found) or _check_rotary_axes(found, now, machine),
        error_text=no_way if explain_missing_path(machine) else "",
    )


def _check_rotary_axes(found: RestartPoint, now: CurrentMachineState, machine: Kinematics) -> str:
    """Return a warning if a rotary axis is not at zero and no earlier line positions it.

    Return an empty string if no rotary axis needs a warning.
    """
    names = {axis.name for axis in machine.rotary_axes}
    for name, wanted, at in zip(machine.axis_names, found.axis_positions, now.axis_positions, strict=True):
        if name in names and wanted is None and abs(at) > ROTATION_TOLERANCE_DEG:
            return tr(
                Message(
                    "CHECK {axis}: NO EARLIER LINE POSITIONS THIS AXIS. IT STAYS AT {position}",
                    axis=name,
                    position=formats.format_angle(at),
                )
            )
    return ""


def _place(axis: str, at: float) -> str:
    return formats.format_angle(at) if axis in "ABC" else formats.format_length(at, True)


def _make_pass_rows(found: RestartPoint) -> tuple[StateRow, ...]:
    """Return a table row for each loop and call that contains the restart line.

    Each row compares the loop pass at the line with the interrupted pass.
    """
    was = found.interrupted_visit.enclosing_levels if found.interrupted_visit is not None else ()
    return tuple(
        _pass(each, was[number] if number < len(was) else None)
        for number, each in enumerate(found.visit.enclosing_levels)
    )


def _pass(wanted: LoopPass | ActiveCall, was: LoopPass | ActiveCall | None) -> StateRow:
    if isinstance(wanted, ActiveCall):
        label = tr("CALLED FROM LINE")
        now = str(was.call_line) if isinstance(was, ActiveCall) else NO_CODE
        return StateRow(label, str(wanted.call_line), now)
    label = tr(Message("REPETITION OF LINES {first}-{last}", first=wanted.first_line, last=wanted.last_line))
    same = isinstance(was, LoopPass) and was.first_line == wanted.first_line
    return StateRow(label, _of(wanted), _of(was) if same and isinstance(was, LoopPass) else NO_CODE)


def _of(loop: LoopPass) -> str:
    return tr(Message("{number} OF {count}", number=loop.pass_number, count=loop.pass_count))


def _left_out(found: RestartPoint) -> str:
    first, last = found.skipped_lines
    if not first:
        return ""
    if first == last:
        return tr(Message("LINE {line} SKIPPED. MATERIAL REMAINS", line=first))
    return tr(Message("LINES {first} TO {last} SKIPPED. MATERIAL REMAINS", first=first, last=last))


def _rows(point: Checkpoint, snapshot: Snapshot, language: str) -> tuple[StateRow, ...]:
    wanted, now = _make_position_rows(point, *point.machine), _make_position_rows(point, *snapshot.demand[:2])
    both = zip(wanted, now, strict=True)
    places = (StateRow(w.label, w.active_code, n.active_code) for w, n in both)
    return (*places, *_make_state_rows(point, snapshot, language))


def _make_state_rows(point: Checkpoint, snapshot: Snapshot, language: str) -> tuple[StateRow, ...]:
    """Return the rows that compare the state at the line with the current state.

    The rows use the terms of the program's language.
    """
    both = zip(make_modal_rows(point, language), make_modal_rows(_now(snapshot), language), strict=True)
    return tuple(
        StateRow(w.label, w.active_code, n.active_code)
        for w, n in both
        if w.key != "comment" or w.active_code
    )


def _now(snapshot: Snapshot) -> Checkpoint:
    return Checkpoint(snapshot.modal, c=snapshot.demand[2] - snapshot.modal.offset_c, kept=snapshot.kept)


def _make_position_rows(point: Checkpoint, x: float, z: float) -> tuple[ModalRow, ...]:
    """Return the table rows of a machine position.

    The position is displayed with the tool, unit and X mode that are active at the restart line.
    """
    modal = point.modal
    mark, factor = ("Ø", 2.0) if modal.diameter else ("R", 1.0)
    return (
        ModalRow("x", f"X {mark}", formats.format_length(factor * (x - modal.offset_x), modal.metric)),
        ModalRow("z", "Z", formats.format_length(z - modal.offset_z, modal.metric)),
    )


def _words(step: ApproachStep, point: Checkpoint, language: str) -> str:
    action = getattr(step, "action", None)
    modal = point.modal
    match action:
        case SpindleRun():
            direction = tr("SPINDLE FORWARD") if modal.spindle > 0 else tr("SPINDLE REVERSE")
            speed = next(row.active_code for row in make_modal_rows(point, language) if row.key == "speed")
            return Message("{details} {speed}", details=direction, speed=speed)
        case SpindleLock():
            return tr("SPINDLE LOCKED AS C AXIS AND TURNED INTO POSITION")
        case SpindlePositioning(angle=angle):
            return tr(Message("SPINDLE ORIENTED AT {angle}", angle=formats.format_angle(angle)))
        case CoolantSwitch():
            return tr("COOLANT")
        case OutputSwitch(name=name):
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
