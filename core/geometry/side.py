"""ZC: a virtual mill on the side of the part, unrolled at a diameter.

Mill X is to the right, which is towards the spindle, and Y up for a tool that looks at the part from the
negative X side; Z is how far out the tip stands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Side:
    """``c0`` (degrees) and ``z0`` (mm) are C and lathe Z of X0 Y0; Y is measured at ``diameter`` (mm)."""

    c0: float
    z0: float
    diameter: float

    def machine(self, points: FloatArray) -> FloatArray:
        """Lathe X (radius), Z, C (n, 3) of mill points X, Y, Z (n, 3), Z as a radius; mm and degrees."""
        x, y, z = points.T
        c = self.c0 - y * (360.0 / (math.pi * self.diameter))
        return np.column_stack([-z, self.z0 - x, c])

    def mill(self, machine: FloatArray) -> FloatArray:
        """Mill points X, Y, Z (n, 3), Z as a radius, of lathe X, Z, C (n, 3)."""
        x, z, c = machine.T
        return np.column_stack([self.z0 - z, (self.c0 - c) * (math.pi * self.diameter / 360.0), -x])
