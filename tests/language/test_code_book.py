"""The code book: what stands at the cursor, what typing may become, and the page that is printed from it."""

from __future__ import annotations

import pytest

from core.interpreter.dialects import get_code_book
from core.language.sinumerik.cycle_names import CYCLE_PARAMETERS
from core.language.source import Dialect

OMNITURN, KLARTEXT, SINUMERIK = Dialect.OMNITURN, Dialect.KLARTEXT, Dialect.SINUMERIK


@pytest.mark.parametrize(
    ("dialect", "line", "column", "head"),
    [
        (KLARTEXT, "12 L X+10 Y+5 R0 FMAX M3", 5, "L"),
        (KLARTEXT, "12 L X+10 Y+5 R0 FMAX M3", 17, "R0"),
        (KLARTEXT, "12 L X+10 Y+5 R0 FMAX M3", 25, "M3"),
        (KLARTEXT, "L X+10 M30", 10, "M30"),
        (KLARTEXT, "cycl def 200 drilling ~", 3, "CYCL DEF 200"),
        (KLARTEXT, "CYCL DEF 4.2 DEPTH -5", 12, "CYCL DEF 4"),
        (KLARTEXT, "CYCL CALL POS X+3 Y+3 Z+0", 2, "CYCL CALL POS"),
        (KLARTEXT, "  PLANE SPATIAL SPA+0 SPB+0 SPC+0 TURN", 1, "PLANE SPATIAL"),
        (KLARTEXT, "Q5 = 3", 1, "Q"),
        (SINUMERIK, "N10 G01 X20 Z-5 F.2", 6, "G1"),
        (SINUMERIK, "N10 G1 X20 CR=5", 13, "CR"),
        (SINUMERIK, "IF R1<3 GOTOB AGAIN", 12, "GOTOB"),
        (OMNITURN, "G90G94F300", 5, "G94"),
        (OMNITURN, "G4F2", 2, "G04"),
    ],
)
def test_code_at_cursor_is_found(dialect: Dialect, line: str, column: int, head: str) -> None:
    found = get_code_book(dialect).at(line, column)
    assert found is not None
    assert found.head == head


@pytest.mark.parametrize(
    ("dialect", "line", "column"),
    [
        (KLARTEXT, "L X+10 ; M3 and so on", 12),
        (SINUMERIK, "; G1 is no code here", 5),
        (OMNITURN, "(G01 IN WORDS)", 4),
        (KLARTEXT, "", 1),
        (SINUMERIK, "PART:", 2),
    ],
)
def test_no_code_is_found_at_other_positions(dialect: Dialect, line: str, column: int) -> None:
    assert get_code_book(dialect).at(line, column) is None


@pytest.mark.parametrize(
    ("dialect", "typed", "column", "heads"),
    [
        (KLARTEXT, "12 plane s", 4, ["PLANE SPATIAL"]),
        (
            KLARTEXT,
            "CYCL DEF 20",
            1,
            [f"CYCL DEF {n}" for n in (200, 201, 202, 203, 205, 206, 207, 208, 209, 204, 20)],
        ),
        (KLARTEXT, "7 APPR PL", 3, ["APPR PLT", "APPR PLN", "APPR PLCT"]),
        (OMNITURN, "G90G0", 4, ["G00", "G01", "G02", "G03", "G04"]),
        (OMNITURN, "G90G4", 4, ["G04", "G40", "G41", "G42"]),
        (SINUMERIK, "IF R1==2 GOTO", 10, ["GOTOF", "GOTOB", "GOTO", "GOTOS"]),
    ],
)
def test_typed_text_is_completed_with_matching_codes(
    dialect: Dialect, typed: str, column: int, heads: list[str]
) -> None:
    begin, found = get_code_book(dialect).find_completions(typed, len(typed) + 1)
    assert (begin, [each.head for each in found]) == (column, heads)


@pytest.mark.parametrize("typed", ["", "L X+10 ", "XYZ", "; M1"])
def test_blank_comment_or_unknown_start_has_no_completion(typed: str) -> None:
    assert get_code_book(KLARTEXT).find_completions(typed, len(typed) + 1)[1] == ()


def _words(dialect: Dialect, head: str) -> dict[str, str]:
    book = get_code_book(dialect)
    return dict(book.list_word_meanings(next(each for each in book.entries if each.head == head)))


@pytest.mark.parametrize(
    ("dialect", "head", "word", "means"),
    [
        (OMNITURN, "G33", "C", "infeed angle in degrees: 0 … 30"),
        (OMNITURN, "G83", "R", "the Z position to which the drill retracts"),
        (OMNITURN, "G94", "F", "the feed per minute"),
        (SINUMERIK, "CYCLE83", "VARI", "0 = chip breaking, 1 = retract out of the hole"),
        (SINUMERIK, "CYCLE97", "PIT", "lead"),
        (SINUMERIK, "CYCLE84", "PIT", "pitch; negative for a left-hand thread"),
        (KLARTEXT, "CYCL DEF 200", "Q201", "depth, measured from the surface"),
    ],
)
def test_code_words_have_meanings(dialect: Dialect, head: str, word: str, means: str) -> None:
    assert _words(dialect, head)[word] == means


def test_code_words_are_listed_in_order_of_code() -> None:
    assert list(_words(OMNITURN, "G33")) == ["X", "Z", "I", "K", "A", "C", "P", "O"]
    assert _words(OMNITURN, "G90") == {}


@pytest.mark.parametrize("dialect", list(Dialect))
def test_every_word_meaning_belongs_to_a_code(dialect: Dialect) -> None:
    book = get_code_book(dialect)
    used = {f"{entry.head}.{word}" for entry in book.entries for word, _ in book.list_word_meanings(entry)}
    bare = {each.rpartition(".")[2] for each in used}
    assert {word for word in book.word_meanings if "." not in word} <= bare
    told = {
        word
        for word in book.word_meanings
        if "." in word and word.partition(".")[0].startswith(("CYCLE", "HOLES"))
    }
    assert told <= used


@pytest.mark.parametrize("head", CYCLE_PARAMETERS)
def test_each_sinumerik_cycle_documents_its_parameters(head: str) -> None:
    """Those of the newer controls, which begin with _, apart."""
    assert {name for name in CYCLE_PARAMETERS[head] if not name.startswith("_")} == _words(
        SINUMERIK, head
    ).keys()
