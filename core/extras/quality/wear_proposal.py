"""The wear correction proposed from readings: mean deviation, dead band, a share of it as the step.

Nothing here changes an offset. Tables of offsets hold the machine position of the tip on part zero, so what
is added to X or Z moves the cut surface by as much, X at the radius: a diameter that is .010 too large at a
tool of X positive wants .010 less of its wear as a diameter, an inside diameter just as an outside one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.extras.quality.measured_feature import Feature
from core.extras.quality.quality_errors import QualityError
from core.message import Message

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
