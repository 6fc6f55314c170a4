"""Whatever stands on a line, the lexer answers with words or with errors that have a place."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from core.language.omniturn import lex_line

LIKELY = st.text(alphabet="XZGMFSTDIKRCLPON}0123456789.+-()/, eEo", max_size=60)


@settings(max_examples=300, deadline=None)
@given(st.text(max_size=80) | LIKELY)
def test_any_line_gives_words_or_valid_errors(text: str) -> None:
    line = lex_line(4, text)
    for word in line.words:
        assert 1 <= word.column <= len(text)
        assert text[word.column - 1].upper() == word.letter[0]
    for error in line.errors:
        assert error.line == 4
        assert 0 <= error.column <= len(text)
        assert error.message
        assert error.code


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(st.sampled_from("XZIKR"), st.decimals(-9999, 9999, places=4)), max_size=6))
def test_numbers_are_read_as_written(pairs: list[tuple[str, object]]) -> None:
    text = "".join(f"{letter}{number}" for letter, number in pairs)
    line = lex_line(1, text)
    assert line.errors == ()
    assert [(word.letter, word.value) for word in line.words] == [(a, float(str(n))) for a, n in pairs]


@settings(max_examples=200, deadline=None)
@given(LIKELY)
def test_blanks_change_only_columns(text: str) -> None:
    if "(" in text or ")" in text:
        return
    tight, loose = lex_line(1, text.replace(" ", "")), lex_line(1, " ".join(text))
    if any(error.code == "text-outside" for error in (*tight.errors, *loose.errors)):
        return  # letters side by side are text, and apart they are codes without numbers
    assert [word[:2] for word in tight.words] == [word[:2] for word in loose.words]
    assert [error.code for error in tight.errors] == [error.code for error in loose.errors]
