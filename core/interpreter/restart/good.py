"""Lines from which a program cannot go on, told by its text alone, and the nearest ones from which it can."""

from __future__ import annotations

from collections.abc import Iterator
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
        self.stretches = sorted((*_structured(program), *_open(program.steps)), key=lambda each: each.first)

    def why_not(self, line: int) -> str:
        """Why no program can go on from this line; empty when its text has nothing against it."""
        if not 1 <= line <= self.count:
            return f"There is no line {line}; the program has {self.count}."
        for stretch in self.stretches:
            if stretch.first <= line <= stretch.last:
                return f"Line {line} {stretch.why}"
        return "" if self._steps[line - 1] is not None else f"Line {line} is empty."

    def before(self, line: int) -> int:
        """The nearest line above it that is good by its text; 0 when there is none."""
        return self._nearest(line, -1)

    def after(self, line: int) -> int:
        """The nearest line below it that is good by its text; 0 when there is none."""
        return self._nearest(line, 1)

    def _nearest(self, line: int, way: int) -> int:
        at = min(line + way, self.count) if way < 0 else line + way
        while 1 <= at <= self.count:
            stretch = next((each for each in self.stretches if each.first <= at <= each.last), None)
            if stretch is not None:
                at = stretch.last + 1 if way > 0 else stretch.first - 1
            elif self._steps[at - 1] is None:
                at += way
            else:
                return at
        return 0


def _structured(program: Program) -> Iterator[Stretch]:
    """Loops, subroutines, contours: their first lines are good, what is inside is not."""
    structure = program.structure
    for start, end in structure.loop_ends.items():
        yield Stretch(start + 2, end + 1, f"is inside the loop of lines {start + 1} to {end + 1}.")
    for start, end in structure.contours.items():
        yield Stretch(start + 2, end + 1, f"describes the contour of line {start + 1}.")
    for number, start in structure.subroutines.items():
        end = structure.subroutine_ends.get(number, len(program.steps) - 1)
        yield Stretch(start + 1, end + 1, f"is in subroutine {number}: the line that calls it may be good.")
    if structure.main_end < len(program.steps):
        yield Stretch(structure.main_end + 1, len(program.steps), "stands after the end of the program.")


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
