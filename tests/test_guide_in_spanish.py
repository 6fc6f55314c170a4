"""The guide in Spanish says, line for line, what the guide says: nobody changes one alone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
ENGLISH, SPANISH = ((DOCS / name).read_text().splitlines() for name in ("guide.md", "guide.es.md"))


def shape(line: str) -> tuple[str, int, int]:
    """What begins it, cells of a table, what is quoted: alike in both."""
    begins = re.match(r"#+ |\d+\. |- |\||!\[|", line)
    assert begins is not None
    return begins[0], line.count(" | "), len(re.findall(r"`[^`]+`", line))


def test_both_have_the_same_lines() -> None:
    assert len(ENGLISH) == len(SPANISH), "translate what was added to docs/guide.md in docs/guide.es.md"


@pytest.mark.parametrize("begins", ["#", "|", "![", "- "])
def test_headings_tables_pictures_and_lists_stand_at_the_same_lines(begins: str) -> None:
    for number, (english, spanish) in enumerate(zip(ENGLISH, SPANISH, strict=True), start=1):
        if english.startswith(begins) or spanish.startswith(begins):
            assert shape(english) == shape(spanish), f"docs/guide.es.md:{number}"


def test_the_pictures_are_the_same_in_spanish_where_there_are_any() -> None:
    for english, spanish in zip(ENGLISH, SPANISH, strict=True):
        for name in re.findall(r"pictures/([\w-]+\.png)", english):
            wanted = (
                f"pictures/es/{name}" if (DOCS / "pictures" / "es" / name).exists() else f"pictures/{name}"
            )
            assert f"({wanted})" in spanish
