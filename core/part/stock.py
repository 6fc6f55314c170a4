"""The stock that a part is made of: bar, tube, or a blank of any profile, in the part's frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Point = tuple[float, float]
"""Z and r, mm."""


@dataclass(frozen=True, slots=True)
class Stock:
    """``outside`` and ``bore`` are profiles of Z and r, mm, Z never falling; no bore: solid.

    ``given`` is what the user has said, in his words; empty where nobody has said anything.
    """

    given: str
    outside: tuple[Point, ...]
    bore: tuple[Point, ...] = ()

    @property
    def back(self) -> float:
        """Least Z of the metal, at the chuck's side."""
        return self.outside[0][0]

    @property
    def front(self) -> float:
        """Z of the face."""
        return self.outside[-1][0]

    @property
    def radius(self) -> float:
        """The greatest radius."""
        return max(r for _, r in self.outside)

    def outside_at(self, z: FloatArray) -> FloatArray:
        """The radius of the outside at each z (n,)."""
        return _at(self.outside, z)

    def bore_at(self, z: FloatArray) -> FloatArray:
        """The radius of the bore at each z (n,), 0 where it is solid."""
        return _at(self.bore, z) if self.bore else np.zeros(len(z))


def _at(profile: Sequence[Point], z: FloatArray) -> FloatArray:
    points = np.array(profile)
    radii: FloatArray = np.interp(z, points[:, 0], points[:, 1], left=0.0, right=0.0)
    return radii


def bar(diameter: float, front: float, back: float, given: str = "") -> Stock:
    """A round bar, mm."""
    return Stock(given, ((back, diameter / 2), (front, diameter / 2)))


def tube(diameter: float, bore: float, front: float, back: float, given: str = "") -> Stock:
    """A tube, mm."""
    return Stock(given, ((back, diameter / 2), (front, diameter / 2)), ((back, bore / 2), (front, bore / 2)))
