"""Long programs: the fast search finds what the plain one does, and findings follow their lines."""

from __future__ import annotations

import random

import pytest

from app.editor import text_search
from app.editor.changed_lines import adjust_findings
from app.editor.live_proof import ProofFindings, map_findings_by_line
from app.editor.text_search import TextSearch
from core.language.diagnostics import Diagnostic, Severity
from core.language.line_errors import find_line_errors
from core.language.source import Dialect


def test_search_of_long_texts_equals_search_of_short_texts(monkeypatch: pytest.MonkeyPatch) -> None:
    chance = random.Random(3)
    for _ in range(300):
        text = "".join(chance.choice("Xx1.0 F\né") for _ in range(60))
        search = TextSearch("".join(chance.choice("Xx1.0F ") for _ in range(2)), chance.random() < 0.5)
        monkeypatch.setattr(text_search, "_LONG_TEXT", 10**9)
        plain = search.find_and_count_matches(text)
        monkeypatch.setattr(text_search, "_LONG_TEXT", 0)
        assert search.find_and_count_matches(text) == plain


def test_word_at_the_end_of_a_long_text_is_found_and_a_longer_one_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(text_search, "_LONG_TEXT", 0)
    assert TextSearch("M30").find_matches("G0\nm30") == (3,)
    assert TextSearch("M3").find_matches("G0\nm30") == ()
    assert TextSearch("M300").find_matches("M30") == ()


def test_findings_move_with_their_lines_and_leave_with_a_changed_line() -> None:
    found = tuple(Diagnostic(line, 1, Severity.ERROR, "x", "x") for line in (2, 5, 9))
    before = ProofFindings(3, found, map_findings_by_line(found))
    error = Diagnostic(6, 1, Severity.ERROR, "new", "new")
    # line 5 becomes lines 5 and 6: its finding goes, and that of line 9 moves to line 10
    after = adjust_findings(before, 5, 1, 2, (error,))
    assert [(each.line, each.code) for each in after.diagnostics] == [(2, "x"), (6, "new"), (10, "x")]
    assert sorted(after.line_findings) == [2, 6, 10]
    assert adjust_findings(before, 7, 1, 1, ()) is before


@pytest.mark.parametrize(
    ("dialect", "bad", "good"),
    [
        (Dialect.OMNITURN, "X1?", "X1Z2"),
        (Dialect.SINUMERIK, "G0 H1", "G0 X1"),
        (Dialect.KLARTEXT, "L X+1 ?", "L X+1 R0 FMAX"),
    ],
)
def test_syntax_error_of_a_single_line_has_its_line_and_column(dialect: Dialect, bad: str, good: str) -> None:
    errors = find_line_errors(dialect, 7, bad)
    assert errors
    assert all(each.line == 7 and each.column >= 1 for each in errors)
    assert find_line_errors(dialect, 7, good) == ()
