"""Texts of the product by id: a test names a message and its values, never its wording.

Each file ``NAME.toml`` of this folder holds ``id = "ENGLISH TEXT WITH {value}"``; a text in ``screen.toml`` has the id
``screen.id``. A text that is reworded changes in the product and on one line here. ``test_texts.py`` holds
every line against the texts that the product has.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent


@cache
def all_texts() -> dict[str, str]:
    """Return every template by its id."""
    return {
        f"{path.stem}.{name}": template
        for path in sorted(FOLDER.glob("*.toml"))
        for name, template in tomllib.loads(path.read_text(encoding="utf-8")).items()
    }


def text(name: str, **values: object) -> str:
    """Return a text with its values put in; raises KeyError for an unknown id or a missing value."""
    template = all_texts()[name]
    return template.format(**values) if values else template


def pattern(name: str, **values: object) -> str:
    """Return a regular expression for the text; a value that is not given stands for anything."""
    template = all_texts()[name]
    parts = re.split(r"(\{\w+\})", template)
    return "".join(
        (re.escape(str(values[part[1:-1]])) if part[1:-1] in values else ".*")
        if re.fullmatch(r"\{\w+\}", part)
        else re.escape(part)
        for part in parts
    )
