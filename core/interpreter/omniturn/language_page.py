"""``docs/language.md`` from the code table.

``python -m core.interpreter.omniturn.language_page > docs/language.md`` writes it.
"""

from __future__ import annotations

import sys
from math import inf

from core.interpreter.omniturn.code_entry import HEAD, TAIL, Code, Limit, WordRule
from core.interpreter.omniturn.code_table import CHAPTERS
from core.language.omniturn.omniturn_words import COUNTING, RANGES

_TOP = """\
# The language, code by code

Written from the table that the tests prove, `core/interpreter/omniturn/code_table.py`.
Do not edit it by hand.
Every example stands between these lines, with every tool on part zero:

```
{head}…
{tail}```

M codes that are not here belong to the machine file. Behind a code stands what its words must be and when it
is refused, with the code of the diagnostic; the sentence itself says line, column and what to do.

## Numbers

In any unit a number lies between these; beside a code it may have to be nearer.

{numbers}"""


def page() -> str:
    """The text of ``docs/language.md``."""
    chapters = "".join(f"\n## {title}\n\n" + "".join(map(_entry, codes)) for title, codes in CHAPTERS)
    return _TOP.format(head=HEAD, tail=TAIL, numbers=_numbers()) + chapters


def _numbers() -> str:
    letters: dict[tuple[float, float, bool], list[str]] = {}
    for letter, (least, most) in RANGES.items():
        letters.setdefault((least, most, letter in COUNTING), []).append(letter)
    rows = [
        f"| {' '.join(f'`{letter}`' for letter in those)} | {_shown(least)} | {_shown(most)}"
        f"{', whole' if whole else ''} |\n"
        for (least, most, whole), those in letters.items()
    ]
    return "| word | least | most |\n|---|---|---|\n" + "".join(rows)


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
        rules.append(f"one of {_letters(letters)} stands there: `{refusal.code}`")
    rules += [f"not {_letters(letters)} together: `{refusal.code}`" for letters, refusal in entry.apart]
    rules += [f"not when {when.value}: `{refusal.code}`" for when, refusal in entry.not_when.items()]
    if entry.further:
        rules.append("also " + ", ".join(f"`{code}`" for code in sorted(entry.further)))
    return rules


def _rule(rule: WordRule) -> str:
    said = [rule.what]
    if rule.missing is not None:
        said.append("needed")
    if rule.numbered is not None:
        said.append("without a number")
    if rule.bare is not None:
        said.append(f"alone {_shown(rule.bare)}")
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
