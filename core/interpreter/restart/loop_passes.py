"""Visits of a line during a run: the loop passes and subroutine calls in which it is executed."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass

from core.interpreter.omniturn.flow.loops_and_subroutines import call_target
from core.interpreter.omniturn.omniturn_interpreter import PassToLine
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.restart.restart_point import Called, LineVisit, LoopPass
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.checkpoint import FlowPlace
from core.interpreter.shared.job_setup import Setup
from core.message import Message

MOST = 20_000
"""Visits that are told apart; more are made by nobody who wants to go on in one of them."""

_WATCHED = 2000


@dataclass(frozen=True, slots=True)
class Visits:
    """Visits of a line in order: the number of earlier elementary blocks, and the flow position, of each."""

    program: Program
    blocks: list[int]
    places: list[FlowPlace]

    def at(self, block: int) -> int:
        """Return the number of the visit in which this block was executed, from 1; 1 if it was earlier."""
        return max(1, bisect_left(self.blocks, block))

    def why_not(self, line: int, number: int) -> str:
        """Return why a visit does not exist; empty if it exists."""
        if not self.blocks:
            return Message("The program never reaches line {line}.", line=line)
        if len(self.blocks) > MOST:
            return Message(
                "Line {line} is executed more than {maximum} times; choose the line that begins the loop.",
                line=line,
                maximum=f"{MOST:,}",
            )
        if 1 <= number <= len(self.blocks):
            return ""
        return Message(
            "Line {line} is executed only {blocks_count} times, so repetition {number} does not exist.",
            line=line,
            blocks_count=len(self.blocks),
            number=number,
        )

    def anchor(self, number: int) -> tuple[int, int]:
        """Return the main program line that contains the visit, and the number of the visit there.

        The line is outside of all loops.
        """
        anchor, nth = _anchor(self.places[number - 1]), number
        while nth > 1 and _anchor(self.places[nth - 2]) == anchor:
            nth -= 1
        return anchor, number - nth + 1

    def line_visit(self, number: int) -> LineVisit:
        """Return the visit with its loop passes and calls for the operator, the outermost first."""
        return LineVisit(number, len(self.blocks), tuple(_within(self.program, self.places[number - 1])))


def visits_of(program: Program, setup: Setup, line: int, watch: Callable[[float], None]) -> Visits:
    """Return the visits of a line in a whole run, with the inputs of ``setup``."""
    found = Visits(program, [], [])
    walk, count, ended = PassToLine(program, setup), 0, False
    blocks = walk.before(line)
    while True:
        for block in blocks:
            count += 1
            if count % _WATCHED == 0:
                watch(count)
            ended = ended or isinstance(block.action, ProgramEnd)
        if ended or not walk.at_line or len(found.blocks) > MOST:
            return found
        point = walk.checkpoint
        found.blocks.append(point.blocks)
        found.places.append(point.flow)
        blocks = walk.once_more(line)


def _anchor(place: FlowPlace) -> int:
    main = place[0]
    if main.loops:
        return main.loops[0][0] + 1
    return main.back if len(place) > 1 else main.back + 1


def _within(program: Program, place: FlowPlace) -> list[LoopPass | Called]:
    found: list[LoopPass | Called] = []
    ends = program.structure.loop_ends
    for number, run in enumerate(place):
        for start, left in run.loops:
            made = program.statement(start + 1)
            count = int((made.value("LS") if made is not None else None) or 1)
            found.append(LoopPass(start + 1, ends[start] + 1, count - left, count))
        if number < len(place) - 1:
            made = program.statement(run.back)
            found.append(Called(run.back, call_target(made) if isinstance(made, Statement) else 0))
    return found
