"""Reader of ``CHANGELOG.md``, which reports deviations from Keep a Changelog 1.1."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

SECTIONS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")
UNRELEASED = "Unreleased"
_RELEASE = re.compile(r"\[(?P<version>[^\]]+)\](?: - (?P<date>\d{4}-\d\d-\d\d))?")
_VERSION = re.compile(r"\d+\.\d+\.\d+(?:-[0-9A-Za-z.-]+)?")


class Release(NamedTuple):
    """One release: its version or Unreleased, its date or "", and the number of entries by section."""

    version: str
    date: str
    entries: dict[str, int]


def releases(text: str) -> list[Release]:
    """Return the releases, the first one of the page first. Headings with a wrong form have no version."""
    found: list[Release] = []
    section = ""
    for line in text.splitlines():
        if line.startswith("## "):
            release = _RELEASE.fullmatch(line[3:])
            found.append(
                Release(release["version"] if release else "", (release and release["date"]) or "", {})
            )
            section = ""
        elif line.startswith("### ") and found:
            section = line[4:]
            found[-1].entries.setdefault(section, 0)
        elif line.startswith("- ") and section:
            found[-1].entries[section] += 1
    return found


def mistakes(text: str, version: str) -> Iterator[str]:
    """Yield the kind of each deviation; ``version`` is the one that the code states."""
    listed = releases(text)
    names = [each.version for each in listed]
    if names[:1] != [UNRELEASED]:
        yield "unreleased-first"
    if version not in names and not any(listed[0].entries.values() if listed else ()):
        yield "version-without-section"
    if len(set(names)) < len(names):
        yield "version-twice"
    released = [each for each in listed if each.version != UNRELEASED]
    if [each for each in released if not _VERSION.fullmatch(each.version) or not each.date]:
        yield "version-or-date"
    dates = [each.date for each in released]
    if dates != sorted(dates, reverse=True):
        yield "order"
    if {section for each in listed for section in each.entries} - set(SECTIONS):
        yield "unknown-section"
    if [each for each in listed if not all(each.entries.values())]:
        yield "empty-section"
