"""Axis speed and acceleration limits for the motion planner."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Protocol

import numpy as np
import numpy.typing as npt

from core.message import CodedError, Message


class MotionError(CodedError):
    """Error raised if a motion cannot be planned.

    The message names the block, the fault and the remedy.
    """


FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]

OVERRIDE_MAX = 1.5  # largest feed_scale and rapid_scale, for which arcs reserve acceleration
CENTRIPETAL_SHARE = 0.8  # fraction of the acceleration; the rest of the vector sum is for braking on the arc


class AxisLike(Protocol):
    """The properties of an axis that the motion planner needs."""

    @property
    def max_speed(self) -> float:
        """Return the maximum speed of the axis in mm/s, or degrees/s for a rotary axis."""
        ...

    @property
    def max_acceleration(self) -> float:
        """Return the maximum acceleration of the axis in mm/s², or degrees/s² for a rotary axis."""
        ...

    @property
    def count_size(self) -> float:
        """Return the size of one encoder count in mm, or in degrees for a rotary axis."""
        ...


@dataclass(frozen=True, slots=True)
class MotionLimits:
    """The speed and acceleration limits of the axes, with the linear axes first.

    Units are mm/s and mm/s², or degrees/s and degrees/s². A lathe has the order X, Z, C.
    - ``interval`` (s) is the time between two setpoints. Within an interval, an axis changes its velocity
      by at most ``amax * interval``. This also limits the velocity step at a corner.
    - ``grain`` (mm) is the resolution of programmed coordinates. Where two short chords meet, the common
      point may be moved by this distance on each axis. If ``grain`` is 0, no point is moved.

    Raises MotionError if a speed, an acceleration or the interval is not positive and finite, or if
    ``grain`` is negative or not finite.
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
    def from_axes(
        cls, axes: Sequence[AxisLike], interval: float, corner_tolerance: float = 0.0
    ) -> MotionLimits:
        """Return the limits of a machine's axes.

        ``corner_tolerance`` (mm) is the distance, in X and Z together, by which the common point of two
        chords may be moved. On each axis, the point may always be moved by one encoder count.
        """
        return cls(
            vmax=tuple(axis.max_speed for axis in axes),
            amax=tuple(axis.max_acceleration for axis in axes),
            interval=interval,
            grain=max(*(axis.count_size for axis in axes[:2]), corner_tolerance / math.sqrt(2.0)),
        )

    @property
    def speeds(self) -> FloatArray:
        """Return ``vmax`` as an array of shape (axes,)."""
        return np.array(self.vmax)

    @property
    def max_acceleration_array(self) -> FloatArray:
        """Return ``amax`` as an array of shape (axes,)."""
        return np.array(self.amax)

    @property
    def max_plane_speed(self) -> float:
        """Return the speed in mm/s that a lathe can use in every direction of the XZ plane.

        This is the smaller ``vmax`` of X and Z.
        """
        return min(self.vmax[:2])

    @property
    def max_plane_acceleration(self) -> float:
        """Return the acceleration in mm/s² that a lathe can use in every direction of the XZ plane.

        This is the smaller ``amax`` of X and Z.
        """
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
