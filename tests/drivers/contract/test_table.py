"""The table of acceptance tests in docs/hardware.md tells the truth: what it names exists."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
NAMED = re.compile(r"`([\w/]+\.py)::(\w+)`")


def table() -> str:
    """The section of the table."""
    text = (ROOT / "docs" / "hardware.md").read_text(encoding="utf-8")
    return text.partition("## Fault → reaction → bound → test")[2].partition("\n## ")[0]


def named() -> list[tuple[str, str]]:
    """(file, test) of every reference."""
    return sorted(set(NAMED.findall(table())))


@pytest.mark.parametrize(("file", "test"), named(), ids="::".join)
def test_what_the_table_names_exists(file: str, test: str) -> None:
    found = [
        folder / file for folder in (ROOT / "tests", ROOT / "tests" / "drivers") if (folder / file).is_file()
    ]
    assert found, f"no file {file} below tests or tests/drivers"
    tree = ast.parse(found[0].read_text(encoding="utf-8"))
    assert test in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


def test_every_acceptance_row_has_a_test() -> None:
    rows = dict(re.findall(r"^\| (\d+) \|(.*)$", table(), re.MULTILINE))
    assert sorted(map(int, rows)) == list(range(1, 19))
    assert [number for number, row in rows.items() if not NAMED.search(row)] == []
