"""Generator of ``docs/language.md`` from the code table.

``python -m core.interpreter.omniturn.codes.language_page > docs/language.md`` writes the page.
"""

from __future__ import annotations

import re
import sys
from math import inf

from core.interpreter.omniturn.codes.code_entry import (
    EXAMPLE_HEAD,
    EXAMPLE_TAIL,
    CodeEntry,
    WordLimit,
    WordRule,
)
from core.interpreter.omniturn.codes.code_table import CODE_CHAPTERS
from core.language.omniturn.omniturn_words import VALUE_RANGES, WHOLE_NUMBER_LETTERS
from core.page_contents import make_table_of_contents

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


def render_language_reference() -> str:
    """Return the text of the page ``docs/language.md``."""
    anchors: set[str] = set()
    chapters = "".join(
        f"\n## {title}\n\n" + "".join(_anchor(code, anchors) + _entry(code) for code in codes)
        for title, codes in CODE_CHAPTERS
    )
    titles = make_table_of_contents(["Numbers", *(title for title, _ in CODE_CHAPTERS)])
    return _TOP.format(head=EXAMPLE_HEAD, tail=EXAMPLE_TAIL, numbers=_numbers(), contents=titles) + chapters


def _numbers() -> str:
    letters: dict[tuple[float, float, bool], list[str]] = {}
    for letter, (least, most) in VALUE_RANGES.items():
        letters.setdefault((least, most, letter in WHOLE_NUMBER_LETTERS), []).append(letter)
    rows = [
        f"| {' '.join(f'`{letter}`' for letter in those)} | {_shown(least)} | {_shown(most)}"
        f"{', whole number' if whole else ''} |\n"
        for (least, most, whole), those in letters.items()
    ]
    return "| word | minimum | maximum |\n|---|---|---|\n" + "".join(rows)


def _anchor(entry: CodeEntry, anchors: set[str]) -> str:
    """Return the HTML anchor of a code, such as ``#g75``, or an empty string.

    Only the first entry of a code has an anchor.
    """
    name = re.sub(r"[^a-z0-9]", "", entry.name.lower())
    if not name or name in anchors:
        return ""
    anchors.add(name)
    return f'<a id="{name}"></a>\n\n'


def _entry(entry: CodeEntry) -> str:
    lines = [
        *entry.example.splitlines(),
        *(["…", *entry.example_subroutine.splitlines()] if entry.example_subroutine else []),
    ]
    rules = "".join(f"- {line}\n" for line in _rules(entry))
    example = "```\n" + "\n".join(lines) + "\n```\n\n"
    return f"**`{entry.syntax}`** {entry.description}\n\n" + (f"{rules}\n" if rules else "") + example


def _rules(entry: CodeEntry) -> list[str]:
    """Return the rules of an entry as text.

    The rules are the limits of the words, the conditions that reject the code, and other findings.
    """
    rules = [f"`{letter}` {_rule(rule)}" for letter, rule in entry.word_rules.items()]
    if entry.required_words is not None:
        letters, refusal = entry.required_words
        rules.append(f"one of {_letters(letters)} is required: `{refusal.diagnostic_code}`")
    rules += [
        f"{_letters(letters)} must not be used together: `{refusal.diagnostic_code}`"
        for letters, refusal in entry.exclusive_words
    ]
    rules += [
        f"not allowed when {when.value}: `{refusal.diagnostic_code}`"
        for when, refusal in entry.rejection_conditions.items()
    ]
    if entry.other_diagnostic_codes:
        rules.append(
            "other findings: " + ", ".join(f"`{code}`" for code in sorted(entry.other_diagnostic_codes))
        )
    return rules


def _rule(rule: WordRule) -> str:
    said = [rule.description]
    if rule.missing_error is not None:
        said.append("required")
    if rule.unwanted_number_error is not None:
        said.append("must be written without a number")
    if rule.value_without_number is not None:
        said.append(f"{_shown(rule.value_without_number)} if no number follows")
    if rule.requires_nonzero:
        said.append("not 0")
    if rule.minimum > -inf:
        said.append(_range(rule))
    if rule.requires_whole_number:
        said.append("whole number")
    codes = dict.fromkeys(f"`{each.diagnostic_code}`" for each in rule.errors)
    return ", ".join(said) + (f": {', '.join(codes)}" if codes else "")


def _range(rule: WordRule) -> str:
    least, most = (
        _shown(rule.minimum),
        rule.maximum.value if isinstance(rule.maximum, WordLimit) else _shown(rule.maximum),
    )
    if rule.maximum == rule.minimum:
        return f"must be {least}"
    if rule.maximum == inf:
        return f"greater than {least}" if rule.excludes_minimum else f"{least} or more"
    return f"greater than {least}, at most {most}" if rule.excludes_minimum else f"{least} to {most}"


def _letters(letters: tuple[str, ...]) -> str:
    return ", ".join(f"`{letter}`" for letter in letters)


def _shown(value: float) -> str:
    return f"{value:,.6f}".rstrip("0").rstrip(".")


if __name__ == "__main__":
    sys.stdout.write(render_language_reference())
