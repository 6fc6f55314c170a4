"""Touch-off of one tool axis on the Jog page: by hand, by a skim cut or with the tool setter."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.translation import tr
from app.offsets.offset_changes import ConfirmedOffsetChanges, OffsetHistory
from app.offsets.offset_table import IncompleteTool
from app.offsets.offset_values import TOOL_FIELDS, UnitMode, convert_to_mm, translate_field_name
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message
from core.store.offsets.touch_off import TouchPosition

TOUCH_X, TOUCH_Z = "touch x", "touch z"
TOUCH_FIELDS = {TOUCH_X: "x", TOUCH_Z: "z"}
MOVE_TOLERANCE_MM = (
    0.005  # Tolerance in mm. After a larger move, the axis is no longer where the tip touched.
)


def find_touch_off_refusal(quantity: str, snapshot: Snapshot) -> str:
    """Return the reason why an axis cannot be touched off now, or an empty string if it can."""
    axis = TOUCH_FIELDS[quantity].upper()
    if not snapshot.homed[snapshot.axes.index(axis)]:
        return tr(Message("{axis} IS NOT HOMED AND ITS POSITION IS UNKNOWN. HOME IT FIRST", axis=axis))
    if snapshot.state not in {MachineState.IDLE, MachineState.DISABLED}:
        return tr("TOUCH OFF ONLY WITH THE MACHINE STOPPED AND READY")
    return ""


def find_axis_position(quantity: str, snapshot: Snapshot) -> float:
    """Return the machine position of the touched axis in mm."""
    return snapshot.tip["xz".index(TOUCH_FIELDS[quantity])]


@dataclass(slots=True)
class TouchOff:
    """Touch-off of one axis of a tool.

    - ``touch_position_mm`` is the machine position in mm at the touch.
    - ``measured_position_mm`` is the result of the tool setter: the machine position in mm with the tip at
      part zero.
    - ``change_reason`` describes a measurement of the tool setter. After this measurement, no entry is
      necessary and the axis may move.
    """

    measured_quantity: str = ""
    touch_position_mm: float = 0.0
    moves_only_this_tool: bool = False  # Only this tool changes, although it is the master.
    measured_position_mm: float | None = None
    change_reason: str = ""
    is_skim_cut: bool = False  # The entered size was measured on a skim cut.

    @property
    def field_name(self) -> str:
        """Return the name of the tool field that the touch-off sets."""
        return TOUCH_FIELDS[self.measured_quantity]

    def store_touch_position(self, quantity: str, snapshot: Snapshot) -> None:
        """Store the current position of the axis as the touch position."""
        self.measured_quantity, self.touch_position_mm, self.moves_only_this_tool = (
            quantity,
            find_axis_position(quantity, snapshot),
            False,
        )
        self.measured_position_mm, self.change_reason, self.is_skim_cut = None, "", False

    def set_cut_position(self, quantity: str, position_mm: float) -> None:
        """Store the machine position in mm during a skim cut as the touch position."""
        self.measured_quantity, self.touch_position_mm, self.moves_only_this_tool = (
            quantity,
            position_mm,
            False,
        )
        self.measured_position_mm, self.change_reason, self.is_skim_cut = None, "", True

    def set_measurement(self, quantity: str, position_mm: float, reason: str) -> None:
        """Store a measurement of the tool setter.

        If the tool is the master tool, the other tools do not follow this measurement.
        """
        (
            self.measured_quantity,
            self.measured_position_mm,
            self.change_reason,
            self.moves_only_this_tool,
            self.is_skim_cut,
        ) = (
            quantity,
            position_mm,
            reason,
            True,
            False,
        )

    def find_zero_position(self, text: str, value_mode: UnitMode) -> float:
        """Return the machine position in mm at which the tool tip is at part zero, with X as a radius.

        Raises InvalidEntryError if the text is invalid or the position is out of range.
        """
        if self.measured_position_mm is not None:
            return self._within(self.measured_position_mm)
        typed = evaluate_expression(text) * (0.5 if self.measured_quantity == TOUCH_X else 1.0)
        return self._within(self.touch_position_mm - convert_to_mm(typed, value_mode.is_metric))

    def _within(self, place: float) -> float:
        if not TOOL_FIELDS[self.field_name].is_valid_value(place):
            raise InvalidEntryError(
                tr(
                    Message(
                        "the {axis} offset would be outside the allowed range",
                        axis=translate_field_name(self.field_name),
                    )
                )
            )
        return place

    def save_touch_off(
        self, tool_number: int, text: str, history: OffsetHistory, new_tool: IncompleteTool
    ) -> str:
        """Save the touch-off. Return an empty string, or the reason if the touch-off is rejected.

        X and Z of a new tool are saved together. A suspicious value must be confirmed first. Raises
        InvalidEntryError if the entry is invalid.
        """
        place, ask = self.find_zero_position(text, history.unit_mode), ConfirmedOffsetChanges(history)
        touch, tip_x_mm = self.make_touch_position(place), self._find_tip_x(place)
        if tool_number in history.offset_book.tool_offsets:
            return ask.touch_off(tool_number, touch, self._make_reason(text, history.unit_mode), tip_x_mm)
        reason = self.change_reason or tr("touch-off of a new tool")
        return ask.touch_off_new_tool(
            tool_number,
            touch,
            lambda: _add_to_new_tool(new_tool, tool_number, touch, tip_x_mm, reason, history),
            tip_x_mm,
        )

    def make_touch_position(self, zero_position_mm: float) -> TouchPosition:
        """Return the result of the touch-off for the offset table.

        ``zero_position_mm`` is the machine position in mm with the tool tip at part zero.
        """
        return (
            TouchPosition(zero_position_mm, None, self.moves_only_this_tool)
            if self.field_name == "x"
            else TouchPosition(None, zero_position_mm, self.moves_only_this_tool)
        )

    def _find_tip_x(self, place: float) -> float | None:
        """Return X of the touching tool tip relative to part zero in mm, or None if X was not touched."""
        return (
            self.touch_position_mm - place
            if self.field_name == "x" and self.measured_position_mm is None
            else None
        )

    def has_axis_moved(self, snapshot: Snapshot) -> bool:
        """Return whether the axis has moved since the touch.

        For a measurement of the tool setter, the result is always False. It is also False for a skim cut,
        because ``SkimCut`` makes its own check.
        """
        return (
            self.measured_position_mm is None
            and not self.is_skim_cut
            and abs(find_axis_position(self.measured_quantity, snapshot) - self.touch_position_mm)
            > MOVE_TOLERANCE_MM
        )

    def _make_reason(self, text: str, mode: UnitMode) -> str:
        """Return the text that describes the touch-off in the offset history."""
        if self.change_reason:
            return f"{self.change_reason}{tr(', this tool only') if self.moves_only_this_tool else ''}"
        unit = "MM " if mode.is_metric else ""
        names = (
            (tr("skim cut Ø"), tr("skim cut Z"))
            if self.is_skim_cut
            else (tr("touch-off Ø"), tr("touch-off Z"))
        )
        what = names[self.measured_quantity != TOUCH_X]
        return f"{unit}{what} {text.strip()}{tr(', this tool only') if self.moves_only_this_tool else ''}"


def _add_to_new_tool(
    new_tool: IncompleteTool,
    tool_number: int,
    touch: TouchPosition,
    tip_x_mm: float | None,
    reason: str,
    history: OffsetHistory,
) -> str:
    """Add one axis to a new tool, and save the tool if both axes are known.

    Returns an empty string, or the reason if the tool is rejected.
    """
    name, place = ("x", touch.x) if touch.x is not None else ("z", touch.z)
    values = new_tool.add_value(tool_number, name, float(place or 0.0))
    new_tool.tip_x_mm = tip_x_mm if name == "x" else new_tool.tip_x_mm
    if len(values) < 2:
        history.desk.say(new_tool.describe_missing_axis())
        return ""
    whole = TouchPosition(float(values["x"]), float(values["z"]))
    why = history.offset_book.touch_off(tool_number, whole, reason)
    if not why:
        new_tool.discard_values()
    return why
