"""Code help of the editor and the MDI page: the meaning of a code, and completions while typing."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from core.language.code_book import CodeBook, Entry


@dataclass(slots=True)
class CodeHelp:
    """Help for the code at the cursor, and a list of choices to insert.

    ``entry`` is the code at the cursor. ``choices`` are the listed codes, and ``marked`` is the index of the
    selected choice. ``begin`` is the column where the typed part of the code begins, or 0 if a choice is
    inserted at the cursor.
    """

    entry: Entry | None = None
    title: str = ""
    choices: tuple[Entry, ...] = ()
    marked: int = 0
    begin: int = 0
    _book: CodeBook | None = None
    _asked: tuple[str, int] = field(default=("", 0))

    def follow(self, book: CodeBook | None, line: str, column: int) -> None:
        """Update the help for the cursor position. Without a book, no code is known yet."""
        if book is self._book and (line, column) == self._asked:
            return
        self._book, self._asked = book, (line, column)
        self.entry = None if book is None else book.at(line, column)

    def ask(self) -> bool:
        """List the completions of the typed text, or else the chapter of the code at the cursor.

        Return False without a book, because the text is still being proved for the first time.
        """
        if self._book is None:
            return False
        begin, self.choices = self._book.completions(*self._asked)
        self.title, self.marked = "MATCHING CODES", 0
        written = self.entry is not None and any(each.head == self.entry.head for each in self.choices)
        typed = bool(self.choices)
        if not typed or (written and len(self.choices) == 1):
            self._chapter(self._book.chapter_of(self.entry))
        self.begin = begin if typed else 0  # A complete code is replaced and not inserted twice.
        return True

    def _chapter(self, number: int) -> None:
        """List a chapter of the book. Numbers past the end continue at the beginning."""
        assert self._book is not None  # The caller has checked that a book exists.
        self.title, self.choices = self._book.chapters[number % len(self._book.chapters)]
        self.marked = self.choices.index(self.entry) if self.entry in self.choices else 0
        self.begin = 0

    def turn(self, chapters: int) -> None:
        """Move by ``chapters`` chapters, forward or backward."""
        if self._book is not None and self.choices:
            self._chapter(self._book.chapter_of(self.chosen) + chapters)

    def mark(self, number: int) -> None:
        """Select another choice. Numbers outside the list select the first or the last choice."""
        self.marked = max(0, min(len(self.choices) - 1, number))

    @property
    def words(self) -> tuple[tuple[str, str], ...]:
        """The words of the selected choice with their meanings."""
        chosen = self.chosen
        return self._book.words_of(chosen) if self._book is not None and chosen is not None else ()

    @property
    def chosen(self) -> Entry | None:
        """The selected choice, or None if there are no choices."""
        return self.choices[self.marked] if self.choices else None
