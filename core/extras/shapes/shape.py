"""A shape: its fields, lines, checks and sketch; and a shape with values."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from core.extras.shapes.contour import Row
from core.extras.shapes.lines.code_lines import (
    Code,
    from_comment,
    in_comment,
    name_from_comment,
    name_in_comment,
)
from core.extras.shapes.lines.sinumerik_lines import SinumerikCode
from core.extras.shapes.shape_fields import LENGTHS, WORDS, Field, Kind, Refusal, Setting, Value, Values
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Sketch


def _no_checks(_filled: Filled, _setting: Setting) -> Iterator[Refusal]:
    return iter(())


TOOL_WORD = "T"  # in the code of the line with the comment, and therefore not in the comment


@dataclass(frozen=True, slots=True)
class Shape:
    """A shape that the editor offers.

    ``name`` begins the comment, so it has only letters and spaces. ``cut`` writes the lines. ``first`` yields
    errors that prevent proposals for other fields, and ``checks`` errors between fields. ``contour`` means
    that the shape has a point table, which is read from its lines. ``ends`` returns lines for the end of the
    program, after M30. ``noted`` means that the lines have a comment, so that the shape can be opened again.
    ``says`` returns notes about the lines. ``extent`` returns values of the points on which proposals depend.
    """

    name: str
    use: str
    fields: tuple[Field, ...]
    cut: Callable[[Filled, Setting, Code], None]
    sketch: Callable[[Filled], Sketch]
    checks: Callable[[Filled, Setting], Iterator[Refusal]] = field(default=_no_checks)
    contour: bool = False
    ends: Callable[[Filled], tuple[str, ...]] = field(default=lambda _filled: ())
    noted: bool = True
    first: Callable[[Filled, Setting], Iterator[Refusal]] = field(default=_no_checks)
    says: Callable[[Filled, Setting], tuple[str, ...]] = field(default=lambda _filled, _setting: ())
    extent: Callable[[Sequence[Row]], Values] = field(default=lambda _rows: {})

    def field(self, word: str) -> Field | None:
        """Return the field with this word, or None."""
        return next((each for each in self.fields if each.word == word), None)


@dataclass(frozen=True, slots=True)
class Filled:
    """A shape with entered values and with proposals for the other fields."""

    shape: Shape
    values: Values
    rows: tuple[Row, ...] = ()

    def n(self, word: str) -> float:
        """Return the value of a number field; 0 if it is missing."""
        value = self.values.get(word, 0.0)
        return 0.0 if isinstance(value, str) else float(value)

    def t(self, word: str) -> str:
        """Return the value of a text field; empty if it is missing."""
        value = self.values.get(word, "")
        return value if isinstance(value, str) else ""

    @property
    def fields(self) -> tuple[Field, ...]:
        """Fields that exist for these values."""
        return tuple(each for each in self.shape.fields if each.only(self.values))

    def refusals(self, setting: Setting) -> list[Refusal]:
        """Return all errors of single fields, or else the errors between fields."""
        if first := list(self.shape.first(self, setting)):
            return first
        said = (each.refusal(self.values.get(each.word)) for each in self.fields)
        found = [refused for refused in said if refused is not None]
        return found or [*self._tool(setting), *self.shape.checks(self, setting)]

    def _tool(self, setting: Setting) -> Iterator[Refusal]:
        """Yield an error if the tool data specifies another kind of tool."""
        known, sheet = self.shape.field(TOOL_WORD), setting.tool(self.n(TOOL_WORD))
        if known is not None and sheet is not None and sheet.kind not in {*known.tools, ToolKind.FORM}:
            wanted = " or ".join(known.tools)
            text = Message(
                "The tool data of T{tool_word} specifies the type {kind}, but this shape needs {expected}",
                tool_word=f"{self.n(TOOL_WORD):.0f}",
                kind=sheet.kind,
                expected=wanted,
            )
            yield Refusal(TOOL_WORD, Message("{what}: enter another tool.", what=text))

    def lines(self, setting: Setting) -> list[str]:
        """Return the lines with their comment. All fields must have values."""
        code = SinumerikCode(setting) if setting.dialect is Dialect.SINUMERIK else Code(setting)
        self.shape.cut(self, setting, code)
        return code.noted(self.comment(setting)) if self.shape.noted else code.lines

    def comment(self, setting: Setting) -> str:
        """Return the comment: the name of the shape, and value and word of each field with a value."""
        said = [self.shape.name]
        for each in self.fields:
            value = self.values.get(each.word)
            if each.word == TOOL_WORD or value is None or (value == 0.0 and each.zero and not each.start):
                continue
            said += [_said(each, value, setting), each.word]
        return " ".join(said)


def filled(shape: Shape, typed: Values, setting: Setting, rows: tuple[Row, ...] = ()) -> Filled:
    """Return the shape with the entered values, and proposals for the other fields in order."""
    values: dict[str, Value] = {}
    drawn = shape.extent(rows)
    for each in shape.fields:
        value = typed.get(each.word)
        if value is None and each.only({**typed, **values}):
            value = each.proposed({**drawn, **typed, **values}, setting)
            value = 0.0 if value is None and each.zero else value
        if value is not None:
            values[each.word] = value
    return Filled(shape, values, rows)


def read_comment(shape: Shape, words: list[str]) -> dict[str, Value] | None:
    """Return the values from the words of a comment after the shape's name; None if they are invalid."""
    if len(words) % 2:
        return None
    found: dict[str, Value] = {}
    for said, word in zip(words[::2], words[1::2], strict=True):
        known = shape.field(word)
        value = None if known is None else _read(known, said)
        if value is None:
            return None
        found[word] = value
    for each in shape.fields:
        if each.word not in found and each.zero:
            found[each.word] = 0.0
    return found


def _said(each: Field, value: Value, setting: Setting) -> str:
    if isinstance(value, str):
        return name_in_comment(value) if each.kind is Kind.NAME else value.replace(" ", "")
    unit = "MM" if each.marked and setting.metric and each.kind in LENGTHS else ""
    return in_comment(value, 6) + unit


def _read(each: Field, said: str) -> Value | None:
    if each.kind is Kind.NAME:
        return name_from_comment(said)
    if each.kind in WORDS:
        return next((choice for choice in each.choices if choice.replace(" ", "") == said), None)
    return from_comment(said)
