"""Picture of the touch-off that is being entered: its drawing, its texts and its warnings."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace

from app.desk.arithmetic import InvalidEntryError
from app.desk.status.formats import format_length
from app.desk.stored_shapes import find_shape_row_mistakes, is_quadrant_for_other_side, make_tool_shape
from app.desk.translation import tr
from app.jog.tool_setting import ToolSetting
from app.jog.tool_touch_off import TOUCH_FIELDS
from app.jog.touch_off_scene import (
    ToolAtPart,
    TouchedSurface,
    TouchOffScene,
    assume_working_side,
    find_working_side,
    make_touch_off_scene,
)
from app.offsets.offset_changes import ConfirmedOffsetChanges, describe_suspicion
from app.offsets.offset_values import UnitMode, describe_missing_offset, format_signed_length
from core.part.tool_shape import ToolKind, ToolShape
from core.store.store_rows import ToolOffsetRow, ToolShapeRow
from core.tool_edges import TIP_DIRECTIONS, format_edge_name, get_tool_number

MISSING_VALUE = "?"
WARNING_DELAY_S = 0.7  # Pause in the entry after which a warning appears.


@dataclass(frozen=True, slots=True, eq=False)
class TouchOffPicture:
    """Drawing of a touch-off with its texts.

    - ``unit_text`` is the unit of the sizes, or an empty string if the whole screen uses it.
    - ``new_text`` is the entered size, and ``old_text`` is the size according to the old offset.
    - ``size_texts`` are the lines of the dimension: the entered size, and the radius of a diameter.
    - ``size_change_text`` is the new size minus the old size. The offset changes in the opposite direction.
    - ``warning_text`` is the reason why the entry must be confirmed, or an empty string.
    - ``is_warning_due`` means that the operator has finished or interrupted the entry.
    - ``note_text`` explains how the tool is drawn, states that its tip quadrant is wrong, or is an empty
      string.
    """

    scene: TouchOffScene
    title: str
    unit_text: str
    old_text: str
    new_text: str
    size_texts: tuple[str, ...]
    size_change_text: str
    warning_text: str
    note_text: str
    is_warning_due: bool = False

    @property
    def shown_warning(self) -> str:
        """Return the warning, or an empty string while the operator is typing."""
        return self.warning_text if self.is_warning_due else ""


@dataclass(slots=True)
class TouchOffPictures:
    """The picture of the touch-off that is being entered.

    The picture remains until the operator has answered the question about a suspicious change.
    """

    tool_setting: ToolSetting
    picture: TouchOffPicture | None = None
    _inputs: Hashable = field(default=None)  # The values that the current picture was made from.
    _changed_at: float = 0.0  # s: time of the last change of these values.

    def update(self) -> None:
        """Make the picture again if the entry or the tool has changed.

        This method is called once per frame.
        """
        tool = self.tool_setting
        if tool.question_name in TOUCH_FIELDS and not tool.is_tool_setter_result:
            now, inputs = tool.desk.station_controls.clock(), self._list_inputs()
            if self.picture is None or inputs != self._inputs:
                self.picture, self._inputs, self._changed_at = self._make_picture(), inputs, now
            self._show_warning(is_due=now - self._changed_at >= WARNING_DELAY_S)
        elif tool.is_touch_off_confirmation_open:
            self._show_warning(is_due=True)
        else:
            self.picture = None

    def _show_warning(self, *, is_due: bool) -> None:
        """Show the warning of the picture when it is due. A shown warning remains."""
        if self.picture is not None and is_due and not self.picture.is_warning_due:
            self.picture = replace(self.picture, is_warning_due=True)

    def _list_inputs(self) -> Hashable:
        tool, touch = self.tool_setting, self.tool_setting.touch_off
        return (
            tool.question_name,
            str(tool.text),
            tool.tool_number,
            tool.tool_row,
            tool.offset_book.tool_shapes.get(get_tool_number(tool.tool_number)),
            tool.offset_history.unit_mode,
            self._is_other_unit_displayed(),
            touch.touch_position_mm,
            touch.moves_only_this_tool,
            touch.is_skim_cut,
        )

    def _make_picture(self) -> TouchOffPicture:
        tool, touch = self.tool_setting, self.tool_setting.touch_off
        mode, row, name = tool.offset_history.unit_mode, tool.tool_row, touch.field_name
        old = None if row is None else touch.touch_position_mm - row.offset["xz".index(name)]
        new = self._find_new_position(mode)
        new_x = new if name == "x" else None
        shape, side, is_internal = self._find_shape(old if name == "x" else self._find_old_x(row), new_x)
        scene = make_touch_off_scene(
            ToolAtPart(shape, side, is_internal, name == "x", new, old, touch.is_skim_cut)
        )
        return TouchOffPicture(
            scene,
            self._make_title(scene.surface),
            (tr("MM") if mode.is_metric else tr("INCH")) if self._is_other_unit_displayed() else "",
            _format_size(name, old, mode) if old is not None else describe_missing_offset(),
            _format_size(name, new, mode),
            _format_dimension(name, new, mode),
            _format_size_change(name, old, new, mode),
            self._find_warning(new),
            self._make_note(new_x),
        )

    def _find_stored_shape(self) -> ToolShapeRow | None:
        """Return the stored shape of the tool, or None if it is missing or cannot be drawn."""
        tool = self.tool_setting
        stored = tool.offset_book.tool_shapes.get(get_tool_number(tool.tool_number))
        return None if stored is None or find_shape_row_mistakes(stored, tool.tool_row) else stored

    def _make_title(self, surface: TouchedSurface) -> str:
        """Return the name of the touched surface, or DIAMETER if the tool may work inside or outside."""
        row = self.tool_setting.tool_row or ToolOffsetRow()
        is_unknown = self._find_stored_shape() is None and TIP_DIRECTIONS[row.quadrant][1] == 0
        if is_unknown and surface in {TouchedSurface.OUTSIDE_DIAMETER, TouchedSurface.BORE}:
            return tr("DIAMETER")
        return _name_surface(surface)

    def _is_other_unit_displayed(self) -> bool:
        """Return whether the positions on the screen are in another unit than the entry."""
        tool = self.tool_setting
        is_metric = tool.offset_history.unit_mode.is_metric
        return tool.desk.settings_store.display_units.metric(is_metric) != is_metric

    def _make_note(self, new_x_mm: float | None) -> str:
        """Return a note about the tip quadrant or the shape of the tool, or an empty string."""
        shape, row = self._find_stored_shape(), self.tool_setting.tool_row or ToolOffsetRow()
        is_rotating = shape is not None and make_tool_shape(shape, row).is_rotating
        if row.quadrant == 0 and not is_rotating:
            return tr("TIP NOT SET (Q)")
        if shape is None:
            return tr("EXAMPLE TOOL. SHAPE: F8, F8")
        if new_x_mm is None or not is_quadrant_for_other_side(shape, row, new_x_mm):
            return ""
        return tr("TIP FOR OTHER SIDE (Q)")

    def _find_new_position(self, mode: UnitMode) -> float | None:
        """Return the entered size as the position of the tip in mm, or None if it is not a valid number."""
        touch = self.tool_setting.touch_off
        try:
            return touch.touch_position_mm - touch.find_zero_position(self.tool_setting.text, mode)
        except InvalidEntryError:
            return None

    def _find_old_x(self, row: ToolOffsetRow | None) -> float | None:
        """Return X of the tip according to the old offset, or None for a new tool."""
        if row is None:
            return self.tool_setting.tool_fields.incomplete_tool.tip_x_mm
        return self.tool_setting.desk.read_snapshot().tip[0] - row.offset[0]

    def _find_shape(self, old_x_mm: float | None, new_x_mm: float | None) -> tuple[ToolShape, int, bool]:
        """Return the shape of the tool, the side on which it works and whether it works in a bore.

        The shape is an example if none is stored.
        """
        stored, row = self._find_stored_shape(), self.tool_setting.tool_row or ToolOffsetRow()
        if stored is not None:
            shape = _add_tip_quadrant(make_tool_shape(stored, row))
            return shape, *find_working_side(shape, old_x_mm, new_x_mm)
        side, is_internal = assume_working_side(row.quadrant, old_x_mm, new_x_mm)
        return make_example_shape(row, side, is_internal=is_internal), side, is_internal

    def _find_warning(self, new_position_mm: float | None) -> str:
        """Return the most serious reason why the entry must be confirmed, or an empty string."""
        tool, touch = self.tool_setting, self.tool_setting.touch_off
        if new_position_mm is None:
            return ""
        position = touch.make_touch_position(touch.touch_position_mm - new_position_mm)
        tip_x_mm = new_position_mm if touch.field_name == "x" else None
        found = ConfirmedOffsetChanges(tool.offset_history).find_suspicious_touch_changes(
            tool.tool_number, position, tip_x_mm
        )
        first = next((each for each in found if each.name == touch.field_name), None)
        if first is None:
            return ""
        reason = describe_suspicion(first.kind)
        if first.row_number == tool.tool_number:
            return reason
        return f"{format_edge_name(first.row_number)}: {reason}"  # A tool that follows the master tool.


def make_example_shape(row: ToolOffsetRow, side: int, *, is_internal: bool) -> ToolShape:
    """Return an example of a tool without a stored shape: a boring bar or a turning tool."""
    kind = ToolKind.BORING if is_internal else ToolKind.TURNING
    return _add_tip_quadrant(ToolShape(kind, tip=row.quadrant, nose_radius=row.nose_radius, rear=side < 0))


def _add_tip_quadrant(shape: ToolShape) -> ToolShape:
    """Return the shape with the tip quadrant that its kind implies, if no quadrant is specified.

    The measured size then refers to the edge of the tool, and not to its nose center.
    """
    if shape.tip or shape.is_rotating:
        return shape
    return replace(shape, tip=next(tip for tip in range(1, 9) if TIP_DIRECTIONS[tip] == shape.direction))


def _name_surface(surface: TouchedSurface) -> str:
    words = {
        TouchedSurface.OUTSIDE_DIAMETER: tr("OUTSIDE DIAMETER"),
        TouchedSurface.BORE: tr("BORE DIAMETER"),
        TouchedSurface.FACE: tr("FACE OF THE PART"),
        TouchedSurface.CENTERLINE: tr("TOOL ON CENTER"),
        TouchedSurface.NONE: tr("NO DIAMETER TOUCHED"),
    }
    return words[surface]


def _format_size(name: str, position_mm: float | None, mode: UnitMode) -> str:
    """Return a position of the tip as it is entered: X as a diameter, and Z."""
    symbol, factor = ("Ø", 2.0) if name == "x" else ("Z", 1.0)
    value = MISSING_VALUE if position_mm is None else format_length(factor * position_mm, mode.is_metric)
    return f"{symbol} {value}"


def _format_dimension(name: str, position_mm: float | None, mode: UnitMode) -> tuple[str, ...]:
    """Return the lines of the dimension: the entered size, and the radius of a diameter."""
    size = _format_size(name, position_mm, mode)
    if name == "z" or position_mm is None:
        return (size,)
    return size, f"R {format_length(position_mm, mode.is_metric)}"


def _format_size_change(name: str, old_mm: float | None, new_mm: float | None, mode: UnitMode) -> str:
    """Return the new size minus the old size as text, or an empty string if one of them is unknown."""
    if old_mm is None or new_mm is None:
        return ""
    symbol, factor = ("Ø", 2.0) if name == "x" else ("Z", 1.0)
    return f"{symbol} {format_signed_length((new_mm - old_mm) * factor, mode.is_metric)}"
