"""How often a run comes to a line: the passes of loops and the calls of subroutines in which it does."""

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
    """In the order of the run: how many elementary blocks come before each, and where the flow stands."""

    program: Program
    blocks: list[int]
    places: list[FlowPlace]

    def at(self, block: int) -> int:
        """The number of the visit in which this block was run, from 1; the first when it came before."""
        return max(1, bisect_left(self.blocks, block))

    def why_not(self, line: int, number: int) -> str:
        """Why there is no such visit; empty when there is."""
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
        """The line of the main program, outside of all loops, in which the visit comes; its number there."""
        anchor, nth = _anchor(self.places[number - 1]), number
        while nth > 1 and _anchor(self.places[nth - 2]) == anchor:
            nth -= 1
        return anchor, number - nth + 1

    def line_visit(self, number: int) -> LineVisit:
        """The visit in the operator's words: passes and calls, outermost first."""
        return LineVisit(number, len(self.blocks), tuple(_within(self.program, self.places[number - 1])))


def visits_of(program: Program, setup: Setup, line: int, watch: Callable[[float], None]) -> Visits:
    """Goes through the whole run; inputs answer as ``setup`` says."""
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
