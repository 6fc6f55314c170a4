"""How a solid part is looked at: from which side, how near, and how far it is cut open.

The axis lies across the picture, Z+ to the right. A point stands at the angle phi from the direction in which
the viewer is, towards the top of the picture: so what is seen first has a phi of 0, the top edge 90°.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.part.ray_cuts import FloatArray


@dataclass(frozen=True, slots=True)
class SolidView:
    """``azimuth`` turns the viewer from the side (0) towards the face (90) or the chuck (-90), degrees.

    ``tilt`` lifts him: 0 looks from where the operator stands, 90 from above, as the path view does. ``roll``
    is C. ``scale`` is in pixels a mm, ``centre`` the Z of the middle of the picture. ``opening`` is what is
    cut out, from and to which phi, degrees within -180 … 180; empty: nothing.
    """

    azimuth: float = 30.0
    tilt: float = 35.0
    roll: float = 0.0
    scale: float = 10.0
    centre: float = 0.0
    opening: tuple[float, float] | None = None

    @property
    def along(self) -> tuple[float, float]:
        """Cosine and sine of the azimuth."""
        return math.cos(math.radians(self.azimuth)), math.sin(math.radians(self.azimuth))

    def phi(self, angles: npt.NDArray[np.floating]) -> FloatArray:
        """Phi, radians within -pi … pi, of polar angles of the part, radians.

        The operator stands at lathe X+, which is where polar angles of 180° lie with C at 0.
        """
        phi = math.radians(180.0 - self.tilt - self.roll) - angles
        return np.asarray(np.remainder(phi + math.pi, 2.0 * math.pi) - math.pi, dtype=np.float64)

    def open_at(self, phi: FloatArray) -> npt.NDArray[np.bool_]:
        """Which phi (radians) are cut out."""
        if self.opening is None:
            return np.zeros(phi.shape, dtype=np.bool_)
        first, last = (math.radians(edge) for edge in self.opening)
        return (phi > first) & (phi < last)

    def on_screen(self, points: FloatArray, width: int, height: int) -> FloatArray:
        """Pixels to the right and down (n, 2) of points r, z and polar angle in degrees (n, 3) of the
        part."""
        r, z, angle = points.T
        phi = self.phi(np.radians(angle))
        cos, sin = self.along
        right = (z - self.centre) * cos - r * np.cos(phi) * sin
        return np.column_stack(
            [0.5 * width + self.scale * right, 0.5 * height - self.scale * r * np.sin(phi)]
        )


def fitted(
    back: float, front: float, radius: float, width: int, height: int, azimuth: float
) -> tuple[float, float]:
    """Scale and centre with which a part from Z ``back`` to ``front`` fills the picture, whatever its
    roll."""
    cos, sin = abs(math.cos(math.radians(azimuth))), abs(math.sin(math.radians(azimuth)))
    wide, high = (front - back) * cos + 2.0 * radius * sin, 2.0 * radius
    scale = 0.94 * min(width / max(wide, 1e-6), height / max(high, 1e-6))
    return scale, 0.5 * (back + front)
