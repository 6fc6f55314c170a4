"""The model of a tool's shape (F8 on the tool offsets), which the operator edits field by field."""

from __future__ import annotations

from app.desk.arithmetic import EntryError
from app.desk.desk import Desk
from app.desk.stored_shapes import row_mistakes, shape_of
from app.desk.translation import tr
from app.offsets.offset_table import ToolEntry, ToolFields
from app.offsets.offset_values import TOOL_FIELDS, choice_word, shown_value, value_typed, word
from core.executor.snapshot import Snapshot
from core.message import Message
from core.part.shape_rules import FIELDS_OF, ShapeMistake
from core.part.tool_outline import ToolOutline, outline
from core.part.tool_shape import ToolKind
from core.store.store_rows import OFFSETS, Kind, ShapeRow, Sort, ToolRow, Value, with_fields
from core.tool_edges import edge_name, edge_number, tool_of

# Fields that are saved with the tool's offset.
_OF_THE_OFFSET = {"tip": "quadrant", "nose_radius": "nose_radius"}
_MOVES = {"Up": -1, "Down": 1, "Tab": 1}
_TURNS = {"Left": -1, "Right": 1}


class ToolShapes(ToolEntry):
    """The shape of one tool, with the field under the cursor. Left and Right cycle through the choices."""

    kind = Kind.SHAPE
    to_write = "PRESS ENTER TO TYPE THE TEXT"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.place = 0

    # --- display -------------------------------------------------------------------------------------

    @property
    def row(self) -> ShapeRow | None:
        """The shape of the selected tool. None if the tool has no shape."""
        return self.book.shapes.get(self.number)

    @property
    def names(self) -> tuple[str, ...]:
        """The fields that apply to a tool of this kind."""
        row = self.row
        if row is None:
            return ("kind",)
        return ("kind", *(_OF_THE_OFFSET.get(name, name) for name in FIELDS_OF[ToolKind(row.kind)]))

    @property
    def name(self) -> str:
        """The field under the cursor."""
        return self.names[min(self.place, len(self.names) - 1)]

    def value(self, name: str) -> Value:
        """Return the saved value of a field. Nose radius and tip come from the tool's offset."""
        if name in ToolRow._fields:
            of_offset: Value = getattr(self.tool or ToolRow(), name)
            return of_offset
        of_shape: Value = getattr(self.row or ShapeRow(), name)
        return of_shape

    def cell(self, name: str) -> str:
        """Return a field as text. Empty if the field is not specified."""
        value = self.value(name)
        stated = bool(value) or TOOL_FIELDS[name].sort is Sort.FLAG or (name == "quadrant" and self.tool)
        return shown_value(name, value, self.mode) if stated else ""

    @property
    def mistakes(self) -> tuple[ShapeMistake, ...]:
        """The mistakes in this shape."""
        return () if self.row is None else row_mistakes(self.row, self.tool)

    @property
    def outline(self) -> ToolOutline | None:
        """The outline to draw. None if there is no shape, or if it has mistakes."""
        return None if self.row is None or self.mistakes else outline(shape_of(self.row, self.tool))

    @property
    def value_before(self) -> str:
        """The saved value of the field as text."""
        return self.cell(self.name)

    @property
    def entered(self) -> str:
        """The entered text, or the name of the selected choice."""
        return self._said(self.text) if self.text and self.chosen_from else self.text

    def _said(self, choice: str) -> str:
        return {"yes": tr("YES"), "no": tr("NO")}.get(choice) or choice_word(choice)

    @property
    def foot(self) -> str:
        """The hint for the keys F3, F8 and Esc."""
        return tr("Page Up, Page Down: other tool   F3: delete shape   F8: tool table   Esc: exit")

    def hint(self, _snapshot: Snapshot) -> str:
        """Return the first mistake of the shape, or how to enter the field under the cursor."""
        if self.mistakes and not (self.text or self.writing):
            return f"{edge_name(self.number)}: {tr(self.mistakes[0].text)}"
        if self.writing:
            return tr("TYPE THE TEXT. ENTER: SAVE   ESC: CANCEL   F-KEYS STILL WORK")
        if self.chosen_from:
            return tr("LEFT/RIGHT: CHANGE    ENTER: ACCEPT")
        if self.is_text:
            return tr(self.to_write)
        return tr("TYPE A NUMBER OR EXPRESSION   ENTER: SET   0: NOT SPECIFIED")

    @property
    def corrects(self) -> bool:
        """False, because a change of a shape must wait until no program is running."""
        return False

    @property
    def chosen_from(self) -> tuple[str, ...]:
        """The choices of the field under the cursor. Empty for a free value."""
        field = TOOL_FIELDS[self.name]
        return ("no", "yes") if field.sort is Sort.FLAG else field.choices

    # --- keys ----------------------------------------------------------------------------------------

    def enter_key(self, key: str) -> bool:
        """Handle a key: Up and Down move the cursor, and Enter saves the entered value or choice."""
        if key in _MOVES:
            self.go(self.names.index(self.name) + _MOVES[key])
        elif key in _TURNS:
            self.turn(_TURNS[key])
        elif key in {"Page up", "Page down"}:
            self.go_to_tool(tool_of(self.number) + (1 if key == "Page down" else -1))
        elif len(key) == 1 and self.takes(key) and self.chosen_from:
            self.desk.say(tr("LEFT/RIGHT: CHANGE THIS VALUE"))
        else:
            return super().enter_key(key)
        return True

    def choose(self, place: int) -> None:
        """Select a touched field. A second touch opens a text or selects the next choice."""
        again = place == self.names.index(self.name)
        if not again:
            self.go(place)
        elif self.chosen_from:
            self.turn(1)
        elif self.is_text and not self.writing:
            self.enter()

    def go(self, place: int) -> None:
        """Move the cursor to a field, unless there is an unfinished entry."""
        if not self.left_open():
            self.place = max(0, min(len(self.names) - 1, place))

    def go_to_tool(self, number: int) -> None:
        """Select another tool at its first field, unless there is an unfinished entry."""
        if not self.left_open():
            self.book.at, self.place = max(OFFSETS[0], min(OFFSETS[-1], number)), 0

    def turn(self, step: int) -> None:
        """Show the next or previous choice of the field. Enter saves it."""
        choices = self.chosen_from
        if not choices:
            return
        if why := self.cell_barred():
            self.desk.say(why)
            return
        now = self.text or self._choice()
        self.text = choices[(choices.index(now) + step) % len(choices)] if now in choices else choices[0]

    def _choice(self) -> str:
        """Return the value of the field as one of its choices. Empty if it is not specified."""
        value = self.value(self.name)
        return ("yes" if value else "no") if isinstance(value, bool) else str(value)

    def enter(self) -> None:
        """Handle Enter: save the entered value or choice, open a text, or go to the next field."""
        if self.text.strip() or self.writing:
            self.store(lambda: self._save(self.name, value_typed(self.name, self.text, self.mode)))
        elif self.is_text:
            self._open()
        else:
            self.go(self.names.index(self.name) + 1)

    def _open(self) -> None:
        if why := self.cell_barred():
            self.desk.say(why)
        else:
            self.writing, self.text = True, str(self.value(self.name))

    def _save(self, name: str, value: Value) -> str:
        """Save a field. Raises EntryError if the value is a mistake in this field."""
        of_offset = name in ToolRow._fields
        if of_offset and self.tool is None:
            return ToolFields(self.history).never_set(self.number)
        if (self.row is not None or of_offset) and value == self.value(name):
            self.desk.say(tr(Message("T{number} NOT CHANGED", number=edge_number(self.number))))
            return ""
        self._check(name, value)
        typed = f"{'MM ' if self.mode.metric else ''}{word(name)} {self.text.strip()}"
        return self.questions.change(
            Kind.TOOL if of_offset else Kind.SHAPE, self.number, {name: value}, typed
        )

    def _check(self, name: str, value: Value) -> None:
        """Raise EntryError if the value is a mistake in this field.

        Mistakes in other fields are only shown.
        """
        tool, row = self.tool or ToolRow(), self.row or ShapeRow()
        if name in ToolRow._fields:
            tool = with_fields(tool, {name: value})
        else:
            row = with_fields(row, {name: value})
        wrong = [
            each for each in row_mistakes(row, tool) if _OF_THE_OFFSET.get(each.field, each.field) == name
        ]
        if wrong:
            raise EntryError(wrong[0].text)

    def remove_barred(self) -> str:
        """Return why the shape cannot be deleted now. Empty if it can."""
        if self.row is None:
            return tr(Message("T{number}: NO TOOL SHAPE DEFINED", number=edge_number(self.number)))
        return self.cell_barred()

    def remove(self) -> None:
        """Handle F3: delete the shape after the operator confirms."""
        if why := self.remove_barred():
            self.desk.say(why)
        else:
            number = self.number
            question = tr(
                Message("PRESS Y TO DELETE THE SHAPE OF T{number}, N TO KEEP IT", number=edge_number(number))
            )
            self.desk.ask(question, lambda: self._remove(number))

    def _remove(self, number: int) -> None:
        self.drop()
        self.history.answer(self.cell_barred() or self.book.remove_shape(number, tr("no shape")))
