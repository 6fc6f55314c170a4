"""The working plane of a mill, and the position of a block in this plane."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from core.geometry.rotation_frames import IDENTITY, Matrix, Vector

if TYPE_CHECKING:
    from core.geometry.rotary_axes import FrameTransform, Kinematics

BlankCorners = tuple[Vector, Vector]
RotaryAngles = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True)
class PlaneCoordinateSystem:
    """The coordinate system of a working plane for one tool, in mm and degrees.

    All blocks share one object until the plane or the tool changes.
    - ``transform`` converts points of the system to machine X, Y and Z.
    - ``frame`` (rows) and ``datum`` are the axes and the origin of the system in the workpiece system.
    - ``is_tilted`` is True if a PLANE block defined the system.
    - ``plane_block_line`` is the line of this PLANE block, or 0 without a PLANE block.
    - ``target_angles`` are Q120, Q121 and Q122.
    - ``blank_corners`` are the corners of BLK FORM in the workpiece system.
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
        """Return whether this is the workpiece system, without a tilted plane or a datum shift."""
        return not self.is_tilted and self.datum == (0.0, 0.0, 0.0)

    def make_workpiece_system(self) -> PlaneCoordinateSystem:
        """Return the workpiece system with the same tool, for use after a program was canceled."""
        place = self.kinematics.make_transform(
            self.kinematics.zero_angles, self.kinematics.workpiece_rotation, tool_length=self.tool_length_mm
        )
        return PlaneCoordinateSystem(
            place, self.kinematics, tool_length_mm=self.tool_length_mm, blank_corners=self.blank_corners
        )


@dataclass(frozen=True, slots=True)
class PlanePosition:
    """The position at the end of one block, in the plane system that is active there.

    ``start`` and ``end`` are points of that system. ``machine_position`` is machine X, Y and Z of the end,
    in mm. ``rotary_angles`` are the displayed angles A, B and C (0 to 360 degrees on a modulo axis). The
    value of an axis that the machine lacks is None.
    """

    start: Vector
    end: Vector
    machine_position: Vector
    rotary_angles: RotaryAngles
    system: PlaneCoordinateSystem

    def convert_to_workpiece_system(self) -> PlanePosition:
        """Return the same position converted to the workpiece system."""
        system = self.system.make_workpiece_system()
        end = system.transform.convert_to_frame_point(self.machine_position)
        return replace(self, start=end, end=end, system=system)
