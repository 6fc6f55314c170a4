"""Where the machine and the workpiece stand while a Klartext program is gone through."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from core.geometry.frames import IDENTITY, Matrix, Vector, applied, plus, product, transposed
from core.geometry.kinematics import Kinematics, Place
from core.interpreter.swivel import Angles

ORIGIN: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class WorkingPlane:
    """The plane in force. ``frame`` in the machine-parallel system; ``targets`` by axis, as shown."""

    frame: Matrix
    targets: Mapping[str, float]
    line: int


class Standing:
    """``at`` holds all axes by name, ``there`` in the machine's order; mm and degrees, rotary counted on.

    ``datum`` is the workpiece datum in the workpiece's system, ``shift`` what TRANS DATUM has added within
    the plane in force. ``frame`` and ``origin`` are the working plane's axes and origin in the workpiece's
    system, ``place`` takes its points to machine positions of the slides; ``point`` is where the tip stands
    in it, mm.
    """

    def __init__(self, kinematics: Kinematics, start: Sequence[float]) -> None:
        self.kinematics = kinematics
        self.names = kinematics.names
        self.rotary_names = tuple(axis.name for axis in kinematics.rotaries)
        self.at = dict(zip(self.names, start, strict=True))
        self.there = tuple(start)
        self.plane: WorkingPlane | None = None
        self.datum = self.shift = self.origin = ORIGIN
        self.frame = IDENTITY
        self.tool_length = 0.0
        self._shown: Angles | None = None  # worked out again when a rotary axis has turned
        self.place = self._place()
        self.point = self.place.point(self.slides)

    def go(self, goal: dict[str, float]) -> None:
        """Stand there; ``goal`` holds every axis."""
        if any(goal[name] != self.at[name] for name in self.rotary_names):
            self._shown = None
        self.at, self.there = goal, tuple([goal[name] for name in self.names])
        self.point = self.place.point(self.slides)

    @property
    def shown(self) -> Angles:
        """A B C as they are displayed, None for axes the machine lacks."""
        if self._shown is None:
            axes = {axis.name: axis.shown(self.at[axis.name]) for axis in self.kinematics.rotaries}
            self._shown = (axes.get("A"), axes.get("B"), axes.get("C"))
        return self._shown

    @property
    def slides(self) -> Vector:
        """Machine X Y Z, mm."""
        return self.at["X"], self.at["Y"], self.at["Z"]

    @property
    def rotary(self) -> dict[str, float]:
        """Rotary axes by name, degrees, counted on."""
        return {axis.name: self.at[axis.name] for axis in self.kinematics.rotaries}

    @property
    def targets(self) -> dict[str, float]:
        """The effective angle of each rotary axis: that of the plane in force, else where it stands."""
        if self.plane is not None:
            return dict(self.plane.targets)
        return {axis.name: axis.shown(self.at[axis.name]) for axis in self.kinematics.rotaries}

    def derive(self) -> None:
        """Work out again what follows from plane, datum and tool."""
        self.frame = IDENTITY
        if self.plane is not None:
            self.frame = product(transposed(self.kinematics.basic), self.plane.frame)
        self.origin = plus(self.datum, applied(self.frame, self.shift))
        self.place = self._place()
        self.point = self.place.point(self.slides)

    def set_plane(self, plane: WorkingPlane | None) -> None:
        """Another plane, or none. The datum's point on the workpiece stays where it is."""
        self.datum, self.shift = self.origin, ORIGIN
        self.plane = plane
        self.derive()

    def _place(self) -> Place:
        angles = self.plane.targets if self.plane is not None else {}
        frame = self.plane.frame if self.plane is not None else self.kinematics.basic
        datum = applied(self.kinematics.basic, self.origin)
        return self.kinematics.place(angles, frame, datum, self.tool_length)
