"""Elementary blocks of OmniTurn programs as the commands show them: inches and minutes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.figures import MM_S_PER_FT_MIN, Json, block_head, degrees, inches, per_minute, seconds

if TYPE_CHECKING:
    from core.interpreter.elementary_blocks import Block

HEAD = "    n  line  kind        X radius          Z         feed      rpm       t  block\n"


def block_json(block: Block, source_line: str, t0: float, t1: float) -> Json:
    """One elementary block with the keys and units of interfaces.md; keys that do not apply are null."""
    arc = block.kind == "arc"
    circular = arc or block.kind == "plane-arc"
    turned = block.kind == "rotate"  # its speed is rpm
    feed = per_minute(block.feed) if not block.per_rev else inches(block.feed)
    return {
        **block_head(block, source_line),
        "x": inches(block.x),
        "z": inches(block.z),
        "c": degrees(block.c),
        "mx": inches(block.mx),
        "mz": inches(block.mz),
        "cx": inches(block.cx) if arc else None,
        "cz": inches(block.cz) if arc else None,
        "dir": ("cw" if block.clockwise else "ccw") if circular else None,
        **_plane_json(block),
        "feed": None if turned else feed,
        "feed_mode": None if turned else "ipr" if block.per_rev else "ipm",
        "rpm": round(block.rpm, 6) + 0.0,
        "css": None if block.css is None else round(block.css / MM_S_PER_FT_MIN, 6),
        "t0": seconds(t0),
        "t1": seconds(t1),
    }


def row(block: Block, t0: float) -> str:
    """One line of the table for a person."""
    feed = f"{inches(block.feed):.5f}/r" if block.per_rev else f"{per_minute(block.feed):.2f}/m"
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{inches(block.x):11.5f}{inches(block.z):11.5f}"
        f"{feed:>13s}{block.rpm:9.0f}{t0:8.2f}  {block.text}\n"
    )


def _plane_json(block: Block) -> Json:
    """End and centre of a block in the virtual mill's frame; on the side of the part its Z is a diameter."""
    way = block.plane
    if way is None:
        return dict.fromkeys(("px", "py", "pz", "pcx", "pcy"))
    x, y, z = way.end
    return {
        "px": inches(x),
        "py": inches(y),
        "pz": inches(2 * z if way.on_side else z),
        "pcx": None if way.centre is None else inches(way.centre[0]),
        "pcy": None if way.centre is None else inches(way.centre[1]),
    }
