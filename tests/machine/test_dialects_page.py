"""``docs/dialects.md``: its generated part is what the code has."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from app.compose.dialects_page import BEGIN, END, generated, machines, with_generated

PAGE = Path(__file__).parents[2] / "docs" / "dialects.md"


def test_the_generated_part_is_up_to_date() -> None:
    text = PAGE.read_text("utf-8")
    assert with_generated(text) == text, "python -m app.compose.dialects_page docs/dialects.md"


def test_every_language_has_a_machine_and_a_book() -> None:
    rows = generated().splitlines()
    assert (rows[0], rows[-1]) == (BEGIN, END)
    for name, ending in (("OmniTurn", "`.nc`"), ("Klartext", "`.h`"), ("SINUMERIK", "`.mpf`")):
        (row,) = [each for each in rows if each.startswith(f"| {name} |")]
        assert ending in row
    assert "| fork-head-mill | mill | sim | X Y Z " in generated()
    assert len(machines()) > 10
    assert all(f"| {name} |" in generated() for name in machines())


def test_a_page_without_its_marks_is_refused() -> None:
    with pytest.raises(ValueError, match=re.escape(BEGIN)):
        with_generated("# Three languages\n")
