"""Output of a proof as JSON, with the keys and units of docs/json.md, and of the stock as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.figures.units import Json, degrees, length_of, per_minute, seconds, volume_of
from core.language.source import Dialect
from core.message import Message, named_values
from core.tool_edges import NamedTool

if TYPE_CHECKING:
    from core.language.diagnostics import Diagnostic
    from core.part.stock import Stock
    from core.part.turned_part import Profile
    from core.proving.proof_report import PartReport, Report

# Checks that the interpreter makes, by the codes of their findings.
_CHECKS = {"spindle-stopped": "spindle-off", "collet-open": "collet-open", "thread-run-up": "thread-run-up"}


def stock_json(part: PartReport, dialect: Dialect) -> Json | None:
    """Return the stock with the keys of docs/json.md; None if no stock is specified or can be assumed."""
    stock, last = part.stock, part.last
    if stock is None:
        return None
    length, volume = length_of(dialect), volume_of(dialect)
    bore = last.bore if last is not None else None
    return {
        "given": stock.given or None,
        "outside": [[length(z), length(r)] for z, r in stock.outside],
        "volume": volume(part.volume),
        "removed_volume": volume(part.removed),
        "left_volume": volume(part.left),
        "profile": _points(last.outside, dialect) if last is not None else [],
        "bore": _points(bore, dialect) if bore is not None else None,
        "min_wall": length(last.min_wall) if last is not None and last.min_wall is not None else None,
        "milled": part.milled,
        "pieces": [volume(piece.volume) for piece in part.pieces],
        "assumed": list(part.assumed),
        "unchecked": list(part.unchecked),
    }


def stock_lines(part: PartReport, dialect: Dialect) -> str:
    """Return the stock as text for the proof."""
    if part.stock is None:
        return "".join(f"  {words}\n" for words in part.assumed)
    inch = dialect is Dialect.OMNITURN
    volume, unit = volume_of(dialect), "in³" if inch else "mm³"
    pieces = (
        Message(", pieces parted off: {pieces_count}", pieces_count=len(part.pieces)) if part.pieces else ""
    )
    return (
        f"  stock {_named(part.stock, dialect)}: {volume(part.removed):.4g} {unit}"
        f" of {volume(part.volume):.4g} cut away{pieces}\n"
        + "".join(f"  {words}\n" for words in part.assumed)
        + (f"  not checked: {'; '.join(part.unchecked)}\n" if part.unchecked else "")
    )


def _named(stock: Stock, dialect: Dialect) -> str:
    if stock.given:
        return stock.given
    length, unit = length_of(dialect), "in" if dialect is Dialect.OMNITURN else "mm"
    bore = (
        Message(", bore diameter {bore}", bore=f"{2.0 * length(stock.bore[0][1]):.3f}") if stock.bore else ""
    )
    return Message(
        "a bar of diameter {radius}{bore} {unit}, assumed because no stock was specified",
        radius=f"{2.0 * length(stock.radius):.3f}",
        bore=bore,
        unit=unit,
    )


def _points(profile: Profile, dialect: Dialect) -> list[list[float]]:
    length = length_of(dialect)
    return [[round(length(z), 6), round(length(r), 6)] for z, r in profile]


def diagnostic_json(diagnostic: Diagnostic) -> Json:
    """Return a diagnostic with the keys of docs/json.md; the column of a whole line is 1."""
    return {
        "line": diagnostic.line,
        "column": max(diagnostic.column, 1) if diagnostic.line else 0,
        "severity": str(diagnostic.severity),
        "code": diagnostic.code,
        "message": diagnostic.message,
        "args": named_values(diagnostic.message),
        "hint": diagnostic.hint,
        "check": diagnostic.check or _CHECKS.get(diagnostic.code),
        "n": diagnostic.n or None,
        "count": diagnostic.count,
        "assumed": list(diagnostic.assumed),
        "silenced": diagnostic.silenced or None,
    }


def stops_of(report: Report, *, optional_stop: bool) -> int:
    """Return how often a cycle waits for the operator."""
    return report.stops + (report.optional_stops if optional_stop else 0)


def report_json(
    file: str, report: Report, part: PartReport | None = None, *, optional_stop: bool = False
) -> Json:
    """Return a proof with the keys and units of docs/json.md; ``stock`` is null on a mill.

    Lengths are inches for OmniTurn programs, otherwise mm.
    """
    reach, times = report.reach, report.times
    mill: Json = {}
    if report.mill is not None:
        from app.cli.figures.klartext_figures import figures

        mill = figures(report, report.mill)
    inch, length = report.dialect is Dialect.OMNITURN, length_of(report.dialect)
    return {
        "file": file,
        "dialect": str(report.dialect),
        "units": "inch" if inch and not report.metric else "mm",
        "blocks": report.blocks,
        "elementary": report.elementary,
        "diagnostics": [diagnostic_json(d) for d in report.diagnostics],
        "silenced": sum(1 for d in report.diagnostics if d.silenced),
        "cycle_time_s": seconds(times.cycle),
        "cutting_time_s": seconds(times.cutting),
        "rapid_time_s": seconds(times.rapid),
        "dwell_time_s": seconds(times.dwell),
        "wait_time_s": seconds(times.wait),
        "stops": stops_of(report, optional_stop=optional_stop),
        "cutting_length": length(report.cutting_length),
        "rapid_length": length(report.rapid_length),
        "corner_tolerance": length(report.corner_tolerance),
        "tools": [each.name if isinstance(each, NamedTool) else each for each in report.tools],
        "limits": {
            "x": [length(x) for x in reach.x],
            "z": [length(z) for z in reach.z],
            "c": [degrees(reach.c[0]), degrees(reach.c[1])],
            "rpm": [round(rpm, 3) for rpm in reach.rpm],
            "feed_ipm": [per_minute(speed) for speed in reach.feed],
        },
        "ways": {
            "proved": report.ways.proved,
            "left": report.ways.unproved,
            "cycle_time_s": [seconds(t) for t in report.ways.cycle],
        },
        "stock": stock_json(part, report.dialect) if part is not None else None,
        "final": {
            "x": length(report.final[0]),
            "z": length(report.final[1]),
            "c": degrees(report.final[2]),
        },
        **mill,
    }
