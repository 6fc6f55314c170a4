"""``docs/language.md`` from the code table.

``python -m core.interpreter.omniturn.language_page > docs/language.md`` writes it.
"""

from __future__ import annotations

import sys

from core.interpreter.omniturn.code_table import CHAPTERS, HEAD, TAIL, Code

_TOP = """\
# The language, code by code

Written from the table that the tests prove, `core/interpreter/omniturn/code_table.py`.
Do not edit it by hand.
Every example stands between these lines, with every tool on part zero:

```
{head}…
{tail}```

M codes that are not here belong to the machine file. What each refusal means, it says itself: line, column,
code and what to do.
"""


def page() -> str:
    """The text of ``docs/language.md``."""
    chapters = "".join(f"\n## {title}\n\n" + "".join(map(_entry, codes)) for title, codes in CHAPTERS)
    return _TOP.format(head=HEAD, tail=TAIL) + chapters


def _entry(entry: Code) -> str:
    lines = [
        *entry.example.splitlines(),
        *(["…", *entry.subroutine.splitlines()] if entry.subroutine else []),
    ]
    return f"**`{entry.form}`** {entry.what}\n\n```\n" + "\n".join(lines) + "\n```\n\n"


if __name__ == "__main__":
    sys.stdout.write(page())
