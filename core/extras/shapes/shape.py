"""A shape: its fields, the lines that cut it, what it refuses, and its sketch; and one that is filled in."""

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


TOOL_WORD = "T"  # stands in the code of the line that has the comment, so not in the comment


@dataclass(frozen=True, slots=True)
class Shape:
    """``name`` begins the comment, so it holds letters and blanks only. ``cut`` writes the lines.

    ``first`` yields why nothing can be proposed for other fields, ``checks`` what the fields refuse of each
    other. ``contour``: it has a table of points, which is read from its lines. ``ends`` are lines that belong
    to the end of the program, behind M30. Without a comment (``noted``) its lines are no piece that is opened
    again. ``says``: what is to be told of them. ``extent``: values of the points that proposals follow.
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
        """The field of this word."""
        return next((each for each in self.fields if each.word == word), None)


@dataclass(frozen=True, slots=True)
class Filled:
    """A shape with what has been typed into it, and with what is proposed for the rest."""

    shape: Shape
    values: Values
    rows: tuple[Row, ...] = ()

    def n(self, word: str) -> float:
        """A number; 0 where there is none."""
        value = self.values.get(word, 0.0)
        return 0.0 if isinstance(value, str) else float(value)

    def t(self, word: str) -> str:
        """A word; empty where there is none."""
        value = self.values.get(word, "")
        return value if isinstance(value, str) else ""

    @property
    def fields(self) -> tuple[Field, ...]:
        """Those that exist for these values."""
        return tuple(each for each in self.shape.fields if each.only(self.values))

    def refusals(self, setting: Setting) -> list[Refusal]:
        """Everything that is wrong, field by field; then what the fields refuse of each other."""
        if first := list(self.shape.first(self, setting)):
            return first
        said = (each.refusal(self.values.get(each.word)) for each in self.fields)
        found = [refused for refused in said if refused is not None]
        return found or [*self._tool(setting), *self.shape.checks(self, setting)]

    def _tool(self, setting: Setting) -> Iterator[Refusal]:
        """A tool whose sheet says that it is another one."""
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
        """The lines with their comment; without a complete set of fields they mean nothing."""
        code = SinumerikCode(setting) if setting.dialect is Dialect.SINUMERIK else Code(setting)
        self.shape.cut(self, setting, code)
        return code.noted(self.comment(setting)) if self.shape.noted else code.lines

    def comment(self, setting: Setting) -> str:
        """What the comment carries: the name, and value and word of each field that says something."""
        said = [self.shape.name]
        for each in self.fields:
            value = self.values.get(each.word)
            if each.word == TOOL_WORD or value is None or (value == 0.0 and each.zero and not each.start):
                continue
            said += [_said(each, value, setting), each.word]
        return " ".join(said)


def filled(shape: Shape, typed: Values, setting: Setting, rows: tuple[Row, ...] = ()) -> Filled:
    """The shape with what was typed, and what is proposed for the rest, field after field."""
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
    """The values that a comment carries behind the name of its shape; None where it carries others."""
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
