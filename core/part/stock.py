"""The stock, what holds it (chuck or collet, tailstock), and the speed at which a bar whirls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Point = tuple[float, float]
"""Z and r, mm."""

_FIRST_MODE = 1.8751**2  # of a beam clamped at one end
_SOUND = 3.5e6  # mm/s, √(E/ρ) of brass; in steel and aluminium it is 5.0e6
_BEHIND = 100.0  # mm of body behind its front
_QUILL = 60.0  # mm of quill behind the cone of its centre


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


def whirling_rpm(stock: Stock, stick_out: float) -> float:
    """The first critical speed of a bar that stands ``stick_out`` mm out of its chuck up to Z0, rpm; 0: none.

    That of a beam clamped at one end: 1.8751² · √(E·I / (ρ·A)) / L², with brass for E and ρ, the slowest of
    what is turned in metal. A bar that bends by itself whirls below it.
    """
    length = stick_out + stock.front
    if length <= 0.0:
        return 0.0
    bore = max((r for _, r in stock.bore), default=0.0)
    gyration = math.hypot(stock.radius, bore) / 2.0
    return _FIRST_MODE * _SOUND * gyration / length**2 * 60.0 / math.tau


@dataclass(frozen=True, slots=True)
class Clamping:
    """Chuck or collet in the part's frame, mm: its foremost face stands ``stick_out`` behind part zero.

    ``jaws`` is how far jaws, or the nose of a collet, stand before the body. ``max_rpm`` 0: not stated.
    ``quill`` is the diameter of a tailstock's quill, 0: there is none; the tip of its centre, ``point``
    degrees, stands at Z ``centre``.
    """

    diameter: float
    stick_out: float
    jaws: float = 0.0
    jaw_diameter: float = 0.0
    max_rpm: float = 0.0
    quill: float = 0.0
    point: float = 60.0
    centre: float = 0.0

    @property
    def outline(self) -> tuple[Point, ...]:
        """Z and r of its outside, Z rising."""
        face, body = -self.stick_out, -self.stick_out - self.jaws
        front = ((body, self.jaw_diameter / 2), (face, self.jaw_diameter / 2)) if self.jaws else ()
        return ((body - _BEHIND, self.diameter / 2), (body, self.diameter / 2), *front)

    def around(self, stock: Stock) -> Stock:
        """Its metal around the stock that it holds."""
        inside = min(stock.radius, self.diameter / 2, (self.jaw_diameter or self.diameter) / 2)
        back, front = self.outline[0][0], self.outline[-1][0]
        return Stock("", self.outline, ((back, inside), (front, inside)))

    @property
    def tailstock(self) -> Stock | None:
        """Centre and quill, None where there is none."""
        if not self.quill:
            return None
        radius = self.quill / 2.0
        cone = self.centre + radius / math.tan(math.radians(self.point / 2.0))
        return Stock("", ((self.centre, 0.0), (cone, radius), (cone + _QUILL, radius)))
