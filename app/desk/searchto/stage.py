"""How far the operator is on the SEARCHTO page."""

from __future__ import annotations

from enum import Enum, auto


class Stage(Enum):
    """From choosing a line to a restart that the palms begin."""

    CHOOSE = auto()
    SEARCHING = auto()
    SHOWN = auto()  # a good line, with its plan
    REFUSED = auto()  # a line that is not good
    PROVING = auto()
    READY = auto()
