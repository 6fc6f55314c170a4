"""Machine position for the 3D view, from a snapshot or from the program line at the cursor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.desk.status.readouts import format_rotary_angle, get_coordinate_system_name

if TYPE_CHECKING:
    from app.working_plane.plane_scene import MillScene
    from core.executor.snapshot import Snapshot
    from core.geometry.rotary_axes import Kinematics
    from core.interpreter.shared.working_plane import PlanePosition

_AXES = ("A", "B", "C")


@dataclass(frozen=True, slots=True)
class SceneInstant:
    """Axis positions by name, working plane and active block (0 for none) at one instant."""

    axis_positions: Mapping[str, float]
    plane_position: PlanePosition | None
    active_block_number: int = 0


def make_instant_from_snapshot(scene: MillScene, snapshot: Snapshot) -> SceneInstant:
    """Return the instant that a snapshot shows."""
    axes = dict(zip(snapshot.axes, snapshot.actual, strict=True))
    axes |= {name: 0.0 for name in scene.kinematics.axis_names if name not in axes}
    return SceneInstant(axes, snapshot.swivel, snapshot.block)


def make_instant_after_line(scene: MillScene, line_number: int) -> SceneInstant:
    """Return the instant after a program line, with the rotary tables at the angles of its plane."""
    swivel = scene.find_plane(line_number)
    if swivel is None:
        return SceneInstant(dict.fromkeys(scene.kinematics.axis_names, 0.0), None)
    axes = dict(zip("XYZ", swivel.machine_position, strict=True))
    shown = zip(_AXES, swivel.rotary_angles, swivel.system.target_angles, strict=True)
    tilted = line_number in scene.plane_line_numbers and swivel.system.is_tilted
    zero = scene.kinematics.zero_angles
    axes |= {name: zero[name] + (target if tilted else at) for name, at, target in shown if at is not None}
    return SceneInstant(axes, swivel)


def make_view_title(kinematics: Kinematics) -> str:
    """Return the title of the view, which names the displayed parts (head, table or both)."""
    heads = any(not axis.is_table for axis in kinematics.rotary_axes)
    if not heads:
        return "TABLE AND PLANE"
    both = any(axis.is_table for axis in kinematics.rotary_axes)
    return "HEAD, TABLE AND PLANE" if both else "HEAD AND PLANE"


def describe_plane(swivel: PlanePosition | None) -> str:
    """Return one line with the name, angles and Z' direction of the plane, or an empty string."""
    if swivel is None:
        return ""
    words = get_coordinate_system_name(swivel)
    if not swivel.system.is_tilted:
        return words
    asked = "  ".join(
        f"{name}{'+' if target >= 0 else ''}{format_rotary_angle(target)}"
        for name, at, target in zip(_AXES, swivel.rotary_angles, swivel.system.target_angles, strict=True)
        if at is not None
    )
    x, y, z = (format_rotary_angle(row[2]) for row in swivel.system.frame)
    return f"{words}:  {asked}   Z' {x}  {y}  {z}"
