"""What a block of a mill says besides its axes: where it stands in its working plane."""

from __future__ import annotations

from dataclasses import dataclass, replace

from core.geometry.rotary_axes import Kinematics, Place
from core.geometry.rotation_frames import IDENTITY, Matrix, Vector

Corners = tuple[Vector, Vector]
Angles = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True)
class PlaneSystem:
    """A working plane's system with a tool in it; blocks share it until one of both changes. mm, degrees.

    ``place`` takes points of the system to machine X Y Z. ``frame`` (rows) and ``datum`` are its axes and
    origin in the workpiece's system, ``tilted`` whether a PLANE block made it, ``line`` that block's line (0:
    none). ``targets`` are Q120, Q121, Q122. ``blank``: corners of BLK FORM in the workpiece's system.
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
        """Whether it is the workpiece's own system: no plane, no datum shifted."""
        return not self.tilted and self.datum == (0.0, 0.0, 0.0)

    def levelled(self) -> PlaneSystem:
        """The workpiece's own system with the same tool: what is left when a program has been given up."""
        place = self.kinematics.place(
            self.kinematics.zero, self.kinematics.basic, tool_length=self.tool_length
        )
        return PlaneSystem(place, self.kinematics, tool_length=self.tool_length, blank=self.blank)


@dataclass(frozen=True, slots=True)
class Swivel:
    """One block in the system that is in force at its end.

    ``start end`` are points of that system, ``slides`` machine X Y Z of the end, mm; ``rotary`` A B C shown
    (0 to 360 on a modulo axis), None for axes the machine lacks.
    """

    start: Vector
    end: Vector
    slides: Vector
    rotary: Angles
    system: PlaneSystem

    def levelled(self) -> Swivel:
        """The same place in the workpiece's own system."""
        system = self.system.levelled()
        end = system.place.point(self.slides)
        return replace(self, start=end, end=end, system=system)
