"""Limits of the values of cycles, so that each cycle ends."""

from __future__ import annotations

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.source_lines import SourceStatement, SourceWord

MAX_PASS_COUNT = 1000
MIN_INFEED_MM = 1e-6


def allow_letters(statement: SourceStatement, letters: str) -> None:
    """Raise ProgramError if a line contains a word with another letter, which would have no effect."""
    for word in statement.words:
        if word.letter not in letters:
            raise make_error(word.line_number, word.column, "code-unknown", word=word.text)


def require_words(statement: SourceStatement, code: SourceWord, letters: str) -> None:
    """Raise ProgramError if a line contains none of these letters."""
    if not any(statement.find_word(letter) for letter in letters):
        raise make_error(code.line_number, code.column, "cycle-word", word=" ".join(letters))


def require_positive(word: SourceWord, value: float) -> float:
    """Return the value of a cycle's word in mm. Raises ProgramError if it is not greater than zero."""
    if value < MIN_INFEED_MM:
        raise make_error(word.line_number, word.column, "cycle-positive", word=word.text)
    return value


def limit_pass_count(word: SourceWord, distance: float, infeed: float) -> None:
    """Raise ProgramError if a distance in mm needs more than MAX_PASS_COUNT passes of ``infeed`` mm."""
    if distance > infeed * MAX_PASS_COUNT:
        raise make_error(word.line_number, word.column, "too-many-passes", word=word.text)
