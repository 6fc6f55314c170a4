"""Executions of one program line (visits) in the repetitions of loops and in subroutine calls."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass

from core.interpreter.omniturn.flow.loops_and_subroutines import get_subroutine_number
from core.interpreter.omniturn.omniturn_interpreter import StoppablePass
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.restart.restart_point import ActiveCall, LineVisit, LoopPass
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.checkpoint import FlowPosition
from core.interpreter.shared.job_setup import InterpreterSetup
from core.message import Message

MAX_VISIT_COUNT = 20_000
"""Maximum number of visits of a line that restart distinguishes.

A line with more visits cannot be chosen by visit number.
"""

_PROGRESS_INTERVAL = 2000


@dataclass(frozen=True, slots=True)
class LineVisits:
    """The visits (executions) of one program line, in order.

    For each visit, the lists contain the number of earlier elementary blocks and the flow position.
    """

    program: Program
    earlier_block_counts: list[int]
    flow_positions: list[FlowPosition]

    def find_visit_number(self, block: int) -> int:
        """Return the number (from 1) of the visit in which this block was executed.

        Returns 1 for a block before the first visit.
        """
        return max(1, bisect_left(self.earlier_block_counts, block))

    def explain_missing_visit(self, line: int, number: int) -> str:
        """Return the reason why a visit with this number does not exist, or an empty string if it exists."""
        if not self.earlier_block_counts:
            return Message("The program never reaches line {line}.", line=line)
        if len(self.earlier_block_counts) > MAX_VISIT_COUNT:
            return Message(
                "Line {line} is executed more than {maximum} times; choose the line that begins the loop.",
                line=line,
                maximum=f"{MAX_VISIT_COUNT:,}",
            )
        if 1 <= number <= len(self.earlier_block_counts):
            return ""
        return Message(
            "Line {line} is executed only {blocks_count} times, so repetition {number} does not exist.",
            line=line,
            blocks_count=len(self.earlier_block_counts),
            number=number,
        )

    def find_main_program_visit(self, number: int) -> tuple[int, int]:
        """Return the main program line in which a visit occurs, and the visit number of that line.

        The main program line is outside of all loops.
        """
        anchor, nth = _anchor(self.flow_positions[number - 1]), number
        while nth > 1 and _anchor(self.flow_positions[nth - 2]) == anchor:
            nth -= 1
        return anchor, number - nth + 1

    def make_line_visit(self, number: int) -> LineVisit:
        """Return a visit for display, with its loop passes and calls.

        The passes and calls are in order from the outermost to the innermost.
        """
        return LineVisit(
            number,
            len(self.earlier_block_counts),
            tuple(_within(self.program, self.flow_positions[number - 1])),
        )


def find_line_visits(
    program: Program, setup: InterpreterSetup, line: int, report_progress: Callable[[float], None]
) -> LineVisits:
    """Return all visits of a line in a complete run with the input states of ``setup``."""
    found = LineVisits(program, [], [])
    walk, count, ended = StoppablePass(program, setup), 0, False
    blocks = walk.run_to_line(line)
    while True:
        for block in blocks:
            count += 1
            if count % _PROGRESS_INTERVAL == 0:
                report_progress(count)
            ended = ended or isinstance(block.action, ProgramEnd)
        if ended or not walk.is_at_line or len(found.earlier_block_counts) > MAX_VISIT_COUNT:
            return found
        point = walk.checkpoint
        found.earlier_block_counts.append(point.blocks)
        found.flow_positions.append(point.flow)
        blocks = walk.run_to_next_visit(line)


def _anchor(place: FlowPosition) -> int:
    main = place[0]
    if main.remaining_repeats:
        return main.remaining_repeats[0][0] + 1
    return main.return_index if len(place) > 1 else main.return_index + 1


def _within(program: Program, place: FlowPosition) -> list[LoopPass | ActiveCall]:
    found: list[LoopPass | ActiveCall] = []
    ends = program.structure.loop_ends
    for number, run in enumerate(place):
        for start, left in run.remaining_repeats:
            made = program.get_statement(start + 1)
            count = int((made.get_value("LS") if made is not None else None) or 1)
            found.append(LoopPass(start + 1, ends[start] + 1, count - left, count))
        if number < len(place) - 1:
            made = program.get_statement(run.return_index)
            found.append(
                ActiveCall(
                    run.return_index, get_subroutine_number(made) if isinstance(made, Statement) else 0
                )
            )
    return found
