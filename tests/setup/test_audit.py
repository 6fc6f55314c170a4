"""What a list of vulnerabilities says of the locked packages, and what it does not say."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

import pytest

from resources.setup.audit import PAGE_PATH, AuditResult, format_page, parse_audit_output
from resources.setup.lock import EXTRAS_BY_SET, INSTALLER_SET

PACKAGES = ("numpy", "pip")


def answer(*dependencies: Mapping[str, object]) -> str:
    return json.dumps({"dependencies": list(dependencies), "fixes": []})


def test_packages_without_known_vulnerability_are_counted_as_checked() -> None:
    told = answer(*({"name": name, "version": "1", "vulns": []} for name in PACKAGES))
    assert parse_audit_output("desk", PACKAGES, told) == AuditResult("desk", 2, [], [])


def test_a_vulnerability_is_named() -> None:
    told = answer({"name": "pip", "version": "1", "vulns": [{"id": "PYSEC-1", "aliases": []}]})
    assert parse_audit_output("desk", ["pip"], told).vulnerabilities == ["pip: PYSEC-1"]


@pytest.mark.parametrize(
    "told",
    [
        "",
        "[]",
        '{"dependencies": 1}',
        answer(),
        answer(*({"name": name, "skip_reason": "not found on PyPI"} for name in PACKAGES)),
    ],
)
def test_skipped_or_missing_packages_count_as_unchecked(told: str) -> None:
    """pip-audit itself ends with 0 and "No known vulnerabilities found" where it has skipped all."""
    result = parse_audit_output("desk", PACKAGES, told)
    assert (result.checked_count, tuple(result.unchecked_packages)) == (0, PACKAGES)
    assert "**no package was checked**" in format_page([result], "2026-11-29")


def test_page_has_date_and_names_every_locked_file() -> None:
    written = PAGE_PATH.read_text(encoding="utf-8")
    assert re.search(r"\(\d{4}-\d\d-\d\d\)", written)
    for name in (*EXTRAS_BY_SET, INSTALLER_SET):
        assert f"`locked-{name}.txt`" in written
