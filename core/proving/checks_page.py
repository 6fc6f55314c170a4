"""The page of the checks of the part: ``python -m core.proving.checks_page docs/checks.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from core.message import Message
from core.page_contents import contents
from core.proving.part_checks import CHECKS, PROGRAM_CHECKS, Check

_PART, _PROGRAM = "Checks of the part", "Checks that do not need the stock"
_HEAD = """\
# What the proof checks

This page is the reference of the checks. How to read a finding, state stock and tools, and turn a
check off is in [programming/edit-and-prove.md](programming/edit-and-prove.md).

{contents}
It is written from `core/proving/part_checks.py` by `python -m core.proving.checks_page docs/checks.md`.
Do not edit it. A finding has its check, line, elementary block and remedy.

**Errors and warnings.** A program with an error does not start. On a machine, an error of the part
rejects Cycle Start if the stock (command line, store or page PART) and the tool shape that it depends
on are stated. If one of them is assumed, the finding is a warning, which is announced before the
start.

**What is assumed.** TurnDesk assumes stock and tools that you do not state, and reports it. It assumes
a bar that is slightly larger than what is cut, or a tube where a boring tool begins without a drill.
It recognizes a tool by the comment next to its `T` or by its moves, with a slim insert and no holder.

**What is not checked.** The proof does not check:

- holders and shanks of tools without a shape;
- a chuck without `[clamping]` in the machine file;
- the first move of a program, which begins at the axis positions of the moment;
- everything that moves while the collet is open.

When a bar is fed, its new front end is where its stop was.

**Accuracy.** Material is exact to 0.004 mm (.00016 in) along Z and to 0.0015 mm (.00006 in) in radius.
A rapid that scrapes a cone or a shoulder is found from a depth of 0.033 mm (.0013 in), measured square
to the surface. Less may pass.

**Turning a check off.** Only a check of the part can be turned off: for one program on the page PART,
with a reason, or for a machine in its file: `[checks]` with `silenced = ["chip-load", "cuts-air"]`. It
is never turned off in the text of a program, because the text may go to another machine. Its findings
are then notes with the reason, and are counted (`silenced` of `prove --json`).
"""


def page() -> str:
    """The whole page."""
    head = _HEAD.format(contents=contents([_PART, _PROGRAM]))
    return f"{head}\n## {_PART}\n\n{_rows(CHECKS)}\n## {_PROGRAM}\n\n{_rows(PROGRAM_CHECKS)}"


def _rows(checks: Mapping[str, Check]) -> str:
    return "\n".join(_row(name, check) for name, check in checks.items()) + "\n"


def _row(name: str, check: Check) -> str:
    return "\n".join(_lines(name, check))


def _lines(name: str, check: Check) -> Iterator[str]:
    yield f"**{name}** ({check.severity}): {check.looks_for}  "
    yield Message("Condition: {decides}  ", decides=check.decides)
    if name in CHECKS:
        yield Message(
            "Depends on: {rests_on}.  ", rests_on=" and ".join(check.rests_on) or "the machine file"
        )
    yield f"Remedy: {check.remedy}"
    yield ""


def main(argv: list[str]) -> int:
    """Write the page to the file that is named."""
    Path(argv[0]).write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
