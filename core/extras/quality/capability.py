"""Capability of a process: Cp, Cpk from the scatter within samples, Pp, Ppk from all of it (ISO 22514-2)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.extras.quality.control_charts import charts_of
from core.extras.quality.quality_errors import QualityError
from core.message import Message

LEAST = 10  # readings below which no capability is told: it would be luck
_ONE_SIDED_95 = 1.645  # of the normal distribution


@dataclass(frozen=True, slots=True)
class Capability:
    """None where there is no limit on one side (Cp, Pp), or nothing scatters."""

    count: int
    mean: float
    within: float  # standard deviation within samples
    cp: float | None
    cpk: float | None
    pp: float | None
    ppk: float | None

    @property
    def at_least(self) -> float | None:
        """What Cpk is with 95 % confidence at least, after Bissell (1990): few readings promise little."""
        if self.cpk is None:
            return None
        n = self.count
        return self.cpk - _ONE_SIDED_95 * math.sqrt(1.0 / (9.0 * n) + self.cpk**2 / (2.0 * (n - 1)))


def capability(
    values: Sequence[float], lower: float | None, upper: float | None, size: int = 1
) -> Capability:
    """Of values in the order of the parts against limits of size, in samples of ``size``.

    Raises QualityError for fewer than 10 values, no limit at all, or limits the wrong way round.
    """
    if lower is None and upper is None:
        raise QualityError(
            "process capability needs a tolerance; enter a tolerance for this feature", "no-tolerance"
        )
    if lower is not None and upper is not None and lower >= upper:
        raise QualityError(
            "the lower limit must be below the upper limit; correct the tolerance", "limits-reversed"
        )
    if len(values) < LEAST:
        raise QualityError(
            Message(
                "{values_count} readings are not enough; a Cpk needs at least {minimum} readings",
                values_count=len(values),
                minimum=LEAST,
            ),
            "too-few-readings",
        )
    within = charts_of(values, size).within
    mean, overall = float(np.mean(values)), float(np.std(values, ddof=1))  # of all values, n − 1
    cp, cpk = _indices(mean, within, lower, upper)
    pp, ppk = _indices(mean, overall, lower, upper)
    return Capability(len(values), mean, within, cp, cpk, pp, ppk)


def _indices(
    mean: float, sigma: float, lower: float | None, upper: float | None
) -> tuple[float | None, float | None]:
    """Width of the tolerance by six standard deviations; distance of the nearer limit by three."""
    if sigma <= 1e-12:
        return None, None  # a gauge that reads too coarsely to see the scatter
    near = [
        (upper - mean) if upper is not None else math.inf,
        (mean - lower) if lower is not None else math.inf,
    ]
    width = (upper - lower) / (6.0 * sigma) if upper is not None and lower is not None else None
    return width, min(near) / (3.0 * sigma)
