"""What a list of vulnerabilities says of the locked packages, and what it does not say."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

import pytest

from resources.setup.audit import PAGE, Result, page, result_of
from resources.setup.lock import INSTALLER, SETS

PACKAGES = ("numpy", "pip")


def answer(*dependencies: Mapping[str, object]) -> str:
    return json.dumps({"dependencies": list(dependencies), "fixes": []})


def test_what_has_no_known_vulnerability_is_checked() -> None:
    told = answer(*({"name": name, "version": "1", "vulns": []} for name in PACKAGES))
    assert result_of("desk", PACKAGES, told) == Result("desk", 2, [], [])


def test_a_vulnerability_is_named() -> None:
    told = answer({"name": "pip", "version": "1", "vulns": [{"id": "PYSEC-1", "aliases": []}]})
    assert result_of("desk", ["pip"], told).found == ["pip: PYSEC-1"]


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
def test_what_was_skipped_or_not_answered_is_not_checked(told: str) -> None:
    """pip-audit itself ends with 0 and "No known vulnerabilities found" where it has skipped all."""
    result = result_of("desk", PACKAGES, told)
    assert (result.checked, tuple(result.unchecked)) == (0, PACKAGES)
    assert "**no package was checked**" in page([result], "2026-11-29")


def test_the_page_has_a_date_and_every_locked_file() -> None:
    written = PAGE.read_text(encoding="utf-8")
    assert re.search(r"\(\d{4}-\d\d-\d\d\)", written)
    for name in (*SETS, INSTALLER):
        assert f"`locked-{name}.txt`" in written
