"""Writer that makes an OmniTurn program from the steps of a source program."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import copysign
from typing import NamedTuple

from core.extras.convert.path_steps import Kind, Spindle, Step, is_same_run
from core.extras.convert.reasons import refuse, warn
from core.extras.convert.source_options import Options
from core.language.diagnostics import Diagnostic

MM_PER_INCH = 25.4
LEAST_DEPTH = (0.00005 * MM_PER_INCH, 0.001)  # mm per side; I of a thread of one pass, in inches and mm
_LONGEST = 60
_NOT_IN_COMMENTS = re.compile(r"[^ -'*-~]")


class WrittenLine(NamedTuple):
    """A line of the converted program, with the number of its source line (0 if it has none)."""

    text: str
    line: int


@dataclass(slots=True)
class Writer:
    """Writer of the converted program, with the modal state after the last line.

    Lengths are in mm, and X is a radius.
    """

    metric: bool
    options: Options
    lines: list[WrittenLine] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)
    x: float | None = None
    z: float | None = None
    rapid: bool = False
    per_rev: bool | None = None
    feed: float | None = None
    spindle: Spindle = field(default_factory=Spindle)
    tool: int = 0
    active: int = 0  # T that is active in the converted program
    nose: int = 0  # D that the next move needs
    needs_both: bool = True
    pending: Step | None = None  # rapid with an unknown coordinate
    infeed: tuple[int, float | None, float | None, bool] | None = None  # last rapid: line, start, G00

    # --- numbers

    def grid(self, value: float, *, across: bool = False) -> float:
        """Convert a length in mm to the unit of the program, rounded to the resolution of the control.

        If ``across`` is True, the result is a diameter.
        """
        if self.metric:
            return round(value * (2 if across else 1), 4) + 0.0
        steps = round(value / MM_PER_INCH / 0.00005)
        return round(steps * (0.0001 if across else 0.00005), 5) + 0.0

    def word(self, letter: str, value: float, places: int = 5) -> str:
        """Return a word without unnecessary zeros after the decimal point."""
        return letter + number(value, places)

    def say(self, text: str, step: Step) -> None:
        """Append a line for a step, with the source in a comment."""
        self.lines.append(WrittenLine(text + self.comment(step), step.line))

    def comment(self, step: Step) -> str:
        """Return the comment for the line of a step, or an empty text if comments are disabled."""
        stop = step.kind is Kind.M and step.number in {0, 1}
        if not self.options.comments and not (stop and step.comment):
            return ""
        words = _NOT_IN_COMMENTS.sub(" ", step.comment)[:_LONGEST].strip()
        place = f"L{step.line}" if self.options.comments else ""
        return f"({f'{place} {words}'.strip()})"

    # --- steps

    def write(self, steps: Sequence[Step]) -> None:
        """Append the lines of all steps. Raises ProgramError."""
        rate = self.options.rapid / (1.0 if self.metric else MM_PER_INCH)
        unit = "G71" if self.metric else "G70"
        first = Step(Kind.M, steps[0].line if steps else 0)
        self.say(f"G90G94F{number(rate, 3)}{unit}G72", first)
        at = 0
        while at < len(steps):
            at += self._step(steps, at)

    def _step(self, steps: Sequence[Step], at: int) -> int:
        """Write one step and return the number of steps that the written lines include."""
        step = steps[at]
        match step.kind:
            case Kind.RAPID | Kind.FEED | Kind.ARC | Kind.THREAD:
                return self._move(steps, at)
            case Kind.HOME:
                self._home(step)
            case Kind.TOOL:
                self._unresolved()
                self.tool, self.x, self.z = round(step.number), None, None
                self._select(step)
            case Kind.SPINDLE:
                self._spindle(step)
            case Kind.DWELL:
                self.say(f"G04{self.word('F', step.number, 3)}", step)
            case Kind.M:
                self.say(f"M{round(step.number):02d}", step)
            case Kind.PRESET:
                self._preset(step)
            case Kind.NOSE:
                self.say(f"G{round(step.number)}", step)
                self.nose = 0 if step.number == 40 else self.tool or 1
            case Kind.END:
                self._unresolved()
                self.say(f"M{round(step.number):02d}", step)
        return 1

    def _select(self, step: Step) -> None:
        self.say(f"T{self.tool}", step)
        self.active, self.needs_both = self.tool, True

    def _unresolved(self) -> None:
        if self.pending is not None:
            axis = "X" if self.pending.x is None else "Z"
            raise refuse(self.pending.line, 1, "position", axis=axis)

    def _move(self, steps: Sequence[Step], at: int) -> int:
        step = steps[at]
        if step.x is None or step.z is None:
            self.pending = step
            return 1
        if self.pending is not None:
            self.warnings.append(warn(self.pending.line, 1, "approach-joined"))
            self.pending = None
        if self.tool and self.active != self.tool:
            self._select(step)
        after = steps[at + 1 : at + 4]
        if step.kind is Kind.THREAD:
            return _write_thread(self, step, after)
        self._go(step)
        return 1

    def _go(self, step: Step) -> None:
        assert step.x is not None
        assert step.z is not None
        words = self._feed(step)
        if step.kind is Kind.ARC:
            words += "G02" if step.clockwise else "G03"
        arc = step.kind is Kind.ARC
        x, z = self.grid(step.x, across=True), self.grid(step.z)
        moved = False
        if arc or self.needs_both or self.x is None or x != self.grid(self.x, across=True):
            words, moved = words + self.word("X", x), True
        if arc or self.needs_both or self.z is None or z != self.grid(self.z):
            words, moved = words + self.word("Z", z), True
        if arc:
            words += self.word("I", self.grid(step.cx - self.snap_x(self.x)))
            words += self.word("K", self.grid(step.cz - self.snap_z(self.z)))
        if self.nose and moved:
            words += f"D{self.nose}"
            self.nose = 0
        before = self.rapid if step.kind is not Kind.RAPID else "G00" not in words
        if words:
            self.say(words, step)
            self.needs_both = self.needs_both and not moved
        if step.kind is Kind.RAPID and moved:
            self.infeed = len(self.lines), self.x, self.z, before
        self.x, self.z = step.x, step.z

    def snap_x(self, x: float | None) -> float:
        """Return X in mm as a radius, rounded to the resolution of the control."""
        unit = 1.0 if self.metric else MM_PER_INCH
        return self.grid(x or 0.0, across=True) * unit / 2

    def snap_z(self, z: float | None) -> float:
        """Return Z in mm, rounded to the resolution of the control."""
        return self.grid(z or 0.0) * (1.0 if self.metric else MM_PER_INCH)

    def _feed(self, step: Step) -> str:
        if step.kind is Kind.RAPID:
            words, self.rapid = "" if self.rapid else "G00", True
            return words
        if not self.rapid and step.per_rev == self.per_rev and step.feed == self.feed:
            return ""
        self.rapid, self.per_rev, self.feed = False, step.per_rev, step.feed
        value = step.feed / (1.0 if self.metric else MM_PER_INCH)
        return ("G95" if step.per_rev else "G94") + self.word("F", value, 8)

    def go_rapid(self, step: Step, x: float, z: float) -> None:
        """Write a rapid to a point; the line refers to the source line of ``step``."""
        self._go(Step(Kind.RAPID, step.line, x, z))

    def _home(self, step: Step) -> None:
        if self.pending is not None and not (step.x is not None and step.z is not None):
            self._unresolved()
        self.pending = None
        if self.active != -1:
            self.say("T0", step)
            step = replace(step, comment="")
        self.active = -1
        words = ("X0" if step.x is not None else "") + ("Z0" if step.z is not None else "")
        self.say(("" if self.rapid else "G00") + words, step)
        self.rapid, self.needs_both = True, True
        self.x = None if step.x is not None else self.x
        self.z = None if step.z is not None else self.z

    def _preset(self, step: Step) -> None:
        words = "G92"
        words += self.word("X", self.grid(step.x, across=True)) if step.x is not None else ""
        words += self.word("Z", self.grid(step.z)) if step.z is not None else ""
        self.say(words, step)
        self.x, self.z, self.needs_both = step.x, step.z, False

    def _spindle(self, step: Step) -> None:
        spindle, before = step.spindle, self.spindle
        self.spindle = spindle
        if not spindle.direction:
            self.say("M05", step)
            return
        if spindle.most and spindle.most != before.most:
            self.say(f"G77S{number(spindle.most, 1)}", step)
        mode = "G96" if spindle.css else "G97"
        speed = f"S{number(spindle.speed, 3)}" if spindle.speed else ""
        if not is_same_run(spindle, before):
            start = (
                "" if spindle.direction == before.direction else ("M03" if spindle.direction > 0 else "M04")
            )
            self.say(f"{mode}{start}{speed}", step)


def number(value: float, places: int = 5) -> str:
    """Format a number without unnecessary zeros, such as ``.5`` or ``-1.25``.

    An integer has no decimal point.
    """
    text = f"{value:.{places}f}".rstrip("0").rstrip(".") if places else f"{value:.0f}"
    text = "0" if text in {"-0", ""} else text
    return re.sub(r"^(-?)0\.", r"\1.", text)


# --- thread passes as G33 with O: one line for the pass, its pull-out and its return

_NEAR = 1e-6  # mm


def _write_thread(writer: Writer, step: Step, after: Sequence[Step]) -> int:
    """Write one thread pass; return the number of steps that it includes: thread, pull-out and return.

    The tool must already be at the start of the thread, and a rapid straight out in X must follow. The
    cycle needs a start point outside the thread; its retract is then the X of the pull-out. Raises
    ProgramError.
    """
    assert step.x is not None
    assert step.z is not None
    start_x, start_z = writer.x, writer.z
    out = after[0] if after else None
    if start_x is None or start_z is None or not _is_pull_out(step, out):
        raise refuse(step.line, 1, "thread-chain")
    assert out is not None
    assert out.x is not None
    assert out.z is not None
    least = LEAST_DEPTH[writer.metric]
    away = copysign(1.0, out.x - step.x)
    taper = step.x - start_x
    begin = out.x - away * (3 * least + max(away * taper, 0.0))
    if away * (begin - start_x) <= _NEAR:
        raise refuse(step.line, 1, "thread-chain")
    _drop_infeed(writer, start_z)
    writer.go_rapid(step, begin, start_z)
    unit = 1.0 if writer.metric else MM_PER_INCH
    words = (
        "G33"
        + writer.word("X", writer.grid(start_x, across=True))
        + writer.word("Z", writer.grid(step.z))
        + writer.word("I", writer.grid(least, across=True))
        + (writer.word("A", writer.grid(taper, across=True)) if abs(taper) > _NEAR else "")
        + writer.word("K", step.feed / unit, 8)
        + "O"
    )
    writer.say(words, step)
    writer.x, writer.z = begin, start_z
    if abs(out.z - step.z) > _NEAR:
        writer.warnings.append(warn(step.line, 1, "thread-pull-out"))
        return 1
    return 2 + _returns(out, after[1:], start_z)


def _is_pull_out(step: Step, out: Step | None) -> bool:
    if out is None or out.kind is not Kind.RAPID or out.x is None or out.z is None:
        return False
    assert step.x is not None
    return abs(out.x - step.x) > _NEAR


def _returns(out: Step, after: Sequence[Step], start_z: float) -> int:
    """Return 1 if the next step returns to the start Z of the pass at the X of the pull-out, otherwise 0."""
    back = after[0] if after else None
    if back is None or back.kind is not Kind.RAPID or back.x is None or back.z is None:
        return 0
    assert out.x is not None
    return int(abs(back.x - out.x) < _NEAR and abs(back.z - start_z) < _NEAR)


def _drop_infeed(writer: Writer, start_z: float) -> None:
    """Remove the rapid to the depth of the pass if it was written last, because the cycle makes this move."""
    if writer.infeed is None:
        return
    count, x, z, was_rapid = writer.infeed
    if z is not None and abs(z - start_z) < _NEAR and x is not None and count == len(writer.lines):
        writer.lines.pop()
        writer.x, writer.z = x, z
        writer.rapid = was_rapid
