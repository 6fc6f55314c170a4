"""Rotary axes that turn while the slides follow, so that a point keeps its place on the workpiece (MOVE)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.frames import Vector, plus, scaled
from core.geometry.kinematics import Kinematics, Place

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PivotWay:
    """From the angles ``start`` to ``end`` in proportion; ``pivot`` stays (mm, machine-parallel system at the
    workpiece's zero), ``distance`` mm below the tip along the tool. ``length`` in degrees.
    """

    kinematics: Kinematics
    start: Mapping[str, float]
    end: Mapping[str, float]
    pivot: Vector
    distance: float
    tool_length: float
    length: float

    @property
    def straight(self) -> bool:
        """The slides never run in proportion to the angles."""
        return False

    def slides(self, angles: Mapping[str, float]) -> Vector:
        """Machine position of X Y Z at these angles, mm."""
        up = scaled(self.kinematics.tool_axis(angles), self.distance)
        return plus(self._place(angles).machine(self.pivot), up)

    def machine(self, share: FloatArray) -> FloatArray:
        """Machine positions (k, axes), in the machine's order, at fractions (k,) of the way."""
        rows = []
        for fraction in share.tolist():
            angles = {name: at + fraction * (self.end[name] - at) for name, at in self.start.items()}
            places = angles | dict(zip("XYZ", self.slides(angles), strict=True))
            rows.append([places[name] for name in self.kinematics.names])
        return np.array(rows)

    def part(self, points: FloatArray) -> FloatArray:
        """Where the tip is on the workpiece (k, 3), mm, at machine positions (k, axes)."""
        names = self.kinematics.names
        rows = []
        for row in points.tolist():
            at = dict(zip(names, row, strict=True))
            rows.append(self._place(at).point((at["X"], at["Y"], at["Z"])))
        return np.array(rows)

    def nearest(self) -> float:
        """The middle: no fraction is harder than another."""
        return 0.5

    def _place(self, angles: Mapping[str, float]) -> Place:
        return self.kinematics.place(angles, tool_length=self.tool_length)
