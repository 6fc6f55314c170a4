"""A text is read once for all passes through it, and no pass knows of another."""

from __future__ import annotations

from itertools import zip_longest

import pytest

from core.interpreter.dialects import SharedProgram
from core.interpreter.omniturn import omniturn_program
from core.interpreter.omniturn.motion.plain_moves import parse_lines, parse_plain_move
from core.interpreter.omniturn.omniturn_interpreter import LONG_PROGRAM_LINE_COUNT
from core.interpreter.omniturn.omniturn_statement import make_statement
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.omniturn import lex_line
from core.language.source import ProgramSource

MOVES = [f"X{0.5 + k % 3 * 0.01:.2f}Z{-0.001 * k:.3f}" for k in range(LONG_PROGRAM_LINE_COUNT + 50)]
# Lines that no column holds: an increment (G91), a word with a comment, a corner that looks ahead.
RARE = ["G91", "X.01", "G90", "(turned)", "X1Z-1,C.02", "Z-2"]
TEXT = "\n".join(["G90G94F300G72", "T1", *MOVES[:-20], *RARE, *MOVES[-20:], "M30"])
SETUP = InterpreterSetup(tools={1: ToolOffset(0.0, 0.0)})


def told(reading: SharedProgram) -> list[str]:
    """Every field of every block of one whole pass."""
    return [repr(block) for block in reading.start_pass(SETUP).generate_blocks()]


def test_two_interleaved_passes_match_single_pass() -> None:
    alone = told(SharedProgram(ProgramSource("part", TEXT)))
    reading = SharedProgram(ProgramSource("part", TEXT))
    first, second = reading.start_pass(SETUP).generate_blocks(), reading.start_pass(SETUP).generate_blocks()
    pairs = list(zip_longest(first, second))
    assert len(alone) > LONG_PROGRAM_LINE_COUNT
    assert [repr(a) for a, _ in pairs] == alone
    assert [repr(b) for _, b in pairs] == alone


def test_abandoned_pass_does_not_affect_next_pass() -> None:
    reading = SharedProgram(ProgramSource("part", TEXT))
    given_up = reading.start_pass(SETUP).generate_blocks()
    for _ in range(LONG_PROGRAM_LINE_COUNT):
        next(given_up)
    assert told(reading) == told(SharedProgram(ProgramSource("part", TEXT)))


def test_the_text_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    read = list[str]()
    before = omniturn_program.read_program

    def counted(source: ProgramSource, strict: bool = False) -> omniturn_program.Program:
        read.append(source.name)
        return before(source, strict)

    monkeypatch.setattr(omniturn_program, "read_program", counted)
    reading = SharedProgram(ProgramSource("part", "G90\nM30\n"))
    for _ in range(3):
        list(reading.start_pass(SETUP).generate_blocks())
    assert read == ["part"]


def test_every_pass_reports_errors_of_program_text() -> None:
    reading = SharedProgram(ProgramSource("part", "G90\nG1X\nM30\n"))
    first, second = ([d.code for d in reading.start_pass(SETUP).diagnostics] for _ in range(2))
    assert first
    assert first == second


def test_pass_replaces_its_line_without_changing_shared_lines() -> None:
    steps = parse_lines(
        ["X1Z0", "X1Z-1", "X1Z-2"], lambda _, text: parse_plain_move(text), reads_every_line=False
    )
    own = steps.copy_lines()
    own[1] = make_statement(lex_line(2, "X1Z-1"))
    assert not isinstance(own[1], tuple)
    assert steps[1] == (1.0, -1.0, None, -1, False)
    assert (own.find_next_statement(0), steps.find_next_statement(0)) == (1, 3)
