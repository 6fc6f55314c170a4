"""The shape of a tool: its kind, hand, insert, holder and dimensions, as on a setup sheet."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from core.tool_edges import TIP_DIRECTIONS


class ToolKind(StrEnum):
    """The kind of a tool, such as a turning tool or a drill, which determines its dimensions."""

    TURNING = "turning"
    BORING = "boring"
    GROOVING = "grooving"
    PARTING = "parting"
    THREADING = "threading"
    DRILL = "drill"
    CENTER_DRILL = "centre-drill"
    REAMER = "reamer"
    TAP = "tap"
    END_MILL = "end-mill"
    FORM = "form"


class ToolHand(StrEnum):
    """The hand of a tool.

    A right-hand turning tool cuts toward the chuck, and a left-hand tool cuts away from it.
    """

    RIGHT = "right"
    LEFT = "left"
    NEUTRAL = "neutral"


# Rotating tools, whose control point is on their axis at the end.
ROUND_TOOLS = frozenset(
    {ToolKind.DRILL, ToolKind.CENTER_DRILL, ToolKind.REAMER, ToolKind.TAP, ToolKind.END_MILL}
)

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class ToolShape:
    """The shape of one tool, in mm and degrees; for 0 or an empty string, a standard size is used.

    - ``tip`` is the quadrant 0 to 9 of the tip as seen from the nose center. For a rotating tool, it is
      the direction of the tool end: 7 (or 0) along the spindle toward the chuck, 8 or 6 across the
      spindle from the front or rear.
    - ``insert`` is an ISO 1832 or ANSI B212.4 code.
    - ``holder`` is a shank size (``20x20``, ``3/4"``), a holder code or any name.
    - ``width`` is the width of a groove, and ``diameter`` that of a round tool or a boring bar.
    - ``point`` is the included angle of a thread, or of the point of a drill or center drill.
    - ``length`` is the cutting length: the flutes of a drill, or the depth of thread flanks.
    - ``stick_out`` is the length up to the clamping.
    - ``entry`` is the entering angle of the main edge; 0 means the angle of the holder or the usual angle
      of the insert.
    - ``rear`` means that the tool works at negative X.
    - ``profile`` is the outline of a form tool, as points (z, r) from the control point.
    """

    kind: ToolKind = ToolKind.TURNING
    hand: ToolHand = ToolHand.RIGHT
    tip: int = 0
    nose_radius: float = 0.0
    insert: str = ""
    holder: str = ""
    width: float = 0.0
    diameter: float = 0.0
    point: float = 0.0
    stick_out: float = 0.0
    length: float = 0.0
    pitch: float = 0.0
    flutes: int = 0
    entry: float = 0.0
    rear: bool = False
    profile: tuple[Point, ...] = ()

    @property
    def is_rotating(self) -> bool:
        """Return whether the tool rotates: a drill, center drill, reamer, tap or end mill."""
        return self.kind in ROUND_TOOLS

    @property
    def internal(self) -> bool:
        """Return whether the tool works in a bore.

        This applies to boring tools, and to grooving and threading tools on a boring bar with a diameter.
        """
        on_a_bar = self.kind in {ToolKind.GROOVING, ToolKind.THREADING} and self.diameter > 0.0
        return self.kind is ToolKind.BORING or on_a_bar

    @property
    def is_rear_tool(self) -> bool:
        """Return whether the tool works at negative X, as specified or as its tip quadrant implies."""
        across = TIP_DIRECTIONS[self.tip][1]
        return self.rear or (across != 0 and (across > 0) is not self.internal)

    @property
    def direction(self) -> tuple[int, int]:
        """Return the direction of the tip as (z, x).

        The direction follows from the quadrant or, without a quadrant, from the kind, hand and side of the
        tool.
        """
        if self.is_rotating and self.tip in {0, 9}:
            return (-1, 0)
        if self.tip not in {0, 9}:
            return TIP_DIRECTIONS[self.tip]
        across = 1 if self.internal is not self.rear else -1
        along = {ToolHand.RIGHT: -1, ToolHand.LEFT: 1, ToolHand.NEUTRAL: 0}[self.hand]
        return (along, across)
