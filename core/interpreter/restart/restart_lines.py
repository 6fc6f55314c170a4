"""Lines from which a program can be restarted: what its text says of each."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter
from typing import NamedTuple

from core.interpreter.omniturn.flow.loops_and_subroutines import call_target
from core.interpreter.omniturn.motion.plain_moves import ReadyLines
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import PLANE, Statement
from core.message import Message

_NOSE_ON, _NOSE_OFF = frozenset({41, 42}), 40


class LineRange(NamedTuple):
    """Lines ``first`` to ``last``, counted from 1.

    If a program cannot be restarted from these lines, ``reason`` is the template of the sentence that
    states why. Its values are ``line``, the line of the restart, and ``begin``, the line on which the
    contour, corner or other section begins.
    """

    first: int
    last: int
    reason: str = ""
    begin: int = 0

    def why(self, line: int) -> Message:
        """Return why a program cannot be restarted from this line, which must be within the range."""
        return Message(self.reason, line=line, begin=self.begin)


class RestartLines:
    """What the text of a program says about each of its lines."""

    def __init__(self, program: Program) -> None:
        self._steps = program.ready
        self.count = len(program.ready)
        order = attrgetter("first")
        self.ranges = sorted((*_structured(program), *_open(program.ready)), key=order)
        self.repeated = sorted(_repeated(program), key=order)
        self._apart = sorted((*self.ranges, *self.repeated), key=order)
        self._calls = _calls(program)

    def why_not(self, line: int) -> str:
        """Why no program can go on from this line; empty when its text has nothing against it."""
        if not 1 <= line <= self.count:
            return Message(
                "Line {line} does not exist; the last line of the program is {lines_count}.",
                line=line,
                lines_count=self.count,
            )
        for lines in self.ranges:
            if lines.first <= line <= lines.last:
                return lines.why(line)
        return "" if self._steps[line - 1] is not None else Message("Line {line} is empty.", line=line)

    def repeats(self, line: int) -> bool:
        """Whether the run may come to it more than once, or never: within a loop or a subroutine."""
        return any(each.first <= line <= each.last for each in self.repeated)

    def nearest(self, line: int, way: int) -> int:
        """The nearest line below it (``way`` 1) or above it (-1) that is good by its text; 0: none is.

        Loops and subroutines are passed by; from inside a subroutine the way up leads to its first call.
        """
        if way < 0:
            line = self._called_from(line)
        at = min(line + way, self.count) if way < 0 else line + way
        while 1 <= at <= self.count:
            lines = next((each for each in self._apart if each.first <= at <= each.last), None)
            if lines is not None:
                at = lines.last + 1 if way > 0 else lines.first - 1
            elif self._steps[at - 1] is None:
                at += way
            else:
                return at
        return 0

    def _called_from(self, line: int) -> int:
        """The line behind the call that leads to this one; the line itself where it is in no subroutine."""
        at = line
        for _ in self._calls:  # a call may stand in a subroutine itself
            at = next((call for first, last, call in self._calls if first <= at <= last), at)
        return line if at == line else at + 1


def _calls(program: Program) -> list[tuple[int, int, int]]:
    """First line, last line and first call from outside of each subroutine that is called."""
    calls = [
        (number, call_target(step))
        for number, step in enumerate(program.ready, start=1)
        if isinstance(step, Statement) and step.calls
    ]
    found = []
    for first, last, number in _subroutines(program):
        outside = (at for at, called in calls if called == number and not first <= at <= last)
        if call := next(outside, 0):
            found.append((first, last, call))
    return found


def _structured(program: Program) -> Iterator[LineRange]:
    """Contours, and what no call can reach: their first lines are good, what is inside is not."""
    structure = program.structure
    for start, end in structure.contours.items():
        reason = "Line {line} is part of the contour that begins on line {begin}."
        yield LineRange(start + 2, end + 1, reason, start + 1)
    spans = sorted(_subroutines(program))
    at = structure.main_end + 1
    for start, end, _number in (*spans, (len(program.ready) + 1, 0, 0)):
        if at < start:
            yield LineRange(at, start - 1, "Line {line} is after the end of the program.")
        at = max(at, end + 1)


def _repeated(program: Program) -> Iterator[LineRange]:
    """Loops behind their LS, and subroutines."""
    for start, end in program.structure.loop_ends.items():
        yield LineRange(start + 2, end + 1)
    for start, end, _number in _subroutines(program):
        yield LineRange(start, end)


def _subroutines(program: Program) -> Iterator[tuple[int, int, int]]:
    """First line, last line and number of each."""
    structure = program.structure
    for number, start in structure.subroutines.items():
        yield start + 1, structure.subroutine_ends.get(number, len(program.ready) - 1) + 1, number


def _open(steps: ReadyLines) -> Iterator[LineRange]:
    """Plane switching, nose compensation and corners: from the line after the one that begins them."""
    plane = nose = corner = 0
    for number, step in enumerate(steps, start=1):
        if not isinstance(step, Statement):
            if corner and step is not None:
                yield _corner(corner, number)
                corner = 0
            continue
        if corner and step.moves:
            yield _corner(corner, number)
            corner = 0
        if step.moves and step.one_shot is None and ("R" in step.words or "C" in step.words):
            corner = number
        if step.flow == PLANE:
            plane, done = _plane(step, number, plane)
            if done:
                reason = "Line {line} is in the section of (~PLXC) or (~PLZC) that begins on line {begin}."
                yield LineRange(done + 1, number, reason, done)
        if not nose and _NOSE_ON.intersection(step.modal):
            nose = number
        elif nose and (_NOSE_OFF in step.modal or "T" in step.words):
            reason = "Line {line} uses the nose compensation that begins on line {begin}."
            yield LineRange(nose + 1, number, reason, nose)
            nose = 0


def _plane(step: Statement, number: int, begun: int) -> tuple[int, int]:
    """(line on which plane switching begins or 0, line on which one that ends here began or 0)."""
    name = step.plane.name if step.plane is not None else ""
    if name == "END":
        return 0, begun
    return (number if name and not begun else begun), 0


def _corner(begun: int, ends: int) -> LineRange:
    return LineRange(begun + 1, ends, "Line {line} is part of the corner that begins on line {begin}.", begun)
