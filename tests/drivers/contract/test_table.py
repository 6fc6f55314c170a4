"""The table of acceptance tests in docs/integrator/tried.md tells the truth: what it names exists."""

from __future__ import annotations

import re

import pytest

from tests.named import NAMED, ROOT, file_of, functions_of, named_in


def table() -> str:
    """The section of the table."""
    text = (ROOT / "docs" / "integrator" / "tried.md").read_text(encoding="utf-8")
    return text.partition("## Acceptance tests")[2].partition("\n## ")[0]


@pytest.mark.parametrize(("file", "test"), named_in(table()))
def test_tests_named_in_the_acceptance_table_exist(file: str, test: str) -> None:
    found = file_of(file)
    assert found is not None, f"no file {file} below tests or tests/drivers"
    assert test in functions_of(found)


def test_every_acceptance_row_has_a_test() -> None:
    rows = dict(re.findall(r"^\| (\d+) \|(.*)$", table(), re.MULTILINE))
    assert sorted(map(int, rows)) == list(range(1, 19))
    assert [number for number, row in rows.items() if not NAMED.search(row)] == []
