"""The coloured parts of a line."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.language.klartext.klartext_colors import BLOCK_GOES_ON, COMMENT_GOES_ON, color_line
from core.language.syntax_colors import PLAIN_STATE, SyntaxKind

CODE, KEY, POSITION, RUN, CALL = (
    SyntaxKind.CODE,
    SyntaxKind.KEYWORD,
    SyntaxKind.POSITION,
    SyntaxKind.FEED_AND_SPEED,
    SyntaxKind.CALL,
)


def parts(text: str) -> list[tuple[str, SyntaxKind]]:
    return [(text[start : start + length], ink) for start, length, ink in color_line(text)[0]]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (
            "6 PLANE AXIAL A+45 IC-90 TURN MB MAX FMAX SYM- ; go",
            [
                ("6", SyntaxKind.NUMBER),
                ("PLANE AXIAL", CODE),
                ("A+45", POSITION),
                ("IC-90", POSITION),
                ("TURN", KEY),
                ("MB MAX", KEY),
                ("FMAX", RUN),
                ("SYM-", KEY),
                ("; go", SyntaxKind.COMMENT),
            ],
        ),
        ("L X+Q1 R0 F200 M3", [("L", CODE), ("X+Q1", POSITION), ("R0", CODE), ("F200", RUN), ("M3", CODE)]),
        ('/ CALL LBL "A;B" REP 2', [("/", SyntaxKind.NUMBER), ('CALL LBL "A;B"', CALL), ("REP 2", CALL)]),
        ("TOOL CALL 1 Z S300", [("TOOL CALL 1", CALL), ("S300", RUN)]),
        ("* - SIDE", [("* - SIDE", SyntaxKind.COMMENT)]),
        ("", []),
    ],
)
def test_line_parts_have_their_syntax_kinds(text: str, wanted: list[tuple[str, SyntaxKind]]) -> None:
    assert parts(text) == wanted


def test_unreadable_text_is_marked_as_error_at_end() -> None:
    assert parts("PLANE AXIAL A+45 A+30 STAY")[-1] == ("A+30", SyntaxKind.ERROR)
    assert parts("FL X+0")[-1] == ("FL", SyntaxKind.ERROR)


@given(st.text(max_size=40))
def test_colored_parts_stay_within_line_for_any_text(text: str) -> None:
    for start, length, _ in color_line(text)[0]:
        assert start >= 0
        assert length >= 1
        assert start + length <= max(len(text), 1)


def test_block_of_several_lines_is_colored_as_one_block() -> None:
    """Neither half of a PLANE is a fault, nor a number that begins a line of it the number of a block."""
    first, state = color_line("6 PLANE SPATIAL SPA+45 ~")
    assert SyntaxKind.ERROR not in {ink for _, _, ink in first}
    assert state == BLOCK_GOES_ON
    second, state = color_line("  SPB+0 SPC+90 ; turned ~", state)
    assert [ink for _, _, ink in second] == [POSITION, POSITION, SyntaxKind.COMMENT]
    assert state == BLOCK_GOES_ON
    last, state = color_line("  TURN FMAX", state)
    assert [ink for _, _, ink in last] == [KEY, RUN]
    assert state == PLAIN_STATE
    assert SyntaxKind.ERROR in {ink for _, _, ink in color_line("  SPB+0 SPC+90", PLAIN_STATE)[0]}


def test_continued_comment_is_colored_as_comment() -> None:
    _, state = color_line("4 ; A long comment ~")
    assert state == COMMENT_GOES_ON
    assert color_line(" L X+5 is text here ~", state) == ([(0, 21, SyntaxKind.COMMENT)], COMMENT_GOES_ON)
    assert color_line(" the end", state) == ([(0, 8, SyntaxKind.COMMENT)], PLAIN_STATE)
    assert color_line("5 CYCL DEF 200 DRILLING ; a hole ~")[1] == BLOCK_GOES_ON
