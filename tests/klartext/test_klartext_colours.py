"""The coloured parts of a line."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.language.klartext.klartext_colours import spans
from core.language.syntax_colours import Ink

CODE, KEY, POSITION, RUN, CALL = Ink.CODE, Ink.KEY, Ink.POSITION, Ink.RUN, Ink.CALL


def parts(text: str) -> list[tuple[str, Ink]]:
    return [(text[start : start + length], ink) for start, length, ink in spans(text)]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (
            "6 PLANE AXIAL A+45 IC-90 TURN MB MAX FMAX SYM- ; go",
            [
                ("6", Ink.NUMBER),
                ("PLANE AXIAL", CODE),
                ("A+45", POSITION),
                ("IC-90", POSITION),
                ("TURN", KEY),
                ("MB MAX", KEY),
                ("FMAX", RUN),
                ("SYM-", KEY),
                ("; go", Ink.COMMENT),
            ],
        ),
        ("L X+Q1 R0 F200 M3", [("L", CODE), ("X+Q1", POSITION), ("R0", CODE), ("F200", RUN), ("M3", CODE)]),
        ('/ CALL LBL "A;B" REP 2', [("/", Ink.NUMBER), ('CALL LBL "A;B"', CALL), ("REP 2", CALL)]),
        ("TOOL CALL 1 Z S300", [("TOOL CALL 1", CALL), ("S300", RUN)]),
        ("* - SIDE", [("* - SIDE", Ink.COMMENT)]),
        ("", []),
    ],
)
def test_parts(text: str, wanted: list[tuple[str, Ink]]) -> None:
    assert parts(text) == wanted


def test_what_cannot_be_read_is_marked_last() -> None:
    assert parts("PLANE AXIAL A+45 A+30 STAY")[-1] == ("A+30", Ink.FAULT)
    assert parts("FL X+0")[-1] == ("FL", Ink.FAULT)


@given(st.text(max_size=40))
def test_any_text_keeps_inside_its_line(text: str) -> None:
    for start, length, _ in spans(text):
        assert start >= 0
        assert length >= 1
        assert start + length <= max(len(text), 1)
