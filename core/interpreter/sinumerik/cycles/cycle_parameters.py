"""Parameters of a standard cycle by name, with range checks, and the motions of the cycle as blocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot
from typing import NamedTuple

from core.geometry.lines_and_arcs import Point
from core.interpreter.shared.actions import Action, Dwell, SpindleLock, SpindleOrient, SpindleRun, SpindleStop
from core.interpreter.shared.contour_passes import pass_count
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.motion.linear_moves import AxisTravel, block_of
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_feed
from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError, Severity
from core.language.sinumerik.call_arguments import Argument
from core.language.sinumerik.cycle_names import CYCLES
from core.language.sinumerik.sinumerik_alarms import fault
from core.language.sinumerik.sinumerik_words import Line
from core.message import Message, worded

TOO_MANY = 12330
NO_FEED, NO_F = 61003, 10860
NO_DIRECTION = 61102
_CORRECT, _POINT = "Correct the value.", "Look for a missing decimal point."
_OWN = "cycle-parameter"
_Alarm = int | str
MACHINING_TYPE = 61002
MOST_PASSES = 10_000
RETRACT = 1.0  # mm; default retract distance from the part without _VRT
_SAME = 1e-9  # mm


class Step(NamedTuple):
    """One motion of a cycle in the program frame, in mm with X as a radius.

    ``feed`` is in the unit of ``modal.feed``, or the lead of a thread, or None for a rapid. A step with
    ``action`` does not move. ``turn`` is the simultaneous turn of C in degrees; ``feed`` is then in mm/s. A
    ``tap`` step follows the spindle, and ``in_hole`` means that the tap is in the hole at its end.
    """

    x: float
    z: float
    feed: float | None = None
    centre: Point | None = None
    clockwise: bool = False
    thread: bool = False
    action: Action | None = None
    turn: float = 0.0
    spindle: int | None = None  # spindle direction after the action: +1, 0 or -1
    tap: bool = False
    in_hole: bool = False


_LIVE = frozenset(("CYCLE81", "CYCLE82", "CYCLE83", "CYCLE85", "CYCLE89", "HOLES1", "HOLES2"))
"""Cycles that drill along the depth of TRANSMIT, too."""


class Cycle:
    """One call of a standard cycle.

    ``x z`` is the position of the tip in the program frame, in mm with X as a radius.
    """

    def __init__(self, state: State, line: Line) -> None:
        self.state, self.line = state, line
        self.statement = Statement(line)
        self._in_thread = False
        self._arguments = self._by_name()
        self._check()
        modal = state.modal
        self.x, self.z = state.x - modal.offset_x, state.z - modal.offset_z
        if state.transformation is not None:
            self.x, self.z = 0.0, state.transformation.depth

    def _by_name(self) -> dict[str, Argument]:
        names, arguments = CYCLES[self.line.call], self.line.arguments or ()
        if len(arguments) > len(names):
            text = "{call} accepts {names_count} parameters, but the call passes {arguments_count}."
            told = {"call": self.line.call, "names_count": len(names), "arguments_count": len(arguments)}
            hint = Message("Use only these parameters: {names}.", names=", ".join(names))
            raise self._fault(arguments[len(names)].column, TOO_MANY, Message(text, **told), hint)
        return {name: each for name, each in zip(names, arguments, strict=False) if each.given}

    def _check(self) -> None:
        """Raise ProgramError if the cycle is not allowed in the present state.

        It is not allowed in a rotated, scaled or mirrored frame, or with nose compensation. With TRANSMIT,
        only drilling cycles are allowed.
        """
        text = "{call} cannot run in a frame that is rotated, scaled or mirrored."
        hint = "Write TRANS without axes before this block."
        self.require(self.state.programmed.plain, "cycle-frame", text, hint)
        plane = self.state.transformation
        if plane is not None and (self.line.call not in _LIVE or not plane.along_z):
            template = (
                "{call} uses the spindle for turning or tapping, but {plane} is active."
                if plane.along_z
                else "{call} moves along Z, but {plane} is active."
            )
            hint = "Write TRAFOOF before this block."
            raise self.refused("transformation", template, hint, plane=plane.name)
        text, on = "{what} is not allowed while G{state} is active.", self.state.modal.nose_comp
        hint = "Write G40 and a move before this block."
        self.require(on == 40, "comp-with", text, hint, what=self.line.call, state=on)

    def given(self, name: str) -> bool:
        """Return whether the call passes this parameter."""
        return name in self._arguments

    def text(self, name: str) -> str:
        """Return a string parameter in capitals; empty without it."""
        argument = self._arguments.get(name)
        return "" if argument is None or argument.text is None else argument.text.upper()

    def number(self, name: str, default: float = 0.0) -> float:
        """Return a number as written. Raises ProgramError for a string."""
        argument = self._arguments.get(name)
        if argument is None:
            return default
        if argument.formula is None:
            raise self.wrong(name, "{name} is text but must be a number", "Enter a number.")
        return self.state.worth(
            argument.formula,
            lambda c, t, h: self._fault(argument.column, c, Message("{name}: {t}", name=name, t=t), h),
        )

    def length(self, name: str, default: float = 0.0) -> float:
        """Return a length in mm, converted from inches under G70."""
        if not self.given(name):
            return default
        return self.number(name) * (1.0 if self.state.modal.metric else 25.4)

    def size(self, name: str, default: float = 0.0) -> float:
        """Return a length without a sign, in mm. Raises ProgramError if it is negative."""
        value = self.length(name, default)
        self.check(value >= 0.0, name, "{name} is a size and cannot be negative", "Remove the sign.")
        return value

    def needed(self, name: str) -> float:
        """Return a required length in mm. Raises ProgramError if it is missing."""
        if not self.given(name):
            raise self.wrong(name, "{name} is missing", "Add this parameter to {call}.", call=self.line.call)
        return self.length(name)

    def over_zero(self, name: str, alarm: _Alarm = _OWN) -> float:
        """Return a required length above 0, in mm. Raises ProgramError if it is missing or not above 0."""
        value = self.needed(name)
        self.check(value > 0.0, name, "{name} must be greater than 0", "Correct the value.", alarm)
        return value

    def whole(self, name: str, default: int, low: int, high: int) -> int:
        """Return a whole number from ``low`` to ``high``. Raises ProgramError for any other value."""
        value = self.number(name, float(default))
        self._demand_whole(name, value)
        text = "{name} is {value} but must be between {low} and {high}"
        self.check(low <= value <= high, name, text, "Correct the value.", value=value, low=low, high=high)
        return round(value)

    def _demand_whole(self, name: str, value: float) -> None:
        text = "{name} is {value} but must be a whole number"
        self.check(value == round(value), name, text, "Enter a whole number.", value=value)

    def zero_only(self, name: str, why: str) -> None:
        """Raise ProgramError if a parameter requests a function that is not supported."""
        if self.number(name):
            raise self.wrong(name, "{name} is not supported; {why}", "Omit {name}.", "not-in-subset", why=why)

    def feed(self, name: str) -> float | None:
        """Return a feed in the unit of ``modal.feed``; without the parameter, the active feed."""
        if not self.given(name) or not self.number(name):
            return self.state.modal.feed
        value = self.number(name)
        self.check(value >= 0.0, name, "{name} must be a feed rate above 0", "Correct the value.")
        value *= 25.4 if self.state.feed_in_inches else 1.0
        return value if self.state.modal.per_rev else value / 60.0

    def machining(self, name: str, known: range) -> int:
        """Return VARI. Raises ProgramError with the alarm of the control for an invalid type."""
        value = self.number(name)
        self._demand_whole(name, value)
        if round(value) not in known:
            low, high = known[0], known[-1]
            text = "{name} is {value}; valid types are {low} to {high}"
            hint = "Correct the value."
            raise self.wrong(name, text, hint, MACHINING_TYPE, value=value, low=low, high=high)
        return round(value)

    def angle(self, name: str, text: str) -> float:
        """Return an angle from 0 to less than 360 degrees. Raises ProgramError for any other value."""
        value = self.number(name)
        self.check(0.0 <= value < 360.0, name, text)
        return value

    def pass_count(
        self, whole: float, each: float, name: str, text: str, hint: str = _POINT, most: int = MOST_PASSES
    ) -> int:
        """Return the number of passes of ``each`` mm for a depth in mm.

        Raises ProgramError if there are too many.
        """
        count = pass_count(whole, each)
        self.check(count <= min(most, MOST_PASSES), name, text, hint, count=f"{count:,}")
        return count

    def known_feed(
        self, feed: float | None, alarm: int = NO_F, hint: str = "Program F before this block."
    ) -> float:
        """Return the feed. Raises ProgramError if it is None."""
        if feed is None:
            raise self.refused(alarm, "no feedrate is programmed.", hint)
        return feed

    def off_part(self, clear: float, out: float = 1.0) -> list[Step]:
        """Return a step to X ``clear`` if the tool is closer to the part.

        ``out`` is the sign of X away from the part.
        """
        return [] if out * self.x >= out * clear else [Step(clear, self.z)]

    def demand_tool(self) -> None:
        """Raise ProgramError unless a tool with an offset is active."""
        modal, text = self.state.modal, "{call} needs an active tool with an offset."
        self.require(modal.tool and modal.edge, 61000, text, "Write T and D before this block.")

    def wrong(
        self, name: str, what: str, hint: str = _CORRECT, code: _Alarm = _OWN, /, **values: object
    ) -> ProgramError:
        """Return an error about one parameter; ``values`` fill the placeholders of ``what`` and ``hint``."""
        argument = self._arguments.get(name)
        column = self.line.call_column if argument is None else argument.column
        values = {"name": name, "call": self.line.call, **values}
        text = Message("{call}: {what}.", call=self.line.call, what=worded(what, values))
        return self._fault(column, code, text, worded(hint, values))

    def check(
        self, ok: object, name: str, what: str, hint: str = _CORRECT, code: _Alarm = _OWN, /, **values: object
    ) -> None:
        """Raise the error of ``wrong`` unless the condition ``ok`` is true."""
        if not ok:
            raise self.wrong(name, what, hint, code, **values)

    def refused(self, code: _Alarm, text: str, hint: str, /, **values: object) -> ProgramError:
        """Return an error about the whole call; ``values`` fill the placeholders of ``text`` and ``hint``."""
        values = {"call": self.line.call, **values}
        return self._fault(self.line.call_column, code, worded(text, values), worded(hint, values))

    def require(self, ok: object, code: _Alarm, text: str, hint: str, /, **values: object) -> None:
        """Raise the error of ``refused`` unless the condition ``ok`` is true."""
        if not ok:
            raise self.refused(code, text, hint, **values)

    def _fault(self, column: int, code: _Alarm, text: str, hint: str) -> ProgramError:
        return ProgramError(fault(self.line.number, column, code, self.line.block, text, hint))

    def warn(self, code: str, text: str, hint: str, /, **values: object) -> None:
        """Log a warning about the call."""
        found = self.refused(code, text, hint, **values).diagnostic
        self.state.log.add(replace(found, severity=Severity.WARNING))

    def blocks(self, steps: Sequence[Step]) -> Iterator[Block]:
        """Yield the motions as blocks. All feeds are checked before the first block. Raises ProgramError."""
        at, kept = (self.x, self.z), list[tuple[Step, float]]()
        for step in steps:
            still = step.action is None and step.centre is None and not step.turn
            if still and hypot(step.x - at[0], step.z - at[1]) <= _SAME:
                continue
            feed = step.feed or 0.0
            if step.action is None and step.feed is not None and not step.thread and not step.turn:
                feed = self._check_feed(step, at[0])
            kept.append((step, feed))
            at = (step.x, step.z) if step.action is None else at
        for step, feed in kept:
            yield self._block(step, feed)

    def _check_feed(self, step: Step, x0: float) -> float:
        """Return the feed of a step in the unit of its block. Raises ProgramError if it is invalid."""
        state, modal = self.state, self.state.modal
        state.adopt(modal._replace(feed=step.feed))
        try:
            return check_feed(state, self.statement, x0, step.x)
        finally:
            state.adopt(modal)

    def _block(self, step: Step, feed: float) -> Block:
        state, modal = self.state, self.state.modal
        if step.action is not None:
            if step.spindle is not None:
                action, locked = step.action, isinstance(step.action, SpindleLock)
                at = action.angle if isinstance(action, SpindleOrient) else None
                state.adopt(modal._replace(spindle=step.spindle, c_locked=locked, oriented=at))
            done = state.action(self.line.number, _told(step), step.action)
            done.in_hole = step.in_hole
            return done
        text = f"{self.line.call} {_words(step, modal.diameter)}"
        if state.transformation is not None:
            return state.transformation.down_to(
                self.statement, step.z, None if step.feed is None else feed, text
            )
        x, z = step.x + modal.offset_x, step.z + modal.offset_z
        travel = AxisTravel(
            state.x, state.z, state.c, x, z, state.c + step.turn, modal, modal.offset_x, modal.offset_z,
            state.programmed,
        )  # fmt: skip
        kind = Kind.THREAD if step.thread else Kind.ARC if step.centre is not None else Kind.FEED
        if step.feed is None:
            speeds = state.setup.limits.speeds
            made = block_of(state, self.statement, travel, Kind.RAPID, travel.rapid_rate(speeds))
        else:
            made = block_of(state, self.statement, travel, kind, feed)
        made.text = text
        made.per_rev = (step.thread or made.per_rev) and not step.turn
        made.coupled, made.in_hole = step.tap, step.in_hole
        made.continues, self._in_thread = step.thread and self._in_thread, step.thread
        if step.centre is not None:
            made.cx, made.cz = step.centre
            made.clockwise = step.clockwise
        return made


def acting(action: Action, spindle: int | None = None) -> Step:
    """Return a step with an action at the present position; ``spindle`` is as in ``Step``."""
    return Step(0.0, 0.0, action=action, spindle=spindle)


def dwell(seconds: float) -> list[Step]:
    """Return a dwell step, or an empty list for 0 s."""
    return [acting(Dwell(seconds))] if seconds > 0.0 else []


def _words(step: Step, diameter: bool) -> str:
    # G2 is clockwise in the view with X up. Blocks use the view with X down.
    code = "G33" if step.thread else "G0" if step.feed is None else "G1"
    if step.centre is not None:
        code = "G3" if step.clockwise else "G2"
    x = step.x * (2.0 if diameter else 1.0)
    return f"{code} X{x + 0.0:.3f} Z{step.z + 0.0:.3f}"


def _told(step: Step) -> str:
    match step.action:
        case Dwell(seconds=seconds):
            return f"G4 F{seconds:g}"
        case SpindleRun(rpm=rpm):
            return f"S{abs(rpm):g} M{3 if rpm > 0 else 4}"
        case SpindleStop():
            return "M5"
        case SpindleLock():
            return "M70"
        case SpindleOrient(angle=angle):
            return f"SPOS={angle:g}"
        case _:
            return "M0"
