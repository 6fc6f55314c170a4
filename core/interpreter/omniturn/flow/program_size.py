"""Calculation of the size of a program, to reject excessive loops before execution."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from core.interpreter.omniturn.codes.code_entry import ActionKind
from core.interpreter.omniturn.flow.loops_and_subroutines import get_subroutine_number, is_call_made
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.interpretation import MAX_BLOCK_COUNT, MAX_CALL_DEPTH, MAX_LINE_COUNT
from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.message import Message


class ProgramSize(NamedTuple):
    """The number of elementary blocks and of executed lines of a program or section.

    ``largest_loop_line`` is the line of the largest loop, or 0 if there are no loops.
    """

    block_count: int = 0
    line_count: int = 0
    largest_loop_line: int = 0


def check_program_size(program: Program, read_input: Callable[[str], bool]) -> Diagnostic | None:
    """Return the error for a program that executes too many blocks or lines, or None otherwise.

    Loops multiply the counts, and each call adds the counts of its subroutine. Conditional calls depend on
    the current inputs.
    """
    if not program.structure.loop_ends and not program.structure.subroutine_starts:
        return _refusal(ProgramSize(len(program.executable_lines), len(program.executable_lines)))
    counter = _Counter(program, read_input)
    return _refusal(counter.measure_region(0, program.structure.main_end_index, 0))


def _refusal(count: ProgramSize) -> Diagnostic | None:
    hint = "Reduce the loop counts."
    if count.block_count > MAX_BLOCK_COUNT:
        text = Message(
            "The program generates {blocks} blocks; the maximum is {most_blocks}.",
            blocks=_format_count(count.block_count),
            most_blocks=f"{MAX_BLOCK_COUNT:,}",
        )
        return make_error_diagnostic(count.largest_loop_line or 1, 0, "too-many-blocks", text, hint)
    if count.line_count > MAX_LINE_COUNT:
        text = Message(
            "The program executes {lines} lines; the maximum is {most_lines}.",
            lines=_format_count(count.line_count),
            most_lines=f"{MAX_LINE_COUNT:,}",
        )
        return make_error_diagnostic(count.largest_loop_line or 1, 0, "too-many-lines", text, hint)
    return None


def _format_count(count: int) -> str:
    """Return a count as text, in full up to 10^24 and as a power of ten above that."""
    tens = int(math.log10(count))
    return f"{count:,}" if tens < 24 else Message("about 10^{tens}", tens=tens)


class _Counter:
    def __init__(self, program: Program, inputs: Callable[[str], bool]) -> None:
        self._program = program
        self._inputs = inputs
        self._known: dict[tuple[int, int], ProgramSize] = {}

    def measure_region(self, start: int, end: int, depth: int) -> ProgramSize:
        """Return the size of the lines from index ``start`` to the index before ``end``.

        ``depth`` is the call depth.
        """
        # end of the loop, number of passes, count before the loop
        open_loops: list[tuple[int, int, ProgramSize]] = []
        total = ProgramSize()
        loop_ends, ready = self._program.structure.loop_ends, self._program.executable_lines
        at = start
        while at < end:
            moves = min(ready.find_next_statement(at), end) - at
            if moves:
                total = ProgramSize(
                    total.block_count + moves, total.line_count + moves, total.largest_loop_line
                )
                at += moves
                continue
            step = ready[at]
            assert not isinstance(step, tuple)
            if step is not None:
                if step.flow_code == "LS" and at in loop_ends:
                    open_loops.append((loop_ends[at], int(step.get_value("LS") or 1), total))
                    total = ProgramSize()
                elif open_loops and at == open_loops[-1][0]:
                    total = self._close(*open_loops.pop(), total)
                else:
                    total = _sum(total, self._line(step, depth))
            at += 1
        return total

    def _close(self, end: int, times: int, before: ProgramSize, body: ProgramSize) -> ProgramSize:
        blocks, lines = body.block_count * times, (body.line_count + 1) * times
        worst = body.largest_loop_line
        if not worst and (blocks > MAX_BLOCK_COUNT or lines > MAX_LINE_COUNT):
            worst = self._program.structure.loop_starts[end] + 1
        return _sum(before, ProgramSize(blocks, lines, worst))

    def _line(self, statement: Statement, depth: int) -> ProgramSize:
        if not statement.calls_subroutine:
            return ProgramSize(estimate_block_count(statement), 1)
        asks = statement.depends_on_input
        if depth >= MAX_CALL_DEPTH or (asks and not is_call_made(statement, self._inputs)):
            return ProgramSize(int(asks), 1)
        return _sum(ProgramSize(int(asks), 1), self._subroutine(get_subroutine_number(statement), depth + 1))

    def _subroutine(self, number: int, depth: int) -> ProgramSize:
        structure = self._program.structure
        if number not in structure.subroutine_starts:
            return ProgramSize()
        key = number, depth
        if key not in self._known:
            start = structure.subroutine_starts[number] + 1
            end = structure.subroutine_ends.get(number, start)
            self._known[key] = self.measure_region(start, end, depth)
        return self._known[key]


def _sum(a: ProgramSize, b: ProgramSize) -> ProgramSize:
    blocks, lines = a.block_count + b.block_count, a.line_count + b.line_count
    worst = a.largest_loop_line or b.largest_loop_line
    return ProgramSize(blocks, lines, worst)


def estimate_block_count(statement: Statement) -> int:
    """Return an estimate of the number of elementary blocks of a line.

    The estimate is the maximum or, for a cycle, the minimum.
    """
    if statement.flow_code:
        return (
            1
            if statement.plane_switching_line is not None
            and {"X", "Y", "Z", "G"}.intersection(statement.plane_switching_line.words)
            else 0
        )
    m_code = statement.m_code_entry
    starts = m_code is not None and m_code.action_kind is ActionKind.SPINDLE
    speed = "S" in statement.words and not starts and not statement.is_s_speed_limit
    moves = (
        statement.has_x_or_z_move if statement.one_shot_code is None else statement.code_entry.min_block_count
    )
    return (
        ("T" in statement.words)
        + (statement.m_number is not None)
        + speed
        + count_corner_blocks(statement)
        + moves
    )


def count_corner_blocks(statement: Statement) -> int:
    """Return the number of blocks that C and R as corner words insert before the next move.

    C is counted even if it is an axis word.
    """
    return int(statement.one_shot_code is None and not {"C", "R"}.isdisjoint(statement.words))
