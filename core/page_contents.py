"""Table of contents of a generated page, with the anchors that GitHub assigns to headings."""

from __future__ import annotations

import re
from collections.abc import Iterable


def make_anchor(title: str) -> str:
    """Return the anchor of a heading, in lower case, with hyphens between words and without punctuation."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title.strip())
    return re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")


def make_table_of_contents(titles: Iterable[str]) -> str:
    """Return a list of links to the headings of a page, one line each."""
    return "".join(f"- [{title}](#{make_anchor(title)})\n" for title in titles)
