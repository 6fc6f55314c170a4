"""Touch-off on a mill with the machine's kinematics, and tool life for the tool table."""

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
_UPRIGHT = 1e-6  # Tolerance of a unit vector within which a tool counts as upright.


@dataclass(slots=True)
class MillTouch:
    """Calculates positions on a mill. ``machine`` is the kinematics from the machine file, or None."""

    desk: Desk
    machine: Kinematics | None

    def close(self) -> None:
        """Do nothing, because nothing runs in the background."""

    @classmethod
    def of(cls, desk: Desk) -> MillTouch:
        """Return the object attached to TurnDesk, or one without kinematics."""
        found = desk.pages.find(cls)
        return found if found is not None else cls(desk, None)

    def tip(self, zeros: Mapping[str, float]) -> Vector | str:
        """Return the machine position of the tip of the tool in the spindle in mm, or why it is unknown.

        The position is calculated for the rotary axes at ``zeros``.
        """
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
        """Return the machine position in mm of a workpiece point with the rotary axes at ``after``.

        ``spot`` is the machine position of the same point with the rotary axes at ``before``.
        """
        if self.machine is None:
            return spot
        first, last = (
            self.machine.with_preset(DatumPreset(_HERE, zeros=tuple(each.items())))
            for each in (before, after)
        )
        return last.at_zeros(first.at_home(spot))

    @property
    def rotary_axes(self) -> tuple[str, ...]:
        """The names of the rotary axes in alphabetical order."""
        return tuple(sorted(axis.name for axis in self.machine.rotaries)) if self.machine else ()

    def angle(self, name: str) -> float | str:
        """Return the machine position of a rotary axis in degrees, or why it is unknown."""
        stands = self._stands()
        return stands if isinstance(stands, str) else stands[1][name]

    def nose_height(self) -> float | str:
        """Return the height of the spindle nose above the zero of the preset in force in mm.

        A tool whose tip touches this zero has this length L. If the height is unknown, return the reason as
        text.
        """
        stands = self._stands()
        if isinstance(stands, str):
            return stands
        machine, angles, slides = stands
        if abs(machine.frame(angles)[2][2] - 1.0) > _UPRIGHT:
            return tr("TOOL TILTED. TURN ROTARY AXES TO SET IT SQUARE TO WORKPIECE")
        return machine.place(angles).point(slides)[2]

    def _stands(self) -> tuple[Kinematics, dict[str, float], Vector] | str:
        """Return the kinematics with the preset in force, the rotary angles and the linear axis positions.

        If they are unknown, return the reason as text.
        """
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
    """Access to the tool life of a mill's tools.

    ``lives`` returns the tool life by tool number, and returns the same object while nothing changes.
    ``set_used`` sets the cutting seconds of a tool, 0 for a new tool.
    """

    lives: Callable[[], Mapping[int, ToolLife]] = _none
    set_used: Callable[[int, float], None] = lambda _number, _seconds: None

    def close(self) -> None:
        """Do nothing, because nothing runs in the background."""

    @classmethod
    def of(cls, desk: Desk) -> MillLives:
        """Return the object attached to TurnDesk, or one without tools."""
        found = desk.pages.find(cls)
        return found if found is not None else cls()
