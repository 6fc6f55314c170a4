"""The one place where tests hold wording: every text of the tables is one that the product has."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest

from tests.texts import FOLDER, all_texts, pattern, text

CATALOGUE = FOLDER.parents[1] / "resources" / "translations" / "turndesk_es.ts"
HOLE = re.compile(r"%\d|\{[^{}]*\}")


@pytest.fixture(scope="module")
def known() -> set[str]:
    """Every English text that the product translates, its holes as ``{}``."""
    sources = ElementTree.parse(CATALOGUE).iter("source")
    return {HOLE.sub("{}", each.text or "") for each in sources}


@pytest.mark.parametrize("name", sorted(all_texts()))
def test_the_product_has_this_text(name: str, known: set[str]) -> None:
    assert HOLE.sub("{}", all_texts()[name]) in known


def test_an_unknown_id_and_a_missing_value_are_refused() -> None:
    with pytest.raises(KeyError):
        text("screen.no-such-text")
    assert re.fullmatch(pattern("screen.no-start"), text("screen.no-start", why="AN ALARM"))
