"""3D-ROT: jog along the axes of the tilted plane in force, or along a tool that leans with its head."""

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
_ROTARY = "ABC"  # of Q120, Q121, Q122
_THERE = 0.01  # degrees from the plane's angles that a rotary axis may stand
_UPRIGHT = 1e-6  # of a unit vector: a tool that leans less stands upright


@dataclass(frozen=True, slots=True)
class JogFrame:
    """X Y Z of the keys as directions in the machine, the columns of ``axes``; ``words`` say whose."""

    axes: Matrix
    words: str

    def direction(self, axis: str) -> Direction | None:
        """Of a slide; a rotary axis turns as ever."""
        if axis not in SLIDES:
            return None
        x, y, z = (row[SLIDES.index(axis)] for row in self.axes)
        return x, y, z


def jog_frame(machine: Kinematics | None, snapshot: Snapshot) -> JogFrame | str:
    """The plane in force, once the rotary axes stand where it asks; without one a tool whose head leans.

    Else why there is none.
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
    """Whether a rotary axis stands elsewhere than the plane asks."""
    target = system.targets[_ROTARY.index(axis.name)]
    return abs(axis.travel(target, system.kinematics.shown(axis, angle))) > _THERE


@dataclass(slots=True)
class TiltedJog:
    """Whether the keys move along a tilted frame, and which. Off whenever nothing is tilted any more.

    ``let_go`` ends what is held, ``say`` tells why.
    """

    machine: Kinematics | None
    let_go: Callable[[str], None]
    say: Callable[[str], None]
    on: bool = False
    frame: JogFrame | None = None  # that there is, on or off
    why: str = ""  # there is none

    def key(self, barred: str = "") -> None:
        """On, or off again; refused where nothing is tilted."""
        self.let_go("")
        if not self.on and self.frame is None:
            self.say(self.why)
        elif not self.on and barred:
            self.say(barred)
        else:
            self.on = not self.on
            self.say("")

    def turns(self, snapshot: Snapshot) -> bool:
        """Return whether the key does something now."""
        return self.on or (self.frame is not None and snapshot.state in BY_HAND)

    def off(self) -> None:
        """The page goes: the arrows move along the machine's axes when it comes back."""
        self.on = False

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame."""
        found = jog_frame(self.machine, snapshot)
        self.frame, self.why = (None, found) if isinstance(found, str) else (found, "")
        if self.on and self.frame is None:
            self.on = False
            why = tr(Message("3D-ROT IS OFF. KEYS NOW JOG IN MACHINE X Y Z. {why}", why=self.why))
            self.let_go(why)
            self.say(why)

    def along(self, axis: str) -> Direction | None:
        """The direction of this axis in the machine; None: the machine's own axis moves."""
        return self.frame.direction(axis) if self.on and self.frame is not None else None
