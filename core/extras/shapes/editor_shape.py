"""Shape of the editor: its fields, program lines, checks and sketch, and the shape with values."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.lines.code_lines import (
    CodeWriter,
    decode_comment_number,
    decode_thread_name,
    encode_comment_number,
    encode_thread_name,
)
from core.extras.shapes.lines.sinumerik_lines import SinumerikCodeWriter
from core.extras.shapes.shape_fields import (
    LENGTH_KINDS,
    TEXT_KINDS,
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
)
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Sketch


def _no_checks(_filled: ShapeInstance, _setting: ProgramSettings) -> Iterator[FieldError]:
    return iter(())


TOOL_FIELD_WORD = "T"  # in the code of the line with the comment, and therefore not in the comment


@dataclass(frozen=True, slots=True)
class Shape:
    """A shape that the editor offers.

    - ``name`` begins the comment, so it contains only letters and spaces.
    - ``write_lines`` writes the program lines. ``make_program_end_lines`` returns lines to be placed
      after M30.
    - ``find_blocking_errors`` yields errors that prevent proposals for other fields.
      ``find_field_conflicts`` yields errors between fields.
    - If ``contour`` is True, the shape has a point table, which is read from its lines.
      ``calculate_extent`` returns values of the points on which proposals depend.
    - If ``has_comment`` is True, the lines have a comment, from which the shape can be opened again.
    - ``make_notes`` returns notes about the lines.
    """

    name: str
    summary: str
    fields: tuple[ShapeField, ...]
    write_lines: Callable[[ShapeInstance, ProgramSettings, CodeWriter], None]
    make_sketch: Callable[[ShapeInstance], Sketch]
    find_field_conflicts: Callable[[ShapeInstance, ProgramSettings], Iterator[FieldError]] = field(
        default=_no_checks
    )
    has_point_table: bool = False
    make_program_end_lines: Callable[[ShapeInstance], tuple[str, ...]] = field(default=lambda _filled: ())
    has_comment: bool = True
    find_blocking_errors: Callable[[ShapeInstance, ProgramSettings], Iterator[FieldError]] = field(
        default=_no_checks
    )
    make_notes: Callable[[ShapeInstance, ProgramSettings], tuple[str, ...]] = field(
        default=lambda _filled, _setting: ()
    )
    calculate_extent: Callable[[Sequence[ContourPoint]], FieldValues] = field(default=lambda _rows: {})

    def find_field(self, word: str) -> ShapeField | None:
        """Return the field with this word, or None if the shape has no such field."""
        return next((each for each in self.fields if each.name == word), None)


@dataclass(frozen=True, slots=True)
class ShapeInstance:
    """A shape with the entered values, and with proposals for the other fields."""

    shape: Shape
    field_values: FieldValues
    contour_points: tuple[ContourPoint, ...] = ()

    def get_number(self, word: str) -> float:
        """Return the value of a number field, or 0 if it is missing."""
        value = self.field_values.get(word, 0.0)
        return 0.0 if isinstance(value, str) else float(value)

    def get_text(self, word: str) -> str:
        """Return the value of a text field, or an empty string if it is missing."""
        value = self.field_values.get(word, "")
        return value if isinstance(value, str) else ""

    @property
    def applicable_fields(self) -> tuple[ShapeField, ...]:
        """Return the fields of the shape that apply to the current values."""
        return tuple(each for each in self.shape.fields if each.applies_to(self.field_values))

    def find_errors(self, settings: ProgramSettings) -> list[FieldError]:
        """Return the errors of single fields or, if there are none, the conflicts between fields."""
        if first := list(self.shape.find_blocking_errors(self, settings)):
            return first
        said = (each.find_error(self.field_values.get(each.name)) for each in self.applicable_fields)
        found = [refused for refused in said if refused is not None]
        return found or [*self._tool(settings), *self.shape.find_field_conflicts(self, settings)]

    def _tool(self, settings: ProgramSettings) -> Iterator[FieldError]:
        """Yield an error if the shape cannot use the kind of tool that the tool data specifies."""
        known, sheet = self.shape.find_field(TOOL_FIELD_WORD), settings.tool(self.get_number(TOOL_FIELD_WORD))
        if known is not None and sheet is not None and sheet.kind not in {*known.tool_kinds, ToolKind.FORM}:
            wanted = " or ".join(known.tool_kinds)
            text = Message(
                "The tool data of T{tool_word} specifies the type {kind}, but this shape needs {expected}",
                tool_word=f"{self.get_number(TOOL_FIELD_WORD):.0f}",
                kind=sheet.kind,
                expected=wanted,
            )
            yield FieldError(TOOL_FIELD_WORD, Message("{what}: enter another tool.", what=text))

    def make_lines(self, settings: ProgramSettings) -> list[str]:
        """Return the program lines, with a comment if the shape requires it.

        All fields must have values.
        """
        code = (
            SinumerikCodeWriter(settings) if settings.dialect is Dialect.SINUMERIK else CodeWriter(settings)
        )
        self.shape.write_lines(self, settings, code)
        return code.add_comment(self.make_comment(settings)) if self.shape.has_comment else code.lines

    def make_comment(self, settings: ProgramSettings) -> str:
        """Return the comment that describes the shape.

        The comment contains the name of the shape, and the value and word of each field with a value.
        """
        said = [self.shape.name]
        for each in self.applicable_fields:
            value = self.field_values.get(each.name)
            if (
                each.name == TOOL_FIELD_WORD
                or value is None
                or (value == 0.0 and each.allows_zero and not each.default)
            ):
                continue
            said += [_said(each, value, settings), each.name]
        return " ".join(said)


def make_shape_instance(
    shape: Shape,
    entered_values: FieldValues,
    settings: ProgramSettings,
    contour_points: tuple[ContourPoint, ...] = (),
) -> ShapeInstance:
    """Return the shape with the entered values, and with proposals for all other fields.

    The proposals are made in the order of the fields.
    """
    values: dict[str, FieldValue] = {}
    drawn = shape.calculate_extent(contour_points)
    for each in shape.fields:
        value = entered_values.get(each.name)
        if value is None and each.applies_to({**entered_values, **values}):
            value = each.propose_value({**drawn, **entered_values, **values}, settings)
            value = 0.0 if value is None and each.allows_zero else value
        if value is not None:
            values[each.name] = value
    return ShapeInstance(shape, values, contour_points)


def read_comment(shape: Shape, words: list[str]) -> dict[str, FieldValue] | None:
    """Return the field values that a comment contains, or None if they are invalid.

    ``words`` are the words of the comment after the name of the shape.
    """
    if len(words) % 2:
        return None
    found: dict[str, FieldValue] = {}
    for said, word in zip(words[::2], words[1::2], strict=True):
        known = shape.find_field(word)
        value = None if known is None else _read(known, said)
        if value is None:
            return None
        found[word] = value
    for each in shape.fields:
        if each.name not in found and each.allows_zero:
            found[each.name] = 0.0
    return found


def _said(each: ShapeField, value: FieldValue, setting: ProgramSettings) -> str:
    if isinstance(value, str):
        return encode_thread_name(value) if each.kind is FieldKind.NAME else value.replace(" ", "")
    unit = "MM" if each.is_in_comment and setting.metric and each.kind in LENGTH_KINDS else ""
    return encode_comment_number(value, 6) + unit


def _read(each: ShapeField, said: str) -> FieldValue | None:
    if each.kind is FieldKind.NAME:
        return decode_thread_name(said)
    if each.kind in TEXT_KINDS:
        return next((choice for choice in each.choices if choice.replace(" ", "") == said), None)
    return decode_comment_number(said)
