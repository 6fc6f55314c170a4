"""Limits of the values of cycles, so that each cycle ends."""

from __future__ import annotations

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.source_lines import SourceWord

MAX_PASS_COUNT = 1000
MIN_INFEED_MM = 1e-6


def require_positive(word: SourceWord, value: float) -> float:
    """Return the value of a cycle's word in mm. Raises ProgramError if it is not greater than zero."""
    if value < MIN_INFEED_MM:
        raise make_error(word.line_number, word.column, "cycle-positive", word=word.text)
    return value


def limit_pass_count(word: SourceWord, distance: float, infeed: float) -> None:
    """Raise ProgramError if a distance in mm needs more than MAX_PASS_COUNT passes of ``infeed`` mm."""
    if distance > infeed * MAX_PASS_COUNT:
        raise make_error(word.line_number, word.column, "too-many-passes", word=word.text)
