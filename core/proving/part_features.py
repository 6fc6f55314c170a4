"""Diameters and shoulders of a turned part, and those of another beside them: what other offsets change.

A feature is a straight of the profile: along Z it is a diameter, across it a shoulder. Cones, arcs and what
a nose leaves in a corner are none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from enum import StrEnum
from itertools import pairwise
from typing import NamedTuple

from core.part.turned_part import Piece, Profile

_SHORTEST = 0.25  # mm
_STRAIGHT = 0.006  # mm of r along a diameter, or of Z along a shoulder: a profile is told within .004
_FAR = 6.35  # mm; two features further apart are not one


class FeatureKind(StrEnum):
    """What a straight of a profile is."""

    DIAMETER = "diameter"
    SHOULDER = "shoulder"
    BORE = "bore"
    BORE_SHOULDER = "bore-shoulder"


class Feature(NamedTuple):
    """``at``: the diameter or the Z, mm; ``reach``: from where to where, in Z of a diameter, else in r."""

    kind: FeatureKind
    at: float
    reach: tuple[float, float]

    def apart(self, other: Feature) -> float:
        """How far another lies from it, mm: a radius counts as much as a length."""
        half = 0.5 if self.kind in {FeatureKind.DIAMETER, FeatureKind.BORE} else 1.0
        return abs(self.at - other.at) * half + math.dist(self.reach, other.reach)


class Pair(NamedTuple):
    """A feature here and there; None where the other part has none like it."""

    here: Feature | None
    there: Feature | None

    @property
    def difference(self) -> float | None:
        """There less here, mm."""
        if self.here is None or self.there is None:
            return None
        return self.there.at - self.here.at


def features(piece: Piece) -> list[Feature]:
    """Those of the outside from the face on, then those of the bore."""
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
    """The end of straight ``k`` that no fillet rounds: behind it comes the longer one. What a nose has left
    at the other end is in the straight too, as far as it lies within the tolerance of the profile."""
    before = math.dist(profile[k - 1], profile[k]) if k else math.inf
    behind = math.dist(profile[k + 1], profile[k + 2]) if k + 2 < len(profile) else math.inf
    return profile[k] if before >= behind else profile[k + 1]


def matched(here: Sequence[Feature], there: Sequence[Feature]) -> list[Pair]:
    """Features of one kind that lie nearest to each other, as ``here`` has them; then those only there."""
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
