"""Size of a program, calculated before execution, so that programs with excessive loops are rejected."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from core.interpreter.omniturn.codes.code_entry import Acts
from core.interpreter.omniturn.flow.loops_and_subroutines import call_target, takes_call
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.interpretation import DEEPEST_CALL, MOST_BLOCKS, MOST_LINES
from core.language.diagnostics import Diagnostic, refusal
from core.message import Message


class Count(NamedTuple):
    """Number of elementary blocks and executed lines, and the line of the largest loop (0 for none)."""

    blocks: int = 0
    lines: int = 0
    worst: int = 0


def refuse_too_large(program: Program, inputs: Callable[[str], bool]) -> Diagnostic | None:
    """Return the error for a program that executes too many blocks or lines, or None.

    Loops multiply the counts, and subroutines count at each call. Conditional calls depend on the present
    inputs.
    """
    if not program.structure.loop_ends and not program.structure.subroutines:
        return _refusal(Count(len(program.ready), len(program.ready)))
    counter = _Counter(program, inputs)
    return _refusal(counter.region(0, program.structure.main_end, 0))


def _refusal(count: Count) -> Diagnostic | None:
    hint = "Reduce the loop counts."
    if count.blocks > MOST_BLOCKS:
        text = Message(
            "The program generates {blocks} blocks; the maximum is {most_blocks}.",
            blocks=_written(count.blocks),
            most_blocks=f"{MOST_BLOCKS:,}",
        )
        return refusal(count.worst or 1, 0, "too-many-blocks", text, hint)
    if count.lines > MOST_LINES:
        text = Message(
            "The program executes {lines} lines; the maximum is {most_lines}.",
            lines=_written(count.lines),
            most_lines=f"{MOST_LINES:,}",
        )
        return refusal(count.worst or 1, 0, "too-many-lines", text, hint)
    return None


def _written(count: int) -> str:
    """Return a count as text, up to 10^24 in full and above that as a power of ten."""
    tens = int(math.log10(count))
    return f"{count:,}" if tens < 24 else Message("about 10^{tens}", tens=tens)


class _Counter:
    def __init__(self, program: Program, inputs: Callable[[str], bool]) -> None:
        self._program = program
        self._inputs = inputs
        self._known: dict[tuple[int, int], Count] = {}

    def region(self, start: int, end: int, depth: int) -> Count:
        """Return the count of the lines from index ``start`` to before ``end``, at call depth ``depth``."""
        # end of the loop, number of passes, count before the loop
        open_loops: list[tuple[int, int, Count]] = []
        total = Count()
        loop_ends, ready = self._program.structure.loop_ends, self._program.ready
        at = start
        while at < end:
            moves = min(ready.moves_until(at), end) - at
            if moves:
                total = Count(total.blocks + moves, total.lines + moves, total.worst)
                at += moves
                continue
            step = ready[at]
            assert not isinstance(step, tuple)
            if step is not None:
                if step.flow == "LS" and at in loop_ends:
                    open_loops.append((loop_ends[at], int(step.value("LS") or 1), total))
                    total = Count()
                elif open_loops and at == open_loops[-1][0]:
                    total = self._close(*open_loops.pop(), total)
                else:
                    total = _sum(total, self._line(step, depth))
            at += 1
        return total

    def _close(self, end: int, times: int, before: Count, body: Count) -> Count:
        blocks, lines = body.blocks * times, (body.lines + 1) * times
        worst = body.worst
        if not worst and (blocks > MOST_BLOCKS or lines > MOST_LINES):
            worst = self._program.structure.loop_starts[end] + 1
        return _sum(before, Count(blocks, lines, worst))

    def _line(self, statement: Statement, depth: int) -> Count:
        if not statement.calls:
            return Count(blocks_of(statement), 1)
        asks = statement.asks
        if depth >= DEEPEST_CALL or (asks and not takes_call(statement, self._inputs)):
            return Count(int(asks), 1)
        return _sum(Count(int(asks), 1), self._subroutine(call_target(statement), depth + 1))

    def _subroutine(self, number: int, depth: int) -> Count:
        structure = self._program.structure
        if number not in structure.subroutines:
            return Count()
        key = number, depth
        if key not in self._known:
            start = structure.subroutines[number] + 1
            end = structure.subroutine_ends.get(number, start)
            self._known[key] = self.region(start, end, depth)
        return self._known[key]


def _sum(a: Count, b: Count) -> Count:
    blocks, lines = a.blocks + b.blocks, a.lines + b.lines
    worst = a.worst or b.worst
    return Count(blocks, lines, worst)


def blocks_of(statement: Statement) -> int:
    """Return the maximum number of elementary blocks of a line; for a cycle, the minimum."""
    if statement.flow:
        return (
            1
            if statement.plane is not None and {"X", "Y", "Z", "G"}.intersection(statement.plane.words)
            else 0
        )
    m_code = statement.m_code
    starts = m_code is not None and m_code.acts is Acts.SPINDLE
    speed = "S" in statement.words and not starts and not statement.s_is_limit
    moves = statement.moves if statement.one_shot is None else statement.entry.least_blocks
    return ("T" in statement.words) + (statement.m is not None) + speed + corner_words(statement) + moves


def corner_words(statement: Statement) -> int:
    """Return the number of blocks that C and R add before the next move; C may also be an axis word."""
    return int(statement.one_shot is None and not {"C", "R"}.isdisjoint(statement.words))
