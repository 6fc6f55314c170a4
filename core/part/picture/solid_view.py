"""The view of a solid part: direction, scale and opening.

The axis is horizontal in the picture, with Z+ to the right. The angle phi of a point is measured from the
direction of the viewer toward the top of the picture. The point closest to the viewer has a phi of 0°, and
the top edge has a phi of 90°.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from core.part.ray_cuts import FloatArray


@dataclass(frozen=True, slots=True)
class SolidView:
    """The view of a solid part: direction of the viewer, scale and cut-open range.

    - ``azimuth_deg`` rotates the viewer from the side (0) to the face (90) or the chuck (-90).
    - ``tilt_deg`` raises the viewer: 0 is the position of the operator, and 90 is the view from above.
    - ``roll_deg`` is the angle of C.
    - ``pixels_per_mm`` is the scale, and ``center_z_mm`` is the Z of the middle of the picture.
    - ``cut_out_range_deg`` is the range of phi that is cut open, within -180 to 180, or None if the part is
      closed.
    - ``offset_px`` moves the picture to the right and down, in pixels.
    """

    azimuth_deg: float = 30.0
    tilt_deg: float = 35.0
    roll_deg: float = 0.0
    pixels_per_mm: float = 10.0
    center_z_mm: float = 0.0
    cut_out_range_deg: tuple[float, float] | None = None
    offset_px: tuple[float, float] = (0.0, 0.0)

    @property
    def azimuth_cos_sin(self) -> tuple[float, float]:
        """Return the cosine and the sine of the azimuth."""
        return math.cos(math.radians(self.azimuth_deg)), math.sin(math.radians(self.azimuth_deg))

    def convert_to_viewer_angles(self, angles: npt.NDArray[np.floating]) -> FloatArray:
        """Return phi from -pi to pi for polar angles of the part; all angles are in radians.

        The operator is at X+ of the lathe, which is the polar angle 180° with C at 0.
        """
        phi = math.radians(180.0 - self.tilt_deg - self.roll_deg) - angles
        return np.asarray(np.remainder(phi + math.pi, 2.0 * math.pi) - math.pi, dtype=np.float64)

    def is_cut_out(self, phi: FloatArray) -> npt.NDArray[np.bool_]:
        """Return a mask of the values of phi (radians) that are within the cut-open range."""
        if self.cut_out_range_deg is None:
            return np.zeros(phi.shape, dtype=np.bool_)
        first, last = (math.radians(edge) for edge in self.cut_out_range_deg)
        return (phi > first) & (phi < last)

    def project_to_screen(self, points: FloatArray, width: int, height: int) -> FloatArray:
        """Return the screen positions (n, 2) of points, in pixels to the right and down.

        ``points`` (n, 3) are r, z and the polar angle in degrees.
        """
        r, z, angle = points.T
        phi = self.convert_to_viewer_angles(np.radians(angle))
        cos, sin = self.azimuth_cos_sin
        right = (z - self.center_z_mm) * cos - r * np.cos(phi) * sin
        return np.column_stack(
            [
                0.5 * width + self.offset_px[0] + self.pixels_per_mm * right,
                0.5 * height + self.offset_px[1] - self.pixels_per_mm * r * np.sin(phi),
            ]
        )


def make_coarse_view(view: SolidView, width: int, height: int, pixel_size: int) -> tuple[SolidView, int, int]:
    """Return the view, width and height of a coarse picture.

    Each of its pixels replaces ``pixel_size`` pixels to the right and down.
    """
    small = -(-width // pixel_size), -(-height // pixel_size)
    offset = tuple(
        (each + 0.5 * whole) / pixel_size - 0.5 * count
        for each, whole, count in zip(view.offset_px, (width, height), small, strict=True)
    )
    coarse = replace(view, pixels_per_mm=view.pixels_per_mm / pixel_size, offset_px=(offset[0], offset[1]))
    return coarse, *small


def fit_view(
    back_z_mm: float, front_z_mm: float, radius: float, width: int, height: int, azimuth_deg: float
) -> tuple[float, float]:
    """Return the scale in pixels/mm and the center Z at which a part fills the picture at any roll.

    The part extends from Z ``back_z_mm`` to ``front_z_mm``, and its radius is ``radius`` mm.
    """
    cos, sin = abs(math.cos(math.radians(azimuth_deg))), abs(math.sin(math.radians(azimuth_deg)))
    wide, high = (front_z_mm - back_z_mm) * cos + 2.0 * radius * sin, 2.0 * radius
    scale = 0.94 * min(width / max(wide, 1e-6), height / max(high, 1e-6))
    return scale, 0.5 * (back_z_mm + front_z_mm)
