"""Output of elementary blocks of SINUMERIK programs in mm, degrees and minutes, with X as programmed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.figures.units import Json, block_head, degrees, millimetres, path_feed, seconds

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Block

HEAD = (
    "    n  line  kind             X          Z          C        dC"
    "              feed      rpm       t  block\n"
)

_TURN = 360.0
_M_PER_MIN = 60.0 / 1000.0  # m/min for 1 mm/s


def block_json(block: Block, source_line: str, t0: float, t1: float) -> Json:
    """Return an elementary block with the keys of docs/json.md; keys that do not apply are null."""
    arc, doubled = block.kind == "arc", 2.0 if block.modal.diameter else 1.0
    feed, mode = _feed(block)
    return {
        **block_head(block, source_line),
        "units": "mm",
        "x": millimetres(block.x * doubled),
        "z": millimetres(block.z),
        "c": _angle(block.c, block),
        "mx": millimetres(block.mx),
        "mz": millimetres(block.mz),
        "mc": _angle(block.mc, block),
        "dc": degrees(block.c - block.c0),
        "cx": millimetres(block.cx * doubled) if arc else None,
        "cz": millimetres(block.cz) if arc else None,
        "dir": ("cw" if block.clockwise else "ccw") if arc else None,
        "feed": feed,
        "feed_mode": mode,
        "rpm": round(block.rpm, 6) + 0.0,
        "css": None if block.css is None else round(block.css * _M_PER_MIN, 6),
        "t0": seconds(t0),
        "t1": seconds(t1),
    }


def row(block: Block, t0: float) -> str:
    """Return a block as a line of the table, with X as programmed and C of the program."""
    feed, mode = _feed(block)
    x = block.x * (2.0 if block.modal.diameter else 1.0)
    shown = "" if feed is None else f"{feed:.2f} {mode}"
    place = f"{x:10.3f} {block.z:10.3f} {_angle(block.c, block):10.3f}"
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{place}"
        f" {block.c - block.c0:+9.3f} {shown:>17s}{block.rpm:9.0f}{t0:8.2f}  {block.text}\n"
    )


def _feed(block: Block) -> tuple[float | None, str | None]:
    """Return the programmed feed and its unit; for a rapid, the speed along its path."""
    if not block.moves:
        return None, None
    alone = (block.x, block.z) == (block.x0, block.z0) and block.c != block.c0
    unit = "deg" if alone and not block.modal.linear_c else "mm"
    return path_feed(block, unit)


def _angle(value: float, block: Block) -> float:
    """Return an angle in degrees; for a modulo axis from 0 to less than 360."""
    angle = degrees(value)
    return degrees(angle % _TURN) % _TURN if block.modal.wraps_c else angle
