"""Comparison of the part with other offsets: features and findings with one and the other set.

The tools are at the positions that the offsets of the proof specify. With the other offsets the axes move
elsewhere, and the part becomes larger, smaller, longer or shorter.

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

from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.job_setup import Setup
from core.language.diagnostics import Diagnostic
from core.language.source import Source
from core.machine.machine_model import Machine
from core.part.turned_part import Piece, Profile
from core.proving.part_proof import prove_with_part
from core.proving.program_tools import PartSetting
from core.proving.proof_report import PartReport, Report
from core.proving.prove_program import Progress

_SHORTEST = 0.25  # mm
_STRAIGHT = 0.006  # mm of r along a diameter, or of Z along a shoulder; profiles have a tolerance of 0.004
_FAR = 6.35  # mm; features further apart are not matched
FINE = 0.001
"""Width of a column of the part, mm, where parts are compared: a shoulder is off by .00002 in at most."""
SAME = 0.0012  # mm; smaller differences are ignored


class FeatureKind(StrEnum):
    """The kind of a straight line of a profile."""

    DIAMETER = "diameter"
    SHOULDER = "shoulder"
    BORE = "bore"
    BORE_SHOULDER = "bore-shoulder"


class Feature(NamedTuple):
    """A feature with its diameter or Z in mm (``at``), and its extent in Z or r (``reach``)."""

    kind: FeatureKind
    at: float
    reach: tuple[float, float]

    def apart(self, other: Feature) -> float:
        """Return the distance to another feature in mm, where a radius counts like a length."""
        half = 0.5 if self.kind in {FeatureKind.DIAMETER, FeatureKind.BORE} else 1.0
        return abs(self.at - other.at) * half + math.dist(self.reach, other.reach)


class Pair(NamedTuple):
    """A feature on both parts; None if the other part has no similar feature."""

    here: Feature | None
    there: Feature | None

    @property
    def difference(self) -> float | None:
        """The value of the other part minus the value here, in mm, or None."""
        if self.here is None or self.there is None:
            return None
        return self.there.at - self.here.at


def features(piece: Piece) -> list[Feature]:
    """Return the features of the outside from the face on, then those of the bore."""
    outside, bore = piece.outside, piece.bore or []
    if not outside:
        return []
    ends = [(outside[0][0], 0.0)], [(outside[-1][0], 0.0)]
    found = list(_of([*ends[0], *outside, *ends[1]], FeatureKind.DIAMETER, FeatureKind.SHOULDER))
    return found + [
        each for each in _of(bore, FeatureKind.BORE, FeatureKind.BORE_SHOULDER) if abs(each.at) > _STRAIGHT
    ]


def _of(profile: Profile, along: FeatureKind, across: FeatureKind) -> Iterator[Feature]:
    for k, ((z0, r0), (z1, r1)) in enumerate(pairwise(profile)):
        if abs(z1 - z0) >= _SHORTEST and abs(r1 - r0) <= _STRAIGHT:
            yield Feature(along, 2.0 * _sharp_end(profile, k)[1], (z0, z1))
        elif abs(r1 - r0) >= _SHORTEST and abs(z1 - z0) <= _STRAIGHT:
            yield Feature(across, _sharp_end(profile, k)[0], (min(r0, r1), max(r0, r1)))


def _sharp_end(profile: Profile, k: int) -> tuple[float, float]:
    """Return the end of straight ``k`` that has no fillet, which is next to the longer neighbor.

    The nose radius at the other end is part of the straight if it is within the tolerance of the profile.
    """
    before = math.dist(profile[k - 1], profile[k]) if k else math.inf
    behind = math.dist(profile[k + 1], profile[k + 2]) if k + 2 < len(profile) else math.inf
    return profile[k] if before >= behind else profile[k + 1]


def matched(here: Sequence[Feature], there: Sequence[Feature]) -> list[Pair]:
    """Return pairs of the closest features of one kind, in the order of ``here``, then the remaining ones."""
    near = sorted(
        (a.apart(b), i, j)
        for i, a in enumerate(here)
        for j, b in enumerate(there)
        if a.kind is b.kind and a.apart(b) <= _FAR
    )
    partner: dict[int, int] = {}
    taken: set[int] = set()
    for _, i, j in near:
        if i not in partner and j not in taken:
            partner[i] = j
            taken.add(j)
    pairs = [Pair(a, there[partner[i]] if i in partner else None) for i, a in enumerate(here)]
    return pairs + [Pair(None, b) for j, b in enumerate(there) if j not in taken]


@dataclass(frozen=True, slots=True)
class OtherPart:
    """The result of the other offsets: proof, part, pairs of features, and findings of only one proof."""

    report: Report
    part: PartReport | None
    pairs: tuple[Pair, ...]
    gone: tuple[Diagnostic, ...]
    added: tuple[Diagnostic, ...]

    @property
    def differing(self) -> int:
        """The number of features that differ or have no counterpart."""
        return sum(pair.difference is None or abs(pair.difference) > SAME for pair in self.pairs)


@dataclass(frozen=True, slots=True)
class ThisPart:
    """A proved program with its setup, its part settings and the resulting part."""

    setup: Setup
    setting: PartSetting
    report: Report
    part: PartReport | None


def other_part(
    program: Source | ReadProgram, this: ThisPart, there: Setup, machine: Machine,
    watch: Progress | None = None, *, ideal: bool = False,
) -> OtherPart:  # fmt: skip
    """Prove the same program, stock and tools with the offsets of ``there``. ``watch`` may cancel."""
    setting = this.setting
    if this.part is not None:
        setting = replace(setting, stock=this.part.stock, tips=_tips(this.setup))
    report, part = prove_with_part(program, there, machine, setting, watch, ideal=ideal, watch=watch)
    pairs: list[Pair] = []
    if this.part is not None and part is not None:
        parts = [each.last for each in (this.part, part)]
        pairs = matched(*([] if each is None else features(each) for each in parts))
    gone, added = _only(this.report.diagnostics, report.diagnostics)
    return OtherPart(report, part, tuple(pairs), gone, added)


def _tips(setup: Setup) -> dict[int, tuple[float, float]]:
    """Return the positions at which the tips are at part zero, by T and by G54 to G59."""
    own = {n: (tool.x, tool.z) for n, tool in setup.tools.items()}
    return own | {n: (zero.x, zero.z) for n, zero in setup.zero.items()}


def _only(
    here: Iterable[Diagnostic], there: Iterable[Diagnostic]
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings that only one side has, compared by line and code."""

    def key(each: Diagnostic) -> tuple[int, str]:
        return each.line, each.code

    ours, theirs = {key(each) for each in here}, {key(each) for each in there}
    return tuple(d for d in here if key(d) not in theirs), tuple(d for d in there if key(d) not in ours)
