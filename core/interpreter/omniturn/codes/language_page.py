"""Generator of ``docs/language.md`` from the code table.

``python -m core.interpreter.omniturn.codes.language_page > docs/language.md`` writes the page.
"""

from __future__ import annotations

import re
import sys
from math import inf

from core.interpreter.omniturn.codes.code_entry import HEAD, TAIL, Code, Limit, WordRule
from core.interpreter.omniturn.codes.code_table import CHAPTERS
from core.language.omniturn.omniturn_words import COUNTING, RANGES
from core.page_contents import contents

_TOP = """\
# OmniTurn, code by code

This page is the reference for all OmniTurn codes. For the language by subject, see
[programming/omniturn.md](programming/omniturn.md).

{contents}
This page is generated from `core/interpreter/omniturn/codes/code_table.py`, which the tests
also use. Do not edit this page. To run an example, put it in place of the line `…` in this
program, and set every tool offset to zero. If the example itself contains `…`, put the lines below
its `…` after M30:

```
{head}…
{tail}```

M codes that are not listed here are defined in the machine file. The list after each code gives the
limits of its words and the conditions under which the code is rejected. Each entry ends with the
code of the finding. The finding itself gives the line, the column and the remedy.

## Numbers

A number must be within these limits, in any unit. Some codes have narrower limits, which are listed
with the code.

{numbers}"""


def page() -> str:
    """Return the text of ``docs/language.md``."""
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
        f"{', whole number' if whole else ''} |\n"
        for (least, most, whole), those in letters.items()
    ]
    return "| word | minimum | maximum |\n|---|---|---|\n" + "".join(rows)


def _anchor(entry: Code, anchors: set[str]) -> str:
    """Return the anchor of a code, such as ``#g75``, before its first entry.

    For its other entries, the text is empty.
    """
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
    """Return the rules of an entry: limits of its words, conditions that reject it, and further findings."""
    rules = [f"`{letter}` {_rule(rule)}" for letter, rule in entry.rules.items()]
    if entry.one_of is not None:
        letters, refusal = entry.one_of
        rules.append(f"one of {_letters(letters)} is required: `{refusal.code}`")
    rules += [
        f"{_letters(letters)} must not be used together: `{refusal.code}`" for letters, refusal in entry.apart
    ]
    rules += [f"not allowed when {when.value}: `{refusal.code}`" for when, refusal in entry.not_when.items()]
    if entry.further:
        rules.append("other findings: " + ", ".join(f"`{code}`" for code in sorted(entry.further)))
    return rules


def _rule(rule: WordRule) -> str:
    said = [rule.what]
    if rule.missing is not None:
        said.append("required")
    if rule.numbered is not None:
        said.append("must be written without a number")
    if rule.bare is not None:
        said.append(f"{_shown(rule.bare)} if no number follows")
    if rule.nonzero:
        said.append("not 0")
    if rule.least > -inf:
        said.append(_range(rule))
    if rule.whole:
        said.append("whole number")
    codes = dict.fromkeys(f"`{each.code}`" for each in rule.refusals)
    return ", ".join(said) + (f": {', '.join(codes)}" if codes else "")


def _range(rule: WordRule) -> str:
    least, most = _shown(rule.least), rule.most.value if isinstance(rule.most, Limit) else _shown(rule.most)
    if rule.most == rule.least:
        return f"must be {least}"
    if rule.most == inf:
        return f"greater than {least}" if rule.over else f"{least} or more"
    return f"greater than {least}, at most {most}" if rule.over else f"{least} to {most}"


def _letters(letters: tuple[str, ...]) -> str:
    return ", ".join(f"`{letter}`" for letter in letters)


def _shown(value: float) -> str:
    return f"{value:,.6f}".rstrip("0").rstrip(".")


if __name__ == "__main__":
    sys.stdout.write(page())
