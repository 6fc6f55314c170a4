"""Path from the current machine position to a restart line, on a lathe or a mill.

On a lathe, the tool leaves the part along its retract. Z moves clear of the part, and X moves to the X of
the start point. The spindle and the coolant start, and the tool enters along the reversed retract of the
line. Rapids remain outside the material. On a mill, the tool retracts along its axis, and Z moves to its
upper limit. There, the rotary axes move, the tool is changed, and X and Y move. The spindle and the coolant
start, and the tool enters along its axis, at a feed near the end.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import hypot, inf
from typing import TYPE_CHECKING

from core.geometry.rotation_frames import Vector, add_vectors, scale_vector
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.path_distances import (
    PATH_TOLERANCE_MM,
    compute_distance_from_row,
    compute_distance_from_segment,
    find_nearest_point,
)
from core.interpreter.restart.restart_point import Interruption, RestartPoint
from core.interpreter.restart.restart_retract import plan_retract
from core.interpreter.restart.tool_retract import Retract, RetractLeg, ToolPosition, ToolSituation
from core.interpreter.shared.actions import (
    CoolantSwitch,
    OutputSwitch,
    ProgramStop,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
    ToolChange,
)
from core.interpreter.shared.checkpoint import (
    ApproachStep,
    CAxisMove,
    FunctionStep,
    MultiAxisLeg,
    PassStart,
    StraightLeg,
)
from core.interpreter.shared.modal_state import ModalState
from core.message import Message

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics

_SAME = 1e-6  # mm
_TURN = 360.0
_MAX_C_TURN_DEG = 0.5  # degrees; permitted turn of C while a tool is in a hole
_INCH = 25.4
_C_SPEED_DEG_S = 60.0  # degrees/s: 10 rpm
_MAX_LATER_ROWS = 400  # number of rows after the saved block in which the tool may be after a power failure


@dataclass(frozen=True, slots=True)
class CurrentMachineState:
    """The current state of the machine.

    The state consists of the axis positions in mm and degrees, the modal state and the interruption.
    """

    axis_positions: tuple[float, ...]
    modal: ModalState
    interruption: Interruption | None = None


@dataclass(frozen=True, slots=True)
class OperatorChoices:
    """Choices of the operator for the approach.

    ``approach_speed_outside_mm_s`` and ``inside_speed_mm_s`` are the speeds outside and inside the part.
    """

    uses_coolant: bool = True
    approach_speed_outside_mm_s: float = 100 * _INCH / 60
    inside_speed_mm_s: float = 20 * _INCH / 60


def plan_retract_from_part(cut_record: CutRecord, present: CurrentMachineState) -> tuple[Retract, int]:
    """Return the retract that moves the tool in use out of the part, and the number of this tool."""
    broken = present.interruption
    if broken is None or broken.tool_number not in cut_record.tool_offsets:
        return _unknown(cut_record, present), present.modal.tool
    tool = broken.tool_number
    x, z = _tip(cut_record, present.axis_positions, tool)
    place = _find_stale_position(cut_record, broken, x, z) if broken.was_power_lost else None
    if place is not None:
        return _block_turned_mill(
            plan_retract(cut_record, place, max(broken.last_complete_block, place.block_number)), present
        ), tool
    if (
        hypot(
            present.axis_positions[0] - broken.machine_position[0],
            present.axis_positions[1] - broken.machine_position[1],
        )
        <= PATH_TOLERANCE_MM
    ):
        found = _block_turned_mill(
            plan_retract(
                cut_record, ToolPosition(broken.block_number, tool, x, z), broken.last_complete_block
            ),
            present,
        )
        return (
            found
            if found.tool_situation is not ToolSituation.UNKNOWN
            else _remaining_retract(cut_record, broken, x, z)
        ), tool
    if cut_record.is_outside_material(x, z, tool):
        return Retract(ToolSituation.CLEAR), tool
    was = plan_retract(
        cut_record,
        ToolPosition(broken.block_number, tool, *_tip(cut_record, broken.machine_position, tool)),
        broken.last_complete_block,
    )
    return _shorten_retract(was, _tip(cut_record, broken.machine_position, tool), x, z), tool


def _tip(cut: CutRecord, at: tuple[float, ...], tool: int) -> tuple[float, float]:
    off_x, off_z = cut.tool_offsets[tool]
    return at[0] - off_x, at[1] - off_z


def _unknown(cut_record: CutRecord, present: CurrentMachineState) -> Retract:
    """Return the retract for a tool whose point of interruption is unknown.

    The tool counts as clear only if every tool of the program would be outside the material here.
    """
    clear = present.axis_positions[1] >= cut_record.max_machine_z - _SAME or all(
        cut_record.is_outside_material(*_tip(cut_record, present.axis_positions, tool), tool)
        for tool in cut_record.tool_offsets
    )
    return Retract(ToolSituation.CLEAR if clear else ToolSituation.UNKNOWN)


def _find_stale_position(
    cut_record: CutRecord, interruption: Interruption, x: float, z: float
) -> ToolPosition | None:
    """Search the rows from the interrupted block on for the first that passes through (x, z).

    Returns None if there is none before the tool changes, or within ``_MAX_LATER_ROWS`` rows.
    """
    row = max(0, cut_record.find_last_row(interruption.block_number))
    for each in range(row, min(row + _MAX_LATER_ROWS, len(cut_record))):
        if int(cut_record.tool_numbers[each]) != interruption.tool_number:
            break
        if compute_distance_from_row(cut_record, each, x, z) <= PATH_TOLERANCE_MM:
            return ToolPosition(int(cut_record.block_numbers[each]), interruption.tool_number, x, z)
    return None


def _remaining_retract(cut_record: CutRecord, interruption: Interruption, x: float, z: float) -> Retract:
    """Return the rest of a retract if an earlier restart was stopped in its approach or retract."""
    row = cut_record.find_last_row(interruption.block_number)
    place = None if row < 0 else find_nearest_point(cut_record, row, x, z)
    if place is None or int(cut_record.tool_numbers[row]) != interruption.tool_number:
        return Retract(ToolSituation.UNKNOWN)
    was = plan_retract(
        cut_record,
        ToolPosition(interruption.block_number, interruption.tool_number, *place),
        interruption.last_complete_block,
    )
    return _shorten_retract(was, place, x, z)


def _block_turned_mill(retract: Retract, present: CurrentMachineState) -> Retract:
    """Return the retract, but without its path if C has rotated while a milling tool is in its cut."""
    broken = present.interruption
    if (
        retract.tool_situation is not ToolSituation.MILLING
        or broken is None
        or len(present.axis_positions) < 3
        or len(broken.machine_position) < 3
    ):
        return retract
    turned = abs(present.axis_positions[2] - broken.machine_position[2]) % _TURN
    return (
        retract
        if min(turned, _TURN - turned) <= _MAX_C_TURN_DEG
        else replace(retract, tool_situation=ToolSituation.PART_TURNED, legs=())
    )


def _shorten_retract(retract: Retract, start: tuple[float, float], x: float, z: float) -> Retract:
    """Return the retract without the distance that the tool has already traveled."""
    at = RetractLeg(*start)
    for number, hop in enumerate(retract.legs):
        if compute_distance_from_segment(at.x, at.z, hop.x, hop.z, x, z) <= PATH_TOLERANCE_MM:
            return replace(retract, legs=retract.legs[number:])
        at = hop
    return Retract(ToolSituation.UNKNOWN, direction=retract.direction)


def make_lathe_pass_start(
    restart_point: RestartPoint, present: CurrentMachineState, choices: OperatorChoices
) -> PassStart:
    """Return the start of a pass at a line of a lathe, with C at the nearest equivalent angle."""
    point, modal = restart_point.checkpoint, restart_point.checkpoint.modal
    if modal.c_locked:
        modal = modal._replace(
            offset_c=_nearest_angle(point.c + modal.offset_c, present.axis_positions[2]) - point.c
        )
    modal = modal._replace(coolant=modal.coolant and choices.uses_coolant)
    steps, skips = plan_lathe_approach(restart_point, present, choices), any(restart_point.skipped_lines)
    return PassStart(
        point._replace(modal=modal), restart_point.line_number, approach_steps=steps, skips_cuts=skips
    )


def plan_lathe_approach(
    restart_point: RestartPoint, present: CurrentMachineState, choices: OperatorChoices
) -> tuple[ApproachStep, ...]:
    """Return all approach steps from the current position, at rest, to the start of the line."""
    out = (
        plan_exit_moves(restart_point.cut_record, present, choices)
        if restart_point.cut_record is not None
        else ()
    )
    at = _end(out, present.axis_positions)
    return (
        *list_stopping_functions(restart_point.checkpoint.modal, present.modal),
        *out,
        *_moves_above_part(restart_point, at, choices),
        *_starts(restart_point, present, choices),
        *_entry_moves(restart_point, at, choices),
    )


def plan_exit_moves(
    cut_record: CutRecord, present: CurrentMachineState, choices: OperatorChoices
) -> tuple[StraightLeg, ...]:
    """Return the moves that bring the tool out of the part, with Z clear of the part.

    The result is empty if no safe path is known.
    """
    found, tool = plan_retract_from_part(cut_record, present)
    if not found.is_known:
        return ()
    x, z = present.axis_positions[0], present.axis_positions[1]
    legs: list[StraightLeg] = []
    if found.legs:
        off_x, off_z = cut_record.tool_offsets[tool]
        for hop in found.legs:
            to_x, to_z = hop.x + off_x, hop.z + off_z
            legs += _leg(x, z, to_x, to_z, choices, rapid=_free(cut_record, tool, (x, z), (to_x, to_z)))
            x, z = to_x, to_z
    return (*legs, *_leg(x, z, x, max(z, cut_record.max_machine_z), choices, rapid=True))


def _free(cut_record: CutRecord, tool: int, start: tuple[float, float], end: tuple[float, float]) -> bool:
    """Return whether a straight move between two machine points remains outside the material.

    The move must also not cross the corner of the bar.
    """
    (x0, z0), (x1, z1) = _tip(cut_record, start, tool), _tip(cut_record, end, tool)
    over = min(abs(x0), abs(x1)) >= cut_record.retract_radius - _SAME and x0 * x1 > 0.0
    before = min(z0, z1) >= cut_record.compute_front_z(tool) - _SAME
    return (
        cut_record.is_outside_material(x0, z0, tool)
        and cut_record.is_outside_material(x1, z1, tool)
        and (over or before)
    )


def list_starting_functions(
    restart_point: RestartPoint, present: CurrentMachineState, choices: OperatorChoices
) -> tuple[ApproachStep, ...]:
    """Return the machine functions that the restart will turn on, for confirmation by the operator."""
    return tuple(step for step in _starts(restart_point, present, choices) if isinstance(step, FunctionStep))


def list_stopping_functions(target: ModalState, present: ModalState) -> Iterator[ApproachStep]:
    """Yield the machine functions that must stop before the approach moves an axis."""
    if present.spindle and present.spindle != target.spindle:
        yield FunctionStep(SpindleStop(), "M05")
    if present.coolant and not target.coolant:
        yield FunctionStep(CoolantSwitch(False), "M09")
    for name in sorted(present.outputs - target.outputs):
        yield FunctionStep(OutputSwitch(name, False), Message("{name} OFF", name=name.upper()))


def _starts(
    found: RestartPoint, now: CurrentMachineState, choices: OperatorChoices
) -> Iterator[ApproachStep]:
    point, wanted = found.checkpoint, found.checkpoint.modal
    if wanted.c_locked:
        yield FunctionStep(SpindleLock(orient=False), "M89")
        yield CAxisMove(
            _nearest_angle(point.c + wanted.offset_c, now.axis_positions[2]),
            (wanted.c_rpm or 10.0) * 6.0,
            "C",
        )
    elif point.at:  # C has a separate drive, and the program has positioned it.
        yield CAxisMove(_target_c_angle(point.at[2], now.axis_positions[2]), _C_SPEED_DEG_S, "C")
    if wanted.oriented is not None:
        yield FunctionStep(SpindlePositioning(wanted.oriented), f"M19 {wanted.oriented:g}")
    if wanted.spindle and not wanted.c_locked:
        surface = wanted.surface_speed if wanted.css else None
        text = f"{'M03' if wanted.spindle > 0 else 'M04'}"
        yield FunctionStep(SpindleRun(wanted.spindle * wanted.rpm, surface), text)
    for name in sorted(wanted.outputs - now.modal.outputs):
        yield FunctionStep(OutputSwitch(name, True), Message("{name} ON", name=name.upper()))
    if wanted.coolant and choices.uses_coolant:
        yield FunctionStep(CoolantSwitch(True), "M08")


def _target_c_angle(angle: float, present: float) -> float:
    """Return the target angle of C; beyond one revolution, use the nearest equivalent angle."""
    return angle if abs(angle) <= _TURN else _nearest_angle(angle, present)


def _moves_above_part(
    restart_point: RestartPoint, at: tuple[float, float], choices: OperatorChoices
) -> Iterator[StraightLeg]:
    """Yield the move of Z clear of the part and the move of X to the first point outside the part."""
    x, z = _entry_points(restart_point)[0]
    clear = max(at[1], z)
    yield from _leg(at[0], at[1], at[0], clear, choices, rapid=True)
    yield from _leg(at[0], clear, x, clear, choices, rapid=True)


def _entry_moves(
    restart_point: RestartPoint, at: tuple[float, float], choices: OperatorChoices
) -> Iterator[StraightLeg]:
    """Yield the rapid to the part, and the entry along the reversed retract path."""
    places = _entry_points(restart_point)
    x, z = places[0][0], max(at[1], places[0][1])
    cut, tool = restart_point.cut_record, restart_point.checkpoint.modal.tool
    known = cut is not None and tool in cut.tool_offsets
    for number, (to_x, to_z) in enumerate(places):
        free = number == 0 or (cut is not None and known and _free(cut, tool, (x, z), (to_x, to_z)))
        yield from _leg(x, z, to_x, to_z, choices, rapid=free)
        x, z = to_x, to_z


def _entry_points(restart_point: RestartPoint) -> list[tuple[float, float]]:
    """Return the machine points of the entry.

    The points are in order from the point outside the part to the start point of the line.
    """
    goal = restart_point.checkpoint.machine
    modal = restart_point.checkpoint.modal
    hops = [
        (hop.x + modal.drawing_zero_x, hop.z + modal.drawing_zero_z) for hop in restart_point.retract.legs
    ]
    return [*reversed(hops), goal]


def _end(legs: tuple[StraightLeg, ...], at: tuple[float, ...]) -> tuple[float, float]:
    x, z = at[0], at[1]
    for leg in legs:
        x, z = x if leg.x is None else leg.x, z if leg.z is None else leg.z
    return x, z


def _leg(
    x: float, z: float, to_x: float, to_z: float, choices: OperatorChoices, *, rapid: bool
) -> list[StraightLeg]:
    along_x, along_z = abs(to_x - x) > _SAME, abs(to_z - z) > _SAME
    if not (along_x or along_z):
        return []
    text = ("X" if along_x else "") + ("Z" if along_z else "")
    feed = choices.approach_speed_outside_mm_s if rapid else choices.inside_speed_mm_s
    return [StraightLeg(to_x if along_x else None, to_z if along_z else None, feed, rapid, text)]


def _nearest_angle(angle: float, present: float) -> float:
    """Return the machine angle equivalent to ``angle`` that is nearest to the current angle."""
    return angle + round((present - angle) / _TURN) * _TURN


# --- on a mill -----------------------------------------------------------------------------------------


LIMIT_CLEARANCE_MM = 0.01  # mm; distance of the path from the software limits
_SLOW_RETRACT_MM = 50.0  # mm along the tool axis; maximum depth of a tool in the part
_SLOW_ENTRY_MM = 5.0  # mm before the target
_LINEAR_AXES = "XYZ"


@dataclass(slots=True)
class _MovePlan:
    """The moves planned so far, and the machine position by axis at the end of these moves."""

    kinematics: Kinematics
    axis_positions: dict[str, float]

    def move_to(self, target: dict[str, float], feed: float | None) -> Iterator[MultiAxisLeg]:
        """Yield a move of the axes that are not at the target yet."""
        moving = {
            name: value for name, value in target.items() if abs(value - self.axis_positions[name]) > _SAME
        }
        self.axis_positions |= moving
        if moving:
            yield MultiAxisLeg(tuple(moving.items()), feed, " ".join(moving))

    @property
    def linear_position(self) -> Vector:
        return self.axis_positions["X"], self.axis_positions["Y"], self.axis_positions["Z"]

    @property
    def tool_axis(self) -> Vector:
        return self.kinematics.compute_tool_direction(self.axis_positions)

    def compute_available_travel(self, start: Vector) -> float:
        """Return the possible travel from ``start`` along the tool axis away from the part, in mm.

        The travel is inf if no axis has a limit.
        """
        ways = [inf]
        for slide, at, share in zip(self.kinematics.linear_axes, start, self.tool_axis, strict=True):
            if abs(share) > _SAME:
                ways.append(((slide.travel_max if share > 0.0 else slide.travel_min) - at) / share)
        return min(ways) - LIMIT_CLEARANCE_MM

    def offset_position(self, start: Vector, length: float) -> dict[str, float]:
        """Return the position at the distance ``length`` from ``start`` along the tool axis."""
        return dict(zip(_LINEAR_AXES, add_vectors(start, scale_vector(self.tool_axis, length)), strict=True))


def make_mill_pass_start(
    restart_point: RestartPoint,
    present: CurrentMachineState,
    choices: OperatorChoices,
    kinematics: Kinematics,
) -> PassStart:
    """Return the start of a pass at the restart line on a mill."""
    point, modal = restart_point.checkpoint, restart_point.checkpoint.modal
    modal = modal._replace(coolant=modal.coolant and choices.uses_coolant)
    steps = tuple(_steps(restart_point, present, choices, kinematics))
    return PassStart(
        point._replace(modal=modal),
        restart_point.line_number,
        approach_steps=steps,
        skips_cuts=any(restart_point.skipped_lines),
    )


def explain_missing_path(kinematics: Kinematics) -> str:
    """Return the reason why no path can be planned on this machine.

    The result is an empty string if a path can be planned.
    """
    return (
        ""
        if all(slide.travel_max < inf for slide in kinematics.linear_axes)
        else ("the axes have no software limits")
    )


def find_start_position(
    restart_point: RestartPoint, present: CurrentMachineState, kinematics: Kinematics
) -> dict[str, float]:
    """Return the start position of the line by axis; an axis that the program has not moved does not move."""
    places = zip(kinematics.axis_names, restart_point.axis_positions, present.axis_positions, strict=True)
    return {name: at if wanted is None else wanted for name, wanted, at in places}


def _steps(
    found: RestartPoint, now: CurrentMachineState, choices: OperatorChoices, machine: Kinematics
) -> Iterator[ApproachStep]:
    wanted, goal = found.checkpoint.modal, find_start_position(found, now, machine)
    move_plan = _MovePlan(machine, dict(zip(machine.axis_names, now.axis_positions, strict=True)))
    change = wanted.tool not in {0, now.modal.tool}
    if change and now.modal.spindle:
        yield FunctionStep(SpindleStop(), "M5")
        now = replace(now, modal=now.modal._replace(spindle=0))
    yield from list_stopping_functions(wanted, now.modal)
    yield from _retract_moves(move_plan, choices)
    yield from move_plan.move_to({name: at for name, at in goal.items() if name not in _LINEAR_AXES}, None)
    if change:
        yield FunctionStep(ToolChange(wanted.tool), Message("TOOL CALL {tool}", tool=wanted.tool))
        yield FunctionStep(
            ProgramStop(optional=False, message=Message("TOOL {tool}", tool=wanted.tool)), "STOP"
        )
    place: Vector = goal["X"], goal["Y"], goal["Z"]
    room = max(move_plan.compute_available_travel(place), 0.0)
    over = move_plan.offset_position(place, room)
    yield from move_plan.move_to({"X": over["X"], "Y": over["Y"]}, None)
    yield from list_starting_functions(found, now, choices)
    yield from move_plan.move_to(over, None)
    yield from move_plan.move_to(move_plan.offset_position(place, min(_SLOW_ENTRY_MM, room)), None)
    yield from move_plan.move_to(move_plan.offset_position(place, 0.0), choices.inside_speed_mm_s)


def _retract_moves(plan: _MovePlan, choices: OperatorChoices) -> Iterator[MultiAxisLeg]:
    """Yield the retract along the tool axis, slow at first, and then the move of Z to its upper limit."""
    start = plan.linear_position
    room = max(plan.compute_available_travel(start), 0.0)
    slowly = min(_SLOW_RETRACT_MM, room)
    yield from plan.move_to(plan.offset_position(start, slowly), choices.inside_speed_mm_s)
    yield from plan.move_to(plan.offset_position(start, room), None)
    top = plan.kinematics.linear_axes[2].travel_max - LIMIT_CLEARANCE_MM
    if top > plan.axis_positions["Z"]:
        yield from plan.move_to({"Z": top}, None)
