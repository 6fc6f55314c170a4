"""The retract of a tool: the situation of the tool, its position, and the moves that lead it out."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple


class ToolSituation(Enum):
    """Situation of a tool relative to the part.

    A tool is either clear of the part or in it. In the part, the situation determines how the tool can
    leave.
    """

    CLEAR = "clear"
    IN_PART = "work"
    IN_THREAD = "thread"
    IN_TAPPED_HOLE = "tap"
    MILLING = "mill"  # C is locked
    PART_TURNED = "turned"  # a mill in a part that has turned since
    UNKNOWN = "unknown"


class RetractLeg(NamedTuple):
    """The end point of a straight move of the tip, in mm."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class Retract:
    """The retract of a tool.

    ``legs`` lead from the tool position out of the material. They are empty if the tool is clear or the
    path is unknown. ``direction`` contains the signs of (x, z) of the first move. It may be known even if
    ``legs`` is empty, and is (0, 0) if it is unknown.
    """

    tool_situation: ToolSituation
    legs: tuple[RetractLeg, ...] = ()
    direction: tuple[int, int] = (0, 0)

    @property
    def is_known(self) -> bool:
        """Return whether the tool is clear or its path out of the part is known."""
        return self.tool_situation is ToolSituation.CLEAR or bool(self.legs)


class ToolPosition(NamedTuple):
    """Position of the tool tip in a program, at (x, z) in mm.

    The position is at the end of ``block_number`` or within this block.
    """

    block_number: int
    tool_number: int
    x: float
    z: float
