"""Blocks as lines of the controller's g-code: mm, radius, plane G18, absolute, feed per minute."""

from __future__ import annotations

from core.block_port import ArcOp, BlockOp, LineOp, RapidOp, ThreadOp

_LAST_NUMBER = 9_000_000


def number(value: float) -> str:
    """Five decimals of a millimetre are a tenth of the finest step; no more zeros than needed."""
    text = f"{value:.5f}".rstrip("0").rstrip(".")
    return "0" if text in {"-0", ""} else text


def line_number(ticket: int) -> int:
    """The N word of a ticket."""
    return (ticket - 1) % _LAST_NUMBER + 1


def line_of(op: BlockOp, ticket: int, rapid: float, feed_override: float) -> str:
    """The line of one block. ``rapid`` is the speed of G0 (mm/s), ``feed_override`` a fraction.

    A rapid slower than G0 goes out as a feed: the controller's rapid override knows three steps only. A feed
    override above 1 speeds up no rapid.
    """
    head = f"N{line_number(ticket)}"
    to = f"X{number(op.x)}Z{number(op.z)}"
    match op:
        case RapidOp(rate=rate) if rate >= rapid * (1.0 - 1e-6):
            return f"{head}G0{to}"
        case RapidOp(rate=rate):
            return f"{head}G1{to}{_feed(rate / max(feed_override, 1.0))}"
        case LineOp(feed=feed):
            return f"{head}G1{to}{_feed(feed)}"
        case ThreadOp(lead=lead):
            return f"{head}G33{to}K{number(lead)}"
        case ArcOp():
            # Counted from Z+ to X+, which in the plane G18 is counter-clockwise.
            way = "G3" if op.clockwise else "G2"
            return f"{head}{way}{to}I{number(op.cx - op.x0)}K{number(op.cz - op.z0)}{_feed(op.feed)}"


def jog_line(letter: str, target: float, speed: float) -> str:
    """An absolute jog in machine coordinates."""
    return f"$J=G53G21G90{letter}{number(target)}{_feed(speed)}"


def _feed(speed: float) -> str:
    return f"F{number(60.0 * speed)}"
