"""Any text, likely or not, is gone through to its end without an exception."""

from __future__ import annotations

from math import isfinite

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block
from core.language.omniturn import lex_line
from tests.interpreter.programs import lines, passed, setup

pytestmark = pytest.mark.long

NUMBERS = st.sampled_from(["0", "1", "-1", ".5", "-.25", ".001", "2", "3.12345", "99", "300", "1000"])
WORD = st.builds(str.__add__, st.sampled_from(list("XZIKRFSTDPC")), NUMBERS)
G_CODES = [0, 1, 2, 3, 4, 10, 33, 40, 41, 42, 70, 71, 72, 73, 75, 76, 77, 90, 91, 92, 94, 95, 96, 97]
M_CODES = [0, 1, 2, 3, 4, 5, 8, 12, 13, 19, 25, 26, 30, 31, 91, 95, 99]
OTHERS = [
    "M98P1",
    "M97I1C1P2",
    "LS2",
    "LS3",
    "LF",
    "}1",
    "}2",
    "P1",
    "RF",
    "/",
    "(A)",
    "(~PLXC)",
    "(END)",
    "CA90",
]
CODE = st.sampled_from([*(f"G{n:02d}" for n in G_CODES), *(f"M{n:02d}" for n in M_CODES), *OTHERS])
LINE = st.lists(WORD | CODE, max_size=4).map("".join)
TEXT = st.lists(LINE, max_size=25).map(lambda each: lines("G90G94F300", "M03S500", *each, "M30"))


def check(block: Block) -> None:
    figures = [block.x0, block.z0, block.x, block.z, block.offset_x, block.offset_z]
    figures += [block.feed, block.rpm, block.cx, block.cz]
    assert all(isfinite(figure) for figure in figures)
    assert not block.moves or block.feed > 0


@settings(max_examples=400, deadline=None)
@given(TEXT, st.booleans(), st.booleans())
def test_likely_programs_run_or_give_valid_findings(text: str, on: bool, strict: bool) -> None:
    result = passed(text, setup(inputs=lambda _terminal: on), strict=strict)
    assert [block.n for block in result.blocks] == list(range(1, len(result.blocks) + 1))
    for block in result.blocks:
        check(block)
    for before, after in zip(result.blocks, result.blocks[1:], strict=False):
        assert abs(after.x0 + after.offset_x - before.mx) < 1e-6
        assert abs(after.z0 + after.offset_z - before.mz) < 1e-6
    for found in result.interpreter.diagnostics:
        assert 0 <= found.line <= text.count("\n") + 1
        assert found.message


@settings(max_examples=200, deadline=None)
@given(st.text(max_size=200))
def test_any_text_gives_blocks_or_errors(text: str) -> None:
    result = passed(text)
    assert result.interpreter.has_errors or result.blocks


@settings(max_examples=100, deadline=None)
@given(st.text(alphabet="XZGM0123456789.-\n}LSFP()", max_size=200))
def test_any_text_of_language_characters_gives_valid_blocks(text: str) -> None:
    for block in passed(text).blocks:
        check(block)


CUT = st.sampled_from(["", "F20", "F.06", "F300", "F400", "F.00125", "F0"])
COORDINATE = st.sampled_from(["0", "1", "-.5", ".12345", ".00001", "2.12344", "9."])
MOVE = st.builds(
    "{}X{}Z{}{}".format, st.sampled_from(["", "G00", "G01"]), COORDINATE, COORDINATE, CUT
) | st.builds("{}Z{}{}".format, st.sampled_from(["", "G00", "G01"]), COORDINATE, CUT)
MODES = ["G90", "G91", "G71", "G72", "G73", "G94F20", "G95F.003", "G95", "G00(A)", "G96S300", "G97S800"]
MODE = st.sampled_from([*MODES, "M03", "M05", "T1", "D1", "LS2", "LF"])


def figures(block: Block) -> tuple[object, ...]:
    own = (block.n, block.line, block.kind, block.x, block.z, block.x0, block.z0, block.feed, block.per_rev)
    return (*own, block.rpm, block.css, block.offset_x, block.offset_z, block.modal)


@settings(max_examples=400, deadline=None)
@given(st.lists(MOVE | MODE, max_size=25))
def test_moves_read_as_numbers_match_moves_read_as_words(program: list[str]) -> None:
    """A blank makes a line one that is read word by word; nothing else may come of it."""
    numbers = passed(lines("G90G94F300", "M03S500", *program, "M30"), setup(secondary={1: (0.1, -0.2)}))
    words = passed(
        lines("G90G94F300", "M03S500", *(f"{line} " for line in program), "M30"),
        setup(secondary={1: (0.1, -0.2)}),
    )
    assert [figures(block) for block in numbers.blocks] == [figures(block) for block in words.blocks]
    assert numbers.interpreter.diagnostics == words.interpreter.diagnostics


WRITTEN = st.text(alphabet="XZGMTFO0123456789.- ABCDERUN(),;%\u2212\u201c/", max_size=60)


@settings(max_examples=400, deadline=None)
@given(WRITTEN)
def test_line_of_code_and_prose_reports_each_error_once_in_place(text: str) -> None:
    line = lex_line(1, text)
    places = [(error.column, error.code) for error in line.errors]
    assert len(places) == len(set(places))
    for error in line.errors:
        assert 0 <= error.column <= max(len(text), 1)
        if error.code == "text-outside" and not error.message.startswith("'" + "…"):
            assert text[error.column - 1 : error.column + 2] == error.message[1:4]
