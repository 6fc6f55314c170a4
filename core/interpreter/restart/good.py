"""Lines from which a program cannot go on, told by its text alone, and the nearest ones from which it can."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter
from typing import NamedTuple

from core.interpreter.program import Program
from core.interpreter.statement import PLANE, Statement
from core.interpreter.steps import Steps

_NOSE_ON, _NOSE_OFF = frozenset({41, 42}), 40


class Stretch(NamedTuple):
    """Lines ``first`` to ``last``, counted from 1, and why none of them is good."""

    first: int
    last: int
    why: str


class Lines:
    """What the text of a program says about each of its lines."""

    def __init__(self, program: Program) -> None:
        self._steps = program.steps
        self.count = len(program.steps)
        order = attrgetter("first")
        self.stretches = sorted((*_structured(program), *_open(program.steps)), key=order)
        self.repeated = sorted(_repeated(program), key=order)
        self._apart = sorted((*self.stretches, *self.repeated), key=order)

    def why_not(self, line: int) -> str:
        """Why no program can go on from this line; empty when its text has nothing against it."""
        if not 1 <= line <= self.count:
            return f"There is no line {line}; the program has {self.count}."
        for stretch in self.stretches:
            if stretch.first <= line <= stretch.last:
                return f"Line {line} {stretch.why}"
        return "" if self._steps[line - 1] is not None else f"Line {line} is empty."

    def repeats(self, line: int) -> bool:
        """Whether the run may come to it more than once, or never: within a loop or a subroutine."""
        return any(each.first <= line <= each.last for each in self.repeated)

    def before(self, line: int) -> int:
        """The nearest line above it, loops and subroutines apart, that is good by its text; 0: none is."""
        return self._nearest(line, -1)

    def after(self, line: int) -> int:
        """The nearest line below it, loops and subroutines apart, that is good by its text; 0: none is."""
        return self._nearest(line, 1)

    def _nearest(self, line: int, way: int) -> int:
        at = min(line + way, self.count) if way < 0 else line + way
        while 1 <= at <= self.count:
            stretch = next((each for each in self._apart if each.first <= at <= each.last), None)
            if stretch is not None:
                at = stretch.last + 1 if way > 0 else stretch.first - 1
            elif self._steps[at - 1] is None:
                at += way
            else:
                return at
        return 0


def _structured(program: Program) -> Iterator[Stretch]:
    """Contours, and what no call can reach: their first lines are good, what is inside is not."""
    structure = program.structure
    for start, end in structure.contours.items():
        yield Stretch(start + 2, end + 1, f"describes the contour of line {start + 1}.")
    spans = sorted(_subroutines(program))
    at = structure.main_end + 1
    for start, end, _number in (*spans, (len(program.steps) + 1, 0, 0)):
        if at < start:
            yield Stretch(at, start - 1, "stands after the end of the program.")
        at = max(at, end + 1)


def _repeated(program: Program) -> Iterator[Stretch]:
    """Loops behind their LS, and subroutines."""
    for start, end in program.structure.loop_ends.items():
        yield Stretch(start + 2, end + 1, f"is inside the loop of lines {start + 1} to {end + 1}.")
    for start, end, number in _subroutines(program):
        yield Stretch(start, end, f"is in subroutine {number}.")


def _subroutines(program: Program) -> Iterator[tuple[int, int, int]]:
    """First line, last line and number of each."""
    structure = program.structure
    for number, start in structure.subroutines.items():
        yield start + 1, structure.subroutine_ends.get(number, len(program.steps) - 1) + 1, number


def _open(steps: Steps) -> Iterator[Stretch]:
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
                yield Stretch(done + 1, number, f"is in the plane switching that begins on line {done}.")
        if not nose and _NOSE_ON.intersection(step.modal):
            nose = number
        elif nose and (_NOSE_OFF in step.modal or "T" in step.words):
            why = f"is under the nose compensation that begins on line {nose}."
            yield Stretch(nose + 1, number, why)
            nose = 0


def _plane(step: Statement, number: int, begun: int) -> tuple[int, int]:
    """(line on which plane switching begins or 0, line on which one that ends here began or 0)."""
    name = step.plane.name if step.plane is not None else ""
    if name == "END":
        return 0, begun
    return (number if name and not begun else begun), 0


def _corner(begun: int, ends: int) -> Stretch:
    return Stretch(begun + 1, ends, f"is in the corner of line {begun}.")
