"""Any text at all: nothing raises, and what is read is written back the same."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.language.klartext import parse_line
from core.language.klartext.canonical_text import format_block
from tests.klartext.chamfers import AXIAL, POINTS
from tests.klartext.running import run, run_file

WORDS = (
    *("PLANE", "AXIAL", "POINTS", "SPATIAL", "RELATIV", "RESET", "MOVE", "TURN", "STAY", "MB", "MAX", "DIST"),
    *(
        "A+45",
        "IC-90",
        "P1X+0",
        "P2Z+1",
        "SPA+30",
        "SPC-Q5",
        "SYM+",
        "SEQ-",
        "COORD ROT",
        "TABLE ROT",
        "FMAX",
    ),
    *(
        "F",
        "F AUTO",
        "F200",
        "L",
        "X+10",
        "IY-2,5",
        "Z+Q1",
        "R0",
        "M3",
        "M91",
        "M128",
        "M140 MB 5",
        "TOOL CALL",
    ),
    *(
        "1",
        "Z",
        "S100",
        "DL+1",
        "TRANS DATUM AXIS",
        "CYCL DEF 7.1",
        "LBL",
        "CALL LBL",
        "REP",
        "Q5",
        "=",
        "/",
        "~",
    ),
    *("+", "-", "*", ";", '"A"', "M", "Q", "STOP", "BLK FORM 0.1", "END PGM", "MM", "FN 0:", "IX", "9" * 400),
)


@given(st.text(max_size=60))
def test_any_line_parses_or_gives_error_with_column(text: str) -> None:
    line = parse_line(7, text)
    assert line.error is None or line.error.line == 7
    if line.error is not None:
        assert line.node is None
        assert 1 <= line.error.column <= len(text) + 1


@given(st.lists(st.sampled_from(WORDS), max_size=10), st.sampled_from(["", " "]))
def test_any_words_round_trip(words: list[str], gap: str) -> None:
    line = parse_line(1, (gap or " ").join(words))
    if line.node is not None:
        text = format_block(line)
        again = parse_line(1, text)
        assert again.error is None, text
        assert format_block(again) == text


@given(st.lists(st.lists(st.sampled_from(WORDS), max_size=8), max_size=6))
def test_any_program_ends(lines: list[list[str]]) -> None:
    ran = run("\n".join(" ".join(words) for words in lines))
    for block in ran.blocks:
        assert block.travel is not None
        assert all(abs(at) < 1e9 for at in block.travel.end)


@pytest.mark.parametrize("text", [AXIAL, POINTS])
def test_one_changed_character_raises_no_exception(text: str) -> None:
    dice = random.Random(3)
    for _ in range(150):
        at = dice.randrange(len(text))
        sign = dice.choice("0123456789+-.,QIXYZABCPMBF \n;/~")
        ran = run_file(text[:at] + sign + text[at + 1 :])
        assert all(error.line >= 1 for error in ran.errors)


def test_a_section_repeated_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("core.interpreter.shared.interpretation.MAX_LINE_COUNT", 1000)
    ran = run("LBL 1\nQ1 = +1\nCALL LBL 1 REP 65534\nCALL LBL 1 REP 65534")
    assert ran.codes == ["too-many-blocks"]
    assert "repeat counts" in ran.errors[0].hint
