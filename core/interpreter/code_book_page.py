"""``docs/klartext-codes.md`` and ``docs/sinumerik-codes.md`` from the code books.

``python -m core.interpreter.code_book_page klartext > docs/klartext-codes.md`` writes one.
"""

from __future__ import annotations

import sys

from core.interpreter.dialects import NAMES, code_book
from core.language.code_book import CodeBook, Entry
from core.language.source import Dialect

_TOP = """\
# {name}, code by code

Written from the code book that the tests prove, `core/language/{dialect}/{dialect}_book.py`.
Do not edit it by hand. Under every code stand lines that use it and, where there are such, lines that are
refused with a part of what is said.

"""


def page(dialect: Dialect) -> str:
    """The text of the page."""
    book = code_book(dialect)
    chapters = "".join(
        f"\n## {title}\n\n" + "".join(map(_entry, entries)) for title, entries in book.chapters
    )
    return _TOP.format(name=NAMES[dialect], dialect=dialect) + _frame(book) + _words(book) + chapters


def _frame(book: CodeBook) -> str:
    return f"Every example stands between these lines:\n\n```\n{book.head}…\n{book.tail}```\n"


def _words(book: CodeBook) -> str:
    """What stands behind the codes, which the screen shows beside each."""
    rows = "".join(f"| `{word}` | {what} |\n" for word, what in book.meanings.items())
    return f"\n## Words of cycles\n\n| word | means |\n|---|---|\n{rows}" if rows else ""


def _entry(entry: Entry) -> str:
    lines = [*entry.example.splitlines(), *(["…", *entry.behind.splitlines()] if entry.behind else [])]
    example = "```\n" + "\n".join(lines) + "\n```\n" if lines else ""
    refused = " / ".join(entry.refused.splitlines())
    says = f"Refused, “{entry.why}”: `{refused}`\n\n" if entry.refused else ""
    return f"**`{entry.form}`** {entry.what}\n\n{example}\n{says}"


if __name__ == "__main__":
    sys.stdout.write(page(Dialect(sys.argv[1])))
