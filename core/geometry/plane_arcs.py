"""Arcs and helices of a mill, on machine axes: in its working plane, or upright in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import Arc
from core.geometry.rotary_axes import Place
from core.geometry.rotation_frames import IDENTITY, Matrix

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class HelixMove:
    """``arc`` in X Y of the system that ``place`` takes to the machine, while Z goes from ``z0`` to ``z1``.

    ``standing`` are the machine positions of all axes in the machine's order, of which X, Y and Z, at
    ``columns``, move; mm, degrees. Of an upright arc ``frame`` (rows) holds the directions, in that system,
    of the two axes that it lies in and of the third: X Y Z of the arc are those then.
    """

    place: Place
    arc: Arc
    z0: float
    z1: float
    standing: tuple[float, ...]
    columns: tuple[int, int, int]
    frame: Matrix = IDENTITY

    @property
    def length(self) -> float:
        """Length of the path, mm."""
        return math.hypot(self.arc.length, self.z1 - self.z0)

    @property
    def in_degrees(self) -> bool:
        """Whether the feed counts degrees: it counts mm."""
        return False

    @property
    def straight(self) -> bool:
        """The slides never run in proportion to each other."""
        return False

    def machine(self, share: FloatArray) -> FloatArray:
        """Machine positions (k, axes), in the machine's order, at fractions (k,) of the way."""
        (cx, cy), (x0, y0), radius = self.arc.centre, self.arc.start, self.arc.radius
        # A positive sweep is clockwise, seen with X to the right and Y up.
        angle = math.atan2(y0 - cy, x0 - cx) - self.arc.sweep * share
        z = self.z0 + share * (self.z1 - self.z0)
        points = np.stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle), z], axis=1)
        rows = np.repeat(np.array([self.standing]), len(share), axis=0)
        turn = np.array(self.place.turn) @ np.array(self.frame)
        rows[:, self.columns] = points @ turn.T + np.array(self.place.shift)
        return rows

    def part(self, points: FloatArray) -> FloatArray:
        """Points (k, 3) of the working plane's system at machine positions (k, axes)."""
        spots: FloatArray = (points[:, self.columns] - np.array(self.place.shift)) @ np.array(self.place.turn)
        return spots

    def nearest(self) -> float:
        """The middle: no fraction is harder than another."""
        return 0.5
