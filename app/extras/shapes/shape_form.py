"""Form of one shape with entries, calculated values and errors.

The module also contains the base class of the forms that other features add to the list of shapes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from app.desk.arithmetic import EXPRESSION_CHARACTERS, InvalidEntryError, evaluate_expression
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, apply_edit_key
from app.desk.translation import tr
from core.extras.shapes.contour import ContourPoint, make_point_label
from core.extras.shapes.editor_shape import Shape, ShapeInstance, make_shape_instance
from core.extras.shapes.lines.code_lines import format_short_number
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    ProgramSettings,
    ShapeField,
    make_choice_text,
)
from core.extras.shapes.shape_pieces import ProgramShape
from core.extras.shapes.threads.thread_series import THREAD_SIZES, ThreadSeries
from core.extras.shapes.threads.thread_values import get_thread_series, list_side_tolerance_classes
from core.sketch import Sketch

POINT_COLUMNS = ("X", "Z", "C", "R", "A")
"""Column headings of a point: diameter, Z, chamfer, radius and arc (positive for G02, negative for G03)."""
_PARTS = ("x", "z", "chamfer", "radius", "arc")
_NAMES = frozenset("0123456789./#-MX")  # characters for the names of sizes
_LONGEST = 24


class FormCell(NamedTuple):
    """Display data of one form field: its label, its value, whether it was typed, and its error."""

    field_name: str
    label: str
    value_text: str
    is_typed: bool
    error_text: str
    is_choice: bool


@dataclass(slots=True)
class ShapeForm:
    """Form of a shape, such as a contour or a screw thread, with the operator's entries.

    - ``entered_texts`` contains the typed text by field.
    - ``point_texts`` contains one entry per point, with the typed text by column.
    - ``selected_row`` is the index of the selected row. Rows of fields precede rows of points.
    - ``replaced_piece`` is the existing shape in the program text from which the form was opened, if any.
    """

    shape: Shape
    settings: ProgramSettings
    replaced_piece: ProgramShape | None = None
    entered_texts: dict[str, str] = field(default_factory=dict)
    point_texts: list[dict[str, str]] = field(default_factory=list)
    selected_row: int = 0
    selected_column: int = 0
    next_key_replaces_entry: bool = True  # the next character replaces the entry
    filled_shape: ShapeInstance = field(init=False)
    error_texts: dict[str, str] = field(default_factory=dict)
    program_lines: list[str] = field(default_factory=list)
    calculation_count: int = 0  # number of calculations
    remarks: tuple[str, ...] = ()  # remarks about the lines

    def __post_init__(self) -> None:
        if self.replaced_piece is not None:
            self._enter_values(self.replaced_piece.shape_instance)
        elif self.shape.has_point_table:
            self.point_texts = [{"X": "0", "Z": "0"}]
        self.calculate()
        self.selected_row = self._first()

    def apply_settings(self, settings: ProgramSettings) -> None:
        """Apply changed tool data, and recalculate the form."""
        self.settings = settings
        self.calculate()

    def _enter_values(self, filled_shape: ShapeInstance) -> None:
        """Enter the values of a shape from the program text as if the operator had typed them."""
        for word, value in filled_shape.field_values.items():
            self.entered_texts[word] = value if isinstance(value, str) else format_short_number(value, 6)
        for row in filled_shape.contour_points:
            said = {c: getattr(row, p) for c, p in zip(POINT_COLUMNS, _PARTS, strict=True)}
            keep = {c: v for c, v in said.items() if v is not None and (v or c in "XZ")}
            self.point_texts.append({c: format_short_number(v, 6) for c, v in keep.items()})

    def _first(self) -> int:
        """Return the row to select first: the first field without a value, or else the second point."""
        for place, each in enumerate(self.fields):
            if self.filled_shape.field_values.get(each.name) is None:
                return place
        return len(self.fields) + 1 if self.shape.has_point_table else 0

    # --- calculation ---------------------------------------------------------------------------------

    def calculate(self) -> None:
        """Calculate the values, the errors and the program lines from the entries."""
        self.calculation_count += 1
        self.error_texts = {}
        values = {word: value for word in self.entered_texts if (value := self._value(word)) is not None}
        rows = tuple(self._row(number) for number in range(len(self.point_texts)))
        while rows and rows[-1].empty:
            rows = rows[:-1]
        self.filled_shape = make_shape_instance(self.shape, values, self.settings, rows)
        if not self.error_texts:
            for refused in self._refusals():
                self.error_texts.setdefault(refused.field_name, refused.message)
        self.program_lines = [] if self.error_texts else self.filled_shape.make_lines(self.settings)
        self.remarks = () if self.error_texts else self.shape.make_notes(self.filled_shape, self.settings)

    def _refusals(self) -> list[FieldError]:
        try:
            return self.filled_shape.find_errors(self.settings)
        except ArithmeticError:
            word = self.fields[min(self.selected_row, len(self.fields) - 1)].name
            return [
                FieldError(
                    word, "These values do not make a valid shape: check the last value that you entered."
                )
            ]

    def _value(self, word: str) -> FieldValue | None:
        known, said = self.shape.find_field(word), self.entered_texts[word]
        if known is None or not said:
            return None
        if known.kind in {FieldKind.CHOICE, FieldKind.NAME}:
            return said
        return self._number(word, said)

    def _number(self, word: str, said: str) -> float | None:
        try:
            return evaluate_expression(said)
        except InvalidEntryError as error:
            self.error_texts[word] = str(error)
            return None

    def _row(self, number: int) -> ContourPoint:
        said = self.point_texts[number]
        word = make_point_label(number + 1)
        found = {c: self._number(word, said[c]) for c in POINT_COLUMNS if said.get(c)}
        return ContourPoint(found.get("X"), found.get("Z"), *(found.get(c) or 0.0 for c in ("C", "R", "A")))

    # --- display -------------------------------------------------------------------------------------

    @property
    def fields(self) -> tuple[ShapeField, ...]:
        """Return the fields that apply to the current choices."""
        return self.filled_shape.applicable_fields if hasattr(self, "filled_shape") else self.shape.fields

    @property
    def row_count(self) -> int:
        """Return the number of rows for fields and points, including the empty point at the end."""
        return len(self.fields) + (len(self.point_texts) + 1 if self.shape.has_point_table else 0)

    @property
    def selected_field(self) -> ShapeField | None:
        """Return the selected field, or None if a point is selected."""
        return self.fields[self.selected_row] if self.selected_row < len(self.fields) else None

    @property
    def selected_point(self) -> int:
        """Return the index of the selected contour point, or -1 if a field is selected."""
        return self.selected_row - len(self.fields) if self.selected_row >= len(self.fields) else -1

    @property
    def selected_field_name(self) -> str:
        """Return the name that identifies the selected field, or the label of the selected point."""
        here = self.selected_field
        return here.name if here is not None else make_point_label(self.selected_point + 1)

    def make_cells(self) -> list[FormCell]:
        """Return the display data of all fields."""
        return [
            FormCell(
                each.name,
                each.label,
                self.get_display_text(each),
                each.name in self.entered_texts,
                self.error_texts.get(each.name, ""),
                bool(self.list_choices(each)),
            )
            for each in self.fields
        ]

    def get_value_text(self, field: ShapeField) -> str:
        """Return the typed text of a field, or else the proposed value as text."""
        if field.name in self.entered_texts:
            return self.entered_texts[field.name]
        value = self.filled_shape.field_values.get(field.name)
        if value is None:
            return ""
        return value if isinstance(value, str) else format_short_number(value, 6)

    def get_display_text(self, field: ShapeField) -> str:
        """Return the text of a field as the operator sees it, with choices translated."""
        said = self.get_value_text(field)
        return translate_choice(field, said) if self.is_translatable(field, said) else said

    def is_translatable(self, field: ShapeField, choice: str) -> bool:
        """Return whether a choice is a screen text to translate. Names and sizes are not translated."""
        return choice in field.choices

    def get_dimension_text(self, word: str) -> str:
        """Return the text of a dimension in the sketch, or an empty string if it has no value."""
        if word.startswith("#"):
            number = int(word[1:]) - 1
            return word if number < len(self.point_texts) else ""
        known = self.shape.find_field(word)
        return self.get_display_text(known) if known is not None and known in self.fields else ""

    def list_choices(self, field: ShapeField) -> tuple[str, ...]:
        """Return the choices of a field, or an empty tuple if the field has no choices."""
        if field.name == "CLASS":
            return list_side_tolerance_classes(self.filled_shape.field_values)
        if field.name == "SIZE":
            return tuple(
                size.name for size in THREAD_SIZES.get(get_thread_series(self.filled_shape.field_values), ())
            )
        return field.choices

    @property
    def current_error(self) -> str:
        """Return the error of the selected field or point, or else the first error of the form."""
        return self.error_texts.get(self.selected_field_name) or next(iter(self.error_texts.values()), "")

    @property
    def current_sketch(self) -> Sketch:
        """Return the sketch of the shape. The dimensions in the sketch are the fields of the form."""
        return self.shape.make_sketch(self.filled_shape)

    @property
    def is_calculating(self) -> bool:
        """Return whether the program lines are still being calculated."""
        return False

    # --- keys ----------------------------------------------------------------------------------------

    def handle_touch(self, point: tuple[float, float]) -> None:
        """Handle a touch on the sketch outside its dimensions."""

    def select_row(self, row: int, column: int = 0) -> None:
        """Select a field or point by its row."""
        self.selected_row = max(0, min(row, self.row_count - 1))
        self.selected_column, self.next_key_replaces_entry = column, True

    def select_field_by_name(self, word: str) -> None:
        """Select the field with a given name, or the contour point with a given label."""
        if word.startswith("#"):
            self.select_row(len(self.fields) + int(word[1:]) - 1)
            return
        for place, each in enumerate(self.fields):
            if each.name == word:
                self.select_row(place)

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the selected field or point."""
        if len(key) != 1:
            return False
        here = self.selected_field
        if here is None:
            return key in EXPRESSION_CHARACTERS or key.upper() in POINT_COLUMNS
        if here.kind is FieldKind.NAME:
            return key.upper() in _NAMES
        if here.kind is FieldKind.CHOICE:
            return any(self._begins(here, each, key) for each in self.list_choices(here))
        return key in EXPRESSION_CHARACTERS

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the key has no function in the form."""
        moves = {"Up": -1, "Down": 1, "Enter": 1, "Page up": -8, "Page down": 8}
        moves |= {key: ROW_STEPS[key] for key in ("Home", "End")}
        if key in moves:
            self.select_row(self.selected_row + moves[key])
        elif key in {"Left", "Right", "Tab"}:
            self._sideways(-1 if key == "Left" else 1)
        elif self.accepts_key(key) or key in {"Back", "Delete"}:
            self._write(key)
        else:
            return False
        return True

    def _sideways(self, by: int) -> None:
        here = self.selected_field
        if here is None:
            self.selected_column, self.next_key_replaces_entry = (
                (self.selected_column + by) % len(POINT_COLUMNS),
                True,
            )
        elif choices := self.list_choices(here):
            now = self.get_value_text(here)
            place = choices.index(now) + by if now in choices else 0
            self._set(here.name, choices[place % len(choices)])
        else:
            self.select_row(self.selected_row + by)

    def _write(self, key: str) -> None:
        here = self.selected_field
        if here is None:
            self._write_point(key)
        elif here.kind is FieldKind.CHOICE:
            self._pick(here, key)
        else:
            before = "" if self.next_key_replaces_entry and key != "Back" else self.get_value_text(here)
            self._set(
                here.name,
                apply_edit_key(before, key.upper() if here.kind is FieldKind.NAME else key, _LONGEST),
            )
            self.next_key_replaces_entry = False

    def _pick(self, here: ShapeField, key: str) -> None:
        """Select the next choice that begins with the typed letter.

        Backspace or Delete restores the proposed choice.
        """
        choices, now = self.list_choices(here), self.get_value_text(here)
        if key in {"Back", "Delete"}:
            self.entered_texts.pop(here.name, None)
            self.calculate()
            return
        start = choices.index(now) + 1 if now in choices else 0
        order = (*choices[start:], *choices[:start])
        self._set(here.name, next(each for each in order if self._begins(here, each, key)))

    def _begins(self, here: ShapeField, choice: str, key: str) -> bool:
        """Return whether the displayed text of a choice begins with the typed letter."""
        said = translate_choice(here, choice) if self.is_translatable(here, choice) else choice
        return said.upper().startswith(key.upper())

    def _write_point(self, key: str) -> None:
        """Handle a key while a point is selected.

        A letter selects the column with that name. Digits edit the value. Editing the empty point at the
        end adds a point.
        """
        if key.upper() in POINT_COLUMNS:
            self.selected_column, self.next_key_replaces_entry = POINT_COLUMNS.index(key.upper()), True
            return
        while len(self.point_texts) <= self.selected_point:
            self.point_texts.append({})
        row, column = self.point_texts[self.selected_point], POINT_COLUMNS[self.selected_column]
        before = "" if self.next_key_replaces_entry and key != "Back" else row.get(column, "")
        row[column] = apply_edit_key(before, key, _LONGEST)
        if not row[column]:
            del row[column]
        self.next_key_replaces_entry = False
        self._calculate_at_point(self.selected_point)

    def _calculate_at_point(self, point: int) -> None:
        """Recalculate the form, and keep the same point selected.

        The row of a point can change, because the fields depend on the points.
        """
        self.calculate()
        self.selected_row = len(self.fields) + point

    def _set(self, word: str, said: str) -> None:
        if said:
            self.entered_texts[word] = said
        else:
            self.entered_texts.pop(word, None)
        self.calculate()
        self.selected_row = next(
            (n for n, each in enumerate(self.fields) if each.name == word), self.selected_row
        )

    def insert_point(self) -> None:
        """Insert an empty point before the selected point."""
        if self.selected_point >= 0:
            self.point_texts.insert(self.selected_point, {})
            self._calculate_at_point(self.selected_point)

    def delete_point(self) -> None:
        """Delete the selected point."""
        if 0 <= self.selected_point < len(self.point_texts):
            del self.point_texts[self.selected_point]
            self._calculate_at_point(self.selected_point)


def translate_choice(field: ShapeField, choice: str) -> str:
    """Return the translated text of a choice, or the choice itself if there is no translation."""
    known = make_choice_text(field, choice)
    said = tr(known)
    return choice if said == known else said


ShowForm = Callable[[ShapeForm], str | None]
"""Function that shows the calculated values of a form and returns the whole text.

It returns None if the form is closed.
"""


class AdditionalForm(ABC):
    """Interface of a form that another feature adds to the list of shapes.

    ``key`` is the key that opens the form. A worker calculates the form.
    """

    key: str
    shape: Shape

    @abstractmethod
    def open_form(
        self, settings: ProgramSettings, preceding_lines: tuple[str, ...], requested_file: Path | None
    ) -> ShapeForm:
        """Return a new form.

        ``preceding_lines`` are the program lines before the form. ``requested_file`` is the file to open.
        """

    @abstractmethod
    def accepts_file(self, name: str) -> bool:
        """Return whether this form can make a program from a file with the given name."""

    @abstractmethod
    def calculate(self, form: ShapeForm, show_form: ShowForm, show_message: Callable[[str], None]) -> None:
        """Calculate the form on a worker.

        ``show_message`` receives the reason if the form cannot be calculated.
        """

    @abstractmethod
    def cancel(self, form: ShapeForm) -> None:
        """Cancel the calculation of the form."""

    @abstractmethod
    def make_function_keys(self, form: ShapeForm, show_form: ShowForm) -> Mapping[int, FunctionKey]:
        """Return the function keys of this form, in addition to those of every shape form."""

    @abstractmethod
    def prompt_text(self, form: ShapeForm) -> str:
        """Return the text of the prompt line."""

    @abstractmethod
    def poll(self) -> None:
        """Process the results of the form's workers. This method is called once per frame."""

    @abstractmethod
    def close(self) -> None:
        """Stop the workers of the form."""


def list_translatable_texts(shapes: Iterable[Shape]) -> list[str]:
    """Return the names of shapes, fields and choices for the translation check."""
    shapes = tuple(shapes)
    fields = [field for shape in shapes for field in shape.fields]
    labels = {field.label for field in fields if len(field.label) > 1}
    choices = {make_choice_text(field, choice) for field in fields for choice in _list_translatable(field)}
    return sorted({shape.name for shape in shapes} | labels | choices)


def _list_translatable(field: ShapeField) -> tuple[str, ...]:
    """Return those choices of a field that are screen texts to translate.

    The names of thread series and classes are the same in all languages.
    """
    if field.name == "SERIES":
        return (ThreadSeries.CUSTOM.value,)
    return () if field.name in {"CLASS", "SIZE"} else field.choices
