"""Writer that converts the steps of a source program to an OmniTurn program."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import copysign
from typing import NamedTuple

from core.extras.convert.conversion_messages import make_error, make_warning
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind, has_same_speed
from core.extras.convert.source_options import ConversionOptions
from core.interpreter.shared.units import get_surface_speed_unit
from core.language.diagnostics import Diagnostic

MM_PER_INCH = 25.4
MIN_DEPTH_MM = (0.00005 * MM_PER_INCH, 0.001)  # mm per side; I of a thread of one pass, in inches and mm
_LONGEST = 60
_LONGEST_STOP = 120  # of the text for the operator at M00 or M01
_NOT_IN_COMMENTS = re.compile(r"[^ -'*-~]")


class WrittenLine(NamedTuple):
    """A line of the converted program with its source line number, or 0 if it has no source line."""

    text: str
    source_line_number: int


@dataclass(slots=True)
class OmniTurnWriter:
    """Writer of the converted program, which tracks the modal state after the last line.

    Lengths are in mm, and X is a radius.
    """

    is_metric: bool
    options: ConversionOptions
    lines: list[WrittenLine] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)
    x: float | None = None
    z: float | None = None
    is_rapid: bool = False
    is_feed_per_rev: bool | None = None
    feed: float | None = None
    spindle: SpindleState = field(default_factory=SpindleState)
    tool_number: int = 0
    active_tool_number: int = 0  # T that is active in the converted program
    nose_code: int = 0  # D that the next move needs
    needs_both_axes: bool = True
    pending_step: PathStep | None = None  # rapid with an unknown coordinate
    last_rapid_move: tuple[int, float | None, float | None, bool] | None = (
        None  # last rapid: line, start, G00
    )

    deletable_lines: frozenset[int] = frozenset()  # source lines that block delete skips
    title: str = ""  # program number, for the comment of the first line
    repeats_axes: bool = True  # after these lines, the next move has both axes

    # --- numbers

    def round_length(self, value: float, *, is_diameter: bool = False) -> float:
        """Convert a length in mm to the unit of the program, rounded to the resolution of the control.

        If ``is_diameter`` is True, the result is a diameter.
        """
        if self.is_metric:
            return round(value * (2 if is_diameter else 1), 4) + 0.0
        steps = round(value / MM_PER_INCH / 0.00005)
        return round(steps * (0.0001 if is_diameter else 0.00005), 5) + 0.0

    def format_word(self, letter: str, value: float, places: int = 5) -> str:
        """Return a word without unnecessary zeros after the decimal point."""
        return letter + number(value, places)

    def append_line(self, text: str, step: PathStep) -> None:
        """Append a line for a step of the source program, with a comment that refers to the source."""
        self.lines.append(WrittenLine(text + self.make_comment(step), step.line))

    def make_comment(self, step: PathStep) -> str:
        """Return the comment for the line of a step, or an empty string if comments are disabled."""
        stop = step.kind is StepKind.M and step.number in {0, 1}
        if not self.options.writes_comments and not (stop and step.comment):
            return ""
        words = _NOT_IN_COMMENTS.sub(" ", step.comment)[: _LONGEST_STOP if stop else _LONGEST].strip()
        place = f"L{step.line}" if self.options.writes_comments else ""
        return f"({f'{place} {words}'.strip()})"

    # --- steps

    def write_steps(self, steps: Sequence[PathStep]) -> None:
        """Append the lines of all steps. Raises ProgramError if a step cannot be written."""
        rate = self.options.rapid / (1.0 if self.is_metric else MM_PER_INCH)
        unit = "G71" if self.is_metric else "G70"
        first = PathStep(StepKind.END, steps[0].line if steps else 0, comment=self.title)
        self.append_line(f"G90G94F{number(rate, 3)}{unit}G72", first)
        at, was_deletable = 0, False
        while at < len(steps):
            if (steps[at].line in self.deletable_lines) is not was_deletable:
                was_deletable = not was_deletable
                self._forget_modes()
            at += self._step(steps, at)
        self.lines[1:] = [
            each._replace(text=f"/{each.text}") if each.source_line_number in self.deletable_lines else each
            for each in self.lines[1:]
        ]

    def _forget_modes(self) -> None:
        """Write the axes and the feed again, because block delete may skip the lines before."""
        self.needs_both_axes = self.needs_both_axes or self.repeats_axes
        self.is_rapid, self.feed, self.is_feed_per_rev = False, None, None

    def _step(self, steps: Sequence[PathStep], at: int) -> int:
        """Write the lines for the step at index ``at``; return how many steps these lines cover."""
        step = steps[at]
        match step.kind:
            case StepKind.RAPID | StepKind.FEED | StepKind.ARC | StepKind.THREAD:
                return self._move(steps, at)
            case StepKind.HOME:
                self._home(step)
            case StepKind.TOOL:
                self._unresolved()
                self.tool_number, self.x, self.z = round(step.number), None, None
                self._select(step)
            case StepKind.SPINDLE:
                self._spindle(step)
            case StepKind.DWELL:
                self.append_line(f"G04{self.format_word('F', step.number, 3)}", step)
            case StepKind.M:
                self.append_line(f"M{round(step.number):02d}", step)
            case StepKind.PRESET:
                self._preset(step)
            case StepKind.NOSE:
                self.append_line(f"G{round(step.number)}", step)
                self.nose_code = 0 if step.number == 40 else self.tool_number or 1
            case StepKind.END:
                self._unresolved()
                self.append_line(f"M{round(step.number):02d}", step)
        return 1

    def _select(self, step: PathStep) -> None:
        self.append_line(f"T{self.tool_number}", step)
        self.active_tool_number, self.needs_both_axes = self.tool_number, True

    def _unresolved(self) -> None:
        if self.pending_step is not None:
            axis = "X" if self.pending_step.x is None else "Z"
            raise make_error(self.pending_step.line, 1, "position", axis=axis)

    def _move(self, steps: Sequence[PathStep], at: int) -> int:
        step = steps[at]
        if step.x is None or step.z is None:
            self.pending_step = step
            return 1
        if self.pending_step is not None:
            self.warnings.append(make_warning(self.pending_step.line, 1, "approach-joined"))
            self.pending_step = None
        if self.tool_number and self.active_tool_number != self.tool_number:
            self._select(step)
        after = steps[at + 1 : at + 4]
        if step.kind is StepKind.THREAD:
            return _write_thread(self, step, after)
        self._go(step)
        return 1

    def _go(self, step: PathStep) -> None:
        assert step.x is not None
        assert step.z is not None
        words = self._feed(step)
        if step.kind is StepKind.ARC:
            words += "G02" if step.clockwise else "G03"
        arc = step.kind is StepKind.ARC
        x, z = self.round_length(step.x, is_diameter=True), self.round_length(step.z)
        moved = False
        if arc or self.needs_both_axes or self.x is None or x != self.round_length(self.x, is_diameter=True):
            words, moved = words + self.format_word("X", x), True
        if arc or self.needs_both_axes or self.z is None or z != self.round_length(self.z):
            words, moved = words + self.format_word("Z", z), True
        if arc:
            words += self.format_word("I", self.round_length(step.cx - self.round_x(self.x)))
            words += self.format_word("K", self.round_length(step.cz - self.round_z(self.z)))
        if self.nose_code and moved:
            words += f"D{self.nose_code}"
            self.nose_code = 0
        before = self.is_rapid if step.kind is not StepKind.RAPID else "G00" not in words
        if words:
            self.append_line(words, step)
            self.needs_both_axes = self.needs_both_axes and not moved
        if step.kind is StepKind.RAPID and moved:
            self.last_rapid_move = len(self.lines), self.x, self.z, before
        self.x, self.z = step.x, step.z

    def round_x(self, x: float | None) -> float:
        """Return X in mm as a radius, rounded to the resolution of the control."""
        unit = 1.0 if self.is_metric else MM_PER_INCH
        return self.round_length(x or 0.0, is_diameter=True) * unit / 2

    def round_z(self, z: float | None) -> float:
        """Return Z in mm, rounded to the resolution of the control."""
        return self.round_length(z or 0.0) * (1.0 if self.is_metric else MM_PER_INCH)

    def _feed(self, step: PathStep) -> str:
        if step.kind is StepKind.RAPID:
            words, self.is_rapid = "" if self.is_rapid else "G00", True
            return words
        if not self.is_rapid and step.per_rev == self.is_feed_per_rev and step.feed == self.feed:
            return ""
        self.is_rapid, self.is_feed_per_rev, self.feed = False, step.per_rev, step.feed
        value = step.feed / (1.0 if self.is_metric else MM_PER_INCH)
        return ("G95" if step.per_rev else "G94") + self.format_word("F", value, 8)

    def write_rapid(self, step: PathStep, x: float, z: float) -> None:
        """Write a rapid to a point; the line refers to the source line of ``step``."""
        self._go(PathStep(StepKind.RAPID, step.line, x, z))

    def _home(self, step: PathStep) -> None:
        if self.pending_step is not None and not (step.x is not None and step.z is not None):
            self._unresolved()
        self.pending_step = None
        if self.active_tool_number != -1:
            self.append_line("T0", step)
            step = replace(step, comment="")
        self.active_tool_number = -1
        words = ("X0" if step.x is not None else "") + ("Z0" if step.z is not None else "")
        self.append_line(("" if self.is_rapid else "G00") + words, step)
        self.is_rapid, self.needs_both_axes = True, True
        self.x = None if step.x is not None else self.x
        self.z = None if step.z is not None else self.z

    def _preset(self, step: PathStep) -> None:
        words = "G92"
        words += (
            self.format_word("X", self.round_length(step.x, is_diameter=True)) if step.x is not None else ""
        )
        words += self.format_word("Z", self.round_length(step.z)) if step.z is not None else ""
        self.append_line(words, step)
        self.x, self.z, self.needs_both_axes = step.x, step.z, False

    def _spindle(self, step: PathStep) -> None:
        spindle, before = step.spindle, self.spindle
        self.spindle = spindle
        if not spindle.direction:
            self.append_line("M05", step)
            return
        if spindle.max_rpm and spindle.max_rpm != before.max_rpm:
            self.append_line(f"G77S{number(spindle.max_rpm, 1)}", step)
        mode = "G96" if spindle.is_css else "G97"
        unit = get_surface_speed_unit(is_metric=self.is_metric) if spindle.is_css else 1.0
        speed = f"S{number(spindle.speed / unit, 3)}" if spindle.speed else ""
        if not has_same_speed(spindle, before):
            start = (
                "" if spindle.direction == before.direction else ("M03" if spindle.direction > 0 else "M04")
            )
            self.append_line(f"{mode}{start}{speed}", step)


def number(value: float, places: int = 5) -> str:
    """Format a number without unnecessary zeros, such as ``.5`` or ``-1.25``.

    An integer has no decimal point.
    """
    text = f"{value:.{places}f}".rstrip("0").rstrip(".") if places else f"{value:.0f}"
    text = "0" if text in {"-0", ""} else text
    return re.sub(r"^(-?)0\.", r"\1.", text)


# --- thread passes as G33 with O: one line for the pass, its pull-out and its return

_NEAR = 1e-6  # mm


def _write_thread(writer: OmniTurnWriter, step: PathStep, after: Sequence[PathStep]) -> int:
    """Write one thread pass; return how many steps it covers: thread, pull-out and return.

    - The tool must already be at the start of the thread, and a rapid out in X must follow.
    - If this rapid also moves Z, a warning is added and only the thread step is covered.
    - The cycle starts at a point outside the thread, and retracts to the X of the pull-out.
    - Raises ProgramError if the position before the pass is unknown, if no such rapid follows, or if
      the
      pull-out does not end far enough outside the start of the thread.
    """
    assert step.x is not None
    assert step.z is not None
    start_x, start_z = writer.x, writer.z
    out = after[0] if after else None
    if start_x is None or start_z is None or not _is_pull_out(step, out):
        raise make_error(step.line, 1, "thread-chain")
    assert out is not None
    assert out.x is not None
    assert out.z is not None
    least = MIN_DEPTH_MM[writer.is_metric]
    away = copysign(1.0, out.x - step.x)
    taper = step.x - start_x
    begin = out.x - away * (3 * least + max(away * taper, 0.0))
    if away * (begin - start_x) <= _NEAR:
        raise make_error(step.line, 1, "thread-chain")
    _drop_infeed(writer, start_z)
    writer.write_rapid(step, begin, start_z)
    unit = 1.0 if writer.is_metric else MM_PER_INCH
    words = (
        "G33"
        + writer.format_word("X", writer.round_length(start_x, is_diameter=True))
        + writer.format_word("Z", writer.round_length(step.z))
        + writer.format_word("I", writer.round_length(least, is_diameter=True))
        + (
            writer.format_word("A", writer.round_length(taper, is_diameter=True))
            if abs(taper) > _NEAR
            else ""
        )
        + writer.format_word("K", step.feed / unit, 8)
        + "O"
    )
    writer.append_line(words, step)
    writer.x, writer.z = begin, start_z
    if abs(out.z - step.z) > _NEAR:
        writer.warnings.append(make_warning(step.line, 1, "thread-pull-out"))
        return 1
    return 2 + _returns(out, after[1:], start_z)


def _is_pull_out(step: PathStep, out: PathStep | None) -> bool:
    if out is None or out.kind is not StepKind.RAPID or out.x is None or out.z is None:
        return False
    assert step.x is not None
    return abs(out.x - step.x) > _NEAR


def _returns(out: PathStep, after: Sequence[PathStep], start_z: float) -> int:
    """Return 1 if the next step returns to the start Z at the X of the pull-out, and otherwise 0."""
    back = after[0] if after else None
    if back is None or back.kind is not StepKind.RAPID or back.x is None or back.z is None:
        return 0
    assert out.x is not None
    return int(abs(back.x - out.x) < _NEAR and abs(back.z - start_z) < _NEAR)


def _drop_infeed(writer: OmniTurnWriter, start_z: float) -> None:
    """Remove the last rapid if it moves to the pass depth, because the cycle makes this move."""
    if writer.last_rapid_move is None:
        return
    count, x, z, was_rapid = writer.last_rapid_move
    if z is not None and abs(z - start_z) < _NEAR and x is not None and count == len(writer.lines):
        writer.lines.pop()
        writer.x, writer.z = x, z
        writer.is_rapid = was_rapid
