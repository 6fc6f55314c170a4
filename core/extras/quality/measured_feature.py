"""A feature of a part that is measured: nominal, limits, and the tool or secondary offset that corrects it.

Lengths mm; a diameter is a diameter. ``grows`` says what the feature does when the correction grows: +1 it
grows with it, -1 it shrinks. A diameter, outside or inside, grows with X of a tool at X positive, and shrinks
with that of a tool at X negative; a length grows or shrinks with Z by the end at which the tool cuts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from core.extras.quality.control_charts import SAMPLE_SIZES
from core.extras.quality.quality_errors import QualityError
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
