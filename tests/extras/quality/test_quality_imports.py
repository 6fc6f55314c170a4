"""The calculations of measured parts know nothing else of TurnDesk."""

from __future__ import annotations

import re
from pathlib import Path

import core.extras.quality

OURS = {"core.message"}


def test_the_calculations_import_only_messages_and_errors() -> None:
    (folder,) = core.extras.quality.__path__
    found = set[str]()
    for path in Path(folder).glob("*.py"):
        found |= set(
            re.findall(r"^\s*from ((?:core|app|drivers)[.\w]*)", path.read_text("utf-8"), re.MULTILINE)
        )
    others = {name for name in found if not name.startswith("core.extras.quality")}
    assert others == OURS
