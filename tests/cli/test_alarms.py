"""``turndesk alarms`` and the page of alarms: what the interfaces promise, and current."""

from __future__ import annotations

import json
from pathlib import Path

from core.alarms import CATALOG
from core.alarms.alarms_page import main, render_page
from tests.cli.conftest import Turndesk

PAGE = Path(__file__).parents[2] / "docs" / "alarms.md"


def test_the_catalogue_as_json_has_number_text_causes_and_remedy(turndesk: Turndesk) -> None:
    told = turndesk("alarms", "--json")
    assert (told.status, told.err) == (0, "")
    entries = json.loads(told.out)
    assert len(entries) == len(CATALOG)
    for entry in entries:
        assert {"number", "text", "causes", "remedy"} <= set(entry)
        assert all(isinstance(cause, str) and cause for cause in entry["causes"])
    numbers = [entry["number"] for entry in entries]
    assert numbers == sorted(set(numbers))


def test_one_alarm_by_its_number(turndesk: Turndesk) -> None:
    told = turndesk("alarms", "102")
    assert told.status == 0
    assert told.out.startswith("102  FOLLOWING ERROR")
    (entry,) = (each for each in CATALOG.values() if each.number == 102)
    assert all(cause in told.out for cause in entry.causes)
    assert "103" not in told.out


def test_a_number_that_is_none_is_refused_in_one_line(turndesk: Turndesk) -> None:
    told = turndesk("alarms", "102", "5")
    assert (told.status, told.out) == (2, "")
    assert (told.code, told.err.count("\n")) == ("unknown-alarm", 1)
    assert " 5" in told.err


def test_the_page_of_alarms_is_current() -> None:
    """python -m core.alarms.alarms_page docs/alarms.md"""
    assert PAGE.read_text(encoding="utf-8") == render_page()


def test_the_page_is_written_where_it_is_asked_for(tmp_path: Path) -> None:
    assert main([str(tmp_path / "page.md")]) == 0
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert all(str(entry.number) in text for entry in CATALOG.values())
