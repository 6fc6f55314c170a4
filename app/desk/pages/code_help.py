"""Code help of the editor and the MDI page.

The code help shows the meaning of a code and completions while the operator types.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.pages.guide_text import BlockKind, GuideBlock
from app.desk.translation import tr

if TYPE_CHECKING:
    from collections.abc import Sequence

    from core.language.code_book import CodeBook, CodeBookEntry


@dataclass(slots=True)
class CodeHelp:
    """Help for the program code at the cursor, with a list of codes that the operator can insert.

    - ``current_entry`` is the code at the cursor.
    - ``choices`` are the listed codes, and ``marked`` is the index of the selected choice.
    - ``start_column`` is the column where the typed part of the code begins, or 0 if a choice is inserted at
      the cursor.
    """

    current_entry: CodeBookEntry | None = None
    title: str = ""
    choices: tuple[CodeBookEntry, ...] = ()
    marked: int = 0
    start_column: int = 0
    _book: CodeBook | None = None
    _asked: tuple[str, int] = field(default=("", 0))

    def update_for_cursor(self, code_book: CodeBook | None, line: str, column: int) -> None:
        """Update the help for the cursor position.

        Without a code book, no code at the cursor is known.
        """
        if code_book is self._book and (line, column) == self._asked:
            return
        self._book, self._asked = code_book, (line, column)
        self.current_entry = None if code_book is None else code_book.at(line, column)

    def open_choices(self) -> bool:
        """List the completions of the typed text, or else the code book chapter of the code at the cursor.

        Returns False if no code book exists yet, because the first proof of the text is still in progress.
        """
        if self._book is None:
            return False
        begin, self.choices = self._book.find_completions(*self._asked)
        self.title, self.marked = "MATCHING CODES", 0
        written = self.current_entry is not None and any(
            each.head == self.current_entry.head for each in self.choices
        )
        typed = bool(self.choices)
        if not typed or (written and len(self.choices) == 1):
            self._show_chapter(self._book.find_chapter(self.current_entry))
        self.start_column = begin if typed else 0  # A complete code is replaced and not inserted twice.
        return True

    def _show_chapter(self, number: int) -> None:
        """List a chapter of the code book. Chapter numbers past the end start again at the first chapter."""
        assert self._book is not None  # The caller has checked that a book exists.
        self.title, self.choices = self._book.chapters[number % len(self._book.chapters)]
        self.marked = self.choices.index(self.current_entry) if self.current_entry in self.choices else 0
        self.start_column = 0

    def move_chapters(self, chapter_count: int) -> None:
        """Move forward by ``chapter_count`` chapters of the code book, or backward if it is negative."""
        if self._book is not None and self.choices:
            self._show_chapter(self._book.find_chapter(self.selected_entry) + chapter_count)

    def mark(self, index: int) -> None:
        """Select the choice with this index.

        An index outside the list selects the first or the last choice.
        """
        self.marked = max(0, min(len(self.choices) - 1, index))

    @property
    def words(self) -> tuple[tuple[str, str], ...]:
        """Return the address words of the selected code with their meanings."""
        chosen = self.selected_entry
        return self._book.list_word_meanings(chosen) if self._book is not None and chosen is not None else ()

    @property
    def selected_entry(self) -> CodeBookEntry | None:
        """Return the selected choice, or None if there are no choices."""
        return self.choices[self.marked] if self.choices else None


def make_code_blocks(code_book: CodeBook, entries: Sequence[CodeBookEntry]) -> tuple[GuideBlock, ...]:
    """Return the explanation of these codes, with their words and examples, as blocks of the help."""
    blocks: list[GuideBlock] = []
    for entry in entries:
        blocks.append(GuideBlock(BlockKind.HEADING, entry.form))
        blocks.append(GuideBlock(BlockKind.TEXT, tr(entry.what)))
        blocks += (
            GuideBlock(BlockKind.KEY, tr(what), word) for word, what in code_book.list_word_meanings(entry)
        )
        blocks += (GuideBlock(BlockKind.TEXT, line) for line in entry.example.splitlines())
    return tuple(blocks)
