"""``turndesk alarms`` and the page of alarms: what the interfaces promise, and current."""

from __future__ import annotations

import json
from pathlib import Path

from core.alarms import CATALOG
from core.alarms.alarms_page import main, render_page
from tests.cli.conftest import Turndesk

PAGE = Path(__file__).parents[2] / "docs" / "alarms.md"


def test_json_catalog_has_numbers_texts_causes_and_remedies(turndesk: Turndesk) -> None:
    told = turndesk("alarms", "--json")
    assert (told.status, told.err) == (0, "")
    entries = json.loads(told.out)
    assert len(entries) == len(CATALOG)
    for entry in entries:
        assert {"number", "text", "causes", "remedy"} <= set(entry)
        assert all(isinstance(cause, str) and cause for cause in entry["causes"])
    numbers = [entry["number"] for entry in entries]
    assert numbers == sorted(set(numbers))


def test_single_alarm_is_shown_by_its_number(turndesk: Turndesk) -> None:
    told = turndesk("alarms", "102")
    assert told.status == 0
    assert told.out.startswith("102  FOLLOWING ERROR")
    (entry,) = (each for each in CATALOG.values() if each.number == 102)
    assert all(cause in told.out for cause in entry.causes)
    assert "103" not in told.out


def test_unknown_alarm_number_is_rejected_in_one_line(turndesk: Turndesk) -> None:
    told = turndesk("alarms", "102", "5")
    assert (told.status, told.out) == (2, "")
    assert (told.code, told.err.count("\n")) == ("unknown-alarm", 1)
    assert " 5" in told.err


def test_alarms_page_is_up_to_date() -> None:
    """python -m core.alarms.alarms_page docs/alarms.md"""
    assert PAGE.read_text(encoding="utf-8") == render_page()


def test_alarms_page_is_written_to_given_path(tmp_path: Path) -> None:
    assert main([str(tmp_path / "page.md")]) == 0
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert all(str(entry.number) in text for entry in CATALOG.values())
