"""TRANS, ROT, SCALE and MIRROR of SINUMERIK: the programmed frame of the plane Z X, and the shift of C."""

from __future__ import annotations

from math import cos, radians, sin, sqrt
from typing import NamedTuple


class ProgrammedFrame(NamedTuple):
    """A point ``p`` of the program lies at M p + (x, z): mm, X a radius; ``c`` is the shift of C, degrees.

    M has the rows ``xx xz`` and ``zx zz``; the zero itself is shifted only, so that no turn and no factor
    touches what offsets say.
    """

    x: float = 0.0
    z: float = 0.0
    c: float = 0.0
    xx: float = 1.0
    xz: float = 0.0
    zx: float = 0.0
    zz: float = 1.0

    @property
    def plain(self) -> bool:
        """Whether it only shifts."""
        return (self.xx, self.xz, self.zx, self.zz) == (1.0, 0.0, 0.0, 1.0)

    @property
    def mirrored(self) -> bool:
        """Whether clockwise has become counter-clockwise in it."""
        return self.xx * self.zz - self.xz * self.zx < 0.0

    @property
    def uniform(self) -> bool:
        """Whether circles stay circles: both axes have one factor."""
        across = self.xx * self.xx + self.zx * self.zx
        along = self.xz * self.xz + self.zz * self.zz
        return abs(across - along) < 1e-9 * along

    def turned(self, x: float, z: float) -> tuple[float, float]:
        """A distance of the program as one of the machine."""
        return self.xx * x + self.xz * z, self.zx * x + self.zz * z

    def unturned(self, x: float, z: float) -> tuple[float, float]:
        """A distance of the machine as one of the program."""
        whole = self.xx * self.zz - self.xz * self.zx
        return (self.zz * x - self.xz * z) / whole, (self.xx * z - self.zx * x) / whole

    @property
    def factor(self) -> float:
        """By what lengths grow where circles stay circles."""
        return sqrt(abs(self.xx * self.zz - self.xz * self.zx))

    def shifted(self, x: float, z: float, c: float) -> ProgrammedFrame:
        """The same with its zero moved by a distance of the program."""
        dx, dz = self.turned(x, z)
        return self._replace(x=self.x + dx, z=self.z + dz, c=self.c + c)

    def rotated(self, degrees: float) -> ProgrammedFrame:
        """Turned further, from Z towards X."""
        a = radians(degrees)
        return self._by(cos(a), sin(a), -sin(a), cos(a))

    def scaled(self, x: float, z: float) -> ProgrammedFrame:
        """With these factors besides; under 0 they mirror."""
        return self._by(x, 0.0, 0.0, z)

    def _by(self, xx: float, xz: float, zx: float, zz: float) -> ProgrammedFrame:
        return self._replace(
            xx=self.xx * xx + self.xz * zx, xz=self.xx * xz + self.xz * zz,
            zx=self.zx * xx + self.zz * zx, zz=self.zx * xz + self.zz * zz,
        )  # fmt: skip
