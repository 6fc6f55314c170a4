"""Code help of editor and MDI: what the code at the cursor means, and what typing may become."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.language.code_book import CodeBook, Entry


@dataclass(slots=True)
class CodeHelp:
    """``entry`` is the code at the cursor; ``choices`` are looked through, one of them is ``marked``.

    ``begin`` is the column of what has been typed of it, 0 where a choice is written at the cursor.
    """

    entry: Entry | None = None
    title: str = ""
    choices: tuple[Entry, ...] = ()
    marked: int = 0
    begin: int = 0
    _book: CodeBook | None = None
    _asked: tuple[str, int] = field(default=("", 0))

    def follow(self, book: CodeBook | None, line: str, column: int) -> None:
        """The cursor stands here; without a book nothing is known yet."""
        if book is self._book and (line, column) == self._asked:
            return
        self._book, self._asked = book, (line, column)
        self.entry = None if book is None else book.at(line, column)

    def ask(self) -> bool:
        """Complete what has been typed, else look at the chapter of the code at the cursor.

        False without a book: the text is still being proved for the first time.
        """
        if self._book is None:
            return False
        begin, self.choices = self._book.completions(*self._asked)
        self.title, self.marked = "MATCHING CODES", 0
        written = self.entry is not None and any(each.head == self.entry.head for each in self.choices)
        typed = bool(self.choices)
        if not typed or (written and len(self.choices) == 1):
            self._chapter(self._book.chapter_of(self.entry))
        self.begin = begin if typed else 0  # what is written whole is replaced, not doubled
        return True

    def _chapter(self, number: int) -> None:
        """Look at a chapter of the book, round its end."""
        assert self._book is not None  # only what has been asked is looked through
        self.title, self.choices = self._book.chapters[number % len(self._book.chapters)]
        self.marked = self.choices.index(self.entry) if self.entry in self.choices else 0
        self.begin = 0

    def turn(self, chapters: int) -> None:
        """Look at the next chapter, or the one before."""
        if self._book is not None and self.choices:
            self._chapter(self._book.chapter_of(self.chosen) + chapters)

    def mark(self, number: int) -> None:
        """Mark another choice; the first and the last are the ends."""
        self.marked = max(0, min(len(self.choices) - 1, number))

    @property
    def words(self) -> tuple[tuple[str, str], ...]:
        """The words of the marked choice with what they mean."""
        chosen = self.chosen
        return self._book.words_of(chosen) if self._book is not None and chosen is not None else ()

    @property
    def chosen(self) -> Entry | None:
        """The marked choice."""
        return self.choices[self.marked] if self.choices else None
