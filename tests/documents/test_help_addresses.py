"""Addresses that the help shows: each leads to a section that exists in the documents."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

import pytest

from app.desk.pages.alarm_help import find_alarm_address, make_alarm_help
from app.desk.pages.guide_text import (
    ALARM_LOG,
    COMMON_KEYS,
    FUNCTIONS_FILE,
    BlockKind,
    find_page_address,
    read_function_help,
)
from app.screen import page_table
from core.alarms import CATALOG
from core.executor.snapshot import Alarm
from tests.documents.pages import DOCS, ROOT, Page

TOPICS = [COMMON_KEYS, ALARM_LOG, *(entry.name for entry in page_table.ALL_PAGES)]
NUMBERS = sorted({entry.number for entry in CATALOG.values()})
SCREEN = DOCS / "guide" / "screen.md"


def has_target(address: str) -> bool:
    """Return whether the Markdown page of an address sets its anchor."""
    file, _, anchor = address.partition("#")
    path = ROOT / PurePosixPath(file).with_suffix(".md")
    return bool(anchor) and path.is_file() and anchor in Page(path).anchors


@pytest.mark.parametrize("language", ["en", "es"])
def test_the_address_of_each_page_exists(language: str) -> None:
    missing = [topic for topic in TOPICS if not has_target(find_page_address(topic, language))]
    assert missing == []


def test_the_address_of_each_alarm_exists() -> None:
    assert len(NUMBERS) > 50  # the catalog is not empty
    assert [number for number in NUMBERS if not has_target(find_alarm_address(number))] == []


def test_the_address_of_each_special_function_exists() -> None:
    page = Page(DOCS / FUNCTIONS_FILE)
    names = [title.lstrip("0123456789 ") for _, _, title in page.headings if title[0].isdigit()]
    assert names
    for name in names:
        assert has_target(read_function_help(name, "en")[0].text)


def test_each_key_of_the_main_menu_links_to_the_section_of_its_page() -> None:
    text = SCREEN.read_text(encoding="utf-8").partition("## Main menu, F1")[2].partition("\n## ")[0]
    linked = {
        row[0]: set(re.findall(r"\(#([^)]+)\)", row[1]))
        for row in re.findall(r"^\| `(\w+)`(.*)$", text, re.MULTILINE)
    }
    missing = []
    for entry in page_table.ALL_PAGES:
        anchor = find_page_address(entry.name, "en").partition("#")[2]
        if entry.key and anchor not in linked.get(entry.key, ()):
            missing.append((entry.key, entry.name, anchor))
    assert missing == []


@pytest.mark.parametrize("number", [0, 100, -102, 99999])
def test_an_unknown_alarm_number_has_no_address(number: int) -> None:
    assert find_alarm_address(number) == ""
    blocks = make_alarm_help(Alarm(number, "following", "FOLLOWING ERROR", "cause", "remedy"))
    assert BlockKind.ADDRESS not in {block.kind for block in blocks}


@pytest.mark.parametrize("topic", ["", "NO SUCH PAGE", "automatic"])
@pytest.mark.parametrize("language", ["en", "es"])
def test_an_unknown_page_has_no_address(topic: str, language: str) -> None:
    assert find_page_address(topic, language) == ""


@pytest.mark.parametrize("address", ["docs/alarms.html#100", "docs/no-page.html#101", "docs/alarms.html"])
def test_a_missing_target_is_detected(address: str) -> None:
    assert not has_target(address)
