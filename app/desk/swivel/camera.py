"""From the machine's space to the picture: a parallel projection from a chosen side."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
_STEP = 1.25  # of a zoom
_PAN = 0.15  # of the picture's smaller side


@dataclass(frozen=True, slots=True)
class Aspect:
    """Where one looks from: degrees about Z from the front (negative Y) to the right, and above the table."""

    name: str
    around: float
    above: float


ASPECTS = (
    Aspect("3-D", 46.0, 36.0),
    Aspect("FRONT", 0.0, 0.0),
    Aspect("RIGHT", 90.0, 0.0),
    Aspect("TOP", 0.0, 90.0),
)


@dataclass(frozen=True, slots=True)
class Camera:
    """Looks at ``centre`` (mm, machine); ``radius`` mm around it fill the picture at ``nearness`` 1."""

    centre: tuple[float, float, float]
    radius: float
    aspect: int = 0
    nearness: float = 1.0
    across: float = 0.0  # of the picture's smaller side, by which it was moved
    down: float = 0.0

    @property
    def shown(self) -> Aspect:
        """The side one looks from."""
        return ASPECTS[self.aspect % len(ASPECTS)]

    def following(self) -> Camera:
        """From the next side, the whole again."""
        return replace(self, aspect=(self.aspect + 1) % len(ASPECTS), nearness=1.0, across=0.0, down=0.0)

    def fitted(self) -> Camera:
        """The whole again."""
        return replace(self, nearness=1.0, across=0.0, down=0.0)

    def zoomed(self, steps: int) -> Camera:
        """Nearer by so many steps."""
        return replace(self, nearness=min(40.0, max(0.2, self.nearness * _STEP**steps)))

    def panned(self, across: int, down: int) -> Camera:
        """Look further right and down."""
        return replace(self, across=self.across - _PAN * across, down=self.down - _PAN * down)

    @property
    def axes(self) -> FloatArray:
        """Rows: right, down and towards the eye, as unit vectors of the machine."""
        around, above = math.radians(self.shown.around), math.radians(self.shown.above)
        ca, sa, ce, se = math.cos(around), math.sin(around), math.cos(above), math.sin(above)
        right, eye = (ca, sa, 0.0), (sa * ce, -ca * ce, se)
        down = (sa * se, -ca * se, -ce)
        return np.array((right, down, eye))

    def seen(self, points: FloatArray, width: float, height: float) -> FloatArray:
        """Pixels x, y and depth towards the eye (n, 3) of machine points (n, 3)."""
        size = min(width, height)
        scale = self.nearness * size / (2.0 * self.radius)
        found = (points - np.array(self.centre)) @ self.axes.T * scale
        found[:, 0] += width / 2.0 + self.across * size
        found[:, 1] += height / 2.0 + self.down * size
        return np.asarray(found)
