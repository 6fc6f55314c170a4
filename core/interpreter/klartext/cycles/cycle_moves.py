"""What cycles are made of: the tool above the plane, its ways and rings, dwells, the spindle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.working_plane import HelixMove
from core.interpreter.klartext.klartext_state import SLIDES, State
from core.interpreter.klartext.motion.feed_rates import per_minute
from core.interpreter.klartext.setup.tool_call import radius_of
from core.interpreter.shared.actions import (
    Coolant,
    Dwell,
    ProgramStop,
    SpindleOrient,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext.klartext_faults import CYCLE_MISSING, INPUT_VALUE, WRONG_RPM
from core.language.klartext.q_parameters import MAX_FEED, TOOL_FEED

_TURN = 360.0
UNORIENTED = "the spindle of this machine cannot be oriented"
HOW_ORIENTED = (
    "set oriented = true under [spindle] in the machine file if the drive can stop the spindle at an angle"
)

Parameters = Mapping[int, int | float | None]
"""Numbers of Q parameters: that of another cycle as an int, a value of its own as a float."""


def oriented(state: State, angle: float) -> Block:
    """The spindle held at an angle, degrees from its index, the short way."""
    state.modal = state.modal._replace(spindle=0, oriented=angle % _TURN)
    return state.action(SpindleOrient(angle % _TURN))


class CycleTool:
    """The tool in a cycle that was called at ``column`` of a block; mm, in the program's coordinates.

    ``value`` gives a parameter of the cycle by the number of its Q, as written.
    """

    def __init__(self, state: State, number: int, value: Callable[[int], float | None], column: int) -> None:
        self._state = state
        self._number = number
        self._value = value
        self._column = column
        self._told_as: Parameters = {}

    def seen(self, parameters: Parameters) -> CycleTool:
        """The same tool as another cycle sees it, whose parameters are others of this one, or fixed values.

        Lengths among the values are in the program's unit. What is not named has not been told.
        """

        def value(q: int) -> float | None:
            found = parameters.get(q)
            return self._value(found) if isinstance(found, int) else found

        other = CycleTool(self._state, self._number, value, self._column)
        other._told_as = parameters
        return other

    def named(self, q: int) -> str:
        """A parameter as the program has it."""
        found = self._told_as.get(q, q)
        return f"Q{found if isinstance(found, int) else q}"

    @property
    def scale(self) -> float:
        """Millimetres of the program's unit."""
        return self._state.scale

    # --- what the cycle was told --------------------------------------------------------------------------

    def plain(self, q: int, default: float | None = None) -> float:
        """A parameter as written. Raises ProgramError where it is missing and has no ``default``."""
        found = self._value(q)
        if found is None:
            found = default
        if found is None:
            text, hint = "Cycle {number} needs {parameter}.", "Add the parameter to CYCL DEF."
            raise self.refuse(text, hint, CYCLE_MISSING, parameter=self.named(q))
        return found

    def length(self, q: int, default: float | None = None) -> float:
        """A length, mm."""
        return self.plain(q, default) * self._state.scale

    def feed(self, q: int) -> float | None:
        """A feed as programmed; None where it is a rapid."""
        found = self.plain(q)
        if found == TOOL_FEED and self._state.tool_feed is not None:
            return per_minute(self._state, self._state.tool_feed, self._state.tool_feed_per, self._column)
        text = "{parameter} of cycle {number} is not a valid feed rate."
        self.check(found > 0.0, text, "Enter a feed rate above 0.", parameter=self.named(q))
        return None if found >= MAX_FEED else found

    def cut(self, q: int) -> float:
        """A feed that cuts, as programmed. Raises ProgramError for a rapid."""
        found = self.feed(q)
        if found is None:
            text = "{parameter} is set to rapid, but this is a cutting move."
            raise self.refuse(text, "Enter a feed rate.", parameter=self.named(q))
        return found

    def refuse(self, text: str, hint: str, code: str = INPUT_VALUE, /, **values: object) -> ProgramError:
        """An error of this cycle, to be raised; the number of the cycle fills the hole ``number``."""
        return self._state.refuse(self._column, code, text, hint, **{"number": self._number, **values})

    def check(self, ok: object, text: str, hint: str, code: str = INPUT_VALUE, /, **values: object) -> None:
        """Raise the error of ``refuse`` unless a condition holds."""
        if not ok:
            raise self.refuse(text, hint, code, **values)

    @property
    def radius(self) -> float:
        """Of the tool, mm."""
        return self._state.tool_radius / self._state.figure.factor

    def radius_of(self, tool: int) -> float | None:
        """Radius of another tool, mm: as TOOL DEF tells it, else the tool table; None where nobody does."""
        found = radius_of(self._state, tool)
        return None if found is None else found / self._state.figure.factor

    def tell(self, text: str) -> None:
        """Something about this cycle that is done otherwise, once."""
        self._tell(Severity.NOTE, "cycle-otherwise", "Cycle {number}: {what}", what=text)

    def _tell(self, severity: Severity, code: str, text: str, hint: str = "", /, **values: object) -> None:
        values = {"number": self._number, **values}
        self._state.tell_once(self._column, severity, code, text, hint, **values)

    @property
    def point_angle(self) -> float:
        """Of the tool's point, degrees. Raises ProgramError where the tool table does not tell it."""
        row = self._state.setup.mill_tools.get(self._state.modal.tool)
        if row is None or not 0.0 < row.point < 180.0:
            text = "Cycle {number} needs the point angle of the tool for a programmed diameter."
            hint = "Enter the point angle in the tool table, or program Q343=+0 and Q201."
            raise self.refuse(text, hint)
        return row.point

    @property
    def here(self) -> Point:
        """X and Y where the tool stands."""
        x, y, _ = self._state.programmed
        return x, y

    @property
    def height(self) -> float:
        """Z where the tool stands."""
        return self._state.programmed[2]

    @property
    def speed(self) -> float:
        """S of the last TOOL CALL, whether the spindle turns or not."""
        return self._state.modal.rpm

    @property
    def rpm(self) -> float:
        """Speed of the spindle, signed. Raises ProgramError where it stands."""
        found = self.turns
        text = "Cycle {number} needs a running spindle."
        self.check(found, text, "Start the spindle with M3 before the cycle.", WRONG_RPM)
        return found

    @property
    def turns(self) -> float:
        """Speed of the spindle, signed; 0 where it stands."""
        return self._state.modal.rpm * self._state.modal.spindle

    def thread_speed(self, pitch: float) -> float:
        """S in the direction of a thread, signed: a pitch under 0 is a left-hand one. Raises ProgramError."""
        self.check(self.speed, "Cycle {number} needs a spindle speed.", "Program S in TOOL CALL.", WRONG_RPM)
        return math.copysign(self.speed, pitch)

    def warn_uncoupled(self) -> None:
        """Z follows the spindle by its speed, not by its angle: it stands while the spindle turns round."""
        text = (
            "Cycle {number}: Z is not synchronized with the spindle angle, so Z stops "
            "while the spindle reverses."
        )
        self._tell(Severity.WARNING, "tapping-uncoupled", text, "Use a floating tap holder.")

    def warn_unoriented(self) -> None:
        """Nothing stops the spindle of this mill at an angle: the edge may point anywhere."""
        text = "Cycle {number} moves the cutting edge away from the wall, but {unoriented}."
        hint = "Program Q214=0, or turn the cutting edge by hand when the program stops for this adjustment."
        self._tell(Severity.WARNING, "spindle-not-oriented", text, hint, unoriented=UNORIENTED)

    # --- what it does -------------------------------------------------------------------------------------

    def to(self, z: float, feed: float | None = None) -> Block:
        """Up or down to ``z``; without a feed in rapid."""
        return self.across(self.here, z, feed)

    def over(self, at: Point, clear: float) -> Iterator[Block]:
        """At the height ``clear`` or above it to a place, and down to that height, in rapid."""
        yield self.to(max(clear, self.height))
        yield self.across(at)
        yield self.to(clear)

    def tap(self, z: float, lead: float, *, in_hole: bool = False) -> Block:
        """Into a thread or out of it: ``lead`` mm a revolution, whatever the feed override says.

        Raises ProgramError where Z does not go as fast as that.
        """
        state, rpm = self._state, self._state.modal.rpm
        fastest = state.kinematics.slides[2].vmax
        if (rate := lead * rpm / 60.0) > fastest:
            text = (
                "A lead of {lead} mm at S{rpm} requires a Z feed rate above the maximum of {fastest} mm/min."
            )
            hint = "Lower S."
            raise self.refuse(text, hint, lead=f"{lead:.10g}", rpm=rpm, fastest=f"{fastest * 60.0:.10g}")
        goal = state.machine((*self.here, z))
        made = state.move(Kind.FEED, dict(zip(SLIDES, goal, strict=True)), rate)
        return replace(made, feed=lead, per_rev=True, coupled=True, in_hole=in_hole)

    def lead_of(self, feed: float) -> float:
        """Millimetres a revolution of a feed as programmed. Raises ProgramError where the spindle stands."""
        return self._state.path_feed(feed) * 60.0 / abs(self.rpm)

    def across(self, at: Point, z: float | None = None, feed: float | None = None) -> Block:
        """Straight to a point; without a feed in rapid."""
        state = self._state
        goal = state.machine((*at, self.height if z is None else z))
        rate = None if feed is None else state.path_feed(feed)
        return state.move(
            Kind.RAPID if rate is None else Kind.FEED, dict(zip(SLIDES, goal, strict=True)), rate
        )

    def round(self, arc: Arc, z: float, feed: float) -> Block:
        """Along an arc, with Z to ``z``."""
        state = self._state
        levels = [state.figure.plane((0.0, 0.0, at))[2] for at in (self.height, z)]
        names = state.names
        columns = names.index("X"), names.index("Y"), names.index("Z")
        way = HelixMove(state.place, state.figure.arc(arc), levels[0], levels[1], state.there, columns)
        goal = dict(zip(SLIDES, state.machine((*arc.end, z)), strict=True))
        return state.move(Kind.PLANE_ARC, goal, state.path_feed(feed), way)

    def dwell(self, seconds: float, *, in_hole: bool = False) -> list[Block]:
        """Rest; nothing where there is no time."""
        return [replace(self._state.action(Dwell(seconds)), in_hole=in_hole)] if seconds > 0.0 else []

    def turn(self, rpm: float, *, in_hole: bool = False) -> Block:
        """The spindle at this speed and in this direction."""
        state = self._state
        state.modal = state.modal._replace(spindle=1 if rpm > 0.0 else -1, oriented=None)
        return replace(state.action(SpindleRun(rpm)), in_hole=in_hole)

    def turning(self, rpm: float) -> list[Block]:
        """The spindle as this signed speed says, 0 at rest; nothing where it turns so already."""
        if rpm == self.turns:
            return []
        return [self.turn(rpm) if rpm else self.stop()]

    def coolant(self, q: int) -> list[Block]:
        """Coolant by the M function that a parameter holds: 8 on, 9 off, 0 nothing. Raises ProgramError."""
        number, state = int(self.plain(q, 0.0)), self._state
        if number == 0:
            return []
        text = "Q{parameter} selects M{number}, which is not a coolant function of this machine."
        hint = "Enter 8 for coolant on or 9 for coolant off."
        self.check(number in {8, 9}, text, hint, parameter=q, number=number)
        state.modal = state.modal._replace(coolant=number == 8)
        return [state.action(Coolant(number == 8))]

    def stop(self, *, stands: bool = False) -> Block:
        """The spindle off; with ``stands`` it is waited for."""
        state = self._state
        state.modal = state.modal._replace(spindle=0, oriented=None)
        return state.action(SpindleStop(stands))

    @property
    def orients(self) -> bool:
        """Whether the spindle of this machine can be stopped at an angle."""
        return self._state.setup.limits.spindle_oriented

    def orient(self, q: int) -> Block:
        """The spindle held at the angle of a parameter. Raises ProgramError."""
        angle = self.plain(q, 0.0)
        if not -_TURN <= angle <= _TURN:
            text = "{parameter} is not a valid spindle angle."
            raise self.refuse(text, "Enter an angle from -360 to 360 degrees.", parameter=self.named(q))
        return oriented(self._state, angle)

    def halt(self, message: str) -> Block:
        """For what the operator has to do by hand; Cycle Start goes on."""
        return self._state.action(ProgramStop(optional=False, message=message))


_SMALLEST = 1e-6  # mm


@dataclass(frozen=True, slots=True)
class Seat:
    """Where a figure sits in the program's X and Y: its middle, and the angle of its first side, degrees."""

    middle: Point
    angle: float = 0.0

    def at(self, u: float, v: float) -> Point:
        """The point of the program for one along the first side and one along the second, mm."""
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        return self.middle[0] + c * u - s * v, self.middle[1] + s * u + c * v

    def moved(self, u: float, v: float) -> Seat:
        """The same with its middle there."""
        return Seat(self.at(u, v), self.angle)


@dataclass(frozen=True, slots=True)
class Ring:
    """A rectangle of half sides ``a`` and ``b`` with corners of ``radius``, mm."""

    a: float
    b: float
    radius: float

    def wider(self, by: float) -> Ring:
        """The same, ``by`` further out; corners stay round."""
        return Ring(self.a + by, self.b + by, max(self.radius + by, 0.0))

    def milled(self, tool: CycleTool, seat: Seat, feed: float, *, clockwise: bool) -> Iterator[Block]:
        """Round from the middle of the side in +u, at the height where the tool stands."""
        r = min(self.radius, self.a, self.b)
        side = -1.0 if clockwise else 1.0
        u, v = self.a - r, self.b - r
        corners = (
            ((self.a, v), (u, self.b), (u, v)),
            ((-u, self.b), (-self.a, v), (-u, v)),
            ((-self.a, -v), (-u, -self.b), (-u, -v)),
            ((u, -self.b), (self.a, -v), (u, -v)),
        )
        z = tool.height
        for start, end, centre in corners:
            first, last, about = (seat.at(x, side * y) for x, y in (start, end, centre))
            yield from _straight(tool, first, feed)
            if r > _SMALLEST:
                yield tool.round(Arc(first, last, about, clockwise), z, feed)
        yield from _straight(tool, seat.at(self.a, 0.0), feed)


def _straight(tool: CycleTool, at: Point, feed: float) -> Iterator[Block]:
    if math.dist(tool.here, at) > _SMALLEST:
        yield tool.across(at, None, feed)
