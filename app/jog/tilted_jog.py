"""Jog along the axes of the active tilted plane, or along the tool axis of a tilted head (3D-ROT)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.translation import tr
from core.executor.hand_motion.jog_line import Direction
from core.executor.snapshot import BY_HAND, Snapshot
from core.geometry.rotary_axes import Kinematics, Rotary
from core.geometry.rotation_frames import Matrix, product, turned
from core.interpreter.shared.working_plane import PlaneSystem
from core.message import Message

SLIDES = "XYZ"
_ROTARY = "ABC"  # Axes of Q120, Q121 and Q122.
_THERE = 0.01  # Tolerance in degrees between a rotary axis and its plane angle.
_UPRIGHT = 1e-6  # Tolerance of a unit vector within which a tool counts as upright.


@dataclass(frozen=True, slots=True)
class JogFrame:
    """The jog directions X, Y and Z in machine coordinates, as the columns of ``axes``.

    ``words`` is the name of the frame.
    """

    axes: Matrix
    words: str

    def direction(self, axis: str) -> Direction | None:
        """Return the machine direction of a linear axis. None for a rotary axis, which jogs as usual."""
        if axis not in SLIDES:
            return None
        x, y, z = (row[SLIDES.index(axis)] for row in self.axes)
        return x, y, z


def jog_frame(machine: Kinematics | None, snapshot: Snapshot) -> JogFrame | str:
    """Return the frame for jogging, or the reason as text if there is no such frame.

    The frame is the active tilted plane, if the rotary axes are at its angles. Without a plane, it is the
    frame of a tilted head.
    """
    swivel = snapshot.swivel
    angles = dict(zip(snapshot.axes, snapshot.actual, strict=True))
    if swivel is not None and swivel.system.tilted:
        system = swivel.system
        axes = sorted(system.kinematics.rotaries, key=lambda axis: axis.name)
        off = [axis.name for axis in axes if _off(system, axis, angles[axis.name])]
        if off:
            turn = " ".join(f"{axis.name}+Q{120 + _ROTARY.index(axis.name)}" for axis in axes)
            words = tr("{axes} NOT AT THE PLANE ANGLE. FIRST RUN L {turn} FMAX IN MDI")
            return tr(Message(words, axes=tr(" AND ").join(off), turn=turn))
        return JogFrame(system.place.turn, tr(Message("TILTED PLANE FROM LINE {line}", line=system.line)))
    if machine is None or abs(machine.tool_axis(angles)[2] - 1.0) <= _UPRIGHT:
        return tr("NO TILT ACTIVE. RUN PLANE IN MDI (F4) OR TILT THE HEAD")
    heads = [turned(each.direction, angles[each.name]) for each in machine.rotaries if not each.table]
    return JogFrame(product(*heads), tr("TOOL AXIS"))


def _off(system: PlaneSystem, axis: Rotary, angle: float) -> bool:
    """Return whether a rotary axis is not at the angle of the plane."""
    target = system.targets[_ROTARY.index(axis.name)]
    return abs(axis.travel(target, system.kinematics.shown(axis, angle))) > _THERE


@dataclass(slots=True)
class TiltedJog:
    """Jog in a tilted frame. It is switched off when the frame is lost.

    ``let_go`` ends the jog, and ``say`` shows the reason.
    """

    machine: Kinematics | None
    let_go: Callable[[str], None]
    say: Callable[[str], None]
    on: bool = False
    frame: JogFrame | None = None  # The available frame, also while 3D-ROT is off.
    why: str = ""  # Why no frame is available.

    def key(self, barred: str = "") -> None:
        """Toggle 3D-ROT. Show the reason if this is not possible."""
        self.let_go("")
        if not self.on and self.frame is None:
            self.say(self.why)
        elif not self.on and barred:
            self.say(barred)
        else:
            self.on = not self.on
            self.say("")

    def turns(self, snapshot: Snapshot) -> bool:
        """Return whether the key has a function now."""
        return self.on or (self.frame is not None and snapshot.state in BY_HAND)

    def off(self) -> None:
        """Switch 3D-ROT off, because the page closes."""
        self.on = False

    def look(self, snapshot: Snapshot) -> None:
        """Update the frame; called once a frame of the screen."""
        found = jog_frame(self.machine, snapshot)
        self.frame, self.why = (None, found) if isinstance(found, str) else (found, "")
        if self.on and self.frame is None:
            self.on = False
            why = tr(Message("3D-ROT IS OFF. KEYS NOW JOG IN MACHINE X Y Z. {why}", why=self.why))
            self.let_go(why)
            self.say(why)

    def along(self, axis: str) -> Direction | None:
        """Return the machine direction of a jog of this axis, or None for the machine axis itself."""
        return self.frame.direction(axis) if self.on and self.frame is not None else None
