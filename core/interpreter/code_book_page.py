"""Generator of the pages ``docs/klartext-codes.md`` and ``docs/sinumerik-codes.md``.

The pages are generated from the code books. For example, ``python -m core.interpreter.code_book_page
klartext > docs/klartext-codes.md`` writes the Klartext page.
"""

from __future__ import annotations

import sys

from core.interpreter.dialects import DIALECT_NAMES, get_code_book
from core.language.code_book import CodeBook, CodeBookEntry
from core.language.source import Dialect
from core.page_contents import make_table_of_contents

_TOP = """\
# {name}, code by code

This page is the reference of all {name} codes. For an introduction, see
[programming/{dialect}.md](programming/{dialect}.md).

{contents}
It is written from `core/language/code_books/{dialect}`, which the tests use. Do not edit it.
Each code has an example. "Rejected" gives an example that is rejected, with a part of the message.

"""


def render_code_book(dialect: Dialect) -> str:
    """Return the reference page of a dialect as Markdown text."""
    book = get_code_book(dialect)
    chapters = "".join(
        f"\n## {title}\n\n" + "".join(map(_entry, entries)) for title, entries in book.chapters
    )
    titles = [*(["Cycle parameters"] if book.word_meanings else []), *(title for title, _ in book.chapters)]
    top = _TOP.format(name=DIALECT_NAMES[dialect], dialect=dialect, contents=make_table_of_contents(titles))
    return top + _frame(book) + _parameter_table(book) + chapters


def _frame(book: CodeBook) -> str:
    return f"Every example goes between these lines:\n\n```\n{book.head}…\n{book.lines_after_example}```\n"


def _parameter_table(book: CodeBook) -> str:
    """Return the table of cycle parameters, or an empty string if the dialect has none."""
    rows = "".join(f"| `{word}` | {what} |\n" for word, what in book.word_meanings.items())
    return f"\n## Cycle parameters\n\n| word | means |\n|---|---|\n{rows}" if rows else ""


def _entry(entry: CodeBookEntry) -> str:
    lines = [*entry.example.splitlines(), *(["…", *entry.behind.splitlines()] if entry.behind else [])]
    example = "```\n" + "\n".join(lines) + "\n```\n" if lines else ""
    refused = " / ".join(entry.refused.splitlines())
    says = f"Rejected with “{entry.why}”: `{refused}`\n\n" if entry.refused else ""
    return f"**`{entry.form}`** {entry.what}\n\n{example}\n{says}"


if __name__ == "__main__":
    sys.stdout.write(render_code_book(Dialect(sys.argv[1])))
