"""Words that the glossary tells writers to avoid."""

from __future__ import annotations

import re
from pathlib import Path

GLOSSARY = Path(__file__).parents[1] / "docs" / "glossary.md"
AVOIDED = "## Words we do not use"
"""Heading of the table."""


def avoided() -> list[str]:
    """Return the words of the table's first column."""
    table = GLOSSARY.read_text(encoding="utf-8").partition(AVOIDED)[2]
    cells = re.findall(r"^\| ([^|]+) \|", table, re.MULTILINE)
    return [word.strip() for cell in cells[2:] for word in cell.split(",")]
