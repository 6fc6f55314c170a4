"""Output of elementary blocks of SINUMERIK programs, in mm, degrees and minutes.

X is output as programmed, which may be a diameter.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.outputs.units import (
    Json,
    get_path_feed,
    make_common_block_json,
    round_degrees,
    round_millimeters,
    round_seconds,
)

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Block

TABLE_HEAD = (
    "    n  line  kind             X          Z          C        dC"
    "              feed      rpm       t  block\n"
)

_DEGREES_PER_REV = 360.0
_M_PER_MIN = 60.0 / 1000.0  # m/min for 1 mm/s


def make_block_json(block: Block, source_line: str, start_s: float, end_s: float) -> Json:
    """Return the JSON object of an elementary block, with the keys of docs/json.md.

    Keys that do not apply to the block are null.
    """
    arc, doubled = block.kind == "arc", 2.0 if block.modal.diameter else 1.0
    feed, mode = _feed_and_unit(block)
    return {
        **make_common_block_json(block, source_line),
        "units": "mm",
        "x": round_millimeters(block.x * doubled),
        "z": round_millimeters(block.z),
        "c": _round_angle(block.c, block),
        "mx": round_millimeters(block.mx),
        "mz": round_millimeters(block.mz),
        "mc": _round_angle(block.mc, block),
        "dc": round_degrees(block.c - block.c0),
        "cx": round_millimeters(block.cx * doubled) if arc else None,
        "cz": round_millimeters(block.cz) if arc else None,
        "dir": ("cw" if block.clockwise else "ccw") if arc else None,
        "feed": feed,
        "feed_mode": mode,
        "rpm": round(block.rpm, 6) + 0.0,
        "css": None if block.css is None else round(block.css * _M_PER_MIN, 6),
        "t0": round_seconds(start_s),
        "t1": round_seconds(end_s),
    }


def format_row(block: Block, start_s: float) -> str:
    """Return a block as a table row, with X as programmed and C in the program's coordinates."""
    feed, mode = _feed_and_unit(block)
    x = block.x * (2.0 if block.modal.diameter else 1.0)
    shown = "" if feed is None else f"{feed:.2f} {mode}"
    place = f"{x:10.3f} {block.z:10.3f} {_round_angle(block.c, block):10.3f}"
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{place}"
        f" {block.c - block.c0:+9.3f} {shown:>17s}{block.rpm:9.0f}{start_s:8.2f}  {block.text}\n"
    )


def _feed_and_unit(block: Block) -> tuple[float | None, str | None]:
    """Return the programmed feed of a block and its unit. For a rapid move, return the path speed."""
    if not block.moves:
        return None, None
    alone = (block.x, block.z) == (block.x0, block.z0) and block.c != block.c0
    unit = "deg" if alone and not block.modal.is_c_linear else "mm"
    return get_path_feed(block, unit)


def _round_angle(value: float, block: Block) -> float:
    """Return a rounded angle in degrees. For a modulo axis, the angle is at least 0 and less than 360."""
    angle = round_degrees(value)
    return (
        round_degrees(angle % _DEGREES_PER_REV) % _DEGREES_PER_REV if block.modal.is_c_axis_modulo else angle
    )
