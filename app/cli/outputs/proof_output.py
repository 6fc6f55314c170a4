"""Output of a proof as JSON with the keys and units of docs/json.md, and of the stock as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.outputs.units import (
    Json,
    get_length_converter,
    get_volume_converter,
    round_degrees,
    round_seconds,
    to_inches_per_minute,
)
from core.language.source import Dialect
from core.message import Message, collect_values
from core.tool_edges import NamedToolNumber

if TYPE_CHECKING:
    from core.language.diagnostics import Diagnostic
    from core.part.stock import Stock
    from core.part.turned_part import ProfilePoints
    from core.proving.proof_report import PartReport, ProofReport

# Checks that the interpreter makes, by the codes of their findings.
_CHECK_NAMES = {
    "spindle-stopped": "spindle-off",
    "collet-open": "collet-open",
    "thread-run-up": "thread-run-up",
}


def make_stock_json(part: PartReport, dialect: Dialect) -> Json | None:
    """Return the stock as JSON with the keys of docs/json.md.

    The result is None if the stock is not specified and cannot be assumed.
    """
    stock, last = part.stock, part.last_piece
    if stock is None:
        return None
    length, volume = get_length_converter(dialect), get_volume_converter(dialect)
    bore = last.bore_profile if last is not None else None
    return {
        "given": stock.specification_text or None,
        "outside": [[length(z), length(r)] for z, r in stock.outside_profile],
        "volume": volume(part.stock_volume_mm3),
        "removed_volume": volume(part.removed_volume_mm3),
        "left_volume": volume(part.remaining_volume_mm3),
        "profile": _points(last.outside_profile, dialect) if last is not None else [],
        "bore": _points(bore, dialect) if bore is not None else None,
        "min_wall": length(last.min_wall_mm) if last is not None and last.min_wall_mm is not None else None,
        "milled": part.is_milled,
        "pieces": [volume(piece.volume_mm3) for piece in part.parted_pieces],
        "assumed": list(part.assumptions),
        "unchecked": list(part.unchecked_data),
    }


def format_stock(part: PartReport, dialect: Dialect) -> str:
    """Return the description of the stock as text for the proof."""
    if part.stock is None:
        return "".join(f"  {words}\n" for words in part.assumptions)
    inch = dialect is Dialect.OMNITURN
    volume, unit = get_volume_converter(dialect), "in³" if inch else "mm³"
    pieces = (
        Message(", pieces parted off: {pieces_count}", pieces_count=len(part.parted_pieces))
        if part.parted_pieces
        else ""
    )
    return (
        f"  stock {_named(part.stock, dialect)}: {volume(part.removed_volume_mm3):.4g} {unit}"
        f" of {volume(part.stock_volume_mm3):.4g} cut away{pieces}\n"
        + "".join(f"  {words}\n" for words in part.assumptions)
        + (f"  not checked: {'; '.join(part.unchecked_data)}\n" if part.unchecked_data else "")
    )


def _named(stock: Stock, dialect: Dialect) -> str:
    if stock.specification_text:
        return stock.specification_text
    length, unit = get_length_converter(dialect), "in" if dialect is Dialect.OMNITURN else "mm"
    bore = (
        Message(", bore diameter {bore}", bore=f"{2.0 * length(stock.bore_profile[0][1]):.3f}")
        if stock.bore_profile
        else ""
    )
    return Message(
        "a bar of diameter {radius}{bore} {unit}, assumed because no stock was specified",
        radius=f"{2.0 * length(stock.max_radius_mm):.3f}",
        bore=bore,
        unit=unit,
    )


def _points(profile: ProfilePoints, dialect: Dialect) -> list[list[float]]:
    length = get_length_converter(dialect)
    return [[round(length(z), 6), round(length(r), 6)] for z, r in profile]


def make_diagnostic_json(diagnostic: Diagnostic) -> Json:
    """Return a diagnostic as JSON with the keys of docs/json.md.

    The column is 1 if the diagnostic applies to a whole line.
    """
    return {
        "line": diagnostic.line,
        "column": max(diagnostic.column, 1) if diagnostic.line else 0,
        "severity": str(diagnostic.severity),
        "code": diagnostic.code,
        "message": diagnostic.message,
        "args": collect_values(diagnostic.message),
        "hint": diagnostic.hint,
        "check": diagnostic.check_name or _CHECK_NAMES.get(diagnostic.code),
        "n": diagnostic.block_number or None,
        "count": diagnostic.occurrence_count,
        "assumed": list(diagnostic.assumptions),
        "silenced": diagnostic.downgrade_reason or None,
    }


def count_operator_stops(report: ProofReport, *, optional_stop: bool) -> int:
    """Return how many times one cycle waits for the operator."""
    return report.stop_count + (report.optional_stop_count if optional_stop else 0)


def make_report_json(
    file: str, report: ProofReport, part: PartReport | None = None, *, optional_stop: bool = False
) -> Json:
    """Return a proof as JSON with the keys and units of docs/json.md.

    Lengths are in inches for OmniTurn programs, and otherwise in mm. ``stock`` is null on a mill.
    """
    reach, times = report.program_ranges, report.program_times
    mill: Json = {}
    if report.mill_results is not None:
        from app.cli.outputs.klartext_output import make_mill_proof_json

        mill = make_mill_proof_json(report, report.mill_results)
    inch, length = report.dialect is Dialect.OMNITURN, get_length_converter(report.dialect)
    return {
        "file": file,
        "dialect": str(report.dialect),
        "units": "inch" if inch and not report.is_metric else "mm",
        "blocks": report.block_count,
        "elementary": report.elementary_block_count,
        "diagnostics": [make_diagnostic_json(d) for d in report.diagnostics],
        "silenced": sum(1 for d in report.diagnostics if d.downgrade_reason),
        "cycle_time_s": round_seconds(times.cycle_time_s),
        "cutting_time_s": round_seconds(times.cutting_time_s),
        "rapid_time_s": round_seconds(times.rapid_time_s),
        "dwell_time_s": round_seconds(times.dwell_time_s),
        "wait_time_s": round_seconds(times.wait_time_s),
        "stops": count_operator_stops(report, optional_stop=optional_stop),
        "cutting_length": length(report.cutting_length_mm),
        "rapid_length": length(report.rapid_length_mm),
        "corner_tolerance": length(report.corner_tolerance_mm),
        "tools": [each.name if isinstance(each, NamedToolNumber) else each for each in report.tool_numbers],
        "limits": {
            "x": [length(x) for x in reach.x_range],
            "z": [length(z) for z in reach.z_range],
            "c": [round_degrees(reach.c_range[0]), round_degrees(reach.c_range[1])],
            "rpm": [round(rpm, 3) for rpm in reach.rpm_range],
            "feed_ipm": [to_inches_per_minute(speed) for speed in reach.feed_range],
        },
        "ways": {
            "proved": report.branch_summary.proved_count,
            "left": report.branch_summary.unproved_count,
            "cycle_time_s": [round_seconds(t) for t in report.branch_summary.cycle_time_range],
        },
        "stock": make_stock_json(part, report.dialect) if part is not None else None,
        "final": {
            "x": length(report.final_position[0]),
            "z": length(report.final_position[1]),
            "c": round_degrees(report.final_position[2]),
        },
        **mill,
    }
