"""Elementary blocks of OmniTurn programs as the commands show them: inches and minutes."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from app.cli.figures import (
    MM_PER_INCH,
    MM_S_PER_FT_MIN,
    Json,
    block_head,
    degrees,
    inches,
    per_minute,
    seconds,
)

if TYPE_CHECKING:
    from core.interpreter.elementary_blocks import Block, Floats, TimedSeries

_SURE = 1e12  # a number of steps up to which it is a whole one, with digits to spare
_HALF = 1e-3  # nearer than that to the half of a step it is rounded by its decimals
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
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{inches(block.x):11.5f}{inches(block.z):11.5f}"
        f"{_feed(block)}{t0:8.2f}  {block.text}\n"
    )


def _feed(block: Block) -> str:
    """Feed and speed in the table."""
    feed = f"{inches(block.feed):.5f}/r" if block.per_rev else f"{per_minute(block.feed):.2f}/m"
    return f"{feed:>13s}{block.rpm:9.0f}"


# --- many moves at once, to the letter as one by one ------------------------------------------------------


def series_rows(moves: TimedSeries) -> str:
    """The lines of the table."""
    series, like = moves.series, moves.series.pattern
    line = f"%5d %5d  {like.kind:10s}%11.5f%11.5f{_feed(like)}%8.2f  %s\n"
    lines = series.line.tolist()
    texts = (series.texts[each - 1] for each in lines)
    columns = (series.n.tolist(), lines, _inches(series.x), _inches(series.z), moves.t0.tolist(), texts)
    return "".join([line % each for each in zip(*columns, strict=True)])


def series_json(moves: TimedSeries) -> str:
    """The objects, a line each."""
    series, like, lines = moves.series, moves.series.pattern, moves.series.line.tolist()
    texts = [json.dumps(series.texts[each - 1]) for each in lines]  # a plain move's text is its line
    columns = {
        "n": series.n.tolist(),
        "line": lines,
        "source": texts,
        "text": texts,
        "x": _inches(series.x),
        "z": _inches(series.z),
        "mx": _inches(series.x + like.offset_x),
        "mz": _inches(series.z + like.offset_z),
        "t0": rounded(moves.t0, 6),
        "t1": rounded(moves.t1, 6),
    }
    same = {
        key: json.dumps(value).replace("%", "%%") for key, value in block_json(like, "", 0.0, 0.0).items()
    }
    each = ", ".join(f'"{key}": {"%s" if key in columns else value}' for key, value in same.items())
    line = f"{{{each}}}\n"
    return "".join(
        [line % row for row in zip(*(columns[key] for key in same if key in columns), strict=True)]
    )


def _inches(mm: Floats) -> list[float]:
    return rounded(mm / MM_PER_INCH, 9)


def rounded(values: Floats, places: int) -> list[float]:
    """As ``round(value, places) + 0.0`` rounds each of them, (m,)."""
    steps = values * 10.0**places
    whole = np.rint(steps)
    found = whole / 10.0**places + 0.0
    for at in np.flatnonzero(
        (np.abs(np.abs(steps - whole) - 0.5) < _HALF) | ~(np.abs(steps) < _SURE)
    ).tolist():
        found[at] = round(float(values[at]), places) + 0.0
    as_list: list[float] = found.tolist()
    return as_list


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
