"""Lines from which a program can be restarted, as far as its text alone determines this."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter
from typing import NamedTuple

from core.interpreter.omniturn.flow.loops_and_subroutines import get_subroutine_number
from core.interpreter.omniturn.motion.plain_moves import ExecutableLines
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import PLANE_FLOW, Statement
from core.message import Message

_NOSE_ON, _NOSE_OFF = frozenset({41, 42}), 40


class LineRange(NamedTuple):
    """The lines ``first`` to ``last_line`` of a program, counted from 1.

    If a program cannot be restarted from these lines, ``rejection_template`` is the template of the
    message. Its placeholder ``line`` is the restart line. Its placeholder ``begin`` is the line on which
    the contour, corner or other section begins.
    """

    first: int
    last_line: int
    rejection_template: str = ""
    start_line: int = 0

    def make_rejection_message(self, line: int) -> Message:
        """Return the reason why a program cannot be restarted from this line.

        The line must be within the range.
        """
        return Message(self.rejection_template, line=line, begin=self.start_line)


class RestartSuitability:
    """Suitability of each program line for a restart, as determined from the program text."""

    def __init__(self, program: Program) -> None:
        self._steps = program.executable_lines
        self.line_count = len(program.executable_lines)
        order = attrgetter("first")
        self.unsuitable_ranges = sorted((*_structured(program), *_open(program.executable_lines)), key=order)
        self.repeated_ranges = sorted(_repeated(program), key=order)
        self._apart = sorted((*self.unsuitable_ranges, *self.repeated_ranges), key=order)
        self._calls = _calls(program)

    def explain_unsuitable_line(self, line: int) -> str:
        """Return the reason why a restart from this line is not possible.

        The result is an empty string if the text of the program allows a restart.
        """
        if not 1 <= line <= self.line_count:
            return Message(
                "Line {line} does not exist; the last line of the program is {lines_count}.",
                line=line,
                lines_count=self.line_count,
            )
        for lines in self.unsuitable_ranges:
            if lines.first <= line <= lines.last_line:
                return lines.make_rejection_message(line)
        return "" if self._steps[line - 1] is not None else Message("Line {line} is empty.", line=line)

    def is_repeated_line(self, line: int) -> bool:
        """Return whether a line is in a loop or subroutine.

        Such a line may be executed several times or never.
        """
        return any(each.first <= line <= each.last_line for each in self.repeated_ranges)

    def find_nearest_line(self, line: int, direction: int) -> int:
        """Return the nearest suitable line in one direction, or 0 if that direction has no suitable line.

        ``direction`` is 1 to search forward and -1 to search backward. Loops and subroutines are skipped.
        From inside a subroutine, the backward search continues at its first call.
        """
        if direction < 0:
            line = self._line_after_call(line)
        at = min(line + direction, self.line_count) if direction < 0 else line + direction
        while 1 <= at <= self.line_count:
            lines = next((each for each in self._apart if each.first <= at <= each.last_line), None)
            if lines is not None:
                at = lines.last_line + 1 if direction > 0 else lines.first - 1
            elif self._steps[at - 1] is None:
                at += direction
            else:
                return at
        return 0

    def _line_after_call(self, line: int) -> int:
        """Return the line after the call of the subroutine that contains this line, or the line itself."""
        at = line
        for _ in self._calls:  # a call may be in another subroutine
            at = next((call for first, last, call in self._calls if first <= at <= last), at)
        return line if at == line else at + 1


def _calls(program: Program) -> list[tuple[int, int, int]]:
    """Return the first and last line of each called subroutine, and its first call from outside."""
    calls = [
        (number, get_subroutine_number(step))
        for number, step in enumerate(program.executable_lines, start=1)
        if isinstance(step, Statement) and step.calls_subroutine
    ]
    found = []
    for first, last, number in _subroutines(program):
        outside = (at for at, called in calls if called == number and not first <= at <= last)
        if call := next(outside, 0):
            found.append((first, last, call))
    return found


def _structured(program: Program) -> Iterator[LineRange]:
    """Yield the line ranges of contours and of code that is never reached.

    Only the first line of a contour is suitable for a restart.
    """
    structure = program.structure
    for start, end in structure.contour_ends.items():
        reason = "Line {line} is part of the contour that begins on line {begin}."
        yield LineRange(start + 2, end + 1, reason, start + 1)
    spans = sorted(_subroutines(program))
    at = structure.main_end_index + 1
    for start, end, _number in (*spans, (len(program.executable_lines) + 1, 0, 0)):
        if at < start:
            yield LineRange(at, start - 1, "Line {line} is after the end of the program.")
        at = max(at, end + 1)


def _repeated(program: Program) -> Iterator[LineRange]:
    """Yield the ranges of loops, from the line after LS, and of subroutines."""
    for start, end in program.structure.loop_ends.items():
        yield LineRange(start + 2, end + 1)
    for start, end, _number in _subroutines(program):
        yield LineRange(start, end)


def _subroutines(program: Program) -> Iterator[tuple[int, int, int]]:
    """Yield the first line, the last line and the number of each subroutine."""
    structure = program.structure
    for number, start in structure.subroutine_starts.items():
        yield start + 1, structure.subroutine_ends.get(number, len(program.executable_lines) - 1) + 1, number


def _open(lines: ExecutableLines) -> Iterator[LineRange]:
    """Yield the line ranges of unfinished functions, from the line after the start of each function.

    The functions are coordinate transformation (plane switching), nose compensation and corners.
    """
    plane = nose = corner = 0
    for number, step in enumerate(lines, start=1):
        if not isinstance(step, Statement):
            if corner and step is not None:
                yield _corner(corner, number)
                corner = 0
            continue
        if corner and step.has_x_or_z_move:
            yield _corner(corner, number)
            corner = 0
        if step.has_x_or_z_move and step.one_shot_code is None and ("R" in step.words or "C" in step.words):
            corner = number
        if step.flow_code == PLANE_FLOW:
            plane, done = _plane(step, number, plane)
            if done:
                reason = "Line {line} is in the section of (~PLXC) or (~PLZC) that begins on line {begin}."
                yield LineRange(done + 1, number, reason, done)
        if not nose and _NOSE_ON.intersection(step.modal_codes):
            nose = number
        elif nose and (_NOSE_OFF in step.modal_codes or "T" in step.words):
            reason = "Line {line} uses the nose compensation that begins on line {begin}."
            yield LineRange(nose + 1, number, reason, nose)
            nose = 0


def _plane(step: Statement, number: int, begun: int) -> tuple[int, int]:
    """Return the line on which the active coordinate transformation starts, or 0 if none is active.

    Also return the start line of the transformation that ends on this line, or 0 if none ends.
    """
    name = step.plane_switching_line.name if step.plane_switching_line is not None else ""
    if name == "END":
        return 0, begun
    return (number if name and not begun else begun), 0


def _corner(begun: int, ends: int) -> LineRange:
    return LineRange(begun + 1, ends, "Line {line} is part of the corner that begins on line {begin}.", begun)
