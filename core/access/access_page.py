"""Generator of the access-level page: ``python -m core.access.access_page docs/access.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from core.access.access_table import ACCESS_RULES, NEVER_PERMITTED, AccessLevel

_HEAD = """\
# What each access level may change

This page is a reference for the person who manages users and PINs. It lists what each access level
may change, and on which screen pages and with which commands. To set up users, see
[guide/access-levels.md](guide/access-levels.md).

Access levels are off until a user of SERVICE level is added with `F10`, ACCESS LEVELS, or with
`turndesk access add`. Each level also includes the changes that the lower levels may make.

No level is ever required for:

{never}

TurnDesk publishes the programs in the program folder automatically, and no access level is required
for this. The person who put a program into the folder needed the access level for that action. A
published program does not replace a program on another control.

This page is generated from `core/access/access_table.py` by
`python -m core.access.access_page docs/access.md`. Do not edit it.
"""


def make_access_page() -> str:
    """Return the access-level page as text."""
    return _HEAD.format(never="\n".join(f"- {each}" for each in NEVER_PERMITTED)) + "".join(_lines())


def _lines() -> Iterator[str]:
    for level in AccessLevel:
        yield f"\n## {level.name}\n\n| what may be changed | page | command |\n|---|---|---|\n"
        for rule in ACCESS_RULES.values():
            if rule.minimum_level is level:
                commands = (
                    ", ".join(f"`{each.strip()}`" for each in rule.commands_text.split(","))
                    if rule.commands_text
                    else ""
                )
                yield f"| {rule.description} | {rule.pages_text} | {commands} |\n"


def write_page(argv: list[str]) -> int:
    """Write the page to the file named in ``argv[0]``."""
    Path(argv[0]).write_text(make_access_page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(write_page(sys.argv[1:]))
