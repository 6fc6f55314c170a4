"""Output of elementary blocks of Klartext programs, in mm, degrees and minutes."""

from __future__ import annotations

from collections.abc import Sequence
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
    from core.interpreter.shared.working_plane import PlanePosition
    from core.proving.proof_report import MillResults, ProofReport

TABLE_HEAD = (
    "    n  line  kind           X          Y          Z         A        B        C"
    "          feed      rpm       t  block\n"
)
_PER_MINUTE = 60.0
_AXES = ("a", "b", "c")


def make_block_json(block: Block, source_line: str, start_s: float, end_s: float) -> Json:
    """Return the JSON object of an elementary block, with the keys of docs/json.md. Missing axes are null."""
    feed, mode = _feed_and_unit(block)
    swivel = block.swivel
    shown = {
        **make_common_block_json(block, source_line),
        "units": "mm",
        **({} if swivel is None else _position_json(swivel)),
        "feed": feed,
        "feed_mode": mode,
        "rpm": round(block.rpm, 6) + 0.0,
        "t0": round_seconds(start_s),
        "t1": round_seconds(end_s),
    }
    return shown | _plane_json(swivel) if block.kind == "plane" and swivel is not None else shown


def make_mill_proof_json(report: ProofReport, mill: MillResults) -> Json:
    """Return the JSON keys of a mill's proof that differ from a lathe's proof.

    ``limits`` are machine positions, and ``final`` has the positions of all axes.
    """
    limits: Json = {
        name.lower(): [round_millimeters(low), round_millimeters(high)]
        for name, (low, high) in zip(mill.axis_names, mill.axis_ranges, strict=False)
    }
    limits["rpm"] = [round(rpm, 3) for rpm in report.program_ranges.rpm_range]
    limits["feed_mm_min"] = [round(speed * _PER_MINUTE, 6) for speed in report.program_ranges.feed_range]
    return {
        "limits": limits,
        "final": {} if mill.final_position is None else _position_json(mill.final_position),
    }


def format_machine_limits(mill: MillResults) -> str:
    """Return the lowest and highest machine position of each axis as a line of text."""
    if not mill.axis_ranges:
        return "  machine stands\n"
    reached = zip(mill.axis_names, mill.axis_ranges, strict=False)
    return "  machine " + "   ".join(f"{name} {low:.3f} … {high:.3f}" for name, (low, high) in reached) + "\n"


def get_final_position(
    mill: MillResults, setpoint: Sequence[float], *, is_complete: bool
) -> dict[str, float]:
    """Return the final position of a run, by axis.

    If ``is_complete`` is true, the result has all axes and the position in the working plane. Otherwise it
    has only the axes of ``setpoint``.
    """
    if is_complete and mill.final_position is not None:
        return {name: at for name, at in _position_json(mill.final_position).items() if isinstance(at, float)}
    named = ((f"m{name.lower()}" if name in "XYZ" else name.lower()) for name in mill.axis_names)
    return {name: round_millimeters(at) for name, at in zip(named, setpoint, strict=False)}


def format_row(block: Block, start_s: float) -> str:
    """Return a block as a table row, with positions in the working plane."""
    feed, mode = _feed_and_unit(block)
    speed = "" if feed is None else f"{feed:.1f}{'°' if mode == 'deg/min' else ''}/m"
    swivel = block.swivel
    places = "" if swivel is None else "".join(f"{value:11.4f}" for value in swivel.end)
    angles = "" if swivel is None else "".join(_angle(angle) for angle in swivel.rotary_angles)
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:8s}{places}{angles}"
        f"{speed:>14s}{block.rpm:9.0f}{start_s:8.2f}  {block.text}\n"
    )


def _position_json(swivel: PlanePosition) -> Json:
    """Return the end point in the working plane and the machine positions of all axes."""
    plane = dict(zip(("x", "y", "z"), map(round_millimeters, swivel.end), strict=True))
    machine = dict(zip(("mx", "my", "mz"), map(round_millimeters, swivel.machine_position), strict=True))
    angles = (None if angle is None else round_degrees(angle) for angle in swivel.rotary_angles)
    return {**plane, **machine, **dict(zip(_AXES, angles, strict=True))}


def _plane_json(swivel: PlanePosition) -> Json:
    """Return the tilted plane of a PLANE block as JSON.

    The JSON contains the rotation matrix of the plane by rows, its origin, and the target angles of the
    axes.
    """
    q120, q121, q122 = (round_degrees(target) for target in swivel.system.target_angles)
    return {
        "frame": [[round(cell, 12) + 0.0 for cell in line] for line in swivel.system.frame],
        "datum": [round_millimeters(value) for value in swivel.system.datum],
        "q120": q120,
        "q121": q121,
        "q122": q122,
    }


def _feed_and_unit(block: Block) -> tuple[float | None, str | None]:
    """Return the path speed of a block and its unit.

    The speed of a rapid move is limited by the slowest axis.
    """
    if not block.moves or block.travel is None or block.travel.length == 0.0:
        return None, None
    unit = "deg" if block.has_angular_feed else "mm"
    return get_path_feed(block, unit)


def _angle(angle: float | None) -> str:
    return f"{'-':>9s}" if angle is None else f"{angle:9.3f}"
