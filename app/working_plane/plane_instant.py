"""Instant of the 3D view: from a snapshot or from the line under the cursor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.desk.status.readouts import rotary_angle, system_words

if TYPE_CHECKING:
    from app.working_plane.plane_scene import Scene
    from core.executor.snapshot import Snapshot
    from core.geometry.rotary_axes import Kinematics
    from core.interpreter.shared.working_plane import Swivel

_AXES = ("A", "B", "C")


@dataclass(frozen=True, slots=True)
class Instant:
    """Axis positions by name, the displayed plane, and the active block (0 for none)."""

    axes: Mapping[str, float]
    swivel: Swivel | None
    block: int = 0


def running(scene: Scene, snapshot: Snapshot) -> Instant:
    """Return the instant of a snapshot."""
    axes = dict(zip(snapshot.axes, snapshot.actual, strict=True))
    axes |= {name: 0.0 for name in scene.kinematics.names if name not in axes}
    return Instant(axes, snapshot.swivel, snapshot.block)


def at_line(scene: Scene, line: int) -> Instant:
    """Return the instant after a program line, with the tables at the target angles of its plane."""
    swivel = scene.swivel_at(line)
    if swivel is None:
        return Instant(dict.fromkeys(scene.kinematics.names, 0.0), None)
    axes = dict(zip("XYZ", swivel.slides, strict=True))
    shown = zip(_AXES, swivel.rotary, swivel.system.targets, strict=True)
    tilted = line in scene.planes and swivel.system.tilted
    zero = scene.kinematics.zero
    axes |= {name: zero[name] + (target if tilted else at) for name, at, target in shown if at is not None}
    return Instant(axes, swivel)


def title_of(kinematics: Kinematics) -> str:
    """Return the title of the view, which names the displayed parts: head, table or both."""
    heads = any(not axis.table for axis in kinematics.rotaries)
    if not heads:
        return "TABLE AND PLANE"
    both = any(axis.table for axis in kinematics.rotaries)
    return "HEAD, TABLE AND PLANE" if both else "HEAD AND PLANE"


def plane_words(swivel: Swivel | None) -> str:
    """Return one line of text with the name, the angles and the Z' direction of the plane."""
    if swivel is None:
        return ""
    words = system_words(swivel)
    if not swivel.system.tilted:
        return words
    asked = "  ".join(
        f"{name}{'+' if target >= 0 else ''}{rotary_angle(target)}"
        for name, at, target in zip(_AXES, swivel.rotary, swivel.system.targets, strict=True)
        if at is not None
    )
    x, y, z = (rotary_angle(row[2]) for row in swivel.system.frame)
    return f"{words}:  {asked}   Z' {x}  {y}  {z}"
