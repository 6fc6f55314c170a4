"""Programs that would run for ever are refused before they start; long ones are made block by block."""

from __future__ import annotations

import tracemalloc
from itertools import islice

import pytest

from core.interpreter.omniturn import omniturn_interpreter
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.language.omniturn import LexedLine, lex_line
from core.language.source import ProgramSource
from tests.interpreter.programs import body, lines, passed, setup


@pytest.mark.parametrize(
    ("program", "error", "count"),
    [
        (("LS5000001", "X1", "LF"), (3, 0, "too-many-blocks"), "5,000,003"),
        (("LS3000", "LS2000", "X1", "LF", "LF"), (3, 0, "too-many-blocks"), "6,000,002"),
        (("X1", "LS2", "LS5000000", "X1", "LF", "LF"), (4, 0, "too-many-blocks"), "10,000,003"),
        (("LS1000000000", "G90", "LF"), (3, 0, "too-many-lines"), "2,000,000,"),
        (("LS100000", "LS100000", "LF", "LF"), (3, 0, "too-many-lines"), "10,000,"),
        (("LS2",) * 20000 + ("X1",) + ("LF",) * 20000, (19981, 0, "too-many-blocks"), "about 10^6020 blocks"),
    ],
)
def test_program_with_too_many_blocks_is_rejected(
    program: tuple[str, ...], error: tuple[int, int, str], count: str
) -> None:
    result = passed(body(*program))
    assert result.errors == [error]
    assert count in result.interpreter.diagnostics[0].message
    assert result.blocks == []


def test_blocks_of_subroutine_count_for_each_call() -> None:
    text = lines("G90F300", "LS3000", "M98P1", "LF", "M30", "}1", "LS2000", "X1", "LF", "M99")
    assert passed(text).errors == [(2, 0, "too-many-blocks")]


@pytest.mark.parametrize(("on", "refused"), [(True, True), (False, False)])
def test_conditional_calls_count_according_to_inputs(on: bool, refused: bool) -> None:
    text = lines("G90F300", "LS30", "M95", "LF", "M30", "}1", "LS200000", "X1", "LF", "M99")
    interpreter = Interpreter(read_program(ProgramSource("A", text)), setup(inputs=lambda _terminal: on))
    assert interpreter.has_errors is refused


def test_block_limit_applies_while_program_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    answers = iter([False])  # when counted; afterwards the input is on
    text = lines("G90F300", "M95", "M30", "}1", "LS200", "X1", "LF", "M99")
    given = setup(inputs=lambda _terminal: next(answers, True))
    monkeypatch.setattr(omniturn_interpreter, "MAX_BLOCK_COUNT", 50)
    interpreter = Interpreter(read_program(ProgramSource("A", text)), given)
    blocks = list(interpreter.generate_blocks())
    assert len(blocks) == 50
    assert interpreter.diagnostics[-1].code == "too-many-blocks"


def test_line_limit_applies_to_loop_without_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(omniturn_interpreter, "MAX_LINE_COUNT", 50)
    result = passed(lines("G90F300", "LS100", "F20", "LF", "M30"))
    assert [code for _, _, code in result.errors] == ["too-many-blocks"]


def test_million_loop_passes_start_at_once_without_memory_growth() -> None:
    program = read_program(ProgramSource("A", body("LS1000000", "G91X.001", "X-.001", "LF")))
    blocks = Interpreter(program, setup()).generate_blocks()
    assert [block.line for block in islice(blocks, 3)] == [2, 4, 5]
    tracemalloc.start()
    try:
        for _ in islice(blocks, 1000):
            pass
        first = tracemalloc.get_traced_memory()[0]
        for _ in islice(blocks, 20_000):
            pass
        grown = tracemalloc.get_traced_memory()[0] - first
    finally:
        tracemalloc.stop()
    assert grown < 20_000


def test_lines_are_not_lexed_again_in_a_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    program = read_program(ProgramSource("A", body("LS50", "X1.23455Z1", "G01X2F20", "G00X1", "X3M08", "LF")))
    lexed: list[int] = []

    def counted(number: int, text: str) -> LexedLine:
        lexed.append(number)
        return lex_line(number, text)

    monkeypatch.setattr("core.interpreter.omniturn.motion.straight_moves.lex_line", counted)
    monkeypatch.setattr(omniturn_interpreter, "lex_line", counted)
    assert sum(1 for _ in Interpreter(program, setup()).generate_blocks()) == 252
    assert len(lexed) == len(set(lexed))
