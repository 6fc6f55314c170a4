"""Path from the present machine position to a line in the middle of a program, on a lathe or mill.

On a lathe, the tool leaves the part as the interrupted block requires. Z moves clear of the part, X moves
over the start, spindle and coolant start, and the tool enters as the line requires. Rapids are only outside
the material. On a mill, the tool retracts along its axis, and Z moves to its upper limit. The rotary axes
move there, the tool is changed, and the tool moves over the position. Spindle and coolant start, and the tool
enters along its axis, with a feed at the end.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import hypot, inf
from typing import TYPE_CHECKING

from core.geometry.rotation_frames import Vector, plus, scaled
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_point import Interruption, RestartPoint
from core.interpreter.restart.restart_retract import (
    NEAR,
    Place,
    Retract,
    RetractLeg,
    ToolPlace,
    nearest,
    off_line,
    off_row,
    retract,
)
from core.interpreter.shared.actions import (
    Coolant,
    Output,
    ProgramStop,
    SpindleLock,
    SpindleOrient,
    SpindleRun,
    SpindleStop,
    ToolChange,
)
from core.interpreter.shared.checkpoint import ApproachStep, AxesLeg, Begin, CTurn, FunctionStep, Leg
from core.interpreter.shared.modal_state import Modal
from core.message import Message

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics

_SAME = 1e-6  # mm
_TURN = 360.0
_HELD = 0.5  # degrees; permitted turn of C while a tool is in a hole
_INCH = 25.4
_OWN_C = 60.0  # degrees/s: 10 rpm
_LATER = 400  # number of rows after the saved block in which the tool may be after a power failure


@dataclass(frozen=True, slots=True)
class MachineNow:
    """Present machine state: position (x, z, c) in mm and degrees, modal state, and the interruption."""

    at: tuple[float, ...]
    modal: Modal
    broken: Interruption | None = None


@dataclass(frozen=True, slots=True)
class Choices:
    """Decisions of the operator. ``rapid`` and ``modest`` are speeds outside and inside the part, in mm/s."""

    coolant: bool = True
    rapid: float = 100 * _INCH / 60
    modest: float = 20 * _INCH / 60


def retract_from_work(cut: CutRecord, now: MachineNow) -> tuple[Retract, int]:
    """Return the retract of the tool from the part, and the number of that tool."""
    broken = now.broken
    if broken is None or broken.tool not in cut.offsets:
        return _unknown(cut, now), now.modal.tool
    tool = broken.tool
    x, z = _tip(cut, now.at, tool)
    place = _stale(cut, broken, x, z) if broken.stale else None
    if place is not None:
        return _held(retract(cut, place, max(broken.done, place.block)), now), tool
    if hypot(now.at[0] - broken.at[0], now.at[1] - broken.at[1]) <= NEAR:
        found = _held(retract(cut, Place(broken.block, tool, x, z), broken.done), now)
        return (found if found.tool_place is not ToolPlace.UNKNOWN else _off_the_row(cut, broken, x, z)), tool
    if cut.outside(x, z, tool):
        return Retract(ToolPlace.CLEAR), tool
    was = retract(cut, Place(broken.block, tool, *_tip(cut, broken.at, tool)), broken.done)
    return _on_the_way(was, _tip(cut, broken.at, tool), x, z), tool


def _tip(cut: CutRecord, at: tuple[float, ...], tool: int) -> tuple[float, float]:
    off_x, off_z = cut.offsets[tool]
    return at[0] - off_x, at[1] - off_z


def _unknown(cut: CutRecord, now: MachineNow) -> Retract:
    """Return the retract without a known interruption.

    The tool is clear only if all tools of the program are outside the material.
    """
    clear = now.at[1] >= cut.clear_z - _SAME or all(
        cut.outside(*_tip(cut, now.at, tool), tool) for tool in cut.offsets
    )
    return Retract(ToolPlace.CLEAR if clear else ToolPlace.UNKNOWN)


def _stale(cut: CutRecord, broken: Interruption, x: float, z: float) -> Place | None:
    """Return the first row, from the saved one on, at which the tool is now; otherwise None."""
    row = max(0, cut.row_behind(broken.block))
    for each in range(row, min(row + _LATER, len(cut))):
        if int(cut.tool[each]) != broken.tool:
            break
        if off_row(cut, each, x, z) <= NEAR:
            return Place(int(cut.n[each]), broken.tool, x, z)
    return None


def _off_the_row(cut: CutRecord, broken: Interruption, x: float, z: float) -> Retract:
    """Return the remaining retract after a stop on the approach or retract of an earlier restart."""
    row = cut.row_behind(broken.block)
    place = None if row < 0 else nearest(cut, row, x, z)
    if place is None or int(cut.tool[row]) != broken.tool:
        return Retract(ToolPlace.UNKNOWN)
    was = retract(cut, Place(broken.block, broken.tool, *place), broken.done)
    return _on_the_way(was, place, x, z)


def _held(way: Retract, now: MachineNow) -> Retract:
    """Return the retract; a mill in its hole can leave only if C has not turned."""
    broken = now.broken
    if way.tool_place is not ToolPlace.MILL or broken is None or len(now.at) < 3 or len(broken.at) < 3:
        return way
    turned = abs(now.at[2] - broken.at[2]) % _TURN
    return way if min(turned, _TURN - turned) <= _HELD else replace(way, tool_place=ToolPlace.TURNED, legs=())


def _on_the_way(was: Retract, start: tuple[float, float], x: float, z: float) -> Retract:
    """Return the rest of a retract along which the tool has already moved."""
    at = RetractLeg(*start)
    for number, hop in enumerate(was.legs):
        if off_line(at.x, at.z, hop.x, hop.z, x, z) <= NEAR:
            return replace(was, legs=was.legs[number:])
        at = hop
    return Retract(ToolPlace.UNKNOWN, away=was.away)


def begin_at(found: RestartPoint, now: MachineNow, choices: Choices) -> Begin:
    """Return the start of a pass at the line, with the real number of revolutions of C."""
    point, modal = found.checkpoint, found.checkpoint.modal
    if modal.c_locked:
        modal = modal._replace(offset_c=_near(point.c + modal.offset_c, now.at[2]) - point.c)
    modal = modal._replace(coolant=modal.coolant and choices.coolant)
    steps, skips = approach_steps(found, now, choices), any(found.left_out)
    return Begin(point._replace(modal=modal), found.line, approach=steps, skips_cuts=skips)


def approach_steps(found: RestartPoint, now: MachineNow, choices: Choices) -> tuple[ApproachStep, ...]:
    """Return all steps between the present standstill and the first block of the line."""
    out = way_out(found.cut, now, choices) if found.cut is not None else ()
    at = _end(out, now.at)
    return (*stopping(found.checkpoint.modal, now.modal), *out, *_over(found, at, choices),
            *_starts(found, now, choices), *_in(found, at, choices))  # fmt: skip


def way_out(cut: CutRecord, now: MachineNow, choices: Choices) -> tuple[Leg, ...]:
    """Return the moves out of the part, with Z clear of it; empty if no safe path is known."""
    found, tool = retract_from_work(cut, now)
    if not found.known:
        return ()
    x, z = now.at[0], now.at[1]
    legs: list[Leg] = []
    if found.legs:
        off_x, off_z = cut.offsets[tool]
        for hop in found.legs:
            to_x, to_z = hop.x + off_x, hop.z + off_z
            legs += _leg(x, z, to_x, to_z, choices, rapid=_free(cut, tool, (x, z), (to_x, to_z)))
            x, z = to_x, to_z
    return (*legs, *_leg(x, z, x, max(z, cut.clear_z), choices, rapid=True))


def _free(cut: CutRecord, tool: int, start: tuple[float, float], end: tuple[float, float]) -> bool:
    """Return whether a straight move between two machine points remains outside the material.

    The move must not cross the corner of the bar.
    """
    (x0, z0), (x1, z1) = _tip(cut, start, tool), _tip(cut, end, tool)
    over = min(abs(x0), abs(x1)) >= cut.over - _SAME and x0 * x1 > 0.0
    before = min(z0, z1) >= cut.front(tool) - _SAME
    return cut.outside(x0, z0, tool) and cut.outside(x1, z1, tool) and (over or before)


def starting(found: RestartPoint, now: MachineNow, choices: Choices) -> tuple[ApproachStep, ...]:
    """Return the functions that will start or turn on, which the operator must confirm."""
    return tuple(step for step in _starts(found, now, choices) if isinstance(step, FunctionStep))


def stopping(wanted: Modal, now: Modal) -> Iterator[ApproachStep]:
    """Yield the functions that must stop before any motion."""
    if now.spindle and now.spindle != wanted.spindle:
        yield FunctionStep(SpindleStop(), "M05")
    if now.coolant and not wanted.coolant:
        yield FunctionStep(Coolant(False), "M09")
    for name in sorted(now.outputs - wanted.outputs):
        yield FunctionStep(Output(name, False), Message("{name} OFF", name=name.upper()))


def _starts(found: RestartPoint, now: MachineNow, choices: Choices) -> Iterator[ApproachStep]:
    point, wanted = found.checkpoint, found.checkpoint.modal
    if wanted.c_locked:
        yield FunctionStep(SpindleLock(orient=False), "M89")
        yield CTurn(_near(point.c + wanted.offset_c, now.at[2]), (wanted.c_rpm or 10.0) * 6.0, "C")
    elif point.at:  # C has a separate drive, and the program has positioned it.
        yield CTurn(_own_c(point.at[2], now.at[2]), _OWN_C, "C")
    if wanted.oriented is not None:
        yield FunctionStep(SpindleOrient(wanted.oriented), f"M19 {wanted.oriented:g}")
    if wanted.spindle and not wanted.c_locked:
        surface = wanted.surface_speed if wanted.css else None
        text = f"{'M03' if wanted.spindle > 0 else 'M04'}"
        yield FunctionStep(SpindleRun(wanted.spindle * wanted.rpm, surface), text)
    for name in sorted(wanted.outputs - now.modal.outputs):
        yield FunctionStep(Output(name, True), Message("{name} ON", name=name.upper()))
    if wanted.coolant and choices.coolant:
        yield FunctionStep(Coolant(True), "M08")


def _own_c(angle: float, now: float) -> float:
    """Return the target angle of C, unless the program has counted many revolutions."""
    return angle if abs(angle) <= _TURN else _near(angle, now)


def _over(found: RestartPoint, at: tuple[float, float], choices: Choices) -> Iterator[Leg]:
    """Yield the moves of Z clear of the part and of X over the first point outside the part."""
    x, z = _before(found)[0]
    clear = max(at[1], z)
    yield from _leg(at[0], at[1], at[0], clear, choices, rapid=True)
    yield from _leg(at[0], clear, x, clear, choices, rapid=True)


def _in(found: RestartPoint, at: tuple[float, float], choices: Choices) -> Iterator[Leg]:
    """Yield the rapid to the start of the part, and the entry along the reversed retract path."""
    places = _before(found)
    x, z = places[0][0], max(at[1], places[0][1])
    cut, tool = found.cut, found.checkpoint.modal.tool
    known = cut is not None and tool in cut.offsets
    for number, (to_x, to_z) in enumerate(places):
        free = number == 0 or (cut is not None and known and _free(cut, tool, (x, z), (to_x, to_z)))
        yield from _leg(x, z, to_x, to_z, choices, rapid=free)
        x, z = to_x, to_z


def _before(found: RestartPoint) -> list[tuple[float, float]]:
    """Return the machine points from the one outside the part to that of the line."""
    goal = found.checkpoint.machine
    modal = found.checkpoint.modal
    hops = [(hop.x + modal.base_x, hop.z + modal.base_z) for hop in found.back.legs]
    return [*reversed(hops), goal]


def _end(legs: tuple[Leg, ...], at: tuple[float, ...]) -> tuple[float, float]:
    x, z = at[0], at[1]
    for leg in legs:
        x, z = x if leg.x is None else leg.x, z if leg.z is None else leg.z
    return x, z


def _leg(x: float, z: float, to_x: float, to_z: float, choices: Choices, *, rapid: bool) -> list[Leg]:
    along_x, along_z = abs(to_x - x) > _SAME, abs(to_z - z) > _SAME
    if not (along_x or along_z):
        return []
    text = ("X" if along_x else "") + ("Z" if along_z else "")
    feed = choices.rapid if rapid else choices.modest
    return [Leg(to_x if along_x else None, to_z if along_z else None, feed, rapid, text)]


def _near(angle: float, now: float) -> float:
    """Return the machine angle equivalent to ``angle`` that is nearest to the present angle."""
    return angle + round((now - angle) / _TURN) * _TURN


# --- on a mill -----------------------------------------------------------------------------------------


SHORT_OF_LIMIT = 0.01  # mm; distance of the path from the software limits
_SLOWLY_OUT = 50.0  # mm along the tool axis; maximum depth of a tool in the part
_SLOWLY_IN = 5.0  # mm before the target
_SLIDES = "XYZ"


@dataclass(slots=True)
class _Way:
    """The moves so far, and their end in machine positions by axis."""

    machine: Kinematics
    at: dict[str, float]

    def to(self, goal: dict[str, float], feed: float | None) -> Iterator[AxesLeg]:
        """Yield a move of the axes that are not yet at the target."""
        moving = {name: value for name, value in goal.items() if abs(value - self.at[name]) > _SAME}
        self.at |= moving
        if moving:
            yield AxesLeg(tuple(moving.items()), feed, " ".join(moving))

    @property
    def slides(self) -> Vector:
        return self.at["X"], self.at["Y"], self.at["Z"]

    @property
    def tool_axis(self) -> Vector:
        return self.machine.tool_axis(self.at)

    def room(self, start: Vector) -> float:
        """Return the possible travel from ``start`` along the tool axis away from the part, in mm.

        It is inf without limits.
        """
        ways = [inf]
        for slide, at, share in zip(self.machine.slides, start, self.tool_axis, strict=True):
            if abs(share) > _SAME:
                ways.append(((slide.high if share > 0.0 else slide.low) - at) / share)
        return min(ways) - SHORT_OF_LIMIT

    def along(self, start: Vector, length: float) -> dict[str, float]:
        """Return the position at this distance from ``start`` along the tool."""
        return dict(zip(_SLIDES, plus(start, scaled(self.tool_axis, length)), strict=True))


def begin_on_mill(found: RestartPoint, now: MachineNow, choices: Choices, machine: Kinematics) -> Begin:
    """Return the start of a pass at the line on a mill."""
    point, modal = found.checkpoint, found.checkpoint.modal
    modal = modal._replace(coolant=modal.coolant and choices.coolant)
    steps = tuple(_steps(found, now, choices, machine))
    return Begin(point._replace(modal=modal), found.line, approach=steps, skips_cuts=any(found.left_out))


def why_no_way(machine: Kinematics) -> str:
    """Return why no path can be planned on this machine; empty if it is possible."""
    return "" if all(slide.high < inf for slide in machine.slides) else ("the axes have no software limits")


def goal_of(found: RestartPoint, now: MachineNow, machine: Kinematics) -> dict[str, float]:
    """Return the start position of the line; an axis that the program has not moved remains."""
    places = zip(machine.names, found.axes, now.at, strict=True)
    return {name: at if wanted is None else wanted for name, wanted, at in places}


def _steps(
    found: RestartPoint, now: MachineNow, choices: Choices, machine: Kinematics
) -> Iterator[ApproachStep]:
    wanted, goal = found.checkpoint.modal, goal_of(found, now, machine)
    way = _Way(machine, dict(zip(machine.names, now.at, strict=True)))
    change = wanted.tool not in {0, now.modal.tool}
    if change and now.modal.spindle:
        yield FunctionStep(SpindleStop(), "M5")
        now = replace(now, modal=now.modal._replace(spindle=0))
    yield from stopping(wanted, now.modal)
    yield from _out(way, choices)
    yield from way.to({name: at for name, at in goal.items() if name not in _SLIDES}, None)
    if change:
        yield FunctionStep(ToolChange(wanted.tool), Message("TOOL CALL {tool}", tool=wanted.tool))
        yield FunctionStep(
            ProgramStop(optional=False, message=Message("TOOL {tool}", tool=wanted.tool)), "STOP"
        )
    place: Vector = goal["X"], goal["Y"], goal["Z"]
    room = max(way.room(place), 0.0)
    over = way.along(place, room)
    yield from way.to({"X": over["X"], "Y": over["Y"]}, None)
    yield from starting(found, now, choices)
    yield from way.to(over, None)
    yield from way.to(way.along(place, min(_SLOWLY_IN, room)), None)
    yield from way.to(way.along(place, 0.0), choices.modest)


def _out(way: _Way, choices: Choices) -> Iterator[AxesLeg]:
    """Yield the retract along the tool, slow at first, and then Z to its upper limit."""
    start = way.slides
    room = max(way.room(start), 0.0)
    slowly = min(_SLOWLY_OUT, room)
    yield from way.to(way.along(start, slowly), choices.modest)
    yield from way.to(way.along(start, room), None)
    top = way.machine.slides[2].high - SHORT_OF_LIMIT
    if top > way.at["Z"]:
        yield from way.to({"Z": top}, None)
