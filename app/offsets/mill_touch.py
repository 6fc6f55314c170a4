"""Tools in a mill: touching off by the machine's own chain, and tool life in the tool table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.offsets_in_force import MillOffsets, with_mill
from core.executor.snapshot import Snapshot, State
from core.geometry.rotary_axes import DatumPreset, Kinematics
from core.geometry.rotation_frames import Vector
from core.interpreter.shared.job_setup import Setup
from core.message import Message
from core.production.tool_life import ToolLife

_HERE: Vector = (0.0, 0.0, 0.0)
_UPRIGHT = 1e-6  # of a unit vector: a tool that leans less stands upright


@dataclass(slots=True)
class MillTouch:
    """A desk's mill. ``machine`` is its chain as the machine file has it; None: it has none."""

    desk: Desk
    machine: Kinematics | None

    def close(self) -> None:
        """Nothing of it runs."""

    @classmethod
    def of(cls, desk: Desk) -> MillTouch:
        """That of this desk."""
        found = desk.pages.find(cls)
        return found if found is not None else cls(desk, None)

    def tip(self, zeros: Mapping[str, float]) -> Vector | str:
        """Where the tip of the tool in the spindle touches, in the machine with the rotary axes at ``zeros``,
        mm; or why nobody knows."""
        stands = self._stands()
        if isinstance(stands, str):
            return stands
        machine, angles, slides = stands
        number = self.desk.snapshot().modal.tool
        row = self.desk.book.mill_tools.get(number)
        if row is None:
            return tr("SPINDLE HAS NO TOOL FROM THE TABLE. RUN TOOL CALL IN MDI")
        length = row.length + row.dl
        bare = machine.with_preset(DatumPreset(_HERE, zeros=tuple(zeros.items())))
        return bare.at_zeros(replace(bare, origin=_HERE).place(angles, tool_length=length).point(slides))

    def moved(self, spot: Vector, before: Mapping[str, float], after: Mapping[str, float]) -> Vector:
        """Where a point of the workpiece lies in the machine with the rotary axes at ``after``, mm; ``spot``
        is where it lies with them at ``before``."""
        if self.machine is None:
            return spot
        first, last = (
            self.machine.with_preset(DatumPreset(_HERE, zeros=tuple(each.items())))
            for each in (before, after)
        )
        return last.at_zeros(first.at_home(spot))

    @property
    def rotary_axes(self) -> tuple[str, ...]:
        """The names of the rotary axes, in the order of A B C."""
        return tuple(sorted(axis.name for axis in self.machine.rotaries)) if self.machine else ()

    def angle(self, name: str) -> float | str:
        """Where a rotary axis stands, degrees in the machine; or why nobody knows."""
        stands = self._stands()
        return stands if isinstance(stands, str) else stands[1][name]

    def nose_height(self) -> float | str:
        """How high the spindle's nose stands over the zero of the preset in force, mm: L of a tool whose tip
        touches there; or why nobody knows."""
        stands = self._stands()
        if isinstance(stands, str):
            return stands
        machine, angles, slides = stands
        if abs(machine.frame(angles)[2][2] - 1.0) > _UPRIGHT:
            return tr("TOOL TILTED. TURN ROTARY AXES TO SET IT SQUARE TO WORKPIECE")
        return machine.place(angles).point(slides)[2]

    def _stands(self) -> tuple[Kinematics, dict[str, float], Vector] | str:
        """The chain with the preset in force, the angles, the slides; or why they are not known."""
        snapshot, book = self.desk.snapshot(), self.desk.book
        if self.machine is None:
            return tr("CANNOT TOUCH OFF: THE MILL'S MACHINE FILE HAS NO [kinematics] TABLE")
        if why := _unknown(snapshot):
            return why
        setup = with_mill(Setup(kinematics=self.machine), MillOffsets({}, book.presets, book.preset))
        assert setup.kinematics is not None
        at = dict(zip(snapshot.axes, snapshot.actual, strict=True))
        slides: Vector = at.pop("X"), at.pop("Y"), at.pop("Z")
        return setup.kinematics, at, slides


def _unknown(snapshot: Snapshot) -> str:
    if snapshot.state in {State.JOG, State.HOME}:
        return tr("AXES ARE MOVING. WAIT UNTIL THEY STOP TO CHANGE OFFSETS")
    for axis, homed in zip(snapshot.axes, snapshot.homed, strict=True):
        if not homed:
            return tr(Message("{axis} IS NOT HOMED. HOME IT FIRST", axis=axis))
    return ""


def _none() -> Mapping[int, ToolLife]:
    return {}


@dataclass(slots=True)
class MillLives:
    """``lives`` by tool, the same object while nothing changes; ``set_used`` a tool's cutting seconds, 0 of a
    fresh tool."""

    lives: Callable[[], Mapping[int, ToolLife]] = _none
    set_used: Callable[[int, float], None] = lambda _number, _seconds: None

    def close(self) -> None:
        """Nothing of it runs."""

    @classmethod
    def of(cls, desk: Desk) -> MillLives:
        """Those of this desk; a desk that counts nothing has none."""
        found = desk.pages.find(cls)
        return found if found is not None else cls()
