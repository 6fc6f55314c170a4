"""Working plane data of a mill's block."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from core.geometry.rotation_frames import IDENTITY, Matrix, Vector

if TYPE_CHECKING:
    from core.geometry.rotary_axes import Kinematics, Place

Corners = tuple[Vector, Vector]
Angles = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True)
class PlaneSystem:
    """Coordinate system of a working plane with a tool, in mm and degrees.

    Blocks share it until either changes.

    ``place`` converts points of the system to machine X Y Z. ``frame`` (rows) and ``datum`` are its axes and
    origin in the workpiece system. ``tilted`` is True if a PLANE block defined it, and ``line`` is the line
    of that block or 0. ``targets`` are Q120, Q121 and Q122. ``blank`` are corners of BLK FORM in the
    workpiece system.
    """

    place: Place
    kinematics: Kinematics
    frame: Matrix = IDENTITY
    datum: Vector = (0.0, 0.0, 0.0)
    tilted: bool = False
    targets: Vector = (0.0, 0.0, 0.0)
    line: int = 0
    tool_length: float = 0.0
    blank: Corners | None = None

    @property
    def level(self) -> bool:
        """Whether this is the workpiece system, without a tilted plane or a datum shift."""
        return not self.tilted and self.datum == (0.0, 0.0, 0.0)

    def levelled(self) -> PlaneSystem:
        """Return the workpiece system with the same tool, which applies after a program is canceled."""
        place = self.kinematics.place(
            self.kinematics.zero, self.kinematics.basic, tool_length=self.tool_length
        )
        return PlaneSystem(place, self.kinematics, tool_length=self.tool_length, blank=self.blank)


@dataclass(frozen=True, slots=True)
class Swivel:
    """Position of one block in the system that is active at the end of the block.

    ``start end`` are points of that system, and ``slides`` is machine X Y Z of the end, in mm. ``rotary`` are
    the displayed A B C (0 to 360 degrees on a modulo axis), with None for an axis that the machine does not
    have.
    """

    start: Vector
    end: Vector
    slides: Vector
    rotary: Angles
    system: PlaneSystem

    def levelled(self) -> Swivel:
        """Return the same position in the workpiece system."""
        system = self.system.levelled()
        end = system.place.point(self.slides)
        return replace(self, start=end, end=end, system=system)
