"""Output of ``prove --compare OFFSETS``, which compares the proof with a second set of offsets.

The output compares parts, times and findings. ``core/proving/offset_comparison.py`` compares the parts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.outputs.proof_output import make_diagnostic_json
from app.cli.outputs.units import MM_PER_INCH, Json, get_length_converter, get_volume_converter, round_seconds
from core.language.source import Dialect

if TYPE_CHECKING:
    from app.cli.proofs.proof_job import ProofJob
    from core.language.source import ProgramSource
    from core.proving.offset_comparison import Pair
    from core.proving.proof_report import PartReport, ProofReport

_ZERO_TOLERANCE = 5e-5  # in or mm


def make_comparison_json(
    job: ProofJob, source: ProgramSource, report: ProofReport, part: PartReport | None
) -> Json:
    """Return the JSON object ``compare``.

    Lengths are in inches for OmniTurn programs, and otherwise in mm.
    """
    from core.proving.offset_comparison import ProvedPart, prove_other_offsets

    assert job.comparison_offsets is not None
    this = ProvedPart(job.setup, job.part_settings, report, part)
    found = prove_other_offsets(
        source, this, job.comparison_offsets.setup, job.machine, is_ideal=job.uses_ideal_times
    )
    there, length, volume = (
        found.proof_report,
        get_length_converter(report.dialect),
        get_volume_converter(report.dialect),
    )
    furthest = max(
        (abs(p.difference_mm) for p in found.feature_pairs if p.difference_mm is not None), default=0.0
    )
    return {
        "offsets": job.comparison_offsets.offsets_file_name,
        "features": [_pair_json(pair, report.dialect) for pair in found.feature_pairs],
        "differing": found.differing_feature_count,
        "largest": length(furthest),
        "removed_volume": [each and volume(each.removed_volume_mm3) for each in (part, found.part_report)],
        "cycle_time_s": [
            round_seconds(report.program_times.cycle_time_s),
            round_seconds(there.program_times.cycle_time_s),
        ],
        "cutting_time_s": [
            round_seconds(report.program_times.cutting_time_s),
            round_seconds(there.program_times.cutting_time_s),
        ],
        "rapid_time_s": [
            round_seconds(report.program_times.rapid_time_s),
            round_seconds(there.program_times.rapid_time_s),
        ],
        "gone": [make_diagnostic_json(each) for each in found.resolved_findings],
        "added": [make_diagnostic_json(each) for each in found.new_findings],
    }


def _pair_json(pair: Pair, dialect: Dialect) -> Json:
    length = get_length_converter(dialect)
    one = pair.this_feature or pair.other_feature
    assert one is not None
    difference = pair.difference_mm
    return {
        "kind": str(one.kind),
        "reach": [_round_value(length(each)) for each in one.extent_mm],
        "here": None if pair.this_feature is None else _round_value(length(pair.this_feature.at)),
        "there": None if pair.other_feature is None else _round_value(length(pair.other_feature.at)),
        "difference": None if difference is None else _round_value(length(difference)),
    }


def _round_value(value: float) -> float:
    """Return a value rounded to six decimals, or 0.0 if it would be zero in the text output.

    The text output shows four decimals.
    """
    return 0.0 if abs(value) < _ZERO_TOLERANCE else round(value, 6)


# --- Text output


def format_comparison(comparison: Json, *, is_metric: bool, dialect: Dialect) -> str:
    """Return the text of the comparison for the proof, in the program's unit."""
    scale = MM_PER_INCH if is_metric and dialect is Dialect.OMNITURN else 1.0
    unit = "mm" if is_metric or dialect is not Dialect.OMNITURN else "in"
    pairs = comparison["features"]
    cycle, gone, added = comparison["cycle_time_s"], comparison["gone"], comparison["added"]
    assert isinstance(pairs, list)
    assert isinstance(cycle, list)
    assert isinstance(gone, list)
    assert isinstance(added, list)
    rows = "".join(_row(each, scale) for each in pairs)
    head = f"    feature, {unit:12s}         here       there  difference\n" if rows else ""
    return (
        f"  with {comparison['offsets']}:\n{head}{rows}"
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
    size_texts = [_figure(pair[key], scale) for key in ("here", "there")]
    difference = pair["difference"]
    change = f"{difference * scale:+12.4f}" if isinstance(difference, float) else "     not both"
    return f"    {name:28s}{size_texts[0]}{size_texts[1]}{change}\n"


def _figure(value: object, scale: float) -> str:
    return f"{value * scale:12.4f}" if isinstance(value, float) else f"{'–':>12s}"
