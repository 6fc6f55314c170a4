"""XC: a virtual mill on the face of the part. Mill X to the right and Y up for a tool that looks at the face.

The live tool stands on the negative X side of the lathe. A point (X, Y) of the part at the distance rho from
the axis comes under the tool when X stands at -sqrt(rho² - H²) and C has turned the point there; H is how far
the tool's centre line lies above the spindle's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Face:
    """``c0`` (degrees) is C at the entry, ``h`` (mm) the height of the tool's centre line."""

    c0: float
    h: float = 0.0

    def machine(self, points: FloatArray, theta: FloatArray) -> FloatArray:
        """Lathe X (radius), Z, C (n, 3) of mill points X, Y, Z (n, 3); mm and degrees.

        ``theta`` (n,) is the polar angle of the points in radians, counted on without wrapping. A point
        nearer to the axis than |h| cannot be reached; it is taken to be at |h|.
        """
        rho = np.hypot(points[:, 0], points[:, 1])
        x = -np.sqrt(np.maximum((rho - self.h) * (rho + self.h), 0.0))
        lead = np.arctan2(np.full(len(x), self.h), -x) if self.h else np.zeros(len(x))
        return np.column_stack([x, points[:, 2], self.c0 + np.degrees(lead - theta)])

    def mill(self, machine: FloatArray) -> FloatArray:
        """Mill points X, Y, Z (n, 3) that stand under the tool at lathe X, Z, C (n, 3)."""
        x = -machine[:, 0]
        rho = np.hypot(x, self.h)
        theta = np.arctan2(self.h, x) - np.radians(machine[:, 2] - self.c0)
        return np.column_stack([rho * np.cos(theta), rho * np.sin(theta), machine[:, 1]])
