"""Calculation of touch-offs with the kinematics of a mill, and the tool life counters of the mill."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.active_offsets import MillOffsets, add_mill_offsets
from core.executor.snapshot import MachineState, Snapshot
from core.geometry.rotary_axes import DatumPreset, Kinematics
from core.geometry.rotation_frames import Vector
from core.interpreter.shared.job_setup import InterpreterSetup
from core.message import Message
from core.production.tool_life import ToolLife

_ORIGIN: Vector = (0.0, 0.0, 0.0)
_UPRIGHT_TOLERANCE = 1e-6  # Tolerance of a unit vector within which a tool counts as upright.


@dataclass(slots=True)
class MillTouchCalculator:
    """Calculator of tool tip positions on a mill, for touch-offs.

    ``kinematics`` is None if the machine file defines no kinematics.
    """

    desk: Desk
    kinematics: Kinematics | None

    def close(self) -> None:
        """Do nothing because the calculator has no worker to stop."""

    @classmethod
    def get_for_desk(cls, desk: Desk) -> MillTouchCalculator:
        """Return the calculator that is attached to TurnDesk, or else a calculator without kinematics."""
        found = desk.page_registry.find_model(cls)
        return found if found is not None else cls(desk, None)

    def find_tip_position(self, zero_positions: Mapping[str, float]) -> Vector | str:
        """Return the machine position of the active tool's tip in mm, or the reason why it is unknown.

        The position is calculated for the rotary axes at ``zero_positions``.
        """
        stationary_state = self._find_stationary_state()
        if isinstance(stationary_state, str):
            return stationary_state
        machine, angles, slides = stationary_state
        number = self.desk.read_snapshot().modal.tool
        row = self.desk.offset_book.mill_tools.get(number)
        if row is None:
            return tr("SPINDLE HAS NO TOOL FROM THE TABLE. RUN TOOL CALL IN MDI")
        length = row.length + row.dl
        bare = machine.apply_preset(DatumPreset(_ORIGIN, axis_zeros=tuple(zero_positions.items())))
        return bare.move_to_table_zeros(
            replace(bare, origin=_ORIGIN)
            .make_transform(angles, tool_length=length)
            .convert_to_frame_point(slides)
        )

    def find_moved_point(
        self, workpiece_point: Vector, angles_before: Mapping[str, float], angles_after: Mapping[str, float]
    ) -> Vector:
        """Return the machine position in mm to which the rotary axes move a point of the workpiece.

        ``workpiece_point`` is the machine position of the point while the rotary axes are at
        ``angles_before``. The result is its position when the rotary axes are at ``angles_after``.
        """
        if self.kinematics is None:
            return workpiece_point
        first, last = (
            self.kinematics.apply_preset(DatumPreset(_ORIGIN, axis_zeros=tuple(each.items())))
            for each in (angles_before, angles_after)
        )
        return last.move_to_table_zeros(first.move_from_table_zeros(workpiece_point))

    @property
    def rotary_axis_names(self) -> tuple[str, ...]:
        """Return the names of the rotary axes in alphabetical order."""
        return tuple(sorted(axis.name for axis in self.kinematics.rotary_axes)) if self.kinematics else ()

    def find_axis_angle(self, axis_name: str) -> float | str:
        """Return the machine position of a rotary axis in degrees, or the reason why it is unknown."""
        stationary_state = self._find_stationary_state()
        return stationary_state if isinstance(stationary_state, str) else stationary_state[1][axis_name]

    def find_spindle_nose_height(self) -> float | str:
        """Return the height of the spindle nose above the zero point of the active preset in mm.

        This height is the length L of a tool whose tip touches the zero point. If the height is unknown,
        the reason is returned as text.
        """
        stationary_state = self._find_stationary_state()
        if isinstance(stationary_state, str):
            return stationary_state
        machine, angles, slides = stationary_state
        if abs(machine.compute_tool_frame(angles)[2][2] - 1.0) > _UPRIGHT_TOLERANCE:
            return tr("TOOL TILTED. TURN ROTARY AXES TO SET IT SQUARE TO WORKPIECE")
        return machine.make_transform(angles).convert_to_frame_point(slides)[2]

    def _find_stationary_state(self) -> tuple[Kinematics, dict[str, float], Vector] | str:
        """Return the kinematics with the active preset, the rotary angles and the linear positions.

        If they are unknown, for example while an axis moves, the reason is returned as text instead.
        """
        snapshot, book = self.desk.read_snapshot(), self.desk.offset_book
        if self.kinematics is None:
            return tr("CANNOT TOUCH OFF: THE MILL'S MACHINE FILE HAS NO [kinematics] TABLE")
        if why := _unknown(snapshot):
            return why
        setup = add_mill_offsets(
            InterpreterSetup(kinematics=self.kinematics), MillOffsets({}, book.presets, book.active_preset)
        )
        assert setup.kinematics is not None
        at = dict(zip(snapshot.axes, snapshot.actual, strict=True))
        slides: Vector = at.pop("X"), at.pop("Y"), at.pop("Z")
        return setup.kinematics, at, slides


def _unknown(snapshot: Snapshot) -> str:
    if snapshot.state in {MachineState.JOG, MachineState.HOMING}:
        return tr("AXES ARE MOVING. WAIT UNTIL THEY STOP TO CHANGE OFFSETS")
    for axis, homed in zip(snapshot.axes, snapshot.homed, strict=True):
        if not homed:
            return tr(Message("{axis} IS NOT HOMED. HOME IT FIRST", axis=axis))
    return ""


def _none() -> Mapping[int, ToolLife]:
    return {}


@dataclass(slots=True)
class MillToolLives:
    """Access to the tool life counters of a mill's tools.

    ``read_lives`` returns the tool life by tool number. It returns the same object until the tool life data
    change. ``set_cutting_time`` sets the cutting time of a tool in seconds, which is 0 for a new tool.
    """

    read_lives: Callable[[], Mapping[int, ToolLife]] = _none
    set_cutting_time: Callable[[int, float], None] = lambda _number, _seconds: None

    def close(self) -> None:
        """Do nothing because there is no worker to stop."""

    @classmethod
    def get_for_desk(cls, desk: Desk) -> MillToolLives:
        """Return the tool life counters that are attached to TurnDesk, or else counters without tools."""
        found = desk.page_registry.find_model(cls)
        return found if found is not None else cls()
