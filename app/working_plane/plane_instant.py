"""The instant that the view of the working plane shows: of a snapshot, or of the line under the cursor."""

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
    """Where the machine stands: axes by name, the plane shown, and the block under way (0: none)."""

    axes: Mapping[str, float]
    swivel: Swivel | None
    block: int = 0


def running(scene: Scene, snapshot: Snapshot) -> Instant:
    """The machine as it stands now."""
    axes = dict(zip(snapshot.axes, snapshot.actual, strict=True))
    axes |= {name: 0.0 for name in scene.kinematics.names if name not in axes}
    return Instant(axes, snapshot.swivel, snapshot.block)


def at_line(scene: Scene, line: int) -> Instant:
    """The machine as it stands behind a line of the program: tables at the targets of its plane."""
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
    """What is seen of the machine beside the plane: its table, its head, or both."""
    heads = any(not axis.table for axis in kinematics.rotaries)
    if not heads:
        return "TABLE AND PLANE"
    both = any(axis.table for axis in kinematics.rotaries)
    return "HEAD, TABLE AND PLANE" if both else "HEAD AND PLANE"


def plane_words(swivel: Swivel | None) -> str:
    """The plane in one line: which it is, the angles that it asks for, and where its Z' points."""
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
