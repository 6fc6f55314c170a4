"""The table of what each level may change: ``python -m core.access.access_page docs/access.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from core.access.access_table import NEVER, RULES, Level

_HEAD = """\
# What each level may change

Written from `core/access/access_table.py` by `python -m core.access.access_page docs/access.md`. Levels are
off until somebody of SERVICE level is entered (`F10` ACCESS LEVELS, or `turndesk access add`); the guide says
how. A level may all that those before it may. Behind no level, ever: {never}.
What lies in the program folder the desk publishes by itself, behind no level: whoever put it there had to be
allowed to, and what is published replaces nothing on another desk.
"""


def page() -> str:
    """The whole page."""
    return _HEAD.format(never=", ".join(NEVER)) + "".join(_lines())


def _lines() -> Iterator[str]:
    for level in Level:
        yield f"\n## {level.name}\n\n| what | pages | commands |\n|---|---|---|\n"
        for rule in RULES.values():
            if rule.level is level:
                commands = (
                    ", ".join(f"`{each.strip()}`" for each in rule.command.split(",")) if rule.command else ""
                )
                yield f"| {rule.what} | {rule.where} | {commands} |\n"


def main(argv: list[str]) -> int:
    """Write the page to the file that is named."""
    Path(argv[0]).write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
