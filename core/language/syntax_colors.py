"""Kinds of text spans for syntax coloring."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

PLAIN_STATE = 0
"""State that a line passes to the next line if no block or comment continues."""


class SyntaxKind(StrEnum):
    """Kind of a span of a line, which determines the color of the span."""

    NUMBER = "number"  # of the block
    CODE = "code"
    POSITION = "position"
    FEED_AND_SPEED = "run"  # feed and speed
    KEYWORD = "key"
    CALL = "call"
    COMMENT = "comment"
    ERROR = "fault"


class ColoredSpan(NamedTuple):
    """A range of characters in a line with its kind; ``start`` counts from 0."""

    start: int
    length: int
    kind: SyntaxKind
