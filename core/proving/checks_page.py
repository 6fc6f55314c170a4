"""Generator of the checks page, run by ``python -m core.proving.checks_page docs/checks.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from core.message import Message
from core.page_contents import make_table_of_contents
from core.proving.checks.part_checks import PART_CHECKS, PROGRAM_CHECKS, PartCheck

_PART, _PROGRAM = "Checks of the part", "Checks that do not need the stock"
_HEAD = """\
# What the proof checks

This page lists all checks. To read a finding, specify stock and tools, or turn a check off, see
[programming/edit-and-prove.md](programming/edit-and-prove.md).

{contents}
This page is generated from `core/proving/checks/part_checks.py` by
`python -m core.proving.checks_page docs/checks.md`. Do not edit it. Each finding shows its check,
line, elementary block and remedy.

**Errors and warnings.** A program with an error does not start. On a machine, an error in a part
check blocks Cycle Start if the stock and the tool shape on which the check depends are specified.
The stock is specified on the command line, in the store or on page PART. If the stock or the tool
shape is assumed, the finding is only a warning, which is announced before the start.

**What is assumed.** TurnDesk assumes the stock and tools that you do not specify, and reports these
assumptions. The assumed stock is a bar that is slightly larger than the finished contour, or a tube
if a boring tool cuts before any drill. TurnDesk derives the tool type from the comment next to its
`T` or from its moves. It assumes a slim insert and no holder.

**What is not checked.** The proof does not check:

- holders and shanks of tools without a shape;
- a chuck without `[clamping]` in the machine file;
- the first move of a program, which begins at the current axis positions;
- any motion while the collet is open.

After a bar feed, the proof assumes that the new front end of the bar is at the position of the bar
stop.

**Accuracy.** The model of the material is accurate to 0.004 mm (.00016 in) along Z and to 0.0015 mm
(.00006 in) in radius. A rapid that scrapes a cone or a shoulder is detected if its depth is at
least 0.033 mm (.0013 in), measured perpendicular to the surface. Shallower scrapes may not be
detected.

**Turning a check off.** Only a check of the part can be turned off. To turn it off for one program,
use page PART and enter a reason. To turn it off for a machine, add, for example,
`silenced = ["chip-load", "cuts-air"]` to `[checks]` in the machine file. A check cannot be turned
off in the text of a program, because the text may be used on another machine. The findings of a
check that is turned off become notes with the reason, and are counted (`silenced` of
`prove --json`).
"""


def render_checks_page() -> str:
    """Return the Markdown text of the documentation page about the checks."""
    head = _HEAD.format(contents=make_table_of_contents([_PART, _PROGRAM]))
    return f"{head}\n## {_PART}\n\n{_rows(PART_CHECKS)}\n## {_PROGRAM}\n\n{_rows(PROGRAM_CHECKS)}"


def _rows(checks: Mapping[str, PartCheck]) -> str:
    return "\n".join(_row(name, check) for name, check in checks.items()) + "\n"


def _row(name: str, check: PartCheck) -> str:
    return "\n".join(_lines(name, check))


def _lines(name: str, check: PartCheck) -> Iterator[str]:
    yield f"**{name}** ({check.severity}): {check.purpose}  "
    yield Message("Condition: {decides}  ", decides=check.condition)
    if name in PART_CHECKS:
        yield Message(
            "Depends on: {rests_on}.  ", rests_on=" and ".join(check.required_data) or "the machine file"
        )
    yield f"Remedy: {check.remedy}"
    yield ""


def main(argv: list[str]) -> int:
    """Write the page to the file that the first argument names."""
    Path(argv[0]).write_text(render_checks_page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
