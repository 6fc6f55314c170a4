"""What the parts of a program line are, for whoever colours a text."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

PLAIN = 0
"""The state that a line hands on to the next where nothing goes on."""


class Ink(StrEnum):
    """What a part of a line is."""

    NUMBER = "number"  # of the block
    CODE = "code"
    POSITION = "position"
    RUN = "run"  # feed and speed
    KEY = "key"
    CALL = "call"
    COMMENT = "comment"
    FAULT = "fault"


class Span(NamedTuple):
    """Some signs of a line: the first one's index from 0, and how many."""

    start: int
    length: int
    ink: Ink
