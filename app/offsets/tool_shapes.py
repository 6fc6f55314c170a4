"""The model of a tool's shape (F8 on the page of tool offsets), which the operator edits field by field."""

from __future__ import annotations

from app.desk.arithmetic import InvalidEntryError
from app.desk.desk import Desk
from app.desk.stored_shapes import find_shape_row_mistakes, make_tool_shape
from app.desk.translation import tr
from app.offsets.offset_table import ToolFieldEditor, ToolFieldTable
from app.offsets.offset_values import (
    TOOL_FIELDS,
    format_value,
    parse_field_value,
    translate_choice,
    translate_field_name,
)
from core.executor.snapshot import Snapshot
from core.message import Message
from core.part.shape_rules import FIELDS_BY_KIND, ShapeMistake
from core.part.tool_outline import ToolOutline, make_tool_outline
from core.part.tool_shape import ToolKind
from core.store.store_rows import (
    OFFSET_NUMBERS,
    FieldType,
    FieldValue,
    OffsetKind,
    ToolOffsetRow,
    ToolShapeRow,
    replace_fields,
)
from core.tool_edges import format_edge_name, format_edge_suffix, get_tool_number

# Fields that are saved with the tool's offset.
_OFFSET_FIELDS = {"tip": "quadrant", "nose_radius": "nose_radius"}
_CURSOR_MOVES = {"Up": -1, "Down": 1, "Tab": 1}
_CHOICE_STEPS = {"Left": -1, "Right": 1}


class ToolShapeTable(ToolFieldTable):
    """The shape of one tool, with the field under the cursor.

    Left and Right cycle through the choices of a field.
    """

    kind = OffsetKind.SHAPE
    open_text_hint = "PRESS ENTER TO TYPE THE TEXT"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.field_index = 0

    # --- display -------------------------------------------------------------------------------------

    @property
    def shape_row(self) -> ToolShapeRow | None:
        """Return the shape of the selected tool, or None if the tool has no shape."""
        return self.offset_book.tool_shapes.get(self.tool_number)

    @property
    def field_names(self) -> tuple[str, ...]:
        """Return the names of the fields that apply to the kind of the selected tool."""
        row = self.shape_row
        if row is None:
            return ("kind",)
        return ("kind", *(_OFFSET_FIELDS.get(name, name) for name in FIELDS_BY_KIND[ToolKind(row.kind)]))

    @property
    def name(self) -> str:
        """Return the name of the field under the cursor."""
        return self.field_names[min(self.field_index, len(self.field_names) - 1)]

    def read_field_value(self, name: str) -> FieldValue:
        """Return the saved value of a field.

        Nose radius and tip come from the tool's offset.
        """
        if name in ToolOffsetRow._fields:
            of_offset: FieldValue = getattr(self.tool_row or ToolOffsetRow(), name)
            return of_offset
        of_shape: FieldValue = getattr(self.shape_row or ToolShapeRow(), name)
        return of_shape

    def format_field(self, name: str) -> str:
        """Return a field as text, or an empty string if the field is not specified."""
        value = self.read_field_value(name)
        stated = (
            bool(value)
            or TOOL_FIELDS[name].field_type is FieldType.BOOLEAN
            or (name == "quadrant" and self.tool_row)
        )
        return format_value(name, value, self.unit_mode) if stated else ""

    @property
    def shape_mistakes(self) -> tuple[ShapeMistake, ...]:
        """Return the mistakes in the shape of the selected tool."""
        return () if self.shape_row is None else find_shape_row_mistakes(self.shape_row, self.tool_row)

    @property
    def tool_outline(self) -> ToolOutline | None:
        """Return the outline to draw, or None if the shape is missing or has mistakes."""
        return (
            None
            if self.shape_row is None or self.shape_mistakes
            else make_tool_outline(make_tool_shape(self.shape_row, self.tool_row))
        )

    @property
    def stored_value_text(self) -> str:
        """Return the saved value of the field under the cursor as text."""
        return self.format_field(self.name)

    @property
    def entered_text(self) -> str:
        """Return the entered text, or the name of the selected choice."""
        return self._said(self.text) if self.text and self.field_choices else self.text

    def _said(self, choice: str) -> str:
        return {"yes": tr("YES"), "no": tr("NO")}.get(choice) or translate_choice(choice)

    @property
    def footer_text(self) -> str:
        """Return the hint about the keys F3, F8 and Esc."""
        return tr("Page Up, Page Down: other tool   F3: delete shape   F8: tool table   Esc: exit")

    def make_hint(self, _snapshot: Snapshot) -> str:
        """Return the first mistake of the shape, or how to enter the field under the cursor."""
        if self.shape_mistakes and not (self.text or self.is_text_open):
            return f"{format_edge_name(self.tool_number)}: {tr(self.shape_mistakes[0].message)}"
        if self.is_text_open:
            return tr("TYPE THE TEXT. ENTER: SAVE   ESC: CANCEL   F-KEYS STILL WORK")
        if self.field_choices:
            return tr("LEFT/RIGHT: CHANGE    ENTER: ACCEPT")
        if self.accepts_any_text:
            return tr(self.open_text_hint)
        return tr("TYPE A NUMBER OR EXPRESSION   ENTER: SET   0: NOT SPECIFIED")

    @property
    def is_correction(self) -> bool:
        """Return False, because a tool shape must not be changed while a program is running."""
        return False

    @property
    def field_choices(self) -> tuple[str, ...]:
        """Return the choices of the field under the cursor, or an empty tuple if it has none."""
        field = TOOL_FIELDS[self.name]
        return ("no", "yes") if field.field_type is FieldType.BOOLEAN else field.choices

    # --- keys ----------------------------------------------------------------------------------------

    def handle_entry_key(self, key: str) -> bool:
        """Handle a key of the table.

        Up and Down move the cursor, and Enter saves the entered value or choice.
        """
        if key in _CURSOR_MOVES:
            self.move_cursor(self.field_names.index(self.name) + _CURSOR_MOVES[key])
        elif key in _CHOICE_STEPS:
            self.show_adjacent_choice(_CHOICE_STEPS[key])
        elif key in {"Home", "End"}:
            self.select_tool(OFFSET_NUMBERS[0] if key == "Home" else OFFSET_NUMBERS[-1])
        elif key in {"Page up", "Page down"}:
            self.select_tool(get_tool_number(self.tool_number) + (1 if key == "Page down" else -1))
        elif len(key) == 1 and self.accepts_key(key) and self.field_choices:
            self.desk.say(tr("LEFT/RIGHT: CHANGE THIS VALUE"))
        else:
            return super().handle_entry_key(key)
        return True

    def select_field(self, index: int) -> None:
        """Select a touched field.

        A second touch opens a text or selects the next choice.
        """
        again = index == self.field_names.index(self.name)
        if not again:
            self.move_cursor(index)
        elif self.field_choices:
            self.show_adjacent_choice(1)
        elif self.accepts_any_text and not self.is_text_open:
            self.handle_enter()

    def move_cursor(self, index: int) -> None:
        """Move the cursor to a field, unless there is an unfinished entry."""
        if not self.is_entry_unfinished():
            self.field_index = max(0, min(len(self.field_names) - 1, index))

    def select_tool(self, number: int) -> None:
        """Select another tool and its first field, unless there is an unfinished entry."""
        if not self.is_entry_unfinished():
            self.offset_book.at, self.field_index = max(OFFSET_NUMBERS[0], min(OFFSET_NUMBERS[-1], number)), 0

    def show_adjacent_choice(self, step: int) -> None:
        """Show the next or previous choice of the field.

        Enter saves the choice.
        """
        choices = self.field_choices
        if not choices:
            return
        if why := self.find_cell_refusal():
            self.desk.say(why)
            return
        now = self.text or self._find_choice()
        self.text = choices[(choices.index(now) + step) % len(choices)] if now in choices else choices[0]

    def _find_choice(self) -> str:
        """Return the field's value as one of its choices, or an empty string if it has no value."""
        value = self.read_field_value(self.name)
        return ("yes" if value else "no") if isinstance(value, bool) else str(value)

    def handle_enter(self) -> None:
        """Handle Enter: save the entered value or choice, open a text, or go to the next field."""
        if self.text.strip() or self.is_text_open:
            self.save_field(
                lambda: self._save_field(self.name, parse_field_value(self.name, self.text, self.unit_mode))
            )
        elif self.accepts_any_text:
            self._open()
        else:
            self.move_cursor(self.field_names.index(self.name) + 1)

    def _open(self) -> None:
        if why := self.find_cell_refusal():
            self.desk.say(why)
        else:
            self.is_text_open, self.text = True, str(self.read_field_value(self.name))

    def _save_field(self, name: str, value: FieldValue) -> str:
        """Save a field.

        Raise InvalidEntryError if the value is not valid for this field.
        """
        of_offset = name in ToolOffsetRow._fields
        if of_offset and self.tool_row is None:
            return ToolFieldEditor(self.offset_history).describe_unset_tool(self.tool_number)
        if (self.shape_row is not None or of_offset) and value == self.read_field_value(name):
            self.desk.say(tr(Message("T{number} NOT CHANGED", number=format_edge_suffix(self.tool_number))))
            return ""
        self._check_shape(name, value)
        typed = f"{'MM ' if self.unit_mode.is_metric else ''}{translate_field_name(name)} {self.text.strip()}"
        return self.confirmed_changes.change_fields(
            OffsetKind.TOOL if of_offset else OffsetKind.SHAPE, self.tool_number, {name: value}, typed
        )

    def _check_shape(self, name: str, value: FieldValue) -> None:
        """Raise InvalidEntryError if the entered value is not valid for the selected field.

        Mistakes in other fields are shown but do not prevent saving.
        """
        tool, row = self.tool_row or ToolOffsetRow(), self.shape_row or ToolShapeRow()
        if name in ToolOffsetRow._fields:
            tool = replace_fields(tool, {name: value})
        else:
            row = replace_fields(row, {name: value})
        wrong = [
            each
            for each in find_shape_row_mistakes(row, tool)
            if _OFFSET_FIELDS.get(each.field_name, each.field_name) == name
        ]
        if wrong:
            raise InvalidEntryError(wrong[0].message)

    def find_deletion_refusal(self) -> str:
        """Return why the shape cannot be deleted now, or an empty string if it can."""
        if self.shape_row is None:
            return tr(
                Message("T{number}: NO TOOL SHAPE DEFINED", number=format_edge_suffix(self.tool_number))
            )
        return self.find_cell_refusal()

    def delete_shape(self) -> None:
        """Handle F3: delete the shape after the operator confirms."""
        if why := self.find_deletion_refusal():
            self.desk.say(why)
        else:
            number = self.tool_number
            question = tr(
                Message(
                    "PRESS Y TO DELETE THE SHAPE OF T{number}, N TO KEEP IT",
                    number=format_edge_suffix(number),
                )
            )
            self.desk.ask_operator(question, lambda: self._remove(number))

    def _remove(self, number: int) -> None:
        self.discard_entry()
        self.offset_history.show_refusal(
            self.find_cell_refusal() or self.offset_book.remove_shape(number, tr("no shape"))
        )
