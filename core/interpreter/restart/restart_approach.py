"""The way from where the machine stands to a line in the middle of a program, as lathe or mill allows.

On a lathe: out of the work by the tool and the block that were interrupted; Z clear of the part, X over the
start, spindle and coolant; then into the work by the line. Rapids only where no metal can be. On a mill: out
along the tool and Z to its top; then the rotary axes, at the top of all travel; the tool that is wanted; over
the place; spindle and coolant; and in along the tool as it will cut, the last bit by feed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import hypot, inf

from core.geometry.rotary_axes import Kinematics
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

_SAME = 1e-6  # mm
_TURN = 360.0
_HELD = 0.5  # degrees that C may have turned under a tool that stands in a hole
_INCH = 25.4
_OWN_C = 60.0  # degrees/s: 10 rpm
_LATER = 400  # rows behind the block that was kept in which a control that was cut off may have stood


@dataclass(frozen=True, slots=True)
class MachineNow:
    """The machine as it stands: machine point (x, z, c), mm and degrees, and modal state; what broke off."""

    at: tuple[float, ...]
    modal: Modal
    broken: Interruption | None = None


@dataclass(frozen=True, slots=True)
class Choices:
    """What the operator decides. ``rapid`` and ``modest``: mm/s of legs outside and inside of the work."""

    coolant: bool = True
    rapid: float = 100 * _INCH / 60
    modest: float = 20 * _INCH / 60


def retract_from_work(cut: CutRecord, now: MachineNow) -> tuple[Retract, int]:
    """How the tool that stands in the work leaves it, and the number of that tool."""
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
    """Nothing was interrupted that is known: every tool of the program must stand where no metal can be."""
    clear = now.at[1] >= cut.clear_z - _SAME or all(
        cut.outside(*_tip(cut, now.at, tool), tool) for tool in cut.offsets
    )
    return Retract(ToolPlace.CLEAR if clear else ToolPlace.UNKNOWN)


def _stale(cut: CutRecord, broken: Interruption, x: float, z: float) -> Place | None:
    """The first row from the one that was kept on at which the tool stands now; None: at none of them."""
    row = max(0, cut.row_behind(broken.block))
    for each in range(row, min(row + _LATER, len(cut))):
        if int(cut.tool[each]) != broken.tool:
            break
        if off_row(cut, each, x, z) <= NEAR:
            return Place(int(cut.n[each]), broken.tool, x, z)
    return None


def _off_the_row(cut: CutRecord, broken: Interruption, x: float, z: float) -> Retract:
    """Stopped on the way of a restart: somewhere on the way out of the block that had been interrupted."""
    row = cut.row_behind(broken.block)
    place = None if row < 0 else nearest(cut, row, x, z)
    if place is None or int(cut.tool[row]) != broken.tool:
        return Retract(ToolPlace.UNKNOWN)
    was = retract(cut, Place(broken.block, broken.tool, *place), broken.done)
    return _on_the_way(was, place, x, z)


def _held(way: Retract, now: MachineNow) -> Retract:
    """A mill in its hole leaves only while C stands as it stood."""
    broken = now.broken
    if way.tool_place is not ToolPlace.MILL or broken is None or len(now.at) < 3 or len(broken.at) < 3:
        return way
    turned = abs(now.at[2] - broken.at[2]) % _TURN
    return way if min(turned, _TURN - turned) <= _HELD else replace(way, tool_place=ToolPlace.TURNED, legs=())


def _on_the_way(was: Retract, start: tuple[float, float], x: float, z: float) -> Retract:
    """The rest of the way out of a tool that has been moved along it already."""
    at = RetractLeg(*start)
    for number, hop in enumerate(was.legs):
        if off_line(at.x, at.z, hop.x, hop.z, x, z) <= NEAR:
            return replace(was, legs=was.legs[number:])
        at = hop
    return Retract(ToolPlace.UNKNOWN, away=was.away)


def begin_at(found: RestartPoint, now: MachineNow, choices: Choices) -> Begin:
    """The beginning of a pass that goes on from the line. C counts the turns that it really has made."""
    point, modal = found.checkpoint, found.checkpoint.modal
    if modal.c_locked:
        modal = modal._replace(offset_c=_near(point.c + modal.offset_c, now.at[2]) - point.c)
    modal = modal._replace(coolant=modal.coolant and choices.coolant)
    steps, skips = approach_steps(found, now, choices), any(found.left_out)
    return Begin(point._replace(modal=modal), found.line, approach=steps, skips_cuts=skips)


def approach_steps(found: RestartPoint, now: MachineNow, choices: Choices) -> tuple[ApproachStep, ...]:
    """Everything between the standstill of now and the first block of the line."""
    out = way_out(found.cut, now, choices) if found.cut is not None else ()
    at = _end(out, now.at)
    return (*stopping(found.checkpoint.modal, now.modal), *out, *_over(found, at, choices),
            *_starts(found, now, choices), *_in(found, at, choices))  # fmt: skip


def way_out(cut: CutRecord, now: MachineNow, choices: Choices) -> tuple[Leg, ...]:
    """Out of the work, and Z clear of the part; nothing where no way is sure."""
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
    """Whether a straight way between two machine points leads from one free place to another, and not
    through the corner of the bar."""
    (x0, z0), (x1, z1) = _tip(cut, start, tool), _tip(cut, end, tool)
    over = min(abs(x0), abs(x1)) >= cut.over - _SAME and x0 * x1 > 0.0
    before = min(z0, z1) >= cut.front(tool) - _SAME
    return cut.outside(x0, z0, tool) and cut.outside(x1, z1, tool) and (over or before)


def starting(found: RestartPoint, now: MachineNow, choices: Choices) -> tuple[ApproachStep, ...]:
    """What will start to turn, flow or switch on: the operator has to confirm it."""
    return tuple(step for step in _starts(found, now, choices) if isinstance(step, FunctionStep))


def stopping(wanted: Modal, now: Modal) -> Iterator[ApproachStep]:
    """What runs and must not, before anything moves."""
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
    elif point.at:  # C has a drive of its own, and the program has positioned it
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
    """Where C is turned to: its angle as it is, unless the program has counted it on over many turns."""
    return angle if abs(angle) <= _TURN else _near(angle, now)


def _over(found: RestartPoint, at: tuple[float, float], choices: Choices) -> Iterator[Leg]:
    """Z clear of the part where the start is farther out, then X over the first place before the work."""
    x, z = _before(found)[0]
    clear = max(at[1], z)
    yield from _leg(at[0], at[1], at[0], clear, choices, rapid=True)
    yield from _leg(at[0], clear, x, clear, choices, rapid=True)


def _in(found: RestartPoint, at: tuple[float, float], choices: Choices) -> Iterator[Leg]:
    """Down to where the work begins by rapid, and into it by the way that leads out of it."""
    places = _before(found)
    x, z = places[0][0], max(at[1], places[0][1])
    cut, tool = found.cut, found.checkpoint.modal.tool
    known = cut is not None and tool in cut.offsets
    for number, (to_x, to_z) in enumerate(places):
        free = number == 0 or (cut is not None and known and _free(cut, tool, (x, z), (to_x, to_z)))
        yield from _leg(x, z, to_x, to_z, choices, rapid=free)
        x, z = to_x, to_z


def _before(found: RestartPoint) -> list[tuple[float, float]]:
    """Machine points from the one before the work to that of the line."""
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
    """The machine angle that stands for ``angle`` and is the nearest to where C is."""
    return angle + round((now - angle) / _TURN) * _TURN


# --- on a mill -----------------------------------------------------------------------------------------


SHORT_OF_LIMIT = 0.01  # mm that the way stays away from the software limits
_SLOWLY_OUT = 50.0  # mm along the tool that a tool may stand in the work
_SLOWLY_IN = 5.0  # mm before the place
_SLIDES = "XYZ"


@dataclass(slots=True)
class _Way:
    """The legs so far, and where they have led: machine positions by axis."""

    machine: Kinematics
    at: dict[str, float]

    def to(self, goal: dict[str, float], feed: float | None) -> Iterator[AxesLeg]:
        """A leg of the axes that are not there yet."""
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
        """How far a slide can go from ``start`` away from the work along the tool, mm; inf: no limit."""
        ways = [inf]
        for slide, at, share in zip(self.machine.slides, start, self.tool_axis, strict=True):
            if abs(share) > _SAME:
                ways.append(((slide.high if share > 0.0 else slide.low) - at) / share)
        return min(ways) - SHORT_OF_LIMIT

    def along(self, start: Vector, length: float) -> dict[str, float]:
        """The place so far from ``start`` along the tool."""
        return dict(zip(_SLIDES, plus(start, scaled(self.tool_axis, length)), strict=True))


def begin_on_mill(found: RestartPoint, now: MachineNow, choices: Choices, machine: Kinematics) -> Begin:
    """The beginning of a pass that goes on from the line."""
    point, modal = found.checkpoint, found.checkpoint.modal
    modal = modal._replace(coolant=modal.coolant and choices.coolant)
    steps = tuple(_steps(found, now, choices, machine))
    return Begin(point._replace(modal=modal), found.line, approach=steps, skips_cuts=any(found.left_out))


def why_no_way(machine: Kinematics) -> str:
    """Why no way can be planned on this machine; empty where one can."""
    return "" if all(slide.high < inf for slide in machine.slides) else ("the axes have no software limits")


def goal_of(found: RestartPoint, now: MachineNow, machine: Kinematics) -> dict[str, float]:
    """Where the line begins: an axis that the program has never moved stays where it stands."""
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
    """Out of the work along the tool, slowly first, and then Z to its top."""
    start = way.slides
    room = max(way.room(start), 0.0)
    slowly = min(_SLOWLY_OUT, room)
    yield from way.to(way.along(start, slowly), choices.modest)
    yield from way.to(way.along(start, room), None)
    top = way.machine.slides[2].high - SHORT_OF_LIMIT
    if top > way.at["Z"]:
        yield from way.to({"Z": top}, None)
