"""The code book of OmniTurn, from its code table."""

from __future__ import annotations

from core.interpreter.omniturn.code_entry import HEAD, TAIL, Code
from core.interpreter.omniturn.code_table import CHAPTERS
from core.language.code_book import CodeBook, Entry


def book() -> CodeBook:
    """Every entry of the table by its chapter."""
    chapters = tuple((title, tuple(map(_entry, codes))) for title, codes in CHAPTERS)
    return CodeBook(chapters, HEAD, TAIL, "(")


def _entry(code: Code) -> Entry:
    head = code.name.rstrip("()") or code.form
    words = code.form.removeprefix(head) if code.form.startswith(head) else code.form
    return Entry(head, words.strip(), code.what, code.example, behind=code.subroutine)
