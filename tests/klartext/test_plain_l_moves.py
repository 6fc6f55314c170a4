"""Plain moves are read by a shorter way: to the same words, columns and numbers as by the long one."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.language.klartext import klartext_line as long_way
from core.language.klartext import parse_line
from core.language.klartext.klartext_line import parse_plain_move
from core.language.klartext.klartext_nodes import KlartextLine

WORDS = st.sampled_from(
    (
        "X+10",
        "Y-2.5",
        "IZ+3",
        "A45",
        "IC-90.125",
        "X-0",
        "B+0.000000001",
        "R0",
        "FMAX",
        "F200",
        "F1.5",
        "M3",
        "X+1,5",
    )
)


def by_the_long_way(text: str, monkeypatch: pytest.MonkeyPatch) -> KlartextLine:
    monkeypatch.setattr(long_way, "parse_plain_move", lambda _number, _text: None)
    made = parse_line(3, text)
    monkeypatch.undo()
    return made


@pytest.mark.parametrize(
    "text",
    ["L X+10", "12 L X-12 Y-7.071 R0 FMAX", "L IX+1 Y2 Z-0 A+1 B2 C-3 R0 F12.5", "7 L Z+0 F200", "L X-0.0"],
)
def test_plain_move_parser_matches_full_parser(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    short = parse_plain_move(3, text)
    assert short is not None
    assert short == by_the_long_way(text, monkeypatch)


@given(st.lists(WORDS, max_size=6), st.sampled_from(["L", "5 L"]))
def test_plain_move_parser_matches_full_parser_for_any_words(words: list[str], head: str) -> None:
    text = " ".join((head, *words))
    short = parse_plain_move(3, text)
    if short is not None:
        with pytest.MonkeyPatch.context() as patch:
            assert short == by_the_long_way(text, patch)


@pytest.mark.parametrize(
    "text", ["L X+1 X+2", "L X+1 M3", "L", "L X+Q1", "l x+1", "L X+1 ; c", "/L X+1", "L X1O", "L X+1 F0 F1"]
)
def test_other_blocks_are_not_read_as_plain_moves(text: str) -> None:
    assert parse_plain_move(1, text) is None
