"""A feature of a part that is measured: nominal, limits, what corrects it, and the proposed correction.

Lengths mm; a diameter is a diameter. ``grows`` says what the feature does when the correction grows: +1 it
grows with it, -1 it shrinks. A diameter, outside or inside, grows with X of a tool at X positive, and shrinks
with that of a tool at X negative; a length grows or shrinks with Z by the end at which the tool cuts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from core.extras.quality.control_charts import SAMPLE_SIZES, QualityError
from core.message import Message

NUMBERS = range(1, 33)
NAME_LONGEST = 24
SIZE_MOST = 2540.0  # mm: 100 in
EVERY_MOST = 10_000


class FeatureKind(StrEnum):
    """What is measured."""

    DIAMETER = "diameter"
    LENGTH = "length"


class CorrectedBy(StrEnum):
    """What makes the feature and is corrected: wear of a tool, or a secondary offset."""

    TOOL = "tool"
    SECONDARY = "secondary"


@dataclass(frozen=True, slots=True)
class Feature:
    """``low`` and ``high`` are deviations from the nominal; ``every``: so many parts apart, 0: no plan."""

    name: str
    kind: FeatureKind
    nominal: float
    low: float
    high: float
    by: CorrectedBy
    number: int
    grows: int = 1
    every: int = 0
    sample: int = 1

    @property
    def axis(self) -> str:
        """The axis whose correction changes it."""
        return "x" if self.kind is FeatureKind.DIAMETER else "z"

    @property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest good size."""
        return self.nominal + self.low, self.nominal + self.high

    @property
    def middle(self) -> float:
        """What is aimed at: the middle of the tolerance."""
        return self.nominal + (self.low + self.high) / 2.0

    @property
    def width(self) -> float:
        """The tolerance from limit to limit."""
        return self.high - self.low

    @property
    def corrected_by(self) -> str:
        """``T3 X`` or ``D4 Z``."""
        return f"{'T' if self.by is CorrectedBy.TOOL else 'D'}{self.number} {self.axis.upper()}"

    def good(self, size: float) -> bool:
        """Whether a part of this size is within its tolerance; a reading on the limit is."""
        low, high = self.limits
        return low - 1e-9 <= size <= high + 1e-9


def check_feature(feature: Feature) -> None:
    """Raises QualityError, with what to enter, for a feature that nobody could measure or correct."""
    if not feature.name.strip() or len(feature.name) > NAME_LONGEST or not feature.name.isprintable():
        raise QualityError(
            Message("a feature name must have 1 to {name_longest} characters", name_longest=NAME_LONGEST),
            "invalid-name",
        )
    if not all(map(math.isfinite, (feature.nominal, feature.low, feature.high))):
        raise QualityError(
            Message("{feature}: the nominal dimension and the limits must be numbers", feature=feature.name),
            "not-a-number",
        )
    if not 0.0 < feature.nominal <= SIZE_MOST:
        raise QualityError(
            Message(
                "{feature}: the nominal dimension must be more than 0 and at most {size_most} mm",
                feature=feature.name,
                size_most=f"{SIZE_MOST:g}",
            ),
            "nominal",
        )
    if feature.low >= feature.high:
        raise QualityError(
            Message(
                "{feature}: the lower deviation must be below the upper deviation; correct one of them",
                feature=feature.name,
            ),
            "limits-reversed",
        )
    if feature.limits[0] <= 0.0:
        raise QualityError(
            Message("{feature}: the lower limit is 0 or less; correct the deviation", feature=feature.name),
            "lower-limit",
        )
    if feature.number not in NUMBERS:
        raise QualityError(
            Message(
                "{feature}: the offset number must be 1 to {numbers}, not {number}",
                feature=feature.name,
                numbers=NUMBERS[-1],
                number=feature.number,
            ),
            "offset-number",
        )
    if feature.grows not in {1, -1}:
        raise QualityError(
            Message(
                "{feature}: the direction must be +1 (a positive correction makes the "
                "dimension larger) or -1 (a positive correction makes the dimension smaller)",
                feature=feature.name,
            ),
            "direction",
        )
    if not 0 <= feature.every <= EVERY_MOST:
        raise QualityError(
            Message(
                "{feature}: the measuring interval must be 1 to {every_most} parts, or 0 for "
                "no sampling plan",
                feature=feature.name,
                every_most=EVERY_MOST,
            ),
            "interval",
        )
    if feature.sample != 1 and feature.sample not in SAMPLE_SIZES:
        raise QualityError(
            Message(
                "{feature}: a sample must have 1 to {sample_sizes} parts",
                feature=feature.name,
                sample_sizes=SAMPLE_SIZES[-1],
            ),
            "sample-size",
        )


WEAR_MOST = 2.54  # mm at the offset (X at the radius): what the tables take; more has to be touched off
_FAR = 3.0  # widths of the tolerance: a reading so far off is no wear


@dataclass(frozen=True, slots=True)
class CorrectionRule:
    """``dead``: share of the tolerance within which nothing is corrected; ``step``: share that is corrected.

    ``last``: so many newest readings count. Half a step follows the scatter of single parts half as much.
    """

    dead: float = 0.1
    step: float = 0.5
    last: int = 5


@dataclass(frozen=True, slots=True)
class Proposal:
    """``change`` is what to add to the correction, mm, of a diameter as a diameter; 0: nothing."""

    feature: Feature
    count: int  # readings behind it
    mean: float
    change: float
    offset_change: float  # the same at the offset: X as a radius
    expected: float  # what parts will measure with it
    why: str  # in words, where nothing is to be changed


def propose(
    feature: Feature, readings: Sequence[float], resolution: float, rule: CorrectionRule | None = None
) -> Proposal:
    """What the newest readings since the last correction ask for, whole steps of ``resolution`` (mm).

    Raises QualityError without readings, and for readings or a change that no wear explains.
    """
    rule = rule or CorrectionRule()
    if not readings:
        raise QualityError(
            Message("{feature}: no part has been measured since the last correction", feature=feature.name),
            "no-readings",
        )
    newest = np.asarray(readings[-rule.last :], dtype=np.float64)
    if not np.isfinite(newest).all():
        raise QualityError(
            Message("{feature}: a reading is not a number; delete that reading", feature=feature.name),
            "not-a-number",
        )
    if float(np.abs(newest - feature.middle).max()) > _FAR * feature.width:
        raise QualityError(
            Message(
                "{feature}: a reading is off by more than {distance} times the tolerance, "
                "which is too large for tool wear; measure again",
                feature=feature.name,
                distance=f"{_FAR:g}",
            ),
            "reading-too-far",
        )
    mean = float(newest.mean())
    deviation = mean - feature.middle
    if abs(deviation) <= rule.dead * feature.width + 1e-12:
        return _nothing(
            feature, len(newest), mean, "the deviation is within the dead band, so no correction is needed"
        )
    change = -feature.grows * _whole_steps(rule.step * deviation, resolution)
    if change == 0.0:
        return _nothing(
            feature,
            len(newest),
            mean,
            "the correction would be less than the smallest offset step, so no correction is needed",
        )
    at_offset = change / 2.0 if feature.axis == "x" else change
    if abs(at_offset) > WEAR_MOST:
        raise QualityError(
            Message(
                "{feature}: a correction of {change} mm is too large to be tool wear; touch the tool off",
                feature=feature.name,
                change=f"{change:.4f}",
            ),
            "correction-too-large",
        )
    return Proposal(feature, len(newest), mean, change, at_offset, mean + feature.grows * change, "")


def _nothing(feature: Feature, count: int, mean: float, why: str) -> Proposal:
    return Proposal(feature, count, mean, 0.0, 0.0, mean, why)


def _whole_steps(length: float, resolution: float) -> float:
    """Rounded to the resolution, halves toward nought: never more than was asked for."""
    steps = math.ceil(abs(length) / resolution - 0.5 - 1e-9)
    return math.copysign(max(0, steps) * resolution, length) if steps > 0 else 0.0
