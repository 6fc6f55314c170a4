"""Comparison of a proved part with the part that results from other offsets.

The tools are at the positions that the offsets of the proof specify. With other offsets, the axes move to
other positions, so the part becomes larger, smaller, longer or shorter.

A feature is a straight line of the profile: a diameter along Z, or a shoulder across Z. Cones, arcs and the
nose radius in a corner are not features.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise
from typing import NamedTuple

from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Diagnostic
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.part.turned_part import PartedPiece, ProfilePoints
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.proof_report import PartReport, ProofReport
from core.proving.prove_program import ReportProgress

_SHORTEST = 0.25  # mm
_STRAIGHT = 0.006  # mm of r along a diameter, or of Z along a shoulder; profiles have a tolerance of 0.004
_FAR = 6.35  # mm; features further apart are not matched
FINE_COLUMN_WIDTH_MM = 0.001
"""Column width in mm for comparing parts. A shoulder is off by at most .00002 in."""
FEATURE_TOLERANCE_MM = 0.0012  # mm; smaller differences are ignored


class FeatureKind(StrEnum):
    """The kind of a profile feature: a diameter or a shoulder, on the outside or in the bore."""

    DIAMETER = "diameter"
    SHOULDER = "shoulder"
    BORE = "bore"
    BORE_SHOULDER = "bore-shoulder"


class PartFeature(NamedTuple):
    """A feature with its diameter or Z (``at``) and its extent in Z or r (``extent_mm``), in mm."""

    kind: FeatureKind
    at: float
    extent_mm: tuple[float, float]

    def calculate_distance_to(self, other: PartFeature) -> float:
        """Return the distance to another feature in mm.

        Diameters are compared as radii, so that their difference counts the same as a difference in Z.
        """
        half = 0.5 if self.kind in {FeatureKind.DIAMETER, FeatureKind.BORE} else 1.0
        return abs(self.at - other.at) * half + math.dist(self.extent_mm, other.extent_mm)


class Pair(NamedTuple):
    """A feature of this part with its counterpart on the other part.

    One of the two is None if the feature exists on only one part.
    """

    this_feature: PartFeature | None
    other_feature: PartFeature | None

    @property
    def difference_mm(self) -> float | None:
        """Return the dimension of the other part minus the dimension of this part, in mm.

        The result is None if the feature has no counterpart.
        """
        if self.this_feature is None or self.other_feature is None:
            return None
        return self.other_feature.at - self.this_feature.at


def find_features(piece: PartedPiece) -> list[PartFeature]:
    """Return the features of the outside from the face on, followed by those of the bore."""
    outside, bore = piece.outside_profile, piece.bore_profile or []
    if not outside:
        return []
    ends = [(outside[0][0], 0.0)], [(outside[-1][0], 0.0)]
    found = list(_of([*ends[0], *outside, *ends[1]], FeatureKind.DIAMETER, FeatureKind.SHOULDER))
    return found + [
        each for each in _of(bore, FeatureKind.BORE, FeatureKind.BORE_SHOULDER) if abs(each.at) > _STRAIGHT
    ]


def _of(profile: ProfilePoints, along: FeatureKind, across: FeatureKind) -> Iterator[PartFeature]:
    for k, ((z0, r0), (z1, r1)) in enumerate(pairwise(profile)):
        if abs(z1 - z0) >= _SHORTEST and abs(r1 - r0) <= _STRAIGHT:
            yield PartFeature(along, 2.0 * _sharp_end(profile, k)[1], (z0, z1))
        elif abs(r1 - r0) >= _SHORTEST and abs(z1 - z0) <= _STRAIGHT:
            yield PartFeature(across, _sharp_end(profile, k)[0], (min(r0, r1), max(r0, r1)))


def _sharp_end(profile: ProfilePoints, k: int) -> tuple[float, float]:
    """Return the end of profile line ``k`` that adjoins its longer neighbor, without a fillet.

    If the corner at the other end is rounded by the tool nose within the profile tolerance, it counts as
    part of the line.
    """
    before = math.dist(profile[k - 1], profile[k]) if k else math.inf
    next_length = math.dist(profile[k + 1], profile[k + 2]) if k + 2 < len(profile) else math.inf
    return profile[k] if before >= next_length else profile[k + 1]


def match_features(own_features: Sequence[PartFeature], other_features: Sequence[PartFeature]) -> list[Pair]:
    """Return pairs of the closest features of the same kind.

    The pairs are in the order of ``own_features``, followed by the features of ``other_features`` without a
    counterpart.
    """
    near = sorted(
        (a.calculate_distance_to(b), i, j)
        for i, a in enumerate(own_features)
        for j, b in enumerate(other_features)
        if a.kind is b.kind and a.calculate_distance_to(b) <= _FAR
    )
    partner: dict[int, int] = {}
    taken: set[int] = set()
    for _, i, j in near:
        if i not in partner and j not in taken:
            partner[i] = j
            taken.add(j)
    pairs = [
        Pair(a, other_features[partner[i]] if i in partner else None) for i, a in enumerate(own_features)
    ]
    return pairs + [Pair(None, b) for j, b in enumerate(other_features) if j not in taken]


@dataclass(frozen=True, slots=True)
class OffsetComparisonResult:
    """The part that results from other offsets, compared with the proved part.

    It contains the proof, the part, the pairs of features, and the findings that occur in only one of the
    two proofs.
    """

    proof_report: ProofReport
    part_report: PartReport | None
    feature_pairs: tuple[Pair, ...]
    resolved_findings: tuple[Diagnostic, ...]
    new_findings: tuple[Diagnostic, ...]

    @property
    def differing_feature_count(self) -> int:
        """Return the number of features that differ or have no counterpart."""
        return sum(
            pair.difference_mm is None or abs(pair.difference_mm) > FEATURE_TOLERANCE_MM
            for pair in self.feature_pairs
        )


@dataclass(frozen=True, slots=True)
class ProvedPart:
    """A proved program with its setup, its part settings and the resulting part."""

    setup: InterpreterSetup
    part_settings: PartSettings
    proof_report: ProofReport
    part_report: PartReport | None


def prove_other_offsets(
    program: ProgramSource | SharedProgram,
    proved_part: ProvedPart,
    other_setup: InterpreterSetup,
    machine: Machine,
    report_progress: ReportProgress | None = None,
    *,
    is_ideal: bool = False,
) -> OffsetComparisonResult:
    """Prove the same program, stock and tools with the offsets of ``other_setup``.

    ``report_progress`` may raise to cancel the proof.
    """
    setting = proved_part.part_settings
    if proved_part.part_report is not None:
        setting = replace(
            setting, stock=proved_part.part_report.stock, tips=_tip_positions(proved_part.setup)
        )
    report, part = prove_program_and_part(
        program,
        other_setup,
        machine,
        setting,
        report_progress,
        is_ideal=is_ideal,
        check_canceled=report_progress,
    )
    pairs: list[Pair] = []
    if proved_part.part_report is not None and part is not None:
        parts = [each.last_piece for each in (proved_part.part_report, part)]
        pairs = match_features(*([] if each is None else find_features(each) for each in parts))
    gone, added = _find_unmatched(proved_part.proof_report.diagnostics, report.diagnostics)
    return OffsetComparisonResult(report, part, tuple(pairs), gone, added)


def _tip_positions(setup: InterpreterSetup) -> dict[int, tuple[float, float]]:
    """Return the machine positions of tool tips at part zero, by T number and by G54 to G59."""
    own = {n: (tool.x, tool.z) for n, tool in setup.tools.items()}
    return own | {n: (zero.x, zero.z) for n, zero in setup.zero.items()}


def _find_unmatched(
    own_findings: Iterable[Diagnostic], there: Iterable[Diagnostic]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings that exist in only one of the two proofs, compared by line and code."""

    def get_line_and_code(each: Diagnostic) -> tuple[int, str]:
        return each.line, each.code

    ours, theirs = (
        {get_line_and_code(each) for each in own_findings},
        {get_line_and_code(each) for each in there},
    )
    return tuple(d for d in own_findings if get_line_and_code(d) not in theirs), tuple(
        d for d in there if get_line_and_code(d) not in ours
    )
