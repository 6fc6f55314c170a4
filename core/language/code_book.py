"""The code book of a language: every code, word and cycle with its meaning, an example and a refusal.

The editor looks a word up in it and completes what is being typed; pages of
``docs`` are printed from it, and its examples and refusals are proved.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

_CLOSE = ("", ".", ":", "=", "(", ",")  # such words stand close behind their head
_NUMBER = re.compile(r"0*([0-9]+)")
_WORD_BEGIN = re.compile(r"(?<![A-Z_$])[A-Z_$]|(?<=[0-9 ])[A-Z]")
_NUMBERED = re.compile(r"(.*[A-Z ])0*([0-9]+)")  # a head that ends in a whole number
_NUMBER_BEHIND = r"\s*0*([0-9]+)"
_LETTERS_BEHIND = r"(?![A-Z_])"
_DIGITS_BEHIND = r"(?![0-9])"
_NO_LETTER_BEFORE = r"(?<![A-Z_$])"


@dataclass(frozen=True, slots=True)
class Entry:
    """One code as a programmer writes it: ``head``, and behind it ``words`` as the book shows them.

    ``example`` are lines that use it, between the book's ``head`` and ``tail`` or, where ``whole``, on their
    own; ``behind`` follows the end of the program, ``files`` are programs beside it, name and text.
    ``refused`` are lines in the place of the example that are no program, ``why`` a part of what is said.
    ``insert`` is what completion writes where that is more than the head.
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
        """The code with its words."""
        joined = self.words[:1] in _CLOSE or self.head[-1] in "=("
        return self.head + self.words if joined else f"{self.head} {self.words}"

    @property
    def written(self) -> str:
        """What completion writes."""
        return self.insert or self.head


@dataclass(frozen=True)
class CodeBook:
    """Chapters of entries; ``head`` and ``tail`` stand around every example.

    ``comment`` is the sign behind which no codes stand. ``meanings`` tells the words that stand behind codes,
    alone or behind one: ``G83.R``; ``named`` finds them.
    """

    chapters: tuple[tuple[str, tuple[Entry, ...]], ...]
    head: str
    tail: str
    comment: str
    meanings: Mapping[str, str] = field(default_factory=dict)
    named: str = r"[A-Z_][A-Z0-9_]*"

    def words_of(self, entry: Entry) -> tuple[tuple[str, str], ...]:
        """Each word behind a code with what it means, as far as the book tells it."""
        found = dict.fromkeys(re.findall(self.named, f"{entry.words} {entry.insert}".strip()))
        said = (
            (word, self.meanings.get(f"{entry.head}.{word}", self.meanings.get(word, ""))) for word in found
        )
        return tuple((word, what) for word, what in said if what)

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """All of them, in the order of the book."""
        return tuple(entry for _, entries in self.chapters for entry in entries)

    def at(self, line: str, column: int) -> Entry | None:
        """The code that the cursor stands on, else the nearest before it in the line, else the first of it.

        ``column`` counts from 1 and may be one behind the line. None in a comment and where nothing is known.
        """
        code = line.upper().split(self.comment, 1)[0]
        if column - 1 > len(code):
            return None
        found = sorted(self._found_in(code), key=lambda each: (each[0], each[0] - each[1]))
        before = [each for each in found if each[0] < column]
        return before[-1][2] if before else found[0][2] if found else None

    def _found_in(self, code: str) -> Iterator[tuple[int, int, Entry]]:
        """Begin, end and entry of each code of a line; of two that begin together the longer one."""
        longest: dict[int, tuple[int, Entry]] = {}
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
    def _patterns(self) -> tuple[tuple[re.Pattern[str], dict[str, Entry]], ...]:
        """Return a pattern for all heads that differ only in their number, and their entries by number."""
        families: dict[tuple[str, bool], dict[str, Entry]] = {}
        for entry in self.entries:
            numbered = _NUMBERED.fullmatch(entry.head)
            stem, number = numbered.groups() if numbered else (entry.head, "")
            families.setdefault((stem, bool(numbered)), {})[number] = entry
        return tuple((_pattern(*family), by_number) for family, by_number in families.items())

    def completions(self, line: str, column: int) -> tuple[int, tuple[Entry, ...]]:
        """What the words before the cursor may become, by the order of the book, and where they begin.

        The longest stretch that begins a code counts; none in a comment and behind a blank.
        """
        typed = line[: column - 1].upper()
        if self.comment in typed or not typed or typed[-1].isspace():
            return column, ()
        for match in _WORD_BEGIN.finditer(typed):
            found = self._beginning_with(typed[match.start() :])
            if found:
                return match.start() + 1, found
        return column, ()

    def _beginning_with(self, typed: str) -> tuple[Entry, ...]:
        written, wanted = " ".join(typed.split()), _plain(typed)
        return tuple(
            each
            for each, head in self._heads
            if head.startswith(wanted)
            or each.head.startswith(written)  # G4 begins G04 and G40, G0 begins G01
        )

    @cached_property
    def _heads(self) -> tuple[tuple[Entry, str], ...]:
        return tuple((each, _plain(each.head)) for each in self.entries)

    def chapter_of(self, entry: Entry | None) -> int:
        """Index of the chapter that an entry stands in; the first for None."""
        return next((n for n, (_, entries) in enumerate(self.chapters) if entry in entries), 0)

    def prepared(self) -> CodeBook:
        """The book, ready to be asked without delay: its patterns take some milliseconds to be made."""
        _ = self._patterns, self._heads
        return self


def _plain(written: str) -> str:
    """Codes as they are compared: capitals, one blank between words, no zeros before a number."""
    return _NUMBER.sub(r"\1", " ".join(written.upper().split()))


def _pattern(stem: str, numbered: bool) -> re.Pattern[str]:
    """Return what matches a code at any place in a line; its group is the number, empty without one."""
    words = r"\s*".join(map(re.escape, stem.split()))
    last = _DIGITS_BEHIND if stem[-1].isdigit() else _LETTERS_BEHIND if stem[-1].isalpha() else ""
    before = _NO_LETTER_BEFORE if stem[0].isalpha() else ""
    return re.compile(before + words + (_NUMBER_BEHIND if numbered else f"(){last}"))
