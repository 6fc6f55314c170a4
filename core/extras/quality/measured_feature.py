"""A measured feature of a part: nominal size, limits, correcting offset and proposed correction.

Lengths are in mm, and a diameter is a diameter. ``grows`` is +1 if the feature becomes larger with a larger
correction, or -1 if it becomes smaller. A diameter, outside or inside, becomes larger with X of a tool at
positive X, and smaller with X of a tool at negative X. For a length, the sign depends on the end that the
tool cuts.
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
SIZE_MOST = 2540.0  # mm, 100 in
EVERY_MOST = 10_000


class FeatureKind(StrEnum):
    """Kind of the measured size."""

    DIAMETER = "diameter"
    LENGTH = "length"


class CorrectedBy(StrEnum):
    """Kind of offset that corrects the feature: wear of a tool, or a secondary offset."""

    TOOL = "tool"
    SECONDARY = "secondary"


@dataclass(frozen=True, slots=True)
class Feature:
    """A measured feature; ``low`` and ``high`` are deviations from the nominal size.

    ``every`` is the number of parts between two measurements, or 0 without a sampling plan.
    """

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
        """Axis whose correction changes the feature."""
        return "x" if self.kind is FeatureKind.DIAMETER else "z"

    @property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest permitted size, in mm."""
        return self.nominal + self.low, self.nominal + self.high

    @property
    def middle(self) -> float:
        """Target size, which is the middle of the tolerance, in mm."""
        return self.nominal + (self.low + self.high) / 2.0

    @property
    def width(self) -> float:
        """Width of the tolerance, in mm."""
        return self.high - self.low

    @property
    def corrected_by(self) -> str:
        """Name of the correcting offset and axis, such as ``T3 X`` or ``D4 Z``."""
        return f"{'T' if self.by is CorrectedBy.TOOL else 'D'}{self.number} {self.axis.upper()}"

    def good(self, size: float) -> bool:
        """Return whether a size is within the tolerance, including its limits."""
        low, high = self.limits
        return low - 1e-9 <= size <= high + 1e-9


def check_feature(feature: Feature) -> None:
    """Raise QualityError with a remedy if the feature cannot be measured or corrected."""
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


# mm at the offset (X as a radius), the limit of the offset tables; a larger change requires a touch-off
WEAR_MOST = 2.54
_FAR = 3.0  # tolerance widths; a larger deviation cannot be wear


@dataclass(frozen=True, slots=True)
class CorrectionRule:
    """Rule for corrections: dead band and step as fractions of the tolerance and of the deviation.

    ``dead`` is the fraction of the tolerance within which nothing is corrected. ``step`` is the fraction of
    the deviation that is corrected. ``last`` is the number of newest readings that are averaged. A step of
    one half follows the variation of single parts only half as much.
    """

    dead: float = 0.1
    step: float = 0.5
    last: int = 5


@dataclass(frozen=True, slots=True)
class Proposal:
    """A proposed correction; ``change`` is in mm, as a diameter for a diameter, and 0 for no correction."""

    feature: Feature
    count: int  # number of readings used
    mean: float
    change: float
    offset_change: float  # the change of the offset, X as a radius
    expected: float  # expected size of parts with the correction
    why: str  # reason why no correction is needed


def propose(
    feature: Feature, readings: Sequence[float], resolution: float, rule: CorrectionRule | None = None
) -> Proposal:
    """Propose a correction from the newest readings since the last correction.

    The change is a multiple of ``resolution`` in mm. Raises QualityError if there are no readings, or if wear
    cannot explain a reading or the change.
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
    """Return a length rounded to the resolution, with halves toward zero so that it is never too large."""
    steps = math.ceil(abs(length) / resolution - 0.5 - 1e-9)
    return math.copysign(max(0, steps) * resolution, length) if steps > 0 else 0.0
