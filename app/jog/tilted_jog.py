"""Jog along the axes of the active tilted working plane or of a tilted head (3D-ROT)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.translation import tr
from core.executor.hand_motion.jog_line import Direction
from core.executor.snapshot import MANUAL_STATES, Snapshot
from core.geometry.rotary_axes import Kinematics, RotaryAxis
from core.geometry.rotation_frames import Matrix, make_rotation, multiply_matrices
from core.interpreter.shared.working_plane import PlaneCoordinateSystem
from core.message import Message

LINEAR_AXES = "XYZ"
_ROTARY = "ABC"  # Axes of Q120, Q121 and Q122.
_ANGLE_TOLERANCE_DEG = 0.01  # Tolerance in degrees between a rotary axis and its plane angle.
_UPRIGHT_TOLERANCE = 1e-6  # Tolerance of a unit vector within which a tool counts as upright.


@dataclass(frozen=True, slots=True)
class JogFrame:
    """Coordinate frame that defines the jog directions X, Y and Z.

    The columns of ``axis_matrix`` are the jog directions in machine coordinates. ``frame_name`` is the
    displayed name.
    """

    axis_matrix: Matrix
    frame_name: str

    def find_direction(self, axis: str) -> Direction | None:
        """Return the direction of a linear axis in machine coordinates, or None for a rotary axis.

        The jog of a rotary axis does not depend on the frame.
        """
        if axis not in LINEAR_AXES:
            return None
        x, y, z = (row[LINEAR_AXES.index(axis)] for row in self.axis_matrix)
        return x, y, z


def make_jog_frame(kinematics: Kinematics | None, snapshot: Snapshot) -> JogFrame | str:
    """Return the tilted frame for jogging, or the reason as text if no frame is available.

    If a tilted plane is active, its frame is used, but only while the rotary axes are at the angles of the
    plane. If no plane is active, the frame of a tilted head is used.
    """
    swivel = snapshot.swivel
    angles = dict(zip(snapshot.axes, snapshot.actual, strict=True))
    if swivel is not None and swivel.system.is_tilted:
        system = swivel.system
        axes = sorted(system.kinematics.rotary_axes, key=lambda axis: axis.name)
        off = [axis.name for axis in axes if _is_angle_different(system, axis, angles[axis.name])]
        if off:
            turn = " ".join(f"{axis.name}+Q{120 + _ROTARY.index(axis.name)}" for axis in axes)
            words = tr("{axes} NOT AT THE PLANE ANGLE. FIRST RUN L {turn} FMAX IN MDI")
            return tr(Message(words, axes=tr(" AND ").join(off), turn=turn))
        return JogFrame(
            system.transform.rotation,
            tr(Message("TILTED PLANE FROM LINE {line}", line=system.plane_block_line)),
        )
    if kinematics is None or abs(kinematics.compute_tool_direction(angles)[2] - 1.0) <= _UPRIGHT_TOLERANCE:
        return tr("NO TILT ACTIVE. RUN PLANE IN MDI (F4) OR TILT THE HEAD")
    heads = [
        make_rotation(each.direction, angles[each.name])
        for each in kinematics.rotary_axes
        if not each.is_table
    ]
    return JogFrame(multiply_matrices(*heads), tr("TOOL AXIS"))


def _is_angle_different(system: PlaneCoordinateSystem, axis: RotaryAxis, angle: float) -> bool:
    """Return whether a rotary axis is not at the angle that the tilted plane requires."""
    target = system.target_angles[_ROTARY.index(axis.name)]
    return (
        abs(axis.find_travel(target, system.kinematics.get_displayed_angle(axis, angle)))
        > _ANGLE_TOLERANCE_DEG
    )


@dataclass(slots=True)
class TiltedJog:
    """Jog in a tilted frame (3D-ROT). It is turned off when the frame is no longer available.

    ``release_keys`` stops the jog, and ``show_message`` shows the reason.
    """

    kinematics: Kinematics | None
    release_keys: Callable[[str], None]
    show_message: Callable[[str], None]
    is_on: bool = False
    jog_frame: JogFrame | None = None  # The available frame, also while 3D-ROT is off.
    refusal_reason: str = ""  # Why no frame is available.

    def toggle_tilted_frame(self, refusal: str = "") -> None:
        """Turn 3D-ROT on or off, or show the reason why it cannot be turned on."""
        self.release_keys("")
        if not self.is_on and self.jog_frame is None:
            self.show_message(self.refusal_reason)
        elif not self.is_on and refusal:
            self.show_message(refusal)
        else:
            self.is_on = not self.is_on
            self.show_message("")

    def is_available(self, snapshot: Snapshot) -> bool:
        """Return whether the 3D-ROT key has a function now."""
        return self.is_on or (self.jog_frame is not None and snapshot.state in MANUAL_STATES)

    def turn_off(self) -> None:
        """Turn 3D-ROT off because the Jog page closes."""
        self.is_on = False

    def update(self, snapshot: Snapshot) -> None:
        """Update the tilted frame, and turn 3D-ROT off if no frame is available.

        This method is called once per screen frame.
        """
        found = make_jog_frame(self.kinematics, snapshot)
        self.jog_frame, self.refusal_reason = (None, found) if isinstance(found, str) else (found, "")
        if self.is_on and self.jog_frame is None:
            self.is_on = False
            why = tr(Message("3D-ROT IS OFF. KEYS NOW JOG IN MACHINE X Y Z. {why}", why=self.refusal_reason))
            self.release_keys(why)
            self.show_message(why)

    def find_direction(self, axis: str) -> Direction | None:
        """Return the jog direction of an axis in machine coordinates.

        Returns None if the machine axis itself is to be jogged.
        """
        return self.jog_frame.find_direction(axis) if self.is_on and self.jog_frame is not None else None
