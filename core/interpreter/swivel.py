"""What a block of a mill says besides its axes: where it stands in its working plane."""

from __future__ import annotations

from dataclasses import dataclass

from core.geometry.frames import IDENTITY, Matrix, Vector
from core.geometry.kinematics import Kinematics, Place

Corners = tuple[Vector, Vector]
Angles = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True)
class Swivel:
    """One block in the working plane that is in force at its end. mm, degrees.

    ``start end`` are points of that plane's system, ``frame`` (rows) and ``datum`` its axes and origin in the
    workpiece's system, ``tilted`` whether a PLANE block made it. ``slides`` are machine X Y Z of the end,
    ``rotary`` A B C as shown (0 to 360 on a modulo axis), None for axes the machine lacks. ``targets`` are
    Q120, Q121, Q122. ``plane_line`` is the line of the PLANE block in force, 0 for none. ``place`` takes
    points of the plane's system to machine X Y Z. ``blank``: corners of BLK FORM in the workpiece's system.
    """

    start: Vector
    end: Vector
    slides: Vector
    rotary: Angles
    place: Place
    kinematics: Kinematics
    frame: Matrix = IDENTITY
    datum: Vector = (0.0, 0.0, 0.0)
    tilted: bool = False
    targets: Vector = (0.0, 0.0, 0.0)
    plane_line: int = 0
    tool_length: float = 0.0
    blank: Corners | None = None
