"""Blocks as lines of the controller's g-code: mm, radius, plane G18, absolute, feed per minute."""

from __future__ import annotations

import math
from collections.abc import Mapping

from core.ports import ArcOp, BlockOp, LineOp, RapidOp, ThreadOp

_LAST_NUMBER = 9_000_000
_DOT = 0.002  # mm; see ``_arc``
_SAME = 1.01  # rapids that differ by so much are one


def number(value: float) -> str:
    """Five decimals of a millimetre are a tenth of the finest step; no more zeros than needed."""
    text = f"{value:.5f}".rstrip("0").rstrip(".")
    return "0" if text in {"-0", ""} else text


def line_number(ticket: int) -> int:
    """The N word of a ticket."""
    return (ticket - 1) % _LAST_NUMBER + 1


def line_of(
    op: BlockOp, ticket: int, rapid: float, feed_override: float, origin: Mapping[str, float] | None = None
) -> str:
    """The line of one block. ``rapid`` is what G0 does on this way (mm/s), ``feed_override`` a fraction.

    A rapid slower than G0 goes out as a feed: the controller's rapid override knows three steps only. A feed
    override above 1 speeds up no rapid. ``origin`` is where home lies in the controller's own frame.
    """
    head = f"N{line_number(ticket)}"
    home = origin or {}
    to = f"X{number(op.x + home.get('X', 0.0))}Z{number(op.z + home.get('Z', 0.0))}"
    match op:
        case RapidOp(rate=rate) if _SAME * rate >= rapid:
            return f"{head}G0{to}"
        case RapidOp(rate=rate):
            return f"{head}G1{to}{_feed(rate / max(feed_override, 1.0))}"
        case LineOp(feed=feed):
            return f"{head}G1{to}{_feed(feed)}"
        case ThreadOp():
            return f"{head}G33{to}K{number(_pitch(op))}"
        case ArcOp():
            return f"{head}{_arc(op)}{to}{_centre(op)}{_feed(op.feed)}"


def jog_line(letter: str, target: float, speed: float) -> str:
    """An absolute jog in machine coordinates."""
    return f"$J=G53G21G90{letter}{number(target)}{_feed(speed)}"


def _arc(op: ArcOp) -> str:
    """G2, G3, or G1 for a dot of an arc.

    The angle counts from the plane's first axis Z to its second, X; the word is that of the way in which it
    grows: G3 from Z+ to X+. An arc whose angle rounds to nothing, or to less, is a whole circle over there.
    """
    if _dot(op):
        return "G1"
    return "G3" if op.clockwise else "G2"


def _dot(op: ArcOp) -> bool:
    """Whether both ends are as good as one, and the arc is less than half a turn."""
    if math.hypot(op.x - op.x0, op.z - op.z0) >= _DOT:
        return False
    turned = (op.z0 - op.cz) * (op.x - op.cx) - (op.x0 - op.cx) * (op.z - op.cz)  # sign as from Z+ to X+
    return turned > 0.0 if op.clockwise else turned < 0.0


def _centre(op: ArcOp) -> str:
    """From the start, and a radius in G7 too."""
    return "" if _dot(op) else f"I{number(op.cx - op.x0)}K{number(op.cz - op.z0)}"


def _pitch(op: ThreadOp) -> float:
    """Along the way, as its K counts (``stepper.c`` compares angle times programmed rate with millimetres of
    the block): a tapered thread goes further than its lead.
    """
    along = abs(op.z - op.z0)
    return op.lead * math.hypot(op.x - op.x0, along) / along if along else op.lead


def _feed(speed: float) -> str:
    return f"F{number(60.0 * speed)}"
