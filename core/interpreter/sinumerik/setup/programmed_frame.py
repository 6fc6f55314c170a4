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
    matrix_xx: float = 1.0
    matrix_xz: float = 0.0
    matrix_zx: float = 0.0
    matrix_zz: float = 1.0

    @property
    def is_shift_only(self) -> bool:
        """Return whether the frame consists only of a shift."""
        return (self.matrix_xx, self.matrix_xz, self.matrix_zx, self.matrix_zz) == (1.0, 0.0, 0.0, 1.0)

    @property
    def is_mirrored(self) -> bool:
        """Return whether the frame reverses the direction of arcs."""
        return self.matrix_xx * self.matrix_zz - self.matrix_xz * self.matrix_zx < 0.0

    @property
    def has_uniform_scale(self) -> bool:
        """Return whether both axes have the same scale factor, so that circles remain circles."""
        across = self.matrix_xx * self.matrix_xx + self.matrix_zx * self.matrix_zx
        along = self.matrix_xz * self.matrix_xz + self.matrix_zz * self.matrix_zz
        return abs(across - along) < 1e-9 * along

    def convert_to_machine_distance(self, x: float, z: float) -> tuple[float, float]:
        """Convert a distance in the program frame to a machine distance."""
        return self.matrix_xx * x + self.matrix_xz * z, self.matrix_zx * x + self.matrix_zz * z

    def convert_to_program_distance(self, x: float, z: float) -> tuple[float, float]:
        """Convert a machine distance to a distance in the program frame."""
        whole = self.matrix_xx * self.matrix_zz - self.matrix_xz * self.matrix_zx
        return (self.matrix_zz * x - self.matrix_xz * z) / whole, (
            self.matrix_xx * z - self.matrix_zx * x
        ) / whole

    @property
    def scale_factor(self) -> float:
        """Return the factor by which the frame scales lengths, for a frame with equal factors."""
        return sqrt(abs(self.matrix_xx * self.matrix_zz - self.matrix_xz * self.matrix_zx))

    def add_shift(self, x: float, z: float, c: float) -> ProgrammedFrame:
        """Return the frame with its zero shifted by a distance in the program frame."""
        dx, dz = self.convert_to_machine_distance(x, z)
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
            matrix_xx=self.matrix_xx * xx + self.matrix_xz * zx,
            matrix_xz=self.matrix_xx * xz + self.matrix_xz * zz,
            matrix_zx=self.matrix_zx * xx + self.matrix_zz * zx,
            matrix_zz=self.matrix_zx * xz + self.matrix_zz * zz,
        )
