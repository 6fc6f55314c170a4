"""Measured feature of a part: nominal size, limits, correcting offset and proposed correction.

Lengths are in mm, and diameters are not halved. ``grows`` is +1 if a larger correction makes the feature
larger, or -1 if it makes the feature smaller. A larger X increases any diameter, outside or inside, if the
tool is at positive X, and decreases it if the tool is at negative X. For a length, the sign depends on the
end that the tool cuts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from core.extras.quality.control_charts import SAMPLE_SIZES, QualityError
from core.message import Message

OFFSET_NUMBERS = range(1, 33)
MAX_NAME_LENGTH = 24
MAX_SIZE_MM = 2540.0  # mm, 100 in
MAX_SAMPLE_INTERVAL = 10_000


class FeatureKind(StrEnum):
    """Kind of size of a measured feature: a diameter or a length."""

    DIAMETER = "diameter"
    LENGTH = "length"


class CorrectingOffset(StrEnum):
    """Kind of offset that corrects the feature: the wear of a tool, or a secondary offset."""

    TOOL = "tool"
    SECONDARY = "secondary"


@dataclass(frozen=True, slots=True)
class MeasuredFeature:
    """A measured feature of a part.

    ``low`` and ``high`` are deviations from the nominal size. ``every`` is the sampling interval in parts,
    or 0 if there is no sampling plan.
    """

    name: str
    kind: FeatureKind
    nominal: float
    low: float
    high: float
    by: CorrectingOffset
    number: int
    grows: int = 1
    every: int = 0
    sample: int = 1

    @property
    def axis(self) -> str:
        """Return the axis whose correction changes the feature."""
        return "x" if self.kind is FeatureKind.DIAMETER else "z"

    @property
    def limits(self) -> tuple[float, float]:
        """Return the smallest and the largest permitted size, in mm."""
        return self.nominal + self.low, self.nominal + self.high

    @property
    def middle(self) -> float:
        """Return the target size, which is the middle of the tolerance, in mm."""
        return self.nominal + (self.low + self.high) / 2.0

    @property
    def width(self) -> float:
        """Return the width of the tolerance, in mm."""
        return self.high - self.low

    @property
    def corrected_by(self) -> str:
        """Return the name of the correcting offset and axis, such as ``T3 X`` or ``D4 Z``."""
        return f"{'T' if self.by is CorrectingOffset.TOOL else 'D'}{self.number} {self.axis.upper()}"

    def good(self, size: float) -> bool:
        """Return whether a size is within the tolerance, including its limits."""
        low, high = self.limits
        return low - 1e-9 <= size <= high + 1e-9


def check_feature(feature: MeasuredFeature) -> None:
    """Raise QualityError if the feature cannot be measured or corrected. The message contains a remedy."""
    if not feature.name.strip() or len(feature.name) > MAX_NAME_LENGTH or not feature.name.isprintable():
        raise QualityError(
            Message("a feature name must have 1 to {name_longest} characters", name_longest=MAX_NAME_LENGTH),
            "invalid-name",
        )
    if not all(map(math.isfinite, (feature.nominal, feature.low, feature.high))):
        raise QualityError(
            Message("{feature}: the nominal dimension and the limits must be numbers", feature=feature.name),
            "not-a-number",
        )
    if not 0.0 < feature.nominal <= MAX_SIZE_MM:
        raise QualityError(
            Message(
                "{feature}: the nominal dimension must be more than 0 and at most {size_most} mm",
                feature=feature.name,
                size_most=f"{MAX_SIZE_MM:g}",
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
    if feature.number not in OFFSET_NUMBERS:
        raise QualityError(
            Message(
                "{feature}: the offset number must be 1 to {numbers}, not {number}",
                feature=feature.name,
                numbers=OFFSET_NUMBERS[-1],
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
    if not 0 <= feature.every <= MAX_SAMPLE_INTERVAL:
        raise QualityError(
            Message(
                "{feature}: the measuring interval must be 1 to {every_most} parts, or 0 for "
                "no sampling plan",
                feature=feature.name,
                every_most=MAX_SAMPLE_INTERVAL,
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
MAX_CORRECTION_MM = 2.54
_FAR = 3.0  # tolerance widths; a larger deviation cannot be wear


@dataclass(frozen=True, slots=True)
class CorrectionRule:
    """Rule for corrections, with a dead band and a step.

    A deviation within ``dead_band_fraction`` of the tolerance is not corrected. The ``reading_count``
    newest readings are averaged, and the fraction ``step_fraction`` of their deviation is corrected. A step
    of one half also halves the effect of the variation between parts.
    """

    dead_band_fraction: float = 0.1
    step_fraction: float = 0.5
    reading_count: int = 5


@dataclass(frozen=True, slots=True)
class CorrectionProposal:
    """A proposed correction of a feature.

    ``change_mm`` is the change of the offset in mm, X as a diameter, or 0 if no correction is needed. The
    size changes by ``change_mm`` times ``grows``.
    """

    feature: MeasuredFeature
    reading_count: int  # number of readings used
    mean_size_mm: float
    change_mm: float
    offset_change_mm: float  # the change of the offset, X as a radius
    expected_size_mm: float  # expected size of parts with the correction
    reason: str  # reason why no correction is needed


def propose_correction(
    feature: MeasuredFeature, readings: Sequence[float], resolution: float, rule: CorrectionRule | None = None
) -> CorrectionProposal:
    """Propose a correction from the newest readings since the last correction.

    The change is a multiple of ``resolution`` in mm; X changes as a diameter. Raises QualityError if there
    are no readings, or if a reading is not finite. Also raises it if the deviation of a single reading or
    the change is too large to be wear.
    """
    rule = rule or CorrectionRule()
    if not readings:
        raise QualityError(
            Message("{feature}: no part has been measured since the last correction", feature=feature.name),
            "no-readings",
        )
    newest = np.asarray(readings[-rule.reading_count :], dtype=np.float64)
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
    if abs(deviation) <= rule.dead_band_fraction * feature.width + 1e-12:
        return _nothing(
            feature, len(newest), mean, "the deviation is within the dead band, so no correction is needed"
        )
    change = -feature.grows * _round_to_resolution(rule.step_fraction * deviation, resolution)
    if change == 0.0:
        return _nothing(
            feature,
            len(newest),
            mean,
            "the correction would be less than the smallest offset step, so no correction is needed",
        )
    at_offset = change / 2.0 if feature.axis == "x" else change
    if abs(at_offset) > MAX_CORRECTION_MM:
        raise QualityError(
            Message(
                "{feature}: a correction of {change} mm is too large to be tool wear; touch the tool off",
                feature=feature.name,
                change=f"{change:.4f}",
            ),
            "correction-too-large",
        )
    return CorrectionProposal(
        feature, len(newest), mean, change, at_offset, mean + feature.grows * change, ""
    )


def _nothing(feature: MeasuredFeature, count: int, mean: float, why: str) -> CorrectionProposal:
    return CorrectionProposal(feature, count, mean, 0.0, 0.0, mean, why)


def _round_to_resolution(length: float, resolution: float) -> float:
    """Return a length rounded to the resolution.

    Half steps are rounded toward zero, so that a correction is never too large.
    """
    steps = math.ceil(abs(length) / resolution - 0.5 - 1e-9)
    return math.copysign(max(0, steps) * resolution, length) if steps > 0 else 0.0
