"""Output of ``prove --compare OFFSETS``: part, times and findings with other offsets.

``core/proving/other_offsets.py`` compares the parts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.figures.proof_json import diagnostic_json
from app.cli.figures.units import MM_PER_INCH, Json, length_of, seconds, volume_of
from core.language.source import Dialect

if TYPE_CHECKING:
    from app.cli.proofs.proof_job import ProofJob
    from core.language.source import Source
    from core.proving.other_offsets import Pair
    from core.proving.proof_report import PartReport, Report

_NOUGHT = 5e-5  # in or mm


def compared(job: ProofJob, source: Source, report: Report, part: PartReport | None) -> Json:
    """Return the JSON object ``compare``. Lengths are inches for OmniTurn programs, otherwise mm."""
    from core.proving.other_offsets import ThisPart, other_part

    assert job.other is not None
    this = ThisPart(job.setup, job.setting, report, part)
    found = other_part(source, this, job.other.setup, job.machine, ideal=job.ideal)
    there, length, volume = found.report, length_of(report.dialect), volume_of(report.dialect)
    furthest = max((abs(p.difference) for p in found.pairs if p.difference is not None), default=0.0)
    return {
        "offsets": job.other.name,
        "features": [_pair_json(pair, report.dialect) for pair in found.pairs],
        "differing": found.differing,
        "largest": length(furthest),
        "removed_volume": [each and volume(each.removed) for each in (part, found.part)],
        "cycle_time_s": [seconds(report.times.cycle), seconds(there.times.cycle)],
        "cutting_time_s": [seconds(report.times.cutting), seconds(there.times.cutting)],
        "rapid_time_s": [seconds(report.times.rapid), seconds(there.times.rapid)],
        "gone": [diagnostic_json(each) for each in found.gone],
        "added": [diagnostic_json(each) for each in found.added],
    }


def _pair_json(pair: Pair, dialect: Dialect) -> Json:
    length = length_of(dialect)
    one = pair.here or pair.there
    assert one is not None
    difference = pair.difference
    return {
        "kind": str(one.kind),
        "reach": [_rounded(length(each)) for each in one.reach],
        "here": None if pair.here is None else _rounded(length(pair.here.at)),
        "there": None if pair.there is None else _rounded(length(pair.there.at)),
        "difference": None if difference is None else _rounded(length(difference)),
    }


def _rounded(value: float) -> float:
    """Return a value rounded to six decimals, and 0.0 for values that would be shown as zero."""
    return 0.0 if abs(value) < _NOUGHT else round(value, 6)


# --- Text output


def compare_lines(found: Json, *, metric: bool, dialect: Dialect) -> str:
    """Return the comparison as text for the proof, in the unit of the program."""
    scale = MM_PER_INCH if metric and dialect is Dialect.OMNITURN else 1.0
    unit = "mm" if metric or dialect is not Dialect.OMNITURN else "in"
    pairs = found["features"]
    cycle, gone, added = found["cycle_time_s"], found["gone"], found["added"]
    assert isinstance(pairs, list)
    assert isinstance(cycle, list)
    assert isinstance(gone, list)
    assert isinstance(added, list)
    rows = "".join(_row(each, scale) for each in pairs)
    head = f"    feature, {unit:12s}         here       there  difference\n" if rows else ""
    return (
        f"  with {found['offsets']}:\n{head}{rows}"
        f"    cycle {cycle[0]:.2f} s, with it {cycle[1]:.2f} s\n"
        + "".join(f"    gone: line {each['line']} {each['code']}\n" for each in gone)
        + "".join(
            f"    new: line {each['line']} {each['severity']}: {each['message']} [{each['code']}]\n"
            for each in added
        )
    )


def _row(pair: Json, scale: float) -> str:
    reach = pair["reach"]
    assert isinstance(reach, list)
    along = "Z" if pair["kind"] in {"diameter", "bore"} else "r"
    name = f"{pair['kind']} {along} {reach[0] * scale:.3f}…{reach[1] * scale:.3f}"
    figures = [_figure(pair[key], scale) for key in ("here", "there")]
    difference = pair["difference"]
    change = f"{difference * scale:+12.4f}" if isinstance(difference, float) else "     not both"
    return f"    {name:28s}{figures[0]}{figures[1]}{change}\n"


def _figure(value: object, scale: float) -> str:
    return f"{value * scale:12.4f}" if isinstance(value, float) else f"{'–':>12s}"
