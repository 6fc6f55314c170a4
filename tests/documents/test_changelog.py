"""CHANGELOG.md has the form of Keep a Changelog, and the version of the code is in it or comes next."""

from __future__ import annotations

from importlib.metadata import version as installed_version

import pytest

from app import VERSION
from resources.setup.lock import read_project_file
from tests.documents.changelog import mistakes, releases
from tests.documents.pages import ROOT

GOOD = """\
# Changelog

## [Unreleased]

### Added

- One.

## [0.2.0] - 2026-12-02

### Fixed

- Two.
  Its second line.
- Three.

## [0.1.0] - 2026-12-01
"""


def test_changelog_has_the_required_form() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert list(mistakes(text, VERSION)) == []
    assert sum(releases(text)[0].entries.values()) + len(releases(text)) > 1


def test_entries_are_counted_by_section() -> None:
    assert releases(GOOD)[1] == ("0.2.0", "2026-12-02", {"Fixed": 2})
    assert list(mistakes(GOOD, "0.2.0")) == []


@pytest.mark.parametrize(
    ("good", "bad", "kind"),
    [
        ("## [Unreleased]\n\n### Added\n\n- One.\n\n", "", "unreleased-first"),
        ("## [Unreleased]", "## Unreleased", "unreleased-first"),
        ("- One.\n", "", "empty-section"),
        ("### Added\n\n- One.\n\n", "", "version-without-section"),
        ("### Fixed", "### Repaired", "unknown-section"),
        (" - 2026-12-02", "", "version-or-date"),
        ("[0.2.0]", "[0.2]", "version-or-date"),
        ("2026-12-02", "2026-11-02", "order"),
        ("[0.2.0]", "[0.1.0]", "version-twice"),
    ],
)
def test_wrong_changelog_is_detected(good: str, bad: str, kind: str) -> None:
    assert good in GOOD
    assert kind in list(mistakes(GOOD.replace(good, bad, 1), "0.3.0"))


def test_the_version_is_stated_once() -> None:
    assert "version" not in read_project_file()["project"]
    assert read_project_file()["project"]["dynamic"] == ["version"]
    assert installed_version("turndesk") == VERSION
