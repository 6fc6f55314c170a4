"""Elements of cycles: tool position, parameters, moves, rings, dwells and spindle."""

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
    """Return the block that orients the spindle to an angle, by the shorter distance.

    ``angle`` is in degrees from the spindle index.
    """
    state.modal = state.modal._replace(spindle=0, oriented=angle % _TURN)
    return state.action(SpindleOrient(angle % _TURN))


class CycleTool:
    """The tool in a cycle that is called at ``column`` of a block; mm, in program coordinates.

    ``value`` returns a parameter of the cycle by its Q number, as written.
    """

    def __init__(self, state: State, number: int, value: Callable[[int], float | None], column: int) -> None:
        self._state = state
        self._number = number
        self._value = value
        self._column = column
        self._told_as: Parameters = {}

    def seen(self, parameters: Parameters) -> CycleTool:
        """Return the tool for another cycle, with other parameters.

        Each parameter is another parameter of this cycle, or a fixed value. Lengths among the fixed values
        are in the program's unit. Parameters that are not listed are not defined.
        """

        def value(q: int) -> float | None:
            found = parameters.get(q)
            return self._value(found) if isinstance(found, int) else found

        other = CycleTool(self._state, self._number, value, self._column)
        other._told_as = parameters
        return other

    def named(self, q: int) -> str:
        """Return the name of a parameter in the program, such as Q200."""
        found = self._told_as.get(q, q)
        return f"Q{found if isinstance(found, int) else q}"

    @property
    def scale(self) -> float:
        """Millimeters per unit of the program."""
        return self._state.scale

    # --- parameters of the cycle ----------------------------------------------------------------------------

    def plain(self, q: int, default: float | None = None) -> float:
        """Return a parameter as written. Raises ProgramError if it is missing and has no ``default``."""
        found = self._value(q)
        if found is None:
            found = default
        if found is None:
            text, hint = "Cycle {number} needs {parameter}.", "Add the parameter to CYCL DEF."
            raise self.refuse(text, hint, CYCLE_MISSING, parameter=self.named(q))
        return found

    def length(self, q: int, default_mm: float | None = None) -> float:
        """Return a length in mm, or ``default_mm`` if the parameter is missing.

        Raises ProgramError if the parameter is missing and has no ``default_mm``.
        """
        if default_mm is not None and self._value(q) is None:
            return default_mm
        return self.plain(q) * self._state.scale

    def feed(self, q: int) -> float | None:
        """Return a feed as programmed; None for a rapid."""
        found = self.plain(q)
        if found == TOOL_FEED and self._state.tool_feed is not None:
            return per_minute(self._state, self._state.tool_feed, self._state.tool_feed_per, self._column)
        text = "{parameter} of cycle {number} is not a valid feed rate."
        self.check(found > 0.0, text, "Enter a feed rate above 0.", parameter=self.named(q))
        return None if found >= MAX_FEED else found

    def cut(self, q: int) -> float:
        """Return a cutting feed as programmed. Raises ProgramError for a rapid."""
        found = self.feed(q)
        if found is None:
            text = "{parameter} is set to rapid, but this is a cutting move."
            raise self.refuse(text, "Enter a feed rate.", parameter=self.named(q))
        return found

    def refuse(self, text: str, hint: str, code: str = INPUT_VALUE, /, **values: object) -> ProgramError:
        """Return an error of this cycle; ``number`` is the placeholder for the number of the cycle."""
        return self._state.refuse(self._column, code, text, hint, **{"number": self._number, **values})

    def check(self, ok: object, text: str, hint: str, code: str = INPUT_VALUE, /, **values: object) -> None:
        """Raise the error of ``refuse`` unless the condition ``ok`` is true."""
        if not ok:
            raise self.refuse(text, hint, code, **values)

    @property
    def radius(self) -> float:
        """Radius of the tool, in mm."""
        return self._state.tool_radius / self._state.figure.factor

    def radius_of(self, tool: int) -> float | None:
        """Return the radius of another tool in mm, from TOOL DEF or the tool table; None if not defined."""
        found = radius_of(self._state, tool)
        return None if found is None else found / self._state.figure.factor

    def tell(self, text: str) -> None:
        """Note once that this cycle works differently on this control."""
        self._tell(Severity.NOTE, "cycle-otherwise", "Cycle {number}: {what}", what=text)

    def _tell(self, severity: Severity, code: str, text: str, hint: str = "", /, **values: object) -> None:
        values = {"number": self._number, **values}
        self._state.tell_once(self._column, severity, code, text, hint, **values)

    @property
    def point_angle(self) -> float:
        """Point angle of the tool in degrees. Raises ProgramError if the tool table does not have it."""
        row = self._state.setup.mill_tools.get(self._state.modal.tool)
        if row is None or not 0.0 < row.point < 180.0:
            text = "Cycle {number} needs the point angle of the tool for a programmed diameter."
            hint = "Enter the point angle in the tool table, or program Q343=+0 and Q201."
            raise self.refuse(text, hint)
        return row.point

    @property
    def here(self) -> Point:
        """X and Y of the tool position."""
        x, y, _ = self._state.programmed
        return x, y

    @property
    def height(self) -> float:
        """Z of the tool position."""
        return self._state.programmed[2]

    @property
    def speed(self) -> float:
        """S of the last TOOL CALL in rpm, also if the spindle is stopped."""
        return self._state.modal.rpm

    @property
    def rpm(self) -> float:
        """Signed spindle speed in rpm. Raises ProgramError if the spindle is stopped."""
        found = self.turns
        text = "Cycle {number} needs a running spindle."
        self.check(found, text, "Start the spindle with M3 before the cycle.", WRONG_RPM)
        return found

    @property
    def turns(self) -> float:
        """Signed spindle speed in rpm; 0 if the spindle is stopped."""
        return self._state.modal.rpm * self._state.modal.spindle

    def thread_speed(self, pitch: float) -> float:
        """Return S in rpm, negative for a left-hand thread (negative pitch).

        Raises ProgramError without S.
        """
        self.check(self.speed, "Cycle {number} needs a spindle speed.", "Program S in TOOL CALL.", WRONG_RPM)
        return math.copysign(self.speed, pitch)

    def warn_uncoupled(self) -> None:
        """Warn that Z is not synchronized with the spindle angle.

        Z stops while the spindle reverses.
        """
        text = (
            "Cycle {number}: Z is not synchronized with the spindle angle, so Z stops "
            "while the spindle reverses."
        )
        self._tell(Severity.WARNING, "tapping-uncoupled", text, "Use a floating tap holder.")

    def warn_unoriented(self) -> None:
        """Warn that this spindle cannot be oriented, so that the direction of the edge is unknown."""
        text = "Cycle {number} moves the cutting edge away from the wall, but {unoriented}."
        hint = "Program Q214=0, or turn the cutting edge by hand when the program stops for this adjustment."
        self._tell(Severity.WARNING, "spindle-not-oriented", text, hint, unoriented=UNORIENTED)

    # --- moves and actions ----------------------------------------------------------------------------------

    def to(self, z: float, feed: float | None = None) -> Block:
        """Return a move to height ``z``, in rapid without a feed."""
        return self.across(self.here, z, feed)

    def over(self, at: Point, clear: float) -> Iterator[Block]:
        """Yield rapids to a position at the height ``clear`` or higher, and down to that height."""
        yield self.to(max(clear, self.height))
        yield self.across(at)
        yield self.to(clear)

    def tap(self, z: float, lead: float, *, in_hole: bool = False) -> Block:
        """Return a move into or out of a thread with ``lead`` mm/rev, independent of the feed override.

        Raises ProgramError if Z cannot move that fast.
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
        """Return a programmed feed in mm/rev. Raises ProgramError if the spindle is stopped."""
        return self._state.path_feed(feed) * 60.0 / abs(self.rpm)

    def across(self, at: Point, z: float | None = None, feed: float | None = None) -> Block:
        """Return a straight move to a point, in rapid without a feed."""
        state = self._state
        goal = state.machine((*at, self.height if z is None else z))
        rate = None if feed is None else state.path_feed(feed)
        return state.move(
            Kind.RAPID if rate is None else Kind.FEED, dict(zip(SLIDES, goal, strict=True)), rate
        )

    def round(self, arc: Arc, z: float, feed: float) -> Block:
        """Return a move along an arc, with Z to ``z``."""
        state = self._state
        levels = [state.figure.plane((0.0, 0.0, at))[2] for at in (self.height, z)]
        names = state.names
        columns = names.index("X"), names.index("Y"), names.index("Z")
        way = HelixMove(state.place, state.figure.arc(arc), levels[0], levels[1], state.there, columns)
        goal = dict(zip(SLIDES, state.machine((*arc.end, z)), strict=True))
        return state.move(Kind.PLANE_ARC, goal, state.path_feed(feed), way)

    def dwell(self, seconds: float, *, in_hole: bool = False) -> list[Block]:
        """Return a dwell block, or an empty list for 0 s."""
        return [replace(self._state.action(Dwell(seconds)), in_hole=in_hole)] if seconds > 0.0 else []

    def turn(self, rpm: float, *, in_hole: bool = False) -> Block:
        """Return the block that runs the spindle at this signed speed in rpm."""
        state = self._state
        state.modal = state.modal._replace(spindle=1 if rpm > 0.0 else -1, oriented=None)
        return replace(state.action(SpindleRun(rpm)), in_hole=in_hole)

    def turning(self, rpm: float) -> list[Block]:
        """Return the block that sets this signed spindle speed in rpm; 0 stops the spindle.

        The list is empty if the spindle already has this speed.
        """
        if rpm == self.turns:
            return []
        return [self.turn(rpm) if rpm else self.stop()]

    def coolant(self, q: int) -> list[Block]:
        """Return the coolant block for a parameter with an M function (8, 9, or 0 for no change).

        Raises ProgramError for any other value.
        """
        number, state = int(self.plain(q, 0.0)), self._state
        if number == 0:
            return []
        text = "Q{parameter} selects M{number}, which is not a coolant function of this machine."
        hint = "Enter 8 for coolant on or 9 for coolant off."
        self.check(number in {8, 9}, text, hint, parameter=q, number=number)
        state.modal = state.modal._replace(coolant=number == 8)
        return [state.action(Coolant(number == 8))]

    def stop(self, *, stands: bool = False) -> Block:
        """Return the block that stops the spindle.

        With ``stands``, the next block waits until the spindle is at rest.
        """
        state = self._state
        state.modal = state.modal._replace(spindle=0, oriented=None)
        return state.action(SpindleStop(stands))

    @property
    def orients(self) -> bool:
        """Whether the spindle of this machine can stop at an angle."""
        return self._state.setup.limits.spindle_oriented

    def orient(self, q: int) -> Block:
        """Return the block that orients the spindle to the angle of a parameter. Raises ProgramError."""
        angle = self.plain(q, 0.0)
        if not -_TURN <= angle <= _TURN:
            text = "{parameter} is not a valid spindle angle."
            raise self.refuse(text, "Enter an angle from -360 to 360 degrees.", parameter=self.named(q))
        return oriented(self._state, angle)

    def halt(self, message: str) -> Block:
        """Return a program stop for a manual action of the operator; Cycle Start continues."""
        return self._state.action(ProgramStop(optional=False, message=message))


_SMALLEST = 1e-6  # mm


@dataclass(frozen=True, slots=True)
class Seat:
    """Position of a figure in the program's X and Y.

    ``middle`` is its center, and ``angle`` is the angle of its first side in degrees.
    """

    middle: Point
    angle: float = 0.0

    def at(self, u: float, v: float) -> Point:
        """Return the program point for coordinates along the first and second side, in mm."""
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        return self.middle[0] + c * u - s * v, self.middle[1] + s * u + c * v

    def moved(self, u: float, v: float) -> Seat:
        """Return the seat with its center moved along its sides."""
        return Seat(self.at(u, v), self.angle)


@dataclass(frozen=True, slots=True)
class Ring:
    """A rectangle with half sides ``a`` and ``b`` and corner ``radius``, in mm."""

    a: float
    b: float
    radius: float

    def wider(self, by: float) -> Ring:
        """Return the ring enlarged by ``by`` mm on all sides; corners remain round."""
        return Ring(self.a + by, self.b + by, max(self.radius + by, 0.0))

    def milled(self, tool: CycleTool, seat: Seat, feed: float, *, clockwise: bool) -> Iterator[Block]:
        """Yield the moves once around the ring, from the middle of the side in +u, at the present height."""
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
