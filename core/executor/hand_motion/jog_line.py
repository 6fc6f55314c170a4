"""Line along which a jog moves: a single axis, or an axis of a tilted plane (3D-ROT).

X, Y and Z move together along an axis of a tilted plane.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.machine.machine_model import Axis
from core.ports import MotionSegments

FloatArray = npt.NDArray[np.float64]
Ramp = tuple[float, float, float]  # seconds, speed at its start, acceleration
Direction = tuple[float, float, float]  # unit vector in the machine's X, Y and Z

SOFT_LIMIT_MARGIN = 0.01  # mm or degrees of clearance to the soft limit
_UNIT_TOLERANCE = 1e-6  # tolerance of the length of a direction
_MIN_SHARE = 1e-9  # share below which an axis does not move


def get_distance_to_limit(axis: Axis, position: float, direction: float) -> float:
    """Return the distance to the soft limit in this direction, or 0 if it is less than one encoder count."""
    if axis.travel is None:
        return math.inf
    low, high = axis.travel
    left = (high - position if direction > 0.0 else position - low) - SOFT_LIMIT_MARGIN
    return left if left > axis.count_size else 0.0


@dataclass(frozen=True, slots=True, eq=False)
class JogLine:
    """A straight line of motion in the space of all axes.

    ``unit_direction`` contains, for each axis, its travel per unit of distance along the line. For a single
    axis, this share is 1.
    """

    axes: Sequence[Axis]
    unit_direction: FloatArray

    @classmethod
    def from_axis(cls, axes: Sequence[Axis], index: int) -> JogLine:
        """Return the line along a single axis."""
        shares = np.zeros(len(axes))
        shares[index] = 1.0
        return cls(axes, shares)

    @classmethod
    def from_direction(cls, axes: Sequence[Axis], direction: Direction) -> JogLine:
        """Return the line along a direction in X, Y and Z. An axis with a share near zero does not move."""
        shares = np.zeros(len(axes))
        for name, share in zip("XYZ", direction, strict=True):
            index = next(place for place, axis in enumerate(axes) if axis.name == name)
            shares[index] = share if abs(share) > _MIN_SHARE else 0.0
        return cls(axes, shares)

    def has_same_direction(self, other: JogLine | None) -> bool:
        """Return whether both lines have the same direction."""
        return other is not None and bool(
            np.allclose(self.unit_direction, other.unit_direction, rtol=0.0, atol=_MIN_SHARE)
        )

    def iter_moving_axes(self) -> Iterator[tuple[int, Axis, float]]:
        """Yield the index, the axis and the share of the line's distance for each axis that moves."""
        yield from (
            (place, axis, share)
            for place, (axis, share) in enumerate(zip(self.axes, self.unit_direction.tolist(), strict=True))
            if share
        )

    @property
    def max_acceleration(self) -> float:
        """Return the highest acceleration along the line at which no axis exceeds its own limit."""
        return min(axis.max_acceleration / abs(share) for _, axis, share in self.iter_moving_axes())

    def project_on_line(self, values: FloatArray) -> float:
        """Return the component along the line of a position or velocity that has a value per axis."""
        return float(sum(values[place] * share for place, _, share in self.iter_moving_axes()))

    def get_distance_to_limit(self, position: FloatArray | Sequence[float], sign: float) -> float:
        """Return the distance along the line to the nearest travel limit of an axis.

        ``sign`` is the direction along the line.
        """
        return min(
            get_distance_to_limit(axis, position[place], math.copysign(share, share * sign)) / abs(share)
            for place, axis, share in self.iter_moving_axes()
        )

    def make_setpoints(
        self, start: float, start_position: FloatArray, ramps: Sequence[Ramp]
    ) -> MotionSegments:
        """Return the ramps from the time ``start`` on as setpoints of all axes.

        Axes that do not move remain at ``start_position``.
        """
        n = len(ramps)
        dt = np.array([piece[0] for piece in ramps])
        t = start + np.concatenate([[0.0], np.cumsum(dt)[:-1]])
        v = np.outer([piece[1] for piece in ramps], self.unit_direction)
        a = np.outer([piece[2] for piece in ramps], self.unit_direction)
        position = np.tile(start_position, (n, 1))
        ways = (v + 0.5 * a * dt[:, np.newaxis]) * dt[:, np.newaxis]
        position[1:] += np.cumsum(ways, axis=0)[:-1]
        return MotionSegments(t, dt, position, v, a)


def is_not_unit_vector(direction: Direction) -> bool:
    """Return whether a direction is invalid because its length is not 1."""
    return not abs(math.hypot(*direction) - 1.0) <= _UNIT_TOLERANCE
