"""The stock, its clamping (chuck or collet, tailstock), and the critical speed of a bar."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Point = tuple[float, float]
"""Point with Z and radius, in mm."""

_FIRST_MODE = 1.8751**2  # constant of a beam clamped at one end
_SOUND = 3.5e6  # mm/s, √(E/ρ) of brass; the value for steel and aluminum is 5.0e6
_BODY_LENGTH_MM = 100.0  # mm of chuck body in the model
_QUILL = 60.0  # mm of quill in the model, after the cone of the center


@dataclass(frozen=True, slots=True)
class Stock:
    """The stock, given by its outside profile and its bore profile.

    Profiles contain Z and r in mm, with Z not decreasing. An empty ``bore_profile`` means solid stock.
    ``specification_text`` is the text that the user entered, or an empty string without stock.
    """

    specification_text: str
    outside_profile: tuple[Point, ...]
    bore_profile: tuple[Point, ...] = ()

    @property
    def back_z_mm(self) -> float:
        """Return the least Z of the stock, on the side of the chuck."""
        return self.outside_profile[0][0]

    @property
    def front_z_mm(self) -> float:
        """Return the Z of the face of the stock."""
        return self.outside_profile[-1][0]

    @property
    def max_radius_mm(self) -> float:
        """Return the greatest radius of the outside profile, in mm."""
        return max(r for _, r in self.outside_profile)

    def find_outside_radii(self, z: FloatArray) -> FloatArray:
        """Return the outside radius at each z (n,)."""
        return _at(self.outside_profile, z)

    def find_bore_radii(self, z: FloatArray) -> FloatArray:
        """Return the radius of the bore at each z (n,), or 0 where the stock is solid."""
        return _at(self.bore_profile, z) if self.bore_profile else np.zeros(len(z))


def _at(profile: Sequence[Point], z: FloatArray) -> FloatArray:
    points = np.array(profile)
    radii: FloatArray = np.interp(z, points[:, 0], points[:, 1], left=0.0, right=0.0)
    return radii


def make_bar_stock(diameter: float, front_z_mm: float, back_z_mm: float, specification: str = "") -> Stock:
    """Return a round bar with dimensions in mm."""
    return Stock(specification, ((back_z_mm, diameter / 2), (front_z_mm, diameter / 2)))


def make_tube_stock(
    diameter: float, bore: float, front_z_mm: float, back_z_mm: float, specification: str = ""
) -> Stock:
    """Return a tube with dimensions in mm."""
    return Stock(
        specification,
        ((back_z_mm, diameter / 2), (front_z_mm, diameter / 2)),
        ((back_z_mm, bore / 2), (front_z_mm, bore / 2)),
    )


def calculate_critical_rpm(stock: Stock, stick_out: float) -> float:
    """Return the first critical speed in rpm of the part of the bar that extends from the chuck.

    ``stick_out`` is the distance from the chuck to Z0 in mm; the bar extends to the front of the stock. The
    result is 0 if the bar does not extend from the chuck. The formula is that of a beam clamped at one end,
    1.8751² · √(E·I / (ρ·A)) / L². E and ρ are those of brass, which gives the lowest speed of the usual
    turned materials. A bent bar whirls below this speed.
    """
    length = stick_out + stock.front_z_mm
    if length <= 0.0:
        return 0.0
    bore = max((r for _, r in stock.bore_profile), default=0.0)
    gyration = math.hypot(stock.max_radius_mm, bore) / 2.0
    return _FIRST_MODE * _SOUND * gyration / length**2 * 60.0 / math.tau


@dataclass(frozen=True, slots=True)
class Clamping:
    """A chuck or collet in the part's frame, in mm, with an optional tailstock.

    - The front face is at Z = -``stick_out``.
    - ``jaw_length`` is the length by which the jaws or the nose of a collet extend from the body.
    - A ``max_rpm`` of 0 means not specified.
    - ``quill_diameter`` is the diameter of the tailstock quill, or 0 without a tailstock.
    - The tip of the tailstock center is at ``center_z_mm``. Its included angle is ``center_angle_deg``
      degrees.
    """

    chuck_diameter: float
    stick_out: float
    jaw_length: float = 0.0
    jaw_diameter: float = 0.0
    max_rpm: float = 0.0
    quill_diameter: float = 0.0
    center_angle_deg: float = 60.0
    center_z_mm: float = 0.0

    @property
    def chuck_outline(self) -> tuple[Point, ...]:
        """Return the outside points (Z, r) of the chuck, with Z ascending."""
        face, body = -self.stick_out, -self.stick_out - self.jaw_length
        front = ((body, self.jaw_diameter / 2), (face, self.jaw_diameter / 2)) if self.jaw_length else ()
        return ((body - _BODY_LENGTH_MM, self.chuck_diameter / 2), (body, self.chuck_diameter / 2), *front)

    def make_chuck_for_stock(self, stock: Stock) -> Stock:
        """Return the material of the chuck or collet around the clamped stock."""
        inside = min(
            stock.max_radius_mm, self.chuck_diameter / 2, (self.jaw_diameter or self.chuck_diameter) / 2
        )
        back, front = self.chuck_outline[0][0], self.chuck_outline[-1][0]
        return Stock("", self.chuck_outline, ((back, inside), (front, inside)))

    @property
    def tailstock_solid(self) -> Stock | None:
        """Return the center and the quill of the tailstock as a solid, or None without a tailstock."""
        if not self.quill_diameter:
            return None
        radius = self.quill_diameter / 2.0
        cone = self.center_z_mm + radius / math.tan(math.radians(self.center_angle_deg / 2.0))
        return Stock("", ((self.center_z_mm, 0.0), (cone, radius), (cone + _QUILL, radius)))
