"""The way from where a mill stands to a line in the middle of a program, in the order that a mill allows.

Out along the tool and Z to its top; then the rotary axes, at the top of all travel; the tool that is wanted;
over the place; spindle and coolant; and in along the tool as it will cut, the last bit by feed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf

from core.geometry.rotary_axes import Kinematics
from core.geometry.rotation_frames import Vector, plus, scaled
from core.interpreter.restart.restart_approach import Choices, MachineNow, starting, stopping
from core.interpreter.restart.restart_point import RestartPoint
from core.interpreter.shared.actions import ProgramStop, SpindleStop, ToolChange
from core.interpreter.shared.checkpoint import ApproachStep, AxesLeg, Begin, FunctionStep
from core.message import Message

SHORT_OF_LIMIT = 0.01  # mm that the way stays away from the software limits
_SLOWLY_OUT = 50.0  # mm along the tool that a tool may stand in the work
_SLOWLY_IN = 5.0  # mm before the place
_SAME = 1e-6
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
