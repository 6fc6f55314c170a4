"""Programmed frame of TRANS, ROT, SCALE and MIRROR in the ZX plane, with the shift of C."""

from __future__ import annotations

from math import cos, radians, sin, sqrt
from typing import NamedTuple


class ProgrammedFrame(NamedTuple):
    """Frame that maps a program point ``p`` to the point M p + (shift_x, shift_z), in mm.

    X is a radius. The matrix M has the rows (xx, xz) and (zx, zz). ``shift_c`` shifts C in degrees.
    Rotation and scaling do not affect other offsets.
    """

    shift_x: float = 0.0
    shift_z: float = 0.0
    shift_c: float = 0.0
    xx: float = 1.0
    xz: float = 0.0
    zx: float = 0.0
    zz: float = 1.0

    @property
    def is_shift_only(self) -> bool:
        """Return whether the frame consists only of a shift."""
        return (self.xx, self.xz, self.zx, self.zz) == (1.0, 0.0, 0.0, 1.0)

    @property
    def is_mirrored(self) -> bool:
        """Return whether the frame reverses the direction of arcs."""
        return self.xx * self.zz - self.xz * self.zx < 0.0

    @property
    def is_uniform(self) -> bool:
        """Return whether both axes have the same scale factor, so that circles remain circles."""
        across = self.xx * self.xx + self.zx * self.zx
        along = self.xz * self.xz + self.zz * self.zz
        return abs(across - along) < 1e-9 * along

    def transform_distance(self, x: float, z: float) -> tuple[float, float]:
        """Convert a distance in the program frame to a machine distance."""
        return self.xx * x + self.xz * z, self.zx * x + self.zz * z

    def invert_distance(self, x: float, z: float) -> tuple[float, float]:
        """Convert a machine distance to a distance in the program frame."""
        whole = self.xx * self.zz - self.xz * self.zx
        return (self.zz * x - self.xz * z) / whole, (self.xx * z - self.zx * x) / whole

    @property
    def scale_factor(self) -> float:
        """Return the factor by which the frame scales lengths, for a frame with equal factors."""
        return sqrt(abs(self.xx * self.zz - self.xz * self.zx))

    def add_shift(self, x: float, z: float, c: float) -> ProgrammedFrame:
        """Return the frame with its zero shifted by a distance in the program frame."""
        dx, dz = self.transform_distance(x, z)
        return self._replace(shift_x=self.shift_x + dx, shift_z=self.shift_z + dz, shift_c=self.shift_c + c)

    def add_rotation(self, angle_deg: float) -> ProgrammedFrame:
        """Return the frame with an additional rotation from Z toward X."""
        a = radians(angle_deg)
        return self._by(cos(a), sin(a), -sin(a), cos(a))

    def add_scaling(self, x_factor: float, z_factor: float) -> ProgrammedFrame:
        """Return the frame with additional scale factors; negative factors mirror an axis."""
        return self._by(x_factor, 0.0, 0.0, z_factor)

    def _by(self, xx: float, xz: float, zx: float, zz: float) -> ProgrammedFrame:
        return self._replace(
            xx=self.xx * xx + self.xz * zx, xz=self.xx * xz + self.xz * zz,
            zx=self.zx * xx + self.zz * zx, zz=self.zx * xz + self.zz * zz,
        )  # fmt: skip
