"""What the axes can do: speeds and accelerations from which the time law follows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Protocol

import numpy as np
import numpy.typing as npt

from core.message import CodedError, Message


class MotionError(CodedError):
    """A movement cannot be planned; one sentence says which block, what is wrong and what to do."""


FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]

OVERRIDE_MAX = (
    1.5  # largest feed_scale and rapid_scale; the speed for which an arc keeps acceleration in hand
)
CENTRIPETAL_SHARE = 0.8  # of the acceleration; the rest, in the vector sum, is left for braking on the arc


class AxisLike(Protocol):
    """An axis as a machine file describes it, as far as the time law needs it."""

    @property
    def vmax(self) -> float: ...
    @property
    def amax(self) -> float: ...
    @property
    def count(self) -> float: ...


@dataclass(frozen=True, slots=True)
class MotionLimits:
    """Limits of the axes, slides first, on a lathe X, Z, C: mm/s and mm/s², degrees/s and degrees/s².

    ``interval`` (s) is the time between two setpoints: within it an axis changes its velocity by
    ``amax * interval`` at most, so a corner may ask for as much and no more.
    ``grain`` (mm) is the step to which words are rounded, and by which joints of short chords may be moved
    on each slide; 0 leaves every joint where it is written.

    Raises MotionError where a figure is not positive and finite.
    """

    vmax: tuple[float, ...] = (127.0, 127.0, 1200.0)
    amax: tuple[float, ...] = (3048.0, 3048.0, 12000.0)
    interval: float = 0.001
    grain: float = 0.0

    def __post_init__(self) -> None:
        for name in (f.name for f in fields(self) if f.name in {"vmax", "amax"}):
            for number, value in enumerate(getattr(self, name), start=1):
                _demand_positive(Message("{name} of axis {number}", name=name, number=number), value)
        _demand_positive("interval", self.interval)
        if not 0.0 <= self.grain < math.inf:
            raise MotionError(
                Message(
                    "The axis resolution is {grain} mm. Enter 0 or a positive number.",
                    grain=self.grain,
                ),
                "grain",
            )

    @classmethod
    def of(cls, axes: Sequence[AxisLike], interval: float, corner_tolerance: float = 0.0) -> MotionLimits:
        """The limits of a machine's axes.

        A joint of chords may be moved by ``corner_tolerance`` (mm) as the way of both slides together, and by
        the count on each that rounding takes anyway.
        """
        return cls(
            vmax=tuple(axis.vmax for axis in axes),
            amax=tuple(axis.amax for axis in axes),
            interval=interval,
            grain=max(*(axis.count for axis in axes[:2]), corner_tolerance / math.sqrt(2.0)),
        )

    @property
    def speeds(self) -> FloatArray:
        """``vmax`` as an array (axes,)."""
        return np.array(self.vmax)

    @property
    def accelerations(self) -> FloatArray:
        """``amax`` as an array (axes,)."""
        return np.array(self.amax)

    @property
    def plane_speed(self) -> float:
        """The smaller vmax of a lathe's slides, mm/s: what an arc, turning through all directions, has."""
        return min(self.vmax[:2])

    @property
    def plane_acceleration(self) -> float:
        """The smaller amax of a lathe's slides, mm/s²; see ``plane_speed``."""
        return min(self.amax[:2])


def _demand_positive(what: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise MotionError(
            Message(
                "Motion limit {what} is {value}. Enter a positive number in the machine file.",
                what=what,
                value=value,
            ),
            "axis-limit",
        )
