"""The retract of a tool: the situation of the tool, its position, and the moves that lead it out."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple


class ToolSituation(Enum):
    """Situation of a tool: clear of the part, or in the part, and how it can leave."""

    CLEAR = "clear"
    IN_PART = "work"
    IN_THREAD = "thread"
    IN_TAPPED_HOLE = "tap"
    MILLING = "mill"  # C is locked
    PART_TURNED = "turned"  # a mill in a part that has turned since
    UNKNOWN = "unknown"


class RetractLeg(NamedTuple):
    """A straight move of the tip to a point, in mm."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class Retract:
    """Retract of a tool. ``legs`` lead from its position out of the material; empty if clear or not known.

    ``direction`` is the direction in which the tool leaves in any case, as the signs of (x, z) of the first
    move; (0, 0) if unknown.
    """

    situation: ToolSituation
    legs: tuple[RetractLeg, ...] = ()
    direction: tuple[int, int] = (0, 0)

    @property
    def is_known(self) -> bool:
        """Whether the tool is clear, or its path out of the part is known."""
        return self.situation is ToolSituation.CLEAR or bool(self.legs)


class ToolPosition(NamedTuple):
    """Position in a program: at or within ``block_number``, with the tip of ``tool_number`` at (x, z)."""

    block_number: int
    tool_number: int
    x: float
    z: float
