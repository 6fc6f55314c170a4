"""What the search for a line answers: a good line with what it inherits, or why it is none."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from core.interpreter.begin import Checkpoint


@dataclass(frozen=True, slots=True)
class Clear:
    """How far off the part the program itself has been, machine mm; ``x`` by tool: least and greatest.

    ``stock`` is the largest radius, mm from the centre line, at which it has fed: the bar is hardly larger.
    """

    z: float = -math.inf
    stock: float = 0.0
    x: Mapping[int, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Found:
    """A good line, what it inherits, and how far off the part the program has been by then."""

    line: int
    checkpoint: Checkpoint
    clear: Clear
    inside: bool = False  # the tool works in a bore, so that the way in is along Z


@dataclass(frozen=True, slots=True)
class NotGood:
    """Why a program cannot go on from a line, and the nearest lines from which it can; 0: there is none."""

    line: int
    why: str
    before: int = 0
    after: int = 0
