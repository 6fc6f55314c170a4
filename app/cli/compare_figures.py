"""``prove --compare OFFSETS``: what other offsets make of the same program: part, times, findings.

Tools stand where the offsets of the proof say that they do; with the others in force the slides bring them
elsewhere, and the part comes out as much larger, smaller, longer or shorter.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from app.cli.figures import MM_PER_INCH, Json, length_of, seconds
from app.cli.proof_json import diagnostic_json
from core.language.source import Dialect

if TYPE_CHECKING:
    from app.cli.proof_job import ProofJob
    from core.language.diagnostics import Diagnostic
    from core.language.source import Source
    from core.proving.part_features import Pair
    from core.proving.part_proof import PartReport
    from core.proving.proof_report import Report

FINE = 0.001
"""Width of a column of the part, mm, where parts are compared: a shoulder is off by .00002 in at most."""

_NOUGHT = 5e-5  # in or mm
_SAME = 0.0012  # mm; less is no difference


def compared(job: ProofJob, source: Source, report: Report, part: PartReport | None) -> Json:
    """The object ``compare``. Lengths are inches for OmniTurn programs, mm for the others."""
    from core.proving.part_features import features, matched
    from core.proving.part_proof import prove_with_part

    assert job.other is not None
    setting = job.setting if part is None else replace(job.setting, stock=part.stock, tips=_tips(job))
    setup = job.other.setup
    there, its_part = prove_with_part(source, setup, job.machine, setting, ideal=job.ideal)
    pairs: list[Pair] = []
    if part is not None and its_part is not None:
        parts = [each.last for each in (part, its_part)]
        pairs = matched(*([] if each is None else features(each) for each in parts))
    here_only, there_only = _only(report.diagnostics, there.diagnostics)
    length = length_of(report.dialect)
    return {
        "offsets": job.other.name,
        "features": [_pair_json(pair, report.dialect) for pair in pairs],
        "differing": sum(pair.difference is None or abs(pair.difference) > _SAME for pair in pairs),
        "largest": length(max((abs(p.difference) for p in pairs if p.difference is not None), default=0.0)),
        "removed_volume": [_volume(each, report.dialect) for each in (part, its_part)],
        "cycle_time_s": [seconds(report.times.cycle), seconds(there.times.cycle)],
        "cutting_time_s": [seconds(report.times.cutting), seconds(there.times.cutting)],
        "rapid_time_s": [seconds(report.times.rapid), seconds(there.times.rapid)],
        "gone": [diagnostic_json(each) for each in here_only],
        "added": [diagnostic_json(each) for each in there_only],
    }


def _tips(job: ProofJob) -> dict[int, tuple[float, float]]:
    """Where the tips stand on part zero, by T and by G54 to G59."""
    own = {n: (tool.x, tool.z) for n, tool in job.setup.tools.items()}
    return own | {n: (zero.x, zero.z) for n, zero in job.setup.zero.items()}


def _only(
    here: Iterable[Diagnostic], there: Iterable[Diagnostic]
) -> tuple[list[Diagnostic], list[Diagnostic]]:
    """The findings that only one of them has: figures in a sentence may differ, place and code may not."""

    def key(each: Diagnostic) -> tuple[int, str]:
        return each.line, each.code

    ours, theirs = {key(each) for each in here}, {key(each) for each in there}
    return [d for d in here if key(d) not in theirs], [d for d in there if key(d) not in ours]


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
    """To a millionth; no -0.0, and none that would be shown as such."""
    return 0.0 if abs(value) < _NOUGHT else round(value, 6)


def _volume(part: PartReport | None, dialect: Dialect) -> float | None:
    if part is None:
        return None
    return round(part.removed / (MM_PER_INCH**3 if dialect is Dialect.OMNITURN else 1.0), 6)


# --- as a person reads it


def compare_lines(found: Json, *, metric: bool, dialect: Dialect) -> str:
    """The comparison in the sheet of a proof, in the unit of the program."""
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
