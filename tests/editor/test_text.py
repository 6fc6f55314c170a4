"""Find, differences and names: what is found, what is shown, what is refused."""

from __future__ import annotations

import pytest

from app.editor.edited_document import InvalidProgramNameError, make_program_name
from app.editor.text_search import TextSearch, find_preceding_position, following
from app.editor.version_history import DifferenceRow as Row
from app.editor.version_history import compare_texts
from core.language.source import Dialect, get_default_extension, guess_dialect
from tests.texts import text as wording

TEXT = "F100\nX1F1000\nf100(F100.)\nF100.5 F100X2\n"


def test_whole_words_are_found_and_longer_words_only_counted() -> None:
    places = TextSearch("F100").find_matches(TEXT)
    assert [TEXT[p : p + 5] for p in places] == ["F100\n", "f100(", "F100.", "F100X"]
    assert TextSearch("F100").words(TEXT) == wording("editor.longer-words", found="4 FOUND", more=2)
    assert TextSearch("F100", matches_whole_words=False).words(TEXT) == "6 FOUND, INCLUDING PARTS OF WORDS"


@pytest.mark.parametrize(("needle", "text"), [(".5", "X1.5"), ("5", "X15"), ("M3", "CM3"), ("M", "MM")])
def test_end_of_a_longer_word_does_not_match_whole_word_search(needle: str, text: str) -> None:
    assert TextSearch(needle).find_matches(text) == ()
    assert TextSearch(needle, matches_whole_words=False).find_matches(text)


def test_search_treats_regex_characters_literally() -> None:
    assert TextSearch("X.5", matches_whole_words=False).find_matches("X15 X.5") == (4,)
    assert TextSearch("(", matches_whole_words=False).find_matches("a(b(") == (1, 3)


def test_empty_search_finds_no_matches() -> None:
    assert TextSearch("").find_matches(TEXT) == ()
    assert TextSearch("Q9").words(TEXT) == "NOT FOUND"
    assert following((), 3) is None
    assert find_preceding_position((), 3) is None


def test_search_wraps_around() -> None:
    assert [following((2, 5), at) for at in (0, 2, 3, 6)] == [2, 2, 5, 2]
    assert [find_preceding_position((2, 5), at) for at in (9, 5, 2)] == [5, 2, 5]


def test_differences_show_lines_with_both_numbers() -> None:
    assert compare_texts("a\nb\nc\n", "a\nB\nc\n") == (
        Row(" ", 1, 1, "a"),
        Row("-", 2, 0, "b"),
        Row("+", 0, 2, "B"),
        Row(" ", 3, 3, "c"),
    )


def test_identical_texts_have_no_differences() -> None:
    assert compare_texts("a\n", "a\n") == ()


def test_omitted_rows_are_marked_with_an_ellipsis() -> None:
    rows = compare_texts("".join(f"{n}\n" for n in range(20)), "".join(f"{n}\n" for n in range(19)))
    assert rows[0].sign == "…"
    assert rows[-1] == Row("-", 20, 0, "19")


def test_large_texts_are_compared_from_both_ends() -> None:
    lines = [f"X{n}" for n in range(30_000)]
    changed = [*lines[:500], "M00", *lines[500:]]
    assert compare_texts("\n".join(lines), "\n".join(changed)) == (
        Row("…", 0, 0, ""),
        Row("+", 0, 501, "M00"),
    )


@pytest.mark.parametrize(
    ("typed", "usual", "name"),
    [
        ("pin", ".nc", "pin.nc"),
        (" pin 2 ", ".nc", "pin 2.nc"),
        ("pin.TXT", ".nc", "pin.TXT"),
        ("roof", ".h", "roof.h"),
        ("ring", ".mpf", "ring.mpf"),
        ("ring.spf", ".mpf", "ring.spf"),
    ],
)
def test_a_name_gets_the_usual_ending(typed: str, usual: str, name: str) -> None:
    assert make_program_name(typed, usual) == name


@pytest.mark.parametrize("dialect", Dialect)
def test_default_extension_maps_back_to_its_dialect(dialect: Dialect) -> None:
    assert guess_dialect(f"part{get_default_extension(dialect)}") is dialect


@pytest.mark.parametrize(
    "typed", ["", "  ", ".pin", "a/b", "..", "a\\b", "pin.exe", "a:b", "NUL.nc", "pin.", "x" * 300]
)
def test_invalid_program_name_is_rejected(typed: str) -> None:
    with pytest.raises(InvalidProgramNameError):
        make_program_name(typed, ".nc")
