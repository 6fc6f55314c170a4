"""Each construct of the code books against figures worked out by hand: ``golden_constructs.py``."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from core.interpreter.dialects import get_code_book
from core.language.code_book import CodeBookEntry
from core.language.diagnostics import Severity
from core.language.source import Dialect
from tests.dialects.golden_constructs import GROUNDS, Golden, blank, differences, extent, goldens, ran, way

CONSTRUCTS = [
    (dialect, entry, goldens(dialect)[entry.head])
    for dialect in GROUNDS
    for entry in get_code_book(dialect).entries
    if entry.head in goldens(dialect)
]


def cases(chosen: Sequence[tuple[Dialect, CodeBookEntry, Golden]]) -> pytest.MarkDecorator:
    """A test for each of them, by its name."""
    return pytest.mark.parametrize(
        ("dialect", "entry", "golden"),
        chosen,
        ids=[f"{dialect}-{entry.head}" for dialect, entry, _ in chosen],
    )


@cases(CONSTRUCTS)
def test_construct_produces_its_golden_blocks_and_messages(
    dialect: Dialect, entry: CodeBookEntry, golden: Golden
) -> None:
    came = ran(dialect, entry, golden.program, golden.machine)
    assert [each.format_one_line("") for each in came.findings if each.severity is Severity.ERROR] == []
    assert golden.rows or golden.sums
    if golden.rows:
        assert differences(came.rows(golden), golden.rows) == ""
    if "extent" in golden.sums:
        assert extent(came.feeds) == pytest.approx(golden.sums["extent"], abs=1e-6)
    if "way" in golden.sums:
        assert [way(came.feeds)] == pytest.approx(golden.sums["way"], abs=1e-5)
    if "blank" in golden.sums:
        assert blank(came.blocks) == pytest.approx(golden.sums["blank"])
    assert sorted(came.told(Severity.WARNING, Severity.NOTE)) == sorted(golden.told)


@cases([each for each in CONSTRUCTS if each[1].refused])
def test_invalid_construct_is_rejected_at_its_location(
    dialect: Dialect, entry: CodeBookEntry, golden: Golden
) -> None:
    came = ran(dialect, entry, entry.refused, golden.refusing)
    assert came.first_error == golden.refused


@pytest.mark.parametrize("dialect", GROUNDS)
def test_a_golden_belongs_to_an_entry(dialect: Dialect) -> None:
    assert set(goldens(dialect)) - {entry.head for entry in get_code_book(dialect).entries} == set()


@pytest.mark.parametrize("dialect", GROUNDS)
def test_every_code_entry_has_its_golden_and_rejected_example(dialect: Dialect) -> None:
    """What nothing can be written wrongly of has no refusal; what is refused by its name has no example."""
    entries = [each for each in get_code_book(dialect).entries if each.example]
    assert [each.head for each in entries if each.head not in goldens(dialect)] == []
    wanted = [each.head for each in entries if each.refused]
    assert [head for head in wanted if not goldens(dialect)[head].refused] == []
