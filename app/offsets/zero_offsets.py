"""Zero offsets G54 to G59 of a lathe, and presets of a mill, which define the workpiece position."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, degrees, hypot, remainder

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.offsets.active_offsets import find_rotary_zero_positions
from app.offsets.cell_table import CellTable
from app.offsets.mill_touch import MillTouchCalculator
from core.executor.snapshot import MachineState, Snapshot
from core.geometry.rotation_frames import Vector
from core.message import Message
from core.store.store_rows import PRESET_NUMBERS, ZERO_CODES, FieldValue, OffsetKind, PresetRow

_ROTARY_AXES = {"a": "A", "b": "B", "c": "C"}
_MIN_EDGE_LENGTH_MM = 1.0  # Millimeters: closer points of an edge do not define its direction.


class PresetTable(CellTable):
    """The preset table with its selected cell.

    To set a basic rotation, the operator touches two points of an edge. ``first_edge_point`` is the first
    of them.
    """

    kind = OffsetKind.PRESET
    numbers = PRESET_NUMBERS

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.first_edge_point: Vector | None = None

    @property
    def columns(self) -> tuple[str, ...]:
        """Return the field names of the columns, with only the rotary axes that this machine has."""
        absent = {
            name
            for name, axis in _ROTARY_AXES.items()
            if axis not in MillTouchCalculator.get_for_desk(self.desk).rotary_axis_names
        }
        return tuple(name for name in super().columns if name not in absent)

    @property
    def title(self) -> str:
        """Return the title of the table, with its units."""
        return tr("PRESETS  ·  WORKPIECE ZERO IN MACHINE COORDINATES, MM AND DEGREES")

    def find_active_row(self, _snapshot: Snapshot) -> int:
        """Return the number of the active preset."""
        return self.offset_book.active_preset

    @property
    def footer_text(self) -> str:
        """Return the hint about the keys F2, F3 and Esc, with the active preset."""
        f2_hint = tr("F2: set the current tip position to the typed value")
        if self.name in _ROTARY_AXES:
            f2_hint = tr("F2: set the current axis position to the typed value")
        elif self.name == "rotation":
            f2_hint = tr("Press F2 at two points on an edge to set ROT so that the edge has the typed angle")
        active = self.offset_book.active_preset
        now = tr(Message("active preset: {preset}", preset=active or tr("0 (from the machine file)")))
        return f"{f2_hint}        {tr('F3: activate preset')}        {now}"

    @property
    def selected_preset(self) -> PresetRow:
        """Return the selected row, or an empty row if it was never set."""
        return self.offset_book.presets.get(self.number, PresetRow())

    def choose(self, row: int, column: int) -> None:
        """Select another cell, and discard the first touched point of an edge."""
        self.first_edge_point = None
        super().choose(row, column)

    def cancel_entry(self) -> bool:
        """Discard the entry and the first point of an edge.

        Return False if there is neither.
        """
        begun, self.first_edge_point = self.first_edge_point is not None, None
        return super().cancel_entry() or begun

    def set_value_from_position(self) -> None:
        """Handle F2: set the selected field so that the position display shows the entered value, or 0.

        A basic rotation needs two points of an edge.
        """
        if self.name in _ROTARY_AXES:
            self._touch_rotary_axis()
        elif self.name in {"x", "y", "z"}:
            self._touch_linear_axis()
        elif self.name == "rotation":
            self._touch_edge_point()
        else:
            self.desk.say(tr("SELECT X, Y, Z, A ROTARY AXIS OR ROT. F2: TOUCH OFF"))

    @property
    def _reads(self) -> str:
        return self.text.strip() or "0"

    def _touch_linear_axis(self) -> None:
        """Set a linear axis so that the displayed tip position is the entered value."""
        tip, reads = self._tip(), self._reads
        if tip is not None:
            at = tip["xyz".index(self.name)]
            self.save_cell(
                lambda: self.check_range(at - evaluate_expression(reads)),
                tr(Message("position set to {value}", value=reads)),
            )

    def _tip(self) -> Vector | None:
        tip = MillTouchCalculator.get_for_desk(self.desk).find_tip_position(
            find_rotary_zero_positions(self.selected_preset)
        )
        if isinstance(tip, str):
            self.desk.say(tip)
            return None
        return tip

    def _touch_rotary_axis(self) -> None:
        """Set a rotary axis of the preset so that its position display shows the entered value.

        The workpiece zero remains at the same point of the part.
        """
        at, reads = (
            MillTouchCalculator.get_for_desk(self.desk).find_axis_angle(_ROTARY_AXES[self.name]),
            self._reads,
        )
        if isinstance(at, str):
            self.desk.say(at)
            return
        self.save_cell(
            lambda: self.check_range(remainder(at - evaluate_expression(reads), 360.0)),
            tr(Message("position set to {value}", value=reads)),
            self._find_linear_offsets,
        )

    def _find_linear_offsets(self, zero: FieldValue) -> Mapping[str, FieldValue]:
        """Return the X, Y and Z offsets for a new zero of a rotary axis.

        With these offsets, the workpiece zero remains at the same point of the part.
        """
        row = self.selected_preset
        if self.stored_row is None:
            return {}
        after = {**find_rotary_zero_positions(row), _ROTARY_AXES[self.name]: float(zero)}
        spot = MillTouchCalculator.get_for_desk(self.desk).find_moved_point(
            (row.x, row.y, row.z), find_rotary_zero_positions(row), after
        )
        return dict(zip("xyz", (round(at, 10) for at in spot), strict=True))

    def _touch_edge_point(self) -> None:
        """Store the first point of an edge, or set the basic rotation from the second point."""
        tip, reads = self._tip(), self._reads
        if tip is None:
            return
        if self.first_edge_point is None:
            self.first_edge_point = tip
            self.desk.say(tr("POINT 1 STORED. TOUCH SAME EDGE AT ANOTHER POINT, PRESS F2"))
            return
        first = self.first_edge_point
        if self.save_cell(
            lambda: self._find_rotation(first, tip, evaluate_expression(reads)),
            tr(Message("edge angle set to {value}", value=reads)),
        ):
            self.first_edge_point = None

    def _find_rotation(self, first: Vector, last: Vector, reads: float) -> float:
        """Return the basic rotation in degrees that makes the touched edge ``reads`` degrees from X.

        An edge has no direction, so half revolutions are ignored. Raise InvalidEntryError if the two
        touched points are too close together.
        """
        dx, dy = last[0] - first[0], last[1] - first[1]
        if hypot(dx, dy) < _MIN_EDGE_LENGTH_MM:
            raise InvalidEntryError(tr("POINTS LESS THAN 1 MM APART. TOUCH FARTHER ALONG THE EDGE"))
        return self.check_range(remainder(degrees(atan2(dy, dx)) - reads, 180.0))

    def find_activation_refusal(self) -> str:
        """Return why the selected preset cannot be activated now, or an empty string if it can."""
        if why := self.find_change_refusal(self.desk.read_snapshot()):
            return why
        if self.stored_row is None:
            return tr(
                Message("PRESET {number} IS NOT SET. TOUCH IT OFF OR TYPE ITS VALUES", number=self.number)
            )
        return ""

    def find_touch_off_refusal(self) -> str:
        """Return why the workpiece cannot be touched off now, or an empty string if it can."""
        if self.name in _ROTARY_AXES:
            place: object = MillTouchCalculator.get_for_desk(self.desk).find_axis_angle(
                _ROTARY_AXES[self.name]
            )
        elif self.name in {"x", "y", "z", "rotation"}:
            place = MillTouchCalculator.get_for_desk(self.desk).find_tip_position(
                find_rotary_zero_positions(self.selected_preset)
            )
        else:
            place = tr("SELECT X, Y, Z, A ROTARY AXIS OR ROT. F2: TOUCH OFF")
        return place if isinstance(place, str) else self.find_change_refusal(self.desk.read_snapshot())

    def activate_preset(self) -> None:
        """Handle F3: activate the selected preset.

        If it is already active, activate the preset of the machine file.
        """
        if why := self.find_activation_refusal():
            self.desk.say(why)
            return
        number = 0 if self.offset_book.active_preset == self.number else self.number
        if why := self.offset_book.activate_preset(number):
            self.desk.say(why)


class ZeroOffsetTable(CellTable):
    """The table of the zero offsets, with its selected cell and the entered text."""

    kind = OffsetKind.ZERO
    page_key = "C"
    numbers = ZERO_CODES
    clear_table_question = "PRESS Y TO CLEAR G54 TO G59, N TO KEEP THEM"
    clear_table_reason = "all zero offsets cleared with the C key"

    @property
    def title(self) -> str:
        """Return the title of the table, with its units."""
        return tr("SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES")

    @property
    def words(self) -> tuple[str, ...]:
        """Return the column headings, which are the axis names."""
        return tuple(name.upper() for name in self.columns)

    def find_active_row(self, snapshot: Snapshot) -> int:
        """Return the G code of the active zero offset."""
        return snapshot.modal.settable

    @property
    def selected_g_code(self) -> int:
        """Return the G code of the selected row."""
        return self.number

    @property
    def question_text(self) -> str:
        """Return the prompt for the selected cell, with its unit."""
        words = {"x": tr("X RADIUS, MM?"), "z": tr("Z, MM?"), "c": tr("C, DEGREES?")}
        return f"G{self.selected_g_code}  {words[self.name]}"

    @property
    def footer_text(self) -> str:
        """Return the hint about the F2, C and Esc keys."""
        return tr(
            "F2: set the current position to the typed value        C: clear G54 to G59        Esc: exit"
        )

    def find_change_refusal(self, snapshot: Snapshot, *, is_correction: bool = False) -> str:
        """Return why the zero offsets cannot be changed now, or an empty string if they can.

        Changes are allowed only between cycles.
        """
        if (
            snapshot.state in ACTIVE_STATES - {MachineState.JOG, MachineState.HOMING}
            and not self.offset_book.lock_reason
        ):
            return tr("PROGRAM RUNNING. CHANGE G54 TO G59 ONLY BETWEEN CYCLES")
        return super().find_change_refusal(snapshot, is_correction=is_correction)

    def find_touch_off_refusal(self) -> str:
        """Return why the machine position cannot be used now, or an empty string if it can."""
        snapshot, axis = self.desk.read_snapshot(), self.name.upper()
        if axis not in snapshot.axes:
            return tr(Message("THIS MACHINE HAS NO {axis} AXIS", axis=axis))
        if not snapshot.homed[snapshot.axes.index(axis)]:
            return tr(Message("{axis} IS NOT HOMED. HOME IT FIRST", axis=axis))
        return self.find_change_refusal(snapshot)

    def set_value_from_position(self) -> None:
        """Handle F2: set the offset so that the position display shows the entered value, or 0."""
        if why := self.find_touch_off_refusal():
            self.desk.say(why)
            return
        snapshot = self.desk.read_snapshot()
        place = snapshot.axes.index(self.name.upper())
        reads = self.text.strip() or "0"
        words = tr(Message("position set to {value}", value=reads))
        self.save_cell(lambda: self._find_offset(snapshot.actual[place], evaluate_expression(reads)), words)

    def _find_offset(self, at: float, reads: float) -> float:
        """Return the zero offset that makes the display show ``reads`` at machine position ``at``.

        Full revolutions of C are ignored.
        """
        return self.check_range(remainder(at - reads, 360.0) if self.name == "c" else at - reads)
