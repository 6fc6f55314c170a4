"""Any text, likely or not, is gone through to its end without an exception."""

from __future__ import annotations

from math import isfinite

from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.blocks import Block
from tests.interpreter.programs import lines, passed, setup

NUMBERS = st.sampled_from(["0", "1", "-1", ".5", "-.25", ".001", "2", "3.12345", "99", "300", "1000"])
WORD = st.builds(str.__add__, st.sampled_from(list("XZIKRFSTDPC")), NUMBERS)
CODE = st.sampled_from(
    (
        "G90 G91 G94 G95 G00 G01 G02 G03 G04 G10 G92 G70 G71 G72 G73 G96 G97 G76 G77 G41 G33 G75 M00 M01 M02 M03"
        " M04 M05 M08 M12 M13 M25 M26 M30 M31 M91 M95 M98P1 M97I1C1P2 M99 LS2 LS3 LF }1 }2 P1 RF / (A) (~PLXC)"
        " (END) M19 CA90"
    ).split()
)
LINE = st.lists(WORD | CODE, max_size=4).map("".join)
TEXT = st.lists(LINE, max_size=25).map(lambda each: lines("G90G94F300", "M03S500", *each, "M30"))


def check(block: Block) -> None:
    figures = [block.x0, block.z0, block.x, block.z, block.offset_x, block.offset_z]
    figures += [block.feed, block.rpm, block.cx, block.cz]
    assert all(isfinite(figure) for figure in figures)
    assert not block.moves or block.feed > 0


@settings(max_examples=400, deadline=None)
@given(TEXT, st.booleans(), st.booleans())
def test_likely_programs(text: str, on: bool, strict: bool) -> None:
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
def test_any_text(text: str) -> None:
    result = passed(text)
    assert result.interpreter.failed or result.blocks


@settings(max_examples=100, deadline=None)
@given(st.text(alphabet="XZGM0123456789.-\n}LSFP()", max_size=200))
def test_text_of_the_languages_letters(text: str) -> None:
    for block in passed(text).blocks:
        check(block)
