"""Kinds of line parts for syntax coloring."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

PLAIN = 0
"""The state that a line hands on to the next where nothing goes on."""


class Ink(StrEnum):
    """Kind of a part of a line, which determines its color."""

    NUMBER = "number"  # of the block
    CODE = "code"
    POSITION = "position"
    RUN = "run"  # feed and speed
    KEY = "key"
    CALL = "call"
    COMMENT = "comment"
    FAULT = "fault"


class Span(NamedTuple):
    """A range of characters in a line, with its kind. ``start`` counts from 0."""

    start: int
    length: int
    ink: Ink
