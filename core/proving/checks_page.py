"""The page of the checks of the part: ``python -m core.proving.checks_page docs/checks.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from core.proving.part_checks import CHECKS, PROGRAM_CHECKS, Check

_HEAD = """# What the proof looks for

Written from `core/proving/part_checks.py` by `python -m core.proving.checks_page docs/checks.md`. Each
finding has its id, line, elementary block and remedy; an error refuses the program. The metal is exact to
.004 mm (.00016 in) along Z and .0015 mm (.00006 in) in r. A rapid that scrapes a cone or a shoulder is found
from .033 mm (.0013 in) on, square to the surface; what scrapes less may pass.

At a machine an error refuses Cycle Start where what it rests on was said: the stock (command line, store, the
page PART), the shape of the tool. Where that is assumed it is a warning, announced before the start.

What nobody has said is assumed and told: the stock as a bar just larger than what is cut (a tube where a
boring tool begins without a drill), a tool by the comment beside its `T` or by its moves, with a slim
insert and no holder. What an assumption cannot know is not checked: holders and shanks of tools without a
shape, a chuck without `[clamping]` in the machine file, the first move of a program, which begins wherever
the slides stand, and all that moves while the collet is open. A bar that is fed begins anew where its stop
stood.

A check of the part is silenced for one program on the page PART, with a reason, or for a machine in its file:
`[checks]` with `silenced = ["chip-load", "cuts-air"]`. Never in the text of a program: that goes to other
machines. Its findings are notes from then on, with the reason, and counted (`silenced` of `prove --json`).
"""

_WITHOUT = """
## Without the stock
"""


def page() -> str:
    """The whole page."""
    return f"{_HEAD}\n{_rows(CHECKS)}{_WITHOUT}\n{_rows(PROGRAM_CHECKS)}"


def _rows(checks: Mapping[str, Check]) -> str:
    return "\n".join(_row(name, check) for name, check in checks.items()) + "\n"


def _row(name: str, check: Check) -> str:
    return "\n".join(_lines(name, check))


def _lines(name: str, check: Check) -> Iterator[str]:
    yield f"**{name}** ({check.severity}): {check.looks_for}  "
    yield f"Condition: {check.decides}  "
    if name in CHECKS:
        yield f"Depends on: {' and '.join(check.rests_on) or 'the machine file'}.  "
    yield f"Do: {check.remedy}"
    yield ""


def main(argv: list[str]) -> int:
    """Write the page to the file that is named."""
    Path(argv[0]).write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
