"""``docs/language.md`` from the code table.

``python -m core.interpreter.omniturn.language_page > docs/language.md`` writes it.
"""

from __future__ import annotations

import re
import sys
from math import inf

from core.interpreter.omniturn.code_entry import HEAD, TAIL, Code, Limit, WordRule
from core.interpreter.omniturn.code_table import CHAPTERS
from core.language.omniturn.omniturn_words import COUNTING, RANGES
from core.page_contents import contents

_TOP = """\
# OmniTurn, code by code

This page is the reference for all OmniTurn codes. For the language by subject, see
[programming/omniturn.md](programming/omniturn.md).

{contents}
It is written from `core/interpreter/omniturn/code_table.py`, which the tests use. Do not edit it.
Every example goes between these lines, with every tool offset at part zero. What follows `…` goes
after M30:

```
{head}…
{tail}```

M codes that are not listed here belong to the machine file. The list after each code gives the
limits of its words and the conditions that reject it, with the code of the finding. The finding
itself gives line, column and remedy.

## Numbers

A number must be within these limits, in any unit. Some codes have narrower limits, which are listed
with the code.

{numbers}"""


def page() -> str:
    """The text of ``docs/language.md``."""
    anchors: set[str] = set()
    chapters = "".join(
        f"\n## {title}\n\n" + "".join(_anchor(code, anchors) + _entry(code) for code in codes)
        for title, codes in CHAPTERS
    )
    titles = contents(["Numbers", *(title for title, _ in CHAPTERS)])
    return _TOP.format(head=HEAD, tail=TAIL, numbers=_numbers(), contents=titles) + chapters


def _numbers() -> str:
    letters: dict[tuple[float, float, bool], list[str]] = {}
    for letter, (least, most) in RANGES.items():
        letters.setdefault((least, most, letter in COUNTING), []).append(letter)
    rows = [
        f"| {' '.join(f'`{letter}`' for letter in those)} | {_shown(least)} | {_shown(most)}"
        f"{', whole' if whole else ''} |\n"
        for (least, most, whole), those in letters.items()
    ]
    return "| word | minimum | maximum |\n|---|---|---|\n" + "".join(rows)


def _anchor(entry: Code, anchors: set[str]) -> str:
    """Return the anchor ``#g75`` before the first entry of a code, and nothing before its other entries."""
    name = re.sub(r"[^a-z0-9]", "", entry.name.lower())
    if not name or name in anchors:
        return ""
    anchors.add(name)
    return f'<a id="{name}"></a>\n\n'


def _entry(entry: Code) -> str:
    lines = [
        *entry.example.splitlines(),
        *(["…", *entry.subroutine.splitlines()] if entry.subroutine else []),
    ]
    rules = "".join(f"- {line}\n" for line in _rules(entry))
    example = "```\n" + "\n".join(lines) + "\n```\n\n"
    return f"**`{entry.form}`** {entry.what}\n\n" + (f"{rules}\n" if rules else "") + example


def _rules(entry: Code) -> list[str]:
    """What must hold of its words, when it is refused, and by which diagnostics besides."""
    rules = [f"`{letter}` {_rule(rule)}" for letter, rule in entry.rules.items()]
    if entry.one_of is not None:
        letters, refusal = entry.one_of
        rules.append(f"one of {_letters(letters)} is required: `{refusal.code}`")
    rules += [
        f"{_letters(letters)} must not be used together: `{refusal.code}`" for letters, refusal in entry.apart
    ]
    rules += [f"not allowed when {when.value}: `{refusal.code}`" for when, refusal in entry.not_when.items()]
    if entry.further:
        rules.append("also " + ", ".join(f"`{code}`" for code in sorted(entry.further)))
    return rules


def _rule(rule: WordRule) -> str:
    said = [rule.what]
    if rule.missing is not None:
        said.append("required")
    if rule.numbered is not None:
        said.append("no number allowed after the word")
    if rule.bare is not None:
        said.append(f"without a number {_shown(rule.bare)}")
    if rule.nonzero:
        said.append("not 0")
    if rule.least > -inf:
        most = rule.most.value if isinstance(rule.most, Limit) else _shown(rule.most)
        least = ("over " if rule.over else "from ") + _shown(rule.least)
        said.append(f"{least} to {most}" if rule.most != inf else least)
    if rule.whole:
        said.append("whole")
    codes = dict.fromkeys(f"`{each.code}`" for each in rule.refusals)
    return ", ".join(said) + (f": {', '.join(codes)}" if codes else "")


def _letters(letters: tuple[str, ...]) -> str:
    return ", ".join(f"`{letter}`" for letter in letters)


def _shown(value: float) -> str:
    return f"{value:,.6f}".rstrip("0").rstrip(".")


if __name__ == "__main__":
    sys.stdout.write(page())
