"""The shape of a tool: its kind, hand, insert, holder and sizes, as a tool sheet states them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from core.tool_edges import TIP_DIRECTIONS


class ToolKind(StrEnum):
    """What a tool is for; it decides which of the sizes mean anything."""

    TURNING = "turning"
    BORING = "boring"
    GROOVING = "grooving"
    PARTING = "parting"
    THREADING = "threading"
    DRILL = "drill"
    CENTRE_DRILL = "centre-drill"
    REAMER = "reamer"
    TAP = "tap"
    END_MILL = "end-mill"
    FORM = "form"


class Hand(StrEnum):
    """A right-hand turning tool cuts towards the chuck, a left-hand one away from it."""

    RIGHT = "right"
    LEFT = "left"
    NEUTRAL = "neutral"


# Turning about their own axis: their control point is on it, at the very end.
ROUND_TOOLS = frozenset(
    {ToolKind.DRILL, ToolKind.CENTRE_DRILL, ToolKind.REAMER, ToolKind.TAP, ToolKind.END_MILL}
)

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class ToolShape:
    """One tool, mm and degrees; 0 or empty stands for "not stated", and a standard size is taken then.

    ``tip`` is the quadrant 0…9 in which the tip lies as seen from the nose centre; of a tool that turns
    about its own axis it says where its end points to: 7 (or 0) along the spindle towards the chuck, 8
    across it from the front, 6 from behind. ``insert`` is an ISO 1832 or ANSI B212.4 code. ``holder`` is a
    shank's size (``20x20``, ``3/4"``), a holder's code or any name. ``width`` is that of a groove.
    ``diameter`` is that of a round tool or of a boring bar. ``point`` is the included angle of a drill's
    point, of a centre drill or of a thread. ``length`` is what can cut: flutes of a drill, depth of a
    thread's flanks. ``stick_out`` ends the tool, beyond it stands what holds it. ``entry`` is the entering
    angle of the main edge; 0: that of the holder, or the usual one for the insert. ``rear``: the tool works
    at X negative. ``profile`` is a form tool's outline, (z, r) from the control point.
    """

    kind: ToolKind = ToolKind.TURNING
    hand: Hand = Hand.RIGHT
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
    def turns_itself(self) -> bool:
        """Whether the tool is round about its own axis: drill, centre drill, reamer, tap, end mill."""
        return self.kind in ROUND_TOOLS

    @property
    def internal(self) -> bool:
        """Whether it works in a bore on a bar: a boring tool, or a groove or thread tool on a bar."""
        on_a_bar = self.kind in {ToolKind.GROOVING, ToolKind.THREADING} and self.diameter > 0.0
        return self.kind is ToolKind.BORING or on_a_bar

    @property
    def behind(self) -> bool:
        """Whether it works at X negative: it says so, or its tip lies where only a tool behind has it."""
        across = TIP_DIRECTIONS[self.tip][1]
        return self.rear or (across != 0 and (across > 0) is not self.internal)

    @property
    def direction(self) -> tuple[int, int]:
        """Where the tip points, (z, x): by the quadrant, and without one by kind, hand and side."""
        if self.turns_itself and self.tip in {0, 9}:
            return (-1, 0)
        if self.tip not in {0, 9}:
            return TIP_DIRECTIONS[self.tip]
        across = 1 if self.internal is not self.rear else -1
        along = {Hand.RIGHT: -1, Hand.LEFT: 1, Hand.NEUTRAL: 0}[self.hand]
        return (along, across)
