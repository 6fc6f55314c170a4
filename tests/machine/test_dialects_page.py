"""``docs/dialects.md``: its generated part is what the code has."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from app.compose.dialects_page import (
    BEGIN_MARK,
    END_MARK,
    generate_dialects_text,
    load_shipped_machines,
    update_dialects_page,
)

PAGE = Path(__file__).parents[2] / "docs" / "dialects.md"


def test_the_generated_part_is_up_to_date() -> None:
    text = PAGE.read_text("utf-8")
    assert update_dialects_page(text) == text, "python -m app.compose.dialects_page docs/dialects.md"


def test_every_language_has_a_machine_and_a_book() -> None:
    rows = generate_dialects_text().splitlines()
    assert (rows[0], rows[-1]) == (BEGIN_MARK, END_MARK)
    for name, ending in (("OmniTurn", "`.nc`"), ("Klartext", "`.h`"), ("SINUMERIK", "`.mpf`")):
        (row,) = [each for each in rows if each.startswith(f"| {name} |")]
        assert ending in row
    assert "| fork-head-mill | mill | sim | X Y Z " in generate_dialects_text()
    assert len(load_shipped_machines()) > 10
    assert all(f"| {name} |" in generate_dialects_text() for name in load_shipped_machines())


def test_a_page_without_its_marks_is_refused() -> None:
    with pytest.raises(ValueError, match=re.escape(BEGIN_MARK)):
        update_dialects_page("# Three languages\n")
