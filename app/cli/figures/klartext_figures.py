"""Output of elementary blocks of Klartext programs, in mm, degrees and minutes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.cli.figures.units import Json, block_head, degrees, millimetres, path_feed, seconds

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Block
    from core.interpreter.shared.working_plane import Swivel
    from core.proving.proof_report import MillFigures, Report

HEAD = (
    "    n  line  kind           X          Y          Z         A        B        C"
    "          feed      rpm       t  block\n"
)
_PER_MINUTE = 60.0
_AXES = ("a", "b", "c")


def block_json(block: Block, source_line: str, t0: float, t1: float) -> Json:
    """Return an elementary block with the keys of docs/json.md; missing axes are null."""
    feed, mode = _feed(block)
    swivel = block.swivel
    shown = {
        **block_head(block, source_line),
        "units": "mm",
        **({} if swivel is None else _places(swivel)),
        "feed": feed,
        "feed_mode": mode,
        "rpm": round(block.rpm, 6) + 0.0,
        "t0": seconds(t0),
        "t1": seconds(t1),
    }
    return shown | _plane(swivel) if block.kind == "plane" and swivel is not None else shown


def figures(report: Report, mill: MillFigures) -> Json:
    """Return the JSON keys of a proof that differ on a mill.

    ``limits`` are machine positions, and ``final`` has all axes.
    """
    limits: Json = {
        name.lower(): [millimetres(low), millimetres(high)]
        for name, (low, high) in zip(mill.axes, mill.reach, strict=False)
    }
    limits["rpm"] = [round(rpm, 3) for rpm in report.reach.rpm]
    limits["feed_mm_min"] = [round(speed * _PER_MINUTE, 6) for speed in report.reach.feed]
    return {"limits": limits, "final": {} if mill.final is None else _places(mill.final)}


def machine_reach(mill: MillFigures) -> str:
    """Return the limits of the machine positions as a line of text."""
    if not mill.reach:
        return "  machine stands\n"
    reached = zip(mill.axes, mill.reach, strict=False)
    return "  machine " + "   ".join(f"{name} {low:.3f} … {high:.3f}" for name, (low, high) in reached) + "\n"


def place(mill: MillFigures, demand: Sequence[float], *, complete: bool) -> dict[str, float]:
    """Return the final position of a run: all axes, and the working plane if the run is ``complete``."""
    if complete and mill.final is not None:
        return {name: at for name, at in _places(mill.final).items() if isinstance(at, float)}
    named = ((f"m{name.lower()}" if name in "XYZ" else name.lower()) for name in mill.axes)
    return {name: millimetres(at) for name, at in zip(named, demand, strict=False)}


def row(block: Block, t0: float) -> str:
    """Return a block as a line of the table, with positions in the working plane."""
    feed, mode = _feed(block)
    speed = "" if feed is None else f"{feed:.1f}{'°' if mode == 'deg/min' else ''}/m"
    swivel = block.swivel
    places = "" if swivel is None else "".join(f"{value:11.4f}" for value in swivel.end)
    angles = "" if swivel is None else "".join(_angle(angle) for angle in swivel.rotary)
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:8s}{places}{angles}"
        f"{speed:>14s}{block.rpm:9.0f}{t0:8.2f}  {block.text}\n"
    )


def _places(swivel: Swivel) -> Json:
    """Return the end point in the working plane, and the positions of all axes."""
    plane = dict(zip(("x", "y", "z"), map(millimetres, swivel.end), strict=True))
    machine = dict(zip(("mx", "my", "mz"), map(millimetres, swivel.slides), strict=True))
    angles = (None if angle is None else degrees(angle) for angle in swivel.rotary)
    return {**plane, **machine, **dict(zip(_AXES, angles, strict=True))}


def _plane(swivel: Swivel) -> Json:
    """Return the plane of a PLANE block: its frame by rows, its origin and the targets of the axes."""
    q120, q121, q122 = (degrees(target) for target in swivel.system.targets)
    return {
        "frame": [[round(cell, 12) + 0.0 for cell in line] for line in swivel.system.frame],
        "datum": [millimetres(value) for value in swivel.system.datum],
        "q120": q120,
        "q121": q121,
        "q122": q122,
    }


def _feed(block: Block) -> tuple[float | None, str | None]:
    """Return the speed along the path and its unit; for a rapid, the speed that the slowest axis permits."""
    if not block.moves or block.travel is None or block.travel.length == 0.0:
        return None, None
    unit = "deg" if block.swivels else "mm"
    return path_feed(block, unit)


def _angle(angle: float | None) -> str:
    return f"{'-':>9s}" if angle is None else f"{angle:9.3f}"
