"""Parameters of a standard cycle by name, and conversion of its motions to blocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot
from typing import NamedTuple

from core.geometry.lines_and_arcs import Point
from core.interpreter.shared.actions import (
    Action,
    Dwell,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.contour_passes import count_passes
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.sinumerik.motion.linear_moves import AxisTravel, make_travel_block
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_block_feed
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError, Severity
from core.language.sinumerik.call_arguments import CallArgument
from core.language.sinumerik.cycle_names import CYCLE_PARAMETERS
from core.language.sinumerik.sinumerik_alarms import make_alarm_diagnostic
from core.language.sinumerik.sinumerik_words import LexedBlock
from core.message import Message, fill_template

TOO_MANY_ARGUMENTS = 12330
NO_FEED, NO_F = 61003, 10860
NO_SPINDLE_DIRECTION = 61102
_CORRECT, _POINT = "Correct the value.", "Look for a missing decimal point."
_PARAMETER_CODE = "cycle-parameter"
_Alarm = int | str
WRONG_MACHINING_TYPE = 61002
MAX_PASS_COUNT = 10_000
DEFAULT_RETRACT_MM = 1.0  # mm; default retract distance from the part without _VRT
_SAME = 1e-9  # mm


class CycleStep(NamedTuple):
    """One motion or action of a cycle, in the program frame, in mm with X as a radius.

    - ``feed`` is the feed in the unit of ``modal.feed``, the lead of a screw thread, or None for a rapid.
    - A step with ``action`` does not move an axis.
    - ``c_travel_deg`` is the simultaneous rotation of C in degrees; ``feed`` is then in mm/s.
    - A step with ``is_tapping`` follows the spindle.
    - ``ends_in_hole`` means that the tap is in the hole at the end of the step.
    """

    x: float
    z: float
    feed: float | None = None
    center: Point | None = None
    is_clockwise: bool = False
    is_thread: bool = False
    action: Action | None = None
    c_travel_deg: float = 0.0
    spindle_direction: int | None = None  # spindle direction after the action: +1, 0 or -1
    is_tapping: bool = False
    ends_in_hole: bool = False


_LIVE_TOOL_CYCLES = frozenset(("CYCLE81", "CYCLE82", "CYCLE83", "CYCLE85", "CYCLE89", "HOLES1", "HOLES2"))
"""Cycles that can also drill along the depth direction of TRANSMIT."""


class CycleCall:
    """One call of a standard cycle.

    ``x`` and ``z`` are the position of the tip in the program frame, in mm with X as a radius.
    """

    def __init__(self, state: SinumerikState, line: LexedBlock) -> None:
        self.state, self.line = state, line
        self.statement = Statement(line)
        self._in_thread = False
        self._arguments = self._by_name()
        self._check()
        modal = state.modal
        self.x, self.z = state.x - modal.offset_x, state.z - modal.offset_z
        if state.transformation is not None:
            self.x, self.z = 0.0, state.transformation.depth_mm

    def _by_name(self) -> dict[str, CallArgument]:
        names, arguments = CYCLE_PARAMETERS[self.line.called_name], self.line.arguments or ()
        if len(arguments) > len(names):
            text = "{call} accepts {names_count} parameters, but the call passes {arguments_count}."
            values = {
                "call": self.line.called_name,
                "names_count": len(names),
                "arguments_count": len(arguments),
            }
            hint = Message("Use only these parameters: {names}.", names=", ".join(names))
            raise self._fault(arguments[len(names)].column, TOO_MANY_ARGUMENTS, Message(text, **values), hint)
        return {name: each for name, each in zip(names, arguments, strict=False) if each.is_specified}

    def _check(self) -> None:
        """Raise ProgramError if the cycle is not allowed in the current state.

        - No cycle is allowed in a rotated, scaled or mirrored frame, or with nose compensation.
        - With TRANSMIT, only drilling cycles and hole patterns are allowed.
        - With a transformation whose depth is not along Z, no cycle is allowed.
        """
        text = "{call} cannot run in a frame that is rotated, scaled or mirrored."
        hint = "Write TRANS without axes before this block."
        self.require_condition(self.state.programmed_frame.is_shift_only, "cycle-frame", text, hint)
        plane = self.state.transformation
        if plane is not None and (
            self.line.called_name not in _LIVE_TOOL_CYCLES or not plane.is_depth_along_z
        ):
            template = (
                "{call} uses the spindle for turning or tapping, but {plane} is active."
                if plane.is_depth_along_z
                else "{call} moves along Z, but {plane} is active."
            )
            hint = "Write TRAFOOF before this block."
            raise self.make_call_error("transformation", template, hint, plane=plane.name)
        text, on = "{what} is not allowed while G{state} is active.", self.state.modal.compensation_code
        hint = "Write G40 and a move before this block."
        self.require_condition(on == 40, "comp-with", text, hint, what=self.line.called_name, state=on)

    def has_argument(self, name: str) -> bool:
        """Return whether the call passes this parameter."""
        return name in self._arguments

    def read_string(self, name: str) -> str:
        """Return a string parameter in capitals, or an empty string if the call omits the parameter."""
        argument = self._arguments.get(name)
        return "" if argument is None or argument.text is None else argument.text.upper()

    def read_number(self, name: str, default: float = 0.0) -> float:
        """Return a number without unit conversion, or ``default`` if the call omits the parameter.

        Raises ProgramError for a string, or if the formula has no value.
        """
        argument = self._arguments.get(name)
        if argument is None:
            return default
        if argument.formula is None:
            raise self.make_parameter_error(name, "{name} is text but must be a number", "Enter a number.")
        return self.state.evaluate_formula(
            argument.formula,
            lambda c, t, h: self._fault(argument.column, c, Message("{name}: {t}", name=name, t=t), h),
        )

    def read_length_mm(self, name: str, default: float = 0.0) -> float:
        """Return a length in mm, converted from inches under G70, or ``default`` if it is omitted."""
        if not self.has_argument(name):
            return default
        return self.read_number(name) * (1.0 if self.state.modal.metric else 25.4)

    def read_unsigned_length_mm(self, name: str, default: float = 0.0) -> float:
        """Return an unsigned length in mm. Raises ProgramError if the length is negative."""
        value = self.read_length_mm(name, default)
        self.check_parameter(
            value >= 0.0, name, "{name} is a size and cannot be negative", "Remove the sign."
        )
        return value

    def read_required_length_mm(self, name: str) -> float:
        """Return a required length in mm. Raises ProgramError if the parameter is missing."""
        if not self.has_argument(name):
            raise self.make_parameter_error(
                name, "{name} is missing", "Add this parameter to {call}.", call=self.line.called_name
            )
        return self.read_length_mm(name)

    def read_positive_length_mm(self, name: str, alarm: _Alarm = _PARAMETER_CODE) -> float:
        """Return a required length above 0, in mm.

        Raises ProgramError if the length is missing or not above 0.
        """
        value = self.read_required_length_mm(name)
        self.check_parameter(value > 0.0, name, "{name} must be greater than 0", "Correct the value.", alarm)
        return value

    def read_whole_number(self, name: str, default: int, minimum: int, maximum: int) -> int:
        """Return a whole number from ``minimum`` to ``maximum``. Raises ProgramError for any other value."""
        value = self.read_number(name, float(default))
        self._demand_whole(name, value)
        text = "{name} is {value} but must be between {low} and {high}"
        self.check_parameter(
            minimum <= value <= maximum,
            name,
            text,
            "Correct the value.",
            value=value,
            low=minimum,
            high=maximum,
        )
        return round(value)

    def _demand_whole(self, name: str, value: float) -> None:
        text = "{name} is {value} but must be a whole number"
        self.check_parameter(value == round(value), name, text, "Enter a whole number.", value=value)

    def check_unsupported_parameter(self, name: str, reason: str) -> None:
        """Raise ProgramError if the parameter of an unsupported function is not 0."""
        if self.read_number(name):
            raise self.make_parameter_error(
                name, "{name} is not supported; {why}", "Omit {name}.", "not-in-subset", why=reason
            )

    def read_feed(self, name: str) -> float | None:
        """Return a feed in the unit of ``modal.feed``, or the active feed if the parameter is omitted."""
        if not self.has_argument(name) or not self.read_number(name):
            return self.state.modal.feed
        value = self.read_number(name)
        self.check_parameter(value >= 0.0, name, "{name} must be a feed rate above 0", "Correct the value.")
        value *= 25.4 if self.state.feed_in_inches else 1.0
        return value if self.state.modal.per_rev else value / 60.0

    def read_machining_type(self, name: str, allowed_types: range) -> int:
        """Return the number of the machining type (parameter VARI).

        Raises ProgramError if the number is not whole. For a whole number that is not an allowed type, the
        error has the alarm of the control (61002).
        """
        value = self.read_number(name)
        self._demand_whole(name, value)
        if round(value) not in allowed_types:
            low, high = allowed_types[0], allowed_types[-1]
            text = "{name} is {value}; valid types are {low} to {high}"
            hint = "Correct the value."
            raise self.make_parameter_error(
                name, text, hint, WRONG_MACHINING_TYPE, value=value, low=low, high=high
            )
        return round(value)

    def read_angle_deg(self, name: str, text: str) -> float:
        """Return an angle in degrees from 0 to less than 360. Raises ProgramError for any other value."""
        value = self.read_number(name)
        self.check_parameter(0.0 <= value < 360.0, name, text)
        return value

    def compute_pass_count(
        self,
        total_depth: float,
        depth_per_pass: float,
        name: str,
        text: str,
        hint: str = _POINT,
        maximum: int = MAX_PASS_COUNT,
    ) -> int:
        """Return the number of passes for a total depth in mm.

        Each pass is at most ``depth_per_pass`` deep, in mm. Raises ProgramError if the number is too high.
        """
        count = count_passes(total_depth, depth_per_pass)
        self.check_parameter(count <= min(maximum, MAX_PASS_COUNT), name, text, hint, count=f"{count:,}")
        return count

    def require_feed(
        self, feed: float | None, alarm: int = NO_F, hint: str = "Program F before this block."
    ) -> float:
        """Return ``feed``. Raises ProgramError if it is None, because no feed is active."""
        if feed is None:
            raise self.make_call_error(alarm, "no feedrate is programmed.", hint)
        return feed

    def make_clearance_steps(self, clearance_x: float, outward_sign: float = 1.0) -> list[CycleStep]:
        """Return a step that moves X away from the part to ``clearance_x``.

        If the tool is already at least this far away, the list is empty. ``outward_sign`` is the sign of X
        away from the part.
        """
        return [] if outward_sign * self.x >= outward_sign * clearance_x else [CycleStep(clearance_x, self.z)]

    def check_active_tool(self) -> None:
        """Raise ProgramError unless a tool with an offset is active."""
        modal, text = self.state.modal, "{call} needs an active tool with an offset."
        self.require_condition(modal.tool and modal.edge, 61000, text, "Write T and D before this block.")

    def make_parameter_error(
        self, name: str, what: str, hint: str = _CORRECT, code: _Alarm = _PARAMETER_CODE, /, **values: object
    ) -> ProgramError:
        """Return an error about one parameter.

        ``values`` are the values for the placeholders of ``what`` and ``hint``.
        """
        argument = self._arguments.get(name)
        column = self.line.call_column if argument is None else argument.column
        values = {"name": name, "call": self.line.called_name, **values}
        text = Message("{call}: {what}.", call=self.line.called_name, what=fill_template(what, values))
        return self._fault(column, code, text, fill_template(hint, values))

    def check_parameter(
        self,
        condition: object,
        name: str,
        message: str,
        hint: str = _CORRECT,
        code: _Alarm = _PARAMETER_CODE,
        /,
        **values: object,
    ) -> None:
        """Raise the ProgramError that ``make_parameter_error`` returns, unless ``condition`` is true."""
        if not condition:
            raise self.make_parameter_error(name, message, hint, code, **values)

    def make_call_error(self, code: _Alarm, text: str, hint: str, /, **values: object) -> ProgramError:
        """Return an error about the whole call.

        ``values`` are the values for the placeholders of ``text`` and ``hint``.
        """
        values = {"call": self.line.called_name, **values}
        return self._fault(
            self.line.call_column, code, fill_template(text, values), fill_template(hint, values)
        )

    def require_condition(
        self, condition: object, code: _Alarm, text: str, hint: str, /, **values: object
    ) -> None:
        """Raise the ProgramError that ``make_call_error`` returns, unless ``condition`` is true."""
        if not condition:
            raise self.make_call_error(code, text, hint, **values)

    def _fault(self, column: int, code: _Alarm, text: str, hint: str) -> ProgramError:
        return ProgramError(
            make_alarm_diagnostic(self.line.line_number, column, code, self.line.block_name, text, hint)
        )

    def log_warning(self, code: str, text: str, hint: str, /, **values: object) -> None:
        """Log a warning about the call."""
        found = self.make_call_error(code, text, hint, **values).diagnostic
        self.state.log_finding(replace(found, severity=Severity.WARNING))

    def make_blocks(self, steps: Sequence[CycleStep]) -> Iterator[Block]:
        """Yield the motions as blocks.

        All feeds are checked before the first block. Raises ProgramError for an invalid feed.
        """
        for step, feed in self.check_steps(steps):
            yield self.make_block(step, feed)

    def check_steps(self, steps: Sequence[CycleStep]) -> list[tuple[CycleStep, float]]:
        """Return the steps with their feeds, without steps that neither move nor execute an action.

        The feeds apply to the active modal state. Raises ProgramError for an invalid feed.
        """
        at, kept = (self.x, self.z), list[tuple[CycleStep, float]]()
        for step in steps:
            still = step.action is None and step.center is None and not step.c_travel_deg
            if still and hypot(step.x - at[0], step.z - at[1]) <= _SAME:
                continue
            feed = step.feed or 0.0
            if step.action is None and step.feed is not None and not step.is_thread and not step.c_travel_deg:
                feed = self._check_feed(step, at[0])
            kept.append((step, feed))
            at = (step.x, step.z) if step.action is None else at
        return kept

    def _check_feed(self, step: CycleStep, x0: float) -> float:
        """Return the feed of a step in the unit of its block. Raises ProgramError if the feed is invalid."""
        state, modal = self.state, self.state.modal
        state.set_modal_state(modal._replace(feed=step.feed))
        try:
            return check_block_feed(state, self.statement, x0, step.x)
        finally:
            state.set_modal_state(modal)

    def make_block(self, step: CycleStep, feed: float) -> Block:
        """Return the block of a step, and set the state to its end."""
        state, modal = self.state, self.state.modal
        if step.action is not None:
            if step.spindle_direction is not None:
                action, locked = step.action, isinstance(step.action, SpindleLock)
                at = action.angle if isinstance(action, SpindlePositioning) else None
                state.set_modal_state(
                    modal._replace(spindle=step.spindle_direction, c_locked=locked, oriented=at)
                )
            done = state.action(self.line.line_number, _told(step), step.action)
            done.in_hole = step.ends_in_hole
            return done
        text = f"{self.line.called_name} {_words(step, modal.diameter)}"
        if state.transformation is not None:
            return state.transformation.make_depth_move(
                self.statement, step.z, None if step.feed is None else feed, text
            )
        x, z = step.x + modal.offset_x, step.z + modal.offset_z
        travel = AxisTravel(
            state.x,
            state.z,
            state.c,
            x,
            z,
            state.c + step.c_travel_deg,
            modal,
            modal.offset_x,
            modal.offset_z,
            state.programmed_frame,
        )
        kind = (
            BlockKind.THREAD
            if step.is_thread
            else BlockKind.ARC
            if step.center is not None
            else BlockKind.FEED
        )
        if step.feed is None:
            speeds = state.setup.limits.max_axis_speeds
            made = make_travel_block(
                state, self.statement, travel, BlockKind.RAPID, travel.compute_rapid_rate(speeds)
            )
        else:
            made = make_travel_block(state, self.statement, travel, kind, feed)
        made.text = text
        made.per_rev = (step.is_thread or made.per_rev) and not step.c_travel_deg
        made.follows_spindle, made.in_hole = step.is_tapping, step.ends_in_hole
        made.continues, self._in_thread = step.is_thread and self._in_thread, step.is_thread
        if step.center is not None:
            made.cx, made.cz = step.center
            made.clockwise = step.is_clockwise
        return made


def make_action_step(action: Action, spindle_direction: int | None = None) -> CycleStep:
    """Return a step that executes an action at the current position.

    ``spindle_direction`` has the same meaning as in ``CycleStep``.
    """
    return CycleStep(0.0, 0.0, action=action, spindle_direction=spindle_direction)


def make_dwell_steps(seconds: float) -> list[CycleStep]:
    """Return a list with one dwell step, or an empty list for 0 s."""
    return [make_action_step(Dwell(seconds))] if seconds > 0.0 else []


def _words(step: CycleStep, diameter: bool) -> str:
    # G2 is clockwise in the view with X up. Blocks use the view with X down.
    code = "G33" if step.is_thread else "G0" if step.feed is None else "G1"
    if step.center is not None:
        code = "G3" if step.is_clockwise else "G2"
    x = step.x * (2.0 if diameter else 1.0)
    return f"{code} X{x + 0.0:.3f} Z{step.z + 0.0:.3f}"


def _told(step: CycleStep) -> str:
    match step.action:
        case Dwell(seconds=seconds):
            return f"G4 F{seconds:g}"
        case SpindleRun(rpm=rpm):
            return f"S{abs(rpm):g} M{3 if rpm > 0 else 4}"
        case SpindleStop():
            return "M5"
        case SpindleLock():
            return "M70"
        case SpindlePositioning(angle=angle):
            return f"SPOS={angle:g}"
        case _:
            return "M0"
