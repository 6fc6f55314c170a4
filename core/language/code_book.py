"""Code book of a dialect, with the meaning and examples of each code, word and cycle.

The editor uses the code book to explain and complete words. Pages of ``docs`` are generated from it, and
tests check that its examples are accepted and its error examples are rejected.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

_ATTACHED_PREFIXES = ("", ".", ":", "=", "(", ",")  # These words follow the head without a blank.
_NUMBER = re.compile(r"0*([0-9]+)")
_WORD_BEGIN = re.compile(r"(?<![A-Z_$])[A-Z_$]|(?<=[0-9 ])[A-Z]")
_NUMBERED = re.compile(r"(.*[A-Z ])0*([0-9]+)")  # a head that ends in a whole number
_NUMBER_AFTER = r"\s*0*([0-9]+)"
_NO_LETTER_AFTER = r"(?![A-Z_])"
_NO_DIGIT_AFTER = r"(?![0-9])"
_NO_LETTER_BEFORE = r"(?<![A-Z_$])"


@dataclass(frozen=True, slots=True)
class CodeBookEntry:
    """One code of the code book: its ``head``, and the ``words`` that follow the head.

    - ``example`` contains lines that use the code. If ``whole`` is True, they are a complete program.
      Otherwise, they are inserted between ``head`` and ``lines_after_example`` of the book.
    - ``behind`` contains the lines after the program end.
    - ``files`` contains other programs in the same folder (name and text).
    - ``refused`` contains lines that cause an error when they replace the example.
    - ``why`` is part of the message of this error.
    - ``insert`` is the completion if it is longer than the head.
    """

    head: str
    words: str
    what: str
    example: str
    refused: str = ""
    why: str = ""
    behind: str = ""
    insert: str = ""
    whole: bool = False
    files: tuple[tuple[str, str], ...] = ()

    @property
    def form(self) -> str:
        """Return the code together with its words."""
        joined = self.words[:1] in _ATTACHED_PREFIXES or self.head[-1] in "=("
        return self.head + self.words if joined else f"{self.head} {self.words}"

    @property
    def written(self) -> str:
        """Return the text that completion inserts for this code."""
        return self.insert or self.head


@dataclass(frozen=True)
class CodeBook:
    """Code book of one dialect, with its entries in chapters.

    - ``head`` and ``lines_after_example`` are the lines before and after each example.
    - ``comment_sign`` is the character that starts a comment.
    - ``word_meanings`` explains the words of codes, either for all codes (``R``) or for one code
      (``G83.R``).
    - ``word_pattern`` is the pattern that finds these words.
    """

    chapters: tuple[tuple[str, tuple[CodeBookEntry, ...]], ...]
    head: str
    lines_after_example: str
    comment_sign: str
    word_meanings: Mapping[str, str] = field(default_factory=dict)
    word_pattern: str = r"[A-Z_][A-Z0-9_]*"

    def list_word_meanings(self, entry: CodeBookEntry) -> tuple[tuple[str, str], ...]:
        """Return the words that can follow a code, each with its meaning; unexplained words are omitted."""
        found = dict.fromkeys(re.findall(self.word_pattern, f"{entry.words} {entry.insert}".strip()))
        said = (
            (word, self.word_meanings.get(f"{entry.head}.{word}", self.word_meanings.get(word, "")))
            for word in found
        )
        return tuple((word, what) for word, what in said if what)

    @cached_property
    def entries(self) -> tuple[CodeBookEntry, ...]:
        """Return all entries in the order of the book."""
        return tuple(entry for _, entries in self.chapters for entry in entries)

    def at(self, line: str, column: int) -> CodeBookEntry | None:
        """Return the entry of the code at the cursor, or None if the line has no known code.

        If the cursor is not at a code, the result is the nearest code to its left or, if there is none, the
        first code in the line. ``column`` counts from 1 and may be one past the end of the line. Also
        returns None in a comment.
        """
        code = line.upper().split(self.comment_sign, 1)[0]
        if column - 1 > len(code):
            return None
        found = sorted(self._find_codes(code), key=lambda each: (each[0], each[0] - each[1]))
        before = [each for each in found if each[0] < column]
        return before[-1][2] if before else found[0][2] if found else None

    def list_codes(self, line: str) -> tuple[CodeBookEntry, ...]:
        """Return the entries of all codes in a line, from left to right, without those in a comment."""
        code = line.upper().split(self.comment_sign, 1)[0]
        return tuple(dict.fromkeys(entry for _start, _end, entry in self._find_codes(code)))

    def _find_codes(self, code: str) -> Iterator[tuple[int, int, CodeBookEntry]]:
        """Yield the start, end and entry of each code in a line.

        If two codes have the same start, the longer code is used.
        """
        longest: dict[int, tuple[int, CodeBookEntry]] = {}
        for pattern, by_number in self._patterns:
            for match in pattern.finditer(code):
                entry = by_number.get(match[1])
                if entry and match.end() > longest.get(match.start(), (0, entry))[0]:
                    longest[match.start()] = match.end(), entry
        reached = 0
        for start in sorted(longest):
            end, entry = longest[start]
            if start >= reached:
                yield start, end, entry
                reached = end

    @cached_property
    def _patterns(self) -> tuple[tuple[re.Pattern[str], dict[str, CodeBookEntry]], ...]:
        """Return a pattern for each group of codes that differ only in their number, such as G0 and G1.

        Each pattern is paired with the entries of its group, by number.
        """
        families: dict[tuple[str, bool], dict[str, CodeBookEntry]] = {}
        for entry in self.entries:
            numbered = _NUMBERED.fullmatch(entry.head)
            stem, number = numbered.groups() if numbered else (entry.head, "")
            families.setdefault((stem, bool(numbered)), {})[number] = entry
        return tuple((_pattern(*family), by_number) for family, by_number in families.items())

    def find_completions(self, line: str, column: int) -> tuple[int, tuple[CodeBookEntry, ...]]:
        """Return the column where the incomplete code starts, and the entries that can complete the code.

        The entries are in book order. The incomplete code is the longest text before the cursor that
        matches the start of a code. In a comment or after a blank, the result has no entries.
        """
        typed = line[: column - 1].upper()
        if self.comment_sign in typed or not typed or typed[-1].isspace():
            return column, ()
        for match in _WORD_BEGIN.finditer(typed):
            found = self._beginning_with(typed[match.start() :])
            if found:
                return match.start() + 1, found
        return column, ()

    def _beginning_with(self, typed: str) -> tuple[CodeBookEntry, ...]:
        written, wanted = " ".join(typed.split()), _normalize(typed)
        return tuple(
            each
            for each, head in self._heads
            if head.startswith(wanted)
            or each.head.startswith(written)  # G4 begins G04 and G40, G0 begins G01
        )

    @cached_property
    def _heads(self) -> tuple[tuple[CodeBookEntry, str], ...]:
        return tuple((each, _normalize(each.head)) for each in self.entries)

    def find_chapter(self, entry: CodeBookEntry | None) -> int:
        """Return the index of the chapter that contains an entry, or 0 if no chapter contains it."""
        return next((n for n, (_, entries) in enumerate(self.chapters) if entry in entries), 0)

    def compile_patterns(self) -> CodeBook:
        """Compile the patterns of the book, which takes some milliseconds, and return the book."""
        _ = self._patterns, self._heads
        return self


def _normalize(written: str) -> str:
    """Return a code in normal form: in capitals, with single blanks, and without leading zeros in numbers."""
    return _NUMBER.sub(r"\1", " ".join(written.upper().split()))


def _pattern(stem: str, numbered: bool) -> re.Pattern[str]:
    """Return a pattern that finds a code in a line; its group is the number or an empty string."""
    words = r"\s*".join(map(re.escape, stem.split()))
    last = _NO_DIGIT_AFTER if stem[-1].isdigit() else _NO_LETTER_AFTER if stem[-1].isalpha() else ""
    before = _NO_LETTER_BEFORE if stem[0].isalpha() else ""
    return re.compile(before + words + (_NUMBER_AFTER if numbered else f"(){last}"))
