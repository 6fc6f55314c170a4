"""Figures as the commands show them: inches and minutes outside, millimetres and seconds inside."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from core.language.source import Dialect

if TYPE_CHECKING:
    from core.interpreter.elementary_blocks import Block
    from core.language.diagnostics import Diagnostic
    from core.proving.proof_report import Report

MM_PER_INCH = 25.4

# A surface speed in ft/min is 12 in over 60 s.
MM_S_PER_FT_MIN = 12 * MM_PER_INCH / 60

Json = dict[str, object]


def inches(mm: float) -> float:
    """Inches of a length, to a billionth, so that the binary noise of the conversion does not show."""
    return round(mm / MM_PER_INCH, 9) + 0.0  # + 0.0 makes -0.0 a plain zero


def millimetres(mm: float) -> float:
    """A length as it is, to a billionth."""
    return round(mm, 9) + 0.0


def length_of(dialect: Dialect) -> Callable[[float], float]:
    """How lengths are shown to whoever programs in this language: OmniTurn counts in inches, others in mm."""
    return inches if dialect is Dialect.OMNITURN else millimetres


def per_minute(mm_s: float) -> float:
    """in/min of a speed in mm/s."""
    return round(mm_s * 60 / MM_PER_INCH, 6)


def seconds(t: float) -> float:
    """Seconds to the microsecond."""
    return round(t, 6)


def degrees(angle: float) -> float:
    """Degrees to a millionth."""
    return round(angle, 6) + 0.0


# Checks that interpreting makes by itself, by the code of their findings.
_CHECKS = {"spindle-stopped": "spindle-off", "collet-open": "collet-open", "thread-run-up": "thread-run-up"}


def diagnostic_json(diagnostic: Diagnostic) -> Json:
    """One diagnostic with the keys of interfaces.md; one about a whole line stands at its first column."""
    return {
        "line": diagnostic.line,
        "column": max(diagnostic.column, 1) if diagnostic.line else 0,
        "severity": str(diagnostic.severity),
        "code": diagnostic.code,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
        "check": diagnostic.check or _CHECKS.get(diagnostic.code),
        "n": diagnostic.n or None,
        "count": diagnostic.count,
    }


def stops_of(report: Report, *, optional_stop: bool) -> int:
    """How often a cycle waits for the operator."""
    return report.stops + (report.optional_stops if optional_stop else 0)


def report_json(file: str, report: Report, *, optional_stop: bool = False) -> Json:
    """A proof with the keys and units of interfaces.md; ``stock`` is null until removal is computed.

    Lengths are inches for OmniTurn programs, mm for the others.
    """
    reach, times = report.reach, report.times
    mill: Json = {}
    if report.mill is not None:
        from app.cli.klartext_figures import figures

        mill = figures(report, report.mill)
    inch, length = report.dialect is Dialect.OMNITURN, length_of(report.dialect)
    return {
        "file": file,
        "dialect": str(report.dialect),
        "units": "inch" if inch and not report.metric else "mm",
        "blocks": report.blocks,
        "elementary": report.elementary,
        "diagnostics": [diagnostic_json(d) for d in report.diagnostics],
        "cycle_time_s": seconds(times.cycle),
        "cutting_time_s": seconds(times.cutting),
        "rapid_time_s": seconds(times.rapid),
        "dwell_time_s": seconds(times.dwell),
        "wait_time_s": seconds(times.wait),
        "stops": stops_of(report, optional_stop=optional_stop),
        "cutting_length": length(report.cutting_length),
        "rapid_length": length(report.rapid_length),
        "tools": list(report.tools),
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
        "stock": None,
        "final": {
            "x": length(report.final[0]),
            "z": length(report.final[1]),
            "c": degrees(report.final[2]),
        },
        **mill,
    }


def block_json(block: Block, source_line: str, t0: float, t1: float) -> Json:
    """One elementary block with the keys and units of interfaces.md; keys that do not apply are null."""
    arc = block.kind == "arc"
    circular = arc or block.kind == "plane-arc"
    turned = block.kind == "rotate"  # its speed is rpm
    feed = per_minute(block.feed) if not block.per_rev else inches(block.feed)
    return {
        "n": block.n,
        "line": block.line,
        "source": source_line,
        "text": block.text,
        "kind": str(block.kind),
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
