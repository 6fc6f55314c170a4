"""The table of what each level may change: ``python -m core.access.access_page docs/access.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from core.access.access_table import NEVER, RULES, Level

_HEAD = """\
# What each access level may change

This page is a reference for the person who manages users and PINs. It lists what each access level
may change, on which pages of the screen and by which commands. How to set up users is in
[guide/access-levels.md](guide/access-levels.md).

Levels are off until a user of SERVICE level is added: `F10`, ACCESS LEVELS, or
`turndesk access add`. Each level may also make the changes of the levels before it.

No level is ever required for:

{never}

TurnDesk publishes the programs in the program folder automatically, and this needs no level. The
person who put a program there needed the level for that. A published program replaces nothing on
another control.

`python -m core.access.access_page docs/access.md` writes this page from
`core/access/access_table.py`. Do not edit it.
"""


def page() -> str:
    """The whole page."""
    return _HEAD.format(never="\n".join(f"- {each}" for each in NEVER)) + "".join(_lines())


def _lines() -> Iterator[str]:
    for level in Level:
        yield f"\n## {level.name}\n\n| what may be changed | page | command |\n|---|---|---|\n"
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
