"""Working plane data of a mill's block."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from core.geometry.rotation_frames import IDENTITY, Matrix, Vector

if TYPE_CHECKING:
    from core.geometry.rotary_axes import FrameTransform, Kinematics

BlankCorners = tuple[Vector, Vector]
RotaryAngles = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True)
class PlaneSystem:
    """Coordinate system of a working plane with a tool, in mm and degrees.

    Blocks share it until either changes.

    ``place`` converts points of the system to machine X Y Z. ``frame`` (rows) and ``datum`` are its axes and
    origin in the workpiece system. ``is_tilted`` is True if a PLANE block defined it, and
    ``plane_block_line`` is the line of that block or 0. ``target_angles`` are Q120, Q121 and Q122.
    ``blank_corners`` are corners of BLK FORM in the workpiece system.
    """

    transform: FrameTransform
    kinematics: Kinematics
    frame: Matrix = IDENTITY
    datum: Vector = (0.0, 0.0, 0.0)
    is_tilted: bool = False
    target_angles: Vector = (0.0, 0.0, 0.0)
    plane_block_line: int = 0
    tool_length_mm: float = 0.0
    blank_corners: BlankCorners | None = None

    @property
    def is_workpiece_system(self) -> bool:
        """Whether this is the workpiece system, without a tilted plane or a datum shift."""
        return not self.is_tilted and self.datum == (0.0, 0.0, 0.0)

    def make_workpiece_system(self) -> PlaneSystem:
        """Return the workpiece system with the same tool, which applies after a program is canceled."""
        place = self.kinematics.make_transform(
            self.kinematics.zero_angles, self.kinematics.workpiece_rotation, tool_length=self.tool_length_mm
        )
        return PlaneSystem(
            place, self.kinematics, tool_length_mm=self.tool_length_mm, blank_corners=self.blank_corners
        )


@dataclass(frozen=True, slots=True)
class PlanePosition:
    """Position of one block in the system that is active at the end of the block.

    ``start end`` are points of that system, and ``machine_position`` is machine X Y Z of the end, in mm.
    ``rotary_angles`` are the displayed A B C (0 to 360 degrees on a modulo axis), with None for an axis that
    the machine does not have.
    """

    start: Vector
    end: Vector
    machine_position: Vector
    rotary_angles: RotaryAngles
    system: PlaneSystem

    def convert_to_workpiece_system(self) -> PlanePosition:
        """Return the same position in the workpiece system."""
        system = self.system.make_workpiece_system()
        end = system.transform.to_frame_point(self.machine_position)
        return replace(self, start=end, end=end, system=system)
