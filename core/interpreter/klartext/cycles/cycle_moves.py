"""Common elements of cycles: parameters, moves, closed tool paths, dwells and spindle commands."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.working_plane import HelixMove
from core.interpreter.klartext.klartext_state import LINEAR_AXES, State
from core.interpreter.klartext.motion.feed_rates import convert_to_feed_per_minute
from core.interpreter.klartext.setup.tool_call import find_tool_radius_mm
from core.interpreter.shared.actions import (
    CoolantSwitch,
    Dwell,
    ProgramStop,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.formula_values import convert_to_whole_number
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext.klartext_faults import CYCLE_MISSING, INPUT_VALUE_INCORRECT, WRONG_RPM
from core.language.klartext.q_parameters import MAX_FEED_VALUE, TOOL_FEED_VALUE

_TURN = 360.0
CANNOT_ORIENT_TEXT = "the spindle of this machine cannot be oriented"
CANNOT_ORIENT_HINT = (
    "set oriented = true under [spindle] in the machine file if the drive can stop the spindle at an angle"
)

CycleParameters = Mapping[int, int | float | None]
"""Values by Q parameter number.

An int is the number of a parameter in another cycle, and a float is a fixed value.
"""


def make_orientation_block(state: State, angle_deg: float) -> Block:
    """Return the block that orients the spindle to an angle in the shorter direction.

    ``angle_deg`` is the angle from the spindle index, in degrees.
    """
    state.modal = state.modal._replace(spindle=0, oriented=angle_deg % _TURN)
    return state.make_action_block(SpindlePositioning(angle_deg % _TURN))


class CycleTool:
    """The tool while a cycle is executed, with positions in program coordinates in mm.

    ``value`` is a function that returns the programmed value of a cycle parameter, given its Q number.
    ``column`` is the column of the cycle call in its block.
    """

    def __init__(self, state: State, number: int, value: Callable[[int], float | None], column: int) -> None:
        self._state = state
        self._number = number
        self._value = value
        self._column = column
        self._told_as: CycleParameters = {}

    def copy_with_parameters(self, parameters: CycleParameters) -> CycleTool:
        """Return a copy of the tool for another cycle, with parameters derived from this cycle.

        Each parameter is either the number of a parameter of this cycle or a fixed value. Fixed lengths are
        in the program's unit. Parameters that are not listed are undefined.
        """

        def find_parameter_value(q: int) -> float | None:
            found = parameters.get(q)
            return self._value(found) if isinstance(found, int) else found

        other = CycleTool(self._state, self._number, find_parameter_value, self._column)
        other._told_as = parameters
        return other

    def format_parameter_name(self, q: int) -> str:
        """Return the name of a parameter as it appears in the program, such as Q200."""
        found = self._told_as.get(q, q)
        return f"Q{found if isinstance(found, int) else q}"

    @property
    def mm_per_unit(self) -> float:
        """Return the number of millimeters per length unit of the program."""
        return self._state.mm_per_unit

    # --- parameters of the cycle ----------------------------------------------------------------------------

    def read_parameter(self, q: int, default: float | None = None) -> float:
        """Return a parameter as programmed.

        Raises ProgramError if the parameter is missing and no ``default`` is given.
        """
        found = self._value(q)
        if found is None:
            found = default
        if found is None:
            text, hint = "Cycle {number} needs {parameter}.", "Add the parameter to CYCL DEF."
            raise self.make_error(text, hint, CYCLE_MISSING, parameter=self.format_parameter_name(q))
        return found

    def read_whole_number(self, q: int, default: float | None = None) -> int:
        """Return a parameter whose value must be a whole number.

        Raises ProgramError if the number is not whole, or if the parameter is missing and no ``default`` is
        given.
        """
        value = self.read_parameter(q, default)
        found = convert_to_whole_number(value)
        if found is None:
            text = "{parameter}={value} of cycle {number} must be a whole number."
            raise self.make_error(
                text, "Correct the value.", parameter=self.format_parameter_name(q), value=value
            )
        return found

    def read_choice(self, q: int, choices: Sequence[int], default: float | None = None) -> int:
        """Return the parameter that selects a variant of the cycle; it must be one of ``choices``.

        Raises ProgramError for any other number, or if the parameter is missing and no ``default`` is
        given.
        """
        found = self.read_whole_number(q, default)
        text = "{parameter}={value} of cycle {number} is not one of {choices}."
        choice_list = ", ".join(map(str, choices))
        self.check_condition(
            found in choices,
            text,
            "Correct the value.",
            parameter=self.format_parameter_name(q),
            value=found,
            choices=choice_list,
        )
        return found

    def read_length_mm(self, q: int, default_mm: float | None = None) -> float:
        """Return a length in mm, or ``default_mm`` if the parameter is missing.

        Raises ProgramError if the parameter is missing and ``default_mm`` is None.
        """
        if default_mm is not None and self._value(q) is None:
            return default_mm
        return self.read_parameter(q) * self._state.mm_per_unit

    def read_feed(self, q: int) -> float | None:
        """Return a feed parameter as programmed, or None if it specifies a rapid."""
        found = self.read_parameter(q)
        if found == TOOL_FEED_VALUE and self._state.tool_feed is not None:
            return convert_to_feed_per_minute(
                self._state, self._state.tool_feed, self._state.tool_feed_base, self._column
            )
        text = "{parameter} of cycle {number} is not a valid feed rate."
        self.check_condition(
            found > 0.0, text, "Enter a feed rate above 0.", parameter=self.format_parameter_name(q)
        )
        return None if found >= MAX_FEED_VALUE else found

    def read_cutting_feed(self, q: int) -> float:
        """Return a cutting feed as programmed, per minute.

        Raises ProgramError for a rapid, and for a feed that is missing or not above 0.
        """
        found = self.read_feed(q)
        if found is None:
            text = "{parameter} is set to rapid, but this is a cutting move."
            raise self.make_error(text, "Enter a feed rate.", parameter=self.format_parameter_name(q))
        return found

    def make_error(
        self, text: str, hint: str, code: str = INPUT_VALUE_INCORRECT, /, **values: object
    ) -> ProgramError:
        """Return a ProgramError for this cycle.

        The placeholder ``number`` in the texts is replaced by the cycle number.
        """
        return self._state.make_error(self._column, code, text, hint, **{"number": self._number, **values})

    def check_condition(
        self, condition: object, text: str, hint: str, code: str = INPUT_VALUE_INCORRECT, /, **values: object
    ) -> None:
        """Raise the ProgramError that ``make_error`` returns, unless ``condition`` is true."""
        if not condition:
            raise self.make_error(text, hint, code, **values)

    @property
    def radius_mm(self) -> float:
        """Return the radius of the tool in mm."""
        return self._state.tool_radius_mm / self._state.transformation.scale_factor

    def find_radius_mm(self, tool: int) -> float | None:
        """Return the radius of another tool in mm, or None if the radius is undefined.

        The radius is from TOOL DEF or from the tool table.
        """
        found = find_tool_radius_mm(self._state, tool)
        return None if found is None else found / self._state.transformation.scale_factor

    def log_note(self, text: str) -> None:
        """Log a note, only once, about a difference between this cycle and the original control."""
        self._tell(Severity.NOTE, "cycle-otherwise", "Cycle {number}: {what}", what=text)

    def _tell(self, severity: Severity, code: str, text: str, hint: str = "", /, **values: object) -> None:
        values = {"number": self._number, **values}
        self._state.log_finding_once(self._column, severity, code, text, hint, **values)

    @property
    def point_angle_deg(self) -> float:
        """Return the point angle of the tool in degrees.

        Raises ProgramError if the tool table does not contain a point angle between 0 and 180 degrees.
        """
        row = self._state.setup.mill_tools.get(self._state.modal.tool)
        if row is None or not 0.0 < row.point_angle_deg < 180.0:
            text = "Cycle {number} needs the point angle of the tool for a programmed diameter."
            hint = "Enter the point angle in the tool table, or program Q343=+0 and Q201."
            raise self.make_error(text, hint)
        return row.point_angle_deg

    @property
    def xy_position(self) -> Point:
        """Return X and Y of the tool position in program coordinates, in mm."""
        x, y, _ = self._state.programmed_position
        return x, y

    @property
    def z_position(self) -> float:
        """Return Z of the tool position in program coordinates, in mm."""
        return self._state.programmed_position[2]

    @property
    def programmed_rpm(self) -> float:
        """Return S of the last TOOL CALL in rpm, even if the spindle is stopped."""
        return self._state.modal.rpm

    @property
    def running_rpm(self) -> float:
        """Return the signed spindle speed in rpm. Raises ProgramError if the spindle is stopped."""
        found = self.signed_rpm
        text = "Cycle {number} needs a running spindle."
        self.check_condition(found, text, "Start the spindle with M3 before the cycle.", WRONG_RPM)
        return found

    @property
    def signed_rpm(self) -> float:
        """Return the signed spindle speed in rpm, or 0 if the spindle is stopped."""
        return self._state.modal.rpm * self._state.modal.spindle

    def compute_thread_rpm(self, pitch: float) -> float:
        """Return the programmed speed S in rpm, which is negative for a left-hand thread (negative pitch).

        Raises ProgramError if S is not programmed.
        """
        self.check_condition(
            self.programmed_rpm, "Cycle {number} needs a spindle speed.", "Program S in TOOL CALL.", WRONG_RPM
        )
        return math.copysign(self.programmed_rpm, pitch)

    def warn_about_unsynchronized_z(self) -> None:
        """Log a warning that Z is not synchronized with the spindle angle.

        Z therefore stops while the spindle reverses.
        """
        text = (
            "Cycle {number}: Z is not synchronized with the spindle angle, so Z stops "
            "while the spindle reverses."
        )
        self._tell(Severity.WARNING, "tapping-uncoupled", text, "Use a floating tap holder.")

    def warn_about_unknown_orientation(self) -> None:
        """Log a warning that the direction of the cutting edge is unknown in this cycle.

        The reason is that the spindle of this machine cannot be oriented.
        """
        text = "Cycle {number} moves the cutting edge away from the wall, but {unoriented}."
        hint = "Program Q214=0, or turn the cutting edge by hand when the program stops for this adjustment."
        self._tell(Severity.WARNING, "spindle-not-oriented", text, hint, unoriented=CANNOT_ORIENT_TEXT)

    # --- moves and actions ----------------------------------------------------------------------------------

    def move_to_z(self, z: float, feed: float | None = None) -> Block:
        """Return a move to the height ``z``, which is a rapid if ``feed`` is None."""
        return self.move_straight(self.xy_position, z, feed)

    def move_above_position(self, position: Point, clearance_z_mm: float) -> Iterator[Block]:
        """Yield a rapid to a point above ``position``, and a rapid down to ``clearance_z_mm``.

        The first rapid is at ``clearance_z_mm`` or higher.
        """
        yield self.move_to_z(max(clearance_z_mm, self.z_position))
        yield self.move_straight(position)
        yield self.move_to_z(clearance_z_mm)

    def make_tapping_block(self, z: float, lead_mm: float, *, is_in_hole: bool = False) -> Block:
        """Return a move into or out of a tapped hole at ``lead_mm`` mm/rev, without feed override.

        Raises ProgramError if Z cannot move fast enough.
        """
        state, rpm = self._state, self._state.modal.rpm
        fastest = state.kinematics.linear_axes[2].vmax
        if (rate := lead_mm * rpm / 60.0) > fastest:
            text = (
                "A lead of {lead} mm at S{rpm} requires a Z feed rate above the maximum of {fastest} mm/min."
            )
            hint = "Lower S."
            raise self.make_error(
                text, hint, lead=f"{lead_mm:.10g}", rpm=rpm, fastest=f"{fastest * 60.0:.10g}"
            )
        goal = state.convert_to_machine_position((*self.xy_position, z))
        made = state.make_move_block(BlockKind.FEED, dict(zip(LINEAR_AXES, goal, strict=True)), rate)
        return replace(made, feed=lead_mm, per_rev=True, follows_spindle=True, in_hole=is_in_hole)

    def convert_feed_to_lead(self, feed: float) -> float:
        """Convert a programmed feed to mm/rev. Raises ProgramError if the spindle is stopped."""
        return self._state.convert_feed_to_mm_s(feed) * 60.0 / abs(self.running_rpm)

    def move_straight(self, position: Point, z: float | None = None, feed: float | None = None) -> Block:
        """Return a straight move to a point, which is a rapid if ``feed`` is None."""
        state = self._state
        goal = state.convert_to_machine_position((*position, self.z_position if z is None else z))
        rate = None if feed is None else state.convert_feed_to_mm_s(feed)
        return state.make_move_block(
            BlockKind.RAPID if rate is None else BlockKind.FEED,
            dict(zip(LINEAR_AXES, goal, strict=True)),
            rate,
        )

    def move_on_arc(self, arc: Arc, z: float, feed: float) -> Block:
        """Return a move along an arc that ends at the height ``z``."""
        state = self._state
        levels = [state.transformation.convert_to_plane((0.0, 0.0, at))[2] for at in (self.z_position, z)]
        names = state.axis_names
        columns = names.index("X"), names.index("Y"), names.index("Z")
        helix = HelixMove(
            state.plane_transform,
            state.transformation.transform_arc(arc),
            levels[0],
            levels[1],
            state.axis_positions,
            columns,
        )
        goal = dict(zip(LINEAR_AXES, state.convert_to_machine_position((*arc.end, z)), strict=True))
        return state.make_move_block(BlockKind.PLANE_ARC, goal, state.convert_feed_to_mm_s(feed), helix)

    def make_dwell_blocks(self, seconds: float, *, is_in_hole: bool = False) -> list[Block]:
        """Return a list with one dwell block, or an empty list for 0 s."""
        return (
            [replace(self._state.make_action_block(Dwell(seconds)), in_hole=is_in_hole)]
            if seconds > 0.0
            else []
        )

    def run_spindle(self, rpm: float, *, is_in_hole: bool = False) -> Block:
        """Return the block that runs the spindle at the signed speed ``rpm``."""
        state = self._state
        state.modal = state.modal._replace(spindle=1 if rpm > 0.0 else -1, oriented=None)
        return replace(state.make_action_block(SpindleRun(rpm)), in_hole=is_in_hole)

    def set_spindle_speed(self, rpm: float) -> list[Block]:
        """Return a list with the block that sets the signed spindle speed ``rpm``; 0 stops the spindle.

        The list is empty if the spindle already runs at this speed.
        """
        if rpm == self.signed_rpm:
            return []
        return [self.run_spindle(rpm) if rpm else self.stop_spindle()]

    def switch_coolant(self, q: int) -> list[Block]:
        """Return a list with the block that switches the coolant as parameter ``q`` specifies.

        The parameter contains an M function number (8 or 9), or 0 for no change; the list is then empty.
        Raises ProgramError for any other value.
        """
        number, state = self.read_whole_number(q, 0.0), self._state
        if number == 0:
            return []
        text = "Q{parameter} selects M{number}, which is not a coolant function of this machine."
        hint = "Enter 8 for coolant on or 9 for coolant off."
        self.check_condition(number in {8, 9}, text, hint, parameter=q, number=number)
        state.modal = state.modal._replace(coolant=number == 8)
        return [state.make_action_block(CoolantSwitch(number == 8))]

    def stop_spindle(self, *, waits_for_standstill: bool = False) -> Block:
        """Return the block that stops the spindle.

        With ``waits_for_standstill``, the next block waits until the spindle is at rest.
        """
        state = self._state
        state.modal = state.modal._replace(spindle=0, oriented=None)
        return state.make_action_block(SpindleStop(waits_for_standstill))

    @property
    def can_orient_spindle(self) -> bool:
        """Return whether the spindle of this machine can stop at a given angle."""
        return self._state.setup.limits.can_orient_spindle

    def orient_spindle(self, q: int) -> Block:
        """Return the block that orients the spindle to the angle in parameter ``q``, in degrees.

        Raises ProgramError for an invalid angle.
        """
        angle = self.read_parameter(q, 0.0)
        if not -_TURN <= angle <= _TURN:
            text = "{parameter} is not a valid spindle angle."
            raise self.make_error(
                text, "Enter an angle from -360 to 360 degrees.", parameter=self.format_parameter_name(q)
            )
        return make_orientation_block(self._state, angle)

    def stop_program(self, message: str) -> Block:
        """Return a block that stops the program so that the operator can act; Cycle Start continues it."""
        return self._state.make_action_block(ProgramStop(optional=False, message=message))


_MIN_LENGTH_MM = 1e-6  # mm


@dataclass(frozen=True, slots=True)
class Placement:
    """The position and rotation of a pocket, slot or stud in program coordinates.

    ``center`` is the center of the shape. ``angle_deg`` is the angle of its first side from X, in degrees.
    """

    center: Point
    angle_deg: float = 0.0

    def convert_to_program_point(self, u: float, v: float) -> Point:
        """Convert a point of the shape to program coordinates, in mm.

        ``u`` and ``v`` are the distances from the center along the first and the second side.
        """
        c, s = math.cos(math.radians(self.angle_deg)), math.sin(math.radians(self.angle_deg))
        return self.center[0] + c * u - s * v, self.center[1] + s * u + c * v

    def translate(self, u: float, v: float) -> Placement:
        """Return a placement with its center moved by ``u`` and ``v`` along the sides."""
        return Placement(self.convert_to_program_point(u, v), self.angle_deg)


@dataclass(frozen=True, slots=True)
class RoundedRectangle:
    """A rectangle with rounded corners, defined by half its side lengths and its corner radius in mm."""

    half_side_u_mm: float
    half_side_v_mm: float
    corner_radius_mm: float

    def make_enlarged_rectangle(self, margin_mm: float) -> RoundedRectangle:
        """Return the rectangle enlarged by ``margin_mm`` on all sides, with round corners."""
        return RoundedRectangle(
            self.half_side_u_mm + margin_mm,
            self.half_side_v_mm + margin_mm,
            max(self.corner_radius_mm + margin_mm, 0.0),
        )

    def generate_outline_moves(
        self, tool: CycleTool, placement: Placement, feed: float, *, is_clockwise: bool
    ) -> Iterator[Block]:
        """Yield the moves once around the rectangle at the current height.

        The path starts at the middle of the side at positive u.
        """
        r = min(self.corner_radius_mm, self.half_side_u_mm, self.half_side_v_mm)
        side = -1.0 if is_clockwise else 1.0
        u, v = self.half_side_u_mm - r, self.half_side_v_mm - r
        corners = (
            ((self.half_side_u_mm, v), (u, self.half_side_v_mm), (u, v)),
            ((-u, self.half_side_v_mm), (-self.half_side_u_mm, v), (-u, v)),
            ((-self.half_side_u_mm, -v), (-u, -self.half_side_v_mm), (-u, -v)),
            ((u, -self.half_side_v_mm), (self.half_side_u_mm, -v), (u, -v)),
        )
        z = tool.z_position
        for start, end, centre in corners:
            first, last, about = (
                placement.convert_to_program_point(x, side * y) for x, y in (start, end, centre)
            )
            yield from _straight(tool, first, feed)
            if r > _MIN_LENGTH_MM:
                yield tool.move_on_arc(Arc(first, last, about, is_clockwise), z, feed)
        yield from _straight(tool, placement.convert_to_program_point(self.half_side_u_mm, 0.0), feed)


def _straight(tool: CycleTool, at: Point, feed: float) -> Iterator[Block]:
    if math.dist(tool.xy_position, at) > _MIN_LENGTH_MM:
        yield tool.move_straight(at, None, feed)
